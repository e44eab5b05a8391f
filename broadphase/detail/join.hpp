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

namespace hashphase::detail {

/// A reader for walkTable() that calls found(entry) for every entry that overlaps a box.
template <class Scalar, class Found>
class OverlapReader {
public:
    OverlapReader(const Table<Scalar>& table, const Aabb<Scalar>& box, Found& found) noexcept
        : columns_(table.columns()), box_(box), found_(found) {}

    static constexpr double limit() noexcept { return std::numeric_limits<double>::infinity(); }

    template <class IsOwn>
    bool read(const EntryRange& range, const IsOwn& isOwn) const {
        for (std::uint32_t entry = range.first; entry < range.last; entry += kLanes) {
            const std::uint32_t lanes = std::min(range.last - entry, kLanes);
            std::uint32_t mask = box_.overlapMask(columns_, entry) & ((1U << lanes) - 1);
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

/// The buckets to read for the entries of one cell: its own row onwards, and the four rows that
/// follow in (z, y) order. Of two neighbouring cells, exactly one reads the other.
template <class Scalar>
struct HalfNeighbourhood {
    struct Row {
        EntryRange range;
        std::int32_t y = 0;
        std::int32_t z = 0;
    };

    Cell cell{kCellLimit, kCellLimit, kCellLimit};
    std::array<Row, 10> rows{};
    std::uint32_t ownCount = 0;  // of rows, how many are parts of the cell's own row
    std::uint32_t rowCount = 0;
    std::uint32_t boxCount = 0;  // in all rows

    void moveTo(const Table<Scalar>& table, const Level<Scalar>& level, const Cell& target) {
        // Spelled out: comparing arrays calls a function.
        if (((target[0] ^ cell[0]) | (target[1] ^ cell[1]) | (target[2] ^ cell[2])) == 0) {
            return;
        }
        cell = target;
        rowCount = 0;
        boxCount = 0;
        const auto [x, y, z] = target;
        add(table, level, {y, z, x, x + 1});
        ownCount = rowCount;
        const bool hasNextY = y < level.high[1];
        if (hasNextY) {
            add(table, level, {y + 1, z, x - 1, x + 1});
        }
        if (z == level.high[2]) {
            return;
        }
        if (y > level.low[1]) {
            add(table, level, {y - 1, z + 1, x - 1, x + 1});
        }
        add(table, level, {y, z + 1, x - 1, x + 1});
        if (hasNextY) {
            add(table, level, {y + 1, z + 1, x - 1, x + 1});
        }
    }

private:
    void add(const Table<Scalar>& table, const Level<Scalar>& level, const CellRun& run) {
        table.forRun(level, run, [&](const EntryRange& range) {
            rows[rowCount] = {range, run.y, run.z};
            rowCount += range.first < range.last ? 1 : 0;
            boxCount += range.last - range.first;
        });
    }
};

/// Calls found(entryA, entryB) for every two entries of a level with cells whose boxes overlap.
template <class Scalar, class Found>
void forOverlapsWithinLevel(const Table<Scalar>& table, const Level<Scalar>& level, QueryCost& cost,
                            const Found& found) {
    HalfNeighbourhood<Scalar> around;
    QueryCost own;  // summed here, where the compiler may keep it in registers
    for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
        const Aabb<Scalar> box = table.box(entry);
        const auto foundHere = [&](std::uint32_t other) { found(entry, other); };
        const OverlapReader<Scalar, decltype(foundHere)> reader(table, box, foundHere);
        around.moveTo(table, level,
                      {level.cell(box.min()[0], 0), level.cell(box.min()[1], 1),
                       level.cell(box.min()[2], 2)});
        own.rowsVisited += around.rowCount;
        own.boxesTested += around.boxCount;
        for (std::uint32_t r = 0; r < around.rowCount; ++r) {
            const auto& row = around.rows[r];
            EntryRange range = row.range;
            if (r < around.ownCount && range.first <= entry && entry < range.last) {
                own.boxesTested -= entry + 1 - range.first;
                range.first = entry + 1;  // its own bucket: what is before it has read it
            }
            reader.read(range,
                        [&](std::uint32_t hit) { return table.isInRow(level, hit, row.y, row.z); });
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
