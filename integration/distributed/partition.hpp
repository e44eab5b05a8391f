// SPDX-License-Identifier: Zlib
#pragma once

// Space cut into as many regions as there are ranks: a part of it for each process of a simulation.
//
// Regions    A tree of cuts by planes across an axis. Each region is a box that has its lower faces, not its
//            upper ones, so that every point, however far away, lies in one region. The outer ones are infinite.
// Pairs      Two boxes that overlap share a point: the componentwise maximum of their min corners. The rank in
//            whose region it lies has both boxes, and is the one to report the pair. So each pair is reported
//            once, with no fixed width of a halo and no message about it.
// Exact      Points and boxes are compared with cuts, and nothing is computed: no rounding, no cells.
// Threads    const members from any number of threads
//
// Recursive bisection after M. Berger and S. Bokhari, "A partitioning strategy for nonuniform problems on
// multiprocessors", 1987; the pair's point as in waLBerla, C. Godenschwager et al., 2013.

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

/// A plane across an axis: points with a coordinate less than `at` are below it, the others above.
template <class Scalar>
struct Cut {
    Scalar at = 0;           ///< [m]
    std::uint32_t axis = 0;  ///< 0, 1 or 2

    friend bool operator==(const Cut&, const Cut&) = default;
};

/// Where there is work, and how much of it.
template <class Scalar>
struct WeightedPoint {
    Vector3<Scalar> at;  ///< a min corner [m]
    double weight = 0;   ///< in any unit, 0 or more
};

/// The box around both corners. Of an inverted box, too, it holds every point by which its pairs are owned.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> hullOf(const Aabb<Scalar>& box) noexcept {
    return {box.min().cwiseMin(box.max()), box.min().cwiseMax(box.max())};
}

/// The point by which the pair of two boxes that overlap is owned: it lies in the hull of each.
template <class Scalar>
[[nodiscard]] Vector3<Scalar> pairPoint(const Aabb<Scalar>& a, const Aabb<Scalar>& b) noexcept {
    return a.min().cwiseMax(b.min());
}

/// Says which rank owns what part of space.
template <class Scalar>
class HASHPHASE_DISTRIBUTED_TEMPLATE_EXPORT Partition {
public:
    /// One rank, which owns all of space.
    Partition() = default;

    /// The partition of these cuts, one fewer than ranks, as cuts() lists them.
    /// Throws std::invalid_argument where a cut is NaN or has no such axis.
    explicit Partition(std::span<const Cut<Scalar>> cuts);

    /// Cuts space so that each of `ranks` (1 or more, asserted) gets about the same weight: across the axis along
    /// which the points are spread farthest, at the point that shares the weight best. Points with a NaN do not
    /// count. Keeps the axes of the partition of the last time, if there was one, where others are not clearly
    /// longer: so less changes hands. The result is the same for the same points in the same order.
    /// Cost: O(points * log(points) * log(ranks)).
    [[nodiscard]] static Partition balanced(std::uint32_t ranks,
                                            std::span<const WeightedPoint<Scalar>> points,
                                            const Partition* last = nullptr);

    [[nodiscard]] std::uint32_t rankCount() const noexcept {
        return static_cast<std::uint32_t>(cuts_.size() + 1);
    }

    /// The rank whose region the point [m] lies in. A NaN counts as above every cut. Cost: O(log ranks).
    [[nodiscard]] std::uint32_t rankOf(const Vector3<Scalar>& point) const noexcept;

    /// The region of a rank [m]: points with min() <= point < max(). Empty where a cut lies outside of the region
    /// that it divides.
    [[nodiscard]] Aabb<Scalar> region(std::uint32_t rank) const noexcept;

    /// Calls visit(rank), ascending, for each rank whose region the hull of the box touches; for none where
    /// it has a NaN. Cost: O(ranks visited * log ranks).
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

    /// Calls visit(rank), ascending, for each rank whose closed region has a key: region.key(box) >= 0, as that
    /// of a RayRegion. Cost: O(ranks visited * log ranks).
    template <class Region, class Visit>
    void forEachRankWithKey(const Region& region, const Visit& visit) const {
        const auto sides = [&](const Aabb<Scalar>& box, const Cut<Scalar>& cut) {
            return std::array{region.key(below(box, cut)) >= 0, region.key(above(box, cut)) >= 0};
        };
        if (rankCount() > 1 || region.key(wholeSpace()) >= 0) {
            visitNode(0, rankCount(), 0, wholeSpace(), sides, visit);
        }
    }

    /// The cuts from the root of the tree on: each is followed by those below it, then by those above it. The
    /// first half of the ranks lies below, where their number is odd the smaller half.
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

    // The ranks from `first` up to `last`, between which cuts_[node] lies.
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
