// SPDX-License-Identifier: Zlib

// The kernels, for one instruction set. Included, after <broadphase/detail/kernel_types.hpp> and the
// definition of Lanes<Scalar>, by the file that is compiled for it, inside a namespace of its own.
//
// Lanes<Scalar> is a box to test against others:
//
//   Lanes(columns, i)            box number i of six columns
//   overlapMask(columns, first)  bit k tells whether box first + k overlaps it, for kWidth boxes
//   longOverlapMask(columns, first)  the same for kLongWidth boxes
//   isApart(a, b)                whether two padded boxes do not overlap
//
// and of quantiseCorners(level, box, low), which sets `low` to the cell of the box's min corner and
// returns whether the box spans one or two cells an axis, none of them where cells are clamped.
//
// Nothing here may call a function that is not defined in this file or always inlined.

constexpr std::uint32_t kWidth = 8;

// Looking up a run of buckets costs about as much as testing this many boxes one after another.
constexpr std::uint64_t kBoxesPerRun = 4;

inline std::uint32_t lowest(std::uint32_t a, std::uint32_t b) {
    return a < b ? a : b;
}

inline std::uint32_t laneMask(std::uint32_t count) {
    return (1U << lowest(count, kWidth)) - 1;
}

inline void makeRoom(PairSink& sink, std::size_t count) {
    if (static_cast<std::size_t>(sink.end - sink.next) < count) {
        sink.grow(sink, count);
    }
}

template <class Scalar>
std::int32_t cellOf(const LevelView<Scalar>& level, Scalar x, int axis) {
    const Scalar inverse = level.inverseCellSize[axis];
    return inverse == 0 ? 0 : quantise(x, level.origin[axis], inverse);
}

template <class Scalar>
std::uint32_t rowBase(const LevelView<Scalar>& level, Row row) {
    const std::uint32_t number = static_cast<std::uint32_t>(row.y) * level.strideY +
                                 static_cast<std::uint32_t>(row.z) * level.strideZ;
    return level.isDense ? number + level.denseBase : mixRow(number);
}

/// Entries to be read, from first to last, one past.
struct Run {
    std::uint32_t first;
    std::uint32_t last;
};

// Hashed rows may share buckets: of the entries of a run, those in the row are hits.
template <bool kIsDense, class Scalar>
bool isInRow(const LevelView<Scalar>& level, std::uint32_t entry, Row row) {
    if constexpr (kIsDense) {
        return true;
    } else {
        const Row own = level.rowOfEntry[entry];
        return own.y == row.y && own.z == row.z;
    }
}

// Tests all entries of a run against one box.
template <bool kIsDense, class Scalar>
void scan(const LevelView<Scalar>& level, const Lanes<Scalar>& box, std::uint32_t number, Run run,
          Row row, PairSink& found) {
    constexpr std::uint32_t width = Lanes<Scalar>::kLongWidth;
    makeRoom(found, run.last - run.first);
    for (std::uint32_t first = run.first; first < run.last; first += width) {
        const std::uint32_t lanes = (1U << lowest(run.last - first, width)) - 1;
        std::uint32_t mask = box.longOverlapMask(level.columns, first) & lanes;
        for (; mask != 0; mask &= mask - 1) {
            const std::uint32_t hit = first + static_cast<std::uint32_t>(__builtin_ctz(mask));
            *found.next = {number, hit};
            found.next += isInRow<kIsDense>(level, hit, row) ? 1 : 0;
        }
    }
}

// --- Filing --------------------------------------------------------------------------------------

template <class Scalar>
bool isNan(const PaddedBox<Scalar>& box) {
    bool result = false;
    for (int axis = 0; axis < 3; ++axis) {
        result |= (box.low[axis] != box.low[axis]) | (box.high[axis] != box.high[axis]);
    }
    return result;
}

template <class Scalar>
bool isWithin(const LevelView<Scalar>& level, const std::int32_t* cell) {
    bool result = true;
    for (int axis = 0; axis < 3; ++axis) {
        result &= (level.low[axis] <= cell[axis]) & (cell[axis] <= level.high[axis]);
    }
    return result;
}

