// SPDX-License-Identifier: Zlib
#pragma once

// Looks at the boxes of crowded buckets, and says along which axis it is worth sorting them.

#include <broadphase/detail/kernel_types.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace hashphase::detail {

template <class Scalar>
class CrowdCensus {
public:
    /// Takes the boxes of one bucket: boxes[i] for every i of the crowd.
    void add(std::span<const std::uint32_t> crowd, std::span<const PaddedBox<Scalar>> boxes) {
        ++crowdCount_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            Scalar low = boxes[crowd[0]].low[axis];
            Scalar high = low;
            for (const std::uint32_t i : crowd) {
                low = std::min(low, boxes[i].low[axis]);
                high = std::max(high, boxes[i].low[axis]);
                longest_[axis] = std::max(longest_[axis], boxes[i].high[axis] - boxes[i].low[axis]);
            }
            spread_[axis] += static_cast<double>(high) - static_cast<double>(low);
        }
    }

    /// The axis along which boxes are shortest, by how far a crowd spreads; -1 where none is so much
    /// shorter that a sweep spares at least half of the tests.
    [[nodiscard]] int sweepAxis() const {
        int best = -1;
        double least = 0.25;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double share = static_cast<double>(longest_[axis]) * crowdCount_ / spread_[axis];
            if (share < least) {
                least = share;
                best = static_cast<int>(axis);
            }
        }
        return best;
    }

    /// An edge [m] that no box exceeds along the axis, before rounding.
    [[nodiscard]] Scalar reach(std::size_t axis) const {
        using Limits = std::numeric_limits<Scalar>;
        return longest_[axis] * (1 + 4 * Limits::epsilon()) + Limits::min();
    }

private:
    std::array<Scalar, 3> longest_{};
    std::array<double, 3> spread_{};  // summed over the crowds
    double crowdCount_ = 0;
};

}  // namespace hashphase::detail
