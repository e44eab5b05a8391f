// SPDX-License-Identifier: Zlib
#pragma once

// The grid: knows every proxy's box, files it in a spatial hash, and answers where things are.
//
// A frame    move() whatever moved (or everything: an unchanged box costs a comparison), then
//            update() once, or Pairs::update(), which does it for you.
// Reads      Every change is visible to queries at once, with no call in between. Changes are kept in
//            a list that queries read beside the tables. When that has cost a third of what filing does,
//            a query files everything anew: changes and queries in turn cost about the least there is.
//            Grids that are never updated, as in editors and servers, hold no more than there is, and at
//            the last update was.
// Threads    Queries are const and may run on any number of threads at the same time, and from
//            within a collector. Everything else needs the grid for itself.
// Units      metres, or any other unit of length used throughout.
// Bad data   A box with a NaN is kept, found by nothing, counted by nanCount(), and reported once
//            through the message handler. Infinite, huge and inverted boxes are answered exactly as
//            overlaps() says.
// Denormals  Boxes are compared as the thread's processor compares numbers: one that takes denormal
//            numbers (nearer to 0 than 1.2e-38, or 2.2e-308) for 0 finds that more of these touch.
//            All threads must agree on that where coordinates are denormal; elsewhere they need not,
//            and the answers are the same.
// Limits     2^28 proxies; who adds more is thrown std::length_error.
// Callbacks  A collector may ask the grid, and change it, in a query of its own: what it removes is
//            not offered any more; what it moves or adds may be offered again, as it is then, or not.
//            After a change, no other thread asks until the query is over.
//            Not so where many are dealt with at once, in visitEach(), in the queries of convex
//            volumes, and in a PairFilter; update() and shiftOrigin() run within none of them.
//            Asserted.
// Memory     Where it runs out, std::bad_alloc comes from add(), reserve(), shiftOrigin(), update() and
//            queries that file or grow; nothing is lost, and the call may be repeated. move() and
//            remove() allocate nothing. Who asks much between changes and updates has a second table of
//            what moves.
// Misuse     An id that is null or stale is asserted, and does nothing; its box is NaN. So is one of
//            another grid, unless this grid has a proxy of the same index and generation, for which it
//            is taken.

#include <broadphase/aabb.hpp>
#include <broadphase/collectors.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/group_kinds.hpp>
#include <broadphase/core/peak_watch.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/export.hpp>
#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/grid_config.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/proxy_groups.hpp>
#include <broadphase/proxy_id.hpp>
#include <broadphase/query_cost.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/tree/box_tree.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace hashphase {

template <class Scalar>
class Pairs;
template <class Scalar>
class Neighbours;
template <class Scalar>
class Crowd;
template <class Scalar>
class Sweeps;
namespace detail {
template <class Scalar>
class ContactSearch;
}

/// Cells lowest to highest, inclusive, in units of Grid::cellSize().
struct CellRange {
    std::array<std::int64_t, 3> lowest{};
    std::array<std::int64_t, 3> highest{};

    friend bool operator==(const CellRange&, const CellRange&) = default;
};

namespace detail {
/// Cells are numbered as far as this on either side.
inline constexpr std::int64_t kLastCell = 9'000'000'000'000'000'000;
}  // namespace detail

/// What update() did: how many proxies it touched, and how many it left alone.
struct UpdateCost {
    std::uint32_t changed = 0;  ///< added, moved or removed since the last update
    std::uint64_t filed = 0;    ///< written into a table
    std::uint32_t resting = 0;  ///< in the table that was left alone
    /// The most proxies that share a cell. Where it is a large part of all, they lie on top of each
    /// other, or GridConfig::cellSize is much too large for them: they are sorted along an axis, which
    /// keeps answers exact and takes longer.
    std::uint32_t largestCell = 0;
};

/// Knows every proxy's box, and answers where things are. Scalar is float or double.
template <class Scalar>
class HASHPHASE_BROADPHASE_EXPORT Grid {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with configError(config) when the configuration is bad.
    explicit Grid(const GridConfig& config = {});
    /// The Pairs of the grid, if there are any, are destroyed before it (asserted).
    ~Grid();
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    // --- Proxies ---------------------------------------------------------------------------------

