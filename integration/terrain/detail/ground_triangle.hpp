// SPDX-License-Identifier: Zlib
#pragma once

// One triangle of the ground: how high it is at a point, and at what height it carries a sphere.
// All in double precision, with y upward, whichever axis that is in the world.

#include <broadphase/aabb.hpp>
#include <integration/terrain/detail/orientation.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

inline constexpr double kNoHeight = -std::numeric_limits<double>::infinity();

/// Corners by coordinate. Seen from above, those of a triangle that has heights turn from x to z. A line
/// of the cache each, in single precision.
template <class Scalar>
struct alignas(64) GroundTriangle {
    Vector3<double> normal = Vector3<double>::Zero();  // of length 1, of the side that is up; or 0
    std::array<Scalar, 3> x;
    std::array<Scalar, 3> z;
    std::array<Scalar, 3> y;
    bool hasHeights = false;        // not vertical, nor without an area
    bool hasNormal : 1 = false;     // and not so thin that rounding hides where its plane is
    bool isTurned : 1 = false;      // the last two corners were exchanged
    std::uint8_t sizeExponent = 0;  // seen from above, no edge is longer than 2 to this - 128 [m]
    std::uint8_t seamGroup = 0;     // see SeamGroups

    [[nodiscard]] Point2 above(std::size_t corner) const noexcept {
        return {static_cast<double>(x[corner]), static_cast<double>(z[corner])};
    }
    [[nodiscard]] double height(std::size_t corner) const noexcept {
        return static_cast<double>(y[corner]);
    }
};

static_assert(sizeof(GroundTriangle<float>) == 64);

/// In place of one that was refused or removed.
template <class Scalar>
[[nodiscard]] GroundTriangle<Scalar> noTriangle() noexcept {
    GroundTriangle<Scalar> none{};
    for (auto* const corners : {&none.x, &none.z, &none.y}) {
        corners->fill(std::numeric_limits<Scalar>::quiet_NaN());
    }
    return none;
}

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

    [[nodiscard]] double least() const noexcept { return std::min(std::min(a, b), c); }
    [[nodiscard]] bool areInside() const noexcept { return least() >= 0; }
    /// Whether the point may be outside by no more than the tolerance of which slackOf() is this. One
    /// comparison: least() is from -2 * slack to 0, but for rounding.
    [[nodiscard]] bool mayBeBeside(double slack) const noexcept {
        return std::abs(least() + slack) <= slack;
    }
};

