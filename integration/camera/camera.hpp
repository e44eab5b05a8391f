// SPDX-License-Identifier: Zlib
#pragma once

// A camera and its viewport: converts pixels to rays and rectangles.
//
//     const Camera<float> camera(viewProjection, DepthRange::zeroToOne, Viewport(0, 0, 1920, 1080));
//     const Picked<float> picked = pickNearest(grid, camera.rayThrough({mouseX + 0.5, mouseY + 0.5}));
//
// Cameras   Uses any matrix that frustum.hpp accepts. Results are computed in double precision, and rounded once at
//           the end.
// Pixels    The middle of the pixel in column i and row k is (i + 0.5, k + 0.5).
// Units     metres in the world
// Bad data  Rays and rectangles are empty if the matrix has no inverse, the viewport has no size, or a pixel is NaN.
//           cameraError() explains faults of the matrix and viewport.
// Threads   Several threads may call const functions of a Camera at once.

#include <broadphase/regions.hpp>
#include <integration/camera/detail/camera_inverse.hpp>
#include <integration/camera/export.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/camera/ground_footprint.hpp>

#include <cstdint>
#include <string>
#include <type_traits>

namespace hashphase {

/// A position in the window: x to the right, y downwards [pixels].
using Pixel = detail::Vector2<double>;

/// The part of the window that the camera draws to [pixels].
struct Viewport {
    double x = 0;       ///< left edge
    double y = 0;       ///< top edge
    double width = 0;   ///< more than 0
    double height = 0;  ///< more than 0

    constexpr Viewport() = default;

    /// Takes numbers of any type, such as integers from a window system.
    template <class X, class Y, class Width, class Height>
        requires(std::is_arithmetic_v<X>&& std::is_arithmetic_v<Y>&& std::is_arithmetic_v<Width>&&
                     std::is_arithmetic_v<Height>)
    constexpr Viewport(X left, Y top, Width columns, Height rows) noexcept
        : x(static_cast<double>(left)),
          y(static_cast<double>(top)),
          width(static_cast<double>(columns)),
          height(static_cast<double>(rows)) {}
};

/// The depth of the near plane: the lowest (nearFirst) or the highest (reversed). Ignored for perspective cameras.
enum class DepthOrder : std::uint8_t { nearFirst, reversed };

namespace detail {

template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::string cameraError(const Matrix4<Scalar>& viewProjection,
                                                              const Viewport& viewport);

}  // namespace detail

/// Returns a sentence that explains why nothing is visible through the 4 x 4 matrix and the viewport: the matrix is
/// singular, a number is not finite, or the viewport has no size. Returns an empty string if there is no fault.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::string cameraError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, const Viewport& viewport) {
    return detail::cameraError<Scalar>(viewProjection, viewport);
}

/// A camera and its viewport.
template <class Scalar>
class HASHPHASE_CAMERA_TEMPLATE_EXPORT Camera {
public:
    using Matrix = Eigen::Matrix<Scalar, 4, 4>;

    /// Takes a 4 x 4 matrix that transforms world coordinates to clip coordinates (frustum.hpp). Does not throw for
    /// bad data: isValid() returns false instead. Cost: one inversion of the matrix.
    template <class Derived>
    Camera(const Eigen::MatrixBase<Derived>& viewProjection, DepthRange depthRange,
           const Viewport& viewport, DepthOrder depthOrder = DepthOrder::nearFirst)
        : Camera(Unaligned{viewProjection}, depthRange, viewport, depthOrder) {}

    /// Returns false if cameraError() is not empty.
    [[nodiscard]] bool isValid() const noexcept { return isValid_; }

    /// Returns the ray through a pixel, from the near plane to the far plane. The pixel may be outside the viewport.
    /// A perspective ray ends at most `farthest` [m] beyond the near plane, measured along the view direction. An
    /// orthographic ray always ends on the far plane. The ray is empty (RayRegion::isEmpty()) if the camera is
    /// invalid, the pixel is NaN, all points under the pixel are behind the camera, or `farthest` is not positive.
    [[nodiscard]] RayRegion<Scalar> rayThrough(const Pixel& pixel,
                                               double farthest = kFarthestView) const;

    /// Takes two opposite corners of a rectangle in any order. Returns the part of the rectangle inside the viewport,
    /// in normalised device coordinates. This part may be a line or a point. The part is empty (isEmpty()) if the
    /// rectangle is outside the viewport.
    // A template, like viewProjection(), because the alignment of Eigen types depends on compiler options.
    template <class Rectangle = ScreenRectangle<Scalar>>
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] Rectangle rectangleBetween(const Pixel& a,
                                                                      const Pixel& b) const {
        using Corner = typename Rectangle::VectorType;
        const detail::ScreenEdges<Scalar> edges = edgesBetween(a, b);
        return {Corner(edges[0], edges[1]), Corner(edges[2], edges[3])};
    }

    /// As rectangleBetween(), but returns the left, bottom, right and top edges.
    [[nodiscard]] detail::ScreenEdges<Scalar> edgesBetween(const Pixel& a, const Pixel& b) const;

    /// The matrix that the constructor took.
    template <class Result = Matrix>
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] Result viewProjection() const noexcept {
        return viewProjection_;
    }
    [[nodiscard]] DepthRange depthRange() const noexcept { return depthRange_; }
    [[nodiscard]] const Viewport& viewport() const noexcept { return viewport_; }

private:
    struct Unaligned {
        detail::Matrix4<Scalar> viewProjection;
    };
    Camera(const Unaligned& matrix, DepthRange depthRange, const Viewport& viewport,
           DepthOrder depthOrder);
    [[nodiscard]] detail::Vector2<double> deviceCoordinates(const Pixel& pixel) const;

    detail::Matrix4<Scalar> viewProjection_;
    detail::CameraInverse inverse_;
    Viewport viewport_;
    DepthRange depthRange_;
    DepthOrder depthOrder_;
    bool isValid_;
};

template <class Derived>
Camera(const Eigen::MatrixBase<Derived>&, DepthRange, const Viewport&,
       DepthOrder = DepthOrder::nearFirst) -> Camera<typename Derived::Scalar>;

extern template class Camera<float>;
extern template class Camera<double>;

}  // namespace hashphase
