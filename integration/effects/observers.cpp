// SPDX-License-Identifier: Zlib
#include <integration/effects/observers.hpp>

#include <broadphase/position_region.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/effects/detail/parts.hpp>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <variant>

namespace hashphase {
namespace {

/// Asks a query for those who take part in an effect: query(filter), or query(acceptAll), which is
/// faster, where nobody is left out.
template <class Scalar, class Query>
decltype(auto) askFor(const ObservedScene<Scalar>& scene, Effect effect, const Query& query) {
    if (scene.allTakePartIn(effect)) {
        return query(ProxyFilter(acceptAll));
    }
    const auto takesPart = [&scene, effect](ProxyId id) { return scene.takesPart(id, effect); };
    return query(ProxyFilter(takesPart));
}

/// How many proxies that are somewhere take part in an effect.
template <class Scalar>
std::size_t countOf(const ObservedScene<Scalar>& scene, Effect effect) {
    if (scene.allTakePartIn(effect)) {
        return scene.grid.size() - scene.grid.nanCount();
    }
    std::size_t count = 0;
    scene.grid.forEach([&](ProxyId id, const Aabb<Scalar>& box) {
        count += scene.takesPart(id, effect) && !hasNan(box) ? 1 : 0;
    });
    return count;
}

/// Whether nothing within the box can be in a zone of that shape.
template <class Shape, class Scalar>
bool isApart(const Shape& shape, const Aabb<Scalar>& box) {
    return std::visit(
        [&](const auto& region) {
            if constexpr (requires { region.volume(); }) {
                // One that wants boxes inside has no key for one around it.
                return !region.volume().isInside && region.key(box) < 0;
            } else {
                return region.key(box) < 0;
            }
        },
        shape);
}

}  // namespace

template <class Scalar>
struct Observers<Scalar>::Culling {
    explicit Culling(Scalar margin) : culler(margin), view({}) {}

    Culler<Scalar> culler;
    ConvexRegion<Scalar> view;
    bool hasMoved = true;          // the view, since the last look
    std::uint32_t framesKept = 0;  // since then, by declaration
};

template <class Scalar>
struct Observers<Scalar>::Proximity {
    void makeRoom(std::size_t count) {
        if (colours.size() < count) {
            colours.resize(count, 0);
        }
    }

    RarestColour<Scalar> rarest;
    std::vector<std::uint32_t> colours;
    std::vector<ProxyId> looking;  // in this frame, where they look by turns
    std::uint64_t turn = 0;        // of those, the next; goes on where others are declared anew
};

template <class Scalar>
struct Observers<Scalar>::ZoneWatch {
    Zones<Scalar> zones;
    ZoneEvents events;
};

template <class Scalar>
struct Observers<Scalar>::RadarWatch {
    Radar<Scalar> radar;
    std::span<const std::uint32_t> counts;
};

// --- The declaration -----------------------------------------------------------------------------

template <class Scalar>
Observers<Scalar>::Observers(const SceneEffects& effects) {
    declare(effects);
}

template <class Scalar>
Observers<Scalar>::~Observers() = default;

template <class Scalar>
void Observers<Scalar>::declare(const SceneEffects& effects) {
    if (const std::string error = effectsError(effects); !error.empty()) {
        throw std::invalid_argument(error);
    }
    std::unique_ptr<Culling> culling;
    const bool hasCuller = effects_.culling && culling_;
    if (effects.culling && !(hasCuller && effects_.culling->margin == effects.culling->margin)) {
        culling = std::make_unique<Culling>(static_cast<Scalar>(effects.culling->margin));
        culling->view = hasCuller ? culling_->view : culling->view;
    }
    try {
        detail::makeIf(effects.proximity.has_value(), proximity_);
        detail::makeIf(effects.zones.has_value(), zones_);
        detail::makeIf(effects.radar.has_value(), radar_);
    } catch (...) {
        dropUndeclared();
        throw;
    }
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
        throw UndeclaredEffect(effect, call);
    }
}

template <class Scalar>
template <class Part>
Part& Observers<Scalar>::partOf(const std::unique_ptr<Part>& part, Effect effect,
                                const char* call) {
    if (!part) {
        throw UndeclaredEffect(effect, call);
    }
    return *part;
}

// --- A frame -------------------------------------------------------------------------------------

