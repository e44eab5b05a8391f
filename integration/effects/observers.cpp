// SPDX-License-Identifier: Zlib
#include <integration/effects/observers.hpp>

#include <broadphase/core/on_failure.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/core/raise.hpp>
#include <broadphase/diagnostics.hpp>
#include <integration/effects/detail/parts.hpp>
#include <integration/effects/observers_frame.inl>

#include <algorithm>

namespace hashphase {

// --- The declaration -----------------------------------------------------------------------------

template <class Scalar>
Observers<Scalar>::Observers(const SceneEffects& effects) {
    declare(effects);
}

template <class Scalar>
Observers<Scalar>::~Observers() = default;

template <class Scalar>
void Observers<Scalar>::declare(const SceneEffects& effects) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "Observers::declare() was called from within observe(). Call it after that "
                     "returns.");
    if (detail::QueryScope::isWithin(this)) {
        return;
    }
    if (const std::string error = effectsError(effects); !error.empty()) {
        detail::raiseInvalidArgument(error);
    }
    std::unique_ptr<Culling> culling;
    const bool hasCuller = effects_.culling && culling_;
    if (effects.culling && !(hasCuller && effects_.culling->margin == effects.culling->margin)) {
        culling = std::make_unique<Culling>(static_cast<Scalar>(effects.culling->margin));
        culling->view = hasCuller ? culling_->view : culling->view;
    }
    const detail::OnFailure dropMade([&] { dropUndeclared(); });
    detail::makeIf(effects.proximity.has_value(), proximity_);
    detail::makeIf(effects.zones.has_value(), zones_);
    detail::makeIf(effects.radar.has_value(), radar_);
    if (culling) {
        culling_ = std::move(culling);
    }
    effects_ = effects;
    dropUndeclared();
    compile();
}

template <class Scalar>
void Observers<Scalar>::dropUndeclared() noexcept {
    detail::dropUnless(effects_.culling.has_value(), culling_);
    detail::dropUnless(effects_.proximity.has_value(), proximity_);
    detail::dropUnless(effects_.zones.has_value(), zones_);
    detail::dropUnless(effects_.radar.has_value(), radar_);
}

template <class Scalar>
void Observers<Scalar>::compile() {
    phases_.clear();
    const EffectSet declared = effects_.set();
    for (const Phase& phase : {Phase{Effect::culling, &Observers::cull},
                               Phase{Effect::proximity, &Observers::lookAround},
                               Phase{Effect::zones, &Observers::watchZones},
                               Phase{Effect::radar, &Observers::scanRadar}}) {
        if (declared.contains(phase.effect)) {
            static_cast<void>(phases_.push(phase));
        }
    }
    if (culling_) {
        culling_->hasMoved = true;  // nobody knows what has happened since
    }
    presentBefore_ = EffectSet::all();
    frame_ = 0;
}

template <class Scalar>
void Observers<Scalar>::demand(Effect effect, const char* call) const {
    if (!effects_.set().contains(effect)) {
        detail::raiseUndeclared(effect, call);
    }
}

template <class Scalar>
template <class Part>
Part& Observers<Scalar>::partOf(const std::unique_ptr<Part>& part, Effect effect,
                                const char* call) {
    if (!part) {
        detail::raiseUndeclared(effect, call);
    }
    return *part;
}

// --- What is looked at, and what was found -------------------------------------------------------

template <class Scalar>
void Observers<Scalar>::setView(const ConvexRegion<Scalar>& view) {
    Culling& culling = partOf(culling_, Effect::culling, "setView()");
    culling.hasMoved = culling.hasMoved || !(view == culling.view);
    culling.view = view;
}

template <class Scalar>
Zones<Scalar>& Observers<Scalar>::zones() {
    return partOf(zones_, Effect::zones, "zones()").zones;
}

template <class Scalar>
void Observers<Scalar>::forgetProxies() noexcept {
    if (zones_) {
        zones_->zones.forgetOccupants();
        zones_->events = {};
    }
}

template <class Scalar>
void Observers<Scalar>::forget(std::uint32_t index) noexcept {
    if (culling_) {
        culling_->culler.forget(index);
    }
    if (proximity_ && index < proximity_->colours.size()) {
        proximity_->colours[index] = 0;
    }
}

