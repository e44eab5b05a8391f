// SPDX-License-Identifier: Zlib

// Kernel part: which rows of cells are read for a box or an entry, and which entries these are. See
// kernels.inl. The only place that knows how the buckets of a hashed level wrap around.

// So few rows are read without a look at how long their runs are.
constexpr std::uint64_t kFewRows = 16;

/// The cells of a level in which whatever overlaps a box may be filed.
struct CellBlock {
    std::int32_t low[3];
    std::int32_t high[3];

    [[nodiscard]] bool isEmpty() const {
        return low[0] > high[0] || low[1] > high[1] || low[2] > high[2];
    }
    [[nodiscard]] std::uint64_t extent(int axis) const {
        return static_cast<std::uint64_t>(high[axis] - low[axis]) + 1;
    }
    [[nodiscard]] std::uint32_t rowLength() const { return static_cast<std::uint32_t>(extent(0)); }
    [[nodiscard]] std::uint64_t rowCount() const { return extent(1) * extent(2); }

    /// Calls visit(row) for each of its rows. Returns false as soon as visit() does.
    template <class Visit>
    [[HASHPHASE_ALWAYS_INLINE]] bool forRows(const Visit& visit) const {
        for (std::int32_t z = low[2]; z <= high[2]; ++z) {
            for (std::int32_t y = low[1]; y <= high[1]; ++y) {
                if (!visit(Row{y, z})) {
                    return false;
                }
            }
        }
        return true;
    }
};

// Of an inverted box, which may overlap boxes that it lies within, the block is the whole level; of
// one with a NaN, which overlaps nothing, it is empty.
template <class Scalar>
CellBlock blockAround(const Level<Scalar>& level, const Query<Scalar>& query) {
    CellBlock block;
    bool isOrdered = true;
    bool isNan = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Scalar min = query.columns[axis][query.number];
        const Scalar max = query.columns[axis + 3][query.number];
        isOrdered &= min <= max;
        isNan |= (min != min) | (max != max);
        const std::int32_t before = level.cell(min, axis) - 1;
        const std::int32_t last = level.cell(max, axis);
        block.low[axis] = before > level.low[axis] ? before : level.low[axis];
        block.high[axis] = last < level.high[axis] ? last : level.high[axis];
    }
    for (int axis = 0; !isOrdered && axis < 3; ++axis) {
        block.low[axis] = isNan ? 1 : level.low[axis];
        block.high[axis] = isNan ? 0 : level.high[axis];
    }
    return block;
}

/// Buckets of a row that follow one another. Behind the last bucket of a hashed level they go on at
/// its first one.
template <bool kIsDense>
struct BucketRange {
    std::uint32_t first;
    std::uint32_t end;  // one past, before they wrap around

    template <class Scalar>
    [[nodiscard]] bool wraps(const Level<Scalar>& level) const {
        return !kIsDense && end > level.bucketCount;
    }
    /// Their entries, but for those behind which they wrap around.
    template <class Scalar>
    [[nodiscard]] Run run(const Level<Scalar>& level) const {
        const std::uint32_t last = kIsDense ? end : lowest(end, level.bucketCount);
        return {level.bucketStart[first], level.bucketStart[last]};
    }
    /// The entries of those that have wrapped around; mostly none.
    template <class Scalar>
    [[nodiscard]] Run wrapped(const Level<Scalar>& level) const {
        const std::uint32_t last = wraps(level) ? end - level.bucketCount : 0;
        return {level.bucketStart[0], level.bucketStart[last]};
    }
};

/// The buckets of `length` cells of a row; of a hashed level, no bucket twice.
template <bool kIsDense, class Scalar>
BucketRange<kIsDense> bucketsOf(const Level<Scalar>& level, Row row, std::int32_t firstX,
                                std::uint32_t length) {
    if (!kIsDense && length >= level.bucketCount) {
        return {0, level.bucketCount};
    }
    const std::uint32_t first = level.template bucketOf<kIsDense>(firstX, row);
    return {first, first + length};
}

// Whether the rows of a hashed level have more entries in their buckets, those of other rows and those
// that several of them share included, than there are.
template <class Scalar>
[[HASHPHASE_NO_INLINE]] bool costsMoreThanFullScan(const Level<Scalar>& level,
                                                   const CellBlock& block) {
    std::uint64_t left = level.count();
    return !block.forRows([&](Row row) {
        const auto buckets = bucketsOf<false>(level, row, block.low[0], block.rowLength());
        const Run run = buckets.run(level);
        const Run wrapped = buckets.wrapped(level);
        const std::uint64_t inRow =
            run.last - run.first + std::uint64_t{wrapped.last - wrapped.first};
        const bool hasMore = inRow > left;
        left -= inRow;
        return !hasMore;
    });
}

/// Whether reading the rows of the block, which is not empty, costs more than reading the whole
/// level.
template <bool kIsDense, class Scalar>
bool costsMoreThanFullScan(const Level<Scalar>& level, const CellBlock& block) {
    const std::uint64_t rowCount = block.rowCount();
    if (rowCount * kBoxesPerRun > level.count()) {
        return true;
    }
    if constexpr (!kIsDense) {
        // Rows that pass as many buckets as there are would have every box read about once a row.
        return rowCount * lowest(block.rowLength(), level.bucketCount) >= level.bucketCount ||
               (rowCount > kFewRows && costsMoreThanFullScan(level, block));
    }
    return false;
}

// What one entry is tested against: what is behind it in the row of its cell, up to the next cell,
// and the rows that follow in (z, y) order, from one cell before to the next one. Of two neighbouring
// cells, exactly one reads the other.
constexpr Row kRowsOfSpace[] = {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
constexpr Row kRowsOfLayer[] = {{0, 0}, {1, 0}};
constexpr Row kRowsOfWall[] = {{0, 0}, {0, 1}};

/// The runs of the entries' neighbourhoods, one after the other. Those of a hashed level do not share
/// buckets, nor do two cells read each other's, as numberHashed() sees to: what overlaps is found once.
template <class Scalar, bool kIsDense, int kRows>
struct Neighbourhood {
    const Level<Scalar>& level;
    std::uint32_t
        offsets[kRows];  // of buckets, from an entry's to the first that is read; none is negative

    Neighbourhood(const Level<Scalar>& itsLevel, const Row* steps) : level(itsLevel) {
        for (int k = 0; k < kRows; ++k) {
            offsets[k] = static_cast<std::uint32_t>(level.offset(steps[k]) - 1);
        }
    }

    // The buckets of row k. Those of the entry's own row begin with the entry's.
    [[nodiscard]] BucketRange<kIsDense> buckets(std::uint32_t entry, int k) const {
        const std::uint32_t own = level.bucketOfEntry[entry] - level.firstBucket;
        if (k == 0) {
            return {own, own + 2};
        }
        // Of two laps, the one that is not negative.
        const std::uint32_t before = own + offsets[k];
        const std::uint32_t first = kIsDense ? before : lowest(before, before - level.bucketCount);
        return {first, first + 3};
    }

    // Sets the runs; returns whether some of them wrap around.
    bool read(std::uint32_t entry, Run* runs) const {
        bool wraps = false;
        for (int k = 0; k < kRows; ++k) {
            const BucketRange<kIsDense> range = buckets(entry, k);
            wraps |= range.wraps(level);
            runs[k] = range.run(level);
        }
        runs[0].first = entry + 1;
        return wraps;
    }
};
