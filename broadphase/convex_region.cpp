// SPDX-License-Identifier: Zlib
#include <broadphase/convex_region.hpp>

#include <broadphase/detail/polyhedron.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase {
namespace {

using PlaneOfDoubles = detail::Polyhedron::Plane;

// A length of 1 keeps all products finite.
template <class Plane>
PlaneOfDoubles normalised(const Plane& plane) {
    const Vector3<double> normal = plane.normal().template cast<double>();
    const auto offset = static_cast<double>(plane.offset());
    const double length = normal.stableNorm();
    return length > 0 ? PlaneOfDoubles(normal / length, offset / length)
                      : PlaneOfDoubles(normal, offset);
}

}  // namespace

template <class Scalar>
ConvexRegion<Scalar>::ConvexRegion(std::span<const Plane> planes, Containment containment,
                                   Touch touch) {
    HASHPHASE_ASSERT(planes.size() <= kMostPlanes, "A convex region has at most 16 planes.");
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    detail::Polyhedron::Planes all;
    for (const Plane& plane : planes.first(std::min(planes.size(), kMostPlanes))) {
        isEmpty_ = isEmpty_ || !plane.normal().allFinite() || !(plane.offset() > -infinity);
        if (plane.offset() < infinity) {
            all.push(normalised(plane));
        }
    }
    const std::size_t ownCount = all.size();
    // What is inside of its own planes is so of all others.
    const bool testsAll = touch == Touch::exact && containment == Containment::touching;
    if (!isEmpty_) {
        const detail::Polyhedron polyhedron(all);
        isEmpty_ = polyhedron.isEmpty();
        polyhedron.appendSilhouettes(testsAll, all);
    }
    volume_ = {};
    volume_.isInside = containment == Containment::inside;
    // Of the planes' numbers, of their products with coordinates, and of the sums.
    volume_.rounding = 4 * std::numeric_limits<Scalar>::epsilon();
    for (std::size_t k = 0; k < all.size(); ++k) {
        const PlaneOfDoubles& plane = all[k];
        if (k >= ownCount && !plane.coeffs().template cast<Scalar>().allFinite()) {
            continue;  // beyond the range of numbers, and not needed
        }
        const std::uint32_t i = volume_.planeCount++;
        for (int axis = 0; axis < 3; ++axis) {
            volume_.slope[axis][i] = static_cast<Scalar>(plane.normal()[axis]);
        }
        volume_.offset[i] = static_cast<Scalar>(plane.offset());
    }
    volume_.ownPlaneCount = static_cast<std::uint32_t>(ownCount);
    volume_.testedPlaneCount = testsAll ? volume_.planeCount : volume_.ownPlaneCount;
}

// The arithmetic of the kernels (detail/kernel_volume.inl), and a rule for infinite boxes.
template <class Scalar>
Scalar ConvexRegion<Scalar>::key(const Aabb<Scalar>& box) const noexcept {
    if (isEmpty_ || hasNan(box)) {
        return -1;
    }
    for (std::uint32_t i = 0; i < volume_.testedPlaneCount; ++i) {
        Scalar sum = volume_.offset[i];
        Scalar size = std::abs(sum);
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar slope = volume_.slope[axis][i];
            if (slope != 0) {
                const bool takesMax = (slope > 0) != volume_.isInside;
                const Scalar term = slope * (takesMax ? box.max() : box.min())[axis];
                sum += term;
                size += std::abs(term);
            }
        }
        // A box that reaches to infinity is inside of nothing there, and may touch anything.
        const bool isOutside =
            std::isinf(size) ? volume_.isInside && !(sum > 0) : sum < -volume_.rounding * size;
        if (isOutside) {
            return -1;
        }
    }
    return 0;
}

template class ConvexRegion<float>;
template class ConvexRegion<double>;

}  // namespace hashphase
