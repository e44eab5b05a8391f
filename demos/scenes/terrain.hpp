// SPDX-License-Identifier: Zlib
#pragma once

// A random landscape of gentle hills: value noise, smooth and without end.

#include <cstdint>

namespace hashphase::demos {

class Terrain {
public:
    /// The same seed gives the same hills on every machine.
    explicit Terrain(std::uint64_t seed) : seed_(seed) {}

    /// Height [m] above the point (x, z) [m]; lies between 0 and kHighest and is continuous.
    [[nodiscard]] float height(float x, float z) const;

    static constexpr float kHighest = 14;

private:
    [[nodiscard]] float noise(float x, float z, std::uint32_t octave) const;
    [[nodiscard]] float latticeValue(std::int32_t i, std::int32_t k, std::uint32_t octave) const;

    std::uint64_t seed_;
};

}  // namespace hashphase::demos
