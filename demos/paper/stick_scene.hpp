// SPDX-License-Identifier: Zlib
#pragma once

// Bodies that are not round: sticks that turn in space, and the volumes around them.

#include <broadphase/aabb.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

/// A capsule.
struct Stick {
    static constexpr float kHalfLength = 1.8F;  // of the line within [m]
    static constexpr float kRadius = 0.2F;      // [m]

    Vector3<float> centre;
    std::array<Vector3<float>, 3> axes;  // at right angles, the first one along the stick
};

class StickScene {
public:
    /// In a cube with 30 m^3 for each.
    StickScene(std::uint32_t sticks, std::uint64_t seed);

    /// Turns each about an axis of its own.
    void advance();

    [[nodiscard]] std::span<const Stick> sticks() const { return sticks_; }

private:
    std::vector<Stick> sticks_;
    std::vector<Vector3<float>> turns_;
};

// Volumes are larger than the stick by a rounding error, so that none leaves out what touches.

enum class VolumeKind : std::uint8_t { sphere, aabb, obb };

/// The box of the volume around the stick, which is filed.
[[nodiscard]] Aabb<float> boxOf(VolumeKind kind, const Stick& stick);

/// Whether the volumes around the two sticks overlap; their boxes do.
[[nodiscard]] bool volumesOverlap(VolumeKind kind, const Stick& a, const Stick& b);

/// Whether the sticks touch: the exact test.
[[nodiscard]] bool sticksTouch(const Stick& a, const Stick& b);

}  // namespace hashphase::demos
