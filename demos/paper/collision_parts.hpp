// SPDX-License-Identifier: Zlib
#pragma once

// What the collision phase does with couples and triangles once a method has found them.

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

/// The highest of the triangles at that place of the map. Edges count to both sides.
class HighestTriangle {
public:
    HighestTriangle(float x, float z) : x_(x), z_(z) {}

    void look(const std::array<Vector3<float>, 3>& corners) {
        constexpr float kEdge = 1e-5F;  // rounding must not lose a point between two triangles
        const auto& [a, b, c] = corners;
        const float abX = b.x() - a.x();
        const float abZ = b.z() - a.z();
        const float acX = c.x() - a.x();
        const float acZ = c.z() - a.z();
        const float area = abX * acZ - abZ * acX;
        const float u = ((x_ - a.x()) * acZ - (z_ - a.z()) * acX) / area;
        const float v = (abX * (z_ - a.z()) - abZ * (x_ - a.x())) / area;
        if (u >= -kEdge && v >= -kEdge && u + v <= 1 + kEdge) {
            height_ = std::max(height_, a.y() + u * (b.y() - a.y()) + v * (c.y() - a.y()));
        }
    }

    [[nodiscard]] float height() const { return height_; }

private:
    float x_;
    float z_;
    float height_ = 0;  // no ground of ours is below
};

}  // namespace hashphase::demos
