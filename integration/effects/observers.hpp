// SPDX-License-Identifier: Zlib
#pragma once

// Runs the effects that only query a scene: culling, proximity, zones and radar in each frame, picking and box
// selection on request. Works with any grid, such as a Simulation's or SpatialHashBroadphase::grid().
//
// Undeclared  An undeclared effect has no phase, no table and no cost. A call that needs an undeclared effect throws
//             UndeclaredEffect.
// Frame       In each frame, set the view, the interest (the player's position) and the zones if they changed.
//             After that, call observe() once.
// Exact       An effect's results depend only on the scenes that you pass, and on the effect's settings, view,
//             interest, zones or colours. Other declared effects do not change the results.
// Late        An effect may be declared to run only in every n-th frame, for all objects or for far objects. In other
//             frames, the last visible set, colours, zone occupants or counts stay, but late zones have no events.
//             cost() counts late results.
// Threads     Calls query the grid: other threads may also query the grid, but not change it. During a call, no other
//             thread may use this object.
// Removed     Call forget() for each removed proxy. (Simulation calls it itself.)
// Failure     If observe() throws std::bad_alloc, the visible set may be incomplete, colours may be old, and
//             radarCounts() may be empty. zoneEvents() has all events or none. The next frames work, and report
//             missed events.
// Misuse      Asserted: callbacks of observe() do not call declare() or observe(). Without assertions, such a call
//             does nothing.

#include <broadphase/convex_region.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/parallel_for.hpp>
#include <integration/ai/zones.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/detail/phase_watch.hpp>
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

/// A grid, and the effects in which each proxy takes part (by default all effects).
template <class Scalar>
struct ObservedScene {
    const Grid<Scalar>& grid;

    /// The effects that may find a proxy, indexed by ProxyId::index. Beyond the end: all effects.
    std::span<const EffectSet> effects = {};

    /// The radar group of a proxy, indexed by ProxyId::index. Beyond the end: group 0.
    std::span<const std::uint32_t> groups = {};

    /// Effects in which at least one proxy takes part. Other effects do not run.
    EffectSet present = EffectSet::all();

    /// Effects in which every proxy takes part. These effects run faster: they do not check each proxy.
    EffectSet common = {};

    [[nodiscard]] bool allTakePartIn(Effect effect) const noexcept {
        return effects.empty() || common.contains(effect);
    }
    [[nodiscard]] bool takesPart(ProxyId id, Effect effect) const noexcept {
        return id.index >= effects.size() || effects[id.index].contains(effect);
    }
};

/// Runs the declared effects that query a grid.
template <class Scalar>
class HASHPHASE_EFFECTS_TEMPLATE_EXPORT Observers {
public:
    using Point = Vector3<Scalar>;
    using Scene = ObservedScene<Scalar>;

    /// Throws std::invalid_argument with the string effectsError(effects), if this string is not empty.
    explicit Observers(const SceneEffects& effects = {});
    ~Observers();
    Observers(const Observers&) = delete;
    Observers& operator=(const Observers&) = delete;

    /// Changes the declaration. Frees tables of effects that are no longer declared. Effects that stay declared keep
    /// their zones, colours and view. The next frame computes all results again, except colours of agents whose turn
    /// comes later. Throws as the constructor, or std::bad_alloc. After an exception, nothing has changed.
    void declare(const SceneEffects& effects);

    [[nodiscard]] const SceneEffects& declared() const noexcept { return effects_; }

    // --- View, interest, zones and colours -------------------------------------------------------

    /// Sets the volume that culling searches, usually a frustum. At first, the volume is all of space. Needs
    /// Effect::culling.
    void setView(const ConvexRegion<Scalar>& view);

    /// Sets the interest: the position of the player [m]. Effects may find far objects late, as declared. The radar
    /// is around the player. If std::nullopt, nothing is far, and the radar is around the origin.
    void setInterest(const std::optional<Point>& interest) { interest_ = interest; }
    [[nodiscard]] const std::optional<Point>& interest() const noexcept { return interest_; }

