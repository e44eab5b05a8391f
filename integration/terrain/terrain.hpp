// SPDX-License-Identifier: Zlib
#pragma once

// The ground: static triangles in a grid. Finds the height of the ground below a point, and of a resting sphere.
//
// Frame     Change the ground, then query many points in one call. changed_ground.hpp finds the bodies on changed
//           ground.
// Numbers   A triangle keeps its number until it is removed. Later triangles may get this number. add() assigns
//           consecutive numbers. If all calls of add() and remove() take the same count of triangles, all free
//           numbers are used again. Otherwise, some may stay free. Free numbers and refused triangles have NaN
//           corners, a zero normal and the null proxy.
// Grid      The grid may contain other proxies, which may change. This costs time, but does not change results.
//           Removed triangles are never found.
// Exact     A point on an edge or corner belongs to all triangles there, so a closed surface has no holes. Heights
//           are computed in double precision.
// Seams     Rounding may leave gaps between meshes with different transforms. A point in such a gap belongs to the
//           highest triangle that is, seen from above, at most seamTolerance() away. If the vertical line below
//           the point meets a second triangle (ground under a bridge, for example), the point belongs to the higher
//           of these two triangles, or to the second if both are about equally high.
// Units     metres. Heights are coordinates along the up axis.
// Threads   Several threads may run queries (const functions) at once. During other calls, no other thread may use
//           the terrain, its grid, or its ChangedGround.
// Memory    Queries answer 16 points at a time, and allocate only if hundreds of boxes lie below these points. If
//           memory runs out during a change, the terrain stays unchanged.
// Bad data  add() and replace() refuse and list triangles with a bad corner (see add()). Queries find no ground for
//           points with a NaN or for bad radii (see restingHeight()).
// Misuse    These fail an assertion and change nothing: a number of corners or indices that is no multiple of 3, bad
//           tolerances, more than 2^32 - 1 triangles, numbers for replace() and remove() that are free or not below
//           size(). Asserted (otherwise undefined behaviour): spans have equal lengths; numbers for corners(),
//           normal() and proxy() are below size().
// Source    The object-terrain test of Hastings, Mesit and Guha for flat ground, extended to slopes and edges.

#include <broadphase/core/compiler.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/up_axis.hpp>
#include <integration/terrain/detail/free_runs.hpp>
#include <integration/terrain/detail/ground_triangle.hpp>
#include <integration/terrain/detail/seam_groups.hpp>
#include <integration/terrain/export.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// The ground at a point.
template <class Scalar>
struct Ground {
    std::uint32_t triangle = 0;  ///< number of the triangle
    Scalar height = 0;           ///< of the ground, or of a resting sphere's centre [m]

    friend bool operator==(const Ground&, const Ground&) = default;
};

/// Result of Terrain::add() and Terrain::replace(). The given triangles have consecutive numbers, refused triangles
/// included.
struct AddedTriangles {
    std::uint32_t first = 0;             ///< number of the first triangle
    std::uint32_t count = 0;             ///< number of given triangles
    std::vector<std::uint32_t> refused;  ///< numbers of the refused triangles
};

template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT ChangedGround;

