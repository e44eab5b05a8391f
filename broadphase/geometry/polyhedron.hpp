// SPDX-License-Identifier: Zlib
#pragma once

// The corners of a convex volume that is given by planes, and the planes by which boxes see it.

#include <broadphase/aabb.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/core/unaligned.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <cstdint>

namespace hashphase::detail {

/// The points p with plane.signedDistance(p) >= 0 for each plane.
class Polyhedron {
public:
    using Plane = detail::Plane<double>;
    using Planes = FixedList<Plane, kMostVolumePlanes>;

    /// The planes are finite, their normals of length 1 or 0, and there are at most 16. Cost:
    /// O(planes^4).
    explicit Polyhedron(const Planes& planes);

    /// True when no point is on the right side of all planes. What rounding leaves in doubt is not.
    [[nodiscard]] bool isEmpty() const noexcept { return corners_.empty(); }

    /// True when every point of the volume lies on the right side of the plane, of which the normal has
    /// length 1 or 0, and at least `margin` away from it; false where that is in doubt, and for volumes
    /// without a corner.
    [[nodiscard]] bool isInside(const Plane& plane, double margin) const;

    /// Appends planes around the volume, of which none cuts off a point of it: across the y and z axes,
    /// and along the x axis through edges that are seen from there; none where the volume has no
    /// corner, and no more than there is room for. With `isExact`, those of the other axes as well: as
    /// many as it takes that a box touches the volume unless a plane has all of it outside, by the
    /// theorem of separating axes.
    void appendSilhouettes(bool isExact, Planes& planes) const;

private:
    struct Corner {
        Vector3<double> point;
        double error = 0;          // how far off it may be
        std::uint32_t planes = 0;  // bit i: it lies in plane i
    };
    struct Direction {
        Vector3<double> way;
        std::uint32_t planes = 0;
    };

    void findCorners(const Planes& planes);
    void findSlice(const Planes& planes);
    void addCorner(Corner corner, const Planes& planes);
    void findDirections(const Planes& planes);
    void appendAround(const Vector3<double>& normal, Planes& planes) const;
    void appendAlong(int axis, const Corner& corner, const Vector3<double>& edge, double error,
                     Planes& planes) const;

    FixedList<Corner, 64> corners_;
    FixedList<Direction, 64> directions_;  // of the edges that go on for ever
    bool spansSpace_ = false;              // the normals do
    bool hasTooMany_ = false;              // corners or directions to be listed
};

}  // namespace hashphase::detail
