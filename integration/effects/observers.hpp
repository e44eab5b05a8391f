// SPDX-License-Identifier: Zlib
#pragma once

// The effects of a scene that only look at it: culling, proximity, zones and radar in each frame, picking
// and box selection on request. They work over any grid: that of a Simulation, or of a live Bullet world
// (SpatialHashBroadphase::grid()).
//
//     Observers<float> observers(effects);
//     observers.setView(frustumRegion<float>(viewProjection, DepthRange::zeroToOne));
//     observers.observe({grid});
//     observers.culler().forEach([&](std::uint32_t index) { draw(objects[index]); });
//
// Undeclared  An effect that is not declared has no phase, no table and no cost. A call for it throws
//             UndeclaredEffect.
// A frame     Say what has changed (view, interest, zones), then observe() once.
// Exact       What an effect finds depends only on the boxes and on its own settings, whatever else is
//             declared.
// Late        A declaration may let an effect look in every n-th frame only. In the frames between, the
//             answer is that of an earlier frame: cost() counts late answers.
// Threads     Everything reads the grid, as queries do, and needs this object for itself.
// Removed     Call forget() for a proxy that is removed. (A Simulation does.)
// Failure     Where memory runs out, std::bad_alloc is passed on. This frame then lacks some answers; the
//             next frames go on.

#include <broadphase/convex_region.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/parallel_for.hpp>
#include <integration/ai/zones.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/export.hpp>
#include <integration/effects/scene_cost.hpp>
#include <integration/effects/scene_effects.hpp>
#include <integration/effects/undeclared_effect.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase {

/// A grid, and what each of its proxies takes part in. By default every proxy takes part in every effect.
template <class Scalar>
struct ObservedScene {
    const Grid<Scalar>& grid;

    /// By ProxyId::index: which effects may find the proxy. Proxies beyond the end take part in all effects.
    std::span<const EffectSet> effects = {};

    /// By ProxyId::index: the group in which the radar counts the proxy. Proxies beyond the end are in
    /// group 0.
    std::span<const std::uint32_t> groups = {};

    /// Effects that some proxy takes part in. The other effects are not run.
    EffectSet present = EffectSet::all();

    /// Effects that every proxy is known to take part in. For these the single proxies are not asked, which
    /// is faster.
    EffectSet common = {};

    [[nodiscard]] bool allTakePartIn(Effect effect) const noexcept {
        return effects.empty() || common.contains(effect);
    }
    [[nodiscard]] bool takesPart(ProxyId id, Effect effect) const noexcept {
        return id.index >= effects.size() || effects[id.index].contains(effect);
    }
};

/// Runs those effects of a declaration that look at a grid.
template <class Scalar>
class HASHPHASE_EFFECTS_TEMPLATE_EXPORT Observers {
public:
    using Point = Vector3<Scalar>;
    using Scene = ObservedScene<Scalar>;

    /// Throws std::invalid_argument with effectsError(effects).
    explicit Observers(const SceneEffects& effects = {});
    ~Observers();
    Observers(const Observers&) = delete;
    Observers& operator=(const Observers&) = delete;

    /// Goes on with another declaration. Tables of effects that are not declared any more are freed; zones,
    /// colours and view of effects that are still declared stay. In the next frame no answer is late. Throws
    /// as the constructor, or std::bad_alloc; then nothing has changed.
    void declare(const SceneEffects& effects);

    [[nodiscard]] const SceneEffects& declared() const noexcept { return effects_; }

    // --- What is looked at -----------------------------------------------------------------------

    /// Sets the camera's volume, or any other one; all of space until then. Needs culling.
    void setView(const ConvexRegion<Scalar>& view);

    /// Sets where the player is [m]. What is far from it may be late, as declared, and the radar is around
    /// it. Without an interest (std::nullopt) nothing is far, and the radar is around the origin.
    void setInterest(const std::optional<Point>& interest) { interest_ = interest; }
    [[nodiscard]] const std::optional<Point>& interest() const noexcept { return interest_; }

    /// Add, set and remove zones here; observe() calls Zones::update(). Needs zones.
    [[nodiscard]] Zones<Scalar>& zones();

    /// Gives the proxy with that index a colour, which is 0 until then. Needs proximity. Cost: O(1), and
    /// memory for all lower indices.
    void setColour(std::uint32_t index, std::uint32_t colour);