template <class Scalar>
void fileBoxes(const LevelView<Scalar>* levels, std::size_t levelCount,
               const PaddedBox<Scalar>* boxes, std::size_t count, std::uint32_t* buckets) {
    const std::size_t listed = levelCount - 1;
    for (std::size_t i = 0; i < count; ++i) {
        const PaddedBox<Scalar>& box = boxes[i];
        std::size_t number = 0;
        std::int32_t cell[4] = {};
        // The finest cells that are no smaller than the box, or, where rounding makes it span three
        // of these, coarser ones. Only the cells themselves decide, so that no rounding can file a
        // box where it is not looked for.
        while (number < listed &&
               !(fitsEdge(levels[number], box) && quantiseCorners(levels[number], box, cell))) {
            number += 2;
        }
        if (number == listed) {
            buckets[i] = isNan(box) ? kNoBucket : levels[listed].firstBucket;
            continue;
        }
        const LevelView<Scalar>& level = levels[number + (isWithin(levels[number], cell) ? 0 : 1)];
        const std::uint32_t sum =
            rowBase(level, Row{cell[1], cell[2]}) + static_cast<std::uint32_t>(cell[0]);
        buckets[i] = level.firstBucket + (level.isDense ? sum : sum & (level.bucketCount - 1));
    }
}

// --- Within a level ------------------------------------------------------------------------------

