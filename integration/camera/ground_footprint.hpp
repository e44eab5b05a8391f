// SPDX-License-Identifier: Zlib
#pragma once

// What a camera sees of the ground: the shadow that a rectangle of the screen casts on a map.
//
// Footprint  The part of the view (frustum.hpp) between two heights, projected along the up axis: a
//            convex polygon. It contains the view's cuts with both heights and all that lies between, so
//            that every object which the view touches between the heights stands on it. With equal heights
//            it is the view's cut with that plane. Under perspective, or with a turned camera, this is a
//            general quadrilateral, which two corners do not give; it has fewer or more corners where the
//            near or the far plane cuts it.
// Horizon    Rays that never come down to the ground end on the far plane, or `farthest` behind the near
//            plane if that is nearer: there the footprint is cut off. The rays of an orthographic camera
//            always end on the far plane.
// Units      metres
// Bad data   With a singular matrix, heights that are NaN or exchanged, or a `farthest` that is not positive
//            and finite, the footprint is empty, and footprintError() says why. Without an error it is empty
//            when the camera sees no ground.

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

/// Views with a farther far plane end here by default [m behind the near plane].
inline constexpr double kFarthestView = 1e6;

/// From the lowest to the highest point of all that stands on the ground.
template <class Scalar>
struct HeightRange {
    Scalar low = 0;   ///< [m]; -infinity for no limit
    Scalar high = 0;  ///< [m]; infinity for no limit
    UpAxis up = UpAxis::y;
};

/// A convex polygon on the map, and the prism over it between two heights. Corrects the paper's drag
/// box and top-down camera, which take two corners and one height.
template <class Scalar>
class HASHPHASE_CAMERA_TEMPLATE_EXPORT GroundFootprint {
public:
    /// A point of the map [m]: (y, z), (x, z) or (x, y), where x, y or z is upwards.
    using Point = detail::Vector2<Scalar>;

    /// A polyhedron with nine planes, as of the view between the heights, has at most 14 corners.
    static constexpr std::size_t kMostCorners = 14;

    /// The footprint of the view through the matrix, 4 x 4 (frustum.hpp), in a rectangle of the screen,
    /// between these heights, up to `farthest` [m] behind the near plane. Cost: some microseconds.
    template <class Derived>
    GroundFootprint(const Eigen::MatrixBase<Derived>& viewProjection, DepthRange depthRange,
                    const HeightRange<Scalar>& heights,
                    const ScreenRectangle<Scalar>& rectangle = wholeScreen<Scalar>(),
                    double farthest = kFarthestView)
        : GroundFootprint(Unaligned{viewProjection}, depthRange, heights,
                          detail::edgesOf<Scalar>(rectangle), farthest) {}

    [[nodiscard]] bool isEmpty() const noexcept { return corners_.empty(); }

    /// The corners of the polygon, in the order in which the first axis turns towards the second. One or two
    /// corners where the footprint has no area.
    [[nodiscard]] std::span<const Point> corners() const noexcept {
        return {corners_.begin(), corners_.end()};
    }

    /// Returns the vertical prism over the polygon between the heights, for boxes that touch it or lie wholly
    /// inside. Every box that touches the view between the heights touches the prism. Cost: as a
    /// ConvexRegion.
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

/// Says in a sentence why there is no footprint: see Bad data. Empty when there may be one.
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
