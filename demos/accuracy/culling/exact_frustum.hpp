// SPDX-License-Identifier: Zlib
#pragma once

// The truth about what a camera sees, by clipping in long double.

#include <demos/scenes/camera_view.hpp>

#include <array>

namespace hashphase::demos {

class ExactFrustum {
public:
    /// Of the matrix, its numbers taken as exact.
    explicit ExactFrustum(const CameraView& view);

    /// True when the closed box and the closed frustum share a point.
    [[nodiscard]] bool sees(const Aabb<float>& box) const;

private:
    using Real = long double;
    using Point = Vector3<Real>;
    using Plane = Eigen::Hyperplane<Real, 3>;

    [[nodiscard]] bool seesFaceOf(const Aabb<Real>& box) const;

    std::array<Plane, 6> planes_;
    Point corner_;  // any point of the frustum
};

}  // namespace hashphase::demos