    /// Runs one frame of the declared effects. `moved` [m] is how far any corner of a box may have moved
    /// since the last frame; infinite when this is unknown or a proxy was added: see Culler::look(). Returns
    /// the cost. The result does not depend on `parallelFor`.
    const SceneCost& observe(const Scene& scene,
                             Scalar moved = std::numeric_limits<Scalar>::infinity(),
                             ParallelFor parallelFor = serialFor);

    /// Call it when the proxy with that index is removed. The next proxy with this index then is not visible
    /// because the removed one was, and has colour 0.
    void forget(std::uint32_t index) noexcept;

    /// Call it before another grid replaces this one, in which indices mean the same and generations do not.
    /// Proxies in a zone enter it again, without having left.
    void forgetProxies() noexcept;

    /// Calls `watch` after each phase with its effect's name, for a profiler. An empty function ends the
    /// calls.
    void watchPhases(std::function<void(std::string_view)> watch) { watch_ = std::move(watch); }

    // --- What was found in the last frame --------------------------------------------------------

    /// The visible set. Needs culling.
    [[nodiscard]] const Culler<Scalar>& culler() const;

    /// By ProxyId::index: the colour that each agent has taken; beyond the end, 0. Valid until the next
    /// frame or setColour(). Needs proximity.
    [[nodiscard]] std::span<const std::uint32_t> colours() const;

    /// Which proxies entered, stayed in and left zones. Valid until the next frame. Needs zones.
    [[nodiscard]] const ZoneEvents& zoneEvents() const;

    /// Counts as Radar::scan() returns them. Valid until the next frame. Needs radar.
    [[nodiscard]] std::span<const std::uint32_t> radarCounts() const;

    /// What the last frame cost, including picks and selections between the frame before and it.
    [[nodiscard]] const SceneCost& cost() const noexcept { return cost_; }

    // --- When it is asked for --------------------------------------------------------------------

    /// As pickNearest(), among proxies that take part in picking. Needs picking.
    [[nodiscard]] Picked<Scalar> pick(const Scene& scene, const RayRegion<Scalar>& ray);
    [[nodiscard]] Picked<Scalar> pick(const Scene& scene, const RayRegion<Scalar>& ray,
                                      ExactTest<Scalar> test);

    /// As hashphase::select(), among proxies that take part in box selection. Needs box selection.
    QueryCost select(const Scene& scene, const Camera<Scalar>& camera, const Pixel& a,
                     const Pixel& b, std::vector<ProxyId>& selected,
                     Containment containment = Containment::touching);

    /// Adds the bytes of all tables here, capacity included. Cost: O(zones).
    void addFootprint(SceneFootprint& footprint) const;

private:
    struct Culling;
    struct Proximity;
    struct ZoneWatch;
    struct RadarWatch;

    /// A phase of observe(), and whose it is.
    struct Phase {
        Effect effect;
        void (Observers::*run)(const Scene&, Scalar moved, ParallelFor);
    };

    void cull(const Scene& scene, Scalar moved, ParallelFor parallelFor);
    void lookAround(const Scene& scene, Scalar moved, ParallelFor parallelFor);
    void lookByTurns(const Scene& scene, ParallelFor parallelFor);
    void watchZones(const Scene& scene, Scalar moved, ParallelFor parallelFor);
    void scanRadar(const Scene& scene, Scalar moved, ParallelFor parallelFor);
    void dropUndeclared() noexcept;
    void compile();
    [[nodiscard]] bool isDue(Effect effect, std::uint32_t everyFrames) const noexcept {
        return frame_ % everyFrames == 0 || farewell_.contains(effect);
    }
    template <class Part>
    static Part& partOf(const std::unique_ptr<Part>& part, Effect effect, const char* call);
    void demand(Effect effect, const char* call) const;
    template <class PickBy>
    Picked<Scalar> pickBy(const Scene& scene, const PickBy& pickBy);
    void noteAsked(SceneCounter count, SceneCounter boxesTested, const QueryCost& cost);

    SceneEffects effects_;
    detail::FixedList<Phase, 4> phases_;
    std::uint64_t frame_ = 0;
    EffectSet presentBefore_;
    EffectSet
        farewell_;  // what somebody took part in in the last frame, and nobody does in this one
    std::optional<Point> interest_;
    SceneCost cost_;   // of the last frame
    SceneCost asked_;  // of picks and selections since
    std::function<void(std::string_view)> watch_;

    std::unique_ptr<Culling> culling_;
    std::unique_ptr<Proximity> proximity_;
    std::unique_ptr<ZoneWatch> zones_;
    std::unique_ptr<RadarWatch> radar_;
};

extern template class Observers<float>;
extern template class Observers<double>;

}  // namespace hashphase
