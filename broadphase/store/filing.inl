// SPDX-License-Identifier: Zlib
#pragma once

// How an update files what has changed, in passes.

#include <broadphase/store/store.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace hashphase::detail {
namespace {

constexpr std::size_t kFewIdle = 32;

// Resting proxies are refiled when this many want to join or have left: often enough to be of use,
// and seldom enough to be cheap for each of them.
std::size_t worthRefiling(std::size_t restingCount) {
    return std::max<std::size_t>(kFewIdle, restingCount / 8);
}

}  // namespace

template <class Scalar>
bool Store<Scalar>::haveFewMoved() const noexcept {
    const bool hasNoneComeOrWoken = proxies.mobile.size() == proxies.mobileAtUpdate;
    const bool hasNoneGone = proxies.removed.count + proxies.removedImmediate.count == 0;
    return cost.changed > 0 && hasNoneComeOrWoken && hasNoneGone && proxies.sweeping.empty() &&
           !proxies.areRegrouped && !tables.mustRefileMobile.load(std::memory_order_relaxed) &&
           areFew() && std::ranges::none_of(proxies.mobile, [this](std::uint32_t proxyIndex) {
               return isIdle(proxies.records[proxyIndex]);
           });
}

// Indices that are near each other in space are near each other
// in proxies.mobile, but anywhere in proxies.records.
template <class Scalar>
void Store<Scalar>::stage(ParallelFor parallelFor, StageFor what) {
    constexpr std::size_t kGrain = 4096;
    constexpr std::size_t kAhead = 12;
    const std::size_t count = proxies.mobile.size();
    frame.now.resize(count);
    frame.before.resize(hasPairs ? count : 0);
    ensureCapacity(frame.proxyIndices, proxies.nanCount);  // for relistMobile()
    frame.idleCount = 0;
    std::atomic<std::uint32_t> calmCount{0};  // of those that may settle with slack
    std::atomic<std::uint32_t> allCalmCount{0};
    const bool observes = what == StageFor::update && observesNow();
    if (observes && frame.someAreCalm.exchange(false)) {
        makeTremors();
    }
    const bool areShifted = !proxies.boxesAtUpdate.empty();
    const bool someRefuse = proxies.groupKinds.someRefuse();  // else nobody asks for kinds
    frame.mobileKinds = 0;
    frame.changedKinds = 0;
    const auto stagePart = [&, what, observes, areShifted, someRefuse, count](std::size_t begin,
                                                                              std::size_t end) {
        PaddedBox<Scalar>* const now = frame.now.data();
        PaddedBox<Scalar>* const before = hasPairs ? frame.before.data() : nullptr;
        const std::uint32_t* const mobile = proxies.mobile.data();
        std::uint32_t idleCount = 0;
        std::uint32_t ownCalmCount = 0;
        std::uint32_t ownAllCalmCount = 0;
        GroupKinds::Set mobileKinds = 0;
        GroupKinds::Set changedKinds = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (i + kAhead < count) {
                prefetch(&proxies.records[mobile[i + kAhead]]);
            }
            Record& record = proxies.records[mobile[i]];
            now[i] = padded(what == StageFor::queries ? record.box : proxies.standingBox(record));
            if (before != nullptr) {
                before[i] = areShifted ? padded(boxAtUpdate(mobile[i]))
                                       : padded(proxies.standingBefore(record));
            }
            const bool isIdle = this->isIdle(record);
            const bool maySettle = observes && observe(mobile[i], record);
            idleCount += isIdle ? 1 : 0;
            ownCalmCount += maySettle && !isIdle ? 1 : 0;
            ownAllCalmCount += observes && record.isCalm ? 1 : 0;
            if (someRefuse) {
                const GroupKinds::Set kind = GroupKinds::bit(record.kind);
                mobileKinds |= kind;
                changedKinds |= record.changedAt == proxies.updateNumber ? kind : 0;
            }
        }
        frame.idleCount += idleCount;
        calmCount += ownCalmCount;
        allCalmCount += ownAllCalmCount;
        frame.mobileKinds |= mobileKinds;
        frame.changedKinds |= changedKinds;
    };
    parallelFor(count, kGrain, stagePart);
    if (observes) {
        const std::size_t allCalm = allCalmCount.load();
        frame.someAreCalm = config.slack ? allCalm > 0 : 8 * allCalm > 7 * count;
    }
    if (settling != nullptr) {
        settling->calmCount = calmCount.load();
    }
}

