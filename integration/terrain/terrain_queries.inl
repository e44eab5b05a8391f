// SPDX-License-Identifier: Zlib
#pragma once

// What a terrain answers: terrain.cpp compiles it.

#include <integration/terrain/terrain.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/core/shared_cost.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hashphase {

/// A collector that notes the triangles that it is offered, has them fetched from memory, and looks at
/// them when all searches of a batch have noted theirs.
template <class Scalar>
template <class Search>
struct Terrain<Scalar>::Candidates {
    void add(ProxyId id, Scalar /*key*/) noexcept {
        const auto& search = static_cast<const Search&>(*this);
        const std::uint32_t number = search.terrain->numberOf(id);
        if (number == kNone) {
            return;
        }
        const detail::GroundTriangle<Scalar>* triangle = &search.terrain->triangles_[number];
        detail::prefetch(triangle);
        detail::prefetch(reinterpret_cast<const char*>(triangle + 1) - 1);
        if (!numbers.push(number)) {
            lookAtAll();
            numbers.push(number);
        }
    }
    [[nodiscard]] static constexpr double limit() noexcept {
        return std::numeric_limits<double>::infinity();
    }

    void lookAtAll() noexcept {
        static_cast<Search&>(*this).lookAtNoted();
        numbers.clear();
    }

    static constexpr std::size_t kMost = 12;
    detail::FixedList<std::uint32_t, kMost> numbers;
};

/// The highest of the triangles beside which a point lies, no farther than its tolerance: where two
/// meshes meet, rounding may leave a point in neither.
template <class Scalar>
class Terrain<Scalar>::Seam {
public:
    void begin(double tolerance) noexcept {
        tolerance_ = tolerance;
        triangle_ = kNone;
    }

    [[HASHPHASE_NO_INLINE]] void lookAt(const Terrain& terrain, std::uint32_t number,
                                        const detail::Point2& point, Scalar from) noexcept {
        const detail::GroundTriangle<Scalar>& triangle = terrain.triangles_[number];
        if (!triangle.hasHeights || tolerance_ == 0) {
            return;
        }
        const double height = detail::heightBeside(triangle, point, tolerance_);
        const bool isBetter =
            triangle_ == kNone || height > height_ || (height == height_ && number < triangle_);
        if (height > detail::kNoHeight && static_cast<Scalar>(height) <= from && isBetter) {
            triangle_ = number;
            height_ = height;
        }
    }

    /// Whether there is one, and what is below, at `height`, is none or another surface: lower by more
    /// than the two rise on either side of the point.
    [[nodiscard]] bool isAbove(const Terrain& terrain, std::uint32_t below,
                               double height) const noexcept {
        if (triangle_ == kNone) [[likely]] {
            return false;
        }
        return below == kNone ||
               height_ > height + 2 * tolerance_ *
                                      (1 + slopeOf(terrain, triangle_) + slopeOf(terrain, below));
    }

    [[nodiscard]] double tolerance() const noexcept { return tolerance_; }
    [[nodiscard]] std::uint32_t triangle() const noexcept { return triangle_; }
    [[nodiscard]] double height() const noexcept { return height_; }

private:
    static double slopeOf(const Terrain& terrain, std::uint32_t number) noexcept {
        const Vector3<double>& normal = terrain.triangles_[number].normal;
        return std::hypot(normal.x(), normal.z()) / normal.y();  // infinite or NaN without a normal
    }

    double tolerance_ = 0;
    std::uint32_t triangle_ = kNone;
    double height_ = 0;  // of the triangle
};

/// The highest surface among the triangles below a point.
template <class Scalar>
struct Terrain<Scalar>::SurfaceSearch : Candidates<SurfaceSearch> {
    const Terrain* terrain = nullptr;
    detail::Point2 point;
    Scalar from = 0;  // no surface above counts
    Ground<Scalar> best{kNone, -std::numeric_limits<Scalar>::infinity()};
    Seam seam;

    void begin(const Terrain& itsTerrain, const detail::Point2& itsPoint, Scalar itsFrom,
               double tolerance) noexcept {
        terrain = &itsTerrain;
        point = itsPoint;
        from = itsFrom;
        seam.begin(tolerance);
        best = {kNone, -std::numeric_limits<Scalar>::infinity()};
    }

    void lookAt(std::uint32_t number) noexcept {
        // Without a branch: which of two triangles the point lies in cannot be predicted.
        const detail::GroundTriangle<Scalar>& triangle = terrain->triangles_[number];
        const detail::Weights weights = detail::weightsAt(triangle, point);
        const auto height = static_cast<Scalar>(detail::heightAt(triangle, weights));
        const bool counts = triangle.hasHeights & weights.areInside() & (height <= from);
        const bool isBetter =
            (height > best.height) | ((height == best.height) & (number < best.triangle));
        const std::array<Ground<Scalar>, 2> choice{best, Ground<Scalar>{number, height}};
        best = choice[static_cast<std::size_t>(counts & isBetter)];
        if (weights.mayBeBeside(detail::slackOf(triangle, seam.tolerance()))) [[unlikely]] {
            seam.lookAt(*terrain, number, point, from);
        }
    }

