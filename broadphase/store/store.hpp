// SPDX-License-Identifier: Zlib
#pragma once

// What a grid is made of: all proxies, where they are filed, and the frame under way. Plain data: the
// frame (step.hpp), queries, sweeps and pairs read it in place.

#include <broadphase/core/peak_watch.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/grid_config.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/query_cost.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/store/frame.hpp>
#include <broadphase/store/move_scratch.hpp>
#include <broadphase/store/population.hpp>
#include <broadphase/store/settling.hpp>
#include <broadphase/store/tables.hpp>
#include <broadphase/update_cost.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

template <class Scalar>
struct HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Motions;

template <class Scalar>
struct HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Store {
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;
    using Record = detail::Record<Scalar>;
    using Filing = detail::Filing<Scalar>;
    using Reading = detail::Reading<Scalar>;

    GridConfig config;
    Population<Scalar> proxies;
    Tables<Scalar> tables;
    Frame<Scalar> frame;
    std::unique_ptr<Settling<Scalar>> settling;
    std::unique_ptr<MoveScratch> moveScratch;  // made by the first batch of moves on threads
    UpdateCost cost;                           // of the present frame
    std::uint64_t shiftCount = 0;              // of the origin
    Motions<Scalar>* firstMotions = nullptr;
    PeakWatch peaks;
    PeakWatch mobilePeaks;  // of those that have come to rest
    bool hasPairs = false;
    bool maySettleWithSlack = true;
    std::uint8_t observedEach = kOftenObserved;  // update, as a binary logarithm
    bool mustRebuildPairs = false;  // by wakeAll(): what pairs watch is to be found anew

    explicit Store(const GridConfig& itsConfig);

    // --- Changes. None allocates but add() and reserve(), which make room for all of it. ---------

