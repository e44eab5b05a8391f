// SPDX-License-Identifier: Zlib
#include <broadphase/hash/density_estimate.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace hashphase::detail {
namespace {

// Fewer pairs than this say little about the share.
constexpr std::uint64_t kFewPairs = 16;

// Every third bit, beginning with the lowest, is one of x.
std::uint64_t spreadBits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

}  // namespace

void DensityEstimate::measure(std::span<const std::array<double, 3>> points,
                              const std::array<double, 3>& low, const std::array<double, 3>& high) {
    std::array<double, 3> corner{};
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent = std::max(extent, high[axis] / 3 - low[axis] / 3);
    }
    // As much again on either side.
    edge_ = std::min(9 * extent, std::numeric_limits<double>::max() / 4);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        corner[axis] = low[axis] - edge_ / 3;
    }
    constexpr double cells = 1 << (kScales - 1);
    for (const AxisSet flat : {AxisSet{0b000}, AxisSet{0b010}, AxisSet{0b100}, AxisSet{0b110}}) {
        keys_.clear();
        for (const std::array<double, 3>& point : points) {
            std::uint64_t key = 0;
            bool isNear = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double cell = std::floor((point[axis] - corner[axis]) / edge_ * cells);
                isNear = isNear && cell >= 0 && cell < cells;
                if (isNear && ((flat >> axis) & 1) == 0) {
                    key |= spreadBits(static_cast<std::uint64_t>(cell)) << axis;
                }
            }
            if (isNear) {
                keys_.push_back(key);
            }
        }
        shares_[flat >> 1] = count(points.size());
    }
}

DensityEstimate::Shares DensityEstimate::count(std::size_t pointCount) {
    std::sort(keys_.begin(), keys_.end());
    // Neighbours in this order share their cells down to some scale; a run of those that share one,
    // ending here, has so many in it.
    std::array<std::uint64_t, kScales> pairs{};
    std::array<std::uint64_t, kScales> run{};
    std::size_t sharedBefore = 0;
    for (std::size_t i = 1; i < keys_.size(); ++i) {
        const auto differing = static_cast<std::size_t>(std::bit_width(keys_[i] ^ keys_[i - 1]));
        const std::size_t shared = kScales - (differing + 2) / 3;
        for (std::size_t scale = 0; scale < shared; ++scale) {
            pairs[scale] += ++run[scale];
        }
        for (std::size_t scale = shared; scale < sharedBefore; ++scale) {
            run[scale] = 0;
        }
        sharedBefore = shared;
    }
    Shares shares;
    const auto points = static_cast<double>(pointCount);
    for (std::size_t scale = 0; scale < kScales && pairs[scale] >= kFewPairs; ++scale) {
        shares.log[scale] =
            std::log2(2 * static_cast<double>(pairs[scale]) / (points * (points - 1)));
        shares.last = scale;
    }
    if (shares.last > 0) {
        shares.slope = shares.log[shares.last - 1] - shares.log[shares.last];
    }
    return shares;
}

double DensityEstimate::shareInCell(double size, AxisSet flat) const {
    if (!(size < edge_)) {
        return 1;
    }
    const Shares& shares = shares_[flat >> 1];
    const double scale = std::log2(edge_) - std::log2(size);
    const auto last = static_cast<double>(shares.last);
    if (scale >= last) {
        return std::exp2(shares.log[shares.last] - (scale - last) * shares.slope);
    }
    const auto above = static_cast<std::size_t>(scale);
    const double part = scale - static_cast<double>(above);
    return std::exp2((1 - part) * shares.log[above] + part * shares.log[above + 1]);
}

}  // namespace hashphase::detail
