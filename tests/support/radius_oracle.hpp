// SPDX-License-Identifier: Zlib
#pragma once

// Who is within a radius of whom, by looking at every two agents: the definition of
// broadphase/radius_search.hpp.

#include <broadphase/geometry/unit_scale.hpp>
#include <broadphase/position_region.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {

/// An agent's neighbours, sorted, by agent.
using NeighbourLists = std::map<ProxyId, std::vector<ProxyId>>;

template <class Scalar>
[[nodiscard]] Vector3<Scalar> agentPosition(const Aabb<Scalar>& box) {
    return positionOf(box);
}

template <class Scalar>
[[nodiscard]] bool areNeighbours(const Vector3<Scalar>& a, const Vector3<Scalar>& b,
                                 Scalar radius) {
    const Scalar most = std::ldexp(Scalar(1), sizeof(Scalar) == sizeof(float) ? 60 : 480);
    const bool isOrdinary = radius >= 1 / most && radius <= most;
    const Scalar scale = isOrdinary ? Scalar(1) : detail::unitScale(radius);
    Scalar squares[3];
    for (int axis = 0; axis < 3; ++axis) {
        const Scalar way = (b[axis] - a[axis]) * scale;
        squares[axis] = way * way;
    }
    return radius >= 0 &&
           (squares[0] + squares[1]) + squares[2] <= (radius * scale) * (radius * scale);
}

/// What a RadiusSearch lists, and counts.
template <class Search>
[[nodiscard]] NeighbourLists neighbourLists(Search& search) {
    std::vector<std::uint32_t> counts(search.size());
    search.count(counts);
    NeighbourLists lists;
    search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
        std::vector<ProxyId>& list = lists[search.id(agent)];
        for (const std::uint32_t other : neighbours) {
            list.push_back(search.id(other));
        }
        std::sort(list.begin(), list.end());
        EXPECT_EQ(counts[agent], neighbours.size());
    });
    return lists;
}

/// Of all proxies that are agents.
template <class Scalar>
[[nodiscard]] NeighbourLists neighboursByBruteForce(std::span<const Placed<Scalar>> proxies,
                                                    Scalar radius) {
    std::vector<std::pair<ProxyId, Vector3<Scalar>>> agents;
    for (const Placed<Scalar>& proxy : proxies) {
        if (agentPosition(proxy.box).allFinite()) {
            agents.emplace_back(proxy.id, agentPosition(proxy.box));
        }
    }
    NeighbourLists lists;
    for (const auto& [id, position] : agents) {
        std::vector<ProxyId>& list = lists[id];
        for (const auto& [other, otherPosition] : agents) {
            if (other != id && areNeighbours(position, otherPosition, radius)) {
                list.push_back(other);
            }
        }
        std::sort(list.begin(), list.end());
    }
    return lists;
}

/// How often each group is among an agent's neighbours.
template <class GroupOf>
[[nodiscard]] std::vector<std::uint32_t> groupCounts(const std::vector<ProxyId>& neighbours,
                                                     std::uint32_t groupCount,
                                                     const GroupOf& groupOf) {
    std::vector<std::uint32_t> counts(groupCount);
    for (const ProxyId id : neighbours) {
        if (groupOf(id) < groupCount) {
            ++counts[groupOf(id)];
        }
    }
    return counts;
}

}  // namespace hashphase::test
