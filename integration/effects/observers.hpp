// SPDX-License-Identifier: Zlib
#pragma once

// The effects of a scene that only look at it: culling, proximity, zones and radar in each frame, picking and box
// selection on request. They work over any grid, such as a Simulation's or SpatialHashBroadphase::grid().
//
// Undeclared  An undeclared effect has no phase, no table and no cost. A call that needs it throws UndeclaredEffect.
// Frame       Set a changed view, interest or zones, then call observe() once.
// Exact       A result depends only on the boxes and the effect's own settings.
// Late        An effect may look in every n-th frame only. Between, it repeats an earlier answer; cost() counts
//             these.
// Threads     Everything reads the grid, as queries do, and needs this object for itself.
// Removed     Call forget() for each removed proxy. (A Simulation does.)
// Failure     std::bad_alloc is passed on. This frame then lacks some answers; the next frames work.

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

/// A grid, and the effects in which each proxy takes part: by default in all.
template <class Scalar>
struct ObservedScene {
    const Grid<Scalar>& grid;

    /// By ProxyId::index: the effects that may find the proxy. Beyond the end, all effects.
    std::span<const EffectSet> effects = {};

    /// By ProxyId::index: the proxy's group in the radar. Beyond the end, group 0.
    std::span<const std::uint32_t> groups = {};

    /// Effects in which some proxy takes part. The others are not run.
    EffectSet present = EffectSet::all();

    /// Effects in which every proxy takes part. They run faster: proxies are not asked.
    EffectSet common = {};

    [[nodiscard]] bool allTakePartIn(Effect effect) const noexcept {
        return effects.empty() || common.contains(effect);
    }
    [[nodiscard]] bool takesPart(ProxyId id, Effect effect) const noexcept {
        return id.index >= effects.size() || effects[id.index].contains(effect);
    }
};

/// Runs the effects of a declaration that look at a grid.
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

    /// Changes the declaration. Frees tables of effects no longer declared; the others keep zones, colours and view.
    /// The next frame has no late answers, except agents out of turn. Throws as the constructor, or std::bad_alloc;
    /// then nothing has changed.
    void declare(const SceneEffects& effects);

    [[nodiscard]] const SceneEffects& declared() const noexcept { return effects_; }

    // --- View, interest, zones and colours -------------------------------------------------------

    /// Sets the camera's volume, or another one; at first all of space. Needs culling.
    void setView(const ConvexRegion<Scalar>& view);

    /// Sets the player's place [m]. Objects far from it may be late, as declared, and the radar is around it. With
    /// std::nullopt nothing is far, and the radar is around the origin.
    void setInterest(const std::optional<Point>& interest) { interest_ = interest; }
    [[nodiscard]] const std::optional<Point>& interest() const noexcept { return interest_; }

    /// Add, set and remove zones here; observe() calls Zones::update(). Needs zones.
    [[nodiscard]] Zones<Scalar>& zones();

    /// Sets the colour of the proxy with that index, at first 0. Needs proximity. Cost: O(1), and memory for all
    /// lower indices.
    void setColour(std::uint32_t index, std::uint32_t colour);

    /// Runs one frame. `moved` [m] is how far any corner of a box may have moved since the last frame; infinite if
    /// unknown, or if a proxy was added (Culler::look()). Returns the cost.
    const SceneCost& observe(const Scene& scene,
                             Scalar moved = std::numeric_limits<Scalar>::infinity(),
                             ParallelFor parallelFor = serialFor);

    /// Forgets a removed proxy: the next proxy with its index is not visible because of it, and has colour 0.
    void forget(std::uint32_t index) noexcept;

    /// Call it before another grid replaces this one, with equal indices but other generations. Proxies in a zone
    /// enter it again, without leaving it.
    void forgetProxies() noexcept;

    /// Calls `watch` with the effect's name after each phase, for a profiler. An empty function ends the calls.
    void watchPhases(std::function<void(std::string_view)> watch) { watch_ = std::move(watch); }

    // --- Results of the last frame ---------------------------------------------------------------

    /// The visible set. Needs culling.
    [[nodiscard]] const Culler<Scalar>& culler() const;

    /// Colours of agents by ProxyId::index; beyond the end, 0. Valid until the next frame or setColour(). Needs
    /// proximity.
    [[nodiscard]] std::span<const std::uint32_t> colours() const;

    /// Events of zones. Valid until the next frame. Needs zones.
    [[nodiscard]] const ZoneEvents& zoneEvents() const;

    /// Counts as of Radar::scan(). Valid until the next frame. Needs radar.
    [[nodiscard]] std::span<const std::uint32_t> radarCounts() const;

    /// Cost of the last frame, with picks and selections since the frame before.
    [[nodiscard]] const SceneCost& cost() const noexcept { return cost_; }

    // --- On request ------------------------------------------------------------------------------

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

    /// A phase of observe(), and its effect.
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
        farewell_;  // effects in which proxies took part in the last frame, and none do in this one
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
