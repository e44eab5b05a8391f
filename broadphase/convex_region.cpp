// SPDX-License-Identifier: Zlib
#include <broadphase/convex_region.hpp>

#include <broadphase/diagnostics.hpp>

#include <algorithm>

namespace hashphase {

template <class Scalar>
ConvexRegion<Scalar>::ConvexRegion(std::span<const Plane> planes, Containment containment)
    : containment_(containment), planeCount_(std::min(planes.size(), kMostPlanes)) {
    HASHPHASE_ASSERT(planes.size() <= kMostPlanes, "A convex region has at most 16 planes.");
    std::copy_n(planes.begin(), planeCount_, planes_.begin());
    for (const Plane& plane : planes.first(planeCount_)) {
        isEmpty_ = isEmpty_ || plane.coeffs().hasNaN();
    }
}

template <class Scalar>
Scalar ConvexRegion<Scalar>::key(const Aabb<Scalar>& box) const noexcept {
    // Of the plane's numbers, of their products and of the sums.
    constexpr Scalar rounding = 4 * std::numeric_limits<Scalar>::epsilon();
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    if (isEmpty_ || hasNan(box)) {
        return -1;
    }
    for (const Plane& plane : planes()) {
        Scalar sum = 0;
        Scalar size = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const Scalar slope = plane.coeffs()[axis];
            if (slope == 0) {
                continue;  // not 0 * infinity
            }
            const bool takesMax = (slope > 0) == (containment_ == Containment::touching);
            const Scalar term = slope * (takesMax ? box.max() : box.min())[axis];
            sum += term;
            size += std::abs(term);
        }
        sum += plane.offset();
        size += std::abs(plane.offset());
        // Of a sum of opposite infinities nothing is known.
        const bool isOutside = sum < -rounding * size || sum == -infinity ||
                               (sum != sum && containment_ == Containment::inside);
        if (isOutside) {
            return -1;
        }
    }
    return 0;
}

template class ConvexRegion<float>;
template class ConvexRegion<double>;

}  // namespace hashphase
