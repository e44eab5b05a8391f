// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground_heights.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {

namespace {

constexpr int kMostSamples = 1024;
constexpr float kTolerance = 1e-4F;  // samples on an edge belong to both its triangles

}  // namespace

GroundHeights::GroundHeights(const GroundMesh& mesh) {
    if (mesh.indices.empty()) {
        return;
    }
    const auto squares = static_cast<float>(mesh.indices.size()) / 6;
    const int count =
        std::clamp(static_cast<int>(2 * std::lround(std::sqrt(squares))) + 1, 2, kMostSamples);
    columns_ = rows_ = count;
    corner_ = {mesh.bounds.min().x(), mesh.bounds.min().z()};
    const Eigen::Vector2f last(mesh.bounds.max().x(), mesh.bounds.max().z());
    spacing_ = ((last - corner_) / static_cast<float>(count - 1)).cwiseMax(1e-6F);
    heights_.assign(static_cast<std::size_t>(count) * count,
                    std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        sample(mesh.vertices[mesh.indices[i]].position, mesh.vertices[mesh.indices[i + 1]].position,
               mesh.vertices[mesh.indices[i + 2]].position);
    }
}

void GroundHeights::sample(const Vector3<float>& a, const Vector3<float>& b,
                           const Vector3<float>& c) {
    // In units of samples, on the level.
    const auto place = [this](const Vector3<float>& point) {
        return Eigen::Vector2f(
            (Eigen::Vector2f(point.x(), point.z()) - corner_).cwiseQuotient(spacing_));
    };
    const Eigen::Vector2f origin = place(a), u = place(b) - origin, v = place(c) - origin;
    const float area = u.x() * v.y() - u.y() * v.x();
    if (area == 0) {
        return;
    }
    const Eigen::Vector2f least = origin + u.cwiseMin(v).cwiseMin(0.0F);
    const Eigen::Vector2f most = origin + u.cwiseMax(v).cwiseMax(0.0F);
    const int lastColumn = std::min(static_cast<int>(most.x() + kTolerance), columns_ - 1);
    const int lastRow = std::min(static_cast<int>(most.y() + kTolerance), rows_ - 1);
    for (int row = static_cast<int>(std::ceil(least.y() - kTolerance)); row <= lastRow; ++row) {
        for (int column = static_cast<int>(std::ceil(least.x() - kTolerance)); column <= lastColumn;
             ++column) {
            const Eigen::Vector2f p =
                Eigen::Vector2f(static_cast<float>(column), static_cast<float>(row)) - origin;
            const float s = (p.x() * v.y() - p.y() * v.x()) / area;
            const float t = (u.x() * p.y() - u.y() * p.x()) / area;
            if (std::min({s, t, 1 - s - t}) >= -kTolerance) {
                float& height = sampleAt(column, row);
                height = std::fmax(height, a.y() + s * (b.y() - a.y()) + t * (c.y() - a.y()));
            }
        }
    }
}

std::optional<GroundHeights::Place> GroundHeights::at(float x, float z) const {
    const float column = (x - corner_.x()) / spacing_.x();
    const float row = (z - corner_.y()) / spacing_.y();
    if (!(column >= 0 && row >= 0 && column < static_cast<float>(columns_ - 1) &&
          row < static_cast<float>(rows_ - 1))) {
        return std::nullopt;
    }
    const auto i = static_cast<int>(column), k = static_cast<int>(row);
    const float s = column - static_cast<float>(i), t = row - static_cast<float>(k);
    const float* first = &heights_[static_cast<std::size_t>(k) * columns_ + i];
    const float a = first[0], b = first[1], c = first[columns_], d = first[columns_ + 1];
    const float alongX = (b - a) * (1 - t) + (d - c) * t;
    const float alongZ = (c - a) * (1 - s) + (d - b) * s;
    const float height = a + s * (b - a) + t * ((c - a) * (1 - s) + (d - b) * s);
    if (std::isnan(height)) {
        return std::nullopt;
    }
    const Vector3<float> normal(-alongX / spacing_.x(), 1, -alongZ / spacing_.y());
    return Place{height, normal.normalized()};
}

}  // namespace hashphase::demos
