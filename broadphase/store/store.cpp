// SPDX-License-Identifier: Zlib
#include <broadphase/store/store.hpp>

#include <broadphase/core/raise.hpp>
#include <broadphase/store/filing.inl>
#include <broadphase/store/memory.inl>
#include <broadphase/store/reading.inl>
#include <broadphase/store/settling.inl>
#include <broadphase/store/shift.inl>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <atomic>
#include <utility>

namespace hashphase::detail {
namespace {

const GridConfig& checked(const GridConfig& config) {
    const std::string error = configError(config);
    if (!error.empty()) {
        raiseInvalidArgument(error);
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
    const std::uint32_t proxyIndex = takeIndex();
    if (!proxies.groups.empty()) {
        proxies.groups.resize(2 * proxies.records.size());
        proxies.setGroups(proxyIndex, groups);
        proxies.groups[2 * std::size_t{proxyIndex} + 1] = groups;
    }
    Record& record = proxies.records[proxyIndex];
    ++record.generation;
    record.before = nanBox<Scalar>();  // not that of one removed in this frame
    record.residency = Residency::mobile;
    proxies.listMobile(proxyIndex);
    if (settling != nullptr && proxyIndex < settling->tremors.size()) {
        settling->tremors[proxyIndex] = {};
    }
    ++proxies.size;
    ++proxies.number;
    markChanged(proxyIndex);
    setBox(record, own);
    record.restsAtOnce = restsAtOnce;
    return proxyIndex;
}

// One without a proxy, and room to list it.
template <class Scalar>
std::uint32_t Store<Scalar>::takeIndex() {
    // Those that came and went, and cannot come again before the update, are listed as changed alone.
    const std::size_t room = listedCount() + proxies.removedImmediate.count + 1;
    std::uint32_t proxyIndex = proxies.free.first;
    if (proxyIndex == kNoProxyIndex) {
        proxies.reserveRecords(proxies.records.size() + 1);
        proxies.reserveLists(room);
        proxyIndex = static_cast<std::uint32_t>(proxies.records.size());
        proxies.records.emplace_back().generation = proxies.firstGeneration;
    } else {
        proxies.reserveLists(room);
        proxies.free.first = proxies.records[proxyIndex].listedAt;
        --proxies.free.count;
    }
    return proxyIndex;
}

template <class Scalar>
void Store<Scalar>::reserve(std::size_t count) {
    makeRoom(count);
    proxies.reservedCount = count;
}

template <class Scalar>
void Store<Scalar>::makeRoom(std::size_t count) {
    checkCount(count, kMostProxies,
               "A grid holds at most 268,435,456 proxies. Remove some, or use another grid.");
    const std::size_t removed = proxies.removed.count + proxies.removedImmediate.count;
    proxies.reserveRecords(count + removed);
    proxies.reserveLists(count + removed);
}

template <class Scalar>
void Store<Scalar>::remove(std::uint32_t proxyIndex) noexcept {
    markChanged(proxyIndex);
    const bool cameAndWent = proxies.isUnseen(proxyIndex);
    if (cameAndWent) {
        proxies.unlistMobile(proxyIndex);
    }
    Record& record = proxies.records[proxyIndex];
    proxies.nanCount -= record.isNan ? 1 : 0;
    record.isNan = false;
    record.box = nanBox<Scalar>();
    record.residency = Residency::nowhere;
    ++record.generation;
    --proxies.size;
    ++proxies.number;
    if (record.generation == kLastGeneration) {
        return;  // nobody gets the index any more, or an id would name two proxies
    }
    proxies.append(proxyIndex, !cameAndWent         ? proxies.removed
                               : record.isImmediate ? proxies.removedImmediate
                                                    : proxies.free);
}

// Indices in the order in which a new grid makes them. What tells their ids apart stays.
template <class Scalar>
void Store<Scalar>::clear() {
    proxies.clear();
    tables.clear();
    mustRebuildPairs = false;
    cost = {};
    frame.someAreCalm = false;
    observedEach = kOftenObserved;
    freeArrays(frame.now, frame.before, frame.proxyIndices, frame.boxes);
    settling.reset();
    moveScratch.reset();
    tables.cellSize = config.cellSize > 0 ? static_cast<Scalar>(config.cellSize) : Scalar(1);
}

template <class Scalar>
void Store<Scalar>::setGroups(std::uint32_t proxyIndex, const ProxyGroups& groups) {
    proxies.makeGroups();
    proxies.setGroups(proxyIndex, groups);
    proxies.areRegrouped = true;
    Record& record = proxies.records[proxyIndex];
    if (hasPairs && record.residency == Residency::mobile) {
        countChange(record);  // where its box is filed, there it is
    } else if (hasPairs) {
        markChanged(proxyIndex);
    }
}

// --- A change ------------------------------------------------------------------------------------

template <class Scalar>
void Store<Scalar>::markChanged(std::uint32_t proxyIndex) noexcept {
    beforeChange();
    Record& record = proxies.records[proxyIndex];
    if (record.residency == Residency::resting) {
        wake(proxyIndex);
    }
    countChange(record);
    listChange(proxyIndex);
}

template <class Scalar>
void Store<Scalar>::listChange(std::uint32_t proxyIndex) noexcept {
    Record& record = proxies.records[proxyIndex];
    if (!proxies.isWaiting(record)) {
        record.listedIn = proxies.listNumber;
        proxies.waiting.push_back(proxyIndex);
    }
}

// What has slack wakes only where it leaves it.
template <class Scalar>
void Store<Scalar>::moveAny(std::uint32_t proxyIndex, Box box) {  // NOLINT(*-value-param)
    beforeChange();  // by which it may have lost its slack
    Record& record = proxies.records[proxyIndex];
    if (record.residency == Residency::resting && !movesInPlace(record, box)) {
        noteLeft(proxyIndex);
        wake(proxyIndex);
    }
    proxies.settledChanged += record.hasSlack ? 1 : 0;
    countChange(record);
    listChange(proxyIndex);
    setBox(record, box);
}

template <class Scalar>
void Store<Scalar>::wake(std::uint32_t proxyIndex) noexcept {
    Record& record = proxies.records[proxyIndex];
    loseSlack(proxyIndex);
    tables.resting.erase(record.listedAt);
    ++tables.restingErased;
    record.residency = Residency::mobile;
    proxies.listMobile(proxyIndex);
    proxies.woken.push_back(proxyIndex);
}

// Then the record has its box before, as those of others.
template <class Scalar>
void Store<Scalar>::loseSlack(std::uint32_t proxyIndex) noexcept {
    Record& record = proxies.records[proxyIndex];
    if (record.hasSlack) {
        record.before = before(proxyIndex);
        record.hasSlack = false;
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
            "A proxy has a box with a NaN coordinate. No pair and no query finds it until it gets "
            "a box without NaN. Grid::nanCount() counts such proxies; later ones are not "
            "reported.");
    }
}

template <class Scalar>
void Store<Scalar>::beginSweep(std::uint32_t proxyIndex) noexcept {
    markChanged(proxyIndex);
    proxies.records[proxyIndex].residency = Residency::sweeping;
    proxies.sweeping.push_back(proxyIndex);
}

template <class Scalar>
void Store<Scalar>::endSweep(std::uint32_t proxyIndex) noexcept {
    markChanged(proxyIndex);
    Record& record = proxies.records[proxyIndex];
    record.residency =
        record.residency == Residency::sweeping ? Residency::mobile : record.residency;
}

// Without pairs nothing does.
template <class Scalar>
void Store<Scalar>::endSweeps() noexcept {
    for (const std::uint32_t proxyIndex : proxies.sweeping) {
        if (proxies.records[proxyIndex].residency == Residency::sweeping) {
            endSweep(proxyIndex);
        }
    }
}

template <class Scalar>
std::size_t Store<Scalar>::listFew(std::vector<std::uint32_t>& few) const {
    few.clear();
    mendTables();  // or a query would, while the lists are read
    if (!isSparse()) {
        return proxies.records.size();
    }
    forEachListed([&](std::uint32_t proxyIndex) {
        if (proxies.isAlive(proxyIndex)) {
            few.push_back(proxyIndex);
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
    for (const Filing& filing : reading.filings()) {
        const FiledTable<Scalar>& table = *filing.table;
        const auto boxOf = [&](std::uint32_t entry) {
            return filing.isResting ? filedBox(entry) : table.box(entry);
        };
        if (std::string error = table.validate(boxOf); !error.empty()) {
            return error;
        }
        if (std::string error = table.validateTree(); !error.empty()) {
            return error;
        }
        for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
            const std::uint32_t proxyIndex = table.proxyIndex(entry);
            if (hasNan(table.box(entry)) || !standsIn(filing, proxyIndex, reading)) {
                continue;
            }
            ++timesFound[proxyIndex];
            if (!isSameBits(table.box(entry), proxies.records[proxyIndex].box)) {
                return "A filed proxy's entry has the proxy's box: broken.";
            }
        }
    }
    for (std::size_t i = 0; i < proxies.waiting.size() && !reading.isFresh; ++i) {
        timesFound[proxies.waiting[i]] += proxies.isAlive(proxies.waiting[i]) ? 1 : 0;
    }
    std::size_t alive = 0;
    for (std::uint32_t proxyIndex = 0; proxyIndex < proxies.records.size(); ++proxyIndex) {
        const Record& record = proxies.records[proxyIndex];
        const bool isAlive = proxies.isAlive(proxyIndex);
        const bool isNan = record.isNan && (reading.isFresh || !proxies.isWaiting(record));
        alive += isAlive ? 1 : 0;
        if (timesFound[proxyIndex] != (isAlive && !isNan ? 1U : 0U)) {
            return "Every proxy alive is filed in exactly one table, or waits in the list of "
                   "changes, or is NaN: broken.";
        }
    }
    return alive == proxies.size ? std::string() : "size() is the number of proxies alive: broken.";
}

template struct HASHPHASE_INSTANCE_EXPORT Store<float>;
template struct HASHPHASE_INSTANCE_EXPORT Store<double>;

}  // namespace hashphase::detail
