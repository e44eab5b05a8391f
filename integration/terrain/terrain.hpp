// SPDX-License-Identifier: Zlib
#pragma once

// The ground: triangles that stand still, filed in the grid once, each by its box. Says how high the
// ground is below a point, and where a sphere rests on it. After the object-terrain test of Hastings,
// Mesit and Guha, which holds on flat ground; here a sphere rests on slopes, edges and corners too.
//
// A frame    Add triangles once. Then ask, for many points at once where there are many.
// Others     The grid may hold other proxies, and changes in whatever way; they cost time only.
// Exact      A point on an edge or a corner belongs to all triangles there: no point of a closed
//            surface is lost between two triangles. Heights are found in double precision.
// Seams      Meshes that meet, and were placed by different transforms, have edges that differ by
//            rounding. A point between them belongs to the nearest, see seamTolerance(); what is
//            wider stays a gap. Where a triangle is exactly below, at about that height, it counts.
// Units      metres. Heights are coordinates along the axis that is up.
// Threads    Queries are const and may run on any number of threads.
// Memory     A query allocates nothing, unless a few points meet hundreds of boxes; one about more
//            than a thousand points takes 0.3 MB of the stack.
// Bad data   Triangles with a bad corner are refused and named; bad points and radii have no ground.
// Misuse     Corners that do not come in threes, batches of unequal lengths, numbers that no triangle
//            has, and more than 2^32 - 2 triangles are asserted.

#include <broadphase/grid.hpp>
#include <broadphase/parallel_for.hpp>
#include <broadphase/up_axis.hpp>
#include <integration/terrain/detail/ground_triangle.hpp>
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

/// Where something stands: on which triangle, by its number, and how high.
template <class Scalar>
struct Ground {
    std::uint32_t triangle = 0;
    Scalar height = 0;  ///< [m]

    friend bool operator==(const Ground&, const Ground&) = default;
};

/// What Terrain::add() did. Triangles are numbered in the order in which they were handed in, those
/// that were refused included.
struct AddedTriangles {
    std::uint32_t first = 0;             ///< number of the first one
    std::uint32_t count = 0;             ///< handed in
    std::vector<std::uint32_t> refused;  ///< numbers of those that the ground goes without
};

/// Triangles that stand still, and what stands on them.
template <class Scalar>
class HASHPHASE_TERRAIN_EXPORT Terrain {
public:
    using Point = Vector3<Scalar>;
    using Corners = std::array<Point, 3>;
    using Found = std::optional<Ground<Scalar>>;

    /// Coordinates and radii up to this are good [m]: all finite ones in single precision.
    static constexpr double kFarthest = 1e70;

    /// The grid is not owned and must outlive the terrain, which removes its proxies in the end.
    explicit Terrain(Grid<Scalar>& grid, UpAxis up = UpAxis::y);
    ~Terrain();
    Terrain(const Terrain&) = delete;
    Terrain& operator=(const Terrain&) = delete;

    // --- Triangles -------------------------------------------------------------------------------

    /// Adds triangles, three corners each. Refused is what has a corner that is NaN, infinite or
    /// farther than kFarthest. Vertical triangles, and those without an area, carry spheres but have
    /// no height themselves. Either side may be up. Where memory runs out, nothing has been added.
    /// Cost: O(1) amortised for each.
    AddedTriangles add(std::span<const Point> corners);

    /// The same, corners by their place in `vertices`. Refused is also what names no vertex.
    AddedTriangles add(std::span<const Point> vertices, std::span<const std::uint32_t> indices);

    /// Removes all triangles; numbers begin at 0 again.
    void clear();

    /// To be called with each Grid::shiftOrigin() of the grid: subtracts `shift` [m] from the corners,
    /// as the grid does from their boxes. Cost: O(triangles).
    void shiftOrigin(const Point& shift);

    /// How many triangles were handed in: all numbers are below. Refused ones included.
    [[nodiscard]] std::uint32_t size() const noexcept {
        return static_cast<std::uint32_t>(triangles_.size());
    }

    /// The corners, in the order in which they were added; NaN of a refused one.
    [[nodiscard]] Corners corners(std::uint32_t triangle) const;

    /// Unit normal of the side that is up; zero where the triangle has no heights.
    [[nodiscard]] Point normal(std::uint32_t triangle) const;

    /// Its proxy in the grid; null of a refused one.
    [[nodiscard]] ProxyId proxy(std::uint32_t triangle) const;

