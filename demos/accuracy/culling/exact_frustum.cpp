// SPDX-License-Identifier: Zlib
//
// A box and a frustum share a point when a face of the box does, or when one lies within the other.
// Faces are clipped by one plane after another: I. Sutherland, G. Hodgman, "Reentrant Polygon
// Clipping", 1974.

#include <demos/accuracy/culling/culling_experiment.hpp>

#include <Eigen/LU>

#include <vector>

namespace hashphase::demos {
namespace {

using Real = long double;
using Point = Vector3<Real>;
using Plane = Eigen::Hyperplane<Real, 3>;
using Polygon = std::vector<Point>;

Polygon clipped(const Polygon& polygon, const Plane& plane) {
    Polygon inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& from = polygon[i];
        const Point& to = polygon[(i + 1) % polygon.size()];
        const Real before = plane.signedDistance(from);
        const Real behind = plane.signedDistance(to);
        if (before >= 0) {
            inside.push_back(from);
        }
        if ((before > 0 && behind < 0) || (before < 0 && behind > 0)) {
            inside.push_back(from + (to - from) * (before / (before - behind)));
        }
    }
    return inside;
}

Polygon faceOf(const Aabb<Real>& box, int axis, bool isFar) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    Point corner = isFar ? box.max() : box.min();
    Polygon face;
    for (const auto& [farU, farV] :
         {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
        corner[u] = (farU ? box.max() : box.min())[u];
        corner[v] = (farV ? box.max() : box.min())[v];
        face.push_back(corner);
    }
    return face;
}

// The corner of the box that lies farthest along the normal.
Point farthestCorner(const Aabb<Real>& box, const Point& normal) {
    return (normal.array() > 0).select(box.max(), box.min());
}

}  // namespace

ExactFrustum::ExactFrustum(const CameraView& view) {
    const Eigen::Matrix<Real, 4, 4> matrix = view.viewProjection.cast<Real>();
    for (int axis = 0; axis < 2; ++axis) {
        const auto side = static_cast<std::size_t>(2 * axis);
        planes_[side].coeffs() = matrix.row(3) + matrix.row(axis);
        planes_[side + 1].coeffs() = matrix.row(3) - matrix.row(axis);
    }
    planes_[4].coeffs() = matrix.row(2);
    planes_[5].coeffs() = matrix.row(3) - matrix.row(2);
    const Eigen::Matrix<Real, 4, 1> corner =
        matrix.inverse() * Eigen::Matrix<Real, 4, 1>(0, 0, Real(0.5), 1);
    corner_ = corner.head<3>() / corner[3];
}

bool ExactFrustum::sees(const Aabb<float>& floatBox) const {
    const Aabb<Real> box = floatBox.cast<Real>();
    bool isInside = true;
    for (const Plane& plane : planes_) {
        if (plane.signedDistance(farthestCorner(box, plane.normal())) < 0) {
            return false;
        }
        isInside = isInside && plane.signedDistance(farthestCorner(box, -plane.normal())) >= 0;
    }
    return isInside || box.contains(corner_) || seesFaceOf(box);
}

bool ExactFrustum::seesFaceOf(const Aabb<Real>& box) const {
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool isFar : {false, true}) {
            Polygon face = faceOf(box, axis, isFar);
            for (const Plane& plane : planes_) {
                face = clipped(face, plane);
            }
            if (!face.empty()) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace hashphase::demos
