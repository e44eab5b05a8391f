// SPDX-License-Identifier: Zlib
#include <broadphase/search/join.hpp>

#include <algorithm>
#include <array>

namespace hashphase::detail {

namespace {

// About how many rows of `level` a box that is filed on `own` looks up, in rows or in boxes that are
// read instead, which are faster by this factor.
constexpr double kBoxesPerRowRead = 8;

template <class Scalar>
double rowsLookedUp(const Level<Scalar>& own, const Level<Scalar>& level) {
    const double rows = static_cast<double>(level.count()) / kBoxesPerRowRead;
    double byCells = 1;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
        const auto cellsPerEdge =
            static_cast<double>(own.largestEdge) * static_cast<double>(level.inverseCellSize[axis]);
        byCells *= level.inverseCellSize[axis] == 0 ? 1 : cellsPerEdge + 2;
    }
    return std::min(rows, byCells);
}

// A search of the entries of one level: among themselves, or for those of another one.
template <class Scalar>
struct Search {
    const Level<Scalar>* from;
    const Level<Scalar>* among;
};

// The boxes of either level may be looked up among those of the other one. Mostly the small ones
// look for the large ones, of which there are few in each row; but a few large ones, or a few that
// are filed far away, had better look for the small ones themselves. So do listed ones, of which each
// reads no more than the cells around it, where the other way round everyone would read all of them.
template <class Scalar>
Search<Scalar> searchOf(const Level<Scalar>& a, const Level<Scalar>& b) {
    if (!a.hasCells() || !b.hasCells()) {
        return a.hasCells() ? Search<Scalar>{&b, &a} : Search<Scalar>{&a, &b};
    }
    const bool isFromA = a.count() * rowsLookedUp(a, b) <= b.count() * rowsLookedUp(b, a);
    return isFromA ? Search<Scalar>{&a, &b} : Search<Scalar>{&b, &a};
}

template <class Scalar>
void run(const Table<Scalar>& table, const Search<Scalar>& search, const GroupsView* groups,
         std::uint32_t first, std::uint32_t last, PairSink& sink, KernelCost& cost) {
    const Kernels<Scalar>& kernel = kernels<Scalar>();
    const Level<Scalar>& among = *search.among;
    if (search.from != search.among) {
        kernel.queryLevel(among, groups, table.columns().data(), first, last, sink, cost);
    } else if (among.hasCells()) {
        kernel.joinLevel(among, groups, first, last, sink, cost);
    } else {
        kernel.joinList(among, groups, first, last, sink, cost);
    }
}

// All searches that there are to do: the entries of all of them, one after the other, are one loop.
template <class Scalar>
class Searches {
public:
    explicit Searches(const Table<Scalar>& table) : table_(table) {
        const auto levels = table.levels();
        for (std::size_t i = 0; i < levels.size(); ++i) {
            for (std::size_t j = i; j < levels.size() && levels[i].count() > 0; ++j) {
                if (levels[j].count() > 0) {
                    add(i == j ? Search<Scalar>{&levels[i], &levels[i]}
                               : searchOf(levels[i], levels[j]));
                }
            }
        }
    }

    [[nodiscard]] std::size_t entryCount() const noexcept { return entryCount_; }

    void run(std::size_t first, std::size_t last, const GroupsView* groups, PairSink& sink,
             KernelCost& cost) const {
        for (std::size_t i = 0; i < count_ && last > 0; ++i) {
            const std::size_t count = all_[i].from->count();
            if (first < count) {
                const std::uint32_t base = all_[i].from->firstEntry;
                detail::run(table_, all_[i], groups, base + static_cast<std::uint32_t>(first),
                            base + static_cast<std::uint32_t>(std::min(last, count)), sink, cost);
            }
            first -= std::min(first, count);
            last -= std::min(last, count);
        }
    }

private:
    void add(const Search<Scalar>& search) {
        all_[count_++] = search;
        entryCount_ += search.from->count();
    }

    static constexpr std::size_t kMost = 2 * kMaxLevels + 1;

    const Table<Scalar>& table_;
    std::array<Search<Scalar>, kMost*(kMost + 1) / 2> all_;  // the first count_
    std::size_t count_ = 0;
    std::size_t entryCount_ = 0;
};

// Entries or boxes that one thread deals with at a time.
constexpr std::size_t kJoinGrain = 2048;

}  // namespace