    [[nodiscard]] std::uint32_t add(const Box& box, bool restsAtOnce, const ProxyGroups& groups);
    [[nodiscard]] std::uint32_t takeIndex();
    void reserve(std::size_t count);
    /// As reserve(), but does not keep the room after a peak.
    void makeRoom(std::size_t count);
    // Inline, as calls would cost what they do.
    [[HASHPHASE_ALWAYS_INLINE]] void move(std::uint32_t proxyIndex, const Box& box) {
        if (!moveIfInPlace(proxyIndex, box)) {
            moveAny(proxyIndex, box);
        }
    }
    /// Returns false, and has done nothing, where moveAny() has to do it.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] bool moveIfInPlace(std::uint32_t proxyIndex,
                                                              const Box& box) {
        Record& record = proxies.records[proxyIndex];
        if (isSameBits(record.box, box)) {
            return true;
        }
        if (!movesInPlace(record, box) || tables.isFresh.load(std::memory_order_relaxed)) {
            return false;
        }
        moveInPlace(record, box, cost.changed, proxies.settledChanged,
                    [&]() noexcept { proxies.waiting.push_back(proxyIndex); });
        return true;
    }
    // By value, lest that of move() had to be in memory for it.
    void moveAny(std::uint32_t proxyIndex, Box box);
    /// Whether a move writes the record, two counts and the list of changes, and nothing else.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] static bool movesInPlace(const Record& record,
                                                                    const Box& box) noexcept {
        return record.hasSlack
                   ? staysWithin(box, record.before)
                   : record.residency == Residency::mobile && !record.isNan && !hasNan(box);
    }
    /// Whether the box is not inverted, and within the one by which it is filed.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] static bool staysWithin(const Box& box,
                                                                   const Box& filed) noexcept {
        if (HASHPHASE_OVERLOOKS_NAN && hasNan(box)) {
            return false;
        }
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            if (!(filed.min()[axis] <= box.min()[axis] && box.min()[axis] <= box.max()[axis] &&
                  box.max()[axis] <= filed.max()[axis])) {
                return false;
            }
        }
        return true;
    }
    /// Such a move. Counts, and calls list() where the proxy is to be listed.
    template <class ListChange>
    [[HASHPHASE_ALWAYS_INLINE]] void moveInPlace(Record& record, const Box& box,
                                                 std::uint32_t& changed,
                                                 std::uint32_t& settledChanged,
                                                 const ListChange& list) noexcept {
        changed += keepBefore(record) ? 1 : 0;
        settledChanged += record.hasSlack ? 1 : 0;
        if (!proxies.isWaiting(record)) {
            record.listedIn = proxies.listNumber;
            list();
        }
        record.box = box;
        record.restsAtOnce = false;
    }
    [[nodiscard]] MoveScratch& scratchOfMoves() {
        if (moveScratch == nullptr) {
            moveScratch = std::make_unique<MoveScratch>();
        }
        return *moveScratch;
    }
    void remove(std::uint32_t proxyIndex) noexcept;
    void clear();
    void setGroups(std::uint32_t proxyIndex, const ProxyGroups& groups);

    /// To be called before every change of a proxy's box. What rests wakes.
    void markChanged(std::uint32_t proxyIndex) noexcept;
    /// The same where the box is not changed.
    void listChange(std::uint32_t proxyIndex) noexcept;
    void noteLeft(std::uint32_t proxyIndex) noexcept;
    void countChange(Record& record) noexcept { cost.changed += keepBefore(record) ? 1 : 0; }
    /// Where the record has not changed since the last update: keeps what it was then, and returns true.
    [[HASHPHASE_ALWAYS_INLINE]] bool keepBefore(Record& record) noexcept {
        if (record.changedAt == proxies.updateNumber) {
            return false;
        }
        record.changedAt = proxies.updateNumber;
        if (record.hasSlack) {
            return true;  // its table has it
        }
        record.before = record.box;
        if (record.residency == Residency::sweeping) {
            record.before = proxies.nowhere();  // as standingBox(), which copies more slowly
        }
        return true;
    }
    void wake(std::uint32_t proxyIndex) noexcept;
    void loseSlack(std::uint32_t proxyIndex) noexcept;
    /// All that are filed by larger boxes than their own.
    void wakeSettled() noexcept;
    void setBox(Record& record, const Box& box) {
        record.box = box;
        record.restsAtOnce = false;
        const bool isNan = hasNan(box);
        if (isNan || record.isNan) {
            markNan(record, isNan);
        }
    }
    void markNan(Record& record, bool isNan);

    /// It sweeps as of the update that begins here.
    void beginSweep(std::uint32_t proxyIndex) noexcept;
    void endSweep(std::uint32_t proxyIndex) noexcept;
    void endSweeps() noexcept;

    /// See Grid::shiftOrigin().
    std::size_t shiftOrigin(const Point& shift);
    void keepBoxesAtUpdate(const Point& shift);
    bool shiftRecord(std::uint32_t proxyIndex, const Point& shift) noexcept;
    void shiftTables(const Point& shift);

    // --- The last update -------------------------------------------------------------------------

    /// standingBox() at the last update, in present coordinates; NaN when the index had no proxy.
    [[nodiscard]] Box before(std::uint32_t proxyIndex) const noexcept {
        const Record& record = proxies.records[proxyIndex];
        if (record.hasSlack && record.changedAt == proxies.updateNumber && !isRestFiledNow()) {
            return tables.resting.boxBefore(record.listedAt);
        }
        return proxies.standingBefore(record);
    }
    /// Whether the update under way has filed what rests. Until its end, records of those with slack have their
    /// boxes before.
    [[nodiscard]] bool isRestFiledNow() const noexcept {
        return tables.settledAt == proxies.updateNumber;
    }
    /// before() in coordinates in which such boxes may be compared with each other.
    [[nodiscard]] Box boxAtUpdate(std::uint32_t proxyIndex) const noexcept {
        if (proxies.boxesAtUpdate.empty()) {
            return before(proxyIndex);
        }
        const std::size_t place = proxies.indicesAtUpdate.size() == 0
                                      ? proxyIndex
                                      : proxies.indicesAtUpdate.find(proxyIndex);
        return place < proxies.boxesAtUpdate.size() ? proxies.boxesAtUpdate[place]
                                                    : before(proxyIndex);
    }
    [[nodiscard]] bool overlappedAtUpdate(std::uint32_t a, std::uint32_t b) const noexcept {
        return overlaps(boxAtUpdate(a), boxAtUpdate(b));
    }

    // --- The passes of an update, see step.hpp ---------------------------------------------------

    /// Lists which settled ones have moved within their slack, unless they are many.
    void listMovedSettled();
    /// Copies the mobile boxes side by side.
    enum class StageFor : std::uint8_t { update, repair, queries };
    void stage(ParallelFor parallelFor, StageFor what);
    [[nodiscard]] bool observesNow() const noexcept;
    [[nodiscard]] std::uint32_t updatesObserved() const noexcept { return 1U << observedEach; }
    /// Watches how a mobile proxy moves. Returns whether it may settle with slack.
    [[nodiscard]] bool observe(std::uint32_t proxyIndex, Record& record) noexcept {
        if (isCalm(record)) {
            return observeCalm(proxyIndex, record);
        }
        if (record.isCalm) {
            record.isCalm = false;
        }
        return false;
    }
    [[nodiscard]] bool isCalm(const Record& record) const noexcept;
    [[nodiscard]] bool observeCalm(std::uint32_t proxyIndex, Record& record) noexcept;
    [[nodiscard]] bool isWorthSlack() const noexcept;
    void makeTremors();
    [[nodiscard]] bool hasTremor(std::uint32_t proxyIndex) const noexcept;
    /// By which it is to be filed with what rests.
    [[nodiscard]] Box boxToFile(std::uint32_t proxyIndex) const noexcept;
    /// By which the entry of the resting table is filed.
    [[nodiscard]] Box filedBox(std::uint32_t entry) const noexcept;
    [[nodiscard]] bool maySettle(std::uint32_t proxyIndex, const Record& record) const noexcept;
    /// How far it may move at most from where it is filed [m]; 0 for not at all.
    [[nodiscard]] Scalar mostSlack(const Box& box) const noexcept;
    [[nodiscard]] Scalar slackOf(std::uint32_t proxyIndex) const noexcept;
    /// Searches of their table see the settled ones where they are now; and again once it has been filed.
    void refreshSettled(ParallelFor parallelFor);
    void refreshFiled(ParallelFor parallelFor);
    void keepFiledBoxes() noexcept;
    /// Idle proxies leave the mobile ones when enough have gathered, or enough others have left rest, to
    /// be worth filing the resting ones anew. Returns whether any did.
    [[nodiscard]] bool settleIdle(ParallelFor parallelFor);
    void listResting();
    void fileResting(ParallelFor parallelFor);
    /// Tables::mustRefileMobile is set until the caller has done what belongs to it.
    void fileMobile(ParallelFor parallelFor);
    void fileSweeping(ParallelFor parallelFor);
    void clearSweeping() noexcept;
    /// Lists the mobile proxies in the order of their table, for the next time, and forgets those that
    /// have left, whose indices may be given away again.
    void relistMobile() noexcept;
    void endUpdate(UpdateCost& done) noexcept;
    /// What is left where memory ran out, and the next update can go on from: everything is mobile.
    void wakeAll() noexcept;
    /// What pairs begin with: as if all had been added since the last update.
    void forgetLastUpdate() noexcept;
    [[nodiscard]] bool isIdle(const Record& record) const noexcept {
        return record.changedAt != proxies.updateNumber && !record.isNan &&
               (record.restsAtOnce ||
                proxies.updateNumber - record.changedAt > config.updatesBeforeRest);
    }

    /// So many proxies are sooner compared with each other than filed: they stay in the list of changes.
    static constexpr std::size_t kFewProxies = 24;
    /// Nor do these settle with slack, unless by a fixed one.
    [[nodiscard]] bool areFew() const noexcept {
        return listedCount() <= kFewProxies && !config.slack;
    }
    /// Whether they are few, and nothing has changed but where some mobile ones are, of which none is idle.
    [[nodiscard]] bool haveFewMoved() const noexcept;
    /// Whether there are few, and some are in the list of changes.
    [[nodiscard]] bool areFewListed() const noexcept {
        return areFew() && !proxies.waiting.empty();
    }

    /// Whether an update has anything to file.
    [[nodiscard]] bool mustFile() const noexcept {
        return cost.changed > 0 || !proxies.woken.empty();
    }

    // --- What queries read -----------------------------------------------------------------------

    /// How queries begin, here one that reads the list as dearly as `weight` boxes. The tables may be read from
    /// then on.
    [[nodiscard]] Reading beginReading(std::size_t weight = 1) const;
    [[nodiscard]] Reading beginReadingForRay() const;
    /// The same for so many queries, which begin together.
    [[nodiscard]] Reading beginReadings(std::size_t count) const;
    void expectQueries(std::size_t count) const;
    void expectRays(std::size_t count) const;
    std::uint64_t countRead(std::uint64_t count) const noexcept;
    void mendTables() const;
    /// Builds the trees that so many rays, which begin together, are worth.
    void growTrees(const Reading& reading, std::size_t rayCount) const;
    /// searchRay() in the table's tree, or in its cells where it is stale.
    bool searchAlong(const RayRegion<Scalar>& ray, const FiledTable<Scalar>& table, double limit,
                     FunctionRef<double(std::span<const std::uint32_t>)> take,
                     QueryCost& queryCost) const;
    [[nodiscard]] std::uint64_t worthFiling() const noexcept;
    /// Does nothing where another one is about it.
    void fileFresh();
    void beforeChange() noexcept {
        if (tables.isFresh.load(std::memory_order_relaxed)) {
            takeFresh();
        }
    }
    void takeFresh() noexcept;
    void forgetErased() noexcept;
    void dropList() noexcept;

    /// Whether a proxy that is listed in a table is still filed there, with its box as it is.
    [[nodiscard]] bool standsIn(const Filing& filing, std::uint32_t proxyIndex,
                                const Reading& reading) const noexcept {
        const Record& record = proxies.records[proxyIndex];
        return record.residency != Residency::nowhere &&
               (proxies.isWaiting(record)
                    ? reading.isFresh && !filing.isResting
                    : (record.residency == Residency::resting) == filing.isResting);
    }
    /// Whether that is so of all that the tables list and that is not erased.
    [[nodiscard]] bool doAllStand(const Reading& reading) const noexcept {
        return proxies.waiting.empty() || (reading.isFresh && proxies.settledChanged == 0);
    }
    /// Calls visitEntry(filing, entry, proxyIndex) for each entry that stands for a proxy, then
    /// visitWaiting(proxyIndex) for each proxy beside the tables; not for proxies with a NaN.
    template <class VisitEntry, class VisitWaiting>
    void forEachPlace(const Reading& reading, const VisitEntry& visitEntry,
                      const VisitWaiting& visitWaiting) const;
    /// Calls visit(ProxyId, box) for every proxy alive whose box has no NaN, in about the order of space.
    template <class Visit>
    void forEachFiled(const Visit& visit) const;

    // --- All proxies -----------------------------------------------------------------------------

    /// How many proxies are listed, among the mobile ones or in the table of those at rest.
    [[nodiscard]] std::size_t listedCount() const noexcept {
        return proxies.mobile.size() + (tables.resting.size() - tables.restingErased);
    }
    /// Whether so few indices have proxies that the lists are read sooner than all records.
    [[nodiscard]] bool isSparse() const noexcept {
        return 8 * listedCount() < proxies.records.size();
    }
    /// Calls visit(index) once for each index that has a proxy or had one at the last update, and perhaps for
    /// others; in any order. visit() may wake proxies, and not add any.
    template <class Visit>
    void forEachListed(const Visit& visit) const;
    /// Where few indices have proxies, lists these in ascending order; else none. Returns how many indices are
    /// to be looked at: those listed, or all.
    std::size_t listFew(std::vector<std::uint32_t>& few) const;

    /// None where cell sizes follow the population.
    [[nodiscard]] LevelSizes fixedSizes() const {
        return config.cellSize > 0 ? fixedLevels(config.cellSize, config.levelRatio) : LevelSizes{};
    }

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(Store& to, const Store& from, const Visit& visit) {
        visit(to.proxies, from.proxies);
        visit(to.tables, from.tables);
        visit(to.frame, from.frame);
        visit(to.settling, from.settling);
        visit(to.cost, from.cost);
        visit(to.shiftCount, from.shiftCount);
        visit(to.peaks, from.peaks);
        visit(to.mobilePeaks, from.mobilePeaks);
        visit(to.maySettleWithSlack, from.maySettleWithSlack);
        visit(to.observedEach, from.observedEach);
        visit(to.mustRebuildPairs, from.mustRebuildPairs);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept;
    [[nodiscard]] std::size_t rayMemoryBytes() const noexcept;
    void releaseRayMemory() noexcept;
    void releaseAfterPeak() noexcept;
    void releaseMemory() noexcept;
    [[nodiscard]] std::string validate() const;
};

