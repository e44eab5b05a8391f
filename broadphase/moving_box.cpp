// SPDX-License-Identifier: Zlib

// Two boxes touch at the time t when on each axis, and in both directions, the gap between them at
// the start is no more than what has closed by then: six inequalities in t. Those that do not hold
// at the start say when contact begins at the earliest, the others when it ends at the latest. After
// Ericson, "Real-Time Collision Detection", 5.5.8, with the comparison made exact.

#include <broadphase/moving_box.hpp>

#include <broadphase/geometry/expansion.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace hashphase {
namespace {

// A difference of two numbers that have a double's precision or less.
struct Difference {
    double minuend;
    double subtrahend;

    [[nodiscard]] double rounded() const noexcept { return minuend - subtrahend; }
    // What rounded() lacks; by Knuth's Two-Sum.
    [[nodiscard]] double rest() const noexcept {
        const double difference = rounded();
        const double ofSubtrahend = difference - minuend;
        return (minuend - (difference - ofSubtrahend)) - (subtrahend + ofSubtrahend);
    }
    [[nodiscard]] Difference scaled(int exponent) const noexcept {
        return {std::ldexp(minuend, exponent), std::ldexp(subtrahend, exponent)};
    }
};

// How far apart the boxes are in one direction at the start, and how much of that closes until 1.
struct Gap {
    Difference width;
    Difference closing;

    [[nodiscard]] double time() const noexcept { return width.rounded() / closing.rounded(); }
};

// The gap between `low` of one box and `high` of the other, which move by so much.
Gap gapBetween(double low, double high, double lowMoves, double highMoves) noexcept {
    const Gap gap{{low, high}, {highMoves, lowMoves}};
    if (std::isfinite(gap.width.rounded()) && std::isfinite(gap.closing.rounded())) {
        return gap;
    }
    if (std::isinf(low) || std::isinf(high)) {
        return {{low <= high ? -1.0 : 1.0, 0}, {0, 0}};  // no move changes that
    }
    return {gap.width.scaled(-1), gap.closing.scaled(-1)};
}

template <class Scalar>
std::array<Gap, 6> gapsBetween(const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) noexcept {
    std::array<Gap, 6> gaps;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = 2 * static_cast<std::size_t>(axis);
        const auto moveA = static_cast<double>(a.displacement[axis]);
        const auto moveB = static_cast<double>(b.displacement[axis]);
        gaps[at] = gapBetween(a.box.min()[axis], b.box.max()[axis], moveA, moveB);
        gaps[at + 1] = gapBetween(b.box.min()[axis], a.box.max()[axis], moveB, moveA);
    }
    return gaps;
}

// The sign of a * b - c * d, of which a and b are not 0.
int signOfDeterminant(const Difference& a, const Difference& b, const Difference& c,
                      const Difference& d) noexcept {
    // So that nothing underflows.
    const int ofA = -std::ilogb(a.rounded());
    const int ofB = -std::ilogb(b.rounded());
    detail::Expansion<16> sum;
    const auto addProduct = [&sum](const Difference& left, const Difference& right, double sign) {
        for (const double x : {left.rest(), left.rounded()}) {
            for (const double y : {right.rest(), right.rounded()}) {
                sum.addProduct(sign * x, y);
            }
        }
    };
    addProduct(a.scaled(ofA), b.scaled(ofB), 1);
    if (c.rounded() != 0) {  // else d may be so large that it overflows
        addProduct(c.scaled(ofA), d.scaled(ofB), -1);
    }
    const double value = sum.value();
    return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

// Whether one time comes before the other one: 1 when it does, -1 when it comes behind, 0 when
// rounding leaves that open.
int roundedOrder(double first, double second) noexcept {
    if (first <= detail::kTiniest && second <= detail::kTiniest) {
        return 0;
    }
    return std::abs(first - second) <= detail::kTimeDoubt * second ? 0 : first < second ? 1 : -1;
}

// Whether the open gap has closed no later than the other one opens.
bool closesInTime(const Gap& open, const Gap& other) noexcept {
    const int order = roundedOrder(open.time(), other.time());
    return order != 0
               ? order > 0
               : signOfDeterminant(open.width, other.closing, other.width, open.closing) >= 0;
}

// The same for the end of the time.
bool closesInTime(const Gap& open) noexcept {
    const Difference one{1, 0};
    const int order = roundedOrder(open.time(), 1);
    return order != 0 ? order > 0 : signOfDeterminant(open.closing, one, open.width, one) >= 0;
}

// Whether all gaps that are open at the start have closed before another one opens, and in time.
bool meetExactly(const std::array<Gap, 6>& gaps) noexcept {
    for (const Gap& open : gaps) {
        if (open.width.rounded() <= 0) {
            continue;
        }
        if (!closesInTime(open)) {
            return false;
        }
        for (const Gap& other : gaps) {
            const bool opens = other.width.rounded() <= 0 && other.closing.rounded() < 0;
            if (opens && !closesInTime(open, other)) {
                return false;
            }
        }
    }
    return true;
}

}  // namespace

