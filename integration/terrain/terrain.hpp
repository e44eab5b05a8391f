// SPDX-License-Identifier: Zlib
#pragma once

// The ground: static triangles in a grid, the height of the ground below a point, and where a sphere rests on it.
//
// Frame     Change the ground, then ask about many points in one call. changed_ground.hpp finds the bodies on
//           changes.
// Numbers   A triangle keeps its number until it is removed; then a later one may take it. add() takes consecutive
//           numbers: chunks of one size reuse them, chunks of different sizes leave gaps. A free number looks like a
//           refused triangle: NaN corners, no normal, and the null proxy.
// Grid      May hold other proxies, and may change: this costs only time. Removed triangles have no effect on
//           answers.
// Exact     A point on an edge or corner belongs to all triangles there: a closed surface has no holes. Heights are
//           computed in double precision.
// Seams     Edges of meshes with different transforms differ by rounding. A point between them belongs to the nearest
//           triangle (seamTolerance()), unless one exactly below has about that height.
// Units     metres. Heights are coordinates along the axis that is up.
// Threads   Queries are const and run on any number of threads. All else needs the terrain, its grid and its
//           ChangedGround for itself.
// Memory    Queries allocate nothing, unless a few points meet hundreds of boxes. If memory runs out in a change,
//           nothing has changed.
// Bad data  Triangles with a bad corner are refused and listed. Bad points and radii have no ground.
// Misuse    Asserted, and changes nothing: corners not in threes, spans of unequal lengths, numbers without a
//           triangle, bad tolerances, more than 2^32 - 2 triangles.
// Source    After the object-terrain test of Hastings, Mesit and Guha for flat ground, extended to slopes and edges.

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
    Scalar height = 0;           ///< of the ground, or of the centre of a resting sphere [m]

    friend bool operator==(const Ground&, const Ground&) = default;
};

/// Result of Terrain::add() and replace(). Numbers follow the order of the given triangles, refused ones included.
struct AddedTriangles {
    std::uint32_t first = 0;             ///< number of the first triangle
    std::uint32_t count = 0;             ///< number of given triangles
    std::vector<std::uint32_t> refused;  ///< numbers of triangles with a bad corner
};

template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT ChangedGround;

/// Static triangles, and the height of the ground.
template <class Scalar>
class HASHPHASE_TERRAIN_TEMPLATE_EXPORT Terrain {
public:
    using Point = Vector3<Scalar>;
    using Corners = std::array<Point, 3>;
    using Found = std::optional<Ground<Scalar>>;

    /// Largest good coordinate and radius [m]: in single precision, all finite ones are good.
    static constexpr double kFarthest = 1e70;

    /// Keeps a reference to the grid, which must outlive the terrain.
    explicit Terrain(Grid<Scalar>& grid, UpAxis up = UpAxis::y);
    /// Removes the terrain's proxies. Asserted: each ChangedGround of the terrain was destroyed.
    ~Terrain();
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    // --- Triangles -------------------------------------------------------------------------------

    /// Adds triangles, three corners [m] each, with either side up. Refuses triangles with a corner that is NaN,
    /// infinite or farther than kFarthest. Vertical triangles and triangles without an area carry spheres, but have
    /// no height. They take the lowest consecutive free numbers, or numbers from size() on. Allocates nothing if as
    /// much was removed before. Cost: O(1) amortised for each triangle, and a step for each run of free numbers.
    AddedTriangles add(std::span<const Point> corners);

    /// Adds triangles by indices into `vertices`, three each. Also refuses triangles with an index beyond the last
    /// vertex.
    AddedTriangles add(std::span<const Point> vertices, std::span<const std::uint32_t> indices);

    /// Replaces the corners of triangles from number `first` on, as many as given; otherwise as add(). Triangles keep
    /// numbers and proxies, unless they are refused now or were before. An unchanged triangle is neither filed nor
    /// noted by ChangedGround. For more triangles, remove() and add(). Allocates nothing unless triangles are
    /// refused, or were. Asserted: all numbers are taken. Cost: O(1) for each triangle.
    AddedTriangles replace(std::uint32_t first, std::span<const Point> corners);
    AddedTriangles replace(std::uint32_t first, std::span<const Point> vertices,
                           std::span<const std::uint32_t> indices);

    /// Removes triangles from number `first` on, refused ones too, and their proxies. Asserted: their numbers are
    /// taken. Cost: O(1) for each triangle, and a step for each run of free numbers.
    void remove(std::uint32_t first, std::uint32_t count = 1);

    /// Removes all triangles, and their proxies. Numbers begin at 0 again.
    void clear();

    /// Subtracts `shift` [m] from all corners. Call it with each Grid::shiftOrigin() of the grid, by the same shift.
    /// Asserted: `shift` is finite. Cost: O(triangles).
    void shiftOrigin(const Point& shift);

