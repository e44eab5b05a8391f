// SPDX-License-Identifier: Zlib
#pragma once

// The random numbers of the scenes: the same on every platform for the same seed, which the
// standard library's distributions do not promise.

#include <cstdint>
#include <random>

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

}  // namespace hashphase::demos
