// SPDX-License-Identifier: Zlib
#pragma once

// Deprecated: include integration/camera/camera.hpp, and use Camera and cameraError().

#include <integration/camera/camera.hpp>

namespace hashphase {

template <class Scalar>
using View [[deprecated("Camera")]] = Camera<Scalar>;

template <class Scalar>
[[deprecated("cameraError()")]] [[nodiscard]] std::string viewError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, const Viewport& viewport) {
    return cameraError(viewProjection, viewport);
}

}  // namespace hashphase