// What one entry is tested against: what is behind it in the row of its cell, up to the next cell,
// and the rows that follow in (z, y) order, from one cell before to the next one. Of two neighbouring
// cells, exactly one reads the other.
constexpr Row kRowsOfSpace[] = {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
constexpr Row kRowsOfLayer[] = {{0, 0}, {1, 0}};
constexpr Row kRowsOfWall[] = {{0, 0}, {0, 1}};

inline Row operator+(Row a, Row b) {
    return {a.y + b.y, a.z + b.z};
}

/// The runs of the entries' neighbourhoods, one after the other.
template <class Scalar, bool kIsDense, int kRows>
struct Neighbourhood {
    const LevelView<Scalar>& level;
    const Row* steps;
    std::uint32_t offsets[kRows];  // of buckets, where these are dense

    Neighbourhood(const LevelView<Scalar>& itsLevel, const Row* itsSteps)
        : level(itsLevel), steps(itsSteps) {
        for (int k = 0; k < kRows; ++k) {
            offsets[k] = static_cast<std::uint32_t>(steps[k].y) * level.strideY +
                         static_cast<std::uint32_t>(steps[k].z) * level.strideZ;
        }
    }

    Row row(std::uint32_t entry, int k) const {
        return kIsDense ? Row{0, 0} : level.rowOfEntry[entry] + steps[k];
    }

    // The bucket before the entry's own in another of its rows, where these are hashed.
    std::uint32_t bucketBefore(std::uint32_t entry, int k) const {
        const Row own = level.rowOfEntry[entry];
        const std::uint32_t bucket = level.bucketOfEntry[entry] - level.firstBucket;
        return (bucket - rowBase(level, own) + rowBase(level, own + steps[k]) - 1) &
               (level.bucketCount - 1);
    }

    // Sets the runs; returns whether some of them go on at the beginning of the buckets.
    bool read(std::uint32_t entry, Run* runs) const {
        const std::uint32_t* starts = level.bucketStart;
        const std::uint32_t bucket = level.bucketOfEntry[entry] - level.firstBucket;
        const std::uint32_t end = level.bucketCount;
        if constexpr (kIsDense) {
            runs[0] = {entry + 1, starts[bucket + 2]};
            for (int k = 1; k < kRows; ++k) {
                const std::uint32_t middle = bucket + offsets[k];
                runs[k] = {starts[middle - 1], starts[middle + 2]};
            }
            return false;
        } else {
            bool wraps = bucket + 2 > end;
            runs[0] = {entry + 1, starts[lowest(bucket + 2, end)]};
            for (int k = 1; k < kRows; ++k) {
                const std::uint32_t first = bucketBefore(entry, k);
                wraps |= first + 3 > end;
                runs[k] = {starts[first], starts[lowest(first + 3, end)]};
            }
            return wraps;
        }
    }

    // How run k goes on at the beginning of the buckets; mostly not at all.
    Run wrapped(std::uint32_t entry, int k) const {
        const std::uint32_t first = bucketBefore(entry, k);
        // A run in the entry's own row begins with the entry, whose bucket may be the first one.
        const bool hasBegun = k == 0 && first + 1 == level.bucketCount;
        if (first + 3 <= level.bucketCount || hasBegun) {
            return {0, 0};
        }
        return {level.bucketStart[0], level.bucketStart[first + 3 - level.bucketCount]};
    }
};

// Flattened, because compilers leave calls in this loop otherwise.
template <class Scalar, bool kIsDense, int kRows>
[[gnu::flatten]] void joinRows(const LevelView<Scalar>& level, const Row* steps,
                               std::uint32_t firstEntry, std::uint32_t lastEntry, PairSink& found,
                               KernelCost& cost) {
    constexpr int kUnbranchedHits = 2;
    const Neighbourhood<Scalar, kIsDense, kRows> around(level, steps);
    std::uint64_t boxesTested = 0;
    for (std::uint32_t entry = firstEntry; entry < lastEntry; ++entry) {
        Run runs[kRows + 1];
        runs[kRows] = {0, 0};
        const bool wraps = around.read(entry, runs);
        std::uint32_t candidates = 0;
        std::uint32_t longest = 0;
        for (int k = 0; k < kRows; ++k) {
            const std::uint32_t count = runs[k].last - runs[k].first;
            candidates += count;
            longest |= count;
        }
        boxesTested += candidates;
        makeRoom(found, candidates + kUnbranchedHits);

        // The first boxes of every run, with no branch in between that could be mispredicted.
        const Lanes<Scalar> box(level.columns, entry);
        std::uint64_t hits = 0;
        for (int k = 0; k < kRows; ++k) {
            const std::uint32_t mask = box.overlapMask(level.columns, runs[k].first) &
                                       laneMask(runs[k].last - runs[k].first);
            hits |= std::uint64_t{mask} << (kWidth * static_cast<unsigned>(k));
        }
        // Most entries have at most two hits: these are written at any rate, and count if they are
        // any.
        constexpr std::uint64_t kNoHit = std::uint64_t{1} << (kWidth * kRows);
        IndexPair* next = found.next;
        const auto take = [&] {
            const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(hits | kNoHit));
            const std::uint32_t k = bit / kWidth;
            const std::uint32_t hit = runs[k].first + bit % kWidth;
            *next = {entry, hit};
            const bool isHit =
                hits != 0 &&
                isInRow<kIsDense>(level, hit, around.row(entry, static_cast<int>(k % kRows)));
            next += isHit ? 1 : 0;
            hits &= hits - 1;
        };
        for (int i = 0; i < kUnbranchedHits; ++i) {
            take();
        }
        while (hits != 0) {
            take();
        }
        found.next = next;

        if (longest >= kWidth) {
            for (int k = 0; k < kRows; ++k) {
                if (runs[k].last - runs[k].first > kWidth) {
                    scan<kIsDense>(level, box, entry, Run{runs[k].first + kWidth, runs[k].last},
                                   around.row(entry, k), found);
                }
            }
        }
        if (wraps) {
            for (int k = 0; k < kRows; ++k) {
                const Run rest = around.wrapped(entry, k);
                boxesTested += rest.last - rest.first;
                scan<kIsDense>(level, box, entry, rest, around.row(entry, k), found);
            }
        }
    }
    cost.boxesTested += boxesTested;
    cost.rowsVisited += std::uint64_t{lastEntry - firstEntry} * kRows;
}

