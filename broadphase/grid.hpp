// SPDX-License-Identifier: Zlib
#pragma once

// The grid: files the boxes of up to 2^28 proxies in a spatial hash, and answers queries about where they are.
//
// A frame    Move the proxies that changed, then call update() once, or Pairs::update() if there are Pairs.
// Queries    see every change at once. Queries read a list of changes; when that has cost a third of filing, one
//            files them all. A grid that is never updated stays correct, with bounded memory.
// Threads    Queries are const: run any number at once, also in collectors. Other calls need exclusive access.
// Units      metres, or any other unit of length used throughout
// Bad data   A box with a NaN is kept but never found; nanCount() counts it, and the message handler reports the
//            first one. Infinite, huge and inverted boxes follow overlaps() exactly.
// Denormals  Flushing denormals (below 1.2e-38, or 2.2e-308) to 0 makes more boxes touch; all threads must agree.
// Callbacks  A collector may query the grid, and in visit() change it; then no other thread queries until visit()
//            ends. Removed proxies are not offered again; moved or added ones may be. Asserted: no change within
//            visitEach(), ConvexRegion queries or a PairFilter; no update() or shiftOrigin() within any query.
// Memory     Calls that allocate throw std::bad_alloc, lose nothing, and may be repeated. remove() and move() on one
//            thread never allocate. Queries that file need a second table of the mobile proxies.
// Misuse     Asserted: ids are valid. With a null or stale id a call does nothing; its box is NaN. An id of another
//            grid is stale here, unless its index and generation match a proxy.

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
/// Cell numbers end here, on either side of 0.
inline constexpr std::int64_t kLastCell = 9'000'000'000'000'000'000;
}  // namespace detail

