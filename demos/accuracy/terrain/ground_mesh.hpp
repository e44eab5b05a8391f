// SPDX-License-Identifier: Zlib
#pragma once

// Ground of triangles: a square of quads, each cut along its diagonal, with heights of many kinds.

#include <broadphase/aabb.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace hashphase::demos {

using TriangleCorners = std::array<Vector3<float>, 3>;

class GroundMesh {
public:
    static constexpr std::uint32_t kQuads = 48;  // a side
    static constexpr float kEdge = 1;            // of a quad [m]
    static constexpr float kHalf = 0.5F * kEdge * kQuads;

    /// Height [m] at x and z.
    using Height = std::function<float(float, float)>;

    /// Vertices between the borders are moved by up to `jitter` [m] along x and z, at random: with 0,
    /// what is between them is a heightfield of Bullet's.
    GroundMesh(const Height& height, float jitter, std::uint64_t seed);

    [[nodiscard]] bool isRegular() const noexcept { return isRegular_; }
    [[nodiscard]] const std::vector<Vector3<float>>& vertices() const noexcept { return vertices_; }
    [[nodiscard]] const std::vector<std::uint32_t>& indices() const noexcept { return indices_; }

    [[nodiscard]] std::uint32_t triangles() const noexcept {
        return static_cast<std::uint32_t>(indices_.size() / 3);
    }
    [[nodiscard]] TriangleCorners corners(std::uint32_t triangle) const;
    [[nodiscard]] Aabb<float> bounds() const;

private:
    bool isRegular_;
    std::vector<Vector3<float>> vertices_;
    std::vector<std::uint32_t> indices_;
};

}  // namespace hashphase::demos
