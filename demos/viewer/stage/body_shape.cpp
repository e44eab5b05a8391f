// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/body_shape.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

// By the quadratic formula that does not cancel.
std::optional<float> meetsSphere(const Vector3<float>& from, const Vector3<float>& way,
                                 float radius) {
    const double closing = -from.dot(way);
    const double distance = double{from.squaredNorm()} - double{radius} * radius;
    if (distance <= 0) {
        return 0.0F;
    }
    const double discriminant = closing * closing - double{way.squaredNorm()} * distance;
    if (closing <= 0 || discriminant < 0) {
        return std::nullopt;
    }
    const double share = distance / (closing + std::sqrt(discriminant));
    return share <= 1 ? std::optional(static_cast<float>(share)) : std::nullopt;
}

// Slab by slab (Kay and Kajiya, 1986).
std::optional<float> meetsBox(const Vector3<float>& from, const Vector3<float>& way,
                              const Vector3<float>& half) {
    float first = 0;
    float last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0) {
            if (std::abs(from[axis]) > half[axis]) {
                return std::nullopt;
            }
            continue;
        }
        const float a = (-half[axis] - from[axis]) / way[axis];
        const float b = (half[axis] - from[axis]) / way[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last ? std::optional(first) : std::nullopt;
}

}  // namespace

Aabb<float> boxAround(const StageBody& body) {
    Vector3<float> half = body.size;
    if (body.shape == StageBody::Shape::capsule) {
        half = {body.size.x(), body.size.x() + body.size.y(), body.size.x()};
    }
    if (body.shape != StageBody::Shape::sphere) {
        half = body.orientation.toRotationMatrix().cwiseAbs() * half;
    }
    return {body.centre - half, body.centre + half};
}

std::optional<float> meets(const StageBody& body, const Vector3<float>& from,
                           const Vector3<float>& way) {
    const Eigen::Quaternionf turnBack = body.orientation.conjugate();
    const Vector3<float> start = turnBack * (from - body.centre);
    const Vector3<float> turned = turnBack * way;
    switch (body.shape) {
        case StageBody::Shape::none:
            return std::nullopt;
        case StageBody::Shape::sphere:
            return meetsSphere(start, turned, body.size.x());
        case StageBody::Shape::box:
            return meetsBox(start, turned, body.size);
        case StageBody::Shape::capsule:
            return meetsBox(start, turned,
                            {body.size.x(), body.size.x() + body.size.y(), body.size.x()});
    }
    return std::nullopt;
}

}  // namespace hashphase::demos
