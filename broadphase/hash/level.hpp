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

/// How a level files boxes. A dense one numbers a well-filled range of cells through (the paper's
/// formula), with empty cells between rows and between layers. A hashed one numbers cells through
/// wherever they lie, modulo the number of buckets: what is far apart may share buckets, as if it had
/// been moved together, and neighbouring rows are as far apart as those of a dense one. A list has no
/// cells: it has one bucket, which every walk reads whole.
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
    std::uint32_t sortedCount = 0;  // of sortedBuckets
    std::int64_t base = 0;          // the number of cell 0, 0, 0; none is negative
    double lapsPerBucket = 0;       // of a hashed one: 1 / bucketCount

    // Into the arrays of the table, which sets them when these are complete.
    const Scalar* columns[6] = {};                        // min x, y, z, max x, y, z of all entries
    const std::uint32_t* bucketStart = nullptr;           // of the level's own buckets, and the end
    const std::uint32_t* bucketOfEntry = nullptr;         // of all entries, counted over all levels
    const std::uint32_t* proxyIndices = nullptr;          // of all entries
    const SortedBucket<Scalar>* sortedBuckets = nullptr;  // the level's own, in ascending order
    // The min corners by which entries are filed: buckets are sorted by them.
    const Scalar* filedLow[3] = {};

    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] bool isDense() const noexcept {
        return kind == LevelKind::dense;
    }
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] bool hasCells() const noexcept {
        return kind != LevelKind::list;
    }
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t count() const noexcept {
        return lastEntry - firstEntry;
    }
    /// Whether a dense one has no cells, as the population is too sparse for it.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] bool isEmpty() const noexcept {
        return low[0] > high[0];
    }

    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::int32_t cell(Scalar x,
                                                             std::size_t axis) const noexcept {
        // Not 0 * infinity, along a flat axis.
        return inverseCellSize[axis] == 0 ? 0 : quantise(x, origin[axis], inverseCellSize[axis]);
    }

    /// By how much the numbers of a row's cells exceed those of row 0, 0.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::int64_t offset(Row row) const noexcept {
        return std::int64_t{row.y} * strideY + std::int64_t{row.z} * strideZ;
    }
    /// The bucket of a numbered cell, among the level's own.
    template <bool kIsDense>
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t bucketOf(
        std::int64_t number) const noexcept {
        const std::int64_t shifted = base + number;
        if constexpr (kIsDense) {
            return static_cast<std::uint32_t>(shifted);
        }
        // Not by a division of integers, which many processors are slow at. The quotient is below 2^31, and
        // rounded by less than 1.
        const auto count = static_cast<std::int64_t>(bucketCount);
        const auto laps = static_cast<std::int64_t>(static_cast<double>(shifted) * lapsPerBucket);
        std::int64_t rest = shifted - laps * count;
        rest += rest < 0 ? count : 0;
        rest -= rest >= count ? count : 0;
        return static_cast<std::uint32_t>(rest);
    }
    /// The bucket of a cell from low to high, among the level's own.
    template <bool kIsDense>
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t bucketOf(std::int32_t x,
                                                                  Row row) const noexcept {
        return bucketOf<kIsDense>(x + offset(row));
    }
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t bucket(std::int32_t x,
                                                                Row row) const noexcept {
        return isDense() ? bucketOf<true>(x, row) : bucketOf<false>(x, row);
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
