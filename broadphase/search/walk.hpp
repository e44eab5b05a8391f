// SPDX-License-Identifier: Zlib
#pragma once

// The one walk that answers every query but rays: reads the rows of cells around the region's bounds,
// level by level.

#include <broadphase/hash/table.hpp>
#include <broadphase/query_cost.hpp>

#include <algorithm>
#include <cstdint>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

// So few rows are read without a look at how long their runs are.
inline constexpr std::uint64_t kFewRows = 16;

/// The rows of cells in which anything overlapping a box may be filed: from one cell before the box to
/// its last cell.
struct RowsOfBox {
    Cell low{};
    Cell high{};
    std::uint64_t count = 0;
    bool areTooMany = false;  // reading the whole level is cheaper, and always correct
};

template <class Scalar>
RowsOfBox rowsOfBox(const Level<Scalar>& level, const Aabb<Scalar>& bounds) {
    RowsOfBox rows;
    if (hasNan(bounds)) {
        return rows;
    }
    if (!(bounds.min().array() <= bounds.max().array()).all()) {
        rows.areTooMany = true;  // an inverted box may overlap boxes that it lies within
        return rows;
    }
    std::uint64_t count = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        rows.low[axis] = std::max(level.cell(bounds.min()[i], axis) - 1, level.low[axis]);
        rows.high[axis] = std::min(level.cell(bounds.max()[i], axis), level.high[axis]);
        if (rows.low[axis] > rows.high[axis]) {
            return rows;
        }
        if (axis > 0) {
            count *= static_cast<std::uint64_t>(rows.high[axis] - rows.low[axis]) + 1;
        }
    }
    rows.count = count;
    rows.areTooMany = count * kBoxesPerRun > level.count();
    return rows;
}

/// Calls visitRow(CellRun) -> bool, false to stop, for each of the rows.
template <class VisitRow>
void forRows(const RowsOfBox& rows, VisitRow&& visitRow) {
    if (rows.count == 0) {
        return;
    }
    for (std::int32_t z = rows.low[2]; z <= rows.high[2]; ++z) {
        for (std::int32_t y = rows.low[1]; y <= rows.high[1]; ++y) {
            if (!visitRow(CellRun{y, z, rows.low[0], rows.high[0]})) {
                return;
            }
        }
    }
}

/// Whether the rows of a hashed level have more entries in their buckets, those of other rows and those
/// that several of them share included, than there are; or as many buckets.
template <class Scalar>
bool haveMoreThanAll(const Table<Scalar>& table, const Level<Scalar>& level,
                     const RowsOfBox& rows) {
    if (level.isDense() || rows.count == 0) {
        return false;
    }
    const auto length = static_cast<std::uint64_t>(rows.high[0] - rows.low[0]) + 1;
    if (rows.count * std::min<std::uint64_t>(length, level.bucketCount) >= level.bucketCount) {
        return true;
    }
    if (rows.count <= kFewRows) {
        return false;
    }
    std::uint64_t count = 0;
    forRows(rows, [&](const CellRun& run) {
        table.forRun(level, run, [&](const EntryRange& range) { count += range.count(); });
        return count <= level.count();
    });
    return count > level.count();
}

/// For each range of whole buckets in which anything overlapping `bounds` may be filed calls
/// read(range, isOwn) -> bool, false to stop; returns false when stopped. See walkLevel().
template <class Scalar, class Read>
bool walkBuckets(const Table<Scalar>& table, const Level<Scalar>& level, const Aabb<Scalar>& bounds,
                 QueryCost& cost, const Read& read) {
    const RowsOfBox rows = rowsOfBox(level, bounds);
    if (!level.hasCells() || rows.areTooMany || haveMoreThanAll(table, level, rows)) {
        return read(EntryRange{level.firstEntry, level.lastEntry},
                    [](std::uint32_t) { return true; });
    }
    bool goOn = true;
    forRows(rows, [&](const CellRun& run) {
        ++cost.rowsVisited;
        table.forRun(level, run, [&](const EntryRange& range) {
            goOn = goOn && read(range, [&](std::uint32_t entry) {
                       return table.isInRow(level, entry, run.y, run.z);
                   });
        });
        return goOn;
    });
    return goOn;
}

/// Reads the entries of one level that may overlap `bounds`: each once at most, but for those of a hashed
/// level, which may be read once for each of the rows where these are kFewRows at most. For each
/// range of entries calls reader.read(range, isOwn) -> bool, false to stop; isOwn(entry) must be
/// asked about every hit, and tells whether this range is the one that reports it. Returns false
/// when stopped.
template <class Scalar, class Reader>
bool walkLevel(const Table<Scalar>& table, const Level<Scalar>& level, const Aabb<Scalar>& bounds,
               QueryCost& cost, Reader&& reader) {
    if (level.count() == 0) {
        return true;
    }
    const auto read = [&](const EntryRange& range, const auto& isOwn) {
        cost.boxesTested += range.count();
        return reader.read(range, isOwn);
    };
    if (level.sortedCount == 0) {
        return walkBuckets(table, level, bounds, cost, read);
    }
    return walkBuckets(
        table, level, bounds, cost, [&](const EntryRange& buckets, const auto& isOwn) {
            bool goOn = true;
            table.forNear(level, buckets, bounds,
                          [&](const EntryRange& range) { goOn = goOn && read(range, isOwn); });
            return goOn;
        });
}

/// walkLevel() over all levels of a table. Returns false when stopped.
template <class Scalar, class Reader>
bool walkTable(const Table<Scalar>& table, const Aabb<Scalar>& bounds, QueryCost& cost,
               Reader&& reader) {
    for (const Level<Scalar>& level : table.levels()) {
        if (!walkLevel(table, level, bounds, cost, reader)) {
            return false;
        }
    }
    return true;
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
