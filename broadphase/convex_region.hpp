// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/aabb.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/core/unaligned.hpp>
#include <broadphase/export.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>

namespace hashphase {

/// How much of a box has to be in a volume: any point (touching), or the whole box (inside).
enum class Containment : std::uint8_t { touching, inside };

/// Which boxes touch a volume. exact: the boxes that share a point with it. byPlanes: the boxes that no plane
/// has wholly outside, of the volume's own planes and of its outline along the x axis. byPlanes takes less
/// time, and finds a few more boxes near the volume's edges.
enum class Touch : std::uint8_t { exact, byPlanes };

/// Every box that touches a convex volume, or lies wholly inside. The volume is the set of points p with
/// plane.signedDistance(p) >= 0 for each plane. Key: 0. Cells that lie wholly inside are taken without a test
/// of their boxes; a query costs at most one pass over all boxes, as Grid::visit() says.
///
/// Closed, and rounding errs to the side of a hit: by about 1e-6 of the coordinates' size in single
/// precision, 1e-9 in double. A volume may be unbounded; without planes it is all of space. A volume without
/// a point, or with a plane that is NaN or has an infinite normal, is empty.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT ConvexRegion {
public:
    using Plane = Eigen::Hyperplane<Scalar, 3>;
    static constexpr std::size_t kMostPlanes = detail::kMostOwnPlanes;

    /// Takes at most kMostPlanes planes (asserted), which face inwards, with normals of any length. Cost:
    /// some microseconds for a frustum; grows with the fourth power of the number of planes.
    explicit ConvexRegion(std::span<const detail::Plane<Scalar>> planes,
                          Containment containment = Containment::touching,
                          Touch touch = Touch::exact);

    /// Takes an array, a vector or a span of Plane, as above.
    template <class Planes>
        requires std::same_as<std::ranges::range_value_t<Planes>, Plane>
    explicit ConvexRegion(const Planes& planes, Containment containment = Containment::touching,
                          Touch touch = Touch::exact)
        : ConvexRegion(unaligned(planes), containment, touch) {}

    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept;

    /// True when no box has a key.
    [[nodiscard]] bool isEmpty() const noexcept { return isEmpty_; }

    /// True when every point of `other` lies inside of this volume, and at least `margin` [m] away from each
    /// of its planes. False where rounding leaves this in doubt, and where `other` has no corners.
    [[nodiscard]] bool contains(const ConvexRegion& other, Scalar margin = 0) const;

    /// The volume with its planes moved outwards by `distance` [m]. It holds every point within that distance
    /// of this volume.
    [[nodiscard]] ConvexRegion grownBy(Scalar distance) const;

    /// The same volume with Touch::exact.
    [[nodiscard]] ConvexRegion exact() const;

    /// True when both have equal planes in the same order, and equal Containment and Touch. False for a plane
    /// that is NaN.
    friend bool operator==(const ConvexRegion& a, const ConvexRegion& b) noexcept {
        return a.isSameAs(b);
    }

    /// For grids: the planes given, and more planes that bound the volume for boxes.
    [[nodiscard]] const detail::Volume<Scalar>& volume() const noexcept { return volume_; }

private:
    // As the library takes them: unaligned.
    using OwnPlane = detail::Plane<Scalar>;
    // One more than may be, which is asserted.
    using PlaneList = detail::FixedList<OwnPlane, kMostPlanes + 1>;

    ConvexRegion(const PlaneList& planes, Containment containment, Touch touch)
        : ConvexRegion(std::span<const OwnPlane>(planes.begin(), planes.end()), containment,
                       touch) {}

    template <class Planes>
    [[nodiscard]] static PlaneList unaligned(const Planes& planes) {
        PlaneList list;
        for (const auto& plane : planes) {
            list.push(OwnPlane(plane));
        }
        return list;
    }

    [[nodiscard]] bool isSameAs(const ConvexRegion& other) const noexcept;
    [[nodiscard]] detail::FixedList<OwnPlane, kMostPlanes> ownPlanes() const;
    [[nodiscard]] ConvexRegion movedOut(Scalar distance, Touch touch) const;

    detail::Volume<Scalar> volume_;
    std::uint32_t ownPlaneCount_ = 0;  // the volume's first planes
    bool isExact_ = false;
    bool isEmpty_ = false;
};

extern template class ConvexRegion<float>;
extern template class ConvexRegion<double>;

}  // namespace hashphase
