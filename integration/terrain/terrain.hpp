// SPDX-License-Identifier: Zlib
#pragma once

// The ground: static triangles in a grid. Finds the height of the ground below a point, and where a sphere rests.
//
// Frame     Change the ground, then query many points in one call. changed_ground.hpp finds the bodies on changed
//           ground.
// Numbers   A triangle keeps its number until it is removed. Later triangles may take the number. add() takes
//           consecutive numbers: chunks of equal size reuse all free numbers, chunks of different sizes do not. A
//           free number looks like a refused triangle: NaN corners, a zero normal, and the null proxy.
// Grid      The grid may hold other proxies, and may change: this costs time, but results stay equal. Removed
//           triangles have no effect on results.
// Exact     A point on an edge or corner belongs to all triangles there, so a closed surface has no holes. Heights
//           are computed in double precision.
// Seams     Rounding may leave gaps between meshes with different transforms. A point in such a gap belongs to the
//           highest triangle within seamTolerance(), unless a triangle exactly below has about that height.
// Units     metres. Heights are coordinates along the up axis.
// Threads   Queries are const: several threads may run them at once. During other calls, no other thread may use the
//           terrain, its grid, or its ChangedGround.
// Memory    Queries allocate only if a few points meet hundreds of boxes. If memory runs out in a change, the terrain
//           stays unchanged.
// Bad data  Triangles with a bad corner are refused and listed (see add()). Queries find no ground for bad points and
//           radii.
// Misuse    Asserted, and changes nothing: a number of corners that is no multiple of 3, spans of unequal lengths,
//           numbers without a triangle, bad tolerances, more than 2^32 - 2 triangles.
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
    /// Removes the terrain's proxies. Asserted: each ChangedGround of the terrain was destroyed before.
    ~Terrain();
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    // --- Triangles -------------------------------------------------------------------------------

    /// Adds triangles, three corners [m] each, in either orientation. Refuses triangles with a corner that is NaN,
    /// infinite or farther than kFarthest. Vertical triangles and triangles without an area carry spheres, but have
    /// no height. The triangles take the lowest consecutive free numbers, or numbers from size() on. Allocates
    /// nothing if enough triangles were removed before. Cost: O(triangles) amortised, and O(runs of free numbers).
    AddedTriangles add(std::span<const Point> corners);

    /// As above, but each triangle has three indices into `vertices`. Also refuses triangles with an index beyond the
    /// last vertex.
    AddedTriangles add(std::span<const Point> vertices, std::span<const std::uint32_t> indices);

    /// Replaces the corners of triangles from number `first` on with the given corners. Accepts and refuses triangles
    /// as add() does. Triangles keep their numbers. Triangles also keep their proxies, unless they are refused now or
    /// were before. Unchanged triangles are not filed again, and not recorded by ChangedGround. To change the number
    /// of triangles, call remove() and add(). Allocates only if triangles are refused now or were before. Asserted:
    /// no number is free. Cost: O(triangles given).
    AddedTriangles replace(std::uint32_t first, std::span<const Point> corners);
    AddedTriangles replace(std::uint32_t first, std::span<const Point> vertices,
                           std::span<const std::uint32_t> indices);

    /// Removes `count` triangles from number `first` on, refused triangles too, and their proxies. Asserted: no
    /// number is free. Cost: O(count), and O(runs of free numbers).
    void remove(std::uint32_t first, std::uint32_t count = 1);

    /// Removes all triangles and their proxies. Numbers begin at 0 again.
    void clear();

    /// Subtracts `shift` [m] from all corners. Call it with every Grid::shiftOrigin() of the grid, with an equal
    /// shift. Asserted: `shift` is finite. Cost: O(triangles).
    void shiftOrigin(const Point& shift);

    /// All numbers are below this limit: numbers of triangles, of refused triangles, and free numbers. Only clear()
    /// lowers the limit.
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(triangles_.size());
    }

    /// The corners [m] of a triangle, in the given order; NaN for a refused triangle.
    [[nodiscard]] Corners corners(std::uint32_t triangle) const;

    /// Unit normal of the upper side; zero if the triangle has no height, or is too thin.
    [[nodiscard]] Point normal(std::uint32_t triangle) const;

    /// The triangle's proxy; null for a refused triangle.
    [[nodiscard]] ProxyId proxy(std::uint32_t triangle) const;

    /// Returns the number of the triangle with this proxy, such as a proxy that a query found. Returns std::nullopt
    /// if the proxy is not the terrain's. Cost: O(1).
    [[nodiscard]] std::optional<std::uint32_t> triangleOf(ProxyId id) const noexcept {
        const std::uint32_t number = numberOf(id);
        return number != kNone && proxies_[number] == id ? std::optional(number) : std::nullopt;
    }

    // --- Seams -----------------------------------------------------------------------------------

    /// Sets how far outside of all triangles a point may be [m] and still belong to a triangle. 0: such points belong
    /// to none. std::nullopt, the default: automatic, see seamTolerance(). Set a tolerance if your corners were
    /// computed from larger numbers than seamTolerance() knows, or if the tolerance must not depend on the present
    /// triangles. Gaps up to twice the tolerance are closed; ledges extend outwards by the tolerance. clear() keeps
    /// the setting. Asserted: 0 to kFarthest; otherwise nothing changes. Cost: O(1).
    void setSeamTolerance(std::optional<Scalar> tolerance);

    /// Returns the tolerance [m] at the point: the one you set, or the automatic one, by which rounding may move a
    /// nearby edge. The automatic tolerance is 8 epsilon of Scalar times a sum of two lengths. The first length is
    /// the point's larger coordinate along the ground. The second is the largest extent plus height of the triangles
    /// of one add() or replace(), rounded up to a power of two, at most 16 km. It counts while any of these triangles
    /// is left. Shifts of the origin do not lower the tolerance. In single precision it is 0.05 mm for chunks of 32 m
    /// near the origin, and 1 mm at 1 km; in double precision 2 pm.
    [[nodiscard]] Scalar seamTolerance(const Point& point) const noexcept {
        return setTolerance_
                   ? *setTolerance_
                   : kSeamRoundings * (seamGroups_.farthest(point[alongX_], point[alongZ_]) +
                                       seamGroups_.extent());
    }

    // --- Queries ---------------------------------------------------------------------------------

    /// Returns the highest surface at or below the point [m], on the point's vertical line. Of equally high
    /// triangles, returns the one with the smallest number. Returns std::nullopt outside of or below all triangles. A
    /// query at the returned height returns that height again. Adds the query's cost to `cost`. Cost: Grid::visit()
    /// of the line below the point.
    [[nodiscard]] Found surfaceBelow(const Point& point, QueryCost* cost = nullptr) const;

    /// Returns the height of the centre of a sphere that rests on the ground, and the triangle that carries the
    /// sphere. The sphere may move only along the vertical line through `center` [m]. The result is the highest rest
    /// whose contact point is at or below `center`: a bridge overhead does not count, and a sunken sphere is lifted.
    /// On a slope with unit normal n, the result is the height of the ground + radius / n_up. Returns std::nullopt if
    /// no triangle is below the sphere, within the radius, or the radius [m] is negative, NaN or above kFarthest.
    /// Adds the query's cost to `cost`. Cost: Grid::visit() of the square column below the sphere.
    [[nodiscard]] Found restingHeight(const Point& center, Scalar radius,
                                      QueryCost* cost = nullptr) const;

    /// As surfaceBelow(), for many points: found[i] belongs to points[i]. Fastest if neighbouring points follow each
    /// other. Returns the cost. Cost: at most as surfaceBelow() for each point. Uses 10 kB of stack, or 300 kB from
    /// 1,024 points on.
    QueryCost surfacesBelow(std::span<const Point> points, std::span<Found> found,
                            ParallelFor parallelFor = serialFor) const;

    /// As restingHeight(), for many spheres: found[i] belongs to centers[i] and radii[i]. Otherwise as
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

    /// The tile of a point, in a grid of tiles over the whole ground.
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

    // Not inlined, so that calls with few points do not take its 300 kB of stack. (Clang reads this only here.)
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
    /// Sets the column below the point. It extends `reach` to each side, which includes a margin for rounding.
    void setColumn(Aabb<Scalar>& column, const Point& point, Scalar reach) const noexcept {
        column.min() = point.array() - reach;
        column.max() = point.array() + reach;
        column.min()[up_] = -std::numeric_limits<Scalar>::infinity();
        column.max()[up_] = point[up_];
    }

    /// The number of the proxy's triangle, or kNone if the proxy is not the terrain's.
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] std::uint32_t numberOf(ProxyId id) const noexcept {
        return id.index < triangleOfProxy_.size() ? triangleOfProxy_[id.index] : kNone;
    }

    Grid<Scalar>* grid_;
    int up_;
    int alongX_;  // the other two axes
    int alongZ_;
    // Around all triangles, and some removed triangles. Decides only the order in which many points are processed.
    Aabb<Scalar> bounds_;
    Aabb<Scalar> nextBounds_;  // around triangles below boundsNext_, and newly set triangles
    std::uint32_t boundsNext_ = 0;
    Point tilesPerMetre_ = Point::Zero();
    std::optional<Scalar> setTolerance_;
    detail::SeamGroups<Scalar> seamGroups_;
    detail::FreeRuns free_;
    std::vector<detail::GroundTriangle<Scalar>> triangles_;
    std::vector<ProxyId> proxies_;  // by triangle; null for refused triangles
    std::vector<std::uint32_t>
        triangleOfProxy_;  // by ProxyId::index; kNone if the proxy is not a triangle
    std::vector<ChangedGround<Scalar>*> changed_;
};

extern template class Terrain<float>;
extern template class Terrain<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