/// The grid. Scalar is float or double.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Grid {
public:
    using Box = Aabb<Scalar>;
    using Point = Vector3<Scalar>;

    /// Throws std::invalid_argument with configError(config) for an invalid configuration.
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

    /// Makes room for `count` proxies in total, which add() then adds without allocating, until
    /// releaseUnusedMemory(). Throws std::length_error beyond 2^28. Cost: O(count) if the room grows.
    void reserve(std::size_t count);

    /// Sets the proxy's box. A box with the same bits as before costs one comparison. Cost: O(1) amortised.
    [[HASHPHASE_ALWAYS_INLINE]] void move(ProxyId id, const Box& box) {
        HASHPHASE_ASSERT(contains(id),
                         "Grid::move(): the id is null, stale, or of another grid. Pass an id that "
                         "add() returned and that was not removed.");
        HASHPHASE_ASSERT(takesChanges(), detail::kMustNotChange);
        if (contains(id)) {
            store_.move(id.index, box);
        }
    }

    /// Sets boxes[i] for ids[i], in order. The result equals single calls, on any number of threads, even if a proxy
    /// is named twice. With `parallelFor`, may throw std::bad_alloc after some moves; repeat the call.
    /// Asserted: both spans have the same length.
    /// Cost: as move() for each proxy. `parallelFor` takes about 10 bytes of scratch per proxy, and runs on one
    /// thread if a proxy is named twice.
    void move(std::span<const ProxyId> ids, std::span<const Box> boxes);
    void move(std::span<const ProxyId> ids, std::span<const Box> boxes, ParallelFor parallelFor);

    /// Sets which proxies the proxy may pair with in Pairs; queries ignore groups. Pairs that groups refuse are
    /// neither tested nor filtered nor remembered, even if hundreds share a cell. With Pairs, the proxy counts as
    /// changed: new pairs begin at the next Pairs::update(). Existing pairs last until their boxes separate, or until
    /// Pairs::refilter(). Throws std::bad_alloc, and changes nothing.
    /// Cost: O(1); O(proxies) for the first groups other than ProxyGroups{}.
    void setGroups(ProxyId id, const ProxyGroups& groups);

    /// Returns the groups last set.
    [[nodiscard]] ProxyGroups groups(ProxyId id) const;

    /// Removes the proxy; its id never becomes valid again. Cost: O(1).
    void remove(ProxyId id);

    /// Removes all proxies. Later calls give the same results, order, cost and indices as a new grid; old ids stay
    /// invalid. Keeps only records (64 bytes per index, 128 in double precision) and room for lists.
    /// Cost: O(indexLimit()). Asserted, else does nothing: no Pairs (use Pairs::clear()), and not within a query.
    void clear();

    /// Moves the origin to `shift` [m]: subtracts it from every box, and from the grid's Sweeps. Shift your own
    /// regions, zones and terrains yourself. Returns how many boxes were rounded (not those so large that the shift
    /// vanishes in rounding). Rounded boxes count as moved: some may begin to touch, none that overlap separate. The
    /// others stay at rest and keep their pairs. Multiples of a power of two, such as 1024 m, round least.
    /// Throws std::bad_alloc, and changes nothing.
    /// Asserted: the shift is finite, else does nothing.
    /// Cost: up to three passes over all boxes; if cells change, also as an update(), perhaps within the next.
    std::size_t shiftOrigin(const Point& shift);

    /// True when the id names a proxy of this grid that was not removed.
    [[nodiscard]] bool contains(ProxyId id) const noexcept { return store_.proxies.contains(id); }

    /// Returns the box last set, exactly.
    [[nodiscard]] const Box& box(ProxyId id) const;

    /// Number of proxies, including those with a NaN box.
    [[nodiscard]] std::size_t size() const noexcept { return store_.proxies.size; }

    /// Length for an array by ProxyId::index: all indices, present and past, are below it. Falls only by
    /// releaseUnusedMemory(), an update() after a peak, or GridSnapshot::restore().
    [[nodiscard]] std::uint32_t indexLimit() const noexcept {
        return static_cast<std::uint32_t>(store_.proxies.records.size());
    }

    /// Returns the proxy with this index, or null: the way back from data kept by index, such as CollectBits.
    /// Cost: O(1).
    [[nodiscard]] ProxyId idAt(std::uint32_t index) const noexcept {
        return index < indexLimit() && store_.proxies.isAlive(index) ? store_.proxies.idOf(index)
                                                                     : ProxyId{};
    }

    /// Identifies the set of proxies: kept query results are out of date when it changes. Every add(), remove(),
    /// clear(), shiftOrigin() and GridSnapshot::restore() changes it. No two grids share a number.
    [[nodiscard]] std::uint64_t populationNumber() const noexcept { return store_.proxies.number; }

    /// Number of proxies whose box has a NaN.
    [[nodiscard]] std::size_t nanCount() const noexcept { return store_.proxies.nanCount; }

    /// Calls visit(ProxyId, const Box&) for every proxy, by ascending index; visit() may change the grid.
    /// Cost: O(proxies); O(n log n) and a list after a peak of eight times as many proxies.
    template <class Visit>
    void forEach(Visit&& visit) const;

    // --- Queries ---------------------------------------------------------------------------------

    /// Offers to `collector`, once each, all proxies whose box has a key in `region` (regions.hpp, collectors.hpp).
    /// Returns the cost as data.
    /// Cost: the cells that the region touches, at most about one test per proxy (16 if many rows of cells share a
    /// bucket), and one test per proxy that changed since it was filed. A region with a NaN costs only the latter (a
    /// NaN in a ray's fatness: one test per proxy). If hundreds share a cell, regions with bounds() test only long
    /// boxes, and those close along an axis.
    template <class Region, class Collector>
    QueryCost visit(const Region& region, Collector& collector) const;

    /// visit() for many regions: collectors[i] takes the proxies of regions[i], in any order. Collectors must not
    /// share data if `parallelFor` is parallel. Returns the sum of the costs. Faster than single calls for regions
    /// with bounds(), unless collectors stop early.
    /// Asserted: both spans have the same length.
    template <class Region, class Collector>
    QueryCost visitEach(std::span<const Region> regions, std::span<Collector> collectors,
                        ParallelFor parallelFor = serialFor) const;

    /// The edge [m] of the cells below: the configured size; or the finest automatic size at the last update, 1
    /// without an update or if the grid was empty.
    [[nodiscard]] Scalar cellSize() const noexcept { return store_.tables.cellSize; }

    /// Files all changes, if that costs less than `count` queries that read their list. Call it before many single
    /// queries on threads, for equal costs in every run; visitEach() does it itself. Cost: O(1), or as an update().
    void expectQueries(std::size_t count) const { store_.expectQueries(count); }

    /// expectQueries() for rays: also builds the box trees that make rays fast, if `count` rays are worth it.
    /// Cost: O(1), or as an update() and a sort of the proxies.
    void expectRays(std::size_t count) const { store_.expectRays(count); }

    /// Offers to the collector every proxy p with `cell` in cellsOf(p). Cost: O(1) buckets; at most as visit().
    template <class Collector>
    QueryCost visitCell(const std::array<std::int64_t, 3>& cell, Collector& collector) const;

    /// Returns the cell of a point [m]: floor(point / cellSize()) on each axis. The last cells, 9e18 from 0, hold
    /// everything beyond. Asserted: the point is finite.
    [[nodiscard]] std::array<std::int64_t, 3> cellAt(const Point& point) const;

    /// Returns the cells that the proxy's box touches. Asserted: the box is finite. Cost: O(1).
    [[nodiscard]] CellRange cellsOf(ProxyId id) const;

    // --- Frame -----------------------------------------------------------------------------------

    /// Ends a frame: files the changes, and lets long unchanged proxies rest. Returns what it did, which does not
    /// depend on `parallelFor`.
    /// Asserted, else does nothing: no Pairs (use Pairs::update()), and not within a query.
    /// Cost: nothing without changes; otherwise a rebuild of the mobile proxies, except of few; at worst O(n log n),
    /// to sort cells that very many proxies share.
    UpdateCost update(ParallelFor parallelFor = serialFor);

    /// How often updates and queries have filed the mobile proxies.
    [[nodiscard]] std::uint64_t filingCount() const noexcept { return store_.tables.filingCount; }

    /// Bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Bytes of the box trees that only rays read, part of memoryBytes(); 0 until enough rays were cast.
    [[nodiscard]] std::size_t rayMemoryBytes() const noexcept;

    /// Frees the box trees for rays; many rays build them again. Asserted: not within a query.
    void releaseRayMemory() noexcept;

    /// Frees surplus room (also that of reserve()), scratch that later calls allocate again, and unused indices at
    /// the end: indexLimit() falls, and old ids stay invalid. From then on new proxies take the lowest free index. A
    /// proxy with a high index keeps the records of all indices below. update() does this itself after 256 updates in
    /// a row with room for over eight times the proxies, or the reserved number.
    /// Asserted: not within a query.
    /// Cost: O(indexLimit()), and moving the rest.
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant as a sentence; empty when all hold. They are in store/store.cpp, hash/table.hpp
    /// and tree/box_tree.hpp.
    [[nodiscard]] std::string validate() const;

    // --- For the library's own parts -------------------------------------------------------------

    /// The grid's parts. They may change with any version.
    [[nodiscard]] detail::Store<Scalar>& store() noexcept { return store_; }
    [[nodiscard]] const detail::Store<Scalar>& store() const noexcept { return store_; }
    /// True while the calling thread is within a query of this grid, or within its filter.
    [[nodiscard]] bool isWithinQuery() const noexcept {
        return detail::QueryScope::isWithin(&store_);
    }
    /// False while the calling thread is within a query that forbids changes: see Callbacks.
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