    /// Adds a proxy. The hint saves work for what will not move; for `groups` see setGroups(). Throws
    /// std::length_error, and adds nothing, when there are 2^28 already. Cost: O(1) amortised.
    [[nodiscard]] ProxyId add(const Box& box, Mobility mobility = Mobility::mobile,
                              const ProxyGroups& groups = {});

    /// Makes room for `count` proxies altogether, so that adding many neither moves anything on the
    /// way nor fails for want of memory, until releaseUnusedMemory() gives it back. Throws
    /// std::length_error for more than 2^28. Cost: O(count) where there is not room already.
    void reserve(std::size_t count);

    /// Sets the proxy's box. Bit-equal to the present one: a comparison, and nothing is marked.
    /// Cost: O(1) amortised.
    void move(ProxyId id, const Box& box);

    /// Says with whom the proxy may pair, for Pairs; queries find it as before. Pairs neither tests nor
    /// remembers two that may not, and does not ask its filter about them: where hundreds share a cell,
    /// too, the cost follows those that may. Groups count from the next Pairs::update() on, for which
    /// the proxy counts as changed: what may pair by then begins to, and a pair that stands stays one
    /// until its boxes part, or until Pairs::refilter(). Where memory runs out, nothing has changed.
    /// Cost: O(1); the first call for other groups than ProxyGroups{}, O(proxies).
    void setGroups(ProxyId id, const ProxyGroups& groups);

    /// As last set.
    [[nodiscard]] ProxyGroups groups(ProxyId id) const;

    /// Removes the proxy; its id is never valid again. Cost: O(1).
    void remove(ProxyId id);

    /// Removes every proxy and forgets all that came before: what is done next has the same results,
    /// in the same order and at the same cost, as with a new grid, indices of ids included. Ids of
    /// before stay invalid. Frees what is held but for 64 bytes an index (128 of doubles). Not for a
    /// grid with Pairs, whose clear() does it, nor within a query: asserted, and does nothing.
    /// Cost: O(indexLimit()).
    void clear();

    /// Moves the origin of all coordinates to `shift` [m]: subtracts it from every box. What could be
    /// subtracted without rounding, or is so large that the shift is lost in it, stays as it was: at
    /// rest, or not, and in its pairs. The others count as moved, by what they were rounded; such
    /// boxes may come to touch, but none that overlap can part. (A shift by multiples of a power of two
    /// rounds least: a kilometre, say, or 1024 m, towards where things are.) Queries see it at once.
    /// Returns how many boxes were rounded. A shift that is not finite is asserted, and does nothing.
    /// Sweeps over this grid are shifted with it. Everything else that has coordinates of its own is for
    /// the caller to shift: regions, zones, terrains. Where it throws, for want of memory, nothing has
    /// changed.
    /// Cost: up to three passes over all boxes; when cells had to change, an update(), or the next one's.
    std::size_t shiftOrigin(const Point& shift);

    [[nodiscard]] bool contains(ProxyId id) const noexcept;

    /// The box last set, exactly.
    [[nodiscard]] const Box& box(ProxyId id) const;

    /// Number of proxies alive, those with a NaN box included.
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

    /// ProxyId::index of every proxy, present and past, is below it: the length of an array by index. Falls
    /// only where memory is given back, as far as there are no proxies: see releaseUnusedMemory().
    [[nodiscard]] std::uint32_t indexLimit() const noexcept {
        return static_cast<std::uint32_t>(records_.size());
    }

