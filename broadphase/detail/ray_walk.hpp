// SPDX-License-Identifier: Zlib
#pragma once

// Walks a BoxTree along a ray, from near to far.

#include <broadphase/detail/box_tree.hpp>
#include <broadphase/detail/walk.hpp>
#include <broadphase/regions.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hashphase::detail {

/// A ray as a BoxTree reads it: single precision, relative to the tree's origin, and so thick that
/// no rounding, here or in the region's key(), lets anything pass by.
template <class Scalar>
class TreeRay {
public:
    TreeRay(const RayRegion<Scalar>& ray, const std::array<double, 3>& origin) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<Eigen::Index>(axis);
            const auto a = static_cast<double>(ray.fatness().min()[i]);
            const auto b = static_cast<double>(ray.fatness().max()[i]);
            const auto at = static_cast<double>(ray.from()[i]);
            start_[axis] = at - origin[axis];
            direction_[axis] = static_cast<double>(ray.direction()[i]);
            inverse_[axis] = static_cast<double>(ray.inverse()[i]);
            low_[axis] = std::min(a, b);
            high_[axis] = std::max(a, b);
            // Of the exact test: relative to the largest number in play.
            const double reach = std::abs(at) + std::abs(origin[axis]) +
                                 2 * std::abs(direction_[axis]) + std::abs(a) + std::abs(b);
            padding_[axis] = 16 * kEpsilon * reach + kTiniest;
            reach_ = std::max(reach_, reach);
        }
        aim();
    }

    /// Makes lanes() fit a level whose bounds are at most `radius` [m] from the origin. Of a much
    /// longer ray only a part is taken, so that single precision will do. Returns false when the
    /// ray passes by.
    bool clipTo(double radius) {
        constexpr double much = 64;
        if (reach_ <= much * radius) {
            if (span_ != 1) {
                first_ = 0;
                span_ = 1;
                aim();
            }
            return true;
        }
        double first = 0;
        double last = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double low = -radius - high_[axis] - 2 * padding_[axis] - start_[axis];
            const double high = radius - low_[axis] + 2 * padding_[axis] - start_[axis];
            if (direction_[axis] == 0) {
                if (low > 0 || high < 0) {
                    return false;
                }
                continue;
            }
            const double a = low / direction_[axis];
            const double b = high / direction_[axis];
            first = std::max(first, std::min(a, b));
            last = std::min(last, std::max(a, b));
        }
        first_ = first;
        span_ = std::max(last - first, std::numeric_limits<double>::epsilon());
        aim();
        return first <= last;
    }

    [[nodiscard]] const RayLanes& lanes() const noexcept { return lanes_; }

    /// False when the numbers are too large for single precision.
    [[nodiscard]] bool isExpressible() const noexcept { return isExpressible_; }

    /// What is met at `key` of the ray is met at this t of the lanes, or sooner.
    [[nodiscard]] float lastFor(double key) const noexcept {
        const double t = (key + 16 * kEpsilon - first_) / span_;
        return static_cast<float>(std::min(t, 1.0)) * kWidened;
    }

private:
    static constexpr double kEpsilon = std::numeric_limits<Scalar>::epsilon();
    static constexpr double kFloatEpsilon = std::numeric_limits<float>::epsilon();
    static constexpr float kWidened = 1 + 16 * std::numeric_limits<float>::epsilon();
    // Below this the way along an axis counts as none; its inverse is a finite float.
    static constexpr double kTiny = 1e-36;
    static constexpr double kTiniest = 4 * kTiny;
    static constexpr double kHuge = 1 / kTiny;

    void aim() {
        double sum = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double start = start_[axis] + first_ * direction_[axis];
            const double way = span_ * direction_[axis];
            const double padding = padding_[axis] + 4 * kFloatEpsilon *
                                                        (std::abs(start) + std::abs(low_[axis]) +
                                                         std::abs(high_[axis]) + padding_[axis]);
            const auto above = static_cast<float>(start + high_[axis] + padding);
            const auto below = static_cast<float>(start + low_[axis] - padding);
            const bool isForwards = way > -kTiny;
            const bool isParallel = isForwards && way < kTiny;
            const auto i = static_cast<std::uint32_t>(axis);
            lanes_.nearColumn[axis] = isForwards ? i : i + 3;
            lanes_.farColumn[axis] = isForwards ? i + 3 : i;
            lanes_.nearOffset[axis] = isForwards ? above : below;
            lanes_.farOffset[axis] = isForwards ? below : above;
            lanes_.inverse[axis] = static_cast<float>(isParallel ? kHuge : inverse_[axis] / span_);
            lanes_.farInverse[axis] = lanes_.inverse[axis] * kWidened;
            sum += std::abs(start) + padding + std::abs(way);
        }
        isExpressible_ = sum < kHuge;
    }

    std::array<double, 3> start_{};
    std::array<double, 3> direction_{};
    std::array<double, 3> inverse_{};
    std::array<double, 3> low_{};
    std::array<double, 3> high_{};
    std::array<double, 3> padding_{};
    double reach_ = 0;
    double first_ = 0;
    double span_ = 1;
    RayLanes lanes_;
    bool isExpressible_ = false;
};

