// SPDX-License-Identifier: Zlib
#pragma once

// The random numbers of the scenes: the same on every platform for the same seed, which the
// standard library's distributions do not promise.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace hashphase::demos {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Uniform in [0, 1).
    [[nodiscard]] float unit() { return static_cast<float>(engine_() >> 40) * 0x1p-24F; }

    /// Uniform in [low, high).
    [[nodiscard]] float between(float low, float high) { return low + (high - low) * unit(); }

private:
    std::mt19937_64 engine_;
};

/// Each order as likely as any other.
inline void shuffle(std::vector<std::size_t>& order, Random& random) {
    for (std::size_t left = order.size(); left > 1; --left) {
        const auto other = static_cast<std::size_t>(random.unit() * static_cast<float>(left));
        std::swap(order[left - 1], order[std::min(other, left - 1)]);  // a float may round up
    }
}

}  // namespace hashphase::demos
