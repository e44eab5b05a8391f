// SPDX-License-Identifier: Zlib

// Kernel part: finds what boxes overlap in a level. See kernels.inl.

// Runs of up to kWidth rows, read with few branches in between: most are shorter than kWidth.
template <bool kIsDense, class Scalar, class Query, class Lanes>
bool scanRows(const Level<Scalar>& level, const Query& query, const Lanes& box, const Run* runs,
              const Row* rows, std::uint32_t rowCount, PairSink& found, KernelCost& cost) {
    if (!makeRoom(found, kWidth * kWidth + 1)) {
        return false;
    }
    std::uint64_t hits = 0;
    std::uint32_t tested = 0;
    std::uint32_t longest = 0;
    for (std::uint32_t k = 0; k < rowCount; ++k) {
        const std::uint32_t count = runs[k].last - runs[k].first;
        tested += lowest(count, kWidth);
        longest |= count;
        const std::uint32_t mask = box.template overlapMask<kWidth>(level.columns, runs[k].first) &
                                   laneMask(count, kWidth);
        hits |= std::uint64_t{mask} << (kWidth * k);
    }
    cost.boxesTested += tested;
    for (; hits != 0; hits &= hits - 1) {
        const std::uint32_t bit = lowestBit(hits);
        const std::uint32_t k = bit / kWidth;
        const std::uint32_t hit = runs[k].first + bit % kWidth;
        *found.next = {query.number, hit};
        found.next += isInRow<kIsDense>(level, hit, rows[k]) && query.finds(hit) ? 1 : 0;
    }
    for (std::uint32_t k = 0; longest >= kWidth && k < rowCount; ++k) {
        const Run rest = {runs[k].first + kWidth, runs[k].last};
        if (rest.last > rest.first &&
            !scan<kIsDense>(level, query, rest, rows[k], found, cost.boxesTested)) {
            return false;
        }
    }
    return true;
}

template <bool kIsDense, class Scalar, class Query>
[[HASHPHASE_FLATTEN]] bool walkBlock(const Level<Scalar>& level, const Query& query,
                                     const CellBlock& block, PairSink& found, KernelCost& cost) {
    cost.rowsVisited += block.rowCount();
    const auto box = query.template lanes<Pack<Scalar>>();
    Run runs[kWidth];
    Row rows[kWidth];
    std::uint32_t waiting = 0;
    const bool goesOn = block.forRows([&](Row row) {
        // There is always room for a run that wraps around.
        if (waiting + 2 > kWidth) {
            if (!scanRows<kIsDense>(level, query, box, runs, rows, waiting, found, cost)) {
                return false;
            }
            waiting = 0;
        }
        const auto buckets = bucketsOf<kIsDense>(level, row, block.low[0], block.rowLength());
        runs[waiting] = buckets.run(level);
        rows[waiting++] = row;
        if (buckets.wraps(level)) {
            runs[waiting] = buckets.wrapped(level);
            rows[waiting++] = row;
        }
        return true;
    });
    return goesOn && scanRows<kIsDense>(level, query, box, runs, rows, waiting, found, cost);
}

template <class Scalar, class Query>
bool walkAll(const Level<Scalar>& level, const Query& query, PairSink& found, KernelCost& cost) {
    const Run all = {level.firstEntry, level.lastEntry};
    return scan<true>(level, query, all, Row{}, found, cost.boxesTested);
}

template <bool kIsDense, class Scalar, class Query>
bool walkBox(const Level<Scalar>& level, const Query& query, PairSink& found, KernelCost& cost) {
    const CellBlock block = blockAround(level, query);
    if (block.isEmpty()) {
        return true;
    }
    return costsMoreThanFullScan<kIsDense>(level, block)
               ? walkAll(level, query, found, cost)
               : walkBlock<kIsDense>(level, query, block, found, cost);
}

template <class Scalar, class Query>
bool walk(const Level<Scalar>& level, const Query& query, PairSink& found, KernelCost& cost) {
    switch (level.kind) {
        case LevelKind::dense:
            return walkBox<true>(level, query, found, cost);
        case LevelKind::hashed:
            return walkBox<false>(level, query, found, cost);
        case LevelKind::list:
            break;
    }
    return walkAll(level, query, found, cost);
}

template <class Scalar>
bool queryLevel(const Level<Scalar>& level, const GroupsView* groups, const Scalar* const* queries,
                std::uint32_t first, std::uint32_t last, PairSink& found, KernelCost& cost) {
    bool goesOn = true;
    for (std::uint32_t number = first; number < last && goesOn; ++number) {
        const Query<Scalar> all{queries, number};
        if (groups == nullptr) {
            goesOn = walk(level, all, found, cost);
            continue;
        }
        const GroupQuery<Scalar> query(level, *groups, all);
        goesOn = !query.findsAny() || walk(level, query, found, cost);
    }
    return goesOn;
}

template <class Scalar>
bool querySwept(const Level<Scalar>& level, const Scalar* const* queries,
                const SweptBox<Scalar>* ways, const std::uint32_t* wayOf, std::uint32_t first,
                std::uint32_t last, PairSink& found, KernelCost& cost) {
    bool goesOn = true;
    for (std::uint32_t number = first; number < last && goesOn; ++number) {
        const SweptQuery<Scalar> query{{queries, number}, &ways[wayOf[number]]};
        goesOn = walk(level, query, found, cost);
    }
    return goesOn;
}

template <class Scalar>
bool queryRay(const Level<Scalar>& level, const RayPart<Scalar>& part, bool readsAll,
              PairSink& found, KernelCost& cost) {
    const Scalar* const columns[6] = {&part.bounds[0], &part.bounds[1], &part.bounds[2],
                                      &part.bounds[3], &part.bounds[4], &part.bounds[5]};
    const RayPartQuery<Scalar> query{{columns, 0}, &part};
    if (readsAll) {
        return walkAll(level, query, found, cost);
    }
    const CellBlock block = {{part.lowCell[0], part.lowCell[1], part.lowCell[2]},
                             {part.highCell[0], part.highCell[1], part.highCell[2]}};
    return level.isDense() ? walkBlock<true>(level, query, block, found, cost)
                           : walkBlock<false>(level, query, block, found, cost);
}