template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline Weights weightsAt(
    const GroundTriangle<Scalar>& triangle, const Point2& point) noexcept {
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
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline double heightAt(
    const GroundTriangle<Scalar>& triangle, const Weights& weights) noexcept {
    const double a = triangle.height(0);
    const double b = triangle.height(1);
    const double c = triangle.height(2);
    const double rise =
        (weights.b * (b - a) + weights.c * (c - a)) / (weights.a + weights.b + weights.c);
    // Rounding must not lead out of the triangle's box.
    return std::clamp(a + rise, std::min({a, b, c}), std::max({a, b, c}));
}

/// 2 to the powers from -129 to 126.
constexpr std::array<double, 256> powersOfTwo() {
    std::array<double, 256> powers{};
    for (std::size_t i = 0; i < powers.size(); ++i) {
        powers[i] = std::bit_cast<double>((1023 - 129 + std::uint64_t{i}) << 52);
    }
    return powers;
}
inline constexpr std::array<double, 256> kPowersOfTwo = powersOfTwo();

/// The area of the largest triangle that a point at most `tolerance` beside an edge has with it.
template <class Scalar>
[[nodiscard]] double slackOf(const GroundTriangle<Scalar>& triangle, double tolerance) noexcept {
    return tolerance * kPowersOfTwo[triangle.sizeExponent];
}

/// The exponent of GroundTriangle: edges of more than 2^127 m, in double precision, count as so long.
template <class Scalar>
[[nodiscard]] std::uint8_t sizeExponentOf(const GroundTriangle<Scalar>& triangle) noexcept {
    const auto [lowX, highX] = std::minmax_element(triangle.x.begin(), triangle.x.end());
    const auto [lowZ, highZ] = std::minmax_element(triangle.z.begin(), triangle.z.end());
    const double longest = (static_cast<double>(*highX) - static_cast<double>(*lowX)) +
                           (static_cast<double>(*highZ) - static_cast<double>(*lowZ));
    return static_cast<std::uint8_t>(std::clamp(std::ilogb(longest) + 1 + 128, 0, 255));
}

/// The normal of a triangle that has heights; 0 where rounding hides it.
template <class Scalar>
[[nodiscard]] Vector3<double> normalOf(const GroundTriangle<Scalar>& triangle) noexcept {
    const auto side = [&](std::size_t corner) {
        return Vector3<double>(triangle.above(corner).x - triangle.above(0).x,
                               triangle.height(corner) - triangle.height(0),
                               triangle.above(corner).z - triangle.above(0).z);
    };
    // Scaled, so that squares of lengths stay in range.
    const Vector3<double> first = side(1);
    const Vector3<double> second = side(2);
    const double largest = std::max(first.cwiseAbs().maxCoeff(), second.cwiseAbs().maxCoeff());
    const double scale = std::scalbn(1.0, -std::ilogb(largest));
    const Vector3<double> normal = (scale * second).cross(scale * first);
    // Not by Eigen, each version of which rounds in an order of its own.
    const double longest = normal.cwiseAbs().maxCoeff();
    const Vector3<double> unit = normal / longest;
    const double squared = unit.x() * unit.x() + unit.y() * unit.y() + unit.z() * unit.z();
    return squared > 0 ? Vector3<double>(normal / (std::sqrt(squared) * longest)) : normal;
}

/// An edge as seen from a sphere's centre.
struct Edge {
    Point2 from;  // the first corner, seen from the centre
    Point2 way;   // to the other one
    double low;   // height of the first corner
    double high;  // and of the other one

    template <class Scalar>
    Edge(const GroundTriangle<Scalar>& triangle, std::size_t i, std::size_t j,
         const Point2& center) noexcept
        : from{triangle.above(i).x - center.x, triangle.above(i).z - center.z},
          way{triangle.above(j).x - triangle.above(i).x, triangle.above(j).z - triangle.above(i).z},
          low(triangle.height(i)),
          high(triangle.height(j)) {}

    [[nodiscard]] double rise() const noexcept { return high - low; }
    [[nodiscard]] double lengthSquared() const noexcept { return way.x * way.x + way.z * way.z; }
    /// How far the centre is along the way and beside it, times the length.
    [[nodiscard]] double ahead() const noexcept { return -(from.x * way.x + from.z * way.z); }
    [[nodiscard]] double aside() const noexcept { return from.x * way.z - from.z * way.x; }
};

/// Whether a sphere whose centre is at `height` is clear of the line through the edge, and above it, by
/// more than rounding: then the edge does not carry it as high. Without a division or a root.
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline bool isClearOf(const Edge& edge, double radius,
                                                             double height) noexcept {
    constexpr double slack = 1e-9;
    const double lengthSquared = edge.lengthSquared();
    // Above the line, the sphere is cut to a circle: its radius, squared, times the length, squared.
    const double circle =
        radius * radius * lengthSquared - (1 - slack) * edge.aside() * edge.aside();
    const double up = (height - edge.low) * lengthSquared;
    const double slope = edge.ahead() * edge.rise();
    const double gap = up - slope - slack * (std::abs(up) + std::abs(slope));
    return (circle < 0) |
           ((gap > 0) & (gap * gap > circle * (lengthSquared + edge.rise() * edge.rise())));
}

/// At what height an edge carries a sphere.
[[nodiscard]] inline Rest restOnEdge(const Edge& edge, double radius) noexcept {
    const double lengthSquared = edge.lengthSquared();
    const double rise = edge.rise();
    const double radiusSquared = radius * radius;
    double share = rise > 0 ? 1 : 0;  // of the way; on a vertical edge, the upper end
    if (lengthSquared > 0) {
        // Above the line through the edge, the sphere is cut to a circle.
        const double circleSquared = radiusSquared - edge.aside() * edge.aside() / lengthSquared;
        if (circleSquared < 0) {
            return {};
        }
        const double slope = rise / std::sqrt(lengthSquared + rise * rise);
        const double uphill = std::sqrt(circleSquared * lengthSquared) * slope;
        share = std::clamp((uphill + edge.ahead()) / lengthSquared, 0.0, 1.0);
    }
    const double x = edge.from.x + share * edge.way.x;
    const double z = edge.from.z + share * edge.way.z;
    const double left = radiusSquared - (x * x + z * z);
    if (left < 0) {
        return {};
    }
    const double touch = share == 1
                             ? edge.high
                             : std::clamp(edge.low + share * rise, std::min(edge.low, edge.high),
                                          std::max(edge.low, edge.high));
    return {touch + std::sqrt(left), touch};
}

/// How high a triangle is at its point nearest to one outside, as seen from above; kNoHeight where that
/// is more than `tolerance` away.
template <class Scalar>
[[nodiscard]] double heightBeside(const GroundTriangle<Scalar>& triangle, const Point2& point,
                                  double tolerance) noexcept {
    double height = kNoHeight;
    double least = tolerance * tolerance;
    for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge(triangle, i, (i + 1) % 3, point);
        const double lengthSquared = edge.lengthSquared();
        const double share =
            lengthSquared > 0 ? std::clamp(edge.ahead() / lengthSquared, 0.0, 1.0) : 0;
        const double x = edge.from.x + share * edge.way.x;
        const double z = edge.from.z + share * edge.way.z;
        if (const double squared = x * x + z * z; squared <= least) {
            least = squared;
            height = std::clamp(edge.low + share * edge.rise(), std::min(edge.low, edge.high),
                                std::max(edge.low, edge.high));
        }
    }
    return height;
}

