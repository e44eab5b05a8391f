// SPDX-License-Identifier: Zlib
#pragma once

// The grid: knows every proxy's box, files it in a spatial hash, and answers where things are.
//
// A frame    move() whatever moved (or everything: an unchanged box costs a comparison), then
//            update() once, or Pairs::update(), which does it for you.
// Reads      Every change is visible to queries at once, without a call in between. Queries read the list of
//            changes beside the tables. When this has cost a third of what filing does, a query files all
//            changes: changes and queries in turn cost about the least possible. Grids that are never
//            updated, as in editors and servers, hold no more than the proxies of now and of the last update.
// Threads    Queries are const and may run on any number of threads at the same time, and from
//            within a collector. Everything else needs the grid for itself.
// Units      metres, or any other unit of length used throughout.
// Bad data   A box with a NaN is kept, found by nothing, counted by nanCount(), and reported once
//            through the message handler. Infinite, huge and inverted boxes are answered exactly as
//            overlaps() says.
// Denormals  Boxes are compared as the thread's processor compares numbers. A thread that takes denormal
//            numbers (nearer to 0 than 1.2e-38, or 2.2e-308) for 0 finds that more such boxes touch. Where
//            coordinates are denormal, all threads must agree on that; elsewhere the answers are the same.
// Limits     2^28 proxies. Throws std::length_error beyond.
// Callbacks  A collector may ask the grid, and change it, in a query of its own. A proxy that it removes is
//            not offered any more; a proxy that it moves or adds may be offered again, by its new box, or
//            not. After a change, no other thread asks until the query is over. Within visitEach(), queries
//            of convex volumes and a PairFilter the grid must not change; update() and shiftOrigin() must not
//            run within any query. Asserted.
// Memory     Where it runs out, std::bad_alloc comes from add(), reserve(), shiftOrigin(), update() and
//            queries that file or grow; nothing is lost, and the call may be repeated. move() and remove()
//            allocate nothing. Many queries between changes and updates need a second table of the mobile
//            proxies.
// Misuse     An id that is null or stale is asserted, and does nothing; its box is NaN. An id of another
//            grid is, too, unless this grid has a proxy with the same index and generation.

#include <broadphase/aabb.hpp>
#include <broadphase/collectors.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/core/same_library.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/export.hpp>
#include <broadphase/grid_config.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/proxy_groups.hpp>
#include <broadphase/proxy_id.hpp>
#include <broadphase/query_cost.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/store/store.hpp>
#include <broadphase/update_cost.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase {

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

