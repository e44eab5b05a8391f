// SPDX-License-Identifier: Zlib
#pragma once

// What is to be seen in one frame, as plain data: who fills it knows nothing of graphics, and who draws
// it (renderer.hpp) knows nothing of simulations.
//
// Colours  sRGB, as on screen
// Units    metres; on the screen, pixels from the upper left corner, y downwards
// Memory   views of the caller's data, which must live until the picture is drawn

#include <broadphase/aabb.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <span>

namespace hashphase::demos {

struct Colour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;
    std::uint8_t alpha = 255;

    friend bool operator==(const Colour&, const Colour&) = default;
};

struct DrawnSphere {
    Vector3<float> centre;
    float radius;
    Colour colour;
};

/// Opaque: the colour's alpha is of no account.
struct DrawnBox {
    Vector3<float> centre;
    Vector3<float> halfExtents;
    Eigen::Vector4f orientation;  // of a unit quaternion: x, y, z, w
    Colour colour;
};

struct DrawnCapsule {
    Vector3<float> from;  // centres of its ends
    Vector3<float> to;
    float radius;
    Colour colour;
};

/// In space; hidden by what stands before it, but for a faint trace where it `isOnTop`.
struct DrawnLine {
    Vector3<float> from;
    Vector3<float> to;
    Colour colour;
    bool isOnTop = false;
};

/// The ground: triangles, three corners each, two for each square of a lattice over x and z. What is drawn is
/// smooth: corners at one place share their normal.
struct DrawnGround {
    std::span<const Vector3<float>> corners;
    std::uint64_t version = 0;  // another number whenever the corners are others
};

/// Squares of one size on the ground, from `corner` towards +x and +z.
struct GroundCells {
    Eigen::Vector2f corner = Eigen::Vector2f::Zero();  // x, z
    float cellSize = 1;
};

/// How full cells are, drawn on the ground in shades of one colour.
struct HeatMap {
    GroundCells cells;
    std::uint32_t columns = 0;            // along x
    std::uint32_t rows = 0;               // along z
    std::span<const std::uint8_t> loads;  // row by row; 0 empty, 255 as full as any
};

struct DrawnCamera {
    Eigen::Matrix4f viewProjection = Eigen::Matrix4f::Identity();  // depth from 0 to 1
    Vector3<float> eye = Vector3<float>::Zero();
};

/// A rectangle that is being dragged, between two corners in any order.
struct DrawnRectangle {
    Eigen::Vector2f from;
    Eigen::Vector2f to;
};

enum class Theme : std::uint8_t { light, dark };

inline constexpr float kContactFrom = 5.5F;  // below that one hardly sees it

struct Picture {
    DrawnCamera camera;
    Theme theme = Theme::light;
    std::span<const DrawnSphere> spheres;
    std::span<const DrawnBox> boxes;
    std::span<const DrawnCapsule> capsules;
    std::span<const DrawnLine> lines;
    DrawnGround ground;
    std::optional<GroundCells> gridLines;
    std::optional<HeatMap> heatMap;
    std::optional<DrawnRectangle> rectangle;
    float leastRadius = 1;  // spheres are drawn at least so large [pixels]
    /// Spheres larger than that have a dark spot below them, on ground that is near [pixels, radius].
    float contactFrom = kContactFrom;
    /// So many columns at the left border are not drawn, as something else will cover them [pixels].
    int coveredLeft = 0;
};

}  // namespace hashphase::demos
