// SPDX-License-Identifier: Zlib
#pragma once

// The ground: triangles that stand still, filed in the grid once, each by its box. Says how high the
// ground is below a point, and where a sphere rests on it. After the object-terrain test of Hastings,
// Mesit and Guha, which holds on flat ground; here a sphere rests on slopes, edges and corners too.
// Triangles come, change and go one by one or in chunks, at the cost of those that do.
//
//     Terrain<float> terrain(grid);
//     terrain.add(corners);
//     if (const auto ground = terrain.surfaceBelow(point)) { point.y() = ground->height; }
//
// A frame    Change the ground, then ask; ask about many points in one call. Where the ground has changed, and
//            what stands there, says ChangedGround (changed_ground.hpp).
// Numbers    A triangle keeps its number until it is removed. Then the number is free, and a later triangle may
//            take it. add() needs free numbers side by side: chunks of one size take again what others left; chunks
//            of different sizes leave gaps, so that size() stays somewhat above the most triangles at a time. A free
//            number has NaN corners, no normal and the null proxy, as that of a refused triangle.
// History    What has left decides nothing: answers are those of a new terrain with the same triangles, under the
//            same numbers, and the same seam tolerance, which follows the calls that brought these triangles.
// Others     The grid may hold other proxies, and may change; this costs only time.
// Exact      A point on an edge or a corner belongs to all triangles there: no point of a closed
//            surface is lost between two triangles. Heights are found in double precision.
// Seams      Where meshes that were placed by different transforms meet, their edges differ by rounding. A
//            point between the edges belongs to the nearest triangle: see seamTolerance(). Wider gaps stay
//            gaps. A triangle exactly below the point, at about that height, goes before.
// Units      metres. Heights are coordinates along the axis that is up.
// Threads    Queries are const and may run on any number of threads. Everything else needs the terrain, its grid
//            and its ChangedGround for itself.
// Memory     A query allocates nothing, unless a few points meet hundreds of boxes. A query about more than a
//            thousand points takes 0.3 MB of the stack. Where it runs out in a call that changes triangles,
//            nothing has changed.
// Bad data   Triangles with a bad corner are refused and named; bad points and radii have no ground.
// Misuse     Corners that do not come in threes, batches of unequal lengths, numbers that no triangle
//            has, bad tolerances, and more than 2^32 - 2 triangles are asserted. Such a call changes nothing.

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

/// Where an object stands.
template <class Scalar>
struct Ground {
    std::uint32_t triangle = 0;  ///< number of the triangle
    Scalar height = 0;           ///< of the ground, or of the centre of a resting sphere [m]

    friend bool operator==(const Ground&, const Ground&) = default;
};

/// What Terrain::add() and replace() did. Triangles are numbered in the order in which they were handed in,
/// including refused ones.
struct AddedTriangles {
    std::uint32_t first = 0;             ///< number of the first triangle
    std::uint32_t count = 0;             ///< how many were handed in
    std::vector<std::uint32_t> refused;  ///< numbers of triangles with a bad corner
};

template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT ChangedGround;

