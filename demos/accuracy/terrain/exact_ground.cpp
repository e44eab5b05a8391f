// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/terrain_experiment.hpp>

#include <demos/scenes/random.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hashphase::demos {
namespace {

using Real = long double;
using Point = Vector3<Real>;
using Corners = std::array<Point, 3>;

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

Real squaredDistanceToSegment(const Point& a, const Point& b, const Point& p) {
    const Point way = b - a;
    const Real length = way.squaredNorm();
    const Real share = length == 0 ? 0 : std::clamp<Real>((p - a).dot(way) / length, 0, 1);
    return (a + share * way - p).squaredNorm();
}

// By the face where the point is above or below it, else by the edges.
Real distanceTo(const Corners& triangle, const Point& p) {
    const auto& [a, b, c] = triangle;
    const Point normal = (b - a).cross(c - a);
    if (normal.dot((b - a).cross(p - a)) >= 0 && normal.dot((c - b).cross(p - b)) >= 0 &&
        normal.dot((a - c).cross(p - c)) >= 0 && !normal.isZero(0)) {
        return std::abs(normal.dot(p - a)) / normal.norm();
    }
    return std::sqrt(std::min({squaredDistanceToSegment(a, b, p), squaredDistanceToSegment(b, c, p),
                               squaredDistanceToSegment(c, a, p)}));
}

Real nearest(std::span<const Corners* const> triangles, const Point& p) {
    Real least = kInfinity;
    for (const Corners* each : triangles) {
        least = std::min(least, distanceTo(*each, p));
    }
    return least;
}

// Whether the point of the map is within the triangle, or so near outside of an edge that rounding
// it to single precision may have put it there.
bool isWithin(const Corners& triangle, Real x, Real z) {
    constexpr Real kOnEdge = 1e-5L;  // [m]
    const auto areaOf = [](const Point& from, const Point& to, Real px, Real pz) {
        return (to.z() - from.z()) * (px - from.x()) - (to.x() - from.x()) * (pz - from.z());
    };
    const auto& [a, b, c] = triangle;
    const Real turn = areaOf(a, b, c.x(), c.z()) < 0 ? -1 : 1;
    const auto isInside = [&areaOf, turn, x, z](const Point& from, const Point& to) {
        const Real length = std::hypot(to.x() - from.x(), to.z() - from.z());
        return turn * areaOf(from, to, x, z) / length >= -kOnEdge;
    };
    return isInside(a, b) && isInside(b, c) && isInside(c, a);
}

Real heightOf(const Corners& triangle, Real x, Real z) {
    const auto& [a, b, c] = triangle;
    const Point normal = (b - a).cross(c - a);
    return a.y() - (normal.x() * (x - a.x()) + normal.z() * (z - a.z())) / normal.y();
}

}  // namespace

TriangleGround groundOfHeights(const std::function<float(float, float)>& height, float jitter,
                               std::uint64_t seed) {
    const auto isInner = [](std::uint32_t i) { return i > 0 && i < kGroundQuads; };
    return {kGroundQuads,
            [&, random = Random(seed)](std::uint32_t i, std::uint32_t k) mutable -> Vector3<float> {
                float x = static_cast<float>(i) * kGroundEdge - kGroundHalf;
                float z = static_cast<float>(k) * kGroundEdge - kGroundHalf;
                if (isInner(i) && isInner(k)) {
                    x += random.between(-jitter, jitter);
                    z += random.between(-jitter, jitter);
                }
                return {x, height(x, z), z};
            }};
}

ExactGround::ExactGround(const TriangleGround& mesh) : boxes_(mesh.boxes) {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        triangles_.push_back({mesh.corner(i, 0).cast<Real>(), mesh.corner(i, 1).cast<Real>(),
                              mesh.corner(i, 2).cast<Real>()});
    }
}

std::vector<const Corners*> ExactGround::trianglesBelow(float x, float z, float radius) const {
    std::vector<const Corners*> found;
    const float reach = radius + kGroundEdge;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        const Aabb<float>& box = boxes_[i];
        if (box.min().x() <= x + reach && box.max().x() >= x - reach &&
            box.min().z() <= z + reach && box.max().z() >= z - reach) {
            found.push_back(&triangles_[i]);
        }
    }
    return found;
}

std::optional<double> ExactGround::surface(float x, float z) const {
    Real height = -kInfinity;
    for (const Corners* each : trianglesBelow(x, z, 0)) {
        if (isWithin(*each, x, z)) {
            height = std::max(height, heightOf(*each, x, z));
        }
    }
    return height > -kInfinity ? std::optional(static_cast<double>(height)) : std::nullopt;
}

bool ExactGround::isAt(std::uint32_t triangle, float x, float z) const {
    return triangle < triangles_.size() && isWithin(triangles_[triangle], x, z);
}

double ExactGround::restingHeight(float x, float z, float radius) const {
    const std::vector<const Corners*> below = trianglesBelow(x, z, radius);
    // Between a centre that is in the ground and one that is free; whatever is above that is free.
    Real low = surface(x, z).value_or(0);
    Real high = low;
    for (const Corners* each : below) {
        for (const Point& corner : *each) {
            high = std::max(high, corner.y() + static_cast<Real>(radius));
        }
    }
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
        const Real middle = (low + high) / 2;
        const bool isFree = nearest(below, {x, middle, z}) >= static_cast<Real>(radius);
        (isFree ? high : low) = middle;
    }
    return static_cast<double>(high);
}

double ExactGround::penetration(float x, double height, float z, float radius) const {
    const Real distance = nearest(trianglesBelow(x, z, radius), {x, static_cast<Real>(height), z});
    const std::optional<double> ground = surface(x, z);
    const bool isBelow = ground && *ground > height;
    const Real depth = static_cast<Real>(radius) + (isBelow ? distance : -distance);
    return static_cast<double>(std::max<Real>(depth, 0));
}

}  // namespace hashphase::demos
