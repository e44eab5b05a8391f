// SPDX-License-Identifier: Zlib
#pragma once

// What the collision phase does with pairs and triangles once a method has found them.

#include <demos/paper/phase_method.hpp>

#include <cmath>

namespace hashphase::demos {

/// What becomes of the spheres: where they stand and how they fly on.
class SphereStates {
public:
    /// Begins a frame: nobody has met anybody.
    void begin(const TestBed& bed) {
        centres_ = bed.centres();
        before_ = bed.velocities();
        after_.assign(before_.begin(), before_.end());
        heights_.assign(centres_.size(), 0);
    }

    /// Two whose boxes overlap: if the spheres touch and approach, they exchange their speeds along
    /// the line between them, as they were when the frame began, so the order does not matter.
    void meet(std::uint32_t a, std::uint32_t b) {
        constexpr float kTouching = 2 * PaperScene::kRadius;
        const Vector3<float> between = centres_[b] - centres_[a];
        const float squared = between.squaredNorm();
        const float approach = (before_[a] - before_[b]).dot(between);
        if (squared <= kTouching * kTouching && approach > 0) {
            const Vector3<float> exchanged = between * (approach / squared);
            after_[a] -= exchanged;
            after_[b] += exchanged;
        }
    }

    /// The sphere rests on ground of that height [m].
    void stand(std::uint32_t object, float groundHeight) {
        heights_[object] = groundHeight + PaperScene::kRadius;
    }

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(after_.size()); }

    /// Of the subjects.
    [[nodiscard]] std::vector<float> numbers(const Subjects& subjects) const;

    [[nodiscard]] std::size_t memoryBytes() const {
        return after_.capacity() * sizeof(after_[0]) + heights_.capacity() * sizeof(float);
    }

private:
    std::span<const Vector3<float>> centres_;
    std::span<const Vector3<float>> before_;
    std::vector<Vector3<float>> after_;
    std::vector<float> heights_;
};

/// The height of the triangle at that place of the map, or nothing where the place is beside it. Edges
/// belong to both sides.
inline std::optional<float> heightOf(const TriangleGround& ground, std::size_t triangle, float x,
                                     float z) {
    constexpr float kEdge = 1e-5F;  // rounding must not lose a point between two triangles
    const Aabb<float>& box = ground.boxes[triangle];
    if (x < box.min().x() || x > box.max().x() || z < box.min().z() || z > box.max().z()) {
        return std::nullopt;
    }
    const auto [a, b, c] = ground.corners(triangle);
    const float abX = b.x() - a.x();
    const float abZ = b.z() - a.z();
    const float acX = c.x() - a.x();
    const float acZ = c.z() - a.z();
    const float inverseArea = 1 / (abX * acZ - abZ * acX);
    const float u = ((x - a.x()) * acZ - (z - a.z()) * acX) * inverseArea;
    const float v = (abX * (z - a.z()) - abZ * (x - a.x())) * inverseArea;
    if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge) {
        return std::nullopt;
    }
    return a.y() + u * (b.y() - a.y()) + v * (c.y() - a.y());
}

/// The height of the ground at that place of the map. No surface is vertical or above another one, so
/// the first of the triangles that has the place is the answer; 0 where none has.
template <class Triangles>
[[nodiscard]] float groundHeight(const TriangleGround& ground, const Triangles& triangles, float x,
                                 float z) {
    for (const auto triangle : triangles) {
        if (const std::optional<float> height = heightOf(ground, triangle, x, z)) {
            return *height;
        }
    }
    return 0;
}

}  // namespace hashphase::demos
