// SPDX-License-Identifier: Zlib
#pragma once

// A frame of observers: what each effect looks at, and what it finds.

#include <integration/effects/observers.hpp>

#include <broadphase/core/query_scope.hpp>
#include <broadphase/position_region.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>

#include <algorithm>
#include <atomic>
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

template <class Scalar>
const SceneCost& Observers<Scalar>::observe(const Scene& scene, Scalar moved,
                                            ParallelFor parallelFor) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "Observers::observe() was called from within observe(). Call it after that "
                     "returns.");
    if (detail::QueryScope::isWithin(this)) {
        return cost_;
    }
    const detail::QueryScope scope(this);
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
            watch_.tell(nameOf(phase.effect));
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
    watch.counts = {};  // scan() may free them, and then throw
    watch.counts = watch.radar.scan(scene.grid, window, effect.groupCount, groupOf);
    cost_[SceneCounter::radarScans] = 1;
    cost_[SceneCounter::cellRowsVisited] += watch.radar.lastCost().rowsVisited;
    cost_[SceneCounter::radarBoxesTested] = watch.radar.lastCost().boxesTested;
}

}  // namespace hashphase