template <class Scalar>
bool Store<Scalar>::settleIdle(ParallelFor parallelFor) {
    constexpr std::uint32_t kUpdatesPerSettling = 8;
    const std::size_t filedCount = tables.resting.size() - tables.restingErased;
    const bool withSlack = isWorthSlack();
    const std::uint32_t calmCount = withSlack ? settling->calmCount : 0;
    const std::uint32_t joining = frame.idleCount + calmCount;
    tables.idleUpdates += frame.idleCount + kUpdatesPerSettling * updatesObserved() * calmCount;
    if (observesNow()) {
        observedEach =
            withSlack ? kOftenObserved : std::min<std::uint8_t>(observedEach + 1, kSeldomObserved);
    }
    // To file one takes about as long as an update of a mobile one among its like, and an eighth of one among
    // many that are settled.
    if (std::max(joining, tables.restingErased) < worthRefiling(filedCount) &&
        tables.idleUpdates < kFewIdle + filedCount + joining) {
        return false;
    }
    // Those that stay at rest come first, then those that join.
    ensureCapacity(frame.proxyIndices, filedCount + joining);
    ensureCapacity(frame.boxes, filedCount + joining);
    listResting();
    if (settling != nullptr) {
        settling->stayedCount = static_cast<std::uint32_t>(frame.proxyIndices.size());
    }
    for (std::size_t i = 0; joining > 0 && i < proxies.mobile.size(); ++i) {
        Record& record = proxies.records[proxies.mobile[i]];
        if (record.residency != Residency::mobile) {
            continue;
        }
        const bool isIdle = this->isIdle(record);
        if (isIdle || (withSlack && maySettle(proxies.mobile[i], record))) {
            record.residency = Residency::resting;
            record.hasSlack = !isIdle;
            proxies.settledChanged += isIdle ? 0 : 1;
            frame.proxyIndices.push_back(proxies.mobile[i]);
            frame.now[i] = padded(nanBox<Scalar>());
        }
    }
    fileResting(parallelFor);
    return joining > 0;
}

// Those that are at rest, in the order of their table.
template <class Scalar>
void Store<Scalar>::listResting() {
    frame.proxyIndices.clear();
    frame.boxes.clear();
    for (const std::uint32_t proxyIndex : tables.resting.proxyIndices()) {
        Record& record = proxies.records[proxyIndex];
        if (record.residency == Residency::resting) {
            const bool keepsSlack = record.hasSlack && !isIdle(record);
            loseSlack(proxyIndex);
            record.hasSlack = keepsSlack;
            frame.proxyIndices.push_back(proxyIndex);
        }
    }
    tables.settledAt = proxies.updateNumber;
}

// Those that are listed, by larger boxes where they have slack.
template <class Scalar>
void Store<Scalar>::fileResting(ParallelFor parallelFor) {
    std::size_t slackCount = 0;
    for (const std::uint32_t proxyIndex : frame.proxyIndices) {
        frame.boxes.push_back(padded(boxToFile(proxyIndex)));
        slackCount += proxies.records[proxyIndex].hasSlack ? 1 : 0;
    }
    if (settling != nullptr) {
        settling->slackCount = slackCount;
    }
    tables.resting.file(frame.proxyIndices, frame.boxes, fixedSizes(), parallelFor,
                        proxies.groupsOfAll());
    if (slackCount > 0) {
        tables.resting.settle();
    }
    tables.idleUpdates = 0;
    tables.restingKinds = 0;
    for (std::uint32_t entry = 0; entry < tables.resting.size(); ++entry) {
        proxies.records[tables.resting.proxyIndex(entry)].listedAt = entry;
        tables.restingKinds |= proxies.kindOf(tables.resting.proxyIndex(entry));
    }
    tables.restingErased = 0;
    cost.filed += tables.resting.size();
}

template <class Scalar>
void Store<Scalar>::fileMobile(ParallelFor parallelFor) {
    tables.isFresh.store(false, std::memory_order_relaxed);
    tables.mustRefileMobile.store(
        true,
        std::memory_order_relaxed);  // should it fail, the next one files anew
    tables.mobile.file(proxies.mobile, frame.now, fixedSizes(), parallelFor, proxies.groupsOfAll());
    ++tables.filingCount;
    cost.filed += tables.mobile.size();
    fileSweeping(parallelFor);
    dropList();
}

// What sweeps is filed apart, for queries: their boxes may be many times as large as those of what
// stands, and no pair is looked for by them.
template <class Scalar>
void Store<Scalar>::fileSweeping(ParallelFor parallelFor) {
    std::erase_if(proxies.sweeping, [this](std::uint32_t proxyIndex) {
        return proxies.records[proxyIndex].residency != Residency::sweeping;
    });
    if (proxies.sweeping.empty()) {
        clearSweeping();
        return;
    }
    if (tables.sweeping == nullptr) {
        tables.sweeping = std::make_unique<FiledTable<Scalar>>();
    }
    frame.boxes.clear();
    for (const std::uint32_t proxyIndex : proxies.sweeping) {
        frame.boxes.push_back(padded(proxies.records[proxyIndex].box));
    }
    tables.sweeping->file(proxies.sweeping, frame.boxes, fixedSizes(), parallelFor);
    cost.filed += tables.sweeping->size();
}

