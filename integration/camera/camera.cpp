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
std::string cameraError(const Eigen::Matrix<Scalar, 4, 4>& viewProjection,
                        const Viewport& viewport) {
    if (std::string error = frustumError(viewProjection); !error.empty()) {
        return error;
    }
    if (!isGood(viewport)) {
        return "The viewport must be of finite numbers, its width and height above zero.";
    }
    if (!detail::CameraInverse(viewProjection.template cast<double>()).isValid()) {
        return "The view-projection matrix is singular; it must have an inverse.";
    }
    return {};
}

template <class Scalar>
Camera<Scalar>::Camera(const Matrix& viewProjection, DepthRange depthRange,
                       const Viewport& viewport, DepthOrder depthOrder)
    : viewProjection_(viewProjection),
      inverse_(viewProjection.template cast<double>()),
      viewport_(viewport),
      depthRange_(depthRange),
      depthOrder_(depthOrder),
      isValid_(inverse_.isValid() && isGood(viewport)) {}

template <class Scalar>
Eigen::Vector2d Camera<Scalar>::deviceCoordinates(const Pixel& pixel) const {
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
    const Eigen::Vector2d device = deviceCoordinates(pixel);
    Eigen::Vector4d near =
        inverse_.at(device.x(), device.y(), depthRange_ == DepthRange::zeroToOne ? 0 : -1);
    Eigen::Vector4d far = inverse_.at(device.x(), device.y(), 1);
    const double difference = far.w() - near.w();
    const bool isParallel =
        std::abs(difference) <= kSameWeight * std::max(std::abs(near.w()), std::abs(far.w()));
    if (isParallel ? depthOrder_ == DepthOrder::reversed : difference > 0) {
        std::swap(near, far);
    }
    if (!(near.w() > 0)) {
        return nothing;  // behind the eye
    }
    // The segment between two homogeneous points goes through infinity where the weight is 0.
    const double least = inverse_.weightBehind(near.w(), farthest);
    if (far.w() < least) {
        far = near + (near.w() - least) / (near.w() - far.w()) * (far - near);
    }
    const Vector3<double> from = near.head<3>() / near.w();
    const Vector3<double> to = far.head<3>() / far.w();
    return {from.cast<Scalar>(), to.cast<Scalar>()};
}

template <class Scalar>
ScreenRectangle<Scalar> Camera<Scalar>::rectangleBetween(const Pixel& a, const Pixel& b) const {
    const Eigen::Vector2d first = deviceCoordinates(a);
    const Eigen::Vector2d second = deviceCoordinates(b);
    const Eigen::Vector2d low = first.cwiseMin(second);
    const Eigen::Vector2d high = first.cwiseMax(second);
    const bool isSeen = (low.array() <= 1).all() && (high.array() >= -1).all() && !first.hasNaN() &&
                        !second.hasNaN();
    if (!isValid_ || !isSeen) {
        return {};
    }
    return {low.cwiseMax(-1).cast<Scalar>(), high.cwiseMin(1).cast<Scalar>()};
}

template std::string cameraError(const Eigen::Matrix4f&, const Viewport&);
template std::string cameraError(const Eigen::Matrix4d&, const Viewport&);
template class HASHPHASE_INSTANCE_EXPORT Camera<float>;
template class HASHPHASE_INSTANCE_EXPORT Camera<double>;

}  // namespace hashphase
