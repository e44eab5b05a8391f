// SPDX-License-Identifier: Zlib
#pragma once

// Grid's query templates; included by grid.hpp.

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/shared_cost.hpp>
#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/search/box_search.hpp>
#include <broadphase/search/volume_search.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Offers to collectors what searches find for their regions: collectors[i] takes what regions[i]
/// has.
template <class Scalar>
template <class Region, class Collector>
struct Grid<Scalar>::VisitReader {
    static constexpr bool kIsLine = requires(const Region& region) { region.segment(); };
    static constexpr bool kIsVolume = requires(const Region& region) { region.volume(); };

    const detail::Store<Scalar>& store;
    const Reading& reading;
    std::span<const Region> regions;  // one, unless they have bounds()
    std::span<Collector> collectors;
    QueryCost& cost;
    // All that the tables list is filed there as it is, and nothing is changed meanwhile.
    bool doAllStand = false;
    bool mayChange = false;

    /// Reads the tables. Returns false when a single collector wants no more.
    bool readTables(std::span<const Filing> filings) {
        if constexpr (kIsLine) {
            return std::ranges::all_of(filings, [&](const Filing& f) { return readLine(f); });
        } else if constexpr (kIsVolume) {
            return std::ranges::all_of(filings, [&](const Filing& f) { return readVolume(f); });
        } else {
            const detail::QueryColumns<Scalar> bounds(regions);
            return std::ranges::all_of(
                filings, [&](const Filing& f) { return readCells(f, bounds.columns()); });
        }
    }

    // Offers what changed since it was filed, which is listed from `first` on, by the boxes as they are now. Not
    // by iterators: the collector may change the list.
    void readWaiting(std::size_t i, std::size_t first) {
        const std::size_t count = store.proxies.waiting.size();
        for (std::size_t k = first; k < count; ++k) {
            const std::uint32_t proxyIndex = store.proxies.waiting[k];
            if (store.proxies.isAlive(proxyIndex)) {
                ++cost.boxesTested;
                const Scalar key = keyNow(i, proxyIndex);
                if (detail::isWanted(key, collectors[i])) {
                    ++cost.hits;
                    collectors[i].add(store.proxies.idOf(proxyIndex), key);
                    if (!(collectors[i].limit() >= 0)) {
                        return;
                    }
                }
            }
        }
    }

private:
    bool readCells(const Filing& filing, const detail::Columns<Scalar>& bounds) {
        detail::KernelCost walk;
        const auto take = [&](std::span<const detail::IndexPair> found) {
            return offerEntries(filing, found);
        };
        const auto count = static_cast<std::uint32_t>(regions.size());
        const bool goesOn = detail::searchBoxes(*filing.table, bounds, count, take, walk);
        addCost(walk);
        return goesOn;
    }

    bool readVolume(const Filing& filing) {
        if (regions[0].isEmpty()) {
            return true;
        }
        if (!(collectors[0].limit() >= 0)) {
            return false;
        }
        const bool mayHaveLeft =
            !store.doAllStand(reading) || (filing.isResting && store.tables.restingErased > 0);
        const auto take = [&](std::span<const std::uint32_t> proxyIndices) {
            const auto zero = [](std::uint32_t) { return Scalar(0); };
            return mayHaveLeft
                       ? offerIndices(
                             proxyIndices,
                             [&](auto proxyIndex) { return isThere(filing, proxyIndex); }, zero)
                       : offerIndices(
                             proxyIndices, [](auto) { return true; }, zero);
        };
        detail::KernelCost walk;
        const bool goesOn = detail::searchVolume(*filing.table, regions[0].volume(), take, walk) &&
                            readList(filing, walk);
        addCost(walk);
        return goesOn;
    }

    // Of what has no cells, the region's key decides.
    bool readList(const Filing& filing, detail::KernelCost& walk) {
        const detail::Table<Scalar>& table = *filing.table;
        if (table.size() == 0) {
            return true;
        }
        const detail::Level<Scalar>& list = table.levels().back();
        walk.boxesTested += list.count();
        for (std::uint32_t entry = list.firstEntry; entry < list.lastEntry; ++entry) {
            const detail::IndexPair found{0, entry};
            if (!offerEntries(filing, {&found, 1})) {
                return false;
            }
        }
        return true;
    }

