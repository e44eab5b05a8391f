// SPDX-License-Identifier: Zlib

// Kernel part: finds what boxes overlap in a level. See kernels.inl.

// Looking up a run of buckets costs about as much as testing this many boxes one after another.
constexpr std::uint64_t kBoxesPerRun = 4;

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

// So few rows are read without a look at how long their runs are.
constexpr std::uint64_t kFewRows = 16;

// Whether the rows of a hashed level have more entries in their buckets, those of other rows and those
// that several of them share included, than there are.
template <class Scalar>
[[gnu::noinline]] bool haveMoreThanAll(const Level<Scalar>& level, const CellBlock& block) {
    const std::uint32_t* starts = level.bucketStart;
    const std::uint32_t length =
        lowest(static_cast<std::uint32_t>(block.extent(0)), level.bucketCount);
    std::uint64_t left = level.lastEntry - level.firstEntry;
    for (std::int32_t z = block.low[2]; z <= block.high[2]; ++z) {
        for (std::int32_t y = block.low[1]; y <= block.high[1]; ++y) {
            const std::uint32_t first =
                (level.rowBase(Row{y, z}) + static_cast<std::uint32_t>(block.low[0])) &
                (level.bucketCount - 1);
            const std::uint32_t end = first + length;
            const std::uint32_t wrapped = end > level.bucketCount ? end - level.bucketCount : 0;
            const std::uint64_t inRow = starts[lowest(end, level.bucketCount)] - starts[first] +
                                        std::uint64_t{starts[wrapped] - starts[0]};
            if (inRow > left) {
                return true;
            }
            left -= inRow;
        }
    }
    return false;
}

// Runs of up to kWidth rows, read with few branches in between: most are shorter than kWidth.
template <bool kIsDense, class Scalar, class Query, class Lanes>
void scanRows(const Level<Scalar>& level, const Query& query, const Lanes& box, const Run* runs,
              const Row* rows, std::uint32_t rowCount, PairSink& found, KernelCost& cost) {
    std::uint64_t hits = 0;
    std::uint32_t candidates = 0;
    std::uint32_t longest = 0;
    for (std::uint32_t k = 0; k < rowCount; ++k) {
        const std::uint32_t count = runs[k].last - runs[k].first;
        candidates += count;
        longest |= count;
        const std::uint32_t mask = box.template overlapMask<kWidth>(level.columns, runs[k].first) &
                                   laneMask(count, kWidth);
        hits |= std::uint64_t{mask} << (kWidth * k);
    }
    cost.boxesTested += candidates;
    makeRoom(found, kWidth * kWidth + 1);
    for (; hits != 0; hits &= hits - 1) {
        const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(hits));
        const std::uint32_t k = bit / kWidth;
        const std::uint32_t hit = runs[k].first + bit % kWidth;
        *found.next = {query.number, hit};
        found.next += isInRow<kIsDense>(level, hit, rows[k]) && query.finds(hit) ? 1 : 0;
    }
    for (std::uint32_t k = 0; longest >= kWidth && k < rowCount; ++k) {
        if (runs[k].last - runs[k].first > kWidth) {
            const Run rest = {runs[k].first + kWidth, runs[k].last};
            cost.boxesTested -= rest.last - rest.first;
            cost.boxesTested += scan<kIsDense>(level, query, rest, rows[k], found);
        }
    }
}

template <bool kIsDense, class Scalar, class Query>
[[gnu::flatten]] void walkBox(const Level<Scalar>& level, const Query& query, PairSink& found,
                              KernelCost& cost) {
    const CellBlock block = blockAround(level, query);
    if (block.isEmpty()) {
        return;
    }
    const auto box = query.template lanes<Pack<Scalar>>();
    const std::uint32_t count = level.lastEntry - level.firstEntry;
    const std::uint64_t rowCount = block.extent(1) * block.extent(2);
    const auto length = static_cast<std::uint32_t>(block.extent(0));
    bool isWhole = rowCount * kBoxesPerRun > count;
    if constexpr (!kIsDense) {
        // Rows that pass as many buckets as there are would have every box read about once a row.
        isWhole = isWhole || rowCount * lowest(length, level.bucketCount) >= level.bucketCount ||
                  (rowCount > kFewRows && haveMoreThanAll(level, block));
    }
    if (isWhole) {
        cost.boxesTested +=
            scan<true>(level, query, Run{level.firstEntry, level.lastEntry}, Row{}, found);
        return;
    }
    cost.rowsVisited += rowCount;
    const std::uint32_t* starts = level.bucketStart;
    Run runs[kWidth];
    Row rows[kWidth];
    std::uint32_t waiting = 0;
    for (std::int32_t z = block.low[2]; z <= block.high[2]; ++z) {
        for (std::int32_t y = block.low[1]; y <= block.high[1]; ++y) {
            // There is always room for a run that goes on at the beginning of the buckets.
            if (waiting + 2 > kWidth) {
                scanRows<kIsDense>(level, query, box, runs, rows, waiting, found, cost);
                waiting = 0;
            }
            const Row row{y, z};
            std::uint32_t first = level.rowBase(row) + static_cast<std::uint32_t>(block.low[0]);
            if constexpr (kIsDense) {
                runs[waiting] = {starts[first], starts[first + length]};
            } else {
                first = length >= level.bucketCount ? 0 : first & (level.bucketCount - 1);
                const std::uint32_t end = first + lowest(length, level.bucketCount);
                runs[waiting] = {starts[first], starts[lowest(end, level.bucketCount)]};
                if (end > level.bucketCount) {
                    rows[waiting++] = row;
                    runs[waiting] = {starts[0], starts[end - level.bucketCount]};
                }
            }
            rows[waiting++] = row;
        }
    }
    scanRows<kIsDense>(level, query, box, runs, rows, waiting, found, cost);
}

template <class Scalar, class Query>
void walk(const Level<Scalar>& level, const Query& query, PairSink& found, KernelCost& cost) {
    if (!level.hasCells()) {
        cost.boxesTested +=
            scan<true>(level, query, Run{level.firstEntry, level.lastEntry}, Row{}, found);
    } else if (level.isDense()) {
        walkBox<true>(level, query, found, cost);
    } else {
        walkBox<false>(level, query, found, cost);
    }
}

template <class Scalar>
void walkLevel(const Level<Scalar>& level, const GroupsView* groups, const Scalar* const* queries,
               std::uint32_t first, std::uint32_t last, PairSink& found, KernelCost& cost) {
    for (std::uint32_t number = first; number < last && groups == nullptr; ++number) {
        walk(level, Query<Scalar>{queries, number}, found, cost);
    }
    for (std::uint32_t number = first; number < last && groups != nullptr; ++number) {
        const GroupQuery<Scalar> query(level, *groups, Query<Scalar>{queries, number});
        if (query.findsAny()) {
            walk(level, query, found, cost);
        }
    }
}

template <class Scalar>
void walkWays(const Level<Scalar>& level, const Scalar* const* queries, const Way<Scalar>* ways,
              const std::uint32_t* wayOf, std::uint32_t first, std::uint32_t last, PairSink& found,
              KernelCost& cost) {
    for (std::uint32_t number = first; number < last; ++number) {
        walk(level, WayQuery<Scalar>{{queries, number}, &ways[wayOf[number]]}, found, cost);
    }
}
