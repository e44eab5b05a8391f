// SPDX-License-Identifier: Zlib
#pragma once

// The grid: stores the boxes of up to 2^28 proxies in the cells of a spatial hash, and finds them in queries.
//
// A frame    Move the proxies that changed, then call update() once, or Pairs::update() if the grid has Pairs.
// Queries    see every change immediately, because they also read a list of changes. When all reads of this list
//            together have cost a third of an update, a query sorts the proxies into cells. A grid that is never
//            updated stays correct, with bounded memory.
// Threads    Queries are const: any number may run at the same time, and collectors may run queries too. During a
//            non-const call, no other thread may use the grid.
// Units      metres, or any other unit of length used throughout
// Bad data   A query never finds a box with a NaN. nanCount() counts such boxes, and the message handler reports the
//            first. Infinite, huge and inverted boxes are valid: overlaps() defines exactly which boxes they touch.
// Denormals  If threads flush denormals (below 1.2e-38; double: 2.2e-308) to 0, more boxes touch. All threads must
//            use the same mode.
// Callbacks  A collector may query the grid. In visit(), it may also change the grid, if no other thread queries
//            until visit() returns. visit() never offers a removed proxy; it may offer proxies added meanwhile,
//            and may offer again a proxy that the collector changed. Asserted: collectors of visitEach() or
//            ConvexRegion queries, and PairFilters, do not change the grid; no collector calls update() or
//            shiftOrigin().
// Memory     Calls that allocate can throw std::bad_alloc. No data is lost, and you can repeat the call. remove(),
//            and move() without `parallelFor`, never allocate. Queries that sort proxies into cells need memory
//            for a second table of the mobile proxies.
// Misuse     Asserted: ids are valid. If assertions are off, a call with a null or stale id does nothing; box()
//            returns a NaN box. An id of another grid counts as stale, unless its index and generation match a proxy
//            of this grid.

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

/// A range of cells, both ends inclusive, in units of Grid::cellSize().
struct CellRange {
    std::array<std::int64_t, 3> lowest{};
    std::array<std::int64_t, 3> highest{};

    friend bool operator==(const CellRange&, const CellRange&) = default;
};

namespace detail {
/// Cell coordinates are from -kLastCell to kLastCell.
inline constexpr std::int64_t kLastCell = 9'000'000'000'000'000'000;
}  // namespace detail

