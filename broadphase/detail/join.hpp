// SPDX-License-Identifier: Zlib
#pragma once

// Finds all overlapping couples of a table: each entry against the half of its neighbourhood that
// lies after it, on its own level, and against the coarser levels.

#include <broadphase/detail/walk.hpp>
#include <broadphase/regions.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

namespace hashphase::detail {

/// A reader for walkTable() that calls found(entry) for every entry that overlaps a box.
template <class Scalar, class Found>
class OverlapReader {
public:
    OverlapReader(const Table<Scalar>& table, const Aabb<Scalar>& box, Found& found) noexcept
        : columns_(table.columns()), box_(box), found_(found) {}

    static constexpr double limit() noexcept { return std::numeric_limits<double>::infinity(); }

    /// Bit k tells whether entry first + k overlaps the box.
    [[nodiscard]] std::uint32_t overlapMask(std::uint32_t first) const noexcept {
        return box_.overlapMask(columns_, first);
    }

    template <class IsOwn>
    bool read(const EntryRange& range, const IsOwn& isOwn) const {
        for (std::uint32_t entry = range.first; entry < range.last; entry += kLanes) {
            const std::uint32_t lanes = std::min(range.last - entry, kLanes);
            std::uint32_t mask = overlapMask(entry) & ((1U << lanes) - 1);
            for (; mask != 0; mask &= mask - 1) {
                const std::uint32_t hit =
                    entry + static_cast<std::uint32_t>(std::countr_zero(mask));
                if (isOwn(hit)) {
                    found_(hit);
                }
            }
        }
        return true;
    }

private:
    Columns<Scalar> columns_;
    BoxLanes<Scalar> box_;
    Found& found_;
};

/// Calls found(slot) for every entry of the table that overlaps the box.
template <class Scalar, class Found>
void forOverlapsInTable(const Table<Scalar>& table, const Aabb<Scalar>& box, QueryCost& cost,
                        Found&& found) {
    const auto foundEntry = [&](std::uint32_t entry) { found(table.slot(entry)); };
    walkTable(table, BoxRegion<Scalar>{box}, cost,
              OverlapReader<Scalar, decltype(foundEntry)>(table, box, foundEntry));
}

/// What one entry is tested against: what is behind it in the row of its cell, up to the next cell,
/// and the four rows that follow in (z, y) order, from one cell before to the next one. Of two
/// neighbouring cells, exactly one reads the other.
///
/// Rows mostly hold few entries: these are laid out as chunks of kLanes, which are tested one after
/// the other with no branch in between that could be mispredicted. What is left is read row by row.
template <class Scalar>
class HalfNeighbourhood {
public:
    /// Up to kLanes entries of a row, from `first` on; lanes() tells which of them count.
    struct Chunk {
        std::uint32_t first = 0;
        std::uint32_t row = 0;
    };
    struct Rest {
        EntryRange range;
        std::uint32_t row = 0;
    };

    HalfNeighbourhood(const Table<Scalar>& table, const Level<Scalar>& level) noexcept
        : table_(table), level_(level) {}

    /// Goes to an entry, which is filed in this cell.
    void moveTo(std::uint32_t entry, const Cell& cell) {
        const bool isOtherRow = ((cell[1] ^ cell_[1]) | (cell[2] ^ cell_[2])) != 0;
        if (isOtherRow || cell[0] != cell_[0]) {
            cell_ = cell;
            if (isOtherRow) {
                findRows();
            }
            readRows();
        }
        const EntryRange behind{entry + 1, endOfOwnRow_};
        const std::uint32_t count = std::min(behind.count(), kLanes);
        chunks_[0].first = behind.first;
        lanes_ = othersLanes_ | ((1U << count) - 1);
        rests_[0].range = {behind.first + count, behind.last};
        boxCount_ = othersBoxCount_ + behind.count();
    }

    [[nodiscard]] std::span<const Chunk> chunks() const noexcept {
        return {chunks_.data(), chunkCount_};
    }
    /// Bit kLanes * c + k tells whether entry k of chunk c counts.
    [[nodiscard]] std::uint64_t lanes() const noexcept { return lanes_; }
    [[nodiscard]] std::span<const Rest> rests() const noexcept {
        return {rests_.data(), restCount_};
    }

    /// In chunks and rests together.
    [[nodiscard]] std::uint32_t boxCount() const noexcept { return boxCount_; }
    [[nodiscard]] std::uint32_t rowCount() const noexcept { return rowCount_; }

    /// Hashed rows may share buckets: asked about every hit.
    [[nodiscard]] bool isInRow(std::uint32_t entry, std::uint32_t row) const noexcept {
        return table_.isInRow(level_, entry, rows_[row].y, rows_[row].z);
    }

private:
    static constexpr std::uint32_t kRows = 5;
    static constexpr std::uint32_t kChunksPerRow = 2;

    struct Row {
        std::uint32_t base = 0;
        std::int32_t y = 0;
        std::int32_t z = 0;
    };

    void findRows() {
        const std::int32_t y = cell_[1];
        const std::int32_t z = cell_[2];
        rowCount_ = 0;
        const auto add = [this](std::int32_t rowY, std::int32_t rowZ) {
            rows_[rowCount_++] = {level_.rowBase(rowY, rowZ), rowY, rowZ};
        };
        add(y, z);
        const bool hasNextY = y < level_.high[1];
        if (hasNextY) {
            add(y + 1, z);
        }
        if (z == level_.high[2]) {
            return;
        }
        if (y > level_.low[1]) {
            add(y - 1, z + 1);
        }
        add(y, z + 1);
        if (hasNextY) {
            add(y + 1, z + 1);
        }
    }

