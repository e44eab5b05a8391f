// SPDX-License-Identifier: Zlib
#pragma once

// What agents must be told, found by looking at everybody.

#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <tests/support/position_oracles.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace hashphase {

// For GoogleTest.
inline void PrintTo(const ZoneId& id, std::ostream* out) {
    *out << "zone " << id.index << '#' << id.generation;
}
inline void PrintTo(const ZoneEvent& event, std::ostream* out) {
    PrintTo(event.zone, out);
    *out << ": ";
    PrintTo(event.proxy, out);
}

}  // namespace hashphase

namespace hashphase::test {

template <class Scalar>
bool hasLineOfSightByBruteForce(std::span<const Placed<Scalar>> proxies,
                                const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                                ProxyFilter blockers = acceptAll, ProxyId viewer = {},
                                ProxyId target = {}) {
    const RayRegion<Scalar> line(from, to);
    return !line.isEmpty() &&
           std::none_of(proxies.begin(), proxies.end(), [&](const Placed<Scalar>& proxy) {
               const Scalar key = line.key(proxy.box);
               return key > 0 && key < 1 && proxy.id != viewer && proxy.id != target &&
                      blockers(proxy.id);
           });
}

template <class Scalar>
void visibleFromByBruteForce(std::span<const Placed<Scalar>> proxies, const Viewer<Scalar>& viewer,
                             std::vector<ProxyId>& seen, ProxyFilter targets = acceptAll,
                             ProxyFilter blockers = acceptAll) {
    const SightRegion<Scalar> view(viewer);
    seen.clear();
    for (const Placed<Scalar>& proxy : proxies) {
        if (view.key(proxy.box) >= 0 && proxy.id != viewer.self && targets(proxy.id) &&
            hasLineOfSightByBruteForce(proxies, viewer.eye, positionOf(proxy.box), blockers,
                                       viewer.self, proxy.id)) {
            seen.push_back(proxy.id);
        }
    }
    std::sort(seen.begin(), seen.end());
}

/// Zones, with one set of all pairs of a zone and an occupant.
template <class Scalar>
class ZonesByBruteForce {
public:
    struct Events {
        std::vector<ZoneEvent> entered;
        std::vector<ZoneEvent> stayed;
        std::vector<ZoneEvent> left;
    };

    void set(ZoneId id, const Zone<Scalar>& zone) {
        remove(id);
        zones_.emplace_back(id, zone);
    }
    void remove(ZoneId id) {
        std::erase_if(zones_, [id](const auto& zone) { return zone.first == id; });
    }

    [[nodiscard]] static bool isIn(const Zone<Scalar>& zone, const Aabb<Scalar>& box) {
        const auto hasKey = [&zone](const Aabb<Scalar>& of) {
            return std::visit([&of](const auto& region) { return region.key(of); }, zone.shape) >=
                   0;
        };
        const Vector3<Scalar> position = positionOf(box);
        return hasKey(box) && (zone.presence == Presence::box || hasKey({position, position}));
    }

    Events update(std::span<const Placed<Scalar>> proxies, ZoneFilter filter = acceptAllInZones) {
        std::set<ZoneEvent> now;
        for (const auto& [id, zone] : zones_) {
            for (const Placed<Scalar>& proxy : proxies) {
                if (isIn(zone, proxy.box) && filter(id, proxy.id)) {
                    now.insert({id, proxy.id});
                }
            }
        }
        Events events;
        std::set_difference(now.begin(), now.end(), occupied_.begin(), occupied_.end(),
                            std::back_inserter(events.entered));
        std::set_intersection(now.begin(), now.end(), occupied_.begin(), occupied_.end(),
                              std::back_inserter(events.stayed));
        std::set_difference(occupied_.begin(), occupied_.end(), now.begin(), now.end(),
                            std::back_inserter(events.left));
        occupied_ = std::move(now);
        return events;
    }

    [[nodiscard]] std::vector<ProxyId> occupants(ZoneId id) const {
        std::vector<ProxyId> occupants;
        for (const ZoneEvent& event : occupied_) {
            if (event.zone == id) {
                occupants.push_back(event.proxy);
            }
        }
        return occupants;
    }

    [[nodiscard]] std::span<const std::pair<ZoneId, Zone<Scalar>>> zones() const { return zones_; }

private:
    std::vector<std::pair<ZoneId, Zone<Scalar>>> zones_;
    std::set<ZoneEvent> occupied_;
};

/// Radar::scan() cell by cell: each cell counts those whose number of cells along each axis is its
/// own.
template <class Scalar>
std::vector<std::uint32_t> scanByBruteForce(std::span<const Placed<Scalar>> proxies,
                                            const RadarWindow<Scalar>& window,
                                            std::uint32_t groupCount, RadarGroups groupOf) {
    std::vector<std::uint32_t> counts;
    const int upAxis = static_cast<int>(window.up);
    const int columnAxis = upAxis == 0 ? 1 : 0;
    const int rowAxis = 3 - columnAxis - upAxis;
    const Scalar size = window.cellSize;
    const auto isIn = [&](const Vector3<Scalar>& position, int axis, Scalar along,
                          std::uint32_t count, std::uint32_t number) {
        if (window.heading.has_value()) {
            return std::floor(along / size + static_cast<Scalar>(count) / 2) ==
                   static_cast<Scalar>(number);
        }
        const Scalar first =
            std::floor(window.center[axis] / size) - static_cast<Scalar>(count / 2);
        return std::floor(position[axis] / size) - first == static_cast<Scalar>(number);
    };
    const bool isOff = !(size > 0) || std::isinf(size) || !window.center.allFinite() ||
                       !std::isfinite(window.heading.value_or(0));
    for (std::uint32_t group = 0; group < groupCount; ++group) {
        for (std::uint32_t layer = 0; layer < std::max(window.layers, 1U); ++layer) {
            for (std::uint32_t row = 0; row < window.rows; ++row) {
                for (std::uint32_t column = 0; column < window.columns; ++column) {
                    counts.push_back(0);
                    for (const Placed<Scalar>& proxy : proxies) {
                        const Vector3<Scalar> position = positionOf(proxy.box);
                        const Vector3<Scalar> offset = position - window.center;
                        const Scalar cosine = std::cos(window.heading.value_or(0));
                        const Scalar sine = std::sin(window.heading.value_or(0));
                        const Scalar x = offset[columnAxis];
                        const Scalar z = offset[rowAxis];
                        const bool isHere =
                            !isOff && position.allFinite() && groupOf(proxy.id) == group &&
                            isIn(position, columnAxis, cosine * x - sine * z, window.columns,
                                 column) &&
                            isIn(position, rowAxis, sine * x + cosine * z, window.rows, row) &&
                            (window.layers == 0 ||
                             isIn(position, upAxis, offset[upAxis], window.layers, layer));
                        counts.back() += isHere ? 1 : 0;
                    }
                }
            }
        }
    }
    return counts;
}

}  // namespace hashphase::test