template <class Scalar>
void Observers<Scalar>::setColour(std::uint32_t index, std::uint32_t colour) {
    Proximity& proximity = partOf(proximity_, Effect::proximity, "setColour()");
    proximity.makeRoom(std::size_t{index} + 1);
    proximity.colours[index] = colour;
}

template <class Scalar>
const Culler<Scalar>& Observers<Scalar>::culler() const {
    return partOf(culling_, Effect::culling, "culler()").culler;
}

template <class Scalar>
std::span<const std::uint32_t> Observers<Scalar>::colours() const {
    return partOf(proximity_, Effect::proximity, "colours()").colours;
}

template <class Scalar>
const ZoneEvents& Observers<Scalar>::zoneEvents() const {
    return partOf(zones_, Effect::zones, "zoneEvents()").events;
}

template <class Scalar>
std::span<const std::uint32_t> Observers<Scalar>::radarCounts() const {
    return partOf(radar_, Effect::radar, "radarCounts()").counts;
}

// --- When it is asked for ------------------------------------------------------------------------

template <class Scalar>
void Observers<Scalar>::noteAsked(SceneCounter count, SceneCounter boxesTested,
                                  const QueryCost& cost) {
    ++asked_[count];
    asked_[boxesTested] += cost.boxesTested;
    asked_[SceneCounter::cellRowsVisited] += cost.rowsVisited;
}

template <class Scalar>
template <class PickBy>
Picked<Scalar> Observers<Scalar>::pickBy(const Scene& scene, const PickBy& pickBy) {
    demand(Effect::picking, "pick()");
    QueryCost cost;
    Picked<Scalar> picked =
        askFor(scene, Effect::picking, [&](ProxyFilter filter) { return pickBy(filter, &cost); });
    noteAsked(SceneCounter::picks, SceneCounter::pickBoxesTested, cost);
    return picked;
}

template <class Scalar>
Picked<Scalar> Observers<Scalar>::pick(const Scene& scene, const RayRegion<Scalar>& ray) {
    return pickBy(scene, [&](ProxyFilter filter, QueryCost* cost) {
        return pickNearest(scene.grid, ray, filter, cost);
    });
}

template <class Scalar>
Picked<Scalar> Observers<Scalar>::pick(const Scene& scene, const RayRegion<Scalar>& ray,
                                       ExactTest<Scalar> test) {
    return pickBy(scene, [&](ProxyFilter filter, QueryCost* cost) {
        return pickNearest(scene.grid, ray, test, filter, cost);
    });
}

template <class Scalar>
QueryCost Observers<Scalar>::select(const Scene& scene, const Camera<Scalar>& camera,
                                    const Pixel& a, const Pixel& b, std::vector<ProxyId>& selected,
                                    Containment containment) {
    demand(Effect::boxSelection, "select()");
    const QueryCost cost = askFor(scene, Effect::boxSelection, [&](ProxyFilter filter) {
        return hashphase::select(scene.grid, camera, a, b, selected, containment, filter);
    });
    noteAsked(SceneCounter::selections, SceneCounter::selectionBoxesTested, cost);
    return cost;
}

template <class Scalar>
void Observers<Scalar>::addFootprint(SceneFootprint& footprint) const {
    if (culling_) {
        footprint[SceneTable::visible] +=
            sizeof(Culling) - sizeof(culling_->culler) + culling_->culler.memoryBytes();
    }
    if (proximity_) {
        footprint[SceneTable::agents] += sizeof(Proximity) - sizeof(proximity_->rarest) +
                                         proximity_->rarest.memoryBytes() +
                                         proximity_->colours.capacity() * sizeof(std::uint32_t) +
                                         proximity_->looking.capacity() * sizeof(ProxyId);
    }
    if (zones_) {
        footprint[SceneTable::zones] +=
            sizeof(ZoneWatch) - sizeof(zones_->zones) + zones_->zones.memoryBytes();
    }
    if (radar_) {
        footprint[SceneTable::radar] +=
            sizeof(RadarWatch) - sizeof(radar_->radar) + radar_->radar.memoryBytes();
    }
}

template class HASHPHASE_INSTANCE_EXPORT Observers<float>;
template class HASHPHASE_INSTANCE_EXPORT Observers<double>;

}  // namespace hashphase