    bool readLine(const Filing& filing) {
        const auto take = [&](std::span<const std::uint32_t> proxyIndices) {
            for (const std::uint32_t proxyIndex : proxyIndices) {
                detail::prefetch(&store.proxies.records[proxyIndex]);
            }
            // Whatever is listed in a table may have left it.
            const bool goesOn = offerIndices(
                proxyIndices, [&](auto proxyIndex) { return isThere(filing, proxyIndex); },
                [&](auto proxyIndex) { return keyNow(0, proxyIndex); });
            return goesOn ? static_cast<double>(collectors[0].limit()) : -1.0;
        };
        return store.searchAlong(regions[0].segment(), *filing.table,
                                 static_cast<double>(collectors[0].limit()), take, cost);
    }

    // Pairs of a region's number and an entry that overlaps the region's bounds.
    bool offerEntries(const Filing& filing, std::span<const detail::IndexPair> found) {
        const detail::Table<Scalar>& table = *filing.table;
        std::uint64_t hits = 0;  // no collector writes here
        bool goesOn = true;
        for (std::size_t k = 0; k < found.size() && goesOn; ++k) {
            const auto [i, entry] = found[k];
            Collector& collector = collectors[i];
            Scalar key = 0;
            if constexpr (!requires { Region::kIsItsBounds; }) {
                key = regions[i].key(table.box(entry));
            }
            const std::uint32_t proxyIndex = table.proxyIndex(entry);
            if (!detail::isWanted(key, collector) || !(doAllStand || isThere(filing, proxyIndex))) {
                continue;
            }
            // What is fresh has what the collector has changed since, too: boxes are asked for as they are
            // now.
            if (mayChange && reading.isFresh) {
                key = keyNow(i, proxyIndex);
                if (!detail::isWanted(key, collector)) {
                    continue;
                }
            }
            ++hits;
            goesOn = offer(collector, proxyIndex, key);
        }
        cost.hits += hits;
        return goesOn;
    }

    template <class IsThere, class KeyOf>
    bool offerIndices(std::span<const std::uint32_t> proxyIndices, const IsThere& isThere,
                      const KeyOf& keyOf) {
        Collector& collector = collectors[0];
        std::uint64_t hits = 0;
        bool goesOn = true;
        for (std::size_t k = 0; k < proxyIndices.size() && goesOn; ++k) {
            if (isThere(proxyIndices[k])) {
                const Scalar key = keyOf(proxyIndices[k]);
                if (detail::isWanted(key, collector)) {
                    ++hits;
                    goesOn = offer(collector, proxyIndices[k], key);
                }
            }
        }
        cost.hits += hits;
        return goesOn;
    }

    // One of many that wants no more does not end the search of the others.
    [[HASHPHASE_ALWAYS_INLINE]] bool offer(Collector& collector, std::uint32_t proxyIndex,
                                           Scalar key) const {
        collector.add(store.proxies.idOf(proxyIndex), key);
        return collector.limit() >= 0 || collectors.size() > 1;
    }

    // A region's key() might find a NaN.
    [[nodiscard]] Scalar keyNow(std::size_t i, std::uint32_t proxyIndex) const {
        const detail::Record<Scalar>& record = store.proxies.records[proxyIndex];
        return record.isNan ? Scalar(-1) : regions[i].key(record.box);
    }
    [[nodiscard]] bool isThere(const Filing& filing, std::uint32_t proxyIndex) const {
        return store.standsIn(filing, proxyIndex, reading);
    }

    void addCost(const detail::KernelCost& walk) {
        cost.rowsVisited += walk.rowsVisited;
        cost.boxesTested += walk.boxesTested;
    }
};

template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visit(const Region& region, Collector& collector) const {
    using Reader = VisitReader<Region, Collector>;
    using Changes = detail::QueryScope::Changes;
    const Reading reading = Reader::kIsLine ? store_.beginReadingForRay() : store_.beginReading();
    const detail::QueryScope scope(&store_,
                                   Reader::kIsVolume ? Changes::forbidden : Changes::allowed);
    return visitTogether<Region, Collector>(reading, {&region, 1}, {&collector, 1},
                                            !Reader::kIsVolume);
}

