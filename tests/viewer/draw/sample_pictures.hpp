// SPDX-License-Identifier: Zlib
#pragma once

// Small worlds to draw, and an eye to see them.

#include <demos/viewer/draw/renderer.hpp>

#include <vector>

namespace hashphase::demos {

inline constexpr int kSampleWidth = 288;
inline constexpr int kSampleHeight = 180;

/// A camera at `eye` that looks at `target`, one radian high. Straight down, up on the screen is +z.
[[nodiscard]] DrawnCamera sampleCamera(const Vector3<float>& eye, const Vector3<float>& target);

/// Where the camera sees the point: x, y in pixels from the upper left corner.
[[nodiscard]] Eigen::Vector2f onScreen(const DrawnCamera& camera, const Vector3<float>& point);

/// The radius of a sphere in the middle of a sampleCamera()'s picture, so far away [pixels].
[[nodiscard]] float radiusOnScreen(float radius, float distance);

/// Hills with spheres, boxes, capsules and lines on them, and how full the cells of 8 m are.
struct SampleWorld {
    SampleWorld();

    /// The height of the hills [m].
    [[nodiscard]] static float height(float x, float z);
    /// Hills and spheres, seen from a hill.
    [[nodiscard]] Picture picture() const;
    [[nodiscard]] GroundCells cells() const;
    [[nodiscard]] HeatMap heatMap() const;

    std::vector<Vector3<float>> corners;
    std::vector<DrawnSphere> spheres;
    std::vector<DrawnBox> boxes;
    std::vector<DrawnCapsule> capsules;
    std::vector<DrawnLine> lines;
    std::vector<std::uint8_t> loads;
};

/// Everything that draws, once for all tests.
[[nodiscard]] Renderer& sampleRenderer();

[[nodiscard]] Image drawn(const Picture& picture);

}  // namespace hashphase::demos