    void lookAtNoted() noexcept {
        for (const std::uint32_t number : this->numbers) {
            lookAt(number);
        }
    }

    [[nodiscard]] Found result() noexcept {
        this->lookAtAll();
        if (seam.isAbove(*terrain, best.triangle, static_cast<double>(best.height))) {
            return Ground<Scalar>{seam.triangle(), static_cast<Scalar>(seam.height())};
        }
        return best.triangle == kNone ? std::nullopt : Found(best);
    }
};

/// The same for a sphere that rests on triangles below its centre.
template <class Scalar>
struct Terrain<Scalar>::RestSearch : Candidates<RestSearch> {
    struct Peak {
        std::uint32_t triangle;
        detail::Weights weights;
    };

    const Terrain* terrain = nullptr;
    detail::Point2 center;
    double radius = 0;
    Scalar from = 0;  // no triangle that is touched above counts
    std::uint32_t best = kNone;
    double height = detail::kNoHeight;
    Seam seam;

    void begin(const Terrain& itsTerrain, const detail::Point2& itsCenter, double itsRadius,
               Scalar itsFrom, double tolerance) noexcept {
        terrain = &itsTerrain;
        center = itsCenter;
        radius = itsRadius;
        from = itsFrom;
        best = kNone;
        height = detail::kNoHeight;
        seam.begin(tolerance);
    }

    // Faces first: most spheres rest on one, high enough to be clear of all edges.
    void lookAtNoted() noexcept {
        std::array<Peak, RestSearch::kMost> outside;
        std::size_t outsideCount = 0;
        for (const std::uint32_t number : this->numbers) {
            const detail::GroundTriangle<Scalar>& triangle = terrain->triangles_[number];
            const detail::Weights weights = detail::weightsAtPeak(triangle, center, radius);
            if (weights.areInside()) {
                take(number, detail::restOnFace(triangle, weights, radius));
            } else {
                outside[outsideCount++] = {number, weights};
            }
        }
        // What is clear of an edge is left out, unless rounding might decide that for so small a sphere.
        const bool isTiny = radius * static_cast<double>(kSeamRoundings) < 1e-6 * seam.tolerance();
        for (std::size_t i = 0; i < outsideCount; ++i) {
            const auto& [number, weights] = outside[i];
            take(number, detail::restOnEdges(terrain->triangles_[number], weights, center, radius,
                                             isTiny ? detail::kNoHeight : height));
        }
        // A larger sphere does not fall between two edges.
        for (std::size_t i = 0; radius < seam.tolerance() && i < outsideCount; ++i) {
            seam.lookAt(*terrain, outside[i].triangle, center, from);
        }
    }

    void take(std::uint32_t number, const detail::Rest& rest) noexcept {
        const bool counts =
            rest.center > detail::kNoHeight && static_cast<Scalar>(rest.touch) <= from;
        if (counts && (rest.center > height || (rest.center == height && number < best))) {
            best = number;
            height = rest.center;
        }
    }

    [[nodiscard]] Found result() noexcept {
        this->lookAtAll();
        if (seam.isAbove(*terrain, best, height - radius)) {
            return Ground<Scalar>{seam.triangle(), static_cast<Scalar>(seam.height() + radius)};
        }
        return best == kNone ? std::nullopt : Found({best, static_cast<Scalar>(height)});
    }
};

/// The order in which many points are looked at: tile by tile of the ground, so that what one of them
/// reads of the memory is still at hand for the next. On the stack.
template <class Scalar>
class Terrain<Scalar>::TileOrder {
public:
    static constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max();

    // A counting sort.
    [[HASHPHASE_NO_INLINE]] TileOrder(const Terrain& terrain, std::span<const Point> points,
                                      ParallelFor parallelFor) {
        constexpr std::size_t grain = 8192;
        std::uint16_t tiles[kMost];
        parallelFor(points.size(), grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                tiles[i] = terrain.tileOf(points[i]);
            }
        });
        std::array<std::uint16_t, kTiles + 1> starts{};
        for (std::size_t i = 0; i < points.size(); ++i) {
            ++starts[tiles[i] + 1U];
        }
        std::partial_sum(starts.begin(), starts.end(), starts.begin(), [](auto sum, auto count) {
            return static_cast<std::uint16_t>(sum + count);
        });
        for (std::size_t i = 0; i < points.size(); ++i) {
            order_[starts[tiles[i]]++] = static_cast<std::uint16_t>(i);
        }
    }

    std::size_t operator[](std::size_t i) const noexcept { return order_[i]; }

private:
    std::uint16_t order_[kMost];
};

