// SPDX-License-Identifier: Zlib
#pragma once

// Ways of a ray through cells of 1 m, in the order in which it meets them. Each calls visit(cell).

#include <demos/accuracy/picking/plain_cells.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace hashphase::demos {

/// How a walk knows when the ray meets the next border: it adds up the time from border to border,
/// or multiplies anew from the border's number.
enum class BorderTimes : std::uint8_t { accumulated, multiplied };

/// J. Amanatides, A. Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing", 1987, in single
/// precision: one cell after another across one face each. Ends in the last cell; or, where rounding
/// has led it astray, after as many steps as there are borders, and 3.
template <class Visit>
void walkFaces(const Vector3<float>& from, const Vector3<float>& to, BorderTimes times,
               const Visit& visit) {
    const Vector3<float> direction = to - from;
    Cell cell;
    Cell last;
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
        const auto axis = static_cast<Eigen::Index>(i);
        cell[i] = static_cast<std::int64_t>(std::floor(from[axis]));
        last[i] = static_cast<std::int64_t>(std::floor(to[axis]));
        step[i] = direction[axis] < 0 ? -1 : 1;
        stepsLeft += std::abs(last[i] - cell[i]);
        const bool isStill = direction[axis] == 0;
        next[i] = isStill ? std::numeric_limits<float>::infinity() : timeOf(i);
        delta[i] = isStill ? 0 : 1 / std::abs(direction[axis]);
    }
    for (visit(cell); cell != last && stepsLeft > 0; --stepsLeft) {
        const auto i =
            static_cast<std::size_t>(std::min_element(next.begin(), next.end()) - next.begin());
        cell[i] += step[i];
        next[i] = times == BorderTimes::accumulated ? next[i] + delta[i] : timeOf(i);
        visit(cell);
    }
}

/// All cells that come near the ray: layer by layer across the axis along which it is longest, in each
/// layer what lies between its two ends, in double precision and a little more on each side.
template <class Visit>
void walkLayers(const Vector3<float>& from, const Vector3<float>& to, const Visit& visit) {
    const Vector3<double> start = from.cast<double>();
    const Vector3<double> direction = to.cast<double>() - start;
    Eigen::Index along = 0;
    direction.cwiseAbs().maxCoeff(&along);
    const auto a = static_cast<std::size_t>(along);
    const std::size_t b = (a + 1) % 3;
    const std::size_t c = (a + 2) % 3;
    // Far above what rounding does to a point of the ray.
    const double margin =
        16 * std::numeric_limits<double>::epsilon() *
        std::max(start.cwiseAbs().maxCoeff(), to.cast<double>().cwiseAbs().maxCoeff());
    const auto cellAt = [&](std::size_t axis, double time, double side) {
        const auto i = static_cast<Eigen::Index>(axis);
        return static_cast<std::int64_t>(
            std::floor(start[i] + time * direction[i] + side * margin));
    };
    const auto first = static_cast<std::int64_t>(std::floor(from[along]));
    const auto last = static_cast<std::int64_t>(std::floor(to[along]));
    const std::int64_t step = last < first ? -1 : 1;
    const auto timeAt = [&](std::int64_t border) {
        const double time = (static_cast<double>(border) - start[along]) / direction[along];
        return direction[along] == 0 ? 0 : std::clamp(time, 0.0, 1.0);
    };
    for (std::int64_t layer = first; layer != last + step; layer += step) {
        const double t = timeAt(layer);
        const double u = timeAt(layer + 1);
        Cell cell;
        cell[a] = layer;
        const auto [lowB, highB] =
            std::minmax({cellAt(b, t, -1), cellAt(b, t, 1), cellAt(b, u, -1), cellAt(b, u, 1)});
        const auto [lowC, highC] =
            std::minmax({cellAt(c, t, -1), cellAt(c, t, 1), cellAt(c, u, -1), cellAt(c, u, 1)});
        for (cell[b] = lowB; cell[b] <= highB; ++cell[b]) {
            for (cell[c] = lowC; cell[c] <= highC; ++cell[c]) {
                visit(cell);
            }
        }
    }
}

}  // namespace hashphase::demos
