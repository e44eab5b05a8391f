// SPDX-License-Identifier: Zlib
#pragma once

// Ways of a ray through cells of 1 m, in the order in which it meets them. Each calls visit(cell).

#include <demos/accuracy/baselines/hashed_cells.hpp>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace hashphase::demos {

/// How a walk knows when the ray meets the next border: it adds up the time from border to border,
/// or multiplies anew from the border's number.
enum class BorderTimes : std::uint8_t { accumulated, multiplied };

/// J. Amanatides, A. Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987, in single
/// precision: one cell after another across one face each. Ends in the last cell; or, where
/// rounding has led it astray, after as many steps as there are borders, and 3.
template <class Visit>
void walkFaces(const Vector3<float>& from, const Vector3<float>& to, BorderTimes times,
               const Visit& visit) {
    const Vector3<float> direction = to - from;
    Cell cell = cellOf(from);
    const Cell last = cellOf(to);
    Cell step;
    std::array<float, 3> next;   // when the next border is met
    std::array<float, 3> delta;  // from border to border
    std::int64_t stepsLeft = 3;
    const auto timeOf = [&](std::size_t i) {
        const auto axis = static_cast<Eigen::Index>(i);
        const auto border = static_cast<float>(cell[i] + (step[i] > 0 ? 1 : 0));
        return (border - from[axis]) / direction[axis];
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const float way = direction[static_cast<Eigen::Index>(i)];
        step[i] = way < 0 ? -1 : 1;
        stepsLeft += std::abs(std::int64_t{last[i]} - cell[i]);
        next[i] = way == 0 ? std::numeric_limits<float>::infinity() : timeOf(i);
        delta[i] = way == 0 ? 0 : 1 / std::abs(way);
    }
    for (visit(cell); cell != last && stepsLeft > 0; --stepsLeft) {
        const auto i =
            static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
        cell[i] += step[i];
        next[i] = times == BorderTimes::accumulated ? next[i] + delta[i] : timeOf(i);
        visit(cell);
    }
}

/// All cells that come near the ray: layer by layer across the axis along which it is longest, in
/// each layer what lies between its two ends, in double precision and a little more on each side.
template <class Visit>
void walkLayers(const Vector3<float>& from, const Vector3<float>& to, const Visit& visit) {
    const Vector3<double> start = from.cast<double>();
    const Vector3<double> direction = to.cast<double>() - start;
    Eigen::Index along = 0;
    direction.cwiseAbs().maxCoeff(&along);
    const auto a = static_cast<std::size_t>(along);
    // Far above what rounding does to a point of the ray.
    const double margin =
        16 * std::numeric_limits<double>::epsilon() *
        std::max(start.cwiseAbs().maxCoeff(), to.cast<double>().cwiseAbs().maxCoeff());
    const auto timeAt = [&](std::int32_t border) {
        const double time = (static_cast<double>(border) - start[along]) / direction[along];
        return direction[along] == 0 ? 0 : std::clamp(time, 0.0, 1.0);
    };
    const std::int32_t last = cellOf(to)[a];
    const std::int32_t step = last < cellOf(from)[a] ? -1 : 1;
    for (std::int32_t layer = cellOf(from)[a]; layer != last + step; layer += step) {
        const Vector3<double> enters = start + timeAt(layer) * direction;
        const Vector3<double> leaves = start + timeAt(layer + 1) * direction;
        Cell low;
        Cell high;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [least, most] = std::minmax(
                {enters[static_cast<Eigen::Index>(i)], leaves[static_cast<Eigen::Index>(i)]});
            low[i] = i == a ? layer : cellAt(least - margin);
            high[i] = i == a ? layer : cellAt(most + margin);
        }
        visitCells(low, high, visit);
    }
}

}  // namespace hashphase::demos
