// SPDX-License-Identifier: Zlib
#pragma once

// Hills of triangles that may be dug, how wrong an answer about them is, and Bullet's shapes of them.

#include <demos/scenes/terrain.hpp>
#include <integration/bullet/conversions.hpp>
#include <tests/support/terrain_oracle.hpp>

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace hashphase::benchmarks {

/// Where hills have been dug.
struct DugHills {
    Aabb<float> bounds;  // of what was there and of what is
    std::vector<std::uint32_t> vertices = {};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> triangles =
        {};  // runs: first, and how many
};

/// Hills over a square: 160 x 160 quads of 2.5 m, in two triangles each.
class HillMesh {
public:
    static constexpr std::uint32_t kQuads = 160;  // a side
    static constexpr float kEdge = 2.5F;          // [m]
    static constexpr float kHalf = 0.5F * kQuads * kEdge;
    static constexpr std::uint32_t kDugQuads = 12;  // a side
    static constexpr double kTolerance = 0.01;      // [m]

    explicit HillMesh(std::uint64_t seed) : hills_(seed) {
        for (std::uint32_t k = 0; k <= kQuads; ++k) {
            for (std::uint32_t i = 0; i <= kQuads; ++i) {
                const float x = static_cast<float>(i) * kEdge - kHalf;
                const float z = static_cast<float>(k) * kEdge - kHalf;
                vertices_.emplace_back(x, hills_.height(x, z), z);
            }
        }
        for (std::uint32_t k = 0; k < kQuads; ++k) {
            for (std::uint32_t i = 0; i < kQuads; ++i) {
                // Along the diagonal that a heightfield of Bullet's takes.
                const std::uint32_t a = k * (kQuads + 1) + i;
                const std::uint32_t b = a + 1;
                const std::uint32_t c = a + kQuads + 1;
                indices_.insert(indices_.end(), {a, c, b, b, c, c + 1});
            }
        }
    }

    [[nodiscard]] const std::vector<Vector3<float>>& vertices() const noexcept { return vertices_; }
    [[nodiscard]] const std::vector<std::uint32_t>& indices() const noexcept { return indices_; }

    /// Makes a round hole of `depth` [m], or a mound, in kDugQuads x kDugQuads quads from the one with these numbers
    /// on; what was dug there before is filled first.
    [[nodiscard]] DugHills dig(std::uint32_t firstI, std::uint32_t firstK, float depth) {
        DugHills dug;
        constexpr float middle = 0.5F * kDugQuads;
        for (std::uint32_t k = firstK; k < firstK + kDugQuads; ++k) {
            dug.triangles.emplace_back(2 * (k * kQuads + firstI), 2 * kDugQuads);
            for (std::uint32_t i = firstI; i < firstI + kDugQuads && k > firstK; ++i) {
                const float apart = std::hypot(static_cast<float>(i - firstI) - middle,
                                               static_cast<float>(k - firstK) - middle);
                if (apart < middle) {  // the rim stays: triangles beyond have it, too
                    const std::uint32_t vertex = k * (kQuads + 1) + i;
                    Vector3<float>& at = vertices_[vertex];
                    dug.bounds.extend(at);
                    at[1] = hills_.height(at[0], at[2]) - depth * (1 - apart / middle);
                    dug.bounds.extend(at);
                    dug.vertices.push_back(vertex);
                }
            }
        }
        return dug;
    }

    /// How far `height` is from what is exact for a sphere, radius 0 for the surface [m].
    // On hills without overhangs, a sphere rests where the nearest point of all is the radius away.
    [[nodiscard]] double error(const Vector3<float>& center, float radius, float height) const {
        const auto quadAt = [](float x) {
            const float quad = std::floor((x + kHalf) / kEdge);
            return static_cast<std::uint32_t>(
                std::clamp(quad, 0.0F, static_cast<float>(kQuads - 1)));
        };
        const test::RealPoint at(static_cast<test::Real>(center[0]),
                                 static_cast<test::Real>(height),
                                 static_cast<test::Real>(center[2]));
        test::Real nearest = std::numeric_limits<test::Real>::infinity();
        for (std::uint32_t k = quadAt(center[2] - radius); k <= quadAt(center[2] + radius); ++k) {
            for (std::uint32_t i = quadAt(center[0] - radius); i <= quadAt(center[0] + radius);
                 ++i) {
                for (const std::uint32_t half : {0U, 1U}) {
                    const test::RealTriangle corners = triangle(2 * (k * kQuads + i) + half);
                    const auto surface = test::surfaceOf(corners, at);
                    if (surface.claim != test::Claim::no && surface.height > at[1] + kTolerance) {
                        return static_cast<double>(surface.height - at[1]);  // sunk in
                    }
                    nearest = std::min(nearest, (test::nearestPoint(corners, at) - at).norm());
                }
            }
        }
        return static_cast<double>(std::abs(nearest - static_cast<test::Real>(radius)));
    }

private:
    [[nodiscard]] test::RealTriangle triangle(std::uint32_t number) const {
        test::RealTriangle corners;
        for (std::size_t i = 0; i < 3; ++i) {
            corners[i] = vertices_[indices_[3 * number + i]].cast<test::Real>();
        }
        return corners;
    }

    demos::Terrain hills_;
    std::vector<Vector3<float>> vertices_;
    std::vector<std::uint32_t> indices_;
};

/// Of a ray at a shape.
struct ClosestTriangle : btTriangleRaycastCallback {
    using btTriangleRaycastCallback::btTriangleRaycastCallback;
    btScalar reportHit(const btVector3& /*normal*/, btScalar fraction, int /*part*/,
                       int /*index*/) override {
        return fraction;
    }
};

class HeightfieldGround {
public:
    explicit HeightfieldGround(const HillMesh& mesh) {
        for (const Vector3<float>& vertex : mesh.vertices()) {
            ground_.push_back(vertex[1]);
        }
        constexpr int side = HillMesh::kQuads + 1;
        // From -20 to 20, so that its middle is at 0.
        const float* heights = ground_.data();
        shape_.emplace(side, side, heights, btScalar(-20), btScalar(20), 1, false);
        shape_->setLocalScaling({HillMesh::kEdge, 1, HillMesh::kEdge});
        shape_->buildAccelerator();
    }
    void dig(const HillMesh& mesh, const DugHills& dug) {
        for (const std::uint32_t vertex : dug.vertices) {
            ground_[vertex] = mesh.vertices()[vertex][1];
        }
        shape_->buildAccelerator();
    }
    btScalar fractionOf(const btVector3& from, const btVector3& to, float /*radius*/) {
        ClosestTriangle closest(from, to);
        shape_->performRaycast(&closest, from, to);
        return closest.m_hitFraction;
    }

private:
    std::vector<float> ground_;
    std::optional<btHeightfieldTerrainShape> shape_;
};

struct MeshGround {
    explicit MeshGround(const HillMesh& mesh)
        : vertices(mesh.vertices()),
          indices(mesh.indices().begin(), mesh.indices().end()),
          array(static_cast<int>(indices.size() / 3), indices.data(), 3 * sizeof(int),
                static_cast<int>(vertices.size()), vertices.data()->data(), sizeof(Vector3<float>)),
          shape(&array, true, {-HillMesh::kHalf, -20, -HillMesh::kHalf},
                {HillMesh::kHalf, 20, HillMesh::kHalf}) {}

    void dig(const HillMesh& mesh, const DugHills& dug) {
        for (const std::uint32_t vertex : dug.vertices) {
            vertices[vertex] = mesh.vertices()[vertex];
        }
        shape.partialRefitTree(toBullet(dug.bounds.min()), toBullet(dug.bounds.max()));
    }
    btScalar fractionOf(const btVector3& from, const btVector3& to, float /*radius*/) {
        ClosestTriangle closest(from, to);
        shape.performRaycast(&closest, from, to);
        return closest.m_hitFraction;
    }

    std::vector<Vector3<float>> vertices;
    std::vector<int> indices;
    btTriangleIndexVertexArray array;
    btBvhTriangleMeshShape shape;
};

}  // namespace hashphase::benchmarks
