// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/ground_mesh.hpp>

#include <demos/scenes/random.hpp>

namespace hashphase::demos {

GroundMesh::GroundMesh(const Height& height, float jitter, std::uint64_t seed)
    : isRegular_(jitter == 0) {
    Random random(seed);
    for (std::uint32_t k = 0; k <= kQuads; ++k) {
        for (std::uint32_t i = 0; i <= kQuads; ++i) {
            float x = static_cast<float>(i) * kEdge - kHalf;
            float z = static_cast<float>(k) * kEdge - kHalf;
            if (i > 0 && i < kQuads && k > 0 && k < kQuads) {
                x += random.between(-jitter, jitter);
                z += random.between(-jitter, jitter);
            }
            vertices_.emplace_back(x, height(x, z), z);
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

TriangleCorners GroundMesh::corners(std::uint32_t triangle) const {
    const std::size_t first = 3 * std::size_t{triangle};
    return {vertices_[indices_[first]], vertices_[indices_[first + 1]],
            vertices_[indices_[first + 2]]};
}

Aabb<float> GroundMesh::bounds() const {
    Aabb<float> bounds;
    for (const Vector3<float>& vertex : vertices_) {
        bounds.extend(vertex);
    }
    return bounds;
}

}  // namespace hashphase::demos
