// SPDX-License-Identifier: Zlib
#pragma once

// What stands on the ground, and how cameras fly over it.

#include <demos/scenes/camera_view.hpp>
#include <demos/scenes/random.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

/// Where the camera looks, and at what.
struct CullingSetting {
    std::string name;
    float fieldOfView = 60;  // [degrees]
    float pitch = -45;       // [degrees]
    float yaw = 20;          // [degrees]
    float tallest = 10;      // [m]
    float cellSize = 10;     // [m]
};

inline constexpr int kViewsPerFlight = 8;

/// A camera that flies straight on from a random place and turns a little.
[[nodiscard]] std::vector<CameraView> flight(const CullingSetting& setting, Random& random);

/// Boxes of 1 to 3 m that stand on the ground, up to `tallest` high.
[[nodiscard]] std::vector<Aabb<float>> standingBoxes(std::size_t count, float tallest,
                                                     std::uint64_t seed);

/// Boxes above the ground, but not above `tallest`, that stay outside of the view but for a corner,
/// which lies on one of its planes as far as single precision allows: some touch it, others do not.
[[nodiscard]] std::vector<Aabb<float>> touchingBoxes(std::size_t count, float tallest,
                                                     const CameraView& view, Random& random);

}  // namespace hashphase::demos
