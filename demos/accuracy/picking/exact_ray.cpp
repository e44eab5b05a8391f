// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/exact_ray.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hashphase::demos {
namespace {

__extension__ using Wide = __int128;

std::int64_t onLattice(float coordinate) {
    const double steps = static_cast<double>(coordinate) / static_cast<double>(kLattice);
    if (std::floor(steps) != steps || std::abs(steps) > 0x1p40) {
        throw std::logic_error("A coordinate is not on the lattice of the exact ray.");
    }
    return static_cast<std::int64_t>(steps);
}

std::array<std::int64_t, 3> onLattice(const Vector3<float>& point) {
    return {onLattice(point[0]), onLattice(point[1]), onLattice(point[2])};
}

}  // namespace

std::strong_ordering operator<=>(const Fraction& a, const Fraction& b) {
    return Wide{a.numerator_} * b.denominator_ <=> Wide{b.numerator_} * a.denominator_;
}

ExactRay::ExactRay(const Vector3<float>& from, const Vector3<float>& to)
    : from_(onLattice(from)), direction_(onLattice(to)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        direction_[axis] -= from_[axis];
    }
}

std::optional<Fraction> ExactRay::entry(const Aabb<float>& box) const {
    const std::array low = onLattice(box.min());
    const std::array high = onLattice(box.max());
    Fraction enter(0, 1);
    Fraction leave(1, 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t toLow = low[axis] - from_[axis];
        const std::int64_t toHigh = high[axis] - from_[axis];
        if (direction_[axis] == 0) {
            if (toLow > 0 || toHigh < 0) {
                return std::nullopt;
            }
            continue;
        }
        const bool isForward = direction_[axis] > 0;
        enter = std::max(enter, Fraction(isForward ? toLow : toHigh, direction_[axis]));
        leave = std::min(leave, Fraction(isForward ? toHigh : toLow, direction_[axis]));
    }
    return enter <= leave ? std::optional(enter) : std::nullopt;
}

}  // namespace hashphase::demos