    /// Limit of all numbers: of triangles, refused and free ones. Shrinks only in clear().
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(triangles_.size());
    }

    /// The corners [m] of a triangle, in the given order; NaN for a refused one.
    [[nodiscard]] Corners corners(std::uint32_t triangle) const;

    /// Unit normal of the side that is up; zero if the triangle has no height, or is too thin.
    [[nodiscard]] Point normal(std::uint32_t triangle) const;

    /// The triangle's proxy; null for a refused one.
    [[nodiscard]] ProxyId proxy(std::uint32_t triangle) const;

    /// Returns the number of the triangle with this proxy, such as one that a query found. Nothing if the proxy is
    /// not the terrain's. Cost: O(1).
    [[nodiscard]] std::optional<std::uint32_t> triangleOf(ProxyId id) const noexcept {
        const std::uint32_t number = numberOf(id);
        return number != kNone && proxies_[number] == id ? std::optional(number) : std::nullopt;
    }

    // --- Seams -----------------------------------------------------------------------------------

    /// Sets how far outside of all triangles a point may be [m] and still belong to the nearest; 0: never.
    /// std::nullopt, the default: automatic, see seamTolerance(). Set it if corners come from larger numbers than
    /// seamTolerance() knows, or if it must not depend on the present triangles. Closes gaps up to twice the
    /// tolerance; ledges reach out by it. clear() keeps it. Asserted: 0 to kFarthest; otherwise nothing changes.
    /// Cost: O(1).
    void setSeamTolerance(std::optional<Scalar> tolerance);

    /// Returns the tolerance [m] at the point: the set one, or the automatic one, by which rounding may move a nearby
    /// edge. The automatic one is 8 epsilon of Scalar times a sum: the point's larger coordinate along the ground,
    /// plus the largest extent and height of the triangles of one add() or replace() that has some left, rounded up
    /// to a power of two, at most 16 km. Shifts of the origin do not lower it. In single precision 0.05 mm for chunks
    /// of 32 m near the origin, 1 mm at 1 km; in double precision 2 pm.
    [[nodiscard]] Scalar seamTolerance(const Point& point) const noexcept {
        return setTolerance_
                   ? *setTolerance_
                   : kSeamRoundings * (seamGroups_.farthest(point[alongX_], point[alongZ_]) +
                                       seamGroups_.extent());
    }

    // --- Queries ---------------------------------------------------------------------------------

    /// Returns the highest surface at or below the point [m], on its vertical line; of equally high ones the triangle
    /// with the smallest number. Nothing outside of or below all triangles. Asked again at the returned height,
    /// returns it again. Adds the query's cost to `cost`. Cost: Grid::visit() of the line below the point.
    [[nodiscard]] Found surfaceBelow(const Point& point, QueryCost* cost = nullptr) const;

    /// Returns the height of the centre of a sphere that rests on the ground, and the triangle that carries it. The
    /// sphere may move only along the vertical line through `center` [m]. The result is the highest rest on triangles
    /// that it touches at or below `center`: a bridge overhead does not count, and a sunken sphere is lifted. On a
    /// slope with unit normal n, it is the height of the ground + radius / n_up. Nothing if no triangle is below
    /// within the radius, or the radius [m] is negative, NaN or above kFarthest. Adds the query's cost to `cost`.
    /// Cost: Grid::visit() of the square column below the sphere.
    [[nodiscard]] Found restingHeight(const Point& center, Scalar radius,
                                      QueryCost* cost = nullptr) const;

    /// surfaceBelow() for many points, found[i] for points[i]. Fastest if neighbouring points follow each other.
    /// Returns the cost. Cost: at most as surfaceBelow() for each point; 10 kB of the stack, 300 kB from 1,024 points
    /// on.
    QueryCost surfacesBelow(std::span<const Point> points, std::span<Found> found,
                            ParallelFor parallelFor = serialFor) const;

    /// restingHeight() for many spheres, found[i] for centers[i] and radii[i]. Otherwise as surfacesBelow().
    QueryCost restingHeights(std::span<const Point> centers, std::span<const Scalar> radii,
                             std::span<Found> found, ParallelFor parallelFor = serialFor) const;

    /// Bytes held, capacity included, without the grid's.
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

    /// The tile of a point, in a grid of tiles over all of the ground.
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

    // Not inlined, so that few points take none of its 300 kB of the stack. (Clang looks for this here only.)
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
    /// Sets the column to everything at most as high as the point and at most `reach` to its sides, with room for
    /// rounding.
    void setColumn(Aabb<Scalar>& column, const Point& point, Scalar reach) const noexcept {
        column.min() = point.array() - reach;
        column.max() = point.array() + reach;
        column.min()[up_] = -std::numeric_limits<Scalar>::infinity();
        column.max()[up_] = point[up_];
    }

    /// The triangle of a proxy, or kNone if it is not the terrain's.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t numberOf(ProxyId id) const noexcept {
        return id.index < triangleOfProxy_.size() ? triangleOfProxy_[id.index] : kNone;
    }

    Grid<Scalar>* grid_;
    int up_;
    int alongX_;  // the other two axes
    int alongZ_;
    // Of all triangles, and some that were; decides only the order in which many points are processed.
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
        triangleOfProxy_;  // by ProxyId::index, which no other proxy has meanwhile
    std::vector<ChangedGround<Scalar>*> changed_;
};

extern template class Terrain<float>;
extern template class Terrain<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
