// SPDX-License-Identifier: Zlib
#pragma once

// A ray as a BoxTree reads it: in single precision, relative to the tree's origin, and so thick that
// no rounding, here or in the region's key(), lets it pass by what key() finds.

#include <broadphase/regions.hpp>
#include <broadphase/simd/ray_types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

template <class Scalar>
class TreeRay {
public:
    /// The region must not be empty. `origin` [m] is what the tree's bounds are relative to.
    // cppcheck-suppress uninitMemberVar
    TreeRay(const RayRegion<Scalar>& ray, const std::array<double, 3>& origin) {
        Scalar sum = 0;  // NaN when a number is
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<Eigen::Index>(axis);
            const Scalar from = ray.from()[i];
            const auto zero = static_cast<Scalar>(origin[axis]);
            const Scalar a = ray.fatness().min()[i];
            const Scalar b = ray.fatness().max()[i];
            start_[axis] = from - zero;
            way_[axis] = ray.direction()[i];
            inverse_[axis] = 1 / way_[axis];
            low_[axis] = std::min(a, b);
            high_[axis] = std::max(a, b);
            // Of the exact test: relative to the largest number in play.
            const Scalar reach = std::abs(from) + std::abs(zero) + 2 * std::abs(way_[axis]) +
                                 std::abs(a) + std::abs(b);
            padding_[axis] = 16 * kEpsilon * reach + static_cast<Scalar>(kTiniest);
            sum += reach;
            aim<Scalar>(axis, start_[axis], inverse_[axis]);
        }
        reach_ = static_cast<double>(sum);
    }

    /// Makes lanes() fit bounds that are at most `radius` [m] from the origin. Of a much longer ray
    /// only the part near them is taken, so that single precision will do. Returns false when the
    /// ray passes them by.
    bool clipTo(double radius) {
        constexpr double much = 64;
        if (!std::isfinite(reach_)) {
            isExpressible_ = false;
            return true;
        }
        if (reach_ <= much * radius) {
            if (isClipped_) {
                isClipped_ = false;
                first_ = 0;
                span_ = 1;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    aim<Scalar>(axis, start_[axis], inverse_[axis]);
                }
            }
            isExpressible_ = reach_ < kHuge;
            return true;
        }
        return clip(radius);
    }

    /// The ray between 0 and 1, for kernels.
    [[nodiscard]] const RayLanes& lanes() const noexcept { return lanes_; }

    /// False when a number is too large for single precision, or NaN; lanes() mean nothing then.
    [[nodiscard]] bool isExpressible() const noexcept { return isExpressible_; }

    /// What the region meets at `key` or sooner, the lanes meet at this or sooner.
    [[nodiscard]] float lastFor(double key) const noexcept {
        const double last = (key + 16 * static_cast<double>(kEpsilon) - first_) / span_;
        return static_cast<float>(std::clamp(last, -1.0, 1.0)) * kWidened;
    }

private:
    static constexpr Scalar kEpsilon = std::numeric_limits<Scalar>::epsilon();
    static constexpr float kFloatEpsilon = std::numeric_limits<float>::epsilon();
    static constexpr float kWidened = 1 + 16 * kFloatEpsilon;
    // A way shorter than this counts as none: its inverse is a finite float, and the padding is more.
    static constexpr double kTiny = 1e-36;
    static constexpr double kTiniest = 4 * kTiny;
    static constexpr double kHuge = 1 / kTiny;

    template <class Number>
    void aim(std::size_t axis, Number start, Number inverse) {
        const auto low = static_cast<Number>(low_[axis]);
        const auto high = static_cast<Number>(high_[axis]);
        const auto padding = static_cast<Number>(padding_[axis]);
        const Number more = padding + 4 * static_cast<Number>(kFloatEpsilon) *
                                          (std::abs(start) + std::abs(low) + std::abs(high));
        lanes_.offset[axis] = static_cast<float>(start + high + more);
        lanes_.offset[axis + 3] = static_cast<float>(start + low - more);
        constexpr auto huge = static_cast<Number>(kHuge);
        lanes_.inverse[axis] = static_cast<float>(std::clamp(inverse, -huge, huge));
        lanes_.farInverse[axis] = lanes_.inverse[axis] * kWidened;
        const auto column = static_cast<std::uint32_t>(axis);
        const std::uint32_t backwards = std::signbit(inverse) ? 3 : 0;
        lanes_.nearColumn[axis] = column + backwards;
        lanes_.farColumn[axis] = column + 3 - backwards;
    }

    bool clip(double radius) {
        double first = 0;
        double last = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double spare = radius + 2 * static_cast<double>(padding_[axis]);
            const auto start = static_cast<double>(start_[axis]);
            const auto way = static_cast<double>(way_[axis]);
            const double lowest = -spare - static_cast<double>(high_[axis]) - start;
            const double highest = spare - static_cast<double>(low_[axis]) - start;
            if (way == 0) {
                if (lowest > 0 || highest < 0) {
                    return false;
                }
                continue;
            }
            first = std::max(first, std::min(lowest / way, highest / way));
            last = std::min(last, std::max(lowest / way, highest / way));
        }
        isClipped_ = true;
        first_ = first;
        span_ = std::max(last - first, std::numeric_limits<double>::epsilon());
        double reach = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto way = static_cast<double>(way_[axis]);
            const double there = static_cast<double>(start_[axis]) + first * way;
            aim<double>(axis, there, 1 / (span_ * way));
            reach +=
                std::abs(there) + std::abs(span_ * way) +
                static_cast<double>(padding_[axis] + std::abs(low_[axis]) + std::abs(high_[axis]));
        }
        isExpressible_ = reach < kHuge;
        return first <= last;
    }

    std::array<Scalar, 3> start_;
    std::array<Scalar, 3> way_;
    std::array<Scalar, 3> inverse_;
    std::array<Scalar, 3> low_;
    std::array<Scalar, 3> high_;
    std::array<Scalar, 3> padding_;
    double reach_;
    // The lanes' 0 and 1 are the ray's first_ and first_ + span_.
    double first_ = 0;
    double span_ = 1;
    bool isClipped_ = false;
    bool isExpressible_ = true;
    RayLanes lanes_;
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