template <class Scalar, bool kIsDense>
void joinDenseOrHashed(const LevelView<Scalar>& level, std::uint32_t firstEntry,
                       std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    const bool isOneRow = level.low[1] == level.high[1];
    const bool isOneLayer = level.low[2] == level.high[2];
    if (isOneRow && isOneLayer) {
        joinRows<Scalar, kIsDense, 1>(level, kRowsOfSpace, firstEntry, lastEntry, found, cost);
    } else if (isOneLayer) {
        joinRows<Scalar, kIsDense, 2>(level, kRowsOfLayer, firstEntry, lastEntry, found, cost);
    } else if (isOneRow) {
        joinRows<Scalar, kIsDense, 2>(level, kRowsOfWall, firstEntry, lastEntry, found, cost);
    } else {
        joinRows<Scalar, kIsDense, 5>(level, kRowsOfSpace, firstEntry, lastEntry, found, cost);
    }
}

template <class Scalar>
void joinLevel(const LevelView<Scalar>& level, std::uint32_t firstEntry, std::uint32_t lastEntry,
               PairSink& found, KernelCost& cost) {
    if (level.isDense) {
        joinDenseOrHashed<Scalar, true>(level, firstEntry, lastEntry, found, cost);
    } else {
        joinDenseOrHashed<Scalar, false>(level, firstEntry, lastEntry, found, cost);
    }
}

template <class Scalar>
void joinList(const Scalar* const* columns, std::uint32_t first, std::uint32_t last,
              std::uint32_t end, PairSink& found, KernelCost& cost) {
    LevelView<Scalar> list{};
    for (int column = 0; column < 6; ++column) {
        list.columns[column] = columns[column];
    }
    for (std::uint32_t entry = first; entry < last; ++entry) {
        cost.boxesTested += end - entry - 1;
        scan<true>(list, Lanes<Scalar>(columns, entry), entry, Run{entry + 1, end}, Row{}, found);
    }
}

// --- Boxes against a level -----------------------------------------------------------------------

/// The cells of a level in which whatever overlaps a box may be filed.
struct CellBlock {
    std::int32_t low[3];
    std::int32_t high[3];

    bool isEmpty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
    std::uint64_t extent(int axis) const {
        return static_cast<std::uint64_t>(high[axis] - low[axis]) + 1;
    }
};

// Where an inverted or NaN box can overlap anything, the block is the whole level.
template <class Scalar>
CellBlock blockAround(const LevelView<Scalar>& level, const Scalar* const* queries,
                      std::uint32_t number) {
    CellBlock block;
    bool isOrdered = true;
    for (int axis = 0; axis < 3; ++axis) {
        const Scalar min = queries[axis][number];
        const Scalar max = queries[axis + 3][number];
        isOrdered &= min <= max;
        const std::int32_t before = cellOf(level, min, axis) - 1;
        const std::int32_t last = cellOf(level, max, axis);
        block.low[axis] = before > level.low[axis] ? before : level.low[axis];
        block.high[axis] = last < level.high[axis] ? last : level.high[axis];
    }
    for (int axis = 0; !isOrdered && axis < 3; ++axis) {
        block.low[axis] = level.low[axis];
        block.high[axis] = level.high[axis];
    }
    return block;
}

// Runs of up to kWidth rows, read with few branches in between: most are shorter than kWidth.
template <bool kIsDense, class Scalar>
void scanRows(const LevelView<Scalar>& level, const Lanes<Scalar>& box, std::uint32_t number,
              const Run* runs, const Row* rows, std::uint32_t rowCount, PairSink& found,
              KernelCost& cost) {
    std::uint64_t hits = 0;
    std::uint32_t candidates = 0;
    std::uint32_t longest = 0;
    for (std::uint32_t k = 0; k < rowCount; ++k) {
        const std::uint32_t count = runs[k].last - runs[k].first;
        candidates += count;
        longest |= count;
        const std::uint32_t mask = box.overlapMask(level.columns, runs[k].first) & laneMask(count);
        hits |= std::uint64_t{mask} << (kWidth * k);
    }
    cost.boxesTested += candidates;
    makeRoom(found, candidates + 1);
    for (; hits != 0; hits &= hits - 1) {
        const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(hits));
        const std::uint32_t k = bit / kWidth;
        const std::uint32_t hit = runs[k].first + bit % kWidth;
        *found.next = {number, hit};
        found.next += isInRow<kIsDense>(level, hit, rows[k]) ? 1 : 0;
    }
    for (std::uint32_t k = 0; longest >= kWidth && k < rowCount; ++k) {
        if (runs[k].last - runs[k].first > kWidth) {
            scan<kIsDense>(level, box, number, Run{runs[k].first + kWidth, runs[k].last}, rows[k],
                           found);
        }
    }
}

