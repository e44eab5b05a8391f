// SPDX-License-Identifier: Zlib

// Kernel part: finds the couples within a level. See kernels.inl.

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
    const Level<Scalar>& level;
    const Row* steps;
    std::uint32_t offsets[kRows];  // of buckets, where these are dense

    Neighbourhood(const Level<Scalar>& itsLevel, const Row* itsSteps)
        : level(itsLevel), steps(itsSteps) {
        for (int k = 0; k < kRows; ++k) {
            offsets[k] = static_cast<std::uint32_t>(steps[k].y) * level.strideY +
                         static_cast<std::uint32_t>(steps[k].z) * level.strideZ;
        }
    }

    [[nodiscard]] Row row(std::uint32_t entry, int k) const {
        return kIsDense ? Row{0, 0} : level.rowOfEntry[entry] + steps[k];
    }

    // The bucket before the entry's own in another of its rows, where these are hashed.
    [[nodiscard]] std::uint32_t bucketBefore(std::uint32_t entry, int k) const {
        const Row own = level.rowOfEntry[entry];
        const std::uint32_t bucket = level.bucketOfEntry[entry] - level.firstBucket;
        return (bucket - level.rowBase(own) + level.rowBase(own + steps[k]) - 1) &
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
    [[nodiscard]] Run wrapped(std::uint32_t entry, int k) const {
        const std::uint32_t first = bucketBefore(entry, k);
        // A run in the entry's own row begins with the entry, whose bucket may be the first one.
        const bool hasBegun = k == 0 && first + 1 == level.bucketCount;
        if (first + 3 <= level.bucketCount || hasBegun) {
            return {0, 0};
        }
        return {level.bucketStart[0], level.bucketStart[first + 3 - level.bucketCount]};
    }
};

/// The queries of a join: for all that overlaps an entry, or for what it may pair with.
struct ForAll {
    template <class Scalar>
    [[nodiscard]] Query<Scalar> operator()(const Level<Scalar>& level, std::uint32_t entry) const {
        return {level.columns, entry};
    }
};
struct ForGroups {
    const GroupsView* view;

    template <class Scalar>
    [[nodiscard]] GroupQuery<Scalar> operator()(const Level<Scalar>& level,
                                                std::uint32_t entry) const {
        return {level, *view, Query<Scalar>{level.columns, entry}};
    }
};

// Flattened, because compilers leave calls in this loop otherwise.
template <class Scalar, bool kIsDense, int kRows, class QueryOf>
[[gnu::flatten]] void joinRows(const Level<Scalar>& level, const Row* steps, const QueryOf& queryOf,
                               std::uint32_t firstEntry, std::uint32_t lastEntry, PairSink& found,
                               KernelCost& cost) {
    constexpr int kUnbranchedHits = 2;
    const Neighbourhood<Scalar, kIsDense, kRows> around(level, steps);
    std::uint64_t boxesTested = 0;
    for (std::uint32_t entry = firstEntry; entry < lastEntry; ++entry) {
        const auto query = queryOf(level, entry);
        if (!query.findsAny()) {
            continue;
        }
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
        makeRoom(found, kWidth * kRows + kUnbranchedHits);

        // The first boxes of every run, with no branch in between that could be mispredicted.
        const Lanes<Pack<Scalar>, Scalar> box(level.columns, entry);
        std::uint64_t hits = 0;
        for (int k = 0; k < kRows; ++k) {
            const std::uint32_t mask =
                box.template overlapMask<kWidth>(level.columns, runs[k].first) &
                laneMask(runs[k].last - runs[k].first, kWidth);
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
                isInRow<kIsDense>(level, hit, around.row(entry, static_cast<int>(k % kRows))) &&
                query.finds(hit);
            next += isHit ? 1 : 0;
            hits &= hits - 1;
        };
        for (int i = 0; i < kUnbranchedHits; ++i) {
            take();
        }
        while (hits != 0) {  // NOLINT(bugprone-infinite-loop): take() takes one away
            take();
        }
        found.next = next;

        if (longest >= kWidth) {
            for (int k = 0; k < kRows; ++k) {
                if (runs[k].last - runs[k].first > kWidth) {
                    const Run rest = {runs[k].first + kWidth, runs[k].last};
                    boxesTested -= rest.last - rest.first;
                    boxesTested += scan<kIsDense>(level, query, rest, around.row(entry, k), found);
                }
            }
        }
        if (wraps) {
            for (int k = 0; k < kRows; ++k) {
                const Run rest = around.wrapped(entry, k);
                boxesTested += scan<kIsDense>(level, query, rest, around.row(entry, k), found);
            }
        }
    }
    cost.boxesTested += boxesTested;
    cost.rowsVisited += std::uint64_t{lastEntry - firstEntry} * kRows;
}

template <class Scalar, bool kIsDense, class QueryOf>
void joinDenseOrHashed(const Level<Scalar>& level, const QueryOf& queryOf, std::uint32_t first,
                       std::uint32_t last, PairSink& found, KernelCost& cost) {
    const bool isOneRow = level.low[1] == level.high[1];
    const bool isOneLayer = level.low[2] == level.high[2];
    if (isOneRow && isOneLayer) {
        joinRows<Scalar, kIsDense, 1>(level, kRowsOfSpace, queryOf, first, last, found, cost);
    } else if (isOneLayer) {
        joinRows<Scalar, kIsDense, 2>(level, kRowsOfLayer, queryOf, first, last, found, cost);
    } else if (isOneRow) {
        joinRows<Scalar, kIsDense, 2>(level, kRowsOfWall, queryOf, first, last, found, cost);
    } else {
        joinRows<Scalar, kIsDense, 5>(level, kRowsOfSpace, queryOf, first, last, found, cost);
    }
}

template <class Scalar, class QueryOf>
void joinLevelFor(const Level<Scalar>& level, const QueryOf& queryOf, std::uint32_t first,
                  std::uint32_t last, PairSink& found, KernelCost& cost) {
    if (level.isDense()) {
        joinDenseOrHashed<Scalar, true>(level, queryOf, first, last, found, cost);
    } else {
        joinDenseOrHashed<Scalar, false>(level, queryOf, first, last, found, cost);
    }
}

template <class Scalar>
void joinLevel(const Level<Scalar>& level, const GroupsView* groups, std::uint32_t firstEntry,
               std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    if (groups == nullptr) {
        joinLevelFor(level, ForAll{}, firstEntry, lastEntry, found, cost);
    } else {
        joinLevelFor(level, ForGroups{groups}, firstEntry, lastEntry, found, cost);
    }
}

template <class Scalar, class QueryOf>
void joinListFor(const Level<Scalar>& level, const QueryOf& queryOf, std::uint32_t firstEntry,
                 std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    for (std::uint32_t entry = firstEntry; entry < lastEntry; ++entry) {
        const auto query = queryOf(level, entry);
        if (query.findsAny()) {
            cost.boxesTested +=
                scan<true>(level, query, Run{entry + 1, level.lastEntry}, Row{}, found);
        }
    }
}

template <class Scalar>
void joinList(const Level<Scalar>& level, const GroupsView* groups, std::uint32_t firstEntry,
              std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    if (groups == nullptr) {
        joinListFor(level, ForAll{}, firstEntry, lastEntry, found, cost);
    } else {
        joinListFor(level, ForGroups{groups}, firstEntry, lastEntry, found, cost);
    }
}