    /// Use the result to add, set and remove zones. observe() calls Zones::update(). Needs Effect::zones.
    [[nodiscard]] Zones<Scalar>& zones();

    /// Sets the colour of the proxy with this index. Colours are 0 at first. Needs Effect::proximity. Cost: O(1), and
    /// memory for all lower indices.
    void setColour(std::uint32_t index, std::uint32_t colour);

    /// Runs one frame. `moved` [m] is the largest distance that a corner of a box may have moved since the last frame
    /// (see Culler::look()). Pass infinity if the distance is unknown, a proxy was added, or ObservedScene::effects
    /// changed. Returns the cost.
    const SceneCost& observe(const Scene& scene,
                             Scalar moved = std::numeric_limits<Scalar>::infinity(),
                             ParallelFor parallelFor = serialFor);

    /// Forgets a removed proxy, so that a new proxy with the same index does not inherit its visibility and colour.
    void forget(std::uint32_t index) noexcept;

    /// Forgets the occupants of all zones; keeps visibility and colours. Call it before you observe another grid that
    /// has equal indices but other generations. Proxies in a zone will enter the zone again, and no event reports
    /// that they left.
    void forgetProxies() noexcept;

    /// Calls `watch` after each phase of observe(), with the name of the phase's effect, for a profiler. To stop the
    /// calls, pass an empty function. `watch` may call watchPhases(): the new function is called from the next phase
    /// on.
    void watchPhases(std::function<void(std::string_view)> watch) { watch_.set(std::move(watch)); }

    // --- Results of the last frame ---------------------------------------------------------------

    /// The visible set. Needs Effect::culling.
    [[nodiscard]] const Culler<Scalar>& culler() const;

    /// Colours of agents, indexed by ProxyId::index. Colours beyond the end are 0. Valid until the next frame or
    /// setColour(). Needs Effect::proximity.
    [[nodiscard]] std::span<const std::uint32_t> colours() const;

    /// Events of zones. Valid until the next frame. Needs Effect::zones.
    [[nodiscard]] const ZoneEvents& zoneEvents() const;

    /// Counts in the order of Radar::scan(). Valid until the next frame. Needs Effect::radar.
    [[nodiscard]] std::span<const std::uint32_t> radarCounts() const;

    /// Cost of the last observe(), and of picks and selections between the last two observe().
    [[nodiscard]] const SceneCost& cost() const noexcept { return cost_; }

    // --- On request ------------------------------------------------------------------------------

    /// As pickNearest(), but only finds proxies that take part in picking. Needs Effect::picking.
    [[nodiscard]] Picked<Scalar> pick(const Scene& scene, const RayRegion<Scalar>& ray);
    [[nodiscard]] Picked<Scalar> pick(const Scene& scene, const RayRegion<Scalar>& ray,
                                      ExactTest<Scalar> test);

    /// As hashphase::select(), but only finds proxies that take part in box selection. Needs Effect::boxSelection.
    QueryCost select(const Scene& scene, const Camera<Scalar>& camera, const Pixel& a,
                     const Pixel& b, std::vector<ProxyId>& selected,
                     Containment containment = Containment::touching);

    /// Adds the bytes of all tables of this object, capacity included. Cost: O(zones).
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
        farewell_;  // effects in which proxies took part in the last frame, but no proxy does in this frame
    std::optional<Point> interest_;
    SceneCost cost_;   // of the last frame
    SceneCost asked_;  // of picks and selections since the last frame
    detail::PhaseWatch watch_;

    std::unique_ptr<Culling> culling_;
    std::unique_ptr<Proximity> proximity_;
    std::unique_ptr<ZoneWatch> zones_;
    std::unique_ptr<RadarWatch> radar_;
};

extern template class Observers<float>;
extern template class Observers<double>;

}  // namespace hashphase
