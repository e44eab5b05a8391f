// SPDX-License-Identifier: Zlib
#include <broadphase/store/store.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

namespace hashphase::detail {
namespace {

const GridConfig& checked(const GridConfig& config) {
    const std::string error = configError(config);
    if (!error.empty()) {
        throw std::invalid_argument(error);
    }
    return config;
}

// Grids have those above, of 2^32 numbers each.
std::uint64_t firstPopulationNumber() noexcept {
    static std::atomic<std::uint64_t> gridCount{0};
    return ++gridCount << 32;
}

}  // namespace

template <class Scalar>
Store<Scalar>::Store(const GridConfig& itsConfig) : config(checked(itsConfig)) {
    proxies.number = firstPopulationNumber();
    if (config.cellSize > 0) {
        tables.cellSize = static_cast<Scalar>(config.cellSize);
    }
}

// --- Proxies -------------------------------------------------------------------------------------

template <class Scalar>
std::uint32_t Store<Scalar>::add(const Box& box, bool restsAtOnce, const ProxyGroups& groups) {
    if (groups != ProxyGroups{}) {
        proxies.makeGroups();
    }
    beforeChange();  // before anything is listed that it does not have
    // It may be that of another proxy, which moves. NOLINTNEXTLINE(*-unnecessary-copy-initialization)
    const Box own = box;
    const std::uint32_t slot = takeSlot();
    if (!proxies.groups.empty()) {
        proxies.groups.resize(2 * proxies.records.size());
        proxies.setGroups(slot, groups);
        proxies.groups[2 * std::size_t{slot} + 1] = groups;
    }
    Record& record = proxies.records[slot];
    ++record.generation;
    record.residency = Residency::mobile;
    proxies.listMobile(slot);
    ++proxies.size;
    ++proxies.number;
    markChanged(slot);
    setBox(record, own);
    record.restsAtOnce = restsAtOnce;
    return slot;
}

// One without a proxy, and room to list it.
template <class Scalar>
std::uint32_t Store<Scalar>::takeSlot() {
    std::uint32_t slot = proxies.free.first;
    if (slot == kNoSlot) {
        proxies.reserveSlots(proxies.records.size() + 1);
        proxies.reserveLists(listedCount() + 1);
        slot = static_cast<std::uint32_t>(proxies.records.size());
        proxies.records.emplace_back().generation = proxies.firstGeneration;
    } else {
        proxies.reserveLists(listedCount() + 1);
        proxies.free.first = proxies.records[slot].listedAt;
        --proxies.free.count;
    }
    return slot;
}

template <class Scalar>
void Store<Scalar>::reserve(std::size_t count) {
    checkCount(count, kMostProxies, "A grid holds at most 268,435,456 proxies.");
    const std::size_t removed = proxies.removed.count + proxies.removedImmediate.count;
    proxies.reserveSlots(count + removed);
    proxies.reserveLists(count + removed);
    proxies.reservedCount = count;
}

template <class Scalar>
void Store<Scalar>::move(std::uint32_t slot, const Box& box) {
    Record& record = proxies.records[slot];
    if (!isSameBits(record.box, box)) {
        markChanged(slot);
        setBox(record, box);
    }
}

template <class Scalar>
void Store<Scalar>::remove(std::uint32_t slot) noexcept {
    markChanged(slot);
    const bool cameAndWent = proxies.isUnseen(slot);
    if (cameAndWent) {
        proxies.unlistMobile(slot);
    }
    Record& record = proxies.records[slot];
    proxies.nanCount -= record.isNan ? 1 : 0;
    record.isNan = false;
    record.box = nanBox<Scalar>();
    record.residency = Residency::nowhere;
    ++record.generation;
    --proxies.size;
    ++proxies.number;
    if (record.generation == kLastGeneration) {
        return;  // nobody gets the slot any more, or an id would name two proxies
    }
    proxies.append(slot, !cameAndWent         ? proxies.removed
                         : record.isImmediate ? proxies.removedImmediate
                                              : proxies.free);
}

// Slots in the order in which a new grid makes them. What tells their ids apart stays.
template <class Scalar>
void Store<Scalar>::clear() {
    proxies.clear();
    tables.clear();
    mustRebuildPairs = false;
    cost = {};
    freeArrays(frame.now, frame.before, frame.slots, frame.boxes);
    tables.cellSize = config.cellSize > 0 ? static_cast<Scalar>(config.cellSize) : Scalar(1);
}

template <class Scalar>
void Store<Scalar>::setGroups(std::uint32_t slot, const ProxyGroups& groups) {
    proxies.makeGroups();
    proxies.setGroups(slot, groups);
    proxies.areRegrouped = true;
    Record& record = proxies.records[slot];
    if (hasPairs && record.residency == Residency::mobile) {
        countChange(record);  // where its box is filed, there it is
    } else if (hasPairs) {
        markChanged(slot);
    }
}

// --- A change ------------------------------------------------------------------------------------

template <class Scalar>
void Store<Scalar>::markChanged(std::uint32_t slot) noexcept {
    beforeChange();
    Record& record = proxies.records[slot];
    countChange(record);
    if (record.residency == Residency::resting) {
        wake(slot);
    }
    if (!proxies.isWaiting(record)) {
        record.listedIn = proxies.listNumber;
        proxies.waiting.push_back(slot);
    }
}

template <class Scalar>
void Store<Scalar>::countChange(Record& record) noexcept {
    if (record.changedAt != proxies.updateNumber) {
        record.before = record.box;
        if (record.residency == Residency::sweeping) {
            record.before = proxies.nowhere();  // as standingBox(), which copies more slowly
        }
        record.changedAt = proxies.updateNumber;
        ++cost.changed;
    }
}

template <class Scalar>
void Store<Scalar>::wake(std::uint32_t slot) noexcept {
    Record& record = proxies.records[slot];
    tables.resting.erase(record.listedAt);
    ++tables.restingErased;
    record.residency = Residency::mobile;
    proxies.listMobile(slot);
    proxies.woken.push_back(slot);
}

template <class Scalar>
void Store<Scalar>::setBox(Record& record, const Box& box) {
    record.box = box;
    record.restsAtOnce = false;
    const bool isNan = hasNan(box);
    if (isNan || record.isNan) {
        markNan(record, isNan);
    }
}

template <class Scalar>
void Store<Scalar>::markNan(Record& record, bool isNan) {
    proxies.nanCount += isNan ? 1 : 0;
    proxies.nanCount -= record.isNan ? 1 : 0;
    record.isNan = isNan;
    if (isNan && !proxies.nanReported) {
        proxies.nanReported = true;
        reportMessage(
            "A box with a NaN coordinate was set. It will pair with nothing and be found by "
            "nothing until a box without NaN is set; further ones are counted silently.");
    }
}

template <class Scalar>
void Store<Scalar>::beginSweep(std::uint32_t slot) noexcept {
    markChanged(slot);
    proxies.records[slot].residency = Residency::sweeping;
    proxies.sweeping.push_back(slot);
}

template <class Scalar>
void Store<Scalar>::endSweep(std::uint32_t slot) noexcept {
    markChanged(slot);
    Record& record = proxies.records[slot];
    record.residency =
        record.residency == Residency::sweeping ? Residency::mobile : record.residency;
}

// Without pairs nothing does.
template <class Scalar>
void Store<Scalar>::endSweeps() noexcept {
    for (const std::uint32_t slot : proxies.sweeping) {
        if (proxies.records[slot].residency == Residency::sweeping) {
            endSweep(slot);
        }
    }
}

template <class Scalar>
std::size_t Store<Scalar>::listFew(std::vector<std::uint32_t>& few) const {
    few.clear();
    if (!isSparse()) {
        return proxies.records.size();
    }
    forEachListed([&](std::uint32_t slot) {
        if (proxies.isAlive(slot)) {
            few.push_back(slot);
        }
    });
    std::sort(few.begin(), few.end());
    return few.size();
}

// --- Accounts ------------------------------------------------------------------------------------

template <class Scalar>
std::string Store<Scalar>::validate() const {
    mendTables();
    const Reading reading = tables.reading();
    // How often each proxy stands where a query would look for it.
    std::vector<std::uint32_t> timesFound(proxies.records.size(), 0);
    for (const auto& [table, isResting] : reading.filings()) {
        if (std::string error = table->validate(); !error.empty()) {
            return error;
        }
        if (std::string error = table->validateTree(); !error.empty()) {
            return error;
        }
        for (std::uint32_t entry = 0; entry < table->size(); ++entry) {
            const std::uint32_t slot = table->slot(entry);
            if (hasNan(table->box(entry)) || !isFiled(slot, reading)) {
                continue;
            }
            ++timesFound[slot];
            if (!isSameBits(table->box(entry), proxies.records[slot].box)) {
                return "A filed proxy's entry has the proxy's box: broken.";
            }
        }
    }
    for (std::size_t i = 0; i < proxies.waiting.size() && !reading.isFresh; ++i) {
        timesFound[proxies.waiting[i]] += proxies.isAlive(proxies.waiting[i]) ? 1 : 0;
    }
    std::size_t alive = 0;
    for (std::uint32_t slot = 0; slot < proxies.records.size(); ++slot) {
        const Record& record = proxies.records[slot];
        const bool isAlive = proxies.isAlive(slot);
        const bool isNan = record.isNan && (reading.isFresh || !proxies.isWaiting(record));
        alive += isAlive ? 1 : 0;
        if (timesFound[slot] != (isAlive && !isNan ? 1U : 0U)) {
            return "Every proxy alive is filed in exactly one table, or waits in the list of "
                   "changes, or is NaN: broken.";
        }
    }
    return alive == proxies.size ? std::string() : "size() is the number of proxies alive: broken.";
}

template struct Store<float>;
template struct Store<double>;

}  // namespace hashphase::detail