template <class Scalar>
void joinTable(const Table<Scalar>& table, ParallelFor parallelFor, PairParts& parts,
               PairList& found, KernelCost& cost, const ProxyGroups* groups,
               const ProxyGroups& together) {
    const GroupsView view{groups, table.proxyIndices().data(), together};
    const Searches<Scalar> searches(table);
    parts.collect(parallelFor, searches.entryCount(), kJoinGrain, found, cost,
                  [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost& own) {
                      searches.run(first, last, groups != nullptr ? &view : nullptr, sink, own);
                  });
}

template <class Scalar>
void joinTable(const Table<Scalar>& table, PairSink& sink, KernelCost& cost,
               const ProxyGroups* groups) {
    const GroupsView view{groups, table.proxyIndices().data(), {}};
    const Searches<Scalar> searches(table);
    searches.run(0, searches.entryCount(), groups != nullptr ? &view : nullptr, sink, cost);
}

template <class Scalar>
std::size_t joinSample(const Table<Scalar>& table, std::size_t count, PairSink& sink,
                       KernelCost& cost, const ProxyGroups* groups) {
    const GroupsView view{groups, table.proxyIndices().data(), {}};
    const Searches<Scalar> searches(table);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = searches.entryCount() * i / count;
        searches.run(at, std::min(at + 1, searches.entryCount()),
                     groups != nullptr ? &view : nullptr, sink, cost);
    }
    return searches.entryCount();
}

template <class Scalar>
bool queryBatch(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
                PairSink& sink, KernelCost& cost) {
    return std::ranges::all_of(table.levels(), [&](const Level<Scalar>& level) {
        return level.count() == 0 ||
               kernels<Scalar>().queryBatch(level, queries.data(), 0, count, sink, cost);
    });
}

template <class Scalar>
bool queryTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t first,
                std::uint32_t last, PairSink& sink, KernelCost& cost, const GroupsView* groups) {
    return std::ranges::all_of(table.levels(), [&](const Level<Scalar>& level) {
        return level.count() == 0 ||
               kernels<Scalar>().queryLevel(level, groups, queries.data(), first, last, sink, cost);
    });
}

template <class Scalar>
void queryTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
                ParallelFor parallelFor, PairParts& parts, PairList& found, KernelCost& cost,
                const GroupsView* groups) {
    parts.collect(parallelFor, count, kJoinGrain, found, cost,
                  [&](std::size_t first, std::size_t last, PairSink& sink, KernelCost& own) {
                      queryTable(table, queries, static_cast<std::uint32_t>(first),
                                 static_cast<std::uint32_t>(last), sink, own, groups);
                  });
}

template void joinTable<float>(const Table<float>&, ParallelFor, PairParts&, PairList&, KernelCost&,
                               const ProxyGroups*, const ProxyGroups&);
template void joinTable<float>(const Table<float>&, PairSink&, KernelCost&, const ProxyGroups*);
template std::size_t joinSample<float>(const Table<float>&, std::size_t, PairSink&, KernelCost&,
                                       const ProxyGroups*);
template void queryTable<float>(const Table<float>&, const Columns<float>&, std::uint32_t,
                                ParallelFor, PairParts&, PairList&, KernelCost&, const GroupsView*);
template bool queryTable<float>(const Table<float>&, const Columns<float>&, std::uint32_t,
                                std::uint32_t, PairSink&, KernelCost&, const GroupsView*);
template bool queryBatch<float>(const Table<float>&, const Columns<float>&, std::uint32_t,
                                PairSink&, KernelCost&);
template void joinTable<double>(const Table<double>&, ParallelFor, PairParts&, PairList&,
                                KernelCost&, const ProxyGroups*, const ProxyGroups&);
template void joinTable<double>(const Table<double>&, PairSink&, KernelCost&, const ProxyGroups*);
template std::size_t joinSample<double>(const Table<double>&, std::size_t, PairSink&, KernelCost&,
                                        const ProxyGroups*);
template void queryTable<double>(const Table<double>&, const Columns<double>&, std::uint32_t,
                                 ParallelFor, PairParts&, PairList&, KernelCost&,
                                 const GroupsView*);
template bool queryTable<double>(const Table<double>&, const Columns<double>&, std::uint32_t,
                                 std::uint32_t, PairSink&, KernelCost&, const GroupsView*);
template bool queryBatch<double>(const Table<double>&, const Columns<double>&, std::uint32_t,
                                 PairSink&, KernelCost&);

}  // namespace hashphase::detail
