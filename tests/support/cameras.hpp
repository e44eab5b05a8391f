// SPDX-License-Identifier: Zlib
#pragma once

// Cameras of every kind, at random.

#include <tests/support/camera_matrices.hpp>
#include <tests/support/random.hpp>

#include <limits>

namespace hashphase::test {

[[nodiscard]] inline CameraLens randomLens(Random& random) {
    CameraLens lens;
    lens.isOrthographic = random.chance(0.2);
    lens.fieldOfView = lens.isOrthographic ? random.between(1, 20) : random.between(0.1, 2.5);
    lens.aspect = random.between(0.5, 2.5);
    lens.nearPlane = random.logBetween(0.01, 2);
    lens.farPlane = random.between(5, 60);
    if (!lens.isOrthographic && random.chance(0.25)) {
        lens.farPlane = std::numeric_limits<double>::infinity();
    }
    lens.depthRange = random.chance(0.5) ? DepthRange::zeroToOne : DepthRange::minusOneToOne;
    lens.isReversed = random.chance(0.3);
    return lens;
}

/// A camera with depths from 0 to 1, that stands and looks within `reach` [m] of `middle`.
template <class Scalar>
[[nodiscard]] Eigen::Matrix<Scalar, 4, 4> randomCamera(Random& random,
                                                       const Vector3<double>& middle,
                                                       double reach) {
    CameraLens lens = randomLens(random);
    lens.depthRange = DepthRange::zeroToOne;
    lens.farPlane *= reach / 20;
    // One after the other: compilers draw arguments of a call in an order of their own.
    const Vector3<double> target = middle + random.pointIn(-reach, reach);
    const Vector3<double> eye = middle + random.pointIn(-reach, reach);
    return cameraMatrix<Scalar>(lens, eye, target);
}

}  // namespace hashphase::test
