// SPDX-License-Identifier: Zlib
#include <demos/accuracy/exact_entry.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hashphase::demos {
namespace {

__extension__ using Wide = __int128;

std::int64_t onLattice(float coordinate) {
    return wholeUnits(coordinate, kLattice, 0x1p40F);
}

}  // namespace

double Fraction::errorOf(double share) const {
    const auto whole = static_cast<double>(denominator);
    return std::abs(std::fma(share, whole, -static_cast<double>(numerator))) / whole;
}

std::strong_ordering operator<=>(const Fraction& a, const Fraction& b) {
    return Wide{a.numerator} * b.denominator <=> Wide{b.numerator} * a.denominator;
}

double operator-(const Fraction& a, const Fraction& b) {
    const Wide difference = Wide{a.numerator} * b.denominator - Wide{b.numerator} * a.denominator;
    return static_cast<double>(difference) / static_cast<double>(a.denominator) /
           static_cast<double>(b.denominator);
}

std::int64_t wholeUnits(float coordinate, float unit, float most) {
    const float units = coordinate / unit;
    if (!(std::abs(units) <= most) ||
        static_cast<float>(static_cast<std::int64_t>(units)) != units) {
        throw std::logic_error("A coordinate is no multiple of the unit.");
    }
    return static_cast<std::int64_t>(units);
}

std::optional<Fraction> exactEntry(const WholePoint& way, const WholePoint& low,
                                   const WholePoint& high) {
    Fraction enter{0, 1};
    Fraction leave{1, 1};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool isForward = way[axis] > 0;
        const std::int64_t toNear = isForward ? low[axis] : -high[axis];
        const std::int64_t toFar = isForward ? high[axis] : -low[axis];
        if (way[axis] != 0) {
            enter = std::max(enter, Fraction{toNear, std::abs(way[axis])});
            leave = std::min(leave, Fraction{toFar, std::abs(way[axis])});
        }
        if (enter > leave || (way[axis] == 0 && (toNear > 0 || toFar < 0))) {
            return std::nullopt;
        }
    }
    return enter;
}

ExactRay::ExactRay(const Vector3<float>& from, const Vector3<float>& to) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        from_[i] = onLattice(from[axis]);
        way_[i] = onLattice(to[axis]) - from_[i];
    }
}

std::optional<Fraction> ExactRay::entry(const Aabb<float>& box) const {
    WholePoint low;
    WholePoint high;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        low[i] = onLattice(box.min()[axis]) - from_[i];
        high[i] = onLattice(box.max()[axis]) - from_[i];
    }
    return exactEntry(way_, low, high);
}

}  // namespace hashphase::demos
