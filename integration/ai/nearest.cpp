// SPDX-License-Identifier: Zlib
#include <integration/ai/nearest.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hashphase {
namespace {

// What a row of cells costs, in tests of boxes.
constexpr std::uint64_t kTestsPerRow = 4;

}  // namespace

template <class Scalar>
QueryCost findNearest(const Grid<Scalar>& grid, const Vector3<std::type_identity_t<Scalar>>& point,
                      std::size_t count, std::type_identity_t<Scalar> maximalDistance,
                      std::vector<KeyedProxy<Scalar>>& nearest, ProxyFilter filter, ProxyId self) {
    using Limits = std::numeric_limits<Scalar>;
    QueryCost cost;
    nearest.clear();
    if (count == 0 || !(maximalDistance >= 0) || !point.allFinite()) {
        return cost;
    }
    const auto isWanted = [&](ProxyId id) { return id != self && filter(id); };
    // So large that its square is an ordinary number.
    const Scalar smallest = std::ldexp(Scalar(1), Limits::min_exponent / 2 + 4);
    Scalar radius = std::max(grid.cellSize(), smallest);
    while (true) {
        // Smaller balls would find too few, or have cost as much as reading everything.
        const bool isLast = !(radius < maximalDistance) || count >= grid.size() ||
                            cost.boxesTested + kTestsPerRow * cost.rowsVisited >= grid.size();
        radius = isLast ? maximalDistance : radius;
        CollectNearest<Scalar> collector(count, nearest);
        CollectIf accepted(collector, isWanted);
        cost += grid.visit(PositionRegion<Scalar>(point, radius), accepted);
        // Who is outside the ball is farther away than any of these; but squares that overflow are
        // equal, and those are told apart by ids.
        const bool isEnough = nearest.size() == count && std::isfinite(nearest.front().key);
        if (isLast || isEnough) {
            collector.sort();
            return cost;
        }
        radius *= 2;
    }
}

template QueryCost findNearest(const Grid<float>&, const Vector3<float>&, std::size_t, float,
                               std::vector<KeyedProxy<float>>&, ProxyFilter, ProxyId);
template QueryCost findNearest(const Grid<double>&, const Vector3<double>&, std::size_t, double,
                               std::vector<KeyedProxy<double>>&, ProxyFilter, ProxyId);

}  // namespace hashphase
