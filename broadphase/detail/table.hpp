// SPDX-License-Identifier: Zlib
#pragma once

// The hash table: boxes sorted by cell, each filed once.
//
// A box is filed under the cell of its min corner, on the finest level where it spans at most two
// cells an axis. Whatever overlaps a region then lies in the region's cells or one step before.
// Cells become buckets by rows: bucket = rowBase(y, z) + x, modulo the number of buckets, so that
// the cells of a run along x are neighbours in memory, and entries are sorted by bucket. After the
// spatial hashing of Hastings, Mesit and Guha, with rows in the place of single cells.
//
// Threads   Building and erasing need the table for themselves; everything const may run anywhere.

#include <broadphase/aabb.hpp>
#include <broadphase/detail/levels.hpp>
#include <broadphase/detail/overlap_kernel.hpp>
#include <broadphase/detail/quantise.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail {

/// Part of a row of cells, from firstX to lastX inclusive.
struct CellRun {
    std::int32_t y = 0;
    std::int32_t z = 0;
    std::int32_t firstX = 0;
    std::int32_t lastX = 0;
};

/// One level of a table: which entries it has, how coordinates become its cells, and how its rows
/// of cells become buckets.
template <class Scalar>
struct Level {
    std::array<Scalar, 3> origin{};
    std::array<Scalar, 3> inverseCellSize{};  // 0 along a flat axis, which has one cell: 0
    std::uint32_t firstEntry = 0;
    std::uint32_t lastEntry = 0;  // one past
    std::uint32_t firstBucket = 0;
    std::uint32_t bucketMask = 0;
    // Lowest and highest cell that has an entry. A level without cells is a plain list: it has
    // one bucket, and every walk reads it whole.
    Cell low{};
    Cell high{};
    bool hasCells = false;
    // A well-filled range of cells is numbered through (the paper's formula); else rows are hashed.
    bool isDense = false;
    std::uint32_t strideY = 0;
    std::uint32_t strideZ = 0;

    [[nodiscard]] std::uint32_t count() const noexcept { return lastEntry - firstEntry; }

    /// True when the run lies in low to high.
    [[nodiscard]] bool isWithin(const CellRun& run) const noexcept {
        return low[0] <= run.firstX && run.lastX <= high[0] && low[1] <= run.y &&
               run.y <= high[1] && low[2] <= run.z && run.z <= high[2];
    }

    [[nodiscard]] std::int32_t cell(Scalar x, std::size_t axis) const noexcept {
        // Not 0 * infinity, along a flat axis.
        return inverseCellSize[axis] == 0 ? 0 : quantise(x, origin[axis], inverseCellSize[axis]);
    }

    /// Bucket of cell x = 0 of row (y, z), before the modulo.
    [[nodiscard]] std::uint32_t rowBase(std::int32_t y, std::int32_t z) const noexcept {
        const auto row =
            static_cast<std::uint32_t>(y) * strideY + static_cast<std::uint32_t>(z) * strideZ;
        if (isDense) {
            return row;
        }
        std::uint32_t hash = row ^ (row >> 16);
        hash *= 0x7feb352dU;
        return hash ^ (hash >> 15);
    }
};

struct EntryRange {
    std::uint32_t first = 0;
    std::uint32_t last = 0;  // one past

    [[nodiscard]] std::uint32_t count() const noexcept { return last - first; }
};

template <class Scalar>
class Table {
public:
    /// Files boxes[slot] for every slot, anew. Cell sizes follow the population, or are fixed when
    /// `fixed.count` > 0. None of the boxes may be NaN. Cost: a few passes over the boxes.
    void build(std::span<const std::uint32_t> slots, const Aabb<Scalar>* boxes,
               const LevelSizes& fixed);

