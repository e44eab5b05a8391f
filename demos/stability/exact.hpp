// SPDX-License-Identifier: Zlib
#pragma once

// What is so: by comparing coordinates, and in integers, so that nothing is rounded. It shares no code
// with the library.

#include <broadphase/moving_box.hpp>
#include <demos/stability/subject.hpp>

#include <cmath>

namespace hashphase::demos {

/// Whether the closed boxes touch; NaN touches nothing.
template <class Scalar>
[[nodiscard]] bool doTouch(const Aabb<Scalar>& a, const Aabb<Scalar>& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(a.min()[axis] <= b.max()[axis] && b.min()[axis] <= a.max()[axis])) {
            return false;
        }
    }
    return true;
}

/// The pairs of boxes that touch, sorted; found along x.
template <class Scalar>
[[nodiscard]] Keys touchingPairs(const Boxes<Scalar>& boxes);

/// The boxes for which isMet() holds.
template <class Scalar, class IsMet>
[[nodiscard]] Objects objectsThat(const Boxes<Scalar>& boxes, const IsMet& isMet) {
    Objects met;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (isMet(boxes[i])) {
            met.push_back(i);
        }
    }
    return met;
}

template <class Scalar>
[[nodiscard]] Aabb<Scalar> pointBox() {
    return {Vector3<Scalar>::Zero(), Vector3<Scalar>::Zero()};
}

/// Coordinates that are multiples of a step, a power of two. Points and ways reach up to 2^59 steps
/// far; boxes may reach farther.
class Lattice {
public:
    explicit Lattice(double step) : step_(step) {}

    /// The nearest multiple.
    template <class Scalar>
    [[nodiscard]] Vector3<Scalar> on(const Vector3<Scalar>& point) const {
        const auto step = static_cast<Scalar>(step_);
        return (point.array() / step).round() * step;
    }
    template <class Scalar>
    [[nodiscard]] Aabb<Scalar> on(const Aabb<Scalar>& box) const {
        return {on<Scalar>(box.min()), on<Scalar>(box.max())};
    }

    /// Whether the box `fatness`, moved from `from` to `to`, comes as near to `box` as `doubt` on
    /// every axis. Throws std::logic_error for coordinates beside the lattice.
    template <class Scalar>
    [[nodiscard]] bool meets(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                             const Aabb<Scalar>& box,
                             const Aabb<Scalar>& fatness = pointBox<Scalar>(),
                             double doubt = 0) const {
        return meets({box.template cast<double>()}, from.template cast<double>(),
                     to.template cast<double>(), fatness.template cast<double>(), doubt);
    }

    /// Whether two moving boxes touch at some moment.
    template <class Scalar>
    [[nodiscard]] bool meet(const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) const {
        // One moves as seen from the other: both have their numbers on the lattice, not the difference.
        return meets({b.box.template cast<double>(), b.displacement.template cast<double>()},
                     Vector3<double>::Zero(), a.displacement.template cast<double>(),
                     a.box.template cast<double>(), 0);
    }

private:
    [[nodiscard]] bool meets(const MovingBox<double>& box, const Vector3<double>& from,
                             const Vector3<double>& to, const Aabb<double>& fatness,
                             double doubt) const;

    double step_;
};

}  // namespace hashphase::demos
