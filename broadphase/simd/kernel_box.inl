// SPDX-License-Identifier: Zlib

// Kernel part: one box against many. See kernels.inl.

/// Boxes that every search tests at once, whether or not its run has as many.
constexpr std::uint32_t kWidth = 8;

/// A box to test against others, its numbers spread over the registers of a Pack.
template <class Pack, class Scalar>
class Lanes {
public:
    Lanes(const Scalar* const* columns, std::uint32_t number) {
        for (int axis = 0; axis < 3; ++axis) {
            low_[axis] = Pack::broadcast(columns[axis][number]);
            high_[axis] = Pack::broadcast(columns[axis + 3][number]);
        }
    }

    /// Bit k tells whether box first + k overlaps it, for kCount boxes.
    template <std::uint32_t kCount>
    [[nodiscard]] std::uint32_t overlapMask(const Scalar* const* columns,
                                            std::uint32_t first) const {
        std::uint32_t mask = 0;
        for (std::uint32_t k = 0; k < kCount; k += Pack::kWidth) {
            mask |= maskOfPack(columns, first + k) << k;
        }
        return mask;
    }

private:
    [[nodiscard]] std::uint32_t maskOfPack(const Scalar* const* columns,
                                           std::uint32_t first) const {
        auto hits = Pack::lessEqual(Pack::load(columns[0] + first), high_[0]);
        hits = Pack::bitAnd(hits, Pack::lessEqual(low_[0], Pack::load(columns[3] + first)));
        for (int axis = 1; axis < 3; ++axis) {
            hits =
                Pack::bitAnd(hits, Pack::lessEqual(Pack::load(columns[axis] + first), high_[axis]));
            hits = Pack::bitAnd(hits,
                                Pack::lessEqual(low_[axis], Pack::load(columns[axis + 3] + first)));
        }
        return Pack::bits(hits);
    }

    typename Pack::Numbers low_[3];
    typename Pack::Numbers high_[3];
};

/// The same for a box on its way: `box` is around that part of it which matters.
template <class Pack, class Scalar>
class SweptLanes {
public:
    SweptLanes(const Lanes<Pack, Scalar>& box, const SweptBox<Scalar>& way)
        : box_(box), way_(&way) {
        for (int k = 0; k < 3; ++k) {
            enterFrom_[k] = Pack::broadcast(way.enterFrom[k]);
            leaveFrom_[k] = Pack::broadcast(way.leaveFrom[k]);
            inverse_[k] = Pack::broadcast(way.inverse[k]);
        }
    }

    template <std::uint32_t kCount>
    [[nodiscard]] std::uint32_t overlapMask(const Scalar* const* columns,
                                            std::uint32_t first) const {
        std::uint32_t mask = box_.template overlapMask<kCount>(columns, first);
        if (mask != 0) {
            std::uint32_t reached = 0;
            for (std::uint32_t k = 0; k < kCount; k += Pack::kWidth) {
                reached |= maskOfPack(columns, first + k) << k;
            }
            mask &= reached;
        }
        return mask;
    }

private:
    // A time is off by three roundings, or less than the least number of which no bit is lost.
    [[nodiscard]] std::uint32_t maskOfPack(const Scalar* const* columns,
                                           std::uint32_t first) const {
        constexpr auto kWidened =
            static_cast<Scalar>(sizeof(Scalar) == sizeof(float) ? 1 + 0x1p-19 : 1 + 0x1p-48);
        constexpr Scalar kTiny =
            sizeof(Scalar) == sizeof(float) ? Scalar(0x1p-126) : Scalar(0x1p-1022);
        auto enter = Pack::broadcast(0);
        auto leave = Pack::broadcast(1);
        for (int k = 0; k < 3; ++k) {
            const auto enters =
                Pack::minus(Pack::load(columns[way_->enterColumn[k]] + first), enterFrom_[k]);
            const auto leaves =
                Pack::minus(Pack::load(columns[way_->leaveColumn[k]] + first), leaveFrom_[k]);
            enter = Pack::greatest(Pack::times(enters, inverse_[k]), enter);
            leave = Pack::least(Pack::times(leaves, inverse_[k]), leave);
        }
        leave = Pack::plus(Pack::times(leave, Pack::broadcast(kWidened)), Pack::broadcast(kTiny));
        return Pack::bits(Pack::lessEqual(enter, leave));
    }