/// Triangles that stand still, and how high the ground is.
template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT Terrain {
public:
    using Point = Vector3<Scalar>;
    using Corners = std::array<Point, 3>;
    using Found = std::optional<Ground<Scalar>>;

    /// Coordinates and radii up to this are good [m]: in single precision all finite ones.
    static constexpr double kFarthest = 1e70;

    /// Keeps a reference to the grid, which must outlive the terrain.
    explicit Terrain(Grid<Scalar>& grid, UpAxis up = UpAxis::y);
    /// Removes the terrain's proxies. Destroy each ChangedGround of the terrain first (asserted).
    ~Terrain();
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    // --- Triangles -------------------------------------------------------------------------------

    /// Adds triangles, three corners [m] each. Refuses triangles with a corner that is NaN, infinite or
    /// farther than kFarthest. Vertical triangles, and those without an area, carry spheres but have no
    /// height themselves. Either side may be up. They take the lowest numbers that are free side by side, or
    /// else those from size() on. Cost: O(1) amortised for each triangle, and a step for each run of free
    /// numbers; where as much was removed before, it allocates nothing.
    AddedTriangles add(std::span<const Point> corners);

    /// Adds triangles by the places of their corners in `vertices`, three indices each. Also refuses
    /// triangles with an index beyond the last vertex.
    AddedTriangles add(std::span<const Point> vertices, std::span<const std::uint32_t> indices);

    /// Sets the corners of the triangles from number `first` on, as many as are handed in; all else is as in
    /// add(). They keep their numbers, and their proxies, but for those that are refused now or were before.
    /// An unchanged triangle is computed again, but neither filed nor noted by ChangedGround. All numbers must
    /// be taken (asserted): for more triangles than before, remove() and add(). Cost: O(1) for each triangle.
    /// Allocates nothing unless triangles are refused, or were.
    AddedTriangles replace(std::uint32_t first, std::span<const Point> corners);
    AddedTriangles replace(std::uint32_t first, std::span<const Point> vertices,
                           std::span<const std::uint32_t> indices);

    /// Removes the triangles from number `first` on, and their proxies; refused ones, too. Their numbers are
    /// free then, and must not be removed or replaced before they are taken again. Cost: O(1) for each
    /// triangle, and a step for each run of free numbers.
    void remove(std::uint32_t first, std::uint32_t count = 1);

    /// Removes all triangles, and their proxies; numbers begin at 0 again.
    void clear();

    /// Subtracts `shift` [m] from the corners, as Grid::shiftOrigin() does from their boxes. Call it with
    /// each Grid::shiftOrigin() of the grid. Cost: O(triangles).
    void shiftOrigin(const Point& shift);

    /// All numbers are below it: those of triangles, of refused ones, and free ones. Never shrinks until
    /// clear().
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(triangles_.size());
    }

    /// The corners [m] of a triangle, in the order in which they were handed in; NaN for a refused one.
    [[nodiscard]] Corners corners(std::uint32_t triangle) const;

    /// Unit normal of the side that is up; zero where the triangle has no heights.
    [[nodiscard]] Point normal(std::uint32_t triangle) const;

    /// The triangle's proxy in the grid; null for a refused one.
    [[nodiscard]] ProxyId proxy(std::uint32_t triangle) const;

    /// The number of the triangle that has the proxy; nothing where the proxy is not the terrain's. Leads from
    /// what a query of the grid finds to the triangle. Cost: O(1).
    [[nodiscard]] std::optional<std::uint32_t> triangleOf(ProxyId id) const noexcept {
        const std::uint32_t number = numberOf(id);
        return number != kNone && proxies_[number] == id ? std::optional(number) : std::nullopt;
    }

    // --- Seams -----------------------------------------------------------------------------------

    /// A point beside all triangles belongs to the nearest one within `tolerance` [m], seen from above. 0: never.
    /// nullopt: automatic, as by default: seamTolerance() then follows the triangles. Set it where corners were
    /// computed from larger numbers than seamTolerance() knows, or where it must not depend on which triangles
    /// come and go. Gaps up to twice the tolerance are closed, and a ledge reaches out by the tolerance. NaN,
    /// negative numbers and those above kFarthest are asserted, and change nothing. clear() keeps it. Cost: O(1).
    void setSeamTolerance(std::optional<Scalar> tolerance);

    /// Returns the tolerance [m] at the point: what was set, or the automatic one, by which rounding may move an
    /// edge near the point. That is 8 epsilon of Scalar times a sum of two numbers. The first is the point's larger
    /// coordinate along the ground, now or before a shift of the origin. The second is the largest extent plus
    /// height of the triangles of one add() or replace(), rounded up to a power of two, at most 16 km. It counts
    /// each add() or replace() of which a triangle is left, with all that it brought, and the shifts since.
    /// (A corner placed by a transform is six sums and products of such numbers along two axes, each off by half
    /// an epsilon.) In single precision a twentieth of a millimetre for chunks of 32 m near the origin, 1 mm at
    /// 1 km; in double precision 2 pm.
    [[nodiscard]] Scalar seamTolerance(const Point& point) const noexcept {
        return setTolerance_
                   ? *setTolerance_
                   : kSeamRoundings * (seamGroups_.farthest(point[alongX_], point[alongZ_]) +
                                       seamGroups_.extent());
    }

    // --- Queries ---------------------------------------------------------------------------------

    /// Returns the highest surface at or below the point [m], on the vertical line through it; of several
    /// equally high ones the triangle with the smallest number. Nothing outside of all triangles, and below
    /// them. A second call at the returned height returns that height again. Adds the query's cost to `cost`.
    /// Cost: the triangles whose boxes the line below the point meets; at most one test for each proxy of the
    /// grid.
    [[nodiscard]] Found surfaceBelow(const Point& point, QueryCost* cost = nullptr) const;

    /// Returns the height of the centre of a sphere that rests on the ground, and the triangle that carries
    /// it, when the sphere may move only along the vertical line through `center` [m].
    /// Each triangle carries the sphere at one height, and touches it at one point. The result is the highest
    /// of these heights among triangles whose touching points are not above `center`: a bridge overhead does
    /// not count, and a sphere sunk into a hill is lifted. On a slope with the unit normal n, it is the
    /// height of the ground + radius / n_up; with radius 0 the ground itself. Nothing where no triangle is
    /// below within the radius, and for a radius [m] that is negative, NaN or above kFarthest. Cost: the
    /// triangles whose boxes overlap the square column below the sphere; at most one test for each proxy of
    /// the grid.
    [[nodiscard]] Found restingHeight(const Point& center, Scalar radius,
                                      QueryCost* cost = nullptr) const;

    /// surfaceBelow() for many points: found[i] is that of points[i]. The result does not depend on
    /// `parallelFor`. Returns the cost. Fastest when points near each other follow each other. Cost: at most
    /// as surfaceBelow() for each point. Takes 300 kB of the stack for 1024 points and more, 10 kB for fewer.
    QueryCost surfacesBelow(std::span<const Point> points, std::span<Found> found,
                            ParallelFor parallelFor = serialFor) const;

    /// restingHeight() for many spheres: found[i] is that of centers[i] and radii[i]. Otherwise as
    /// surfacesBelow().
    QueryCost restingHeights(std::span<const Point> centers, std::span<const Scalar> radii,
                             std::span<Found> found, ParallelFor parallelFor = serialFor) const;

    /// Bytes held, capacity included, without those of the grid.
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

    /// The tile in which the point lies, of a grid of tiles over all of the ground.
    [[nodiscard]] std::uint16_t tileOf(const Point& point) const noexcept {
        const auto along = [&](Eigen::Index axis) {
            constexpr auto last = static_cast<Scalar>(kTilesPerSide - 1);
            const Scalar tile = (point[axis] - bounds_.min()[axis]) * tilesPerMetre_[axis];
            // In this order NaN becomes 0.
            return static_cast<std::uint32_t>(std::min(std::max(Scalar(0), tile), last));
        };
        return static_cast<std::uint16_t>(along(alongZ_) * kTilesPerSide + along(alongX_));
    }

    template <class Search, class MakeSearch, class NumberOf>
    QueryCost searchInOrder(std::size_t count, const NumberOf& numberOf, std::span<Found> found,
                            ParallelFor parallelFor, const MakeSearch& makeSearch) const;

    // Not inlined, so that few points take none of its 300 kB of the stack. (Clang looks for this here alone.)
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
    /// Sets the column to all that is no higher than the point, and no farther beside it than `reach`,
    /// which has room for rounding.
    void setColumn(Aabb<Scalar>& column, const Point& point, Scalar reach) const noexcept {
        column.min() = point.array() - reach;
        column.max() = point.array() + reach;
        column.min()[up_] = -std::numeric_limits<Scalar>::infinity();
        column.max()[up_] = point[up_];
    }

    /// The triangle of a proxy, or kNone where it is someone else's.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t numberOf(ProxyId id) const noexcept {
        return id.index < triangleOfProxy_.size() ? triangleOfProxy_[id.index] : kNone;
    }

    Grid<Scalar>* grid_;
    int up_;
    int alongX_;  // the other two axes
    int alongZ_;
    // Of all triangles, and some that were; decides only in which order many points are looked at.
    Aabb<Scalar> bounds_;
    Aabb<Scalar> nextBounds_;  // of those below boundsNext_, and what has come since it was 0
    std::uint32_t boundsNext_ = 0;
    Point tilesPerMetre_ = Point::Zero();
    std::optional<Scalar> setTolerance_;
    detail::SeamGroups<Scalar> seamGroups_;
    detail::FreeRuns free_;
    std::vector<detail::GroundTriangle<Scalar>> triangles_;
    std::vector<ProxyId> proxies_;  // by triangle; null of refused ones
    std::vector<std::uint32_t>
        triangleOfProxy_;  // by ProxyId::index: nobody else's while ours lives
    std::vector<ChangedGround<Scalar>*> changed_;
};

extern template class Terrain<float>;
extern template class Terrain<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
