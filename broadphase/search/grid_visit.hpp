// SPDX-License-Identifier: Zlib
#pragma once

// Grid's query templates; included by grid.hpp.

#include <broadphase/grid.hpp>
#include <broadphase/search/join.hpp>
#include <broadphase/tree/ray_walk.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// Turns what the walk finds into what the collector takes.
template <class Scalar>
template <class Region, class Collector>
struct Grid<Scalar>::VisitReader {
    const Grid& grid;
    const Reading& reading;
    const detail::Table<Scalar>& table;
    const Region& region;
    Collector& collector;
    QueryCost& cost;

    [[nodiscard]] auto limit() const { return collector.limit(); }

    template <class IsOwn>
    bool read(const detail::EntryRange& range, const IsOwn& isOwn) {
        for (std::uint32_t entry = range.first; entry < range.last; ++entry) {
            Scalar key = region.key(table.box(entry));
            if (!isWanted(key) || !isOwn(entry)) {
                continue;
            }
            const std::uint32_t slot = table.slot(entry);
            if (!grid.store().isFiled(slot, reading)) {
                continue;
            }
            // What is fresh has no list of what the collector has changed since: boxes are asked for
            // as they are now.
            if (reading.isFresh) {
                key = region.key(grid.store().proxies.records[slot].box);
            }
            if (isWanted(key) && !offer(slot, key)) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] bool isWanted(Scalar key) const { return detail::isWanted(key, collector); }

    bool offer(std::uint32_t slot, Scalar key) {
        ++cost.hits;
        collector.add(grid.store().proxies.idOf(slot), key);
        return limit() >= 0;
    }
};

/// The same for what a ray finds in a tree.
template <class Scalar>
template <class Region, class Collector>
struct Grid<Scalar>::RayReader {
    const Grid& grid;
    const Reading& reading;
    const Region& region;
    Collector& collector;
    QueryCost& cost;
    const Filing& filing;

    [[nodiscard]] auto limit() const { return collector.limit(); }

    bool read(std::uint32_t slot) {
        // The tree is as old as its table: who stands there may have left.
        if (!grid.store().standsIn(filing, slot, reading)) {
            return true;
        }
        const Scalar key = region.key(grid.store().proxies.records[slot].box);
        if (!detail::isWanted(key, collector)) {
            return true;
        }
        ++cost.hits;
        collector.add(grid.store().proxies.idOf(slot), key);
        return limit() >= 0;
    }
};

/// The same for what a kernel finds in a convex volume.
template <class Scalar>
template <class Region, class Collector>
struct Grid<Scalar>::VolumeReader {
    VisitReader<Region, Collector> reader;
    const Filing& filing;
    bool mayHaveLeft = false;  // some that are filed in the table
    detail::KernelCost walk{};

    /// Returns false when the collector wants no more.
    bool read() {
        if (!(reader.limit() >= 0)) {
            return false;
        }
        return std::ranges::all_of(reader.table.levels(), [this](
                                                              const detail::Level<Scalar>& level) {
            return level.count() == 0 || (level.hasCells() ? readCells(level) : readList(level));
        });
    }

private:
    bool readList(const detail::Level<Scalar>& level) {
        walk.boxesTested += level.count();
        return reader.read({level.firstEntry, level.lastEntry}, [](std::uint32_t) { return true; });
    }

    bool readCells(const detail::Level<Scalar>& level) {
        const auto flush = [](detail::SlotSink& sink) {
            return static_cast<VolumeReader*>(sink.owner)->take(sink);
        };
        std::array<std::uint32_t, 512> found;
        detail::SlotSink sink{found.data(), found.data(), found.data() + found.size(), flush, this};
        return detail::kernels<Scalar>().walkVolume(level, reader.region.volume(), sink, walk) &&
               take(sink);
    }