/// Stores static triangles, and finds the height of the ground.
template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT Terrain {
public:
    using Point = Vector3<Scalar>;
    using Corners = std::array<Point, 3>;
    using Found = std::optional<Ground<Scalar>>;

    /// Largest valid coordinate and radius [m]. In single precision, all finite numbers are valid.
    static constexpr double kFarthest = 1e70;

    /// Keeps a reference to the grid, which must outlive the terrain.
    explicit Terrain(Grid<Scalar>& grid, UpAxis up = UpAxis::y);
    /// Removes the terrain's proxies. Asserted: each ChangedGround of the terrain was destroyed earlier.
    ~Terrain();
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    // --- Triangles -------------------------------------------------------------------------------

    /// Adds triangles, three corners [m] each, in either orientation. Refuses triangles with a coordinate that is
    /// NaN, infinite or beyond kFarthest. Spheres can rest on vertical triangles and triangles of zero area, but
    /// surfaceBelow() does not find these triangles. The triangles get the lowest consecutive free numbers. If no run of
    /// free numbers is long enough, size() grows. If size() stays constant because free numbers are used again, add()
    /// soon allocates nothing except `refused`. Cost: O(given triangles) amortised, and O(runs of free numbers).
    AddedTriangles add(std::span<const Point> corners);

    /// As the other add(), but each triangle has three indices into `vertices`. Also refuses triangles with an index
    /// beyond the last vertex.
    AddedTriangles add(std::span<const Point> vertices, std::span<const std::uint32_t> indices);

    /// Replaces the corners of the triangles with numbers `first`, `first` + 1 and so on. Refuses triangles as add()
    /// does. Triangles keep their numbers. A triangle keeps its proxy if it was accepted before and is accepted now.
    /// Unchanged triangles cost no update of the grid, and ChangedGround does not record them. To change how many
    /// triangles there are, call remove() and add(). Allocates if a replaced triangle was refused before, or is
    /// refused now; otherwise rarely, and a few kB at most. Asserted: none of the numbers is free. Cost: O(given
    /// triangles).
    AddedTriangles replace(std::uint32_t first, std::span<const Point> corners);
    AddedTriangles replace(std::uint32_t first, std::span<const Point> vertices,
                           std::span<const std::uint32_t> indices);

    /// Removes `count` triangles from number `first` on, refused triangles too, and their proxies. Asserted: none of
    /// the numbers is free. Cost: O(count), and O(runs of free numbers).
    void remove(std::uint32_t first, std::uint32_t count = 1);

    /// Removes all triangles and their proxies. The next add() begins with number 0.
    void clear();

    /// Subtracts `shift` [m] from all corners. Call it together with every Grid::shiftOrigin() of the grid, with an
    /// equal shift. Asserted: `shift` is finite. Cost: O(triangles).
    void shiftOrigin(const Point& shift);

    /// All numbers are below this limit: numbers of triangles, of refused triangles, and free numbers. Only clear()
    /// lowers the limit.
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(triangles_.size());
    }

    /// The corners [m] of a triangle, in the given order; NaN for a refused triangle.
    [[nodiscard]] Corners corners(std::uint32_t triangle) const;

    /// Unit normal of the upper side; zero if the triangle is vertical or refused, or its area is zero or so small
    /// that rounding hides the normal.
    [[nodiscard]] Point normal(std::uint32_t triangle) const;

    /// The triangle's proxy; null for a refused triangle.
    [[nodiscard]] ProxyId proxy(std::uint32_t triangle) const;

    /// Returns the number of the triangle that owns this proxy. Use it for proxies that a query found. Returns
    /// std::nullopt if the terrain has no such proxy. Cost: O(1).
    [[nodiscard]] std::optional<std::uint32_t> triangleOf(ProxyId id) const noexcept {
        const std::uint32_t number = numberOf(id);
        return number != kNone && proxies_[number] == id ? std::optional(number) : std::nullopt;
    }

    // --- Seams -----------------------------------------------------------------------------------

    /// Sets the tolerance [m]: a point in a gap belongs to a triangle that is, seen from above, at most this far away
    /// (see Seams at the top). If 0, gaps stay open. If std::nullopt, the default, the tolerance is automatic: see
    /// seamTolerance(). Set a tolerance if you computed the corners from larger numbers than the two lengths in
    /// seamTolerance() (for example, far from the origin), or if the tolerance must not depend on the present
    /// triangles. Gaps up to twice the tolerance are closed. Ledges extend outwards by the tolerance. clear() keeps
    /// the setting. Asserted: the tolerance is std::nullopt, or at least 0 and at most kFarthest. If not, nothing
    /// changes. Cost: O(1).
    void setSeamTolerance(std::optional<Scalar> tolerance);

    /// Returns the tolerance [m] at the point: the tolerance that you set, or the automatic tolerance, by which
    /// rounding may move a nearby edge. The automatic tolerance is 8 epsilon of Scalar times the sum of two lengths.
    /// A chunk is the triangles of one add() or replace(), and is present until all its triangles are removed or
    /// replaced. The first length is the largest absolute value of the point's two horizontal coordinates, with the
    /// present origin and with each earlier origin since the oldest present chunk was added. The second length is the
    /// size of the largest present chunk, rounded up to a power of two, at most 16 km. The size of a chunk is its
    /// largest extent plus its largest absolute height when it was added. For chunks of size 64 m in single
    /// precision, the tolerance is 0.06 mm at the origin, and 1 mm at 1 km; in double precision 2 pm at 1 km.
    [[nodiscard]] Scalar seamTolerance(const Point& point) const noexcept {
        return setTolerance_
                   ? *setTolerance_
                   : kSeamRoundings * (seamGroups_.farthest(point[alongX_], point[alongZ_]) +
                                       seamGroups_.extent());
    }

    // --- Queries ---------------------------------------------------------------------------------

    /// Returns the highest surface at or below the point [m], on the point's vertical line. Of equally high
    /// triangles, returns the triangle with the smallest number. Returns std::nullopt if there is no such surface. A
    /// query at the returned height returns the same height. Adds the query's cost to `cost`. Cost: Grid::visit() of
    /// the line below the point.
    [[nodiscard]] Found surfaceBelow(const Point& point, QueryCost* cost = nullptr) const;

    /// Returns the height of the centre of a sphere that rests on the ground, and the triangle that carries the
    /// sphere. The sphere may move only along the vertical line through `center` [m]. The result is the highest
    /// position of rest whose contact point is at or below `center`: a bridge overhead does not count, and a sunken
    /// sphere is lifted. On a slope with unit normal n, the result is the height of the ground + radius / n_up.
    /// Returns std::nullopt if the sphere would fall past all triangles, or the radius [m] is negative, NaN or above
    /// kFarthest. Adds the query's cost to `cost`. Cost: Grid::visit() of the square column below the sphere.
    [[nodiscard]] Found restingHeight(const Point& center, Scalar radius,
                                      QueryCost* cost = nullptr) const;

    /// As surfaceBelow(), for many points: found[i] belongs to points[i]. Fastest if neighbouring points are adjacent
    /// in `points`. Returns the cost. Cost: at most as surfaceBelow() for each point. Memory: 10 kB of stack on each
    /// thread; for 1,024 or more points, 300 kB of stack on the calling thread.
    QueryCost surfacesBelow(std::span<const Point> points, std::span<Found> found,
                            ParallelFor parallelFor = serialFor) const;

    /// As restingHeight(), for many spheres: found[i] belongs to centers[i] and radii[i]. Speed, cost and memory: as
    /// surfacesBelow().
    QueryCost restingHeights(std::span<const Point> centers, std::span<const Scalar> radii,
                             std::span<Found> found, ParallelFor parallelFor = serialFor) const;

    /// Bytes held, capacity included, without the grid's bytes.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    friend class ChangedGround<Scalar>;
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    static constexpr Scalar kSeamRoundings = 8 * std::numeric_limits<Scalar>::epsilon();

    template <class Search>
    struct Candidates;
    class Seam;
    struct SurfaceSearch;
    struct RestSearch;
    class TileOrder;

    static constexpr std::uint32_t kTilesPerSide = 128;
    static constexpr std::size_t kTiles = std::size_t{kTilesPerSide} * kTilesPerSide;

    /// Returns the tile of a point, in a grid of tiles over bounds_.
    [[nodiscard]] std::uint16_t tileOf(const Point& point) const noexcept {
        const auto along = [&](Eigen::Index axis) {
            constexpr auto last = static_cast<Scalar>(kTilesPerSide - 1);
            const Scalar tile = (point[axis] - bounds_.min()[axis]) * tilesPerMetre_[axis];
            // This order of min and max turns NaN into 0.
            return static_cast<std::uint32_t>(std::min(std::max(Scalar(0), tile), last));
        };
        return static_cast<std::uint16_t>(along(alongZ_) * kTilesPerSide + along(alongX_));
    }

    template <class Search, class MakeSearch, class NumberOf>
    QueryCost searchInOrder(std::size_t count, const NumberOf& numberOf, std::span<Found> found,
                            ParallelFor parallelFor, const MakeSearch& makeSearch) const;

    // Not inlined: calls with few points must not use its 300 kB of stack. (Clang reads the attribute only here.)
    template <class Search, class MakeSearch>
    [[HASHPHASE_NO_INLINE]] QueryCost searchByTiles(std::span<const Point> points,
                                                    std::span<Found> found, ParallelFor parallelFor,
                                                    const MakeSearch& makeSearch) const;

    template <class Search, class MakeSearch>
    QueryCost searchEach(std::span<const Point> points, std::span<Found> found,
                         ParallelFor parallelFor, const MakeSearch& makeSearch) const;

    using CornersOf = FunctionRef<Corners(std::size_t)>;
    AddedTriangles addAll(std::size_t count, CornersOf cornersOf);
    AddedTriangles replaceAll(std::uint32_t first, std::size_t count, CornersOf cornersOf);
    struct Plan;
    [[nodiscard]] Plan prepare(std::uint32_t first, std::size_t count, CornersOf cornersOf);
    void write(const Plan& plan, CornersOf cornersOf);
    void setTriangle(std::uint32_t number, const Corners& corners, std::uint8_t seamGroup);
    void unsetTriangle(std::uint32_t number);
    [[nodiscard]] bool areTaken(std::uint32_t first, std::size_t count) const noexcept;
    void includeInBounds(const Aabb<Scalar>& box) noexcept;
    void tightenBounds(std::uint32_t changedCount) noexcept;
    void noteChange(const Aabb<Scalar>& box) noexcept;
    [[nodiscard]] detail::GroundTriangle<Scalar> groundTriangle(const Corners& corners) const;
    [[nodiscard]] detail::Point2 above(const Point& point) const noexcept {
        return {static_cast<double>(point[alongX_]), static_cast<double>(point[alongZ_])};
    }

    [[nodiscard]] Scalar along(const Point& point) const noexcept {
        return std::max(std::abs(point[alongX_]), std::abs(point[alongZ_]));
    }
    /// Sets the vertical column below the point. The column extends `reach` [m] to each side. `reach` must include
    /// a margin for rounding.
    void setColumn(Aabb<Scalar>& column, const Point& point, Scalar reach) const noexcept {
        column.min() = point.array() - reach;
        column.max() = point.array() + reach;
        column.min()[up_] = -std::numeric_limits<Scalar>::infinity();
        column.max()[up_] = point[up_];
    }

    /// Returns the number of the triangle whose proxy has the index id.index, or kNone. Ignores id.generation, so the
    /// id of a removed proxy with the same index also finds this triangle.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t numberOf(ProxyId id) const noexcept {
        return id.index < triangleOfProxy_.size() ? triangleOfProxy_[id.index] : kNone;
    }

    Grid<Scalar>* grid_;
    int up_;
    int alongX_;  // the axes along the ground
    int alongZ_;
    // A box around all triangles, and some removed triangles. Used only for the order in which many points are
    // processed.
    Aabb<Scalar> bounds_;
    Aabb<Scalar> nextBounds_;  // around triangles with numbers below boundsNext_, and new triangles
    std::uint32_t boundsNext_ = 0;
    Point tilesPerMetre_ = Point::Zero();
    std::optional<Scalar> setTolerance_;
    detail::SeamGroups<Scalar> seamGroups_;
    detail::FreeRuns free_;
    std::vector<detail::GroundTriangle<Scalar>> triangles_;
    std::vector<ProxyId> proxies_;  // index: number of the triangle; null if refused
    std::vector<std::uint32_t>
        triangleOfProxy_;  // index: ProxyId::index; kNone if the proxy is not a triangle
    std::vector<ChangedGround<Scalar>*> changed_;
};

extern template class Terrain<float>;
extern template class Terrain<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
