// SPDX-License-Identifier: Zlib
#include <broadphase/convex_region.hpp>

#include <broadphase/diagnostics.hpp>
#include <broadphase/geometry/polyhedron.hpp>

#include <algorithm>
#include <array>
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
ConvexRegion<Scalar>::ConvexRegion(std::span<const detail::Plane<Scalar>> planes,
                                   Containment containment, Touch touch) {
    HASHPHASE_ASSERT(
        planes.size() <= kMostPlanes,
        "ConvexRegion: more than 16 planes were given. Pass at most 16 planes (kMostPlanes).");
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    detail::Polyhedron::Planes all;
    for (const OwnPlane& plane : planes.first(std::min(planes.size(), kMostPlanes))) {
        const PlaneOfDoubles scaled = normalised(plane);
        const auto offset = static_cast<Scalar>(scaled.offset());
        isEmpty_ = isEmpty_ || !scaled.normal().allFinite() || !(offset > -infinity);
        if (offset < infinity) {  // else there is no number beyond it
            all.push(scaled);
        }
    }
    const std::size_t ownCount = all.size();
    // What lies inside needs no more than the volume's own planes.
    isExact_ = touch == Touch::exact && containment == Containment::touching;
    if (!isEmpty_) {
        const detail::Polyhedron polyhedron(all);
        isEmpty_ = polyhedron.isEmpty();
        polyhedron.appendSilhouettes(isExact_, all);
    }
    volume_ = {};
    volume_.isInside = containment == Containment::inside;
    // Of the planes' numbers, of their products with coordinates, and of the sums.
    volume_.rounding = 4 * std::numeric_limits<Scalar>::epsilon();
    volume_.tiny = std::numeric_limits<Scalar>::min();
    for (std::size_t k = 0; k < all.size(); ++k) {
        const PlaneOfDoubles& plane = all[k];
        if (k >= ownCount && !plane.coeffs().template cast<Scalar>().allFinite()) {
            continue;  // beyond the range of numbers, and not needed
        }
        const std::uint32_t i = volume_.planeCount++;
        for (int axis = 0; axis < 3; ++axis) {
            // One that has no inverse is none.
            const auto slope = static_cast<Scalar>(plane.normal()[axis]);
            const bool isOrdinary = std::abs(slope) >= std::numeric_limits<Scalar>::min();
            volume_.slope[axis][i] = isOrdinary ? slope : Scalar(0);
        }
        volume_.offset[i] = static_cast<Scalar>(plane.offset());
    }
    ownPlaneCount_ = static_cast<std::uint32_t>(ownCount);
}

// The arithmetic of the kernels (simd/kernel_volume.inl), and a rule for infinite boxes.
template <class Scalar>
Scalar ConvexRegion<Scalar>::key(const Aabb<Scalar>& box) const noexcept {
    if (isEmpty_ || hasNan(box)) {
        return -1;
    }
    for (std::uint32_t i = 0; i < volume_.planeCount; ++i) {
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

template <class Scalar>
detail::FixedList<detail::Plane<Scalar>, ConvexRegion<Scalar>::kMostPlanes>
ConvexRegion<Scalar>::ownPlanes() const {
    detail::FixedList<OwnPlane, kMostPlanes> planes;
    for (std::uint32_t i = 0; i < ownPlaneCount_; ++i) {
        const Vector3<Scalar> normal(volume_.slope[0][i], volume_.slope[1][i], volume_.slope[2][i]);
        planes.push(OwnPlane(normal, volume_.offset[i]));
    }
    return planes;
}

template <class Scalar>
bool ConvexRegion<Scalar>::isSameAs(const ConvexRegion& other) const noexcept {
    bool isSame = ownPlaneCount_ == other.ownPlaneCount_ && isEmpty_ == other.isEmpty_ &&
                  isExact_ == other.isExact_ && volume_.isInside == other.volume_.isInside;
    for (std::uint32_t i = 0; isSame && i < ownPlaneCount_; ++i) {
        isSame = volume_.offset[i] == other.volume_.offset[i];
        for (int axis = 0; axis < 3; ++axis) {
            isSame = isSame && volume_.slope[axis][i] == other.volume_.slope[axis][i];
        }
    }
    return isSame;
}

template <class Scalar>
bool ConvexRegion<Scalar>::contains(const ConvexRegion& other, Scalar margin) const {
    if (isEmpty_ || other.isEmpty_) {
        return other.isEmpty_;
    }
    detail::Polyhedron::Planes planes;
    for (const OwnPlane& plane : other.ownPlanes()) {
        planes.push(normalised(plane));
    }
    const detail::Polyhedron polyhedron(planes);
    const auto own = ownPlanes();
    return std::all_of(own.begin(), own.end(), [&](const OwnPlane& plane) {
        const bool isEverywhere = plane.normal().isZero(0);  // for all of space is inside of it
        return isEverywhere || polyhedron.isInside(normalised(plane), static_cast<double>(margin));
    });
}

template <class Scalar>
ConvexRegion<Scalar> ConvexRegion<Scalar>::movedOut(Scalar distance, Touch touch) const {
    std::array<OwnPlane, kMostPlanes> planes;
    const auto own = ownPlanes();
    for (std::size_t i = 0; i < own.size(); ++i) {
        planes[i] = own[i];
        const Scalar length = own[i].normal().norm();
        planes[i].offset() += length > 0 ? distance * length : Scalar(0);
    }
    ConvexRegion result(std::span<const OwnPlane>(planes).first(own.size()),
                        volume_.isInside ? Containment::inside : Containment::touching, touch);
    result.isEmpty_ = result.isEmpty_ || isEmpty_;
    return result;
}

template <class Scalar>
ConvexRegion<Scalar> ConvexRegion<Scalar>::grownBy(Scalar distance) const {
    return movedOut(distance, isExact_ ? Touch::exact : Touch::byPlanes);
}

template <class Scalar>
ConvexRegion<Scalar> ConvexRegion<Scalar>::exact() const {
    return movedOut(0, Touch::exact);
}

template class HASHPHASE_INSTANCE_EXPORT ConvexRegion<float>;
template class HASHPHASE_INSTANCE_EXPORT ConvexRegion<double>;

}  // namespace hashphase