    Lanes<Pack, Scalar> box_;
    const SweptBox<Scalar>* way_;
    typename Pack::Numbers enterFrom_[3];
    typename Pack::Numbers leaveFrom_[3];
    typename Pack::Numbers inverse_[3];
};

/// The same for a ray. It may meet inverted boxes, as if they were the right way round.
template <class Pack, class Scalar>
class RayPartLanes {
public:
    explicit RayPartLanes(const RayPart<Scalar>& part)
        : sieve_(part.sieve),
          low_(Pack::broadcast(part.bounds[part.sieve % 3])),
          high_(Pack::broadcast(part.bounds[part.sieve % 3 + 3])),
          last_(Pack::broadcast(part.last)) {
        for (int k = 0; k < 3; ++k) {
            lowFrom_[k] = Pack::broadcast(part.lowFrom[k]);
            highFrom_[k] = Pack::broadcast(part.highFrom[k]);
            inverse_[k] = Pack::broadcast(part.inverse[k]);
        }
    }

    template <std::uint32_t kCount>
    [[nodiscard]] std::uint32_t overlapMask(const Scalar* const* columns,
                                            std::uint32_t first) const {
        std::uint32_t mask = 0;
        for (std::uint32_t k = 0; k < kCount; k += Pack::kWidth) {
            mask |= maskOfPack(columns, first + k) << k;
        }
        return mask;
    }

private:
    [[nodiscard]] bool areAllFar(const Scalar* const* columns, std::uint32_t first) const {
        const auto min = Pack::load(columns[sieve_] + first);
        const auto max = Pack::load(columns[sieve_ + 3] + first);
        return Pack::bits(Pack::bitAnd(Pack::lessEqual(Pack::least(min, max), high_),
                                       Pack::lessEqual(low_, Pack::greatest(min, max)))) == 0;
    }

    [[nodiscard]] std::uint32_t maskOfPack(const Scalar* const* columns,
                                           std::uint32_t first) const {
        if (sieve_ != RayPart<Scalar>::kNoSieve && areAllFar(columns, first)) {
            return 0;
        }
        auto enter = Pack::broadcast(0);
        auto leave = last_;
        for (int k = 0; k < 3; ++k) {
            const auto min = Pack::load(columns[k] + first);
            const auto max = Pack::load(columns[k + 3] + first);
            const auto one =
                Pack::times(Pack::minus(Pack::least(min, max), lowFrom_[k]), inverse_[k]);
            const auto other =
                Pack::times(Pack::minus(Pack::greatest(min, max), highFrom_[k]), inverse_[k]);
            enter = Pack::greatest(Pack::least(one, other), enter);
            leave = Pack::least(Pack::greatest(one, other), leave);
        }
        // What was erased is NaN, which has changed nothing.
        const auto x = Pack::load(columns[0] + first);
        return Pack::bits(Pack::bitAnd(Pack::lessEqual(enter, leave), Pack::lessEqual(x, x)));
    }

    typename Pack::Numbers lowFrom_[3];
    typename Pack::Numbers highFrom_[3];
    typename Pack::Numbers inverse_[3];
    std::uint32_t sieve_;
    typename Pack::Numbers low_;  // along it
    typename Pack::Numbers high_;
    typename Pack::Numbers last_;
};

/// A box that is looked for: box `number` of six columns.
template <class Scalar>
struct Query {
    const Scalar* const* columns;
    std::uint32_t number;

    template <class Pack>
    [[nodiscard]] Lanes<Pack, Scalar> lanes() const {
        return Lanes<Pack, Scalar>(columns, number);
    }