template <class Scalar>
const SceneCost& Observers<Scalar>::observe(const Scene& scene, Scalar moved,
                                            ParallelFor parallelFor) {
    cost_ = asked_;
    asked_ = {};
    if (zones_) {
        zones_->events = {};
    }
    // Whoever took part the last time and does not any more has to be forgotten, and not late.
    const EffectSet wanted = scene.present | presentBefore_;
    farewell_ = presentBefore_ - scene.present;
    if (culling_ && !wanted.contains(Effect::culling)) {
        culling_->culler.noteMoves(std::numeric_limits<Scalar>::infinity());
    }
    for (const Phase& phase : phases_) {
        if (wanted.contains(phase.effect)) {
            (this->*phase.run)(scene, moved, parallelFor);
            if (watch_) {
                watch_(nameOf(phase.effect));
            }
        }
    }
    presentBefore_ = scene.present;
    ++frame_;
    return cost_;
}

template <class Scalar>
void Observers<Scalar>::cull(const Scene& scene, Scalar moved, ParallelFor /*parallelFor*/) {
    Culling& culling = *culling_;
    if (!culling.hasMoved && !farewell_.contains(Effect::culling) &&
        culling.framesKept + 1 < effects_.culling->restingCameraFrames) {
        ++culling.framesKept;
        culling.culler.noteMoves(moved);
        cost_[SceneCounter::framesCulledLate] = 1;
        return;
    }
    const std::uint64_t foundBefore = culling.culler.findCount();
    const QueryCost cost = askFor(scene, Effect::culling, [&](ProxyFilter filter) {
        return scene.allTakePartIn(Effect::culling)
                   ? culling.culler.look(scene.grid, culling.view, moved)
                   : culling.culler.look(scene.grid, culling.view, filter, moved);
    });
    culling.hasMoved = false;
    culling.framesKept = 0;
    cost_[SceneCounter::viewsFound] = culling.culler.findCount() - foundBefore;
    cost_[SceneCounter::cellRowsCulled] = cost.rowsVisited;
    cost_[SceneCounter::cellRowsVisited] += cost.rowsVisited;
    cost_[SceneCounter::cullingBoxesTested] = cost.boxesTested;
}

// Between the frames in which all look around, those near the player do, and see who is near them.
template <class Scalar>
void Observers<Scalar>::lookAround(const Scene& scene, Scalar /*moved*/, ParallelFor parallelFor) {
    const ProximityEffect& effect = *effects_.proximity;
    Proximity& proximity = *proximity_;
    proximity.makeRoom(scene.grid.indexLimit());
    if (effect.turns > 1) {
        lookByTurns(scene, parallelFor);
        return;
    }
    const bool allLook = !interest_ || isDue(Effect::proximity, effect.farFrames);
    const auto isWithin = [&](ProxyId id, double distance) {
        const Vector3<double> offset =
            (positionOf(scene.grid.box(id)) - *interest_).template cast<double>();
        return offset.squaredNorm() <= distance * distance;
    };
    // Rounding must not leave out a neighbour.
    const double reach = (effect.interestRadius + effect.radius) * (1 + 1e-5);
    std::atomic<std::uint32_t> lookingCount{0};
    const QueryCost cost = askFor(scene, Effect::proximity, [&](ProxyFilter filter) {
        const auto update = [&](ProxyFilter counts, ProxyFilter looks) {
            return proximity.rarest.update(scene.grid, static_cast<Scalar>(effect.radius),
                                           effect.colourCount, proximity.colours, counts, looks,
                                           parallelFor);
        };
        if (allLook) {
            return update(filter, acceptAll);
        }
        const auto counts = [&](ProxyId id) { return filter(id) && isWithin(id, reach); };
        const auto looks = [&](ProxyId id) {
            const bool isNear = isWithin(id, effect.interestRadius);
            lookingCount.fetch_add(isNear ? 1 : 0, std::memory_order_relaxed);
            return isNear;
        };
        return update(counts, looks);
    });
    cost_[SceneCounter::agentsScanned] = proximity.rarest.search().size();
    cost_[SceneCounter::neighboursTested] = cost.boxesTested;
    cost_[SceneCounter::agentsLate] =
        allLook ? 0 : countOf(scene, Effect::proximity) - lookingCount.load();
}