// Several regions have bounds(), and had better be near each other.
template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visitTogether(const Reading& reading, std::span<const Region> regions,
                                      std::span<Collector> collectors, bool mayChange) const {
    QueryCost cost;
    const bool doAllStand = !mayChange && store_.doAllStand(reading);
    VisitReader<Region, Collector> reader{store_, reading,    regions,  collectors,
                                          cost,   doAllStand, mayChange};
    const std::size_t filedCount = reading.isFresh ? store_.proxies.waiting.size() : 0;
    reader.readTables(reading.filings());
    for (std::size_t i = 0; i < regions.size(); ++i) {
        if (collectors[i].limit() >= 0) {
            reader.readWaiting(i, filedCount);
        }
    }
    return cost;
}

template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visitEach(std::span<const Region> regions, std::span<Collector> collectors,
                                  ParallelFor parallelFor) const {
    HASHPHASE_ASSERT(regions.size() == collectors.size(),
                     "Grid::visitEach(): regions and collectors have different lengths. Pass one "
                     "collector for each region.");
    constexpr std::size_t grain = 256;
    // Boxes are looked for together.
    constexpr bool kHasBounds = requires(const Region& region) {
        region.bounds();
    };
    constexpr std::size_t atOnce = kHasBounds ? detail::QueryColumns<Scalar>::kMost : 1;
    const Reading reading = store_.beginReadings(regions.size());
    if constexpr (VisitReader<Region, Collector>::kIsLine) {
        store_.growTrees(reading, regions.size());
    }
    detail::SharedCost shared;
    parallelFor(regions.size(), grain, [&](std::size_t begin, std::size_t end) {
        QueryCost cost;
        const detail::QueryScope scope(&store_, detail::QueryScope::Changes::forbidden);
        for (; begin < end; begin += atOnce) {
            const std::size_t count = std::min(atOnce, end - begin);
            cost += visitTogether(reading, regions.subspan(begin, count),
                                  collectors.subspan(begin, count), false);
        }
        shared.add(cost);
    });
    return shared.sum();
}

/// The boxes that touch one cell, by the same rounding as cellAt().
template <class Scalar>
struct Grid<Scalar>::CellRegion {
    const Grid& grid;
    std::array<std::int64_t, 3> cell;

    [[nodiscard]] Scalar key(const Box& box) const {
        if (!detail::areFinite(box.min()) || !detail::areFinite(box.max())) {
            return -1;
        }
        const auto low = grid.cellAt(box.min());
        const auto high = grid.cellAt(box.max());
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (low[axis] > cell[axis] || high[axis] < cell[axis]) {
                return -1;
            }
        }
        return 0;
    }

    [[nodiscard]] Box bounds() const {
        // A little more than the cell: its borders are rounded. All that is farther away than cells
        // are numbered is in the last one.
        using Limits = std::numeric_limits<Scalar>;
        const Scalar size = grid.cellSize();
        Box bounds;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Scalar low =
                std::clamp(static_cast<Scalar>(cell[axis]) * size, Limits::lowest(), Limits::max());
            const Scalar margin = 8 * Limits::epsilon() * (std::abs(low) + size);
            const bool isFirst = cell[axis] <= -detail::kLastCell;
            const bool isLast = cell[axis] >= detail::kLastCell;
            bounds.min()[static_cast<int>(axis)] = isFirst ? -Limits::infinity() : low - margin;
            bounds.max()[static_cast<int>(axis)] =
                isLast ? Limits::infinity() : low + size + margin;
        }
        return bounds;
    }
};

template <class Scalar>
template <class Collector>
QueryCost Grid<Scalar>::visitCell(const std::array<std::int64_t, 3>& cell,
                                  Collector& collector) const {
    return visit(CellRegion{*this, cell}, collector);
}

template <class Scalar>
template <class Visit>
void Grid<Scalar>::forEach(Visit&& visit) const {
    std::vector<std::uint32_t> few;
    const auto count =
        static_cast<std::uint32_t>(store_.listFew(few));  // not those that `visit` adds
    for (std::uint32_t i = 0; i < count; ++i) {
        // Null after `visit` has removed the proxy, or the record, too.
        const ProxyId id = idAt(few.empty() ? i : few[i]);
        if (!id.isNull()) {
            const Box box = store_.proxies.records[id.index].box;  // a copy: `visit` may move them
            visit(id, box);
        }
    }
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
