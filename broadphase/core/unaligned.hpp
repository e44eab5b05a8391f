// SPDX-License-Identifier: Zlib
#pragma once

// Eigen's own matrices, points and planes, as the libraries keep them, pass them on and compute with them.
// Those without Eigen::DontAlign lie at places, and are read by instructions, that depend on macros and on the
// processor that is compiled for (integration/guide/abi.md). Points of three coordinates never do.

#include <Eigen/Geometry>

namespace hashphase::detail {

template <class Scalar>
using Matrix4 = Eigen::Matrix<Scalar, 4, 4, Eigen::DontAlign>;

template <class Scalar>
using Vector4 = Eigen::Matrix<Scalar, 4, 1, Eigen::DontAlign>;

template <class Scalar>
using Vector2 = Eigen::Matrix<Scalar, 2, 1, Eigen::DontAlign>;

template <class Scalar>
using Plane = Eigen::Hyperplane<Scalar, 3, Eigen::DontAlign>;

}  // namespace hashphase::detail
