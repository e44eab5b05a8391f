// SPDX-License-Identifier: Zlib
#include <integration/picking/ground.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase {
namespace {

template <class Scalar>
RayRegion<Scalar> emptyRay() {
    const Vector3<Scalar> nowhere =
        Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN());
    return {nowhere, nowhere};
}

}  // namespace

template <class Scalar>
RayRegion<Scalar> clipToHeights(const RayRegion<Scalar>& ray, const HeightRange<Scalar>& heights) {
    const auto up = static_cast<int>(heights.up);
    if (ray.isEmpty() || !(heights.low <= heights.high)) {
        return emptyRay<Scalar>();
    }
    const Vector3<double> from = ray.from().template cast<double>();
    const Vector3<double> way = ray.direction().template cast<double>();
    // The ends are rounded, and must not end before what they touch.
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    constexpr auto rounding = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    const auto above = [&](double height, double outward) {
        const double slack =
            4 * (rounding * std::abs(height) + epsilon * (std::abs(from[up]) + std::abs(way[up])));
        return std::isinf(height) ? height : height - from[up] + outward * slack;
    };
    const double low = above(static_cast<double>(heights.low - ray.fatness().max()[up]), -1);
    const double high = above(static_cast<double>(heights.high - ray.fatness().min()[up]), 1);
    double enter = 0;
    double leave = 1;
    if (way[up] == 0) {
        leave = low <= 0 && high >= 0 ? 1 : -1;
    } else {
        const auto [near, far] = std::minmax({low / way[up], high / way[up]});
        enter = std::max(enter, near);
        leave = std::min(leave, far);
    }
    if (!(enter <= leave)) {
        return emptyRay<Scalar>();
    }
    const Vector3<double> begin = from + enter * way;
    const Vector3<double> end = from + leave * way;
    return {begin.cast<Scalar>(), end.cast<Scalar>(), ray.fatness()};
}

template <class Scalar>
std::optional<Vector3<Scalar>> groundPoint(const RayRegion<Scalar>& ray,
                                           std::type_identity_t<Scalar> height, UpAxis up) {
    const auto axis = static_cast<int>(up);
    const auto way = static_cast<double>(ray.direction()[axis]);
    const double fraction =
        (static_cast<double>(height) - static_cast<double>(ray.from()[axis])) / way;
    // The direction is rounded: a ray that ends on the plane may seem to end before it.
    constexpr auto rounding = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    if (ray.isEmpty() || way == 0 || !(fraction >= 0 && fraction <= 1 + rounding)) {
        return std::nullopt;
    }
    const Vector3<double> point = ray.from().template cast<double>() +
                                  std::min(fraction, 1.0) * ray.direction().template cast<double>();
    Vector3<Scalar> result = point.cast<Scalar>();
    result[axis] = height;
    return result;
}

#define HASHPHASE_INSTANTIATE(Scalar)                                                              \
    template RayRegion<Scalar> clipToHeights(const RayRegion<Scalar>&,                             \
                                             const HeightRange<Scalar>&);                          \
    template std::optional<Vector3<Scalar>> groundPoint(const RayRegion<Scalar>&, Scalar, UpAxis)

HASHPHASE_INSTANTIATE(float);
HASHPHASE_INSTANTIATE(double);
#undef HASHPHASE_INSTANTIATE

}  // namespace hashphase
