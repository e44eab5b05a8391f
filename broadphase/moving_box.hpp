// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that move along a straight line during a frame, and when two of them first touch.
//
// Time    runs from 0, where the boxes are as given, to 1, where each has moved by its whole
//         displacement. Both ends count.
// Closed  Boxes that touch for a moment only, at a face, an edge or a corner, do touch.
// Exact   Whether they touch is decided without a rounding error, for single precision always, and
//         for double between 1e-140 and 1e300 m. When they do is rounded to double precision.
// Bad data  What has a NaN, or an infinite displacement, touches nothing.

#include <broadphase/aabb.hpp>
#include <broadphase/regions.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace hashphase {

/// At the time t, `box` shifted by t * displacement [m].
template <class Scalar>
struct MovingBox {
    Aabb<Scalar> box;
    Vector3<Scalar> displacement = Vector3<Scalar>::Zero();
};

/// The box around a moving box's way between two times [m], rounded outward.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> wayBounds(const MovingBox<Scalar>& moving, double from = 0,
                                     double to = 1);

/// The first time at which the two touch: 0 when they do from the start; nothing when they never do.
template <class Scalar>
[[nodiscard]] std::optional<double> firstContact(const MovingBox<Scalar>& a,
                                                 const MovingBox<Scalar>& b) noexcept;

/// What a moving box meets on its way. Key: the time of the first contact, by firstContact(). With
/// CollectClosest, what is hit first.
template <class Scalar>
class MovingBoxRegion {
public:
    explicit MovingBoxRegion(const MovingBox<Scalar>& moving);

    [[nodiscard]] Scalar key(const Aabb<Scalar>& other) const noexcept {
        const std::optional<double> time = firstContact(moving_, MovingBox<Scalar>{other});
        return time ? static_cast<Scalar>(*time) : Scalar(-1);
    }

    /// The way, a little thicker than the box: it is rounded, and key() is not.
    [[nodiscard]] const RayRegion<Scalar>& segment() const noexcept { return segment_; }

private:
    MovingBox<Scalar> moving_;
    RayRegion<Scalar> segment_;
};

extern template Aabb<float> wayBounds(const MovingBox<float>&, double, double);
extern template Aabb<double> wayBounds(const MovingBox<double>&, double, double);
extern template std::optional<double> firstContact(const MovingBox<float>&,
                                                   const MovingBox<float>&) noexcept;
extern template std::optional<double> firstContact(const MovingBox<double>&,
                                                   const MovingBox<double>&) noexcept;
extern template class MovingBoxRegion<float>;
extern template class MovingBoxRegion<double>;

}  // namespace hashphase
