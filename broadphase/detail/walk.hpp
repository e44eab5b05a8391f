// SPDX-License-Identifier: Zlib
#pragma once

// The one walk that answers every query but rays: reads the rows of cells around the region's bounds,
// level by level.

#include <broadphase/detail/table.hpp>

#include <algorithm>
#include <cstdint>

namespace hashphase {

/// What a query cost, returned with its answer.
struct QueryCost {
    std::uint64_t rowsVisited = 0;  ///< rows of cells, or a ray's blocks of up to eight boxes
    std::uint64_t boxesTested = 0;
    std::uint64_t hits = 0;

    QueryCost& operator+=(const QueryCost& other) noexcept {
        rowsVisited += other.rowsVisited;
        boxesTested += other.boxesTested;
        hits += other.hits;
        return *this;
    }
};

namespace detail {

// Looking up a run of buckets costs about as much as testing this many boxes one after another.
inline constexpr std::uint64_t kBoxesPerRun = 4;

/// Calls visitRow(CellRun) for the rows of `level` in which anything overlapping `bounds` may be
/// filed: from one cell before the box to its last cell. Returns false, without a call, when
/// reading the whole level is cheaper (and always correct), or the box is inverted.
template <class Scalar, class VisitRow>
bool forRowsOfBox(const Level<Scalar>& level, const Aabb<Scalar>& bounds, VisitRow&& visitRow) {
    if (hasNan(bounds)) {
        return true;
    }
    if (!(bounds.min().array() <= bounds.max().array()).all()) {
        return false;
    }
    Cell low;
    Cell high;
    std::uint64_t rows = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<Eigen::Index>(axis);
        low[axis] = std::max(level.cell(bounds.min()[i], axis) - 1, level.low[axis]);
        high[axis] = std::min(level.cell(bounds.max()[i], axis), level.high[axis]);
        if (low[axis] > high[axis]) {
            return true;
        }
        if (axis > 0) {
            rows *= static_cast<std::uint64_t>(high[axis] - low[axis]) + 1;
        }
    }
    // Rows of a hashed level share buckets: long ones would have every box read once a row.
    const auto length = static_cast<std::uint64_t>(high[0] - low[0]) + 1;
    const bool coversBuckets =
        !level.isDense &&
        rows * std::min<std::uint64_t>(length, level.bucketCount) >= level.bucketCount;
    if (rows * kBoxesPerRun > level.count() || coversBuckets) {
        return false;
    }
    for (std::int32_t z = low[2]; z <= high[2]; ++z) {
        for (std::int32_t y = low[1]; y <= high[1]; ++y) {
            if (!visitRow(CellRun{y, z, low[0], high[0]})) {
                return true;
            }
        }
    }
    return true;
}

/// Reads the entries of one level that may overlap `bounds`. For each range of entries calls
/// reader.read(range, isOwn) -> bool, false to stop; isOwn(entry) must be asked about every hit, and
/// tells whether this range is the one that reports it. Returns false when stopped.
template <class Scalar, class Reader>
bool walkLevel(const Table<Scalar>& table, const Level<Scalar>& level, const Aabb<Scalar>& bounds,
               QueryCost& cost, Reader&& reader) {
    if (level.count() == 0) {
        return true;
    }
    const auto readWhole = [&] {
        const EntryRange all{level.firstEntry, level.lastEntry};
        cost.boxesTested += level.count();
        return reader.read(all, [](std::uint32_t) { return true; });
    };
    if (!level.hasCells) {
        return readWhole();
    }
    bool goOn = true;
    const bool byRows = forRowsOfBox(level, bounds, [&](const CellRun& run) {
        ++cost.rowsVisited;
        table.forRun(level, run, [&](const EntryRange& range) {
            cost.boxesTested += range.last - range.first;
            goOn = goOn && reader.read(range, [&](std::uint32_t entry) {
                return table.isInRow(level, entry, run.y, run.z);
            });
        });
        return goOn;
    });
    return byRows ? goOn : readWhole();
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

}  // namespace detail
}  // namespace hashphase
