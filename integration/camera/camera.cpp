// SPDX-License-Identifier: Zlib
#include <integration/camera/camera.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase {
namespace {

bool isGood(const Viewport& viewport) {
    return std::isfinite(viewport.x) && std::isfinite(viewport.y) && viewport.width > 0 &&
           viewport.height > 0 && std::isfinite(viewport.width) && std::isfinite(viewport.height);
}

// Weights that differ by less are the same: those of an orthographic camera.
constexpr double kSameWeight = 1e-9;

}  // namespace

template <class Scalar>
std::string detail::cameraError(const Matrix4<Scalar>& viewProjection, const Viewport& viewport) {
    const ScreenEdges<Scalar> wholeScreen{-1, -1, 1, 1};
    if (std::string error = frustumError(viewProjection, wholeScreen); !error.empty()) {
        return error;
    }
    if (!isGood(viewport)) {
        return "The viewport is not finite, or its width or height is not above 0. Pass the part "
               "of the window to draw to [pixels].";
    }
    if (!CameraInverse(viewProjection.template cast<double>()).isValid()) {
        return "The view-projection matrix is singular: it has no inverse. Check the near and far "
               "planes and the field of view.";
    }
    return {};
}

template <class Scalar>
Camera<Scalar>::Camera(const Unaligned& matrix, DepthRange depthRange, const Viewport& viewport,
                       DepthOrder depthOrder)
    : viewProjection_(matrix.viewProjection),
      inverse_(viewProjection_.template cast<double>()),
      viewport_(viewport),
      depthRange_(depthRange),
      depthOrder_(depthOrder),
      isValid_(inverse_.isValid() && isGood(viewport)) {}

template <class Scalar>
detail::Vector2<double> Camera<Scalar>::deviceCoordinates(const Pixel& pixel) const {
    return {2 * (pixel.x() - viewport_.x) / viewport_.width - 1,
            1 - 2 * (pixel.y() - viewport_.y) / viewport_.height};
}

template <class Scalar>
RayRegion<Scalar> Camera<Scalar>::rayThrough(const Pixel& pixel, double farthest) const {
    const Vector3<Scalar> nowhere =
        Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN());
    RayRegion<Scalar> nothing(nowhere, nowhere);
    if (!isValid_ || !(farthest > 0)) {
        return nothing;
    }
    const detail::Vector2<double> device = deviceCoordinates(pixel);
    detail::Vector4<double> near =
        inverse_.at(device.x(), device.y(), depthRange_ == DepthRange::zeroToOne ? 0 : -1);
    detail::Vector4<double> far = inverse_.at(device.x(), device.y(), 1);
    const double difference = far.w() - near.w();
    const bool isParallel =
        std::abs(difference) <= kSameWeight * std::max(std::abs(near.w()), std::abs(far.w()));
    if (isParallel ? depthOrder_ == DepthOrder::reversed : difference > 0) {
        std::swap(near, far);
    }
    if (!(near.w() > 0)) {
        return nothing;  // behind the eye
    }
    // The segment between two homogeneous points goes through infinity where the weight is 0. No part of it is to
    // overflow.
    constexpr double kMost = std::min<double>(std::numeric_limits<Scalar>::max() / 4, 1e300);
    const double least = inverse_.weightBehind(near.w(), std::min(farthest, kMost));
    if (far.w() < least) {
        far = near + (near.w() - least) / (near.w() - far.w()) * (far - near);
        far.w() = least;  // which rounding may have made 0
    }
    const Vector3<double> from = near.head<3>() / near.w();
    const Vector3<double> along = far.head<3>() / far.w() - from;
    const Vector3<double> to = from + along * std::min(1.0, kMost / along.cwiseAbs().maxCoeff());
    return {from.cast<Scalar>(), to.cast<Scalar>()};
}

template <class Scalar>
detail::ScreenEdges<Scalar> Camera<Scalar>::edgesBetween(const Pixel& a, const Pixel& b) const {
    const detail::Vector2<double> first = deviceCoordinates(a);
    const detail::Vector2<double> second = deviceCoordinates(b);
    const detail::Vector2<double> low = first.cwiseMin(second);
    const detail::Vector2<double> high = first.cwiseMax(second);
    const bool isSeen = (low.array() <= 1).all() && (high.array() >= -1).all() && !first.hasNaN() &&
                        !second.hasNaN();
    if (!isValid_ || !isSeen) {
        constexpr Scalar most = std::numeric_limits<Scalar>::max();
        return {most, most, -most, -most};  // as an empty Eigen::AlignedBox
    }
    const auto edge = [](double at) { return static_cast<Scalar>(std::clamp(at, -1.0, 1.0)); };
    return {edge(low.x()), edge(low.y()), edge(high.x()), edge(high.y())};
}

template std::string detail::cameraError(const Matrix4<float>&, const Viewport&);
template std::string detail::cameraError(const Matrix4<double>&, const Viewport&);
template class HASHPHASE_INSTANCE_EXPORT Camera<float>;
template class HASHPHASE_INSTANCE_EXPORT Camera<double>;

}  // namespace hashphase
