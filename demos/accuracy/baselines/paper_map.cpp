// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>

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

int cellsAlong(float side, float cellSize) {
    return static_cast<int>(std::max(1.0F, std::ceil(side / cellSize)));
}

}  // namespace

PaperMap::PaperMap(const Aabb<float>& domain, float cellSize)
    : cellSize_(cellSize),
      conversionFactor_(1 / cellSize),
      lowX_(domain.min().x()),
      lowZ_(domain.min().z()),
      width_(cellsAlong(domain.sizes().x(), cellSize)),
      depth_(cellsAlong(domain.sizes().z(), cellSize)),
      lastX_(static_cast<float>(width_ - 1)),
      lastZ_(static_cast<float>(depth_ - 1)) {
    fillBuckets();
}

PaperMap::PaperMap(std::span<const Aabb<float>> boxes, float cellSize)
    : PaperMap(boundsOf(boxes), cellSize) {
    refile(boxes);
}

void PaperMap::refile(std::span<const Aabb<float>> boxes) {
    index_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        index_[i] = range(boxes[i]);
    }
    fillBuckets();
}

void PaperMap::refile(std::span<const Vector3<float>> points) {
    index_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Cell cell = cellAt(points[i].x(), points[i].z());
        index_[i] = {cell.x, cell.z, cell.x, cell.z};
    }
    fillBuckets();
}

template <class Visit>
void PaperMap::forEachEntry(const Visit& visit) const {
    for (std::uint32_t i = 0; i < index_.size(); ++i) {
        forEachCell(index_[i], [&](int x, int z) { visit(bucketOf(x, z), i); });
    }
}

void PaperMap::fillBuckets() {
    // Counts come first, two places on, so that their sums say where the bucket before begins; that
    // place moves on as the bucket fills, until it is where the next one begins.
    begin_.assign(bucketOf(0, depth_) + 2, 0);
    forEachEntry([this](std::size_t bucket, std::uint32_t) { ++begin_[bucket + 2]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    objects_.resize(begin_.back());
    forEachEntry([this](std::size_t bucket, std::uint32_t object) {
        objects_[begin_[bucket + 1]++] = object;
    });
}

Aabb<float> PaperMap::square(int x, int z) const {
    const Vector3<float> low(lowX_ + cellSize_ * static_cast<float>(x), 0,
                             lowZ_ + cellSize_ * static_cast<float>(z));
    return {low, low + Vector3<float>(cellSize_, 0, cellSize_)};
}

}  // namespace hashphase::demos
