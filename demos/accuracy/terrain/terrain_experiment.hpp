// SPDX-License-Identifier: Zlib
#pragma once

// P9: ways to find out how high the centre of a sphere is that stands on ground of triangles.

#include <demos/accuracy/experiment.hpp>
#include <demos/scenes/terrain.hpp>

namespace hashphase::demos {

inline constexpr std::uint32_t kGroundQuads = 48;  // a side
inline constexpr float kGroundEdge = 1;            // of a quad [m]
inline constexpr float kGroundHalf = 0.5F * kGroundEdge * kGroundQuads;

/// Of the height [m] at x and z. Vertices between the borders are moved by up to `jitter` [m] along x and
/// z, at random: with 0, what is between them is a heightfield of Bullet's.
[[nodiscard]] TriangleGround groundOfHeights(const std::function<float(float, float)>& height,
                                             float jitter = 0, std::uint64_t seed = 1);

/// Spheres above the ground. Those of radius 0 are points.
struct SphereBatch {
    std::vector<Vector3<float>> centers;
    std::vector<float> radii;
};

struct Standing {
    float height = 0;                       // of the centre [m]
    std::optional<std::uint32_t> triangle;  // on which it stands, of methods that tell
};

/// A method that has filed a mesh: writes where each sphere stands when it is moved down; nothing
/// where there is no ground.
using GroundFinder = std::function<void(const SphereBatch&, std::span<std::optional<Standing>>)>;

/// must_rest      a sphere in the ground or above it, or without ground, breaks a check
/// sinks_by_line  on a slope it must be in the ground as far as theory says
/// takes_cells    the size of cells matters
/// finds_points   takes spheres of radius 0, and any mesh
using GroundMethod = Method<GroundFinder(const TriangleGround&, float cellSize)>;

/// The paper's, the library's, Bullet's.
[[nodiscard]] std::vector<GroundMethod> groundMethods();

/// How much is measured.
struct TerrainPlan {
    std::size_t spheres;  // on each ground
    std::size_t points;   // of each place
    int frames;           // that are timed
    std::size_t spheresPerFrame;
};

/// Measures, and says what it shows (terrain.sql).
[[nodiscard]] Findings findTerrain(const TerrainPlan& plan, std::uint64_t seed,
                                   std::span<const GroundMethod> methods, const TellProgress& tell);

/// The truth about spheres on the ground: the nearest point of all triangles, in long double.
class ExactGround {
public:
    explicit ExactGround(const TriangleGround& mesh);

    /// The height of the ground below or above a point of the map; none outside.
    [[nodiscard]] std::optional<double> surface(float x, float z) const;

    /// Whether the triangle is above or below the point of the map, but for rounding of the point.
    [[nodiscard]] bool isAt(std::uint32_t triangle, float x, float z) const;

    /// How high the centre of a sphere is that rests on the ground, which has no overhangs.
    [[nodiscard]] double restingHeight(float x, float z, float radius) const;

    /// How deep a sphere with its centre there is in the ground: the radius less the distance to
    /// the nearest triangle, or plus it where the centre is below the ground; 0 where it does not
    /// touch.
    [[nodiscard]] double penetration(float x, double height, float z, float radius) const;

private:
    using Corners = std::array<Vector3<long double>, 3>;

    [[nodiscard]] std::vector<const Corners*> trianglesBelow(float x, float z, float radius) const;

    std::vector<Corners> triangles_;
    std::vector<Aabb<float>> boxes_;
};

}  // namespace hashphase::demos
