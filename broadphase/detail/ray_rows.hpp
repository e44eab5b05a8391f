// SPDX-License-Identifier: Zlib
#pragma once

// Which rows of cells a ray, or a box moved along it, can meet. Layer by layer, each from the ray's
// own equation: nothing accumulates, so a ray of a billion cells is as exact as one of ten.

#include <broadphase/detail/walk.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hashphase::detail {

/// A ray in the cell units of one level: position(t) = from + t * direction, t in [0, 1], and how
/// far below and above the position anything that it meets may be filed.
struct CellRay {
    struct Interval {
        double first = 0;
        double last = 1;
    };

    std::array<double, 3> from{};
    std::array<double, 3> direction{};
    std::array<double, 3> below{};
    std::array<double, 3> above{};

    /// False when some number overflowed or is NaN.
    [[nodiscard]] bool isFinite() const {
        double sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sum += std::abs(from[axis]) + std::abs(direction[axis]) + std::abs(below[axis]) +
                   std::abs(above[axis]);
        }
        return sum < std::numeric_limits<double>::infinity();
    }

    /// The part of `t` during which an entry filed in cells low..high of the axis can be met.
    [[nodiscard]] Interval clip(Interval t, std::size_t axis, double low, double high) const {
        low -= above[axis];
        high += below[axis];
        if (direction[axis] == 0) {
            const bool inside = low <= from[axis] && from[axis] <= high;
            return inside ? t : Interval{1, 0};
        }
        const double a = (low - from[axis]) / direction[axis];
        const double b = (high - from[axis]) / direction[axis];
        return {std::max(t.first, std::min(a, b)), std::min(t.last, std::max(a, b))};
    }

    /// The cells of the axis in which something met during `t` may be filed, first to last in the
    /// direction of the ray's motion, clamped to low..high.
    [[nodiscard]] std::array<std::int32_t, 2> cells(Interval t, std::size_t axis, std::int32_t low,
                                                    std::int32_t high) const {
        const double a = from[axis] + t.first * direction[axis];
        const double b = from[axis] + t.last * direction[axis];
        const double lowest = std::min(a, b) - below[axis];
        const double highest = std::max(a, b) + above[axis];
        const auto clamped = [low, high](double x) {
            return static_cast<std::int32_t>(
                std::clamp(x, static_cast<double>(low), static_cast<double>(high)));
        };
        return {clamped(std::ceil(lowest)), clamped(std::floor(highest))};
    }
};

template <class Scalar>
CellRay toCells(const Level<Scalar>& level, const Vector3<Scalar>& from,
                const Vector3<Scalar>& direction, const Aabb<Scalar>& fatness) {
    constexpr double epsilon = std::numeric_limits<Scalar>::epsilon();
    CellRay ray;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto scale = static_cast<double>(level.inverseCellSize[axis]);
        const auto i = static_cast<Eigen::Index>(axis);
        const auto origin = static_cast<double>(level.origin[axis]);
        const auto start = static_cast<double>(from[i]);
        ray.from[axis] = (start - origin) * scale;
        ray.direction[axis] = static_cast<double>(direction[i]) * scale;
        // Entries reach two cells up from where they are filed. The padding covers the rounding of
        // quantise() and of the exact test, both relative to the largest number in play.
        const double reach = std::abs(start) + std::abs(origin) +
                             2 * std::abs(static_cast<double>(direction[i])) +
                             std::abs(static_cast<double>(fatness.min()[i])) +
                             std::abs(static_cast<double>(fatness.max()[i]));
        const double padding = 1e-3 + 16 * epsilon * reach * scale;
        ray.below[axis] = 2 - static_cast<double>(fatness.min()[i]) * scale + padding;
        ray.above[axis] = static_cast<double>(fatness.max()[i]) * scale + padding;
    }
    return ray;
}

/// Calls visitRow(CellRun) -> bool for the rows that the ray can meet, each once, roughly from near
/// to far. Returns false, without a call, when reading the whole level is cheaper.
template <class Scalar, class VisitRow>
bool forRowsOfRay(const Level<Scalar>& level, const Vector3<Scalar>& from,
                  const Vector3<Scalar>& direction, const Aabb<Scalar>& fatness,
                  VisitRow&& visitRow) {
    const CellRay ray = toCells(level, from, direction, fatness);
    if (!ray.isFinite()) {
        return false;
    }
    CellRay::Interval whole;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        whole = ray.clip(whole, axis, level.low[axis], level.high[axis]);
    }
    if (whole.first > whole.last) {
        return true;
    }
    const auto layers = ray.cells(whole, 2, level.low[2], level.high[2]);
    const auto across = ray.cells(whole, 1, level.low[1], level.high[1]);
    const auto perLayer =
        static_cast<std::uint64_t>(std::min(ray.below[1] + ray.above[1], 1e9)) + 1;
    const std::uint64_t rows = (static_cast<std::uint64_t>(layers[1] - layers[0]) + 1) * perLayer +
                               3 * (static_cast<std::uint64_t>(across[1] - across[0]) + 1);
    if (rows * kBoxesPerRun > level.count()) {
        return false;
    }

    // Layer by layer in z, row by row in y, in the direction of the ray.
    const bool upwards = ray.direction[2] >= 0;
    const bool forwards = ray.direction[1] >= 0;
    const std::int32_t layerCount = layers[1] - layers[0] + 1;
    for (std::int32_t i = 0; i < layerCount; ++i) {
        const std::int32_t z = upwards ? layers[0] + i : layers[1] - i;
        const auto inLayer = ray.clip(whole, 2, z, z);
        if (inLayer.first > inLayer.last) {
            continue;
        }
        const auto lines = ray.cells(inLayer, 1, level.low[1], level.high[1]);
        const std::int32_t lineCount = lines[1] - lines[0] + 1;
        for (std::int32_t j = 0; j < lineCount; ++j) {
            const std::int32_t y = forwards ? lines[0] + j : lines[1] - j;
            const auto inRow = ray.clip(inLayer, 1, y, y);
            if (inRow.first > inRow.last) {
                continue;
            }
            const auto run = ray.cells(inRow, 0, level.low[0], level.high[0]);
            if (!visitRow(CellRun{y, z, run[0], run[1], inRow.first})) {
                return true;
            }
        }
    }
    return true;
}

}  // namespace hashphase::detail
