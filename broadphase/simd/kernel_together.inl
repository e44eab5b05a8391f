// SPDX-License-Identifier: Zlib

// Kernel part: finds what a few boxes overlap that are near each other, looking up once what is filed
// around them all. See kernels.inl.

// So many boxes are looked at together. A box alone takes about as long as testing it against
// kMostPacks * kWidth others.
constexpr std::uint32_t kTogether = 4;
constexpr std::uint32_t kMostPacks = 16;

/// What is filed around some boxes, in pieces of up to kWidth.
struct Packs {
    std::uint32_t first[kMostPacks];  // entry
    std::uint32_t lanes[kMostPacks];  // a bit for each entry
    Row rows[kMostPacks];
    std::uint32_t count = 0;
    std::uint32_t entries = 0;

    /// Returns false when there is no room for the run.
    bool add(Run run, Row row) {
        entries += run.last - run.first;
        for (std::uint32_t at = run.first; at < run.last; at += kWidth) {
            if (count == kMostPacks) {
                return false;
            }
            first[count] = at;
            lanes[count] = laneMask(run.last - at, kWidth);
            rows[count++] = row;
        }
        return true;
    }
};

// Returns false when there are too many.
template <bool kIsDense, class Scalar>
bool gatherPacks(const Level<Scalar>& level, const CellBlock& block, Packs& packs) {
    const std::uint32_t* starts = level.bucketStart;
    const auto length = static_cast<std::uint32_t>(block.extent(0));
    for (std::int32_t z = block.low[2]; z <= block.high[2]; ++z) {
        for (std::int32_t y = block.low[1]; y <= block.high[1]; ++y) {
            const Row row{y, z};
            std::uint32_t first = level.rowBase(row) + static_cast<std::uint32_t>(block.low[0]);
            if constexpr (kIsDense) {
                if (!packs.add({starts[first], starts[first + length]}, row)) {
                    return false;
                }
            } else {
                first = length >= level.bucketCount ? 0 : first & (level.bucketCount - 1);
                const std::uint32_t end = first + lowest(length, level.bucketCount);
                const std::uint32_t wrapped = end > level.bucketCount ? end - level.bucketCount : 0;
                if (!packs.add({starts[first], starts[lowest(end, level.bucketCount)]}, row) ||
                    !packs.add({starts[0], starts[wrapped]}, row)) {
                    return false;
                }
            }
        }
    }
    return true;
}

template <bool kIsDense, class Scalar>
void scanPacks(const Level<Scalar>& level, const Query<Scalar>& query, const Packs& packs,
               PairSink& found) {
    const Lanes<Pack<Scalar>, Scalar> box(query.columns, query.number);
    makeRoom(found, kWidth * packs.count + 1);
    for (std::uint32_t begin = 0; begin < packs.count; begin += 8) {
        std::uint64_t hits = 0;
        for (std::uint32_t k = 0; k < lowest(packs.count - begin, 8); ++k) {
            const std::uint32_t mask =
                box.template overlapMask<kWidth>(level.columns, packs.first[begin + k]) &
                packs.lanes[begin + k];
            hits |= std::uint64_t{mask} << (kWidth * k);
        }
        for (; hits != 0; hits &= hits - 1) {
            const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(hits));
            const std::uint32_t k = begin + bit / kWidth;
            const std::uint32_t hit = packs.first[k] + bit % kWidth;
            *found.next = {query.number, hit};
            found.next += isInRow<kIsDense>(level, hit, packs.rows[k]) ? 1 : 0;
        }
    }
}

// Returns false when the boxes are better looked at one by one.
template <class Scalar, bool kIsDense>
[[gnu::flatten]] bool walkBoxes(const Level<Scalar>& level, const Scalar* const* queries,
                                std::uint32_t first, std::uint32_t last, PairSink& found,
                                KernelCost& cost) {
    // The box around all. Whatever overlaps one of them, be it inverted, overlaps this one, when this
    // one is not inverted; a NaN is left out, as it overlaps nothing.
    Scalar around[6];
    const Scalar* columns[6];
    for (int axis = 0; axis < 3; ++axis) {
        Scalar low = queries[axis][first];
        Scalar high = queries[axis + 3][first];
        for (std::uint32_t number = first + 1; number < last; ++number) {
            low = queries[axis][number] < low ? queries[axis][number] : low;
            high = queries[axis + 3][number] > high ? queries[axis + 3][number] : high;
        }
        if (!(low <= high)) {
            return false;
        }
        around[axis] = low;
        around[axis + 3] = high;
        columns[axis] = &around[axis];
        columns[axis + 3] = &around[axis + 3];
    }
    const CellBlock block = blockAround(level, Query<Scalar>{columns, 0});
    if (block.isEmpty()) {
        return true;
    }
    const std::uint64_t rowCount = block.extent(1) * block.extent(2);
    Packs packs;
    if (rowCount > kMostPacks || rowCount * kBoxesPerRun > level.lastEntry - level.firstEntry ||
        !gatherPacks<kIsDense>(level, block, packs)) {
        return false;
    }
    cost.rowsVisited += rowCount;
    for (std::uint32_t number = first; number < last; ++number) {
        cost.boxesTested += packs.entries;
        scanPacks<kIsDense>(level, Query<Scalar>{queries, number}, packs, found);
    }
    return true;
}

template <class Scalar>
void walkTogether(const Level<Scalar>& level, const Scalar* const* queries, std::uint32_t first,
                  std::uint32_t last, PairSink& found, KernelCost& cost) {
    for (std::uint32_t end = first; first < last; first = end) {
        end = first + lowest(kTogether, last - first);
        bool isDone = false;
        if (level.hasCells() && end - first > 1) {
            isDone = level.isDense()
                         ? walkBoxes<Scalar, true>(level, queries, first, end, found, cost)
                         : walkBoxes<Scalar, false>(level, queries, first, end, found, cost);
        }
        if (!isDone) {
            walkLevel(level, nullptr, queries, first, end, found, cost);
        }
    }
}
