// SPDX-License-Identifier: Zlib
#pragma once

// The truth about spheres on the ground: the nearest point of all triangles, in long double.

#include <demos/accuracy/terrain/ground_mesh.hpp>

#include <array>
#include <optional>
#include <vector>

namespace hashphase::demos {

class ExactGround {
public:
    explicit ExactGround(const GroundMesh& mesh);

    /// The height of the ground below or above a point of the map; none outside.
    [[nodiscard]] std::optional<double> surface(float x, float z) const;

    /// Whether the triangle is above or below the point of the map, but for rounding of the point.
    [[nodiscard]] bool isAt(std::uint32_t triangle, float x, float z) const;

    /// How high the centre of a sphere is that rests on the ground, which has no overhangs.
    [[nodiscard]] double restingHeight(float x, float z, float radius) const;

    /// How deep a sphere with its centre there is in the ground: the radius less the distance to the
    /// nearest triangle, or plus it where the centre is below the ground; 0 where it does not touch.
    [[nodiscard]] double penetration(float x, double height, float z, float radius) const;

private:
    using Real = long double;
    using Point = Vector3<Real>;
    using Corners = std::array<Point, 3>;

    [[nodiscard]] std::vector<const Corners*> trianglesBelow(float x, float z, float radius) const;

    std::vector<Corners> triangles_;
    std::vector<Aabb<float>> boxes_;
};

}  // namespace hashphase::demos