    /// The proxy alive that has this index; null when there is none. From what is kept by index, as
    /// CollectBits does, back to who is meant. Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept {
        return index < indexLimit() && isAlive(index) ? idOf(index) : ProxyId{};
    }

    /// Which proxies there are, as a number: another one after each add(), remove(), clear() and shift of the
    /// origin, and never that of another grid. For who keeps what a query has found.
    [[nodiscard]] std::uint64_t populationNumber() const noexcept { return populationNumber_; }

    /// Number of proxies whose box has a NaN now.
    [[nodiscard]] std::size_t nanCount() const noexcept { return nanCount_; }

    /// Calls visit(ProxyId, const Box&) for every proxy alive, in the order of their indices; it may
    /// change the grid. Cost: O(proxies); after a peak of eight times as many, O(n log n) and a list.
    template <class Visit>
    void forEach(Visit&& visit) const;

    // --- Queries ---------------------------------------------------------------------------------

    /// The one query: offers to `collector` every proxy whose box has a key in `region`, each once.
    /// See regions.hpp and collectors.hpp. Cost: the cells that the region touches, returned as
    /// data. However large or long the region, about one test for each proxy at most, up to 16 where
    /// so many rows of cells share a bucket, and one more for each that has changed since it was
    /// filed; none, but for these, for a region that is empty by a NaN (one for each, if the NaN is in
    /// a ray's fatness). Of hundreds that share a cell, only the long ones and what is near along
    /// an axis, where the region has bounds().
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// visit() for many: collectors[i] takes what regions[i] finds, in any order; there are as many
    /// of both (asserted). The collectors must not share anything when `parallelFor` is parallel.
    /// Returns the sum of the costs, each within the bounds of visit(). Faster than one by one where
    /// regions have bounds(), unless the collectors stop early.
    template <class Region, class Collector>
    QueryCost visitEach(std::span<const Region> regions, std::span<Collector> collectors,
                        ParallelFor parallelFor = serialFor) const;

    /// The edge of the cells of cellAt(), cellsOf() and visitCell() [m]: the fixed cell size, or the
    /// finest of the automatic ones at the last update; 1 while the grid is empty.
    [[nodiscard]] Scalar cellSize() const noexcept { return cellSize_; }

    /// Files what has changed, if `count` queries would otherwise read more of the list of changes than
    /// filing costs. visitEach() does it; for who makes many single queries on several threads, and wants
    /// all of them to cost the same in every run. Cost: O(1), or that of an update().
    void expectQueries(std::size_t count) const;

    /// Cell query: who is in the cell? Offers every proxy p with `cell` in cellsOf(p) to the
    /// collector. Cost: O(1) buckets; at most that of visit().
    template <class Collector>
    QueryCost visitCell(const std::array<std::int64_t, 3>& cell, Collector& collector) const;

    /// The cell of a point: floor(point / cellSize()), at most 9e18 from 0, beyond which all is in the
    /// last cell. The point must be finite (asserted).
    [[nodiscard]] std::array<std::int64_t, 3> cellAt(const Point& point) const;

    /// Object query: which cells does the proxy's box touch? Its box must be finite (asserted).
    /// Cost: O(1).
    [[nodiscard]] CellRange cellsOf(ProxyId id) const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Ends a frame: files what changed, and puts to rest what has not changed for a while.
    /// Cost: a rebuild of the mobile proxies when one of them changed, nothing otherwise; at worst
    /// O(n log n), which is that of sorting crowds. Not for a grid with Pairs, whose update() does it, nor
    /// within a query: asserted, and does nothing. The result does not depend on `parallelFor`.
    UpdateCost update(ParallelFor parallelFor = serialFor);

    /// How often the mobile proxies have been filed: once by each update that found a change, and
    /// between updates by queries, where those have read much of what has changed.
    [[nodiscard]] std::uint64_t filingCount() const noexcept { return filingCount_; }

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Those of them that only rays read; 0 before the first one.
    [[nodiscard]] std::size_t rayMemoryBytes() const noexcept;

    /// Frees these; the next ray makes them anew.
    void releaseRayMemory() noexcept;

    /// Gives back what is not used: room for more proxies than there are, or than were reserved, and what
    /// only the next update, shift or query would use, which takes it again. Indices at the end without a
    /// proxy go, too: indexLimit() falls, and their old ids stay invalid; from then on new proxies take
    /// the lowest free index first. A proxy with a high index keeps a record (64 bytes, or 128 in double
    /// precision) for each index below. An update does it by itself when there has been room for more than
    /// eight times as many, or eight times those reserved, in 256 updates in a row. Not within a query
    /// (asserted). Cost: O(indexLimit()), and moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every proxy alive is filed in exactly one table, or waits in the list of changes, or is NaN.
    /// - A filed proxy's entry has the proxy's box.
    /// - The tables' own invariants (hash/table.hpp), and those of their trees (tree/box_tree.hpp).
    [[nodiscard]] std::string validate() const;