    /// Takes the entry out of every later answer. Cost: O(1); its place is reclaimed by build().
    void erase(std::uint32_t entry) noexcept;

    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(slots_.size());
    }
    [[nodiscard]] std::span<const Level<Scalar>> levels() const noexcept { return levels_; }
    [[nodiscard]] std::span<const std::uint32_t> slots() const noexcept { return slots_; }
    [[nodiscard]] std::uint32_t slot(std::uint32_t entry) const noexcept { return slots_[entry]; }
    /// Edge of the finest cells [m]; infinity when nothing is filed by cells.
    [[nodiscard]] double finestCellSize() const noexcept {
        return sizes_.count > 0 && !slots_.empty() ? sizes_.cellSize[0]
                                                   : std::numeric_limits<double>::infinity();
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// The entry's box, or NaN when it was erased.
    [[nodiscard]] Aabb<Scalar> box(std::uint32_t entry) const noexcept {
        return {Vector3<Scalar>(bounds_[0][entry], bounds_[1][entry], bounds_[2][entry]),
                Vector3<Scalar>(bounds_[3][entry], bounds_[4][entry], bounds_[5][entry])};
    }

    /// Coordinates of all entries, by column.
    [[nodiscard]] Columns<Scalar> columns() const noexcept {
        return {bounds_[0].data(), bounds_[1].data(), bounds_[2].data(),
                bounds_[3].data(), bounds_[4].data(), bounds_[5].data()};
    }

    /// True when the entry, found by forRun(), lies in that row (y, z): hashed rows may share
    /// buckets. Asked about hits only.
    [[nodiscard]] bool isInRow(const Level<Scalar>& level, std::uint32_t entry, std::int32_t y,
                               std::int32_t z) const noexcept {
        return level.isDense ||
               (level.cell(bounds_[1][entry], 1) == y && level.cell(bounds_[2][entry], 2) == z);
    }

    /// Calls visit(EntryRange) for the buckets of the run: once, or twice where it wraps around.
    /// The run may begin one cell before the level's lowest and end one after its highest.
    /// Entries of other rows may be among them where rows are hashed. Cost: O(1) + visits.
    template <class Visit>
    void forRun(const Level<Scalar>& level, const CellRun& run, Visit&& visit) const {
        forRun(level, level.rowBase(run.y, run.z), run.firstX, run.lastX, visit);
    }

    /// The same for a row given by its Level::rowBase().
    template <class Visit>
    void forRun(const Level<Scalar>& level, std::uint32_t rowBase, std::int32_t firstX,
                std::int32_t lastX, Visit&& visit) const {
        const std::uint32_t* starts = bucketStart_.data() + level.firstBucket;
        const auto length = static_cast<std::uint32_t>(lastX - firstX) + 1;
        const std::uint32_t bucketCount = level.bucketMask + 1;
        if (length >= bucketCount) {
            visit(EntryRange{starts[0], starts[bucketCount]});
            return;
        }
        const std::uint32_t first =
            (rowBase + static_cast<std::uint32_t>(firstX)) & level.bucketMask;
        const std::uint32_t last = first + length;
        if (last <= bucketCount) {
            visit(EntryRange{starts[first], starts[last]});
        } else {
            visit(EntryRange{starts[first], starts[bucketCount]});
            visit(EntryRange{starts[0], starts[last - bucketCount]});
        }
    }

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every entry lies in the bucket of the cell of its min corner.
    /// - Every entry is on the finest level where its box spans at most two cells an axis, or is
    ///   listed without cells.
    /// - Buckets partition the entries in order.
    [[nodiscard]] std::string validate() const;

private:
    struct Filed {
        Cell cell{};
        std::uint32_t level = 0;
    };

    void chooseLevels(std::span<const std::uint32_t> slots, const Aabb<Scalar>* boxes,
                      const LevelSizes& fixed);
    [[nodiscard]] Filed file(const Aabb<Scalar>& box) const noexcept;
    void layOutBuckets(std::span<const std::uint32_t> counts);
    void layOutLevel(Level<Scalar>& level, std::uint32_t count, std::uint32_t& firstBucket);
    [[nodiscard]] std::uint32_t bucketOf(const Filed& filed) const noexcept;

    LevelSizes sizes_;
    std::array<Scalar, 3> origin_{};
    std::uint64_t countWhenChosen_ = 0;
    std::uint32_t buildsSinceChosen_ = 0;
    SizeCensus census_;

    std::vector<Level<Scalar>> levels_;  // finest first; the last one is the list without cells
    std::vector<std::uint32_t> bucketStart_;
    std::vector<std::uint32_t> slots_;
    std::array<std::vector<Scalar>, 6> bounds_;  // kLanes longer than the entries

    std::vector<Filed> filed_;            // scratch of build()
    std::vector<std::uint32_t> buckets_;  // scratch of build()
};

extern template class Table<float>;
extern template class Table<double>;

}  // namespace hashphase::detail
