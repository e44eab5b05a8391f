// SPDX-License-Identifier: Zlib
#pragma once

// The paper's own grid: a map of square cells on the ground, one bucket each, and in each bucket the
// numbers of all objects that touch the cell. Hastings, Mesit, Guha, "Optimization of Large-Scale,
// Real-Time Simulations by Spatial Hashing".
//
// Hash      The paper's fast one: the conversion factor in place of a division, truncation in place of
//           floor, which is the same once the domain's minimum is subtracted. All that is filed and
//           asked goes through the one function, and it is monotone, so that no pair is lost.
// Outside   What is beyond the domain's border is in the outermost cells.

#include <broadphase/aabb.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class PaperMap {
public:
    struct Cell {
        int x = 0;
        int z = 0;
    };

    /// Cells low to high, inclusive.
    struct Range {
        int lowX = 0;
        int lowZ = 0;
        int highX = 0;
        int highZ = 0;
    };

    /// Nothing is filed yet. Of the domain, x and z count.
    PaperMap(const Aabb<float>& domain, float cellSize);

    /// Files all boxes by x and z, in the domain that they take; objects have their numbers.
    PaperMap(std::span<const Aabb<float>> boxes, float cellSize);

    /// Wipes all buckets and files these boxes, as the paper does in every frame. Keeps its memory.
    void refile(std::span<const Aabb<float>> boxes);

    /// The same with points, each of which is in one cell.
    void refile(std::span<const Vector3<float>> points);

    [[nodiscard]] Cell cellAt(float x, float z) const {
        return {cellOf(x - lowX_, lastX_), cellOf(z - lowZ_, lastZ_)};
    }

    /// The cells that a rectangle of the map touches, no farther than the map goes.
    [[nodiscard]] Range range(float lowX, float lowZ, float highX, float highZ) const {
        const Cell low = cellAt(lowX, lowZ);
        const Cell high = cellAt(highX, highZ);
        return {low.x, low.z, high.x, high.z};
    }
    [[nodiscard]] Range range(const Aabb<float>& box) const {
        return range(box.min().x(), box.min().z(), box.max().x(), box.max().z());
    }
    [[nodiscard]] Range all() const { return {0, 0, width_ - 1, depth_ - 1}; }

    [[nodiscard]] std::span<const std::uint32_t> objects(int x, int z) const {
        return row(x, x, z);
    }

    /// Those of neighbouring cells of a row, one bucket after the other.
    [[nodiscard]] std::span<const std::uint32_t> row(int lowX, int highX, int z) const {
        const std::uint32_t begin = begin_[bucketOf(lowX, z)];
        return std::span(objects_).subspan(begin, begin_[bucketOf(highX, z) + 1] - begin);
    }

    /// The cell on the plane at height 0.
    [[nodiscard]] Aabb<float> square(int x, int z) const;

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + (begin_.capacity() + objects_.capacity()) * sizeof(std::uint32_t) +
               index_.capacity() * sizeof(Range);
    }

private:
    [[nodiscard]] int cellOf(float distance, float last) const {
        return static_cast<int>(std::clamp(distance * conversionFactor_, 0.0F, last));
    }
    [[nodiscard]] std::size_t bucketOf(int x, int z) const {
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }
    template <class Visit>
    void forEachEntry(const Visit& visit) const;
    void fillBuckets();

    float cellSize_;
    float conversionFactor_;
    float lowX_;
    float lowZ_;
    int width_;
    int depth_;
    float lastX_;
    float lastZ_;
    std::vector<std::uint32_t> begin_;    // of each bucket, the end, and one more for fillBuckets()
    std::vector<Range> index_;            // the paper's object index: the cells of each object
    std::vector<std::uint32_t> objects_;  // bucket by bucket
};

/// Calls visit(x, z) for each of the cells, row by row.
template <class Visit>
void forEachCell(const PaperMap::Range& cells, const Visit& visit) {
    for (int z = cells.lowZ; z <= cells.highZ; ++z) {
        for (int x = cells.lowX; x <= cells.highX; ++x) {
            visit(x, z);
        }
    }
}

}  // namespace hashphase::demos
