// SPDX-License-Identifier: Zlib
#pragma once

// Looks at the boxes of a crowded bucket, and says along which axis it is worth sorting them.

#include <broadphase/simd/kernel_types.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

template <class Scalar>
class BucketCensus {
public:
    /// Of the boxes of one bucket: boxes[i] for every i of the crowd.
    BucketCensus(std::span<const std::uint32_t> crowd, std::span<const PaddedBox<Scalar>> boxes) {
        const auto count = static_cast<double>(crowd.size());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Scalar low = boxes[crowd[0]].low[axis];
            Scalar high = low;
            double sum = 0;
            for (const std::uint32_t i : crowd) {
                low = std::min(low, boxes[i].low[axis]);
                high = std::max(high, boxes[i].low[axis]);
                sum += static_cast<double>(boxes[i].high[axis] - boxes[i].low[axis]);
            }
            const double spread = static_cast<double>(high) - static_cast<double>(low);
            share_[axis] = sum / (count * spread);
            longFrom_[axis] = static_cast<Scalar>(kLong * sum / count);
            pairs_[axis] = pairsAlong(axis, crowd, boxes);
        }
    }

    /// The axis along which the fewest of a sample of pairs are beside each other, or where boxes
    /// are shortest by how far the crowd spreads; none where a sweep spares less than half of the
    /// tests.
    [[nodiscard]] std::optional<std::uint32_t> sweepAxis() const {
        std::optional<std::uint32_t> best;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const bool isWorthIt = 2 * pairs_[axis] < kSample * (kSample - 1) / 2;
            if (isWorthIt && (!best || std::pair(pairs_[axis], share_[axis]) <
                                           std::pair(pairs_[*best], share_[*best]))) {
                best = axis;
            }
        }
        return best;
    }

    /// Whether the box is so much longer than most that it had better be tested with everyone than
    /// make everyone look that much farther: of the whole crowd, one in kLong at most. So had an inverted
    /// one, which a ray may meet before the corner by which it would be sorted.
    [[nodiscard]] bool isLong(const PaddedBox<Scalar>& box, std::size_t axis) const {
        return box.high[axis] - box.low[axis] > longFrom_[axis] || box.high[axis] < box.low[axis];
    }

    /// An edge [m] that none of these boxes exceeds along the axis, before rounding.
    [[nodiscard]] static Scalar reach(std::span<const std::uint32_t> some,
                                      std::span<const PaddedBox<Scalar>> boxes, std::size_t axis) {
        using Limits = std::numeric_limits<Scalar>;
        Scalar longest = 0;
        for (const std::uint32_t i : some) {
            longest = std::max(longest, boxes[i].high[axis] - boxes[i].low[axis]);
        }
        return longest * (1 + 4 * Limits::epsilon()) + Limits::min();
    }

private:
    static constexpr double kLong = 8;
    static constexpr std::uint32_t kSample = 48;

    static std::uint32_t pairsAlong(std::size_t axis, std::span<const std::uint32_t> crowd,
                                    std::span<const PaddedBox<Scalar>> boxes) {
        std::array<const PaddedBox<Scalar>*, kSample> sample;
        for (std::size_t k = 0; k < kSample; ++k) {
            sample[k] = &boxes[crowd[k * crowd.size() / kSample]];
        }
        std::uint32_t pairs = 0;
        for (std::size_t a = 0; a < kSample; ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                const bool beginsBefore = sample[a]->low[axis] <= sample[b]->high[axis];
                const bool endsBehind = sample[b]->low[axis] <= sample[a]->high[axis];
                pairs += static_cast<std::uint32_t>(beginsBefore & endsBehind);
            }
        }
        return pairs;
    }

    std::array<double, 3> share_{};     // mean edge by spread of the min corners
    std::array<Scalar, 3> longFrom_{};  // [m]
    std::array<std::uint32_t, 3> pairs_{};
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
