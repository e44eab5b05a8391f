// SPDX-License-Identifier: Zlib
#pragma once

// Convex volumes, such as frusta, as regions for queries.

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

/// How much of a box must be in a volume: at least one point (touching), or the whole box (inside).
enum class Containment : std::uint8_t { touching, inside };

/// Which boxes count as touching. exact: boxes that share a point with the volume. byPlanes: faster, but also finds
/// a few boxes outside the volume, near its edges. byPlanes rejects a box only if it lies wholly outside one
/// plane of the volume, or if the projections of box and volume onto the yz plane do not touch.
/// Containment::inside ignores Touch.
enum class Touch : std::uint8_t { exact, byPlanes };

/// Finds every box that touches a convex volume, or that lies wholly inside it (see Containment). The volume is the
/// set of points p with plane.signedDistance(p) >= 0 for each plane. Every box found has key 0. Boxes in cells
/// wholly inside the volume need no test. Cost: as Grid::visit().
///
/// The volume contains its surface. Because of rounding, queries may also find boxes outside, at a distance up to
/// about 1e-6 times the largest coordinate (double precision: 1e-9 times). Without planes, the volume is all of
/// space. A volume is empty if it contains no point, or if a plane has a NaN or an infinite normal.
template <class Scalar>
class HASHPHASE_BROADPHASE_TEMPLATE_EXPORT ConvexRegion {
public:
    using Plane = Eigen::Hyperplane<Scalar, 3>;
    static constexpr std::size_t kMostPlanes = detail::kMostOwnPlanes;

    /// Plane normals must point inwards, and may have any length. Asserted: at most kMostPlanes planes. Cost: O(p^4)
    /// for p planes; a few microseconds for a frustum.
    explicit ConvexRegion(std::span<const detail::Plane<Scalar>> planes,
                          Containment containment = Containment::touching,
                          Touch touch = Touch::exact);

    /// Like the first constructor, for an array, a vector or a span of Plane.
    template <class Planes>
        requires std::same_as<std::ranges::range_value_t<Planes>, Plane>
    explicit ConvexRegion(const Planes& planes, Containment containment = Containment::touching,
                          Touch touch = Touch::exact)
        : ConvexRegion(unaligned(planes), containment, touch) {}

    [[nodiscard]] Scalar key(const Aabb<Scalar>& box) const noexcept;

    /// True when the volume is empty, so no box is found.
    [[nodiscard]] bool isEmpty() const noexcept { return isEmpty_; }

    /// True when `other` is empty, or when it lies inside this volume, at least `margin` [m] from every plane of this
    /// volume. False if rounding leaves doubt, or if the corners of `other` cannot be computed.
    [[nodiscard]] bool contains(const ConvexRegion& other, Scalar margin = 0) const;

    /// Returns the volume with its planes moved outwards by `distance` [m]. The result contains every point within
    /// `distance` of this volume.
    [[nodiscard]] ConvexRegion grownBy(Scalar distance) const;

    /// Returns this volume with Touch::exact.
    [[nodiscard]] ConvexRegion exact() const;

    /// True when a and b have equal planes in the same order, equal Containment and equal Touch. Volumes that are
    /// empty because of a NaN may compare equal even if their planes differ.
    friend bool operator==(const ConvexRegion& a, const ConvexRegion& b) noexcept {
        return a.isSameAs(b);
    }

    /// The planes that grids test: the given planes, and derived planes that reject more boxes.
    [[nodiscard]] const detail::Volume<Scalar>& volume() const noexcept { return volume_; }

private:
    // The library's plane type, which needs no SIMD alignment.
    using OwnPlane = detail::Plane<Scalar>;
    // Has space for one plane too many, for the constructor's assertion.
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
    std::uint32_t ownPlaneCount_ = 0;  // number of given planes, first in volume_
    bool isExact_ = false;
    bool isEmpty_ = false;
};

extern template class ConvexRegion<float>;
extern template class ConvexRegion<double>;

}  // namespace hashphase
