// SPDX-License-Identifier: Zlib
#pragma once

// Which levels a table has: of which cell sizes, between which cells, and how these become buckets.
// The sizes follow the population (see levels.hpp); the rest follows where the boxes are.

#include <broadphase/aabb.hpp>
#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/hash/level.hpp>
#include <broadphase/hash/levels.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// How many boxes are filed by cells, and between which cells.
struct CellReach {
    std::uint32_t count = 0;
    Cell low{kCellLimit, kCellLimit, kCellLimit};
    Cell high{-kCellLimit, -kCellLimit, -kCellLimit};

    void add(const Cell& cell) noexcept {
        ++count;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], cell[axis]);
            high[axis] = std::max(high[axis], cell[axis]);
        }
    }
};

template <class Scalar>
class LevelLayout {
public:
    /// A level of so few proxies costs every walk more than reading them as a list.
    static constexpr std::uint32_t kThinLevel = 32;

    /// Whether the cell sizes are to be chosen again for so many boxes: when the number has changed,
    /// and now and then. To be asked once a build, which it counts.
    [[nodiscard]] bool isTimeToChoose(std::size_t count);

    /// Chooses the cell sizes, or takes the fixed ones where there are any. Cost: a pass over the boxes.
    void choose(std::span<const PaddedBox<Scalar>> boxes, const LevelSizes& fixed);

    /// Lays the levels out for the boxes as they are now, and a little further: for each cell size, finest
    /// first, a dense one, for most, and a hashed one for what lies beyond it. The last one, the only one
    /// for a few boxes, is the list. Cost: a pass or two over the boxes.
    void layOut(std::span<const PaddedBox<Scalar>> boxes, std::vector<Level<Scalar>>& levels);

    /// To be told when `shift` is subtracted from all coordinates.
    void shiftOrigin(const Vector3<Scalar>& shift) noexcept;

    [[nodiscard]] const LevelSizes& sizes() const noexcept { return sizes_; }
    void releaseUnusedMemory() noexcept {
        census_ = {};
        cells_ = {};
        buckets_ = {};
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + census_.memoryBytes() + cells_.capacity() * sizeof(Cell) +
               buckets_.capacity() * sizeof(std::uint32_t);
    }

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(LevelLayout& to, const LevelLayout& from, const Visit& visit) {
        visit(to.sizes_, from.sizes_);
        visit(to.origin_, from.origin_);
        visit(to.middle_, from.middle_);
        visit(to.countWhenChosen_, from.countWhenChosen_);
        visit(to.buildsSinceChosen_, from.buildsSinceChosen_);
    }

private:
    void layOutDense(Level<Scalar>& level, const CellReach& reach) const;
    void layOutHashed(Level<Scalar>& level, const CellReach& reach, std::uint32_t count,
                      std::span<const PaddedBox<Scalar>> boxes);
    [[nodiscard]] double crowdingOf(const Level<Scalar>& level);

    LevelSizes sizes_;
    std::array<Scalar, 3> origin_{};  // finite
    SizeCensus::Range middle_;  // where all but a few of the boxes began, when sizes were chosen
    std::uint64_t countWhenChosen_ = 0;
    std::uint32_t buildsSinceChosen_ = 0;
    SizeCensus census_;                   // scratch of choose()
    std::vector<Cell> cells_;             // scratch of layOut(): a sample
    std::vector<std::uint32_t> buckets_;  // the same: theirs
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
