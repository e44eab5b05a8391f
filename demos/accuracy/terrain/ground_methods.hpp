// SPDX-License-Identifier: Zlib
#pragma once

// Ways to find out how high the centre of a sphere is that stands on ground of triangles.

#include <demos/accuracy/terrain/ground_mesh.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Spheres above the ground. Those of radius 0 are points.
struct SphereBatch {
    std::vector<Vector3<float>> centers;
    std::vector<float> radii;

    [[nodiscard]] std::size_t size() const noexcept { return centers.size(); }
};

struct Standing {
    static constexpr std::uint32_t kUntold = ~std::uint32_t{0};

    float height = 0;                  // of the centre [m]
    std::uint32_t triangle = kUntold;  // on which it stands
};

/// A method that has filed a mesh.
class GroundFinder {
public:
    GroundFinder() = default;
    GroundFinder(const GroundFinder&) = delete;
    GroundFinder& operator=(const GroundFinder&) = delete;
    virtual ~GroundFinder() = default;

    /// Writes where each sphere stands when it is moved down; nothing where there is no ground.
    virtual void find(const SphereBatch& spheres, std::span<std::optional<Standing>> found) = 0;
};

struct GroundMethod {
    std::string name;
    bool isOurs = false;
    bool mustRest = false;  // a sphere in the ground or above it, or without ground, breaks a check
    bool sinksByLine = false;   // on a slope it must be in the ground as far as theory says
    bool takesCells = false;    // the size of cells matters
    bool needsRegular = false;  // of the mesh
    bool findsPoints = true;    // takes spheres of radius 0
    std::function<std::unique_ptr<GroundFinder>(const GroundMesh&, float cellSize)> make;
};

/// The paper's, then the library's.
[[nodiscard]] std::vector<GroundMethod> gridGroundMethods();

[[nodiscard]] std::vector<GroundMethod> bulletGroundMethods();

/// All of them.
[[nodiscard]] std::vector<GroundMethod> groundMethods();

}  // namespace hashphase::demos
