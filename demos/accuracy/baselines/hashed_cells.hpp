// SPDX-License-Identifier: Zlib
#pragma once

// A plain grid of cells of 1 m, hashed, with lists of what is in them. A flat one has one layer of
// cells, at y = 0: the columns over the ground of the paper.

#include <broadphase/aabb.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hashphase::demos {

using Cell = std::array<std::int32_t, 3>;

[[nodiscard]] inline std::int32_t cellAt(double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate));
}

[[nodiscard]] inline Cell cellOf(const Vector3<float>& point, bool isFlat = false) {
    const auto at = [&](int axis) { return cellAt(static_cast<double>(point[axis])); };
    return {at(0), isFlat ? 0 : at(1), at(2)};
}

/// Calls visit(cell) of every cell from the one to the other.
template <class Visit>
void visitCells(const Cell& low, const Cell& high, const Visit& visit) {
    Cell at;
    for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
        for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
            for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) {
                visit(at);
            }
        }
    }
}

/// Of every cell that the box touches.
template <class Visit>
void visitBox(const Aabb<float>& box, bool isFlat, const Visit& visit) {
    visitCells(cellOf(box.min(), isFlat), cellOf(box.max(), isFlat), visit);
}

/// Which objects are in which cells. What is filed first stays; what is filed after keepFiled()
/// lasts until unfile().
class HashedCells {
public:
    explicit HashedCells(std::size_t expected) : heads_(std::bit_ceil(2 * expected + 1), kNone) {}

    void file(const Cell& cell, std::uint32_t object) {
        if (entries_.size() == heads_.size()) {
            grow();
        }
        std::uint32_t& head = heads_[bucketOf(cell)];
        entries_.push_back({cell, object, head});
        head = static_cast<std::uint32_t>(entries_.size() - 1);
    }

    /// Calls visit(object) of all that are in the cell.
    template <class Visit>
    void visitObjects(const Cell& cell, const Visit& visit) const {
        for (std::uint32_t i = heads_[bucketOf(cell)]; i != kNone; i = entries_[i].next) {
            if (entries_[i].cell == cell) {
                visit(entries_[i].object);
            }
        }
    }

    void keepFiled() { kept_ = entries_.size(); }

    // The newest of a bucket come first.
    void unfile() {
        for (; entries_.size() > kept_; entries_.pop_back()) {
            heads_[bucketOf(entries_.back().cell)] = entries_.back().next;
        }
    }

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    struct Entry {
        Cell cell;
        std::uint32_t object;
        std::uint32_t next;
    };

    // Neighbours along x stay neighbours; large odd numbers take rows far apart.
    [[nodiscard]] std::size_t bucketOf(const Cell& cell) const noexcept {
        return (static_cast<std::uint32_t>(cell[0]) +
                static_cast<std::uint32_t>(cell[1]) * 0x85ebca6bU +
                static_cast<std::uint32_t>(cell[2]) * 0x9e3779b1U) &
               (heads_.size() - 1);
    }

    void grow() {
        heads_.assign(2 * heads_.size(), kNone);
        for (std::uint32_t i = 0; i < entries_.size(); ++i) {
            std::uint32_t& head = heads_[bucketOf(entries_[i].cell)];
            entries_[i].next = head;
            head = i;
        }
    }

    std::vector<std::uint32_t> heads_;  // a power of two, no fewer than entries
    std::vector<Entry> entries_;
    std::size_t kept_ = 0;
};

}  // namespace hashphase::demos