/// Offers to reader.read(slot) -> bool, false to stop, each box of the level that the ray may meet
/// up to the key reader.limit(), roughly from near to far. Returns false when stopped.
template <class Scalar, class Reader>
bool walkTreeLevel(const BoxTree& tree, const BoxTreeLevel& level, const TreeRay<Scalar>& ray,
                   QueryCost& cost, Reader&& reader) {
    struct Pending {
        float enter;
        std::uint32_t block;
    };
    // Each of at most 32 storeys leaves seven behind.
    std::array<Pending, 256> pending;
    std::uint32_t count = 1;
    pending[0] = {0, level.root};
    const RayLanes lanes = ray.lanes();
    float last = ray.lastFor(static_cast<double>(reader.limit()));
    while (count > 0) {
        const auto [enter, index] = pending[--count];
        if (enter > last) {
            continue;
        }
        const BoxBlock& block = tree.blocks()[index];
        std::array<float, kBlockWidth> enters;
        std::uint32_t mask = mayMeetMask(block, lanes, last, enters.data());
        ++cost.rowsVisited;
        if (index < level.firstInner) {
            cost.boxesTested += block.count;
            if (mask == 0) {
                continue;
            }
            for (; mask != 0; mask &= mask - 1) {
                if (!reader.read(block.below[static_cast<std::size_t>(std::countr_zero(mask))])) {
                    return false;
                }
            }
            last = ray.lastFor(static_cast<double>(reader.limit()));
            continue;
        }
        // The nearest on top.
        const std::uint32_t bottom = count;
        for (; mask != 0; mask &= mask - 1) {
            const auto k = static_cast<std::size_t>(std::countr_zero(mask));
            std::uint32_t i = count++;
            for (; i > bottom && pending[i - 1].enter < enters[k]; --i) {
                pending[i] = pending[i - 1];
            }
            pending[i] = {enters[k], block.below[k]};
        }
    }
    return true;
}

/// The same for every box of the level.
template <class Reader>
bool readWholeLevel(const BoxTree& tree, const BoxTreeLevel& level, QueryCost& cost,
                    Reader&& reader) {
    for (std::uint32_t index = level.firstBlock; index < level.firstInner; ++index) {
        const BoxBlock& block = tree.blocks()[index];
        cost.boxesTested += block.count;
        for (std::uint32_t k = 0; k < block.count; ++k) {
            if (!reader.read(block.below[k])) {
                return false;
            }
        }
    }
    return true;
}

/// walkTreeLevel() over all levels.
template <class Scalar, class Reader>
bool walkTree(const BoxTree& tree, const RayRegion<Scalar>& region, QueryCost& cost,
              Reader&& reader) {
    if (tree.levels().empty()) {
        return true;
    }
    TreeRay<Scalar> ray(region, tree.origin());
    for (const BoxTreeLevel& level : tree.levels()) {
        if (!ray.clipTo(level.radius)) {
            continue;
        }
        if (!ray.isExpressible()) {
            if (!readWholeLevel(tree, level, cost, reader)) {
                return false;
            }
            continue;
        }
        if (!walkTreeLevel(tree, level, ray, cost, reader)) {
            return false;
        }
    }
    return true;
}

}  // namespace hashphase::detail