/// Knows every proxy's box, and answers where things are. Scalar is float or double.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Grid {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with configError(config) when the configuration is bad.
    explicit Grid(const GridConfig& config = {});
    /// Destroy the Pairs and Sweeps of the grid first (asserted).
    ~Grid();
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    // --- Proxies ---------------------------------------------------------------------------------

    /// Adds a proxy. The hint `mobility` saves work for proxies that will not move; for `groups` see
    /// setGroups(). Throws std::length_error, and adds nothing, beyond 2^28 proxies. Cost: O(1) amortised.
    [[nodiscard]] ProxyId add(const Box& box, Mobility mobility = Mobility::mobile,
                              const ProxyGroups& groups = {});

    /// Makes room for `count` proxies altogether. Up to that number, add() neither moves memory nor fails for
    /// want of it, until releaseUnusedMemory() gives the room back. Throws std::length_error beyond 2^28.
    /// Cost: O(count) where there is not room already.
    void reserve(std::size_t count);

    /// Sets the proxy's box. A box that is equal to the present one, bit by bit, costs a comparison and marks
    /// nothing. Cost: O(1) amortised.
    [[HASHPHASE_ALWAYS_INLINE]] void move(ProxyId id, const Box& box) {
        HASHPHASE_ASSERT(contains(id),
                         "Only a proxy of this grid that was not removed can be moved.");
        HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
        if (contains(id)) {
            store_.move(id.index, box);
        }
    }

    /// Sets the box of each proxy, in their order; both spans have the same length (asserted). All is as
    /// after as many single calls, on any number of threads, where a proxy is named twice, too. Where memory
    /// runs out in the second one, some boxes are set and others are not: the call may be repeated. Cost: as
    /// move() for each proxy; on several threads 4 bytes a proxy, and where one is named twice the call goes on
    /// on one thread.
    void move(std::span<const ProxyId> ids, std::span<const Box> boxes);
    void move(std::span<const ProxyId> ids, std::span<const Box> boxes, ParallelFor parallelFor);

    /// Says which proxies the proxy may pair with, for Pairs; queries find it as before. Pairs neither tests
    /// nor remembers two proxies that may not pair, and does not ask its filter about them: the cost follows
    /// the pairs that may be, even where hundreds share a cell. Groups count from the next Pairs::update()
    /// on, for which the proxy counts as changed. New pairs begin there; a present pair lasts until its boxes
    /// part, or until Pairs::refilter(). Where memory runs out, nothing has changed.
    /// Cost: O(1); the first call for other groups than ProxyGroups{}, O(proxies).
    void setGroups(ProxyId id, const ProxyGroups& groups);

    /// The groups last set.
    [[nodiscard]] ProxyGroups groups(ProxyId id) const;

    /// Removes the proxy; its id is never valid again. Cost: O(1).
    void remove(ProxyId id);

    /// Removes every proxy and forgets all that came before: the next calls have the same results, in the
    /// same order and at the same cost, as with a new grid, indices of ids included. Old ids stay invalid.
    /// Frees all memory but 64 bytes an index (128 in double precision). Not for a grid with Pairs, which
    /// Pairs::clear() clears, nor within a query: asserted, and does nothing.
    /// Cost: O(indexLimit()).
    void clear();

    /// Moves the origin of all coordinates to `shift` [m]: subtracts it from every box. Queries see it at
    /// once. Returns how many boxes were rounded.
    /// Boxes that were not rounded, or are so large that the shift is lost in them, keep their rest and their
    /// pairs. Boxes that were rounded count as moved: some may come to touch, but none that overlap can part.
    /// (A shift by multiples of a power of two rounds least: 1024 m, say, towards where things are.)
    /// Sweeps over this grid are shifted with it. Shift all else that has coordinates yourself: regions,
    /// zones, terrains. A shift that is not finite is asserted, and does nothing. Where memory runs out,
    /// nothing has changed.
    /// Cost: up to three passes over all boxes; when cells had to change, an update(), or the next one's.
    std::size_t shiftOrigin(const Point& shift);

    /// Whether the id names a proxy of this grid that was not removed.
    [[nodiscard]] bool contains(ProxyId id) const noexcept { return store_.proxies.contains(id); }

    /// The box last set, exactly.
    [[nodiscard]] const Box& box(ProxyId id) const;

    /// Number of proxies alive, those with a NaN box included.
    [[nodiscard]] std::size_t size() const noexcept { return store_.proxies.size; }

    /// The length of an array by ProxyId::index: the indices of all proxies, present and past, are below it.
    /// Falls only where memory is given back: see releaseUnusedMemory().
    [[nodiscard]] std::uint32_t indexLimit() const noexcept {
        return static_cast<std::uint32_t>(store_.proxies.records.size());
    }

    /// The proxy alive that has this index; null when there is none. Leads from data kept by index, such as
    /// the bits of CollectBits, back to the proxy. Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept {
        return index < indexLimit() && store_.proxies.isAlive(index) ? store_.proxies.idOf(index)
                                                                     : ProxyId{};
    }

    /// A number that stands for the set of proxies: it differs after each add(), remove(), clear() and shift
    /// of the origin, and from that of any other grid. Tells whether a kept query result is out of date.
    [[nodiscard]] std::uint64_t populationNumber() const noexcept { return store_.proxies.number; }

    /// Number of proxies whose box has a NaN now.
    [[nodiscard]] std::size_t nanCount() const noexcept { return store_.proxies.nanCount; }

    /// Calls visit(ProxyId, const Box&) for every proxy alive, in the order of their indices; it may
    /// change the grid. Cost: O(proxies); after a peak of eight times as many, O(n log n) and a list.
    template <class Visit>
    void forEach(Visit&& visit) const;

    // --- Queries ---------------------------------------------------------------------------------

    /// The one query: offers to `collector` every proxy whose box has a key in `region`, each once.
    /// See regions.hpp and collectors.hpp. Returns the cost as data.
    /// Cost: the cells that the region touches. However large or long the region, at most about one test for
    /// each proxy (up to 16 where so many rows of cells share a bucket), and one more for each proxy that has
    /// changed since it was filed. A region that is empty by a NaN costs only these (one test for each proxy,
    /// if the NaN is in a ray's fatness). Where hundreds share a cell, a region with bounds() tests only the
    /// long ones and those close to it along an axis.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// visit() for many regions: collectors[i] takes the proxies of regions[i], in any order. Both spans have
    /// the same length (asserted). The collectors must not share data when `parallelFor` is parallel. Returns
    /// the sum of the costs, each within the bounds of visit(). Faster than single calls where regions have
    /// bounds(), unless the collectors stop early.
    template <class Region, class Collector>
    QueryCost visitEach(std::span<const Region> regions, std::span<Collector> collectors,
                        ParallelFor parallelFor = serialFor) const;

    /// The edge of the cells of cellAt(), cellsOf() and visitCell() [m]: the fixed cell size, or the
    /// finest of the automatic ones at the last update; 1 while the grid is empty.
    [[nodiscard]] Scalar cellSize() const noexcept { return store_.tables.cellSize; }

    /// Files what has changed, if `count` queries would otherwise read more of the list of changes than
    /// filing costs. visitEach() does it by itself. Call it before many single queries on several threads, so
    /// that they cost the same in every run. Cost: O(1), or that of an update().
    void expectQueries(std::size_t count) const { store_.expectQueries(count); }

    /// The same for rays: builds, too, what makes so many fast, if they may be worth it; those that come later
    /// would. visitEach() does it by itself. Cost: O(1), or that of an update() and a sort of the proxies.
    void expectRays(std::size_t count) const { store_.expectRays(count); }

    /// Cell query: which proxies are in the cell? Offers every proxy p with `cell` in cellsOf(p) to the
    /// collector. Cost: O(1) buckets; at most that of visit().
    template <class Collector>
    QueryCost visitCell(const std::array<std::int64_t, 3>& cell, Collector& collector) const;

    /// The cell of a point [m]: floor(point / cellSize()) on each axis. The last cells, 9e18 from 0, hold all
    /// that lies beyond. The point must be finite (asserted).
    [[nodiscard]] std::array<std::int64_t, 3> cellAt(const Point& point) const;

    /// Object query: which cells does the proxy's box touch? Its box must be finite (asserted).
    /// Cost: O(1).
    [[nodiscard]] CellRange cellsOf(ProxyId id) const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Ends a frame: files what changed, and puts to rest what has not changed for a while. Not for a grid
    /// with Pairs, which Pairs::update() updates, nor within a query: asserted, and does nothing. The result
    /// does not depend on `parallelFor`. Cost: a rebuild of the mobile proxies when one of them changed, unless
    /// there are few; nothing otherwise; at worst O(n log n), to sort cells that very many proxies share.
    UpdateCost update(ParallelFor parallelFor = serialFor);

    /// How often the mobile proxies have been filed: by updates that found a change, unless of few, and between
    /// updates by queries that had read much of the list of changes.
    [[nodiscard]] std::uint64_t filingCount() const noexcept { return store_.tables.filingCount; }

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Bytes that only rays read, where there are so many of them that it pays; else 0. Part of memoryBytes().
    [[nodiscard]] std::size_t rayMemoryBytes() const noexcept;

    /// Frees what only rays read; many rays build it again. Not within a query (asserted).
    void releaseRayMemory() noexcept;

    /// Gives back unused memory: room for more proxies than there are, and scratch, which the next update,
    /// shift or query takes again. Ends what reserve() has asked for.
    /// Indices at the end without a proxy go, too: indexLimit() falls, and their old ids stay invalid; from
    /// then on new proxies take the lowest free index first. A proxy with a high index keeps a record (64
    /// bytes, or 128 in double precision) for each index below.
    /// An update does it by itself when there has been room for more than eight times as many proxies, or
    /// eight times those reserved, in 256 updates in a row. Not within a query (asserted). Cost:
    /// O(indexLimit()), and moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every proxy alive is filed in exactly one table, or waits in the list of changes, or is NaN.
    /// - A filed proxy's entry has the proxy's box.
    /// - The tables' own invariants (hash/table.hpp), and those of their trees (tree/box_tree.hpp).
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    /// What the grid is made of. It may change with any version.
    [[nodiscard]] detail::Store<Scalar>& store() noexcept { return store_; }
    [[nodiscard]] const detail::Store<Scalar>& store() const noexcept { return store_; }
    /// Whether the calling thread is within a query of this grid, or within its filter.
    [[nodiscard]] bool isWithinQuery() const noexcept {
        return detail::QueryScope::isWithin(&store_);
    }
    /// False while the calling thread is within a query that takes no changes: see Callbacks.
    [[nodiscard]] bool takesChanges() const noexcept {
        return !detail::QueryScope::forbidsChanges(&store_);
    }

private:
    using Filing = detail::Filing<Scalar>;
    using Reading = detail::Reading<Scalar>;

    template <class Region, class Collector>
    struct VisitReader;
    struct CellRegion;

    template <class Region, class Collector>
    QueryCost visitTogether(const Reading& reading, std::span<const Region> regions,
                            std::span<Collector> collectors, bool mayChange) const;

    detail::Store<Scalar> store_;
};

extern template class Grid<float>;
extern template class Grid<double>;

}  // namespace hashphase

#include <broadphase/search/grid_visit.hpp>