// At what height a triangle carries a sphere whose centre is on a vertical line: the largest
// y + sqrt(radius^2 - d^2) over its points, d being their distance from the line. That is a concave
// function. Its peak on the plane is where the sphere touches the plane; when that is not in the
// triangle, the largest value is on an edge that has the peak on its outer side.

/// Where the peak is. All weights are negative where the triangle has no normal.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline Weights weightsAtPeak(
    const GroundTriangle<Scalar>& triangle, const Point2& center, double radius) noexcept {
    if (!triangle.hasNormal) [[unlikely]] {
        return {-1, -1, -1};
    }
    return weightsAt(triangle, {center.x - radius * triangle.normal.x(),
                                center.z - radius * triangle.normal.z()});
}

/// The height when the peak is inside.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline Rest restOnFace(
    const GroundTriangle<Scalar>& triangle, const Weights& peak, double radius) noexcept {
    const double touch = heightAt(triangle, peak);
    return {touch + radius * triangle.normal.y(), touch};
}

/// The height when it is not. Means nothing where that is below `least`.
template <class Scalar>
[[nodiscard, HASHPHASE_ALWAYS_INLINE]] inline Rest restOnEdges(
    const GroundTriangle<Scalar>& triangle, const Weights& peak, const Point2& center,
    double radius, double least) noexcept {
    Rest best;
    const auto look = [&](double weight, std::size_t i, std::size_t j) {
        const Edge edge(triangle, i, j, center);
        if (weight < 0 && !isClearOf(edge, radius, least)) {
            const Rest rest = restOnEdge(edge, radius);
            best = rest.center > best.center ? rest : best;
        }
    };
    look(peak.a, 1, 2);
    look(peak.b, 2, 0);
    look(peak.c, 0, 1);
    return best;
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