    /// Whether an entry that overlaps it is to be found, whether any is, and whether any of a part of a
    /// bucket is.
    [[nodiscard]] static constexpr bool finds(std::uint32_t /*entry*/) { return true; }
    [[nodiscard]] static constexpr bool findsAny() { return true; }
    [[nodiscard]] static constexpr bool findsAny(const SortedBucket<Scalar>& /*part*/) {
        return true;
    }
};

/// The same for one that finds only what it may pair with.
template <class Scalar>
struct GroupQuery : Query<Scalar> {
    const GroupsView* view;
    const std::uint32_t* proxyIndices;  // of entries
    ProxyGroups own;

    // cppcheck-suppress uninitDerivedMemberVar  // the copied query has them
    GroupQuery(const Level<Scalar>& level, const GroupsView& groups, const Query<Scalar>& query)
        : Query<Scalar>(query),
          view(&groups),
          proxyIndices(level.proxyIndices),
          own(groups.groups[2 * std::size_t{groups.indexOfQuery[query.number]}]) {}

    [[nodiscard]] bool isFor(const ProxyGroups& other) const {
        return ((own.group & other.mask) != 0) & ((other.group & own.mask) != 0);
    }
    [[nodiscard]] bool finds(std::uint32_t entry) const {
        return isFor(view->groups[2 * std::size_t{proxyIndices[entry]}]);
    }
    [[nodiscard]] bool findsAny() const { return isFor(view->together); }
    [[nodiscard]] bool findsAny(const SortedBucket<Scalar>& part) const {
        return !part.haveSameGroups || isFor(part.groups);
    }
};

/// The same for a part of a way, of which the box is around.
template <class Scalar>
struct SweptQuery : Query<Scalar> {
    const SweptBox<Scalar>* way;

    template <class Pack>
    [[nodiscard]] SweptLanes<Pack, Scalar> lanes() const {
        return {Query<Scalar>::template lanes<Pack>(), *way};
    }
};

/// The same for a part of a ray, of which the box is around.
template <class Scalar>
struct RayPartQuery : Query<Scalar> {
    const RayPart<Scalar>* part;

    template <class Pack>
    [[nodiscard]] RayPartLanes<Pack, Scalar> lanes() const {
        return RayPartLanes<Pack, Scalar>(*part);
    }
};

// Hashed rows may share buckets: of the entries of a run, those in the row are hits.
template <bool kIsDense, class Scalar>
bool isInRow(const Level<Scalar>& level, std::uint32_t entry, Row row) {
    if constexpr (kIsDense) {
        return true;
    } else {
        const auto cellAlong = [&](std::size_t axis) {
            return level.cell(level.filedLow[axis][entry], axis);
        };
        return cellAlong(1) == row.y && cellAlong(2) == row.z;
    }
}

// Tests all entries of a run, and adds how many to `tested`; none where it ends before it begins,
// as what is looked for in a sorted one may. Like all scans, returns false when the sink ends the
// search.
template <bool kIsDense, class Scalar, class Query>
bool scanAll(const Level<Scalar>& level, const Query& query, Run run, Row row, PairSink& found,
             std::uint64_t& tested) {
    if (run.last <= run.first) {
        return true;
    }
    using Pack = WidePack<Scalar>;
    constexpr std::uint32_t width = Pack::kWidth < kWidth ? kWidth : Pack::kWidth;
    static_assert(kMostRoom % width == 0);
    const auto box = query.template lanes<Pack>();
    while (run.first < run.last) {
        const std::uint32_t count = lowest(run.last - run.first, kMostRoom);
        if (!makeRoom(found, count)) {
            return false;
        }
        tested += count;
        IndexPair* next = found.next;
        for (const std::uint32_t end = run.first + count; run.first < end; run.first += width) {
            std::uint32_t mask = box.template overlapMask<width>(level.columns, run.first) &
                                 laneMask(end - run.first, width);
            for (; mask != 0; mask &= mask - 1) {
                const std::uint32_t hit = run.first + lowestBit(mask);
                *next = {query.number, hit};
                next += isInRow<kIsDense>(level, hit, row) && query.finds(hit) ? 1 : 0;
            }
        }
        found.next = next;
    }
    return true;
}

