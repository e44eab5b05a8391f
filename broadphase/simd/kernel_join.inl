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
FirstBoxes testFirst(const Level<Scalar>& level, std::uint32_t entry, const Run* runs) {
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

// Tests what the runs have beyond their first boxes, and what has wrapped around.
template <class Scalar, bool kIsDense, int kRows, class Query>
bool joinRests(const Neighbourhood<Scalar, kIsDense, kRows>& around, const Query& query,
               std::uint32_t entry, const Run* runs, bool wraps, PairSink& found,
               std::uint64_t& boxesTested) {
    for (int k = 0; k < kRows; ++k) {
        const Run rest = {runs[k].first + kWidth, runs[k].last};
        if (rest.last > rest.first) {
            std::uint64_t tested = 0;
            if (!scan<kIsDense>(around.level, query, rest, around.row(entry, k), found, tested)) {
                return false;
            }
            boxesTested += tested - (rest.last - rest.first);
        }
    }
    for (int k = 0; wraps && k < kRows; ++k) {
        const Run rest = around.buckets(entry, k).wrapped(around.level);
        std::uint64_t tested = 0;
        if (!scan<kIsDense>(around.level, query, rest, around.row(entry, k), found, tested)) {
            return false;
        }
        boxesTested += tested;
    }
    return true;
}

template <class Scalar, bool kIsDense, int kRows, class Query>
bool joinEntry(const Neighbourhood<Scalar, kIsDense, kRows>& around, const Query& query,
               std::uint32_t entry, PairSink& found, std::uint64_t& boxesTested) {
    constexpr int kUnbranchedHits = 2;
    static_assert(kWidth * kRows + kUnbranchedHits <= kMostRoom);
    Run runs[kRows + 1];
    runs[kRows] = {0, 0};
    const bool wraps = around.read(entry, runs);
    if (!makeRoom(found, kWidth * kRows + kUnbranchedHits)) {
        return false;
    }
    const FirstBoxes first = testFirst<kRows>(around.level, entry, runs);
    boxesTested += first.candidates;
    // Most entries have at most two hits: these are written at any rate, and count if they are
    // any.
    constexpr std::uint64_t kNoHit = std::uint64_t{1} << (kWidth * kRows);
    std::uint64_t hits = first.hits;
    IndexPair* next = found.next;
    const auto take = [&] {
        const auto bit = static_cast<std::uint32_t>(__builtin_ctzll(hits | kNoHit));
        const std::uint32_t k = bit / kWidth;
        const std::uint32_t hit = runs[k].first + bit % kWidth;
        const Row row = around.row(entry, static_cast<int>(k % kRows));
        *next = {entry, hit};
        const bool isHit =
            hits != 0 && isInRow<kIsDense>(around.level, hit, row) && query.finds(hit);
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
    return (first.longest < kWidth && !wraps) ||
           joinRests(around, query, entry, runs, wraps, found, boxesTested);
}

// Flattened, because compilers leave calls in this loop otherwise.
template <class Scalar, bool kIsDense, int kRows, class QueryOf>
[[gnu::flatten]] bool joinRows(const Level<Scalar>& level, const Row* steps, const QueryOf& queryOf,
                               std::uint32_t firstEntry, std::uint32_t lastEntry, PairSink& found,
                               KernelCost& cost) {
    const Neighbourhood<Scalar, kIsDense, kRows> around(level, steps);
    std::uint64_t boxesTested = 0;
    bool goesOn = true;
    for (std::uint32_t entry = firstEntry; entry < lastEntry && goesOn; ++entry) {
        const auto query = queryOf(level, entry);
        if (query.findsAny()) {
            goesOn = joinEntry(around, query, entry, found, boxesTested);
        }
    }
    cost.boxesTested += boxesTested;
    cost.rowsVisited += std::uint64_t{lastEntry - firstEntry} * kRows;
    return goesOn;
}

template <class Scalar, bool kIsDense, class QueryOf>
bool joinDenseOrHashed(const Level<Scalar>& level, const QueryOf& queryOf, std::uint32_t first,
                       std::uint32_t last, PairSink& found, KernelCost& cost) {
    const bool isOneRow = level.low[1] == level.high[1];
    const bool isOneLayer = level.low[2] == level.high[2];
    if (isOneRow && isOneLayer) {
        return joinRows<Scalar, kIsDense, 1>(level, kRowsOfSpace, queryOf, first, last, found,
                                             cost);
    }
    if (isOneLayer) {
        return joinRows<Scalar, kIsDense, 2>(level, kRowsOfLayer, queryOf, first, last, found,
                                             cost);
    }
    if (isOneRow) {
        return joinRows<Scalar, kIsDense, 2>(level, kRowsOfWall, queryOf, first, last, found, cost);
    }
    return joinRows<Scalar, kIsDense, 5>(level, kRowsOfSpace, queryOf, first, last, found, cost);
}

template <class Scalar, class QueryOf>
bool joinLevelFor(const Level<Scalar>& level, const QueryOf& queryOf, std::uint32_t first,
                  std::uint32_t last, PairSink& found, KernelCost& cost) {
    return level.isDense()
               ? joinDenseOrHashed<Scalar, true>(level, queryOf, first, last, found, cost)
               : joinDenseOrHashed<Scalar, false>(level, queryOf, first, last, found, cost);
}

template <class Scalar>
bool joinLevel(const Level<Scalar>& level, const GroupsView* groups, std::uint32_t firstEntry,
               std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    return groups == nullptr
               ? joinLevelFor(level, ForAll{}, firstEntry, lastEntry, found, cost)
               : joinLevelFor(level, ForGroups{groups}, firstEntry, lastEntry, found, cost);
}

template <class Scalar, class QueryOf>
bool joinListFor(const Level<Scalar>& level, const QueryOf& queryOf, std::uint32_t firstEntry,
                 std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    bool goesOn = true;
    for (std::uint32_t entry = firstEntry; entry < lastEntry && goesOn; ++entry) {
        const auto query = queryOf(level, entry);
        const Run behind = {entry + 1, level.lastEntry};
        goesOn =
            !query.findsAny() || scan<true>(level, query, behind, Row{}, found, cost.boxesTested);
    }
    return goesOn;
}

template <class Scalar>
bool joinList(const Level<Scalar>& level, const GroupsView* groups, std::uint32_t firstEntry,
              std::uint32_t lastEntry, PairSink& found, KernelCost& cost) {
    return groups == nullptr
               ? joinListFor(level, ForAll{}, firstEntry, lastEntry, found, cost)
               : joinListFor(level, ForGroups{groups}, firstEntry, lastEntry, found, cost);
}