template <class Scalar>
std::optional<double> detail::firstContactExactly(const MovingBox<Scalar>& a,
                                                  const MovingBox<Scalar>& b) noexcept {
    if (!a.displacement.allFinite() || !b.displacement.allFinite()) {
        return std::nullopt;
    }
    bool isApart = false;  // at the start
    double begin = 0;
    double end = 1;
    const std::array<Gap, 6> gaps = gapsBetween(a, b);
    for (const Gap& gap : gaps) {
        // Neither is rounded to the wrong sign.
        const double width = gap.width.rounded();
        const double closing = gap.closing.rounded();
        if (!(width <= 0)) {
            const double time = closing > 0 ? gap.time() : 2;
            if (!(time < 2)) {
                return std::nullopt;
            }
            isApart = true;
            begin = std::max(begin, time);
        } else if (closing < 0) {
            end = std::min(end, gap.time());
        }
    }
    const int order = isApart ? roundedOrder(begin, end) : 1;
    const bool doMeet = order != 0 ? order > 0 : meetExactly(gaps);
    return doMeet ? std::optional(std::min(begin, 1.0)) : std::nullopt;
}

// In double precision: of a long way, a float knows the places only roughly.
template <class Scalar>
Aabb<Scalar> sweptBounds(const MovingBox<Scalar>& moving, double from, double to) {
    using Limits = std::numeric_limits<Scalar>;
    constexpr auto kLargest = static_cast<double>(Limits::max());
    constexpr auto kShare = 2 * static_cast<double>(Limits::epsilon());
    Aabb<Scalar> bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const auto way = static_cast<double>(moving.displacement[axis]);
        const double start = from * way;
        const double stop = to * way;
        const double low = static_cast<double>(moving.box.min()[axis]) + std::min(start, stop);
        const double high = static_cast<double>(moving.box.max()[axis]) + std::max(start, stop);
        // A product and two sums, each off by half a unit of its last place.
        const double ofWay = std::abs(way) * std::numeric_limits<double>::epsilon() +
                             static_cast<double>(Limits::min());
        bounds.min()[axis] =
            static_cast<Scalar>(low - (std::min(std::abs(low), kLargest) * kShare + ofWay));
        bounds.max()[axis] =
            static_cast<Scalar>(high + (std::min(std::abs(high), kLargest) * kShare + ofWay));
    }
    return bounds;
}

namespace {

// A ray that meets what the moving box does. One that leaves all numbers behind stands still, as
// large as the whole way.
template <class Scalar>
RayRegion<Scalar> rayAround(const MovingBox<Scalar>& moving) {
    using Limits = std::numeric_limits<Scalar>;
    const Vector3<Scalar> reach =
        moving.box.min().cwiseAbs() + moving.box.max().cwiseAbs() + moving.displacement.cwiseAbs();
    if (!(reach.maxCoeff() < Limits::max() / 8)) {
        const Vector3<Scalar> zero = Vector3<Scalar>::Zero();
        return {zero, zero, sweptBounds(moving)};
    }
    const Vector3<Scalar> center = moving.box.min() / 2 + moving.box.max() / 2;
    const Vector3<Scalar> padding =
        reach * (16 * Limits::epsilon()) + Vector3<Scalar>::Constant(Limits::min());
    return {center,
            center + moving.displacement,
            {moving.box.min() - center - padding, moving.box.max() - center + padding}};
}

}  // namespace

template <class Scalar>
MovingBoxRegion<Scalar>::MovingBoxRegion(const MovingBox<Scalar>& moving)
    : moving_(moving), segment_(rayAround(moving)) {}

template Aabb<float> sweptBounds(const MovingBox<float>&, double, double);
template Aabb<double> sweptBounds(const MovingBox<double>&, double, double);
template std::optional<double> detail::firstContactExactly(const MovingBox<float>&,
                                                           const MovingBox<float>&) noexcept;
template std::optional<double> detail::firstContactExactly(const MovingBox<double>&,
                                                           const MovingBox<double>&) noexcept;
template class HASHPHASE_INSTANCE_EXPORT MovingBoxRegion<float>;
template class HASHPHASE_INSTANCE_EXPORT MovingBoxRegion<double>;

}  // namespace hashphase
