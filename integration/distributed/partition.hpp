// SPDX-License-Identifier: Zlib
#pragma once

// Space cut into regions, one for each rank (process) of a simulation.
//
// Regions  A tree of cuts by planes across an axis. A region is a box with its lower faces, without its upper ones:
//          every point is in exactly one. Outer regions are infinite.
// Pairs    A pair has a point: the larger of both min corners on each axis. The rank whose region contains it has
//          both boxes, and reports the pair: once, without messages.
// Exact    Coordinates are only compared with cuts: nothing is rounded.
// Threads  const members from any number of threads
// Source   Recursive bisection after M. Berger and S. Bokhari, "A partitioning strategy for nonuniform problems on
//          multiprocessors", 1987. The pair's point as in waLBerla, C. Godenschwager et al., 2013.

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

/// A plane across an axis. Points with a coordinate less than `at` are below it, all others above.
template <class Scalar>
struct Cut {
    Scalar at = 0;           ///< [m]
    std::uint32_t axis = 0;  ///< 0, 1 or 2

    friend bool operator==(const Cut&, const Cut&) = default;
};

/// A place with work, and its amount.
template <class Scalar>
struct WeightedPoint {
    Vector3<Scalar> at;  ///< a min corner [m]
    double weight = 0;   ///< in any unit, 0 or more
};

/// Returns the box around both corners. It contains all points by which pairs of the box are owned, even if the box
/// is inverted.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> hullOf(const Aabb<Scalar>& box) noexcept {
    return {box.min().cwiseMin(box.max()), box.min().cwiseMax(box.max())};
}

/// Returns the point that decides which rank owns the pair of two overlapping boxes. It lies in the hull of each.
template <class Scalar>
[[nodiscard]] Vector3<Scalar> pairPoint(const Aabb<Scalar>& a, const Aabb<Scalar>& b) noexcept {
    return a.min().cwiseMax(b.min());
}

/// Assigns each part of space to a rank.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT Partition {
public:
    /// One rank, which owns all of space.
    Partition() = default;

    /// Takes the cuts in the order of cuts(), one fewer than ranks. Throws std::invalid_argument if a cut is NaN or
    /// its axis is above 2.
    explicit Partition(std::span<const Cut<Scalar>> cuts);

    /// Cuts space so that each of `ranks` gets about the same weight: across the axis along which points are spread
    /// farthest, at the point that shares the weight best. Ignores points with a NaN. Keeps the axes of `last`, if it
    /// has as many ranks, unless another axis is clearly longer: fewer objects change ranks. Equal points in equal
    /// order give equal results. Asserted: `ranks` is 1 or more. Cost: O(points * log(points) * log(ranks)).
    [[nodiscard]] static Partition balanced(std::uint32_t ranks,
                                            std::span<const WeightedPoint<Scalar>> points,
                                            const Partition* last = nullptr);

    [[nodiscard]] std::uint32_t rankCount() const noexcept {
        return static_cast<std::uint32_t>(cuts_.size() + 1);
    }

    /// Returns the rank whose region contains the point [m]. A NaN counts as above every cut. Cost: O(log ranks).
    [[nodiscard]] std::uint32_t rankOf(const Vector3<Scalar>& point) const noexcept;

    /// Returns the region of a rank [m]: points with min() <= point < max(). Empty if a cut lies outside the region
    /// that it divides.
    [[nodiscard]] Aabb<Scalar> region(std::uint32_t rank) const noexcept;

    /// Calls visit(rank), ascending, for each rank whose region the hull of the box touches; for none with a NaN.
    /// Cost: O(ranks visited * log ranks).
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

    /// Calls visit(rank), ascending, for each rank whose closed region has a key: region.key(box) >= 0, as for a
    /// RayRegion. Cost: as forEachRank().
    template <class Region, class Visit>
    void forEachRankWithKey(const Region& region, const Visit& visit) const {
        const auto sides = [&](const Aabb<Scalar>& box, const Cut<Scalar>& cut) {
            return std::array{region.key(below(box, cut)) >= 0, region.key(above(box, cut)) >= 0};
        };
        if (rankCount() > 1 || region.key(wholeSpace()) >= 0) {
            visitNode(0, rankCount(), 0, wholeSpace(), sides, visit);
        }
    }

    /// The cuts from the root of the tree: each cut, then those below it, then those above it. The first half of the
    /// ranks is below; of an odd number, the smaller half.
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

    // Visits the ranks from `first` to `last` - 1; cuts_[node] lies between them.
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
