// SPDX-License-Identifier: Zlib

// Kernel part: finds the pairs within a level. See kernels.inl.

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

/// Boxes that an entry is tested against at first: the first kWidth of each of its runs.
struct FirstBoxes {
    std::uint64_t hits = 0;        // a bit for each
    std::uint32_t longest = 0;     // at least kWidth when a run is at least as long
    std::uint32_t candidates = 0;  // in all runs, to their ends
};

// With no branch in between that could be mispredicted.
template <int kRows, class Scalar>
[[HASHPHASE_ALWAYS_INLINE]] inline FirstBoxes testFirst(const Level<Scalar>& level,
                                                        std::uint32_t entry, const Run* runs) {
    const Lanes<Pack<Scalar>, Scalar> box(level.columns, entry);
    FirstBoxes first;
    for (int k = 0; k < kRows; ++k) {
        const std::uint32_t count = runs[k].last - runs[k].first;
        first.candidates += count;
        first.longest |= count;
        const std::uint32_t mask = box.template overlapMask<kWidth>(level.columns, runs[k].first) &
                                   laneMask(count, kWidth);
        first.hits |= std::uint64_t{mask} << (kWidth * static_cast<unsigned>(k));
    }
    return first;
}

// Tests what the runs have beyond their first boxes, and what has wrapped around. `tested` counts all boxes of the
// runs when it is called; afterwards, those that were tested: fewer of sorted buckets, and what has wrapped around.
template <class Scalar, bool kIsDense, int kRows, class Query>
[[HASHPHASE_ALWAYS_INLINE]] inline void joinRests(
    const Neighbourhood<Scalar, kIsDense, kRows>& around, const Query& query, std::uint32_t entry,
    const Run* runs, bool wraps, PairSink& found, std::uint64_t& tested) {
    for (int k = 0; k < kRows; ++k) {
        const Run rest = {runs[k].first + kWidth, runs[k].last};
        if (rest.last > rest.first) {
            tested -= rest.last - rest.first;
            scan<true>(around.level, query, rest, Row{}, found, tested);
        }
    }
    for (int k = 0; wraps && k < kRows; ++k) {
        const Run rest = around.buckets(entry, k).wrapped(around.level);
        scan<true>(around.level, query, rest, Row{}, found, tested);
    }
}

// Returns how many boxes were tested.
template <class Scalar, bool kIsDense, int kRows, class Query>
std::uint64_t joinEntry(const Neighbourhood<Scalar, kIsDense, kRows>& around, const Query& query,
                        std::uint32_t entry, PairSink& found) {
    constexpr int kUnbranchedHits = 2;
    static_assert(kWidth * kRows + kUnbranchedHits <= kMostRoom);
    Run runs[kRows + 1];
    runs[kRows] = {0, 0};
    const bool wraps = around.read(entry, runs);
    makeRoom(found, kWidth * kRows + kUnbranchedHits);
    const FirstBoxes first = testFirst<kRows>(around.level, entry, runs);
    // Most entries have at most two hits: these are written at any rate, and count if they are
    // any.
    constexpr std::uint64_t kNoHit = std::uint64_t{1} << (kWidth * kRows);
    std::uint64_t hits = first.hits;
    IndexPair* next = found.next;
    const auto take = [&] {
        const std::uint32_t bit = lowestBit(hits | kNoHit);
        const std::uint32_t k = bit / kWidth;
        const std::uint32_t hit = runs[k].first + bit % kWidth;
        *next = {entry, hit};
        const bool isHit = hits != 0 && query.finds(hit);
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
    std::uint64_t tested = first.candidates;
    if (first.longest >= kWidth || wraps) {
        joinRests(around, query, entry, runs, wraps, found, tested);
    }
    return tested;
}

// Flattened, because compilers leave calls in this loop otherwise.
template <class Scalar, bool kIsDense, int kRows, class QueryOf>
[[HASHPHASE_FLATTEN]] void joinRows(const Level<Scalar>& level, const Row* steps,
                                    const QueryOf& queryOf, std::uint32_t firstEntry,
                                    std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    const Neighbourhood<Scalar, kIsDense, kRows> around(level, steps);
    std::uint64_t boxesTested = 0;
    for (std::uint32_t entry = firstEntry; entry < lastEntry; ++entry) {
        const auto query = queryOf(level, entry);
        if (query.findsAny()) {
            boxesTested += joinEntry(around, query, entry, found);
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
        const Run behind = {entry + 1, level.lastEntry};
        if (query.findsAny()) {
            scan<true>(level, query, behind, Row{}, found, cost.boxesTested);
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