    void readRows() {
        chunkCount_ = 1;
        restCount_ = 1;
        othersLanes_ = 0;
        othersBoxCount_ = 0;
        for (std::uint32_t row = 0; row < rowCount_; ++row) {
            const std::int32_t x = cell_[0];
            bool isWrapped = false;
            const auto read = [&](const EntryRange& range) {
                if (row == 0 && !isWrapped) {
                    endOfOwnRow_ = range.last;
                } else {
                    othersBoxCount_ += range.count();
                    isWrapped ? addRest(range, row) : addChunks(range, row);
                }
                isWrapped = true;
            };
            table_.forRun(level_, rows_[row].base, row == 0 ? x : x - 1, x + 1, read);
        }
    }

    void addChunks(const EntryRange& range, std::uint32_t row) {
        const std::uint32_t count = std::min(range.count(), kChunksPerRow * kLanes);
        othersLanes_ |= std::uint64_t{(1U << count) - 1} << (kLanes * chunkCount_);
        for (std::uint32_t i = 0; i < kChunksPerRow; ++i) {
            chunks_[chunkCount_ + i] = {range.first + kLanes * i, row};
        }
        chunkCount_ += (count + kLanes - 1) / kLanes;
        if (range.count() > count) {
            addRest({range.first + count, range.last}, row);
        }
    }

    void addRest(const EntryRange& range, std::uint32_t row) {
        rests_[restCount_++] = {range, row};
    }

    const Table<Scalar>& table_;
    const Level<Scalar>& level_;
    Cell cell_{kCellLimit, kCellLimit, kCellLimit};
    std::array<Row, kRows> rows_{};  // its own first
    std::uint32_t rowCount_ = 0;
    std::uint32_t endOfOwnRow_ = 0;
    std::uint64_t othersLanes_ = 0;  // of all rows but its own
    std::uint32_t othersBoxCount_ = 0;

    std::array<Chunk, 1 + kChunksPerRow*(kRows - 1)> chunks_{};  // its own row's first
    std::array<Rest, 2 * kRows> rests_{};                        // the same; a row may wrap around
    std::uint32_t chunkCount_ = 1;
    std::uint32_t restCount_ = 1;
    std::uint64_t lanes_ = 0;
    std::uint32_t boxCount_ = 0;
};

/// Calls found(entryA, entryB) for every two entries of a level with cells whose boxes overlap.
/// Flattened, because compilers leave calls in this loop otherwise, which take a fifth of its time.
template <class Scalar, class Found>
[[gnu::flatten]] void forOverlapsWithinLevel(const Table<Scalar>& table, const Level<Scalar>& level,
                                             QueryCost& cost, const Found& found) {
    HalfNeighbourhood<Scalar> around(table, level);
    QueryCost own;  // summed here, where the compiler may keep it in registers
    for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
        const Aabb<Scalar> box = table.box(entry);
        around.moveTo(entry, {level.cell(box.min()[0], 0), level.cell(box.min()[1], 1),
                              level.cell(box.min()[2], 2)});
        own.rowsVisited += around.rowCount();
        own.boxesTested += around.boxCount();

        const auto foundHere = [&](std::uint32_t other) { found(entry, other); };
        const OverlapReader<Scalar, decltype(foundHere)> reader(table, box, foundHere);
        const auto chunks = around.chunks();
        std::uint64_t hits = 0;
        for (std::size_t c = 0; c < chunks.size(); ++c) {
            hits |= std::uint64_t{reader.overlapMask(chunks[c].first)} << (kLanes * c);
        }
        for (hits &= around.lanes(); hits != 0; hits &= hits - 1) {
            const auto bit = static_cast<std::uint32_t>(std::countr_zero(hits));
            const auto [first, row] = chunks[bit / kLanes];
            const std::uint32_t hit = first + bit % kLanes;
            if (around.isInRow(hit, row)) {
                found(entry, hit);
            }
        }
        for (const auto& rest : around.rests()) {
            const std::uint32_t row = rest.row;
            reader.read(rest.range, [&](std::uint32_t hit) { return around.isInRow(hit, row); });
        }
    }
    cost.rowsVisited += own.rowsVisited;
    cost.boxesTested += own.boxesTested;
}

/// Calls found(entryA, entryB) for every two entries of the table whose boxes overlap, once.
template <class Scalar, class Found>
void forOverlapsWithinTable(const Table<Scalar>& table, QueryCost& cost, const Found& found) {
    const auto levels = table.levels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Level<Scalar>& level = levels[i];
        if (level.hasCells) {
            forOverlapsWithinLevel(table, level, cost, found);
        }
        // Against what is listed after it, or filed on coarser levels.
        const auto coarser = levels.subspan(i + 1);
        const bool hasCoarser = std::any_of(coarser.begin(), coarser.end(),
                                            [](const auto& other) { return other.count() > 0; });
        if (level.hasCells && !hasCoarser) {
            continue;
        }
        for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
            const Aabb<Scalar> box = table.box(entry);
            const auto foundHere = [&](std::uint32_t other) { found(entry, other); };
            const OverlapReader<Scalar, decltype(foundHere)> reader(table, box, foundHere);
            if (!level.hasCells) {
                cost.boxesTested += level.lastEntry - entry - 1;
                reader.read({entry + 1, level.lastEntry}, [](std::uint32_t) { return true; });
            }
            for (const Level<Scalar>& other : coarser) {
                walkLevel(table, other, BoxRegion<Scalar>{box}, cost, reader);
            }
        }
    }
}

}  // namespace hashphase::detail
