// SPDX-License-Identifier: Zlib
#include <integration/distributed/partition.hpp>

#include <broadphase/core/raise.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase {
namespace {

template <class Scalar>
using Points = std::span<WeightedPoint<Scalar>>;

template <class Scalar>
auto byCoordinate(std::uint32_t axis) {
    return [axis](const WeightedPoint<Scalar>& a, const WeightedPoint<Scalar>& b) {
        return a.at[axis] < b.at[axis];
    };
}

// How far the middle eight tenths of the points are spread along each axis: a ground plane that reaches to infinity
// has one corner, and does not count.
template <class Scalar>
std::array<double, 3> spreadOf(Points<Scalar> points) {
    std::array<double, 3> spread{};
    for (std::uint32_t axis = 0; axis < 3 && !points.empty(); ++axis) {
        const auto atRank = [&](std::size_t rank) {
            const auto at = points.begin() + static_cast<std::ptrdiff_t>(rank);
            std::nth_element(points.begin(), at, points.end(), byCoordinate<Scalar>(axis));
            constexpr double kLargest = std::numeric_limits<double>::max() / 4;
            return std::clamp(static_cast<double>(at->at[axis]), -kLargest, kLargest);
        };
        const double low = atRank(points.size() / 10);
        spread[axis] = atRank(points.size() - 1 - points.size() / 10) - low;
    }
    return spread;
}

// The axis of the last time, unless another one is clearly longer: else regions would change hands for nothing.
template <class Scalar>
std::uint32_t axisFor(Points<Scalar> points, const Cut<Scalar>* last) {
    constexpr double kClearly = 1.5;
    const std::array<double, 3> spread = spreadOf(points);
    const auto* const longest = std::max_element(spread.begin(), spread.end());
    return last != nullptr && *longest <= kClearly * spread[last->axis]
               ? last->axis
               : static_cast<std::uint32_t>(longest - spread.begin());
}

// Returns how many of the points, sorted along the axis, lie below the best cut. Those with the same coordinate
// stay together.
template <class Scalar>
std::size_t countBelow(Points<Scalar> points, std::uint32_t axis, double share) {
    double total = 0;
    for (const WeightedPoint<Scalar>& point : points) {
        total += point.weight;
    }
    std::size_t best = 0;
    double leastError = share * total;
    double below = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        below += points[i - 1].weight;
        const double error = std::abs(below - share * total);
        if (points[i - 1].at[axis] < points[i].at[axis] && error < leastError) {
            leastError = error;
            best = i;
        }
    }
    return best;
}

// Appends the cuts between so many ranks; `last` are those of the last time, or none.
template <class Scalar>
void bisect(Points<Scalar> points, std::uint32_t ranks, const Cut<Scalar>* last,
            std::vector<Cut<Scalar>>& cuts) {
    if (ranks == 1) {
        return;
    }
    const std::uint32_t below = ranks / 2;
    const std::uint32_t axis = axisFor(points, last);
    std::sort(points.begin(), points.end(), byCoordinate<Scalar>(axis));
    const std::size_t count = countBelow(points, axis, static_cast<double>(below) / ranks);
    cuts.push_back({points.empty() ? Scalar(0) : points[count].at[axis], axis});
    bisect(points.first(count), below, last == nullptr ? nullptr : last + 1, cuts);
    bisect(points.subspan(count), ranks - below, last == nullptr ? nullptr : last + below, cuts);
}

}  // namespace

template <class Scalar>
Partition<Scalar>::Partition(std::span<const Cut<Scalar>> cuts) : cuts_(cuts.begin(), cuts.end()) {
    for (const Cut<Scalar>& cut : cuts) {
        if (cut.axis > 2 || std::isnan(cut.at)) {
            detail::raiseInvalidArgument(
                "Partition: a cut has an axis above 2, or lies at NaN. Set Cut::axis to 0, 1 or 2, "
                "and Cut::at to a number [m].");
        }
    }
}

template <class Scalar>
Partition<Scalar> Partition<Scalar>::balanced(std::uint32_t ranks,
                                              std::span<const WeightedPoint<Scalar>> points,
                                              const Partition* last) {
    HASHPHASE_ASSERT(ranks > 0, "Partition::balanced(): ranks is 0. Pass 1 or more.");
    std::vector<WeightedPoint<Scalar>> counted;
    counted.reserve(points.size());
    for (const WeightedPoint<Scalar>& point : points) {
        if (!detail::anyNan(point.at)) {
            counted.push_back(point);
        }
    }
    Partition partition;
    partition.cuts_.reserve(ranks);
    const bool isLike = last != nullptr && last->rankCount() == ranks;
    bisect<Scalar>(counted, std::max(ranks, 1U), isLike ? last->cuts_.data() : nullptr,
                   partition.cuts_);
    return partition;
}

template <class Scalar>
std::uint32_t Partition<Scalar>::rankOf(const Vector3<Scalar>& point) const noexcept {
    std::uint32_t first = 0;
    std::uint32_t last = rankCount();
    std::size_t node = 0;
    while (last - first > 1) {
        const std::uint32_t middle = first + (last - first) / 2;
        if (point[cuts_[node].axis] < cuts_[node].at) {
            last = middle;
            ++node;
        } else {
            node += middle - first;
            first = middle;
        }
    }
    return first;
}

template <class Scalar>
Aabb<Scalar> Partition<Scalar>::region(std::uint32_t rank) const noexcept {
    Aabb<Scalar> box = wholeSpace();
    std::uint32_t first = 0;
    std::uint32_t last = rankCount();
    std::size_t node = 0;
    while (last - first > 1) {
        const std::uint32_t middle = first + (last - first) / 2;
        if (rank < middle) {
            box = below(box, cuts_[node]);
            last = middle;
            ++node;
        } else {
            box = above(box, cuts_[node]);
            node += middle - first;
            first = middle;
        }
    }
    return box;
}

template class HASHPHASE_INSTANCE_EXPORT Partition<float>;
template class HASHPHASE_INSTANCE_EXPORT Partition<double>;

}  // namespace hashphase
