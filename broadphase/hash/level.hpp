// SPDX-License-Identifier: Zlib
#pragma once

// One level of a table, as the table keeps it and as kernels read it. Kernels are compiled for several
// instruction sets: what stands here has plain arrays, and may call only what is always inlined, as
// simd/kernel_types.hpp says.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/hash/sorted_bucket.hpp>

#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// A row of cells, along x.
struct Row {
    std::int32_t y;
    std::int32_t z;
};

/// A hash of a row's number whose lower bits are well mixed.
[[nodiscard, gnu::always_inline]] inline std::uint32_t mixRow(std::uint32_t row) noexcept {
    std::uint32_t hash = row ^ (row >> 16);
    hash *= 0x7feb352dU;
    return hash ^ (hash >> 15);
}

/// How a level files boxes. A dense one numbers a well-filled range of cells through (the paper's
/// formula), with empty cells between rows and between layers. A hashed one hashes rows into a number of
/// buckets that is a power of two. A list has no cells: it has one bucket, which every walk reads whole.
enum class LevelKind : std::uint8_t { dense, hashed, list };

/// Which entries a level has, how coordinates become its cells, and how its rows of cells become
/// buckets.
template <class Scalar>
struct Level {
    LevelKind kind = LevelKind::list;
    Scalar origin[4] = {};
    Scalar inverseCellSize[4] = {};  // 0 along a flat axis, which has one cell: 0
    Scalar largestEdge = 0;          // of boxes that are filed by their cells
    // Between which coordinates the boxes lie, along flat axes.
    Scalar lowest[4] = {};
    Scalar highest[4] = {};
    std::uint32_t firstEntry = 0;
    std::uint32_t lastEntry = 0;  // one past
    std::uint32_t firstBucket = 0;
    std::uint32_t bucketCount = 1;
    // Every entry's cell lies from low to high.
    std::int32_t low[4] = {};
    std::int32_t high[4] = {};
    std::uint32_t strideY = 0;
    std::uint32_t strideZ = 0;
    std::uint32_t denseBase = 0;
    std::uint32_t sortedCount = 0;  // of sortedBuckets

    // Into the arrays of the table, which sets them when these are complete.
    const Scalar* columns[6] = {};                        // min x, y, z, max x, y, z of all entries
    const std::uint32_t* bucketStart = nullptr;           // of the level's own buckets, and the end
    const std::uint32_t* bucketOfEntry = nullptr;         // of all entries, counted over all levels
    const std::uint32_t* proxyIndices = nullptr;          // of all entries
    const Row* rowOfEntry = nullptr;                      // of all entries, where a level is hashed
    const SortedBucket<Scalar>* sortedBuckets = nullptr;  // the level's own, in ascending order
    // By what these are sorted: the min corners by which entries are filed, so many numbers apart.
    const Scalar* sortKeys[3] = {};
    std::uint32_t sortStride = 1;

    [[nodiscard, gnu::always_inline]] bool isDense() const noexcept {
        return kind == LevelKind::dense;
    }
    [[nodiscard, gnu::always_inline]] bool hasCells() const noexcept {
        return kind != LevelKind::list;
    }
    [[nodiscard, gnu::always_inline]] std::uint32_t count() const noexcept {
        return lastEntry - firstEntry;
    }

    [[nodiscard, gnu::always_inline]] std::int32_t cell(Scalar x, std::size_t axis) const noexcept {
        // Not 0 * infinity, along a flat axis.
        return inverseCellSize[axis] == 0 ? 0 : quantise(x, origin[axis], inverseCellSize[axis]);
    }

    /// Bucket of cell x = 0 of a row, among the level's own; of a hashed one before the modulo.
    template <bool kIsDense>
    [[nodiscard, gnu::always_inline]] std::uint32_t rowBase(Row row) const noexcept {
        const std::uint32_t number = static_cast<std::uint32_t>(row.y) * strideY +
                                     static_cast<std::uint32_t>(row.z) * strideZ;
        return kIsDense ? number + denseBase : mixRow(number);
    }

    /// Bucket of a cell from low to high, among the level's own.
    [[nodiscard, gnu::always_inline]] std::uint32_t bucket(std::int32_t x, Row row) const noexcept {
        const auto column = static_cast<std::uint32_t>(x);
        return isDense() ? rowBase<true>(row) + column
                         : (rowBase<false>(row) + column) & (bucketCount - 1);
    }
};

/// The two levels of one cell size. A box whose cell lies from low to high of the dense one is filed there,
/// the others on the hashed one.
template <class Scalar>
struct SizeClass {
    const Level<Scalar>* dense;
    const Level<Scalar>* hashed;
};

}  // namespace hashphase::detail
