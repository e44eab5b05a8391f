// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/stage.hpp>

#include <broadphase/regions.hpp>

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

// An upright one: the round wall between its ends, or one of the balls there.
std::optional<float> meetsCapsule(const Vector3<float>& from, const Vector3<float>& way,
                                  float radius, float halfHeight) {
    const Vector3<float> upright(1, 0, 1);
    std::optional<float> first =
        meetsSphere(from.cwiseProduct(upright), way.cwiseProduct(upright), radius);
    if (first && std::abs(from.y() + *first * way.y()) > halfHeight) {
        first.reset();
    }
    for (const float end : {-halfHeight, halfHeight}) {
        const auto ball = meetsSphere(from - Vector3<float>(0, end, 0), way, radius);
        if (ball && (!first || *ball < *first)) {
            first = ball;
        }
    }
    return first;
}

// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
std::optional<double> meetsTriangle(const Vector3<double>& from, const Vector3<double>& way,
                                    std::span<const Vector3<float>, 3> corners) {
    const Vector3<double> corner = corners[0].cast<double>();
    const Vector3<double> first = corners[1].cast<double>() - corner;
    const Vector3<double> second = corners[2].cast<double>() - corner;
    const Vector3<double> across = way.cross(second);
    const double volume = first.dot(across);
    if (volume == 0) {
        return std::nullopt;
    }
    const Vector3<double> start = from - corner;
    const Vector3<double> turned = start.cross(first);
    const double u = start.dot(across) / volume;
    const double v = way.dot(turned) / volume;
    const double share = second.dot(turned) / volume;
    const bool isMet = u >= 0 && v >= 0 && u + v <= 1 && share >= 0 && share <= 1;
    return isMet ? std::optional(share) : std::nullopt;
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
    float share = 0;
    switch (body.shape) {
        case StageBody::Shape::none:
            return std::nullopt;
        case StageBody::Shape::sphere:
            return meetsSphere(start, turned, body.size.x());
        case StageBody::Shape::box:
            share = RayRegion<float>(start, start + turned).key({-body.size, body.size});
            return share < 0 ? std::nullopt : std::optional(share);
        case StageBody::Shape::capsule:
            return meetsCapsule(start, turned, body.size.x(), body.size.y());
    }
    return std::nullopt;
}

std::optional<float> meets(std::span<const Vector3<float>> triangles, const Vector3<float>& from,
                           const Vector3<float>& way) {
    std::optional<double> nearest;
    for (; !triangles.empty(); triangles = triangles.subspan(3)) {
        const auto share =
            meetsTriangle(from.cast<double>(), way.cast<double>(), triangles.first<3>());
        if (share && (!nearest || *share < *nearest)) {
            nearest = share;
        }
    }
    return nearest ? std::optional(static_cast<float>(*nearest)) : std::nullopt;
}

}  // namespace hashphase::demos
