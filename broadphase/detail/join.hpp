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
#include <type_traits>

namespace hashphase::detail {

/// A reader for walkTable() that calls found(slot) for every entry that overlaps a box.
template <class Scalar, class Found>
class OverlapReader {
public:
    OverlapReader(const Table<Scalar>& table, const Aabb<Scalar>& box, Found& found) noexcept
        : columns_(table.columns()), slots_(table.slots().data()), box_(box), found_(found) {}

    static constexpr double limit() noexcept { return std::numeric_limits<double>::infinity(); }

    template <class IsOwn>
    bool read(const EntryRange& range, const IsOwn& isOwn) const {
        for (std::uint32_t entry = range.first; entry < range.last; entry += kLanes) {
            const std::uint32_t lanes = std::min(range.last - entry, kLanes);
            std::uint32_t mask = box_.overlapMask(columns_, entry) & ((1U << lanes) - 1);
            for (; mask != 0; mask &= mask - 1) {
                const std::uint32_t hit = entry + static_cast<std::uint32_t>(std::countr_zero(mask));
                if (isOwn(hit)) {
                    found_(slots_[hit]);
                }
            }
        }
        return true;
    }

private:
    Columns<Scalar> columns_;
    const std::uint32_t* slots_;
    BoxLanes<Scalar> box_;
    Found& found_;
};

/// Calls found(slot) for every entry of the table that overlaps the box.
template <class Scalar, class Found>
void forOverlapsInTable(const Table<Scalar>& table, const Aabb<Scalar>& box, QueryCost& cost,
                        Found&& found) {
    walkTable(table, BoxRegion<Scalar>{box}, cost,
              OverlapReader<Scalar, std::remove_reference_t<Found>>(table, box, found));
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
    std::uint32_t rowCount = 0;

    void moveTo(const Table<Scalar>& table, const Level<Scalar>& level, const Cell& target) {
        if (target == cell) {
            return;
        }
        cell = target;
        rowCount = 0;
        const auto [x, y, z] = target;
        add(table, level, {y, z, x, x + 1});
        add(table, level, {y + 1, z, x - 1, x + 1});
        add(table, level, {y - 1, z + 1, x - 1, x + 1});
        add(table, level, {y, z + 1, x - 1, x + 1});
        add(table, level, {y + 1, z + 1, x - 1, x + 1});
    }

    [[nodiscard]] bool isOwnRow(const Row& row) const noexcept {
        return row.y == cell[1] && row.z == cell[2];
    }

private:
    void add(const Table<Scalar>& table, const Level<Scalar>& level, const CellRun& run) {
        if (run.y < level.low[1] || run.y > level.high[1] || run.z > level.high[2]) {
            return;
        }
        table.forRun(level, run, [&](const EntryRange& range) {
            if (range.first < range.last) {
                rows[rowCount++] = {range, run.y, run.z};
            }
        });
    }
};

/// Calls found(slotA, slotB) for every two entries of the table whose boxes overlap, once.
template <class Scalar, class Found>
void forOverlapsWithinTable(const Table<Scalar>& table, QueryCost& cost, Found&& found) {
    const auto levels = table.levels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Level<Scalar>& level = levels[i];
        HalfNeighbourhood<Scalar> around;
        for (std::uint32_t entry = level.firstEntry; entry < level.lastEntry; ++entry) {
            const Aabb<Scalar> box = table.box(entry);
            const auto foundHere = [&, slot = table.slot(entry)](std::uint32_t other) {
                found(slot, other);
            };
            const OverlapReader<Scalar, decltype(foundHere)> reader(table, box, foundHere);

            if (!level.hasCells) {
                cost.boxesTested += level.lastEntry - entry - 1;
                reader.read({entry + 1, level.lastEntry}, [](std::uint32_t) { return true; });
                continue;
            }
            around.moveTo(table, level,
                          {level.cell(box.min()[0], 0), level.cell(box.min()[1], 1),
                           level.cell(box.min()[2], 2)});
            for (std::uint32_t r = 0; r < around.rowCount; ++r) {
                const auto& row = around.rows[r];
                EntryRange range = row.range;
                if (around.isOwnRow(row) && range.first <= entry && entry < range.last) {
                    range.first = entry + 1;  // its own bucket: what is before it has read it
                }
                ++cost.rowsVisited;
                cost.boxesTested += range.last - range.first;
                reader.read(range, [&](std::uint32_t hit) {
                    return table.isInRow(level, hit, row.y, row.z);
                });
            }
            for (const Level<Scalar>& coarser : levels.subspan(i + 1)) {
                walkLevel(table, coarser, BoxRegion<Scalar>{box}, cost, reader);
            }
        }
    }
}

}  // namespace hashphase::detail