template <class Scalar>
void Store<Scalar>::clearSweeping() noexcept {
    if (tables.sweeping != nullptr) {
        tables.sweeping->clear();
        tables.sweeping->makeTreeStale();
    }
}

template <class Scalar>
void Store<Scalar>::relistMobile() noexcept {
    frame.proxyIndices.clear();
    if (tables.mobile.size() != proxies.mobile.size() && proxies.nanCount > 0) {
        std::copy_if(
            proxies.mobile.begin(), proxies.mobile.end(), std::back_inserter(frame.proxyIndices),
            [this](std::uint32_t proxyIndex) { return proxies.records[proxyIndex].isNan; });
    }
    proxies.mobile.assign(tables.mobile.proxyIndices().begin(), tables.mobile.proxyIndices().end());
    if (tables.sweeping != nullptr) {
        const std::span<const std::uint32_t> sweeping = tables.sweeping->proxyIndices();
        proxies.mobile.insert(proxies.mobile.end(), sweeping.begin(), sweeping.end());
    }
    proxies.mobile.insert(proxies.mobile.end(), frame.proxyIndices.begin(),
                          frame.proxyIndices.end());
    proxies.mobileAtUpdate = proxies.mobile.size();
    proxies.giveBack(proxies.removed);
    proxies.giveBack(proxies.removedImmediate);
}

template <class Scalar>
void Store<Scalar>::endUpdate(UpdateCost& done) noexcept {
    // Number by number: of wider reads the processor would wait for what was written last.
    done.changed = std::exchange(cost.changed, 0);
    done.filed = std::exchange(cost.filed, 0);
    done.largestCell = 0;
    done.resting = tables.resting.size() - tables.restingErased;
    double finest = std::numeric_limits<double>::infinity();
    const Reading reading = tables.reading();
    for (const Filing& filing : reading.filings()) {
        done.largestCell = std::max(done.largestCell, filing.table->largestCell());
        finest = std::min(finest, filing.table->finestCellSize());
    }
    if (isRestFiledNow() && tables.resting.isSettled()) {
        keepFiledBoxes();
    }
    tables.resting.endRefresh();
    proxies.woken.clear();
    proxies.settledChanged = 0;
    proxies.boxesAtUpdate.clear();
    proxies.indicesAtUpdate.clear();
    if (std::exchange(proxies.areRegrouped, false)) {
        for (std::size_t i = 0; i < proxies.groups.size(); i += 2) {
            proxies.groups[i + 1] = proxies.groups[i];
        }
    }
    if (++proxies.updateNumber == std::numeric_limits<std::uint32_t>::max()) {
        proxies.countUpdatesAnew(config.updatesBeforeRest);
        tables.settledAt = 0;
    }
    if (config.cellSize == 0 && !tables.mustRefileMobile.load(std::memory_order_relaxed)) {
        tables.cellSize = std::isinf(finest) ? Scalar(1) : static_cast<Scalar>(finest);
    }
}

template <class Scalar>
void Store<Scalar>::forgetLastUpdate() noexcept {
    beforeChange();  // which may list others, and in another order
    forEachListed([this](std::uint32_t proxyIndex) {
        if (proxies.isAlive(proxyIndex)) {
            markChanged(proxyIndex);
        }
        proxies.records[proxyIndex].before = nanBox<Scalar>();
        proxies.records[proxyIndex].isImmediate = false;
    });
    proxies.woken.clear();  // had no box then, and may be removed for good before the next update
    proxies.boxesAtUpdate.clear();
    proxies.indicesAtUpdate.clear();
    mustRebuildPairs = false;
}

// Whoever has been put to rest by now is still listed among the mobile ones; who rested before is not.
template <class Scalar>
void Store<Scalar>::wakeAll() noexcept {
    for (const std::uint32_t proxyIndex : proxies.mobile) {
        Record& record = proxies.records[proxyIndex];
        loseSlack(proxyIndex);
        record.residency =
            record.residency == Residency::resting ? Residency::mobile : record.residency;
    }
    for (std::uint32_t proxyIndex = 0; proxyIndex < proxies.records.size(); ++proxyIndex) {
        if (proxies.records[proxyIndex].residency == Residency::resting) {
            loseSlack(proxyIndex);
            proxies.records[proxyIndex].residency = Residency::mobile;
            proxies.listMobile(proxyIndex);
            proxies.woken.push_back(proxyIndex);
        }
    }
    mustRebuildPairs = true;
    tables.resting.clear();
    tables.restingErased = 0;
    tables.resting.makeTreeStale();
    tables.isFresh.store(false, std::memory_order_relaxed);
    tables.mustRefileMobile.store(true, std::memory_order_relaxed);
}

}  // namespace hashphase::detail
