// SPDX-License-Identifier: Zlib
#pragma once

// Whether a segment, or a box that moves along it, meets a box, in rational numbers: without any
// rounding.

#include <broadphase/aabb.hpp>

#include <gmpxx.h>

#include <cmath>
#include <utility>

namespace hashphase::test {

/// True when the box `fatness`, moved from `from` to `to`, touches `box` (closed) somewhere on its
/// way. All finite, no box inverted.
template <class Scalar>
[[nodiscard]] bool meetsByRationals(const Vector3<Scalar>& from, const Vector3<Scalar>& to,
                                    const Aabb<Scalar>& box,
                                    const Aabb<Scalar>& fatness = {Vector3<Scalar>::Zero(),
                                                                   Vector3<Scalar>::Zero()}) {
    mpq_class enter = 0;
    mpq_class leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const mpq_class start = from[axis];
        const mpq_class way = mpq_class(to[axis]) - start;
        const mpq_class low = mpq_class(box.min()[axis]) - start - mpq_class(fatness.max()[axis]);
        const mpq_class high = mpq_class(box.max()[axis]) - start - mpq_class(fatness.min()[axis]);
        if (way == 0) {
            if (low > 0 || high < 0) {
                return false;
            }
            continue;
        }
        mpq_class near = low / way;
        mpq_class far = high / way;
        if (way < 0) {
            std::swap(near, far);
        }
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
        if (enter > leave) {
            return false;
        }
    }
    return true;
}

/// The box with every face moved outward by `doubt` of the largest coordinate at hand, its own and
/// those of the segment.
template <class Scalar>
[[nodiscard]] Aabb<Scalar> withDoubt(const Aabb<Scalar>& box, const Vector3<Scalar>& from,
                                     const Vector3<Scalar>& to, double doubt) {
    const Scalar reach = box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff() +
                         from.cwiseAbs().maxCoeff() + to.cwiseAbs().maxCoeff();
    const Vector3<Scalar> by = Vector3<Scalar>::Constant(reach * static_cast<Scalar>(doubt));
    return {box.min() - by, box.max() + by};
}

}  // namespace hashphase::test