template <class Scalar>
template <class VisitEntry, class VisitWaiting>
void Store<Scalar>::forEachPlace(const Reading& reading, const VisitEntry& visitEntry,
                                 const VisitWaiting& visitWaiting) const {
    for (const Filing& filing : reading.filings()) {
        for (std::uint32_t entry = 0; entry < filing.table->size(); ++entry) {
            const std::uint32_t proxyIndex = filing.table->proxyIndex(entry);
            if (standsIn(filing, proxyIndex, reading) && !hasNan(filing.table->box(entry))) {
                visitEntry(filing, entry, proxyIndex);
            }
        }
    }
    for (std::size_t i = 0; i < proxies.waiting.size() && !reading.isFresh; ++i) {
        const std::uint32_t proxyIndex = proxies.waiting[i];
        if (proxies.isAlive(proxyIndex) && !proxies.records[proxyIndex].isNan) {
            visitWaiting(proxyIndex);
        }
    }
}

template <class Scalar>
template <class Visit>
void Store<Scalar>::forEachFiled(const Visit& visit) const {
    forEachPlace(
        beginReading(),
        [&](const Filing& filing, std::uint32_t entry, std::uint32_t proxyIndex) {
            visit(proxies.idOf(proxyIndex), filing.table->box(entry));
        },
        [&](std::uint32_t proxyIndex) {
            visit(proxies.idOf(proxyIndex), proxies.records[proxyIndex].box);
        });
}

template <class Scalar>
template <class Visit>
void Store<Scalar>::forEachListed(const Visit& visit) const {
    if (!isSparse()) {
        for (std::uint32_t proxyIndex = 0; proxyIndex < proxies.records.size(); ++proxyIndex) {
            visit(proxyIndex);
        }
        return;
    }
    const std::size_t mobileCount = proxies.mobile.size();  // not those that `visit` wakes
    for (std::size_t i = 0; i < mobileCount; ++i) {
        visit(proxies.mobile[i]);
    }
    for (const std::uint32_t proxyIndex : tables.resting.proxyIndices()) {
        if (proxies.rests(proxyIndex)) {
            visit(proxyIndex);
        }
    }
}

extern template struct Store<float>;
extern template struct Store<double>;

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