    bool take(detail::SlotSink& sink) {
        const std::span<const std::uint32_t> taken(sink.begin, sink.next);
        sink.next = sink.begin;
        return mayHaveLeft ? offer<true>(taken) : offer<false>(taken);
    }

    template <bool kMayHaveLeft>
    bool offer(std::span<const std::uint32_t> taken) {
        std::uint64_t hits = 0;  // no collector writes here
        bool goesOn = true;
        for (std::size_t i = 0; i < taken.size() && goesOn; ++i) {
            // Who is listed may have left: erased, or waiting.
            if (!kMayHaveLeft || reader.grid.store().standsIn(filing, taken[i], reader.reading)) {
                ++hits;
                reader.collector.add(reader.grid.store().proxies.idOf(taken[i]), Scalar(0));
                goesOn = reader.limit() >= 0;
            }
        }
        reader.cost.hits += hits;
        return goesOn;
    }
};

template <class Scalar>
template <class Region, class Collector>
bool Grid<Scalar>::visitTables(const Reading& reading, std::span<const Filing> filings,
                               const Region& region, Collector& collector, QueryCost& cost) const {
    if constexpr (requires { region.segment(); }) {
        const RayRegion<Scalar>& ray = region.segment();
        return std::ranges::all_of(filings, [&](const Filing& filing) {
            RayReader<Region, Collector> reader{*this, reading, region, collector, cost, filing};
            return detail::walkTree(filing.table->tree, ray, cost, reader);
        });
    } else if constexpr (requires { region.volume(); }) {
        return std::ranges::all_of(filings, [&](const Filing& filing) {
            const bool mayHaveLeft = (!reading.isFresh && !store_.proxies.waiting.empty()) ||
                                     (filing.isResting && store_.tables.restingErased > 0);
            VolumeReader<Region, Collector> reader{
                {*this, reading, *filing.table, region, collector, cost}, filing, mayHaveLeft};
            const bool goesOn = region.isEmpty() || reader.read();
            cost.rowsVisited += reader.walk.rowsVisited;
            cost.boxesTested += reader.walk.boxesTested;
            return goesOn;
        });
    } else {
        const Box bounds = region.bounds();
        return std::ranges::all_of(filings, [&](const Filing& filing) {
            VisitReader<Region, Collector> reader{*this,  reading,   *filing.table,
                                                  region, collector, cost};
            return detail::walkTable(*filing.table, bounds, cost, reader);
        });
    }
}

// Offers what changed since it was filed, by the boxes as they are now. Not by iterators: the collector
// may change the list.
template <class Scalar>
template <class Region, class Collector>
void Grid<Scalar>::visitWaiting(const Region& region, Collector& collector, QueryCost& cost) const {
    const std::size_t count = store_.proxies.waiting.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t slot = store_.proxies.waiting[i];
        if (!store_.proxies.isAlive(slot)) {
            continue;
        }
        ++cost.boxesTested;
        const Scalar key = region.key(store_.proxies.records[slot].box);
        if (detail::isWanted(key, collector)) {
            ++cost.hits;
            collector.add(store_.proxies.idOf(slot), key);
            if (!(collector.limit() >= 0)) {
                return;
            }
        }
    }
}

template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visit(const Region& region, Collector& collector) const {
    if constexpr (requires { region.segment(); }) {
        return visit(store_.beginReadingInOrder(), region, collector);
    } else {
        return visit(store_.beginReading(), region, collector);
    }
}

template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visit(const Reading& reading, const Region& region,
                              Collector& collector) const {
    using Changes = detail::QueryScope::Changes;
    constexpr bool kReadsRows = requires {
        region.volume();
    };
    const detail::QueryScope scope(&store_, kReadsRows ? Changes::forbidden : Changes::allowed);
    QueryCost cost;
    if (visitTables(reading, reading.filings(), region, collector, cost) && !reading.isFresh) {
        visitWaiting(region, collector, cost);
    }
    return cost;
}

