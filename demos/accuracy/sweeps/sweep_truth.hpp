// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that move during a frame, what they really touch, and when: in integers, so nothing is
// rounded, and of all pairs. It shares no code with the library.

#include <broadphase/moving_box.hpp>
#include <demos/accuracy/exact_entry.hpp>
#include <demos/compare/reference_pairs.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// Objects of one frame. The first `movers` may move while it lasts; the others never do.
struct SweptFrame {
    std::vector<MovingBox<float>> objects;
    std::uint32_t movers = 0;

    /// By axis: all coordinates are multiples of it, at the start and at the end of the frame, and
    /// below 2^24 of them. So no coordinate is rounded.
    std::array<float, 3> unit{kUnit, kUnit, kUnit};  // [m]

    static constexpr float kUnit = 0x1p-10F;
};

/// The box at the end of the frame.
[[nodiscard]] inline Aabb<float> endBox(const MovingBox<float>& moving) {
    return moving.box.translated(moving.displacement);
}

/// The box around the way. Nothing is rounded in these scenes.
[[nodiscard]] inline Aabb<float> wayBox(const MovingBox<float>& moving) {
    return moving.box.merged(endBox(moving));
}

/// When the two objects of the frame touch first, as a share of the frame; nothing when they never
/// do. Throws std::logic_error for coordinates that are no multiples of the frame's unit.
[[nodiscard]] std::optional<Fraction> exactContact(const SweptFrame& frame, std::uint32_t a,
                                                   std::uint32_t b);

struct SweepTruth {
    std::vector<PairKey> contacts;  // that begin during the frame, of one mover at least; sorted
    std::vector<Fraction> moments;  // when each begins
    std::vector<PairKey>
        older;  // that touch when the frame begins, found in the one before; sorted
};

[[nodiscard]] SweepTruth findTruth(const SweptFrame& frame);

}  // namespace hashphase::demos
