// SPDX-License-Identifier: Zlib
#pragma once

// Ground of triangles: a square of quads, each cut along its diagonal, with heights of many kinds;
// and the truth about spheres on it: the nearest point of all triangles, in long double.

#include <broadphase/aabb.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace hashphase::demos {

struct GroundMesh {
    static constexpr std::uint32_t kQuads = 48;  // a side
    static constexpr float kEdge = 1;            // of a quad [m]
    static constexpr float kHalf = 0.5F * kEdge * kQuads;

    /// Of the height [m] at x and z. Vertices between the borders are moved by up to `jitter` [m]
    /// along x and z, at random: with 0, what is between them is a heightfield of Bullet's.
    explicit GroundMesh(const std::function<float(float, float)>& height, float jitter = 0,
                        std::uint64_t seed = 1);

    [[nodiscard]] std::uint32_t triangles() const {
        return static_cast<std::uint32_t>(indices.size() / 3);
    }
    [[nodiscard]] const Vector3<float>& corner(std::uint32_t triangle, std::uint32_t i) const {
        return vertices[indices[3 * triangle + i]];
    }
    [[nodiscard]] std::vector<Aabb<float>> triangleBoxes() const;
    [[nodiscard]] Aabb<float> bounds() const;

    std::vector<Vector3<float>> vertices;
    std::vector<std::uint32_t> indices;
};

class ExactGround {
public:
    explicit ExactGround(const GroundMesh& mesh);

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