template <class Scalar, bool kIsDense>
[[gnu::flatten]] void walkBox(const LevelView<Scalar>& level, const Scalar* const* queries,
                              std::uint32_t number, PairSink& found, KernelCost& cost) {
    const CellBlock block = blockAround(level, queries, number);
    if (block.isEmpty()) {
        return;
    }
    const Lanes<Scalar> box(queries, number);
    const std::uint32_t count = level.lastEntry - level.firstEntry;
    const std::uint64_t rowCount = block.extent(1) * block.extent(2);
    if (rowCount * kBoxesPerRun > count) {
        cost.boxesTested += count;
        scan<true>(level, box, number, Run{level.firstEntry, level.lastEntry}, Row{}, found);
        return;
    }
    cost.rowsVisited += rowCount;
    const std::uint32_t* starts = level.bucketStart;
    const auto length = static_cast<std::uint32_t>(block.extent(0));
    Run runs[kWidth];
    Row rows[kWidth];
    std::uint32_t waiting = 0;
    for (std::int32_t z = block.low[2]; z <= block.high[2]; ++z) {
        for (std::int32_t y = block.low[1]; y <= block.high[1]; ++y) {
            // There is always room for a run that goes on at the beginning of the buckets.
            if (waiting + 2 > kWidth) {
                scanRows<kIsDense>(level, box, number, runs, rows, waiting, found, cost);
                waiting = 0;
            }
            const Row row{y, z};
            std::uint32_t first = rowBase(level, row) + static_cast<std::uint32_t>(block.low[0]);
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
    scanRows<kIsDense>(level, box, number, runs, rows, waiting, found, cost);
}

template <class Scalar>
void walkLevel(const LevelView<Scalar>& level, const Scalar* const* queries, std::uint32_t first,
               std::uint32_t last, PairSink& found, KernelCost& cost) {
    for (std::uint32_t number = first; number < last; ++number) {
        if (!level.hasCells) {
            cost.boxesTested += level.lastEntry - level.firstEntry;
            scan<true>(level, Lanes<Scalar>(queries, number), number,
                       Run{level.firstEntry, level.lastEntry}, Row{}, found);
        } else if (level.isDense) {
            walkBox<Scalar, true>(level, queries, number, found, cost);
        } else {
            walkBox<Scalar, false>(level, queries, number, found, cost);
        }
    }
}

// --- Couples -------------------------------------------------------------------------------------

template <class Scalar>
std::size_t selectApart(const IndexPair* couples, std::size_t count, const std::uint32_t* order,
                        const PaddedBox<Scalar>* boxes, IndexPair* apart) {
    std::size_t selected = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const IndexPair couple = couples[i];
        const std::uint32_t a = order != nullptr ? order[couple.a] : couple.a;
        const std::uint32_t b = order != nullptr ? order[couple.b] : couple.b;
        apart[selected] = couple;
        selected += Lanes<Scalar>::isApart(boxes[a], boxes[b]) ? 1 : 0;
    }
    return selected;
}

template <class Scalar>
constexpr Kernels<Scalar> kKernels{&fileBoxes<Scalar>, &joinLevel<Scalar>, &walkLevel<Scalar>,
                                   &joinList<Scalar>, &selectApart<Scalar>};