// Asks the grid about a few of `count` points at a time, so that all that it takes is on the stack:
// the k-th of them is point numberOf(k).
template <class Scalar>
template <class Search, class MakeSearch, class NumberOf>
QueryCost Terrain<Scalar>::searchInOrder(std::size_t count, const NumberOf& numberOf,
                                         std::span<Found> found, ParallelFor parallelFor,
                                         const MakeSearch& makeSearch) const {
    constexpr std::size_t grain = 1024;
    constexpr std::size_t atOnce = 16;
    detail::SharedCost sum;
    parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
        std::array<BoxRegion<Scalar>, atOnce> columns;
        std::array<Search, atOnce> searches;
        QueryCost cost;
        for (std::size_t first = begin; first < end; first += atOnce) {
            const std::size_t few = std::min(atOnce, end - first);
            for (std::size_t i = 0; i < few; ++i) {
                makeSearch(numberOf(first + i), columns[i].box, searches[i]);
            }
            cost += grid_->visitEach(std::span<const BoxRegion<Scalar>>(columns).first(few),
                                     std::span(searches).first(few));
            for (std::size_t i = 0; i < few; ++i) {
                found[numberOf(first + i)] = searches[i].result();
            }
        }
        sum.add(cost);
    });
    return sum.sum();
}

template <class Scalar>
template <class Search, class MakeSearch>
QueryCost Terrain<Scalar>::searchByTiles(std::span<const Point> points, std::span<Found> found,
                                         ParallelFor parallelFor,
                                         const MakeSearch& makeSearch) const {
    QueryCost cost;
    for (std::size_t first = 0; first < points.size(); first += TileOrder::kMost) {
        const std::size_t count = std::min(points.size() - first, TileOrder::kMost);
        const TileOrder order(*this, points.subspan(first, count), parallelFor);
        const auto numberOf = [&](std::size_t k) { return first + order[k]; };
        cost += searchInOrder<Search>(count, numberOf, found, parallelFor, makeSearch);
    }
    return cost;
}

template <class Scalar>
template <class Search, class MakeSearch>
QueryCost Terrain<Scalar>::searchEach(std::span<const Point> points, std::span<Found> found,
                                      ParallelFor parallelFor, const MakeSearch& makeSearch) const {
    constexpr std::size_t worthSorting = 1024;
    if (points.size() >= worthSorting) {
        return searchByTiles<Search>(points, found, parallelFor, makeSearch);
    }
    const auto numberOf = [](std::size_t k) { return k; };
    return searchInOrder<Search>(points.size(), numberOf, found, parallelFor, makeSearch);
}

template <class Scalar>
QueryCost Terrain<Scalar>::surfacesBelow(std::span<const Point> points, std::span<Found> found,
                                         ParallelFor parallelFor) const {
    HASHPHASE_ASSERT(points.size() == found.size(),
                     "Terrain::surfacesBelow(): points and found have different lengths. Pass one "
                     "Found for each point.");
    return searchEach<SurfaceSearch>(
        points, found, parallelFor,
        [&](std::size_t i, Aabb<Scalar>& column, SurfaceSearch& search) {
            const Point& point = points[i];
            const Scalar tolerance = seamTolerance(point);
            setColumn(column, point, Scalar(1.125) * tolerance);  // an eighth for rounding
            search.begin(*this, above(point), point[up_], static_cast<double>(tolerance));
        });
}

template <class Scalar>
QueryCost Terrain<Scalar>::restingHeights(std::span<const Point> centers,
                                          std::span<const Scalar> radii, std::span<Found> found,
                                          ParallelFor parallelFor) const {
    HASHPHASE_ASSERT(centers.size() == found.size() && radii.size() == found.size(),
                     "Terrain::restingHeights(): centers, radii and found have different lengths. "
                     "Pass one of each for each sphere.");
    using Limits = std::numeric_limits<Scalar>;
    return searchEach<RestSearch>(
        centers, found, parallelFor, [&](std::size_t i, Aabb<Scalar>& column, RestSearch& search) {
            const Point& center = centers[i];
            const bool isGood = radii[i] >= 0 && radii[i] <= Limits::max() &&
                                static_cast<double>(radii[i]) <= kFarthest;
            const Scalar radius = isGood ? radii[i] : Limits::quiet_NaN();
            const Scalar tolerance = seamTolerance(center);
            const Scalar reach = std::max(radius, tolerance);  // NaN of a bad radius
            setColumn(column, center, reach + 2 * Limits::epsilon() * (along(center) + reach));
            search.begin(*this, above(center), static_cast<double>(radius), center[up_],
                         static_cast<double>(tolerance));
        });
}

template <class Scalar>
typename Terrain<Scalar>::Found Terrain<Scalar>::surfaceBelow(const Point& point,
                                                              QueryCost* cost) const {
    Found found;
    const QueryCost own = surfacesBelow({&point, 1}, {&found, 1});
    if (cost != nullptr) {
        *cost += own;
    }
    return found;
}

template <class Scalar>
typename Terrain<Scalar>::Found Terrain<Scalar>::restingHeight(const Point& center, Scalar radius,
                                                               QueryCost* cost) const {
    Found found;
    const QueryCost own = restingHeights({&center, 1}, {&radius, 1}, {&found, 1});
    if (cost != nullptr) {
        *cost += own;
    }
    return found;
}

}  // namespace hashphase
