// SPDX-License-Identifier: Zlib
#pragma once

// The part of the ground that a camera sees: the footprint of a screen rectangle on a map.
//
// Footprint  A convex polygon: the part of the view (frustum.hpp) between two heights, projected along the up axis.
//            On the map, the polygon touches every object that the view touches between the heights. If the heights
//            are equal, the polygon is the intersection of the view and the plane at that height.
// Horizon    Perspective views end at the far plane or `farthest` beyond the near plane, whichever is nearer.
//            Orthographic views always end at the far plane.
// Units      metres
// Bad data   The footprint is empty if the matrix or the rectangle is bad (frustum.hpp), the matrix is singular, a
//            height is NaN, `low` is above `high`, both heights are the same infinity, or `farthest` is not positive
//            or not finite. footprintError() returns the reason. If there is no error, an empty footprint means that
//            the camera sees no ground.

#include <broadphase/convex_region.hpp>
#include <broadphase/core/fixed_list.hpp>
#include <broadphase/up_axis.hpp>
#include <integration/camera/export.hpp>
#include <integration/camera/frustum.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace hashphase {

/// Default of `farthest`: views end at most this far beyond the near plane [m].
inline constexpr double kFarthestView = 1e6;

/// The heights between which all objects on the ground lie.
template <class Scalar>
struct HeightRange {
    Scalar low = 0;   ///< [m]; -infinity for no limit
    Scalar high = 0;  ///< [m]; infinity for no limit
    UpAxis up = UpAxis::y;
};

/// A convex polygon on the map, and the vertical prism over the polygon between two heights.
template <class Scalar>
class HASHPHASE_CAMERA_TEMPLATE_EXPORT GroundFootprint {
public:
    /// A point of the map [m]: (y, z) if x is up, (x, z) if y is up, (x, y) if z is up.
    using Point = detail::Vector2<Scalar>;

    /// Maximum number of corners: the view's six planes, two heights and `farthest` enclose a polyhedron that has at
    /// most 14.
    static constexpr std::size_t kMostCorners = 14;

    /// Takes a 4 x 4 matrix (frustum.hpp), the heights, and a rectangle of the screen. A perspective view ends at
    /// most `farthest` [m] beyond the near plane. Cost: some microseconds.
    template <class Derived>
    GroundFootprint(const Eigen::MatrixBase<Derived>& viewProjection, DepthRange depthRange,
                    const HeightRange<Scalar>& heights,
                    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>(),
                    double farthest = kFarthestView)
        : GroundFootprint(Unaligned{viewProjection}, depthRange, heights,
                          detail::edgesOf<Scalar>(rectangle), farthest) {}

    [[nodiscard]] bool isEmpty() const noexcept { return corners_.empty(); }

    /// The polygon's corners, in the direction of rotation from the first axis of Point to the second. If the
    /// polygon is only a point, there is one corner; if it is a line, two; if it is empty, none.
    [[nodiscard]] std::span<const Point> corners() const noexcept {
        return {corners_.begin(), corners_.end()};
    }

    /// Returns the vertical prism over the polygon as a query region. `containment` selects boxes that touch the
    /// prism, or only boxes inside. Every box that touches the view between the heights touches the prism. Cost: as
    /// making a ConvexRegion.
    [[nodiscard]] ConvexRegion<Scalar> region(
        Containment containment = Containment::touching) const;

private:
    using Plane = detail::Plane<Scalar>;
    struct Unaligned {
        detail::Matrix4<Scalar> viewProjection;
    };

    GroundFootprint(const Unaligned& matrix, DepthRange depthRange,
                    const HeightRange<Scalar>& heights, const detail::ScreenEdges<Scalar>& edges,
                    double farthest);
    template <class Points>
    void setHull(const Points& points, const HeightRange<Scalar>& heights);

    detail::FixedList<Point, kMostCorners> corners_;
    detail::FixedList<Plane, kMostCorners + 2> planes_;
};

template <class Derived, class Scalar, class... Rest>
GroundFootprint(const Eigen::MatrixBase<Derived>&, DepthRange, const HeightRange<Scalar>&, Rest...)
    -> GroundFootprint<Scalar>;

namespace detail {

template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::string footprintError(
    const Matrix4<Scalar>& viewProjection, const HeightRange<Scalar>& heights,
    const ScreenEdges<Scalar>& edges, double farthest);

}  // namespace detail

/// Returns a sentence that explains why the footprint is empty (see Bad data). Returns an empty string if the data
/// are good, even if the camera sees no ground.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::string footprintError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, const HeightRange<Scalar>& heights,
    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>(),
    double farthest = kFarthestView) {
    return detail::footprintError<Scalar>(viewProjection, heights,
                                          detail::edgesOf<Scalar>(rectangle), farthest);
}

extern template class GroundFootprint<float>;
extern template class GroundFootprint<double>;

}  // namespace hashphase
