// SPDX-License-Identifier: Zlib
#pragma once

// Places on a Hilbert curve through a cube: places that follow one another are neighbours in space,
// so that a run of them keeps together. After C. H. Hamilton, "Compact Hilbert Indices", 2006, with
// the state of each step looked up instead of computed.

#include <array>
#include <bit>
#include <cstdint>

namespace hashphase::detail {

/// The most bits an axis that fit a place.
inline constexpr int kHilbertBits = 21;

/// The curve inside a cube of eight is Hamilton's Gray code, turned: it enters at one corner and
/// leaves along one axis, 8 * 3 states.
struct HilbertStep {
    std::uint8_t order = 0;  // of the small cube among the eight
    std::uint8_t state = 0;  // within it, times 8
};

namespace hilbert {

constexpr std::uint32_t rotatedLeft(std::uint32_t corner, std::uint32_t by) {
    return ((corner << by) | (corner >> (3 - by))) & 7;
}

constexpr std::uint32_t grayCode(std::uint32_t i) {
    return i ^ (i >> 1);
}

constexpr std::uint32_t inverseGrayCode(std::uint32_t code) {
    return code ^ (code >> 1) ^ (code >> 2);
}

/// What the curve does in the small cube `corner` where it enters at `entry` and leaves along `axis`.
constexpr HilbertStep step(std::uint32_t entry, std::uint32_t axis, std::uint32_t corner) {
    const std::uint32_t turn = (axis + 1) % 3;
    const std::uint32_t order = inverseGrayCode(rotatedLeft(corner ^ entry, (3 - turn) % 3));
    const std::uint32_t entryOfOrder = order == 0 ? 0 : grayCode(2 * ((order - 1) / 2));
    std::uint32_t axisOfOrder = 0;
    if (order != 0) {
        const std::uint32_t i = order % 2 == 0 ? order - 1 : order;
        axisOfOrder = static_cast<std::uint32_t>(std::countr_one(i)) % 3;
    }
    const std::uint32_t nextEntry = entry ^ rotatedLeft(entryOfOrder, turn);
    const std::uint32_t nextAxis = (axis + axisOfOrder + 1) % 3;
    return {static_cast<std::uint8_t>(order),
            static_cast<std::uint8_t>(8 * (nextEntry * 3 + nextAxis))};
}

using HilbertSteps = std::array<HilbertStep, 192>;  // by entry, axis and corner: 8 * 3 * 8

constexpr HilbertSteps allSteps() {
    HilbertSteps steps{};
    for (std::uint32_t i = 0; i < steps.size(); ++i) {
        steps[i] = step(i / 24, i / 8 % 3, i % 8);
    }
    return steps;
}

inline constexpr HilbertSteps kSteps = allSteps();

/// Moves bit i of the lowest 21 to bit 3 i.
constexpr std::uint64_t spreadBits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffffU;
    x = (x | x << 16) & 0x001f0000ff0000ffU;
    x = (x | x << 8) & 0x100f00f00f00f00fU;
    x = (x | x << 4) & 0x10c30c30c30c30c3U;
    return (x | x << 2) & 0x1249249249249249U;
}

}  // namespace hilbert

/// The place of the point on the curve through the cube of 2^bits points an axis: 0 to 8^bits - 1.
[[nodiscard]] constexpr std::uint64_t placeOnHilbertCurve(const std::array<std::uint32_t, 3>& point,
                                                          int bits) {
    const std::uint64_t corners = hilbert::spreadBits(point[0]) |
                                  hilbert::spreadBits(point[1]) << 1 |
                                  hilbert::spreadBits(point[2]) << 2;
    std::uint64_t place = 0;
    std::uint32_t state = 0;
    for (int shift = 3 * (bits - 1); shift >= 0; shift -= 3) {
        const HilbertStep step = hilbert::kSteps[state | ((corners >> shift) & 7)];
        place = place << 3 | step.order;
        state = step.state;
    }
    return place;
}

}  // namespace hashphase::detail
