// SPDX-License-Identifier: Zlib
#pragma once

// One triangle of the ground: how high it is at a point, and at what height it carries a sphere.
// All in double precision, with y upward, whichever axis that is in the world.

#include <integration/terrain/detail/orientation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hashphase::detail {

inline constexpr double kNoHeight = -std::numeric_limits<double>::infinity();

/// Corners by coordinate. Seen from above, those of a triangle that has heights turn from x to z.
template <class Scalar>
struct GroundTriangle {
    std::array<Scalar, 3> x;
    std::array<Scalar, 3> z;
    std::array<Scalar, 3> y;
    bool hasHeights = false;  // not vertical, nor without an area
    bool isTurned = false;    // the last two corners were exchanged

    [[nodiscard]] Point2 above(std::size_t corner) const noexcept {
        return {static_cast<double>(x[corner]), static_cast<double>(z[corner])};
    }
    [[nodiscard]] double height(std::size_t corner) const noexcept {
        return static_cast<double>(y[corner]);
    }
};

/// A sphere's centre on its vertical line, and how high the point lies that carries it.
struct Rest {
    double center = kNoHeight;
    double touch = kNoHeight;
};

/// How far inside of each edge a point lies, as areas: that of corner i is of the edge before it.
struct Weights {
    double a;
    double b;
    double c;

    [[nodiscard]] bool areInside() const noexcept { return ((a >= 0) & (b >= 0) & (c >= 0)) != 0; }
};

template <class Scalar>
[[nodiscard, gnu::always_inline]] inline Weights weightsAt(const GroundTriangle<Scalar>& triangle,
                                                           const Point2& point) noexcept {
    const Point2 a = triangle.above(0);
    const Point2 b = triangle.above(1);
    const Point2 c = triangle.above(2);
    // One branch for all three, which is hardly ever taken.
    const Area ofA = roundedOrientation(b, c, point);
    const Area ofB = roundedOrientation(c, a, point);
    const Area ofC = roundedOrientation(a, b, point);
    if (!(ofA.isCertain & ofB.isCertain & ofC.isCertain)) [[unlikely]] {
        return {orientation(b, c, point), orientation(c, a, point), orientation(a, b, point)};
    }
    return {ofA.value, ofB.value, ofC.value};
}

/// Height of the triangle's face at a point with these weights; means nothing unless they are inside.
template <class Scalar>
[[nodiscard, gnu::always_inline]] inline double heightAt(const GroundTriangle<Scalar>& triangle,
                                                         const Weights& weights) noexcept {
    const double a = triangle.height(0);
    const double b = triangle.height(1);
    const double c = triangle.height(2);
    const double rise =
        (weights.b * (b - a) + weights.c * (c - a)) / (weights.a + weights.b + weights.c);
    // Rounding must not lead out of the triangle's box.
    return std::clamp(a + rise, std::min({a, b, c}), std::max({a, b, c}));
}

/// At what height the edge from corner i to corner j carries a sphere.
template <class Scalar>
[[nodiscard]] Rest restOnEdge(const GroundTriangle<Scalar>& triangle, std::size_t i, std::size_t j,
                              const Point2& center, double radius) noexcept {
    const Point2 from{triangle.above(i).x - center.x, triangle.above(i).z - center.z};
    const Point2 way{triangle.above(j).x - triangle.above(i).x,
                     triangle.above(j).z - triangle.above(i).z};
    const double low = triangle.height(i);
    const double rise = triangle.height(j) - low;
    const double lengthSquared = way.x * way.x + way.z * way.z;
    const double radiusSquared = radius * radius;
    double share = rise > 0 ? 1 : 0;  // of the way; on a vertical edge, the upper end
    if (lengthSquared > 0) {
        // Above the line through the edge, the sphere is cut to a circle.
        const double aside = from.x * way.z - from.z * way.x;
        const double circleSquared = radiusSquared - aside * aside / lengthSquared;
        if (circleSquared < 0) {
            return {};
        }
        const double slope = rise / std::sqrt(lengthSquared + rise * rise);
        const double ahead = std::sqrt(circleSquared * lengthSquared) * slope;
        share = (ahead - (from.x * way.x + from.z * way.z)) / lengthSquared;
        share = std::clamp(share, 0.0, 1.0);
    }
    const double x = from.x + share * way.x;
    const double z = from.z + share * way.z;
    const double left = radiusSquared - (x * x + z * z);
    if (left < 0) {
        return {};
    }
    const double high = triangle.height(j);
    const double touch =
        share == 1 ? high
                   : std::clamp(low + share * rise, std::min(low, high), std::max(low, high));
    return {touch + std::sqrt(left), touch};
}

[[nodiscard]] inline Rest higher(const Rest& a, const Rest& b) noexcept {
    return b.center > a.center ? b : a;
}

/// At what height the triangle carries a sphere whose centre is on a vertical line: the largest
/// y + sqrt(radius^2 - d^2) over its points, d being their distance from the line. That is a
/// concave function. Its peak on the plane is where the sphere touches the plane; when that is not
/// in the triangle, the largest value is on an edge that has the peak on its outer side.
template <class Scalar>
[[nodiscard]] Rest restOn(const GroundTriangle<Scalar>& triangle, const Point2& center,
                          double radius) noexcept {
    Weights weights{-1, -1, -1};
    if (triangle.hasHeights) {
        const double x1 = triangle.above(1).x - triangle.above(0).x;
        const double z1 = triangle.above(1).z - triangle.above(0).z;
        const double y1 = triangle.height(1) - triangle.height(0);
        const double x2 = triangle.above(2).x - triangle.above(0).x;
        const double z2 = triangle.above(2).z - triangle.above(0).z;
        const double y2 = triangle.height(2) - triangle.height(0);
        const double normalX = y2 * z1 - y1 * z2;
        const double normalY = x1 * z2 - x2 * z1;
        const double normalZ = x2 * y1 - x1 * y2;
        const double length = std::sqrt(normalX * normalX + normalY * normalY + normalZ * normalZ);
        if (length > 0) {
            const double scale = radius / length;
            weights = weightsAt(triangle, {center.x - scale * normalX, center.z - scale * normalZ});
            if (weights.areInside()) {
                const double touch = heightAt(triangle, weights);
                return {touch + radius * (normalY / length), touch};
            }
        }
    }
    Rest best;
    if (weights.a < 0) {
        best = restOnEdge(triangle, 1, 2, center, radius);
    }
    if (weights.b < 0) {
        best = higher(best, restOnEdge(triangle, 2, 0, center, radius));
    }
    if (weights.c < 0) {
        best = higher(best, restOnEdge(triangle, 0, 1, center, radius));
    }
    return best;
}

}  // namespace hashphase::detail