/// The first part of the bucket, counted over all levels; null when it is not sorted.
template <class Scalar>
const SortedBucket<Scalar>* sortedBucket(const Level<Scalar>& level, std::uint32_t bucket) {
    std::uint32_t first = 0;
    std::uint32_t last = level.sortedCount;
    while (first < last) {
        const std::uint32_t middle = first + (last - first) / 2;
        if (level.sortedBuckets[middle].bucket < bucket) {
            first = middle + 1;
        } else {
            last = middle;
        }
    }
    const SortedBucket<Scalar>* const found = level.sortedBuckets + first;
    return first < level.sortedCount && found->bucket == bucket ? found : nullptr;
}

// Tests those entries of a run that are in a part of a bucket.
template <bool kIsDense, class Scalar, class Query>
bool sweepPart(const Level<Scalar>& level, const Query& query, const SortedBucket<Scalar>& sorted,
               Run run, Row row, PairSink& found, std::uint64_t& tested) {
    run = {highest(run.first, sorted.first), lowest(run.last, sorted.last)};
    if (run.last <= run.first || !query.findsAny(sorted)) {
        return true;
    }
    const Scalar* const keys = level.filedLow[sorted.axis];
    const Scalar low = query.columns[sorted.axis][query.number];
    const Scalar high = query.columns[sorted.axis + 3][query.number];
    const Run longOnes = {highest(run.first, sorted.firstLong), run.last};
    run.last = lowest(run.last, sorted.firstLong);
    const Run near = {firstNear(sorted, keys, run.first, run.last, low),
                      endOfNear(keys, run.first, run.last, high)};
    return scanAll<kIsDense>(level, query, longOnes, row, found, tested) &&
           scanAll<kIsDense>(level, query, near, row, found, tested);
}

// Tests the entries of a run on a level of which some crowded buckets are sorted along an axis: of
// these, those that begin before the box ends, and no farther before it than the longest of them
// reaches, and the long ones.
template <bool kIsDense, class Scalar, class Query>
[[HASHPHASE_NO_INLINE]] bool sweep(const Level<Scalar>& level, const Query& query, Run run, Row row,
                                   PairSink& found, std::uint64_t& tested) {
    const SortedBucket<Scalar>* const endOfSorted = level.sortedBuckets + level.sortedCount;
    while (run.first < run.last) {
        const std::uint32_t bucket = level.bucketOfEntry[run.first];
        const std::uint32_t begin = level.bucketStart[bucket - level.firstBucket];
        const std::uint32_t end = level.bucketStart[bucket - level.firstBucket + 1];
        const SortedBucket<Scalar>* sorted =
            end - begin > kCrowdedBucket ? sortedBucket(level, bucket) : nullptr;
        const Run part = {run.first, lowest(end, run.last)};
        run.first = part.last;
        if (sorted == nullptr) {
            if (!scanAll<kIsDense>(level, query, part, row, found, tested)) {
                return false;
            }
            continue;
        }
        for (; sorted != endOfSorted && sorted->bucket == bucket; ++sorted) {
            if (!sweepPart<kIsDense>(level, query, *sorted, part, row, found, tested)) {
                return false;
            }
        }
    }
    return true;
}

// Finds all entries of a run that overlap the box, and adds to `tested` how many it tested.
template <bool kIsDense, class Scalar, class Query>
[[HASHPHASE_ALWAYS_INLINE]] inline bool scan(const Level<Scalar>& level, const Query& query,
                                             Run run, Row row, PairSink& found,
                                             std::uint64_t& tested) {
    if (level.sortedCount > 0) {
        return sweep<kIsDense>(level, query, run, row, found, tested);
    }
    return scanAll<kIsDense>(level, query, run, row, found, tested);
}
