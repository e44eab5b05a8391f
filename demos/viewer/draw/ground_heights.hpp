// SPDX-License-Identifier: Zlib
#pragma once

// How high the drawn ground is at a place, to about half a triangle: near enough for shades on it.

#include <demos/viewer/draw/ground_mesh.hpp>

#include <optional>

namespace hashphase::demos {

class GroundHeights {
public:
    /// Of no ground.
    GroundHeights() = default;

    /// Samples the highest triangle at the points of a lattice, two a triangle's edge, at most
    /// 1,024 each way.
    explicit GroundHeights(const GroundMesh& mesh);

    struct Place {
        float height;
        Vector3<float> normal;  // upwards, of length one
    };

    /// Nothing where there is no ground.
    [[nodiscard]] std::optional<Place> at(float x, float z) const;

private:
    void sample(const Vector3<float>& a, const Vector3<float>& b, const Vector3<float>& c);
    [[nodiscard]] float& sampleAt(int column, int row) {
        return heights_[static_cast<std::size_t>(row) * columns_ + column];
    }

    Eigen::Vector2f corner_ = Eigen::Vector2f::Zero();   // x, z of the first sample
    Eigen::Vector2f spacing_ = Eigen::Vector2f::Ones();  // of samples [m]
    int columns_ = 0;
    int rows_ = 0;
    std::vector<float> heights_;  // NaN where there is no ground
};

}  // namespace hashphase::demos
