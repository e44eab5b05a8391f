// SPDX-License-Identifier: Zlib
#pragma once

// Divides space into regions, one for each rank (process) of a simulation.
//
// Regions  A tree of axis-aligned planes cuts space into boxes. Regions are half-open: a region includes its min
//          faces, not its max faces. Every point is in exactly one region. Outer regions are infinite.
// Pairs    A pair has a point: on each axis, the larger coordinate of the two min corners. The rank whose region
//          contains the point has both boxes. Only this rank reports the pair. Deciding this needs no messages.
// Exact    Coordinates are compared with cuts, and never rounded.
// Threads  Any number of threads may call const members at the same time.
// Source   Recursive bisection after M. Berger and S. Bokhari, "A partitioning strategy for nonuniform problems on
//          multiprocessors", 1987. Points of pairs as in waLBerla, C. Godenschwager et al., 2013.

#include <broadphase/aabb.hpp>
#include <integration/distributed/export.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase {

/// A plane perpendicular to an axis. Points with a coordinate less than `at` are below the plane, all other points
/// above it.
template <class Scalar>
struct Cut {
    Scalar at = 0;           ///< [m]
    std::uint32_t axis = 0;  ///< 0, 1 or 2

    friend bool operator==(const Cut&, const Cut&) = default;
};

/// A point, and the amount of work there.
template <class Scalar>
struct WeightedPoint {
    Vector3<Scalar> at;  ///< min corner of an object [m]
    double weight = 0;   ///< work in any unit, 0 or more
};

/// Returns the box around both corners of `box`. `box` may be inverted. The result contains the pairPoint() of each
/// pair in which `box` is one of the two boxes.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> hullOf(const Aabb<Scalar>& box) noexcept {
    return {box.min().cwiseMin(box.max()), box.min().cwiseMax(box.max())};
}

/// Returns the point that decides which rank owns the pair of two overlapping boxes. The point is in the hulls of
/// both boxes.
template <class Scalar>
[[nodiscard]] Vector3<Scalar> pairPoint(const Aabb<Scalar>& a, const Aabb<Scalar>& b) noexcept {
    return a.min().cwiseMax(b.min());
}

/// Assigns each region of space to a rank.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT Partition {
public:
    /// Makes one region for one rank: all of space.
    Partition() = default;

    /// Takes the cuts in the order of cuts(): n - 1 cuts for n ranks. Throws std::invalid_argument if Cut::at is NaN
    /// or Cut::axis is above 2.
    explicit Partition(std::span<const Cut<Scalar>> cuts);

    /// Cuts space so that each rank gets about the same weight. Each cut is perpendicular to the axis along which
    /// points are spread most, at the coordinate that divides the weight best. Ignores points with a NaN. If
    /// last->rankCount() is `ranks`, cuts keep the axes of `last`, unless the spread along another axis is clearly
    /// larger. So fewer objects change ranks. Equal points in equal order give equal results. Asserted: `ranks` is 1
    /// or more. Cost: O(points * log(points) * log(ranks)).
    [[nodiscard]] static Partition balanced(std::uint32_t ranks,
                                            std::span<const WeightedPoint<Scalar>> points,
                                            const Partition* last = nullptr);

    [[nodiscard]] std::uint32_t rankCount() const noexcept {
        return static_cast<std::uint32_t>(cuts_.size() + 1);
    }

    /// Returns the rank whose region contains the point [m]. A NaN is above every cut. Cost: O(log ranks).
    [[nodiscard]] std::uint32_t rankOf(const Vector3<Scalar>& point) const noexcept;

    /// Returns the region of a rank [m]: points with min() <= point < max(). If a cut is outside the region that it
    /// divides, one part is empty.
    [[nodiscard]] Aabb<Scalar> region(std::uint32_t rank) const noexcept;

    /// Calls visit(rank) in ascending order for each rank whose region touches the hull of the box. If the box has a
    /// NaN, visits no rank. Cost: O(visited ranks * log ranks).
    template <class Visit>
    void forEachRank(const Aabb<Scalar>& box, const Visit& visit) const {
        const Aabb<Scalar> hull = hullOf(box);
        if (!hasNan(box)) {
            visitNode(
                0, rankCount(), 0, wholeSpace(),
                [&](const Aabb<Scalar>& /*region*/, const Cut<Scalar>& cut) {
                    return std::array{hull.min()[cut.axis] < cut.at,
                                      hull.max()[cut.axis] >= cut.at};
                },
                visit);
        }
    }

    /// Calls visit(rank) in ascending order for each rank whose part of space touches `region`, a query region such
    /// as RayRegion: region.key(part) >= 0. Here, the part includes its max faces. Cost: as forEachRank().
    template <class Region, class Visit>
    void forEachRankWithKey(const Region& region, const Visit& visit) const {
        const auto sides = [&](const Aabb<Scalar>& box, const Cut<Scalar>& cut) {
            return std::array{region.key(below(box, cut)) >= 0, region.key(above(box, cut)) >= 0};
        };
        if (rankCount() > 1 || region.key(wholeSpace()) >= 0) {
            visitNode(0, rankCount(), 0, wholeSpace(), sides, visit);
        }
    }

    /// Returns the cuts in preorder: each cut, then the cuts below it, then the cuts above it. If a cut divides n
    /// ranks, the first n / 2 ranks (rounded down) are below the cut.
    [[nodiscard]] std::span<const Cut<Scalar>> cuts() const noexcept { return cuts_; }

    friend bool operator==(const Partition&, const Partition&) = default;

private:
    [[nodiscard]] static Aabb<Scalar> wholeSpace() noexcept {
        constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
        return {Vector3<Scalar>::Constant(-kInfinity), Vector3<Scalar>::Constant(kInfinity)};
    }
    [[nodiscard]] static Aabb<Scalar> below(Aabb<Scalar> box, const Cut<Scalar>& cut) noexcept {
        box.max()[cut.axis] = std::min(box.max()[cut.axis], cut.at);
        return box;
    }
    [[nodiscard]] static Aabb<Scalar> above(Aabb<Scalar> box, const Cut<Scalar>& cut) noexcept {
        box.min()[cut.axis] = std::max(box.min()[cut.axis], cut.at);
        return box;
    }

    // Visits the ranks `first` to `last` - 1. Their first cut is cuts_[node].
    template <class Sides, class Visit>
    void visitNode(std::uint32_t first, std::uint32_t last, std::size_t node,
                   const Aabb<Scalar>& region, const Sides& sides, const Visit& visit) const {
        if (last - first == 1) {
            visit(first);
            return;
        }
        const Cut<Scalar>& cut = cuts_[node];
        const std::uint32_t middle = first + (last - first) / 2;
        const auto [goesBelow, goesAbove] = sides(region, cut);
        if (goesBelow) {
            visitNode(first, middle, node + 1, below(region, cut), sides, visit);
        }
        if (goesAbove) {
            visitNode(middle, last, node + (middle - first), above(region, cut), sides, visit);
        }
    }

    std::vector<Cut<Scalar>> cuts_;
};

extern template class Partition<float>;
extern template class Partition<double>;

}  // namespace hashphase

#include <broadphase/core/restore_macros.hpp>
