// SPDX-License-Identifier: Zlib
#pragma once

// A camera and the window that it draws to: from pixels to rays and rectangles.
//
//     const Camera<float> camera(viewProjection, DepthRange::zeroToOne, Viewport(0, 0, 1920, 1080));
//     const Picked<float> picked = pickNearest(grid, camera.rayThrough({mouseX + 0.5, mouseY + 0.5}));
//
// Cameras   All cameras of frustum.hpp: perspective, orthographic, oblique, with a reversed depth range or an
//           infinite far plane. Computed in double precision, and rounded once at the end.
// Pixels    x to the right and y downwards, as in windows. Fractions count: the middle of the pixel in
//           column i and row k is (i + 0.5, k + 0.5).
// Units     metres in the world
// Bad data  A camera whose matrix has no inverse, or whose viewport has no size, sees nothing: its rays and
//           rectangles are empty, and cameraError() says why. So are those of a pixel that is NaN.
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

/// A place in the window: x to the right, y downwards [pixels].
using Pixel = detail::Vector2<double>;

/// The part of the window that the camera draws to [pixels].
struct Viewport {
    double x = 0;       ///< of the upper left corner
    double y = 0;       ///< of the upper left corner
    double width = 0;   ///< above 0
    double height = 0;  ///< above 0

    constexpr Viewport() = default;

    /// Takes numbers of any type: window systems give sizes as integers.
    template <class X, class Y, class Width, class Height>
        requires(std::is_arithmetic_v<X>&& std::is_arithmetic_v<Y>&& std::is_arithmetic_v<Width>&&
                     std::is_arithmetic_v<Height>)
    constexpr Viewport(X left, Y top, Width columns, Height rows) noexcept
        : x(static_cast<double>(left)),
          y(static_cast<double>(top)),
          width(static_cast<double>(columns)),
          height(static_cast<double>(rows)) {}
};

/// Whether the near plane has the lowest depth (nearFirst) or the highest one (reversed). Matters for
/// orthographic cameras only; all other matrices show it themselves.
enum class DepthOrder : std::uint8_t { nearFirst, reversed };

namespace detail {

template <class Scalar>
[[nodiscard]] HASHPHASE_CAMERA_EXPORT std::string cameraError(const Matrix4<Scalar>& viewProjection,
                                                              const Viewport& viewport);

}  // namespace detail

/// Says in a sentence why nothing can be seen or picked through the matrix, 4 x 4, in the viewport: not
/// finite, singular, or a viewport without a size. Empty when something may be seen.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline std::string cameraError(
    const Eigen::Matrix<Scalar, 4, 4>& viewProjection, const Viewport& viewport) {
    return detail::cameraError<Scalar>(viewProjection, viewport);
}

/// A camera and the part of the window that it draws to.
template <class Scalar>
class HASHPHASE_CAMERA_TEMPLATE_EXPORT Camera {
public:
    using Matrix = Eigen::Matrix<Scalar, 4, 4>;

    /// `viewProjection` is 4 x 4, from world to clip coordinates (frustum.hpp). Bad data makes a camera that
    /// is not valid; nothing is thrown. Cost: inverts the matrix, once.
    template <class Derived>
    Camera(const Eigen::MatrixBase<Derived>& viewProjection, DepthRange depthRange,
           const Viewport& viewport, DepthOrder depthOrder = DepthOrder::nearFirst)
        : Camera(Unaligned{viewProjection}, depthRange, viewport, depthOrder) {}

    /// False when cameraError() is not empty.
    [[nodiscard]] bool isValid() const noexcept { return isValid_; }

    /// Returns the ray that is seen at a pixel, in the viewport or beside it. It leads from the near plane to
    /// the far plane, but no farther than `farthest` [m] behind the near plane, as measured along the
    /// camera's view; the ray of an orthographic camera always ends on the far plane. Empty
    /// (RayRegion::isEmpty()) where nothing is seen, or `farthest` is not positive.
    [[nodiscard]] RayRegion<Scalar> rayThrough(const Pixel& pixel,
                                               double farthest = kFarthestView) const;

    /// Returns the part of the rectangle between two corners, in any order, that lies in the viewport, in
    /// normalised device coordinates. It may have no area. isEmpty() when no part lies in the viewport.
    // A template, as viewProjection() is, so that the library has no result that is aligned by its options.
    template <class Rectangle = ScreenRectangle<Scalar>>
    [[nodiscard, HASHPHASE_ALWAYS_INLINE]] Rectangle rectangleBetween(const Pixel& a,
                                                                      const Pixel& b) const {
        using Corner = typename Rectangle::VectorType;
        const detail::ScreenEdges<Scalar> edges = edgesBetween(a, b);
        return {Corner(edges[0], edges[1]), Corner(edges[2], edges[3])};
    }

    /// rectangleBetween() as left, bottom, right and top.
    [[nodiscard]] detail::ScreenEdges<Scalar> edgesBetween(const Pixel& a, const Pixel& b) const;

    /// As given.
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
