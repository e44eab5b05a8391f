// SPDX-License-Identifier: Zlib
#pragma once

// What picking must answer, found by looking at everything, in double precision where that helps.

#include <integration/camera/camera.hpp>
#include <integration/picking/pick.hpp>
#include <tests/support/convex_oracle.hpp>
#include <tests/support/oracles.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <vector>

namespace hashphase::test {

/// Of a window within a larger one.
inline constexpr Viewport kViewport{100, 50, 1280, 720};

[[nodiscard]] inline Pixel middleOf(const Viewport& viewport) {
    return {viewport.x + viewport.width / 2, viewport.y + viewport.height / 2};
}

/// Clip coordinates of a point.
template <class Scalar>
[[nodiscard]] Eigen::Vector4d clipCoordinates(const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
                                              const Vector3<double>& point) {
    return viewProjection.template cast<double>() * point.homogeneous();
}

/// Where clip coordinates are in the window.
[[nodiscard]] inline Pixel pixelOf(const Eigen::Vector4d& clip, const Viewport& viewport) {
    return {viewport.x + viewport.width * (clip.x() / clip.w() + 1) / 2,
            viewport.y + viewport.height * (1 - clip.y() / clip.w()) / 2};
}

/// The planes of what is seen between two corners in the window, in the viewport.
template <class Scalar>
[[nodiscard]] std::vector<OraclePlane> planesBetween(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, DepthRange depthRange,
    const Viewport& viewport, const Pixel& a, const Pixel& b) {
    const Eigen::Matrix4d matrix = viewProjection.template cast<double>();
    const auto x = [&](double pixel) {
        return std::clamp(2 * (pixel - viewport.x) / viewport.width - 1, -1.0, 1.0);
    };
    const auto y = [&](double pixel) {
        return std::clamp(1 - 2 * (pixel - viewport.y) / viewport.height, -1.0, 1.0);
    };
    std::vector<Eigen::Hyperplane<double, 3>> planes(6);
    planes[0].coeffs() = matrix.row(0) - std::min(x(a.x()), x(b.x())) * matrix.row(3);
    planes[1].coeffs() = std::max(x(a.x()), x(b.x())) * matrix.row(3) - matrix.row(0);
    planes[2].coeffs() = matrix.row(1) - std::min(y(a.y()), y(b.y())) * matrix.row(3);
    planes[3].coeffs() = std::max(y(a.y()), y(b.y())) * matrix.row(3) - matrix.row(1);
    planes[4].coeffs() = matrix.row(2);
    if (depthRange == DepthRange::minusOneToOne) {
        planes[4].coeffs() += matrix.row(3).transpose();
    }
    planes[5].coeffs() = matrix.row(3) - matrix.row(2);
    return oraclePlanes<double>(planes);
}

/// pickAll() by looking at everything; the first one is what pickNearest() finds.
template <class Scalar>
[[nodiscard]] std::vector<Picked<Scalar>> pickAllByBruteForce(
    std::span<const Placed<Scalar>> proxies, const RayRegion<Scalar>& ray,
    std::type_identity_t<ExactTest<Scalar>> test, ProxyFilter filter) {
    std::vector<Picked<Scalar>> picked;
    for (const Placed<Scalar>& proxy : proxies) {
        if (!filter(proxy.id) || !(ray.key(proxy.box) >= 0)) {
            continue;
        }
        if (const auto fraction = test(proxy.id, ray, Scalar(1))) {
            picked.push_back({proxy.id, *fraction, ray.from() + *fraction * ray.direction()});
        }
    }
    std::sort(picked.begin(), picked.end(), [](const auto& a, const auto& b) {
        return std::tie(a.fraction, a.id) < std::tie(b.fraction, b.id);
    });
    return picked;
}

}  // namespace hashphase::test