// Who looks is known beforehand, and few: a query for each is less than counting for all.
template <class Scalar>
void Observers<Scalar>::lookByTurns(const Scene& scene, ParallelFor parallelFor) {
    const ProximityEffect& effect = *effects_.proximity;
    Proximity& proximity = *proximity_;
    std::size_t late = 0;
    const auto isTurnOf = [&](ProxyId id, const Aabb<Scalar>& box) {
        std::uint64_t turns = effect.turns;
        if (effect.farFrames > 1 && interest_) {
            const Vector3<double> offset = (positionOf(box) - *interest_).template cast<double>();
            const bool isFar = offset.squaredNorm() > effect.interestRadius * effect.interestRadius;
            turns *= isFar ? effect.farFrames : 1;
        }
        return id.index % turns == proximity.turn % turns;
    };
    proximity.looking.clear();
    scene.grid.forEach([&](ProxyId id, const Aabb<Scalar>& box) {
        if (!scene.takesPart(id, Effect::proximity) || hasNan(box)) {
            return;
        }
        if (isTurnOf(id, box)) {
            proximity.looking.push_back(id);
        } else {
            ++late;
        }
    });
    ++proximity.turn;
    const QueryCost cost = askFor(scene, Effect::proximity, [&](ProxyFilter filter) {
        return proximity.rarest.updateSome(scene.grid, static_cast<Scalar>(effect.radius),
                                           effect.colourCount, proximity.colours, proximity.looking,
                                           filter, parallelFor);
    });
    cost_[SceneCounter::agentsScanned] = proximity.looking.size();
    cost_[SceneCounter::neighboursTested] = cost.boxesTested;
    cost_[SceneCounter::agentsLate] = late;
}

template <class Scalar>
void Observers<Scalar>::watchZones(const Scene& scene, Scalar /*moved*/, ParallelFor parallelFor) {
    const ZonesEffect& effect = *effects_.zones;
    ZoneWatch& watch = *zones_;
    const bool allAreDue = !interest_ || isDue(Effect::zones, effect.farFrames);
    Aabb<Scalar> near;
    if (!allAreDue) {
        const auto half = Point::Constant(static_cast<Scalar>(effect.interestRadius)).eval();
        near = {*interest_ - half, *interest_ + half};
    }
    std::atomic<std::uint32_t> lateCount{0};
    const auto isDueZone = [&](ZoneId id) {
        const bool isFar = !allAreDue && isApart(watch.zones.zone(id).shape, near);
        lateCount.fetch_add(isFar ? 1 : 0, std::memory_order_relaxed);
        return !isFar;
    };
    askFor(scene, Effect::zones, [&](ProxyFilter filter) {
        const auto counts = [&](ZoneId /*zone*/, ProxyId proxy) { return filter(proxy); };
        watch.events = watch.zones.update(scene.grid, counts, isDueZone, parallelFor);
    });
    cost_[SceneCounter::zonesTested] = watch.zones.size() - lateCount;
    cost_[SceneCounter::cellRowsVisited] += watch.zones.lastCost().rowsVisited;
    cost_[SceneCounter::zoneBoxesTested] = watch.zones.lastCost().boxesTested;
    cost_[SceneCounter::zonesLate] = lateCount;
}

template <class Scalar>
void Observers<Scalar>::scanRadar(const Scene& scene, Scalar /*moved*/,
                                  ParallelFor /*parallelFor*/) {
    const RadarEffect& effect = *effects_.radar;
    if (!isDue(Effect::radar, effect.frames)) {
        cost_[SceneCounter::radarsLate] = 1;
        return;
    }
    const RadarWindow<Scalar> window{.center = interest_.value_or(Point::Zero()),
                                     .cellSize = static_cast<Scalar>(effect.cellSize),
                                     .columns = effect.columns,
                                     .rows = effect.rows,
                                     .up = effect.up};
    const bool allTakePart = scene.allTakePartIn(Effect::radar);
    const auto groupOf = [&](ProxyId id) -> std::uint32_t {
        if (!allTakePart && !scene.takesPart(id, Effect::radar)) {
            return effect.groupCount;  // which is counted nowhere
        }
        return id.index < scene.groups.size() ? scene.groups[id.index] : 0;
    };
    RadarWatch& watch = *radar_;
    watch.counts = watch.radar.scan(scene.grid, window, effect.groupCount, groupOf);
    cost_[SceneCounter::radarScans] = 1;
    cost_[SceneCounter::cellRowsVisited] += watch.radar.lastCost().rowsVisited;
    cost_[SceneCounter::radarBoxesTested] = watch.radar.lastCost().boxesTested;
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

template class Observers<float>;
template class Observers<double>;

}  // namespace hashphase
