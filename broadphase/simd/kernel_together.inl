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
    std::uint32_t entryCount = 0;
    std::uint64_t rowCount = 0;

    /// Returns false when there is no room for the run.
    bool add(Run run, Row row) {
        entryCount += run.last - run.first;
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
    return block.forRows([&](Row row) {
        const auto buckets = bucketsOf<kIsDense>(level, row, block.low[0], block.rowLength());
        return packs.add(buckets.run(level), row) &&
               (!buckets.wraps(level) || packs.add(buckets.wrapped(level), row));
    });
}

// Gathers what is filed around the boxes from first to last. Returns false when they are better
// looked at one by one.
template <bool kIsDense, class Scalar>
[[HASHPHASE_FLATTEN]] bool gatherAround(const Level<Scalar>& level, const Scalar* const* queries,
                                        std::uint32_t first, std::uint32_t last, Packs& packs) {
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
    packs.rowCount = block.rowCount();
    return packs.rowCount <= kMostPacks && packs.rowCount * kBoxesPerRun <= level.count() &&
           gatherPacks<kIsDense>(level, block, packs);
}

template <bool kIsDense, class Scalar>
bool scanPacks(const Level<Scalar>& level, const Query<Scalar>& query, const Packs& packs,
               PairSink& found) {
    static_assert(kWidth * kMostPacks + 1 <= kMostRoom);
    const Lanes<Pack<Scalar>, Scalar> box(query.columns, query.number);
    if (!makeRoom(found, kWidth * packs.count + 1)) {
        return false;
    }
    for (std::uint32_t begin = 0; begin < packs.count; begin += 8) {
        std::uint64_t hits = 0;
        for (std::uint32_t k = 0; k < lowest(packs.count - begin, 8); ++k) {
            const std::uint32_t mask =
                box.template overlapMask<kWidth>(level.columns, packs.first[begin + k]) &
                packs.lanes[begin + k];
            hits |= std::uint64_t{mask} << (kWidth * k);
        }
        for (; hits != 0; hits &= hits - 1) {
            const std::uint32_t bit = lowestBit(hits);
            const std::uint32_t k = begin + bit / kWidth;
            const std::uint32_t hit = packs.first[k] + bit % kWidth;
            *found.next = {query.number, hit};
            found.next += isInRow<kIsDense>(level, hit, packs.rows[k]) ? 1 : 0;
        }
    }
    return true;
}

template <bool kIsDense, class Scalar>
[[HASHPHASE_FLATTEN]] bool scanAround(const Level<Scalar>& level, const Scalar* const* queries,
                                      std::uint32_t first, std::uint32_t last, const Packs& packs,
                                      PairSink& found, KernelCost& cost) {
    cost.rowsVisited += packs.rowCount;
    bool goesOn = true;
    for (std::uint32_t number = first; number < last && packs.count > 0 && goesOn; ++number) {
        cost.boxesTested += packs.entryCount;
        goesOn = scanPacks<kIsDense>(level, Query<Scalar>{queries, number}, packs, found);
    }
    return goesOn;
}

template <bool kIsDense, class Scalar>
bool walkGroup(const Level<Scalar>& level, const Scalar* const* queries, std::uint32_t first,
               std::uint32_t last, PairSink& found, KernelCost& cost) {
    Packs packs;
    return gatherAround<kIsDense>(level, queries, first, last, packs)
               ? scanAround<kIsDense>(level, queries, first, last, packs, found, cost)
               : queryLevel(level, nullptr, queries, first, last, found, cost);
}

template <class Scalar>
bool queryBatch(const Level<Scalar>& level, const Scalar* const* queries, std::uint32_t first,
                std::uint32_t last, PairSink& found, KernelCost& cost) {
    bool goesOn = true;
    for (std::uint32_t end = first; first < last && goesOn; first = end) {
        end = first + lowest(kTogether, last - first);
        if (!level.hasCells() || end - first == 1) {
            goesOn = queryLevel(level, nullptr, queries, first, end, found, cost);
        } else if (level.isDense()) {
            goesOn = walkGroup<true>(level, queries, first, end, found, cost);
        } else {
            goesOn = walkGroup<false>(level, queries, first, end, found, cost);
        }
    }
    return goesOn;
}