private:
    friend class Pairs<Scalar>;
    friend class Neighbours<Scalar>;
    friend class Crowd<Scalar>;
    friend class Sweeps<Scalar>;
    friend class detail::ContactSearch<Scalar>;

    static constexpr std::uint32_t kNoSlot = ~std::uint32_t{0};

    enum class Place : std::uint8_t {
        nowhere,   // no proxy
        mobile,    // listed in mobileSlots_, and filed in mobile_ unless it waits or is NaN
        resting,   // filed in resting_
        sweeping,  // as mobile, but filed in sweeping_: its way, and not its box, makes its pairs
    };

    /// All about a slot, in one cache line for single precision and two for double.
    struct alignas(16 * sizeof(Scalar)) Record {
        Box box = nanBox();            // NaN while the slot has no proxy
        Box before = nanBox();         // standingBox() at the last update, if it has changed since
        std::uint32_t generation = 0;  // odd while the slot has a proxy
        std::uint32_t changedAt = 0;  // number of the update that will see, or saw, the last change
        std::uint32_t listedAt = 0;   // where in resting_; in mobileSlots_, if it has joined these
                                      // since the last update; or the next slot without a proxy
        Place place = Place::nowhere;
        std::uint8_t listedIn = 0;  // number of the list of changes that has it
        std::uint8_t kind = 0;      // of its groups, in groupKinds_
        // Mobility::resting, or rested, and has not moved since but by a shift of the origin
        bool restsAtOnce : 1 = false;
        bool isNan : 1 = false;        // has a NaN; of a proxy alive
        bool isAnnounced : 1 = false;  // Pairs told of a couple of the slot's since the last update
    };

    /// Slots without a proxy, one after the other by Record::listedAt.
    struct SlotList {
        std::uint32_t first = kNoSlot;
        std::uint32_t last = kNoSlot;
        std::uint32_t count = 0;
    };

    /// What rays read of a table; made by the first ray after the table was built.
    struct TableTree {
        detail::BoxTree tree;
        std::atomic<bool> isStale{false};
    };
    /// A table that few grids need, made when the first thing is filed in it.
    struct LateTable {
        detail::Table<Scalar> table;
        TableTree tree;
    };
    /// Calls visit(table, tree) for all of `grid` that are there, in use or not.
    template <class Self, class Visit>
    static void forTables(Self& grid, const Visit& visit) {
        visit(grid.mobile_, grid.mobileTree_);
        visit(grid.resting_, grid.restingTree_);
        for (auto* late : {grid.sweeping_.get(), grid.fresh_.get()}) {
            if (late != nullptr) {
                visit(late->table, late->tree);
            }
        }
    }
    /// A table that queries read.
    struct Filing {
        const detail::Table<Scalar>* table;
        const TableTree* tree;
        bool isResting;
    };
    /// All that a query reads: the tables of what stands, then that of what sweeps, if there is one.
    struct Reading {
        std::array<Filing, 3> all;
        // Filed since the last change, so that nothing waits, what sweeps with the rest.
        bool isFresh;

        // Not of a Reading that ends with the expression.
        std::span<const Filing> filings() const&& = delete;
        std::span<const Filing> standing() const&& = delete;
        [[nodiscard]] std::span<const Filing> filings() const& noexcept {
            return std::span(all).first(isFresh || all[2].table == nullptr ? 2 : 3);
        }
        [[nodiscard]] std::span<const Filing> standing() const& noexcept {
            return std::span(all).first(2);
        }
    };

    template <class Region, class Collector>
    struct VisitReader;
    struct CellRegion;

    /// The proxy in the slot, or the last one that was.
    [[nodiscard]] ProxyId idOf(std::uint32_t slot) const noexcept {
        return {slot, (records_[slot].generation - 1) | 1};
    }
    [[nodiscard]] bool isAlive(std::uint32_t slot) const noexcept {
        return (records_[slot].generation & 1) != 0;
    }
    [[nodiscard]] static Box nanBox() {
        const Point nan = Point::Constant(std::numeric_limits<Scalar>::quiet_NaN());
        return {nan, nan};
    }

    [[nodiscard]] bool isWaiting(const Record& record) const noexcept {
        return record.listedIn == listNumber_;
    }
    /// Whether a slot that is listed in a table is still filed there.
    [[nodiscard]] bool isFiled(std::uint32_t slot, const Reading& reading) const noexcept {
        const Record& record = records_[slot];
        return record.place != Place::nowhere && (reading.isFresh || !isWaiting(record));
    }
    [[nodiscard]] bool standsIn(const Filing& filing, std::uint32_t slot,
                                const Reading& reading) const noexcept {
        const bool rests = records_[slot].place == Place::resting;
        return rests == filing.isResting && isFiled(slot, reading);
    }
    [[nodiscard]] bool changedNow(std::uint32_t slot) const noexcept {
        return records_[slot].changedAt == updateNumber_;
    }

    /// The box by which a slot makes pairs: NaN of what sweeps, which makes them on its way.
    [[nodiscard]] const Box& standingBox(const Record& record) const noexcept {
        return record.place == Place::sweeping ? nowhere_ : record.box;
    }
    /// The same at the last update, in present coordinates; NaN when it had no proxy.
    [[nodiscard]] const Box& before(std::uint32_t slot) const noexcept {
        return changedNow(slot) ? records_[slot].before : standingBox(records_[slot]);
    }
    /// The same in coordinates in which such boxes may be compared with each other.
    [[nodiscard]] const Box& boxAtUpdate(std::uint32_t slot) const noexcept {
        if (boxesAtUpdate_.empty()) {
            return before(slot);
        }
        const std::size_t place = slotsAtUpdate_.size() == 0 ? slot : slotsAtUpdate_.find(slot);
        return place < boxesAtUpdate_.size() ? boxesAtUpdate_[place] : before(slot);
    }
    [[nodiscard]] bool overlappedAtUpdate(std::uint32_t a, std::uint32_t b) const noexcept {
        return overlaps(boxAtUpdate(a), boxAtUpdate(b));
    }
    [[nodiscard]] bool isQuiet(const Record& record) const noexcept {
        return record.changedAt != updateNumber_ && !record.isNan &&
               (record.restsAtOnce || updateNumber_ - record.changedAt > config_.updatesBeforeRest);
    }

    [[nodiscard]] ProxyGroups groupsNow(std::uint32_t slot) const noexcept {
        return groups_.empty() ? ProxyGroups{} : groups_[2 * std::size_t{slot}];
    }
    [[nodiscard]] bool mayPairNow(std::uint32_t a, std::uint32_t b) const noexcept {
        return groups_.empty() || mayPair(groupsNow(a), groupsNow(b));
    }
    /// At the last update.
    [[nodiscard]] bool couldPair(std::uint32_t a, std::uint32_t b) const noexcept {
        const auto groupsAtUpdate = [this](std::uint32_t slot) {
            return groups_[2 * std::size_t{slot} + 1];
        };
        return groups_.empty() || mayPair(groupsAtUpdate(a), groupsAtUpdate(b));
    }
    /// For searches among all proxies: null where all may pair.
    [[nodiscard]] const ProxyGroups* groupsOfAll() const noexcept {
        return groupKinds_.someRefuse() ? groups_.data() : nullptr;
    }
    /// The same as of the last update.
    [[nodiscard]] const ProxyGroups* groupsOfAllAtUpdate() const noexcept {
        const ProxyGroups* const now = groupsOfAll();
        return now != nullptr ? now + 1 : nullptr;
    }
    void makeGroups();
    void noteGroups(std::uint32_t slot, const ProxyGroups& groups) noexcept;
    [[nodiscard]] detail::GroupKinds::Set kindOf(std::uint32_t slot) const noexcept {
        return detail::GroupKinds::bit(records_[slot].kind);
    }

    /// How many slots are listed, in mobileSlots_ or in the table of those at rest.
    [[nodiscard]] std::size_t listedCount() const noexcept {
        return mobileSlots_.size() + (resting_.size() - restingErased_);
    }
    /// Whether so few slots have proxies that their lists are read sooner than all slots.
    [[nodiscard]] bool isSparse() const noexcept { return 8 * listedCount() < records_.size(); }
    /// Calls visit(slot) once for each slot that has a proxy or had one at the last update, and perhaps for
    /// others; in any order. visit() may wake proxies, and not add any.
    template <class Visit>
    void forEachListed(const Visit& visit) const;
    /// Where proxies are few among the slots, lists their slots in ascending order; else none. Returns how
    /// many slots are to be looked at: those listed, or all.
    std::size_t listFew(std::vector<std::uint32_t>& few) const;

    /// None where cell sizes follow the population.
    [[nodiscard]] detail::LevelSizes fixedSizes() const {
        return config_.cellSize > 0 ? detail::fixedLevels(config_.cellSize, config_.levelRatio)
                                    : detail::LevelSizes{};
    }
    void reserveSlots(std::size_t slotCount);
    void listMobile(std::uint32_t slot) noexcept;
    void unlistMobile(std::uint32_t slot) noexcept;
    /// Whether the slot's proxy, which is marked as changed, was added since the last update.
    [[nodiscard]] bool isUnseen(std::uint32_t slot) const noexcept;
    void append(std::uint32_t slot, SlotList& list) noexcept;
    void giveBack(SlotList& list) noexcept;
    void reserveLists(std::size_t count);
    void releaseAfterPeak() noexcept;
    void releaseMemory() noexcept;
    void dropLastSlots();

    // None of these allocates: reserveLists() has made room for all of it.
    void noteChange(std::uint32_t slot) noexcept;
    void countChange(Record& record) noexcept;
    void leaveRest(std::uint32_t slot) noexcept;
    void beginSweep(std::uint32_t slot) noexcept;
    void endSweep(std::uint32_t slot) noexcept;
    void endSweeps() noexcept;
    void setBox(Record& record, const Box& box);
    void noteNan(Record& record, bool isNan);

    void keepBoxesAtUpdate(const Point& shift);
    bool shiftRecord(std::uint32_t slot, const Point& shift) noexcept;
    void shiftTables(const Point& shift);

    // The passes of an update. Between them, Pairs finds what was born and what died.
    void stage(ParallelFor parallelFor, bool isForQueries = false);
    [[nodiscard]] bool putQuietToRest(ParallelFor parallelFor);
    void listResting();
    void fileResting(ParallelFor parallelFor);
    void fileMobile(ParallelFor parallelFor);
    void fileSweeping(ParallelFor parallelFor);
    void clearSweeping() noexcept;
    void settle() noexcept;
    UpdateCost endUpdate() noexcept;
    void countUpdatesAnew() noexcept;

    // What is left where memory ran out, and Pairs can go on from: everything is mobile.
    void wakeAll() noexcept;
    // What Pairs begin with: as if all had been added since the last update.
    void forgetLastUpdate() noexcept;

    /// How queries begin. The tables may be read from then on.
    [[nodiscard]] Reading beginReading() const;
    [[nodiscard]] Reading beginReadingInOrder() const;
    [[nodiscard]] Reading presentReading() const noexcept;
    [[nodiscard]] std::uint64_t worthFiling() const noexcept;
    void mendTables() const;
    enum class Lock : std::uint8_t { tryOnce, waitFor };
    void fileFresh(Lock how) const;
    void beforeChange() noexcept {
        if (isFresh_.load(std::memory_order_relaxed)) {
            takeFresh();
        }
    }
    void takeFresh() noexcept;
    void forgetErased() noexcept;
    void dropList() noexcept;

    template <class Visit>
    void forEachFiled(Visit&& visit) const;
    void growTrees(const Reading& reading) const;
    [[nodiscard]] bool treesAreStale(const Reading& reading) const noexcept {
        return std::ranges::any_of(reading.filings(), [](const Filing& filing) {
            return filing.tree->isStale.load(std::memory_order_acquire);
        });
    }
    template <class Region, class Collector>
    QueryCost visitTogether(const Reading& reading, std::span<const Region> regions,
                            std::span<Collector> collectors, bool mayChange) const;
    template <class Region, class Collector>
    bool visitTables(const Reading& reading, std::span<const Filing> filings, const Region& region,
                     Collector& collector, QueryCost& cost) const;

    GridConfig config_;

    std::vector<Record> records_;
    std::uint32_t firstGeneration_ = 0;  // of new slots; even
    SlotList free_;
    // Those whose proxies were removed since the tables were last settled: the next update has to tell
    // these from the next ones. What came and went in between is free at once, unless Pairs told of it.
    SlotList removed_;
    SlotList removedAnnounced_;
    std::size_t size_ = 0;
    std::size_t nanCount_ = 0;
    std::size_t reservedCount_ = 0;  // of proxies, by reserve()
    std::uint64_t populationNumber_;
    detail::PeakWatch peaks_;
    bool nanReported_ = false;
    bool hasPairs_ = false;
    bool isTorn_ = false;        // by wakeAll(): what Pairs watches is to be found anew
    bool areRegrouped_ = false;  // groups of some, since the last update

    // Of each slot now, and at the last update: 2 * slot, and one behind. Empty until somebody has others
    // than ProxyGroups{}; as long as records_ then.
    std::vector<ProxyGroups> groups_;
    // The same as numbers, and which of them there are among those that are mobile, that have changed,
    // and that rest; and perhaps more.
    detail::GroupKinds groupKinds_;
    std::atomic<detail::GroupKinds::Set> mobileKinds_{0};
    std::atomic<detail::GroupKinds::Set> changedKinds_{0};
    detail::GroupKinds::Set restingKinds_ = 0;

    std::uint32_t updateNumber_ = 1;             // of the update that ends the present frame
    std::uint32_t restingErased_ = 0;            // entries of resting_
    UpdateCost cost_;                            // of the present frame
    std::atomic<std::uint64_t> filingCount_{0};  // a query may file while others ask
    std::uint64_t shiftCount_ = 0;               // of the origin

    // What changed since mobile_ was built, and how much of that queries have read since.
    std::vector<std::uint32_t> waiting_;
    mutable std::atomic<std::uint64_t> waitingRead_{0};
    std::uint8_t listNumber_ = 1;
    // mobile_ cannot be read: a shift of the origin, or want of memory, has left it as it is.
    std::atomic<bool> isTableTorn_{false};
    std::mutex filing_;

    // In the table's order as of the last update, then what has joined since. What has left since
    // is still listed, with a NaN box, unless it had joined since. What a change appends to, this, woken_
    // and waiting_, has room for all that are listed here or rest.
    std::vector<std::uint32_t> mobileSlots_;
    std::size_t listedAtUpdate_ = 0;  // how many there were at the last update
    detail::Table<Scalar> mobile_;

    std::vector<std::uint32_t> woken_;  // slots that have left resting_ since the last update
    detail::Table<Scalar> resting_;

    std::vector<std::uint32_t> sweepingSlots_;  // when the last update began; in mobileSlots_, too
    std::vector<detail::PaddedBox<Scalar>> sweepingBoxes_;  // scratch of fileSweeping()
    std::unique_ptr<LateTable> sweeping_;

    TableTree mobileTree_;
    TableTree restingTree_;

    // What a query has filed while others went on with mobile_ and waiting_. The next change makes it
    // mobile_, or drops it where it is made within a query, which may be reading either.
    std::unique_ptr<LateTable> fresh_;
    std::atomic<bool> isFresh_{false};

    // Boxes by their place in mobileSlots_: as they are now, and as of the last update.
    std::vector<detail::PaddedBox<Scalar>> staged_;
    std::vector<detail::PaddedBox<Scalar>> stagedBefore_;
    std::atomic<std::uint32_t> quietCount_{0};

    // When a shift of the origin has rounded boxes since the last update: the boxes of that update in the
    // coordinates of then. By slot, or where proxies are few among the slots by place in slotsAtUpdate_.
    // Those that are missing had no proxy.
    std::vector<Box> boxesAtUpdate_;
    detail::FlatSet slotsAtUpdate_;

    std::vector<std::uint32_t> restSlots_;  // scratch of listResting()
    std::vector<detail::PaddedBox<Scalar>> restBoxes_;
    std::vector<std::uint32_t> nanSlots_;  // scratch of settle()

    Sweeps<Scalar>* firstSweeps_ = nullptr;
    Scalar cellSize_ = 1;
    const Box nowhere_ = nanBox();
};

extern template class Grid<float>;
extern template class Grid<double>;

}  // namespace hashphase

#include <broadphase/search/grid_visit.hpp>
