// SPDX-License-Identifier: Zlib
#pragma once

// P9: ways to find out how high the centre of a sphere is that stands on ground of triangles.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/terrain/ground_mesh.hpp>

#include <span>
#include <string>

namespace hashphase::demos {

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

struct GroundMethod {
    std::string name;
    std::function<GroundFinder(const GroundMesh&, float cellSize)> make;
    bool isOurs = false;
    bool mustRest = false;  // a sphere in the ground or above it, or without ground, breaks a check
    bool sinksByLine = false;  // on a slope it must be in the ground as far as theory says
    bool takesCells = false;   // the size of cells matters
    bool findsPoints = true;   // takes spheres of radius 0, and any mesh
};

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

}  // namespace hashphase::demos
