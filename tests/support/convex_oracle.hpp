// SPDX-License-Identifier: Zlib
#pragma once

// Whether a box and a convex volume share a point, found without regard to what either is made of: the
// planes of both enclose what they share, which has a corner if it has a point, because the box is
// bounded.

#include <broadphase/aabb.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {

using OraclePlane = Eigen::Hyperplane<double, 3>;

/// The planes with normals of length 1, in double precision, without those at infinity.
template <class Scalar>
[[nodiscard]] std::vector<OraclePlane> oraclePlanes(
    std::span<const Eigen::Hyperplane<Scalar, 3>> planes) {
    std::vector<OraclePlane> result;
    for (const auto& plane : planes) {
        const OraclePlane exact = plane.template cast<double>();
        if (exact.normal().isZero(0)) {
            continue;  // infinitely far away
        }
        result.push_back(exact);
        result.back().coeffs() /= exact.normal().norm();
    }
    return result;
}

/// How deep, at most, a point of the box lies inside of all planes: the largest, over the corners of
/// what planes and box enclose, of the least distance from any of these; negative where some plane has
/// each of them outside. 0 or nearly so where box and volume share a point. O(n^4).
[[nodiscard]] inline double depthInVolume(std::vector<OraclePlane> planes,
                                          const Aabb<double>& box) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vector3<double> unit = Vector3<double>::Unit(axis);
        planes.emplace_back(unit, -box.min()[axis]);
        planes.emplace_back(-unit, box.max()[axis]);
    }
    double depth = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                Eigen::Matrix3d normals;
                normals << planes[i].normal().transpose(), planes[j].normal().transpose(),
                    planes[k].normal().transpose();
                const Vector3<double> offsets(planes[i].offset(), planes[j].offset(),
                                              planes[k].offset());
                if (std::abs(normals.determinant()) < 1e-9) {
                    continue;
                }
                const Vector3<double> corner = normals.inverse() * -offsets;
                double least = std::numeric_limits<double>::infinity();
                for (const OraclePlane& plane : planes) {
                    least = std::min(least, plane.signedDistance(corner));
                }
                depth = std::max(depth, least);
            }
        }
    }
    return depth;
}

}  // namespace hashphase::test
