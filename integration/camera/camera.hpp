// SPDX-License-Identifier: Zlib
#pragma once

// A camera and the window that it draws to: from pixels to rays and rectangles.
//
// Cameras   any that frustum.hpp knows: perspective, orthographic, oblique, with a reversed depth
//           range or an infinite far plane. Computed in double precision throughout, and rounded once
//           at the end.
// Pixels    x to the right and y downwards, as in windows; any numbers, not only whole ones: the
//           middle of the pixel in column i and row k is (i + 0.5, k + 0.5).
// Units     metres in the world
// Bad data  A view that has no inverse or no size sees nothing: its rays and rectangles are empty, and
//           cameraError() says why. So are those of pixels that are NaN.
// Threads   values; use them from any thread

#include <broadphase/regions.hpp>
#include <integration/camera/detail/camera_inverse.hpp>
#include <integration/camera/export.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/camera/ground_footprint.hpp>

#include <cstdint>
#include <string>
#include <type_traits>

namespace hashphase {

/// A place in the window.
using Pixel = Eigen::Vector2d;

/// The part of the window that the camera draws to, in pixels; (x, y) is its upper left corner.
struct Viewport {
    double x = 0;
    double y = 0;
    double width = 0;
    double height = 0;

    constexpr Viewport() = default;

    /// Of any numbers: windows tell their sizes as whole ones.
    template <class X, class Y, class Width, class Height>
        requires(std::is_arithmetic_v<X>&& std::is_arithmetic_v<Y>&& std::is_arithmetic_v<Width>&&
                     std::is_arithmetic_v<Height>)
    constexpr Viewport(X left, Y top, Width columns, Height rows) noexcept
        : x(static_cast<double>(left)),
          y(static_cast<double>(top)),
          width(static_cast<double>(columns)),
          height(static_cast<double>(rows)) {}
};

/// Which end of the depth range is near. Asked about orthographic cameras only; of all others the
/// matrix says so itself.
enum class DepthOrder : std::uint8_t { nearFirst, reversed };

/// Says in a sentence why nothing can be seen or picked through the matrix, 4 x 4, in the viewport;
/// empty when something may be.
template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::string cameraError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, const Viewport& viewport);

/// A camera and the part of the window that it draws to.
template <class Scalar>
class HASHPHASE_CAMERA_EXPORT Camera {
public:
    using Matrix = Eigen::Matrix<Scalar, 4, 4>;

    /// Cost: inverts the matrix, once.
    Camera(const Matrix& viewProjection, DepthRange depthRange, const Viewport& viewport,
           DepthOrder depthOrder = DepthOrder::nearFirst);

    /// False when cameraError() says something.
    [[nodiscard]] bool isValid() const noexcept { return isValid_; }

    /// All that is seen at a pixel, in the viewport or beside it: from the near plane to the far
    /// plane, or, where that is farther away or at infinity, to what is `farthest` [m] behind the near
    /// plane, as measured along the camera's view. Empty where nothing is, or `farthest` is not
    /// positive.
    [[nodiscard]] RayRegion<Scalar> rayThrough(const Pixel& pixel,
                                               double farthest = kFarthestView) const;

    /// The rectangle between two corners, in any order, as far as it lies in the viewport; perhaps
    /// without area. isEmpty() when none of it does.
    [[nodiscard]] ScreenRectangle<Scalar> rectangleBetween(const Pixel& a, const Pixel& b) const;

    [[nodiscard]] Matrix viewProjection() const noexcept { return viewProjection_; }
    [[nodiscard]] DepthRange depthRange() const noexcept { return depthRange_; }
    [[nodiscard]] const Viewport& viewport() const noexcept { return viewport_; }

private:
    [[nodiscard]] Eigen::Vector2d deviceCoordinates(const Pixel& pixel) const;

    // Not aligned: see integration/guide/abi.md.
    Eigen::Matrix<Scalar, 4, 4, Eigen::DontAlign> viewProjection_;
    detail::CameraInverse inverse_;
    Viewport viewport_;
    DepthRange depthRange_;
    DepthOrder depthOrder_;
    bool isValid_;
};

extern template class Camera<float>;
extern template class Camera<double>;

}  // namespace hashphase
