// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hashphase::demos {
namespace {

Aabb<float> boundsOf(std::span<const Aabb<float>> boxes) {
    Aabb<float> bounds;
    for (const Aabb<float>& box : boxes) {
        bounds.extend(box);
    }
    return bounds;
}

int cellIn(float distance, float cellSize, int count) {
    return static_cast<int>(
        std::clamp(std::floor(distance / cellSize), 0.0F, static_cast<float>(count - 1)));
}

}  // namespace

PaperMap::PaperMap(std::span<const Aabb<float>> boxes, float cellSize) : cellSize_(cellSize) {
    refile(boxes);
}

void PaperMap::refile(std::span<const Aabb<float>> boxes) {
    const Aabb<float> bounds = boundsOf(boxes);
    lowX_ = bounds.min().x();
    lowZ_ = bounds.min().z();
    width_ = 1 + static_cast<int>(bounds.sizes().x() / cellSize_);
    depth_ = 1 + static_cast<int>(bounds.sizes().z() / cellSize_);
    const auto forEachEntry = [&](const auto& visit) {
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            const Range cells = range(boxes[i].min().x(), boxes[i].min().z(), boxes[i].max().x(),
                                      boxes[i].max().z());
            for (int z = cells.lowZ; z <= cells.highZ; ++z) {
                for (int x = cells.lowX; x <= cells.highX; ++x) {
                    visit(bucketOf(x, z), i);
                }
            }
        }
    };
    // Counts first: begin_ of a bucket is where those before it end.
    begin_.assign(bucketOf(0, depth_) + 1, 0);
    forEachEntry([&](std::size_t bucket, std::uint32_t) { ++begin_[bucket + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    objects_.resize(begin_.back());
    next_.assign(begin_.begin(), begin_.end() - 1);
    forEachEntry(
        [&](std::size_t bucket, std::uint32_t object) { objects_[next_[bucket]++] = object; });
}

PaperMap::Range PaperMap::range(float lowX, float lowZ, float highX, float highZ) const {
    return {cellIn(lowX - lowX_, cellSize_, width_), cellIn(lowZ - lowZ_, cellSize_, depth_),
            cellIn(highX - lowX_, cellSize_, width_), cellIn(highZ - lowZ_, cellSize_, depth_)};
}

Aabb<float> PaperMap::square(int x, int z) const {
    const Vector3<float> low(lowX_ + cellSize_ * static_cast<float>(x), 0,
                             lowZ_ + cellSize_ * static_cast<float>(z));
    return {low, low + Vector3<float>(cellSize_, 0, cellSize_)};
}

}  // namespace hashphase::demos
