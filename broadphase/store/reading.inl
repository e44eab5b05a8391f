// SPDX-License-Identifier: Zlib
#pragma once

// What queries read between updates, and what they build for that: the filing of many changes, and the
// trees of rays. Each is built by the first query that needs it, under one lock.

#include <broadphase/store/store.hpp>

#include <broadphase/search/ray_search.hpp>
#include <broadphase/search/ray_walk.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::detail {
namespace {

// So few changes are read by each query without further ado, unless there are few proxies, which are filed soon.
constexpr std::size_t kFewWait = 64;

// A ray reads the list as dearly as so many boxes.
constexpr std::size_t kBoxesPerRay = 3;

// Where readers write: what they need and is not there yet is built, under a lock, or before any of them
// has passed. The store is never a const object: it is created by its owner, and only seen as const. Neither
// are its tables.
template <class T>
T& writable(const T& what) {
    return const_cast<T&>(what);  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

}  // namespace

// Changes and queries may come in turn: filing for each query would cost far more than reading the
// list, and reading it for millions of queries far more than filing. So they read it until that has
// cost a third of what filing does, and then file: at most a third more than to file at once, which is
// right for many queries without a change in between, and a sixth more than the least there is for changes
// and queries in turn.
template <class Scalar>
std::uint64_t Store<Scalar>::worthFiling() const noexcept {
    constexpr std::uint64_t kThirdOfFiling = 3;  // entries of the list, for each proxy
    constexpr std::uint64_t kThirdOfFew =
        8;  // the same where these are few, for each that is listed,
    constexpr std::uint64_t kThirdOfNone = 32;  // and for all together
    if (areFew()) {
        return kThirdOfNone + kThirdOfFew * proxies.waiting.size();
    }
    return 1024 + kThirdOfFiling * (tables.mobile.size() + proxies.settledChanged);
}

template <class Scalar>
auto Store<Scalar>::beginReading(std::size_t weight) const -> Reading {
    mendTables();
    const std::size_t count = proxies.waiting.size();
    if ((count > kFewWait || areFewListed()) && !tables.isFresh.load(std::memory_order_acquire) &&
        countRead(weight * count) > worthFiling()) {
        writable(*this).fileFresh();
    }
    return tables.reading();
}

template <class Scalar>
void Store<Scalar>::expectQueries(std::size_t count) const {
    mendTables();
    if ((proxies.waiting.size() > kFewWait || areFewListed()) &&
        !tables.isFresh.load(std::memory_order_acquire)) {
        const std::uint64_t read = tables.waitingRead.load(std::memory_order_relaxed);
        if (count > (worthFiling() - std::min(worthFiling(), read)) / proxies.waiting.size()) {
            writable(*this).fileFresh();
        }
    }
}

template <class Scalar>
void Store<Scalar>::expectRays(std::size_t count) const {
    expectQueries(kBoxesPerRay * count);
    growTrees(tables.reading(), count);
}

template <class Scalar>
auto Store<Scalar>::beginReadingForRay() const -> Reading {
    const Reading reading = beginReading(kBoxesPerRay);
    growTrees(reading, 1);
    return reading;
}

template <class Scalar>
auto Store<Scalar>::beginReadings(std::size_t count) const -> Reading {
    expectQueries(count);
    const Reading reading = tables.reading();
    countRead(reading.isFresh ? 0 : std::uint64_t{proxies.waiting.size()} * count);
    return reading;
}

// Returns how much of the list of changes queries have read by now.
template <class Scalar>
std::uint64_t Store<Scalar>::countRead(std::uint64_t count) const noexcept {
    auto& read = writable(*this).tables.waitingRead;
    return read.fetch_add(count, std::memory_order_relaxed) + count;
}

// No reader has passed this point while the table is torn, and the first to come here files for all.
template <class Scalar>
void Store<Scalar>::mendTables() const {
    if (!tables.mustRefileMobile.load(std::memory_order_acquire)) {
        return;
    }
    auto& self = writable(*this);
    const std::lock_guard lock(self.tables.mutex);
    if (tables.mustRefileMobile.load(std::memory_order_relaxed)) {
        self.stage(serialFor, StageFor::repair);
        self.fileMobile(serialFor);
        if (!hasPairs) {
            self.relistMobile();
        }
        self.tables.mustRefileMobile.store(false, std::memory_order_release);
    }
}

// Others may be reading the mobile table and the list, and go on with them. None reads the fresh one: since
// it was last in use, something has changed. From within a query that is not so, and nothing is filed.
template <class Scalar>
void Store<Scalar>::fileFresh() {
    if (QueryScope::isWithin(this)) {
        return;
    }
    const std::unique_lock lock(tables.mutex, std::try_to_lock);
    if (!lock.owns_lock() || tables.isFresh.load(std::memory_order_relaxed)) {
        return;
    }
    if (tables.fresh == nullptr) {
        tables.fresh = std::make_unique<FiledTable<Scalar>>();
    }
    stage(serialFor, StageFor::queries);
    frame.proxyIndices = proxies.mobile;
    for (std::size_t i = 0; proxies.settledChanged > 0 && i < proxies.waiting.size(); ++i) {
        if (proxies.rests(proxies.waiting[i])) {
            frame.proxyIndices.push_back(proxies.waiting[i]);
            frame.now.push_back(padded(proxies.records[proxies.waiting[i]].box));
        }
    }
    tables.fresh->file(frame.proxyIndices, frame.now, fixedSizes(), serialFor,
                       proxies.groupsOfAll());
    ++tables.filingCount;
    cost.filed += tables.fresh->size();
    tables.isFresh.store(true, std::memory_order_release);
}

// Before a change: what is fresh will not be so any more.
template <class Scalar>
void Store<Scalar>::takeFresh() noexcept {
    tables.isFresh.store(false, std::memory_order_relaxed);
    if (QueryScope::isWithin(this)) {
        return;
    }
    for (std::size_t i = 0; proxies.settledChanged > 0 && i < proxies.waiting.size(); ++i) {
        if (proxies.rests(proxies.waiting[i])) {
            wake(proxies.waiting[i]);  // now it is filed with the mobile ones
        }
    }
    tables.mobile.swap(*tables.fresh);
    if (tables.fresh->memoryBytes() == 0) {  // the first filing of all
        tables.fresh.reset();
    }
    clearSweeping();
    dropList();
    if (!hasPairs) {
        relistMobile();
    }
    forgetErased();
}

template <class Scalar>
void Store<Scalar>::dropList() noexcept {
    proxies.dropWaiting();
    tables.waitingRead.store(0, std::memory_order_relaxed);
}

// What was at rest and has left it is listed until the next update, which may never come. Where all
// have left, as with a level, no query need look at them any more.
template <class Scalar>
void Store<Scalar>::forgetErased() noexcept {
    if (tables.restingErased > 0 && tables.restingErased == tables.resting.size()) {
        tables.resting.clear();
        tables.restingErased = 0;
        tables.resting.makeTreeStale();
    }
}

// Others may be walking the cells of the tables, and go on with them.
template <class Scalar>
void Store<Scalar>::growTrees(const Reading& reading, std::size_t rayCount) const {
    const auto lacksTree = [&](const Filing& filing) { return filing.table->lacksTree(rayCount); };
    if (rayCount == 0 || std::ranges::none_of(reading.filings(), lacksTree)) {
        return;
    }
    auto& self = writable(*this);
    const std::lock_guard lock(self.tables.mutex);
    Tables<Scalar>::forAll(self.tables, [&](FiledTable<Scalar>& table) {
        const auto isRead = [&](const Filing& filing) { return filing.table == &table; };
        if (std::ranges::any_of(reading.all, isRead) && table.lacksTree(rayCount)) {
            const bool isResting = &table == &tables.resting;
            table.tree.build(table, [&](std::uint32_t entry) {
                return isResting ? filedBox(entry) : table.box(entry);
            });
            table.isTreeStale.store(false, std::memory_order_release);
        }
    });
}

// By which of the two changes the order in which boxes are found, and not which.
template <class Scalar>
bool Store<Scalar>::searchAlong(const RayRegion<Scalar>& ray, const FiledTable<Scalar>& table,
                                double limit,
                                FunctionRef<double(std::span<const std::uint32_t>)> take,
                                QueryCost& queryCost) const {
    if (!table.isTreeStale.load(std::memory_order_acquire)) {
        return searchRay(table.tree, ray, limit, take, queryCost);
    }
    QueryCost walk;
    const bool goesOn = searchCells(table, ray, limit, take, walk);
    if (walk.boxesTested > 0 || walk.rowsVisited > 0) {
        writable(table).countWalk(kBoxesPerRun * walk.rowsVisited + walk.boxesTested);
    }
    queryCost += walk;
    return goesOn;
}

}  // namespace hashphase::detail
