// SPDX-License-Identifier: Zlib
#pragma once

// A random landscape of gentle hills, smooth and without end; and ground of triangles.

#include <broadphase/aabb.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// Height [m] of a ground at (x, z) [m]; finite. An empty function: no ground.
using GroundHeight = std::function<float(float x, float z)>;

/// Value noise.
class Terrain {
public:
    /// The same seed gives the same hills on every machine.
    explicit Terrain(std::uint64_t seed) : seed_(seed) {}

    /// Height [m] above the point (x, z) [m]; lies between 0 and kHighest and is continuous.
    [[nodiscard]] float height(float x, float z) const;

    static constexpr float kHighest = 14;

private:
    [[nodiscard]] float noise(float x, float z, std::uint32_t octave) const;
    [[nodiscard]] float latticeValue(std::int32_t i, std::int32_t k, std::uint32_t octave) const;

    std::uint64_t seed_;
};

/// A square of quads, each cut along its diagonal, the one that a heightfield of Bullet's takes.
struct TriangleGround {
    /// So many quads a side; the vertices are vertexAt(i, k), row after row from 0 to `quads`.
    TriangleGround(std::uint32_t quads,
                   const std::function<Vector3<float>(std::uint32_t i, std::uint32_t k)>& vertexAt);

    [[nodiscard]] const Vector3<float>& corner(std::size_t triangle, std::size_t i) const {
        return vertices[indices[3 * triangle + i]];
    }
    [[nodiscard]] Aabb<float> bounds() const;

    /// How high the triangle is at that place of the map [m]; nothing beside it, but for so small a share
    /// of its edges.
    [[nodiscard]] std::optional<float> heightAt(std::size_t triangle, float x, float z,
                                                float share = 0) const {
        const Vector3<float>& a = corner(triangle, 0);
        const Vector3<float> ab = corner(triangle, 1) - a;
        const Vector3<float> ac = corner(triangle, 2) - a;
        const float fromX = x - a.x();
        const float fromZ = z - a.z();
        const float area = ab.x() * ac.z() - ab.z() * ac.x();
        const float u = (fromX * ac.z() - fromZ * ac.x()) / area;
        const float v = (ab.x() * fromZ - ab.z() * fromX) / area;
        return u >= -share && v >= -share && u + v <= 1 + share
                   ? std::optional(a.y() + u * ab.y() + v * ac.y())
                   : std::nullopt;
    }

    std::vector<Vector3<float>> vertices;
    std::vector<std::uint32_t> indices;  // three a triangle
    std::vector<Aabb<float>> boxes;      // of the triangles
};

}  // namespace hashphase::demos
