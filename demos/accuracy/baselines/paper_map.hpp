// SPDX-License-Identifier: Zlib
#pragma once

// The paper's own grid: a map of square cells on the ground, one bucket each, and in each bucket the
// numbers of all objects that touch the cell. Hastings, Mesit, Guha, "Optimization of Large-Scale,
// Real-Time Simulations by Spatial Hashing".

#include <broadphase/aabb.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class PaperMap {
public:
    /// Cells low to high, inclusive.
    struct Range {
        int lowX = 0;
        int lowZ = 0;
        int highX = 0;
        int highZ = 0;
    };

    /// Files all boxes by x and z; objects have their numbers.
    PaperMap(std::span<const Aabb<float>> boxes, float cellSize);

    /// Wipes all buckets and files these boxes, as the paper does in every frame. Keeps its memory.
    void refile(std::span<const Aabb<float>> boxes);

    /// The cells that a rectangle of the map touches, no farther than the map goes.
    [[nodiscard]] Range range(float lowX, float lowZ, float highX, float highZ) const;
    [[nodiscard]] Range all() const { return {0, 0, width_ - 1, depth_ - 1}; }

    [[nodiscard]] std::span<const std::uint32_t> objects(int x, int z) const {
        const std::size_t bucket = bucketOf(x, z);
        return std::span(objects_).subspan(begin_[bucket], begin_[bucket + 1] - begin_[bucket]);
    }

    /// The cell on the plane at height 0.
    [[nodiscard]] Aabb<float> square(int x, int z) const;

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + (begin_.capacity() + next_.capacity()) * sizeof(std::size_t) +
               objects_.capacity() * sizeof(std::uint32_t);
    }

private:
    [[nodiscard]] std::size_t bucketOf(int x, int z) const {
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    float cellSize_;
    float lowX_ = 0;
    float lowZ_ = 0;
    int width_ = 0;
    int depth_ = 0;
    std::vector<std::size_t> begin_;      // of each bucket, and the end
    std::vector<std::size_t> next_;       // scratch of refile()
    std::vector<std::uint32_t> objects_;  // bucket by bucket
};

}  // namespace hashphase::demos