// Some boxes are looked for at once, in one table after the other; what they find is then offered to
// the regions.
template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visitTogether(const Reading& reading, std::span<const Region> regions,
                                      std::span<Collector> collectors,
                                      detail::FewPairs& found) const {
    const detail::QueryColumns<Scalar> bounds(regions);
    // Where nothing waits, all that the tables list is filed there.
    const bool isAllFiled = reading.isFresh || store_.proxies.waiting.empty();
    QueryCost cost;
    for (const Filing& filing : reading.filings()) {
        const detail::Table<Scalar>* const table = filing.table;
        if (table->size() == 0) {
            continue;
        }
        detail::KernelCost walk;
        found.assign([&](detail::PairSink& sink) {
            detail::walkTogether(*table, bounds.columns(),
                                 static_cast<std::uint32_t>(regions.size()), sink, walk);
        });
        cost.rowsVisited += walk.rowsVisited;
        cost.boxesTested += walk.boxesTested;
        for (const auto [i, entry] : found.pairs()) {
            Scalar key = 0;
            if constexpr (!requires { Region::kIsItsBounds; }) {
                key = regions[i].key(table->box(entry));
            }
            const std::uint32_t slot = table->slot(entry);
            if (detail::isWanted(key, collectors[i]) &&
                (isAllFiled || store_.isFiled(slot, reading))) {
                ++cost.hits;
                collectors[i].add(store_.proxies.idOf(slot), key);
            }
        }
    }
    for (std::size_t i = 0; i < regions.size() && !isAllFiled; ++i) {
        if (collectors[i].limit() >= 0) {
            visitWaiting(regions[i], collectors[i], cost);
        }
    }
    return cost;
}

template <class Scalar>
template <class Region, class Collector>
QueryCost Grid<Scalar>::visitEach(std::span<const Region> regions, std::span<Collector> collectors,
                                  ParallelFor parallelFor) const {
    HASHPHASE_ASSERT(regions.size() == collectors.size(), "Each region has a collector.");
    constexpr std::size_t grain = 256;
    const Reading reading = store_.beginReadings(regions.size());
    if constexpr (requires { regions[0].segment(); }) {
        store_.growTrees(reading);
    }
    std::atomic<std::uint64_t> rowsVisited{0};
    std::atomic<std::uint64_t> boxesTested{0};
    std::atomic<std::uint64_t> hits{0};
    parallelFor(regions.size(), grain, [&](std::size_t begin, std::size_t end) {
        QueryCost cost;
        const detail::QueryScope scope(&store_, detail::QueryScope::Changes::forbidden);
        if constexpr (requires { regions[0].bounds(); }) {
            // So few that what they find has room, though each of them finds everything.
            constexpr std::size_t atOnce = detail::QueryColumns<Scalar>::kMost;
            detail::FewPairs found;
            for (; begin < end; begin += atOnce) {
                const std::size_t count = std::min(atOnce, end - begin);
                cost += visitTogether(reading, regions.subspan(begin, count),
                                      collectors.subspan(begin, count), found);
            }
        }
        for (; begin < end; ++begin) {
            cost += visit(reading, regions[begin], collectors[begin]);
        }
        rowsVisited += cost.rowsVisited;
        boxesTested += cost.boxesTested;
        hits += cost.hits;
    });
    return {rowsVisited, boxesTested, hits};
}

/// The boxes that touch one cell, by the same rounding as cellAt().
template <class Scalar>
struct Grid<Scalar>::CellRegion {
    const Grid& grid;
    std::array<std::int64_t, 3> cell;

    [[nodiscard]] Scalar key(const Box& box) const {
        if (!box.min().allFinite() || !box.max().allFinite()) {
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
        const std::uint32_t slot = few.empty() ? i : few[i];
        if (store_.proxies.isAlive(slot)) {
            const Box box =
                store_.proxies.records[slot].box;  // a copy: `visit` may move the records
            visit(store_.proxies.idOf(slot), box);
        }
    }
}

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