/// The grid. Scalar is float or double.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Grid {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with configError(config) if `config` is invalid.
    explicit Grid(const GridConfig& config = {});
    /// Asserted: the grid's Pairs and Sweeps are already destroyed.
    ~Grid();
    Grid(const Grid&) = delete;
    Grid& operator=(const Grid&) = delete;

    // --- Proxies ---------------------------------------------------------------------------------

    /// Adds a proxy. `mobility` is a hint; for `groups` see setGroups(). Throws std::length_error beyond 2^28
    /// proxies. Cost: O(1) amortised.
    [[nodiscard]] ProxyId add(const Box& box, Mobility mobility = Mobility::mobile,
                              const ProxyGroups& groups = {});

    /// Allocates memory for `count` proxies in total. Until releaseUnusedMemory(), add() allocates nothing for up to
    /// `count` proxies. Exception: the first proxy with groups other than ProxyGroups{}; see setGroups(). Throws
    /// std::length_error beyond 2^28 proxies. Cost: O(count) if the capacity grows.
    void reserve(std::size_t count);

    /// Sets the proxy's box. If no bit changes, the call costs one comparison. Cost: O(1) amortised.
    [[HASHPHASE_ALWAYS_INLINE]] void move(ProxyId id, const Box& box) {
        HASHPHASE_ASSERT(contains(id),
                         "Grid::move(): the id is null, stale, or of another grid. Pass an id that "
                         "add() returned and that was not removed.");
        HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
        if (contains(id)) {
            store_.move(id.index, box);
        }
    }

    /// Calls move(ids[i], boxes[i]) for each i, in order. `parallelFor` does not change the result, even if an id
    /// occurs twice: in that case, the call runs on one thread. With `parallelFor`, the call needs scratch memory:
    /// about 6 bytes per index below indexLimit(), and 4 bytes per id passed. If it throws std::bad_alloc, only some
    /// proxies may have moved: repeat the call.
    /// Asserted: both spans have the same length.
    /// Cost: as move() for each proxy.
    void move(std::span<const ProxyId> ids, std::span<const Box> boxes);
    void move(std::span<const ProxyId> ids, std::span<const Box> boxes, ParallelFor parallelFor);

    /// Sets which proxies this proxy may pair with in Pairs. Queries ignore groups. The class Pairs skips pairs that
    /// groups refuse: it does not test, filter or store them. If the grid has Pairs, the proxy counts as changed: the
    /// next Pairs::update() finds its new pairs. Existing pairs stay, even if the new groups refuse them,
    /// until their boxes separate, or until Pairs::refilter(). On std::bad_alloc, changes nothing. Cost: O(1), but
    /// O(proxies) when the grid gets its first groups other than ProxyGroups{}.
    void setGroups(ProxyId id, const ProxyGroups& groups);

    /// Returns the proxy's groups.
    [[nodiscard]] ProxyGroups groups(ProxyId id) const;

    /// Removes the proxy; its id never becomes valid again. Cost: O(1).
    void remove(ProxyId id);

    /// Removes all proxies. Later calls give the same results, order, cost and indices as a new grid. However, old
    /// ids stay invalid, and indexLimit() does not fall. Keeps only the memory of records (64 bytes per index, 128 in
    /// double precision) and of lists of indices: reserve() stays in effect. Cost: O(indexLimit()).
    /// Asserted: the grid has no Pairs (use Pairs::clear()); this thread runs no query. If not, the call does
    /// nothing.
    void clear();

    /// Moves the origin to `shift` [m]: subtracts `shift` from every box of the grid and its Sweeps. Shift your
    /// regions, zones and terrains yourself. Returns the number of boxes that had to be rounded, not counting boxes
    /// so large that the shift is lost in rounding. Rounded boxes count as moved: some may begin to touch, but
    /// overlapping boxes never separate. All other proxies keep their pairs, and stay resting if they rested.
    /// Exception: trembling or slow proxies with slack (GridConfig::slack) become mobile. Multiples of a large power
    /// of two, such as 1024 m, round fewest boxes. On std::bad_alloc, changes nothing.
    /// Asserted: the shift is finite. If not, the call does nothing.
    /// Cost: up to three passes over all boxes. If proxies must be sorted into cells again, plus the cost of an
    /// update(), in this call or in the next query or update().
    std::size_t shiftOrigin(const Point& shift);

    /// True when the id belongs to a proxy of this grid that was not removed.
    [[nodiscard]] bool contains(ProxyId id) const noexcept { return store_.proxies.contains(id); }

    /// Returns the proxy's box, exactly as add() or move() set it, or as shiftOrigin() shifted it.
    [[nodiscard]] const Box& box(ProxyId id) const;

    /// Number of proxies, including proxies with a NaN box.
    [[nodiscard]] std::size_t size() const noexcept { return store_.proxies.size; }

    /// Size for an array that is indexed by ProxyId::index: all indices of present proxies are below it. Only
    /// releaseUnusedMemory(), an update() after a peak, and GridSnapshot::restore() lower it.
    [[nodiscard]] std::uint32_t indexLimit() const noexcept {
        return static_cast<std::uint32_t>(store_.proxies.records.size());
    }

    /// Returns the id of the proxy with this index, such as the number of a bit that CollectBits set; a null id if no
    /// proxy has this index. Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept {
        return index < indexLimit() && store_.proxies.isAlive(index) ? store_.proxies.idOf(index)
                                                                     : ProxyId{};
    }

    /// Identifies the set of proxies and the origin: when the number changes, stored query results are out of date.
    /// Every add(), remove(), clear(), shiftOrigin() (except by 0) and GridSnapshot::restore() changes it. move()
    /// does not, although it can change query results. No two grids share a number.
    [[nodiscard]] std::uint64_t populationNumber() const noexcept { return store_.proxies.number; }

    /// Number of proxies whose box has a NaN.
    [[nodiscard]] std::size_t nanCount() const noexcept { return store_.proxies.nanCount; }

    /// Calls visit(ProxyId, const Box&) for every proxy, in ascending index order. This callback may change the grid.
    /// Cost: O(n) for n proxies. If indexLimit() exceeds 8 n, after a peak: O(n log n), and a temporary list.
    template <class Visit>
    void forEach(Visit&& visit) const;

    // --- Queries ---------------------------------------------------------------------------------

    /// Offers to `collector` every proxy whose key in `region` is from 0 to collector.limit() (regions.hpp,
    /// collectors.hpp): once each, unless the collector changes the proxy. Returns counts of the work.
    /// Cost: grows with the cells that the region touches, up to about one test for each proxy of the grid, or 16
    /// tests for each if many cells share hash buckets. Plus one test for each proxy that changed since the last sort
    /// into cells. A region with a NaN tests only these changed proxies. If this region has bounds(), it also tests
    /// the other proxies in no cell (filed_cells.hpp). In a cell with hundreds of proxies, regions with bounds()
    /// usually test only boxes near the region along one axis (the axis that separates these boxes best), and boxes
    /// much longer than average along it.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// Like visit(), for many regions: collectors[i] receives the proxies of regions[i], in any order. If
    /// `parallelFor` uses several threads, collectors must not share data. Returns the sum of the costs. For regions
    /// with bounds(), faster than single calls, unless collectors stop early.
    /// Asserted: both spans have the same length.
    template <class Region, class Collector>
    QueryCost visitEach(std::span<const Region> regions, std::span<Collector> collectors,
                        ParallelFor parallelFor = serialFor) const;

    /// Edge [m] of the cells in visitCell(), cellAt() and cellsOf(): GridConfig::cellSize, or if that is 0, the
    /// finest size chosen at the last update (1 if none was chosen, as for an empty grid).
    [[nodiscard]] Scalar cellSize() const noexcept { return store_.tables.cellSize; }

    /// Sorts changed proxies into cells if that costs less than `count` queries that read the list of changes. Call
    /// it before many single queries on several threads, to make their costs equal in every run. visitEach() calls
    /// it itself. Cost: O(1), or as update().
    void expectQueries(std::size_t count) const { store_.expectQueries(count); }

    /// Like expectQueries(), for rays. Also builds the box trees that make rays fast, if the rays since the last sort
    /// into cells, and `count` more rays, may cost as much as building these trees. Cost: O(1), or as update() and a
    /// sort of the proxies.
    void expectRays(std::size_t count) const { store_.expectRays(count); }

    /// Offers every proxy whose cellsOf() include `cell` to the collector, but never a proxy whose box is not finite.
    /// Cost: O(1) buckets; at most as visit().
    template <class Collector>
    QueryCost visitCell(const std::array<std::int64_t, 3>& cell, Collector& collector) const;

    /// Returns the cell that contains a point [m]: on each axis, floor(point / cellSize()), limited to the range
    /// from -9e18 to 9e18. The outermost cells contain all points beyond. Asserted: the point is finite.
    [[nodiscard]] std::array<std::int64_t, 3> cellAt(const Point& point) const;

    /// Returns the cells that the proxy's box touches. Asserted: the box is finite. Cost: O(1).
    [[nodiscard]] CellRange cellsOf(ProxyId id) const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Ends a frame: sorts the mobile proxies into cells again, except in grids with few proxies. Proxies that have
    /// not changed for GridConfig::updatesBeforeRest updates can become resting: later updates skip them. Returns
    /// counts of the work, which do not depend on `parallelFor`.
    /// Asserted: the grid has no Pairs (use Pairs::update()); this thread runs no query. If not, the call does
    /// nothing.
    /// Cost: O(1) if nothing changed. Otherwise grows with the mobile proxies; at worst O(n log n), if very many of n
    /// proxies share cells.
    UpdateCost update(ParallelFor parallelFor = serialFor);

    /// Number of times that the grid sorted the mobile proxies into cells.
    [[nodiscard]] std::uint64_t filingCount() const noexcept { return store_.tables.filingCount; }

    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Bytes of the box trees that only rays read, as part of memoryBytes(). 0 until enough rays were cast or
    /// expected (expectRays()).
    [[nodiscard]] std::size_t rayMemoryBytes() const noexcept;

    /// Frees the box trees for rays. They are built again once rays, cast or expected, cost as much as building them.
    /// Asserted: this thread runs no query.
    void releaseRayMemory() noexcept;

    /// Frees unused and reserved capacity, and scratch memory that later calls allocate again. Drops unused indices
    /// above the highest used index: indexLimit() falls, and old ids stay invalid. Afterwards, new proxies take the
    /// lowest free index. A proxy with a high index keeps all records below that index allocated. Asserted: this
    /// thread runs no query. If the capacity exceeds eight times the number of proxies, and eight times the
    /// reserved number, during 256 updates in a row, update() frees unused memory too, except reserved capacity.
    /// Cost: O(indexLimit()), plus a copy of the remaining data.
    void releaseUnusedMemory() noexcept;

    /// Returns a sentence about a broken invariant; empty if all hold. store/store.cpp, hash/table.hpp and
    /// tree/box_tree.hpp define the invariants.
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    /// Internal data. It may change with any version.
    [[nodiscard]] detail::Store<Scalar>& store() noexcept { return store_; }
    [[nodiscard]] const detail::Store<Scalar>& store() const noexcept { return store_; }
    /// True while the calling thread runs a query of this grid, or a PairFilter of its Pairs.
    [[nodiscard]] bool isWithinQuery() const noexcept {
        return detail::QueryScope::isWithin(&store_);
    }
    /// False while the calling thread runs a query or PairFilter that forbids changes: see Callbacks.
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
