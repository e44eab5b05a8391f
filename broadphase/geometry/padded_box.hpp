// SPDX-License-Identifier: Zlib
#pragma once

// Boxes to and from the form that passes over many boxes read.

#include <broadphase/aabb.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

template <class Scalar>
[[nodiscard]] inline PaddedBox<Scalar> padded(const Aabb<Scalar>& box) noexcept {
    return {{box.min()[0], box.min()[1], box.min()[2], 0},
            {box.max()[0], box.max()[1], box.max()[2], 0}};
}

template <class Scalar>
[[nodiscard]] inline Aabb<Scalar> unpadded(const PaddedBox<Scalar>& box) noexcept {
    return {Vector3<Scalar>(box.low[0], box.low[1], box.low[2]),
            Vector3<Scalar>(box.high[0], box.high[1], box.high[2])};
}

template <class Scalar>
[[nodiscard]] Aabb<Scalar> nanBox() {
    const auto nan = Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN());
    return {nan, nan};
}

/// Whether no coordinate of the box lies beyond those of `outer`; not of one with a NaN.
template <class Scalar>
[[nodiscard]] inline bool isWithin(const PaddedBox<Scalar>& box,
                                   const PaddedBox<Scalar>& outer) noexcept {
    bool result = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result &= (box.low[axis] >= outer.low[axis]) & (box.high[axis] <= outer.high[axis]);
    }
    return result;
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