    /// How far beside a triangle a point may lie, as seen from above, and still belong to it where no
    /// other one is there [m]. That is what rounding may take away from an edge near the point: 8
    /// epsilon of Scalar times the point's larger coordinate along the ground, now or before the shifts
    /// of the origin, and the largest extent and height of what one add() has brought, at most 16 km.
    /// A corner that a transform placed is six sums and products of numbers of that size, along two
    /// axes, each off by half an epsilon of them. In single precision a twentieth of a millimetre for
    /// chunks of 32 m near the origin, 1 mm at 1 km; in double precision 2 pm.
    [[nodiscard]] Scalar seamTolerance(const Point& point) const noexcept {
        Scalar farthest = along(point);
        if (isShifted_) {
            farthest = std::max(farthest, along(point + shifted_));
        }
        return kSeamRoundings * (farthest + meshReach_);
    }

    // --- Queries ---------------------------------------------------------------------------------

    /// The highest surface at or below the point, on the vertical line through it; of several the
    /// one with the smallest number. None outside of all triangles, and below them. Asked again at
    /// the height that it gave, it gives the same. Adds what it cost to `cost`. Cost: the triangles
    /// whose boxes the line below the point meets; at most one test for each proxy of the grid.
    [[nodiscard]] Found surfaceBelow(const Point& point, QueryCost* cost = nullptr) const;

    /// How high the centre of a sphere is that rests on the ground, and on which triangle, when it
    /// may move along the vertical line through `center` only. Each triangle carries the sphere at
    /// one height, touching it at one point; what counts is the highest of those whose touching
    /// points are not above `center`: a bridge overhead does not, and a sphere that is sunk into a
    /// hill is lifted. On a slope with the unit normal n, that is the height of the ground + radius /
    /// n_up; with radius 0 the ground itself. None where nothing is below within the radius, and for
    /// a radius that is negative, NaN or above kFarthest. Cost: the triangles whose boxes overlap
    /// the square column below the sphere; at most as above.
    [[nodiscard]] Found restingHeight(const Point& center, Scalar radius,
                                      QueryCost* cost = nullptr) const;

    /// surfaceBelow() for many: found[i] is that of points[i]. The result does not depend on
    /// `parallelFor`. Fastest when near ones follow each other; each costs at most as above.
    QueryCost surfacesBelow(std::span<const Point> points, std::span<Found> found,
                            ParallelFor parallelFor = serialFor) const;

    /// restingHeight() for many: found[i] is that of centers[i] and radii[i].
    QueryCost restingHeights(std::span<const Point> centers, std::span<const Scalar> radii,
                             std::span<Found> found, ParallelFor parallelFor = serialFor) const;

    /// Bytes held beside what the grid holds, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    static constexpr Scalar kSeamRoundings = 8 * std::numeric_limits<Scalar>::epsilon();
    static constexpr double kLargestMesh =
        16384;  // [m]; a stray corner makes no tolerance of 1e30 m

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

    template <class Search, class MakeSearch>
    QueryCost searchByTiles(std::span<const Point> points, std::span<Found> found,
                            ParallelFor parallelFor, const MakeSearch& makeSearch) const;

    template <class Search, class MakeSearch>
    QueryCost searchEach(std::span<const Point> points, std::span<Found> found,
                         ParallelFor parallelFor, const MakeSearch& makeSearch) const;

    template <class CornersOf>
    AddedTriangles addAll(std::size_t count, const CornersOf& cornersOf);
    void noteReach(const Aabb<Scalar>& mesh);
    void addOne(const Corners& corners, AddedTriangles& added, Aabb<Scalar>& boxOfAll);
    void removeFrom(std::size_t first);
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
    [[nodiscard]] std::uint32_t triangleOf(ProxyId id) const noexcept {
        return id.index < triangleOfProxy_.size() ? triangleOfProxy_[id.index] : kNone;
    }

    Grid<Scalar>* grid_;
    Eigen::Index up_;
    Eigen::Index alongX_;  // the other two axes
    Eigen::Index alongZ_;
    Aabb<Scalar> bounds_;  // of all triangles
    Point tilesPerMetre_ = Point::Zero();
    Scalar meshReach_ = 0;           // the largest extent and height of what one add() has brought
    Point shifted_ = Point::Zero();  // by all shifts of the origin
    bool isShifted_ = false;
    std::vector<detail::GroundTriangle<Scalar>> triangles_;
    std::vector<ProxyId> proxies_;  // by triangle; null of refused ones
    std::vector<std::uint32_t>
        triangleOfProxy_;  // by ProxyId::index: nobody else's while ours lives
};

extern template class Terrain<float>;
extern template class Terrain<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
