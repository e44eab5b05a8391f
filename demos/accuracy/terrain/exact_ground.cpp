// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/exact_ground.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace hashphase::demos {
namespace {

using Real = long double;
using Point = Vector3<Real>;
using Corners = std::array<Point, 3>;

Point nearestOnSegment(const Point& a, const Point& b, const Point& p) {
    const Point way = b - a;
    const Real length = way.squaredNorm();
    return length == 0 ? a : Point(a + way * std::clamp<Real>((p - a).dot(way) / length, 0, 1));
}

// By the face where the point is above or below it, else by the edges.
Real distanceTo(const Corners& triangle, const Point& p) {
    const auto& [a, b, c] = triangle;
    const Point normal = (b - a).cross(c - a);
    if (normal.dot((b - a).cross(p - a)) >= 0 && normal.dot((c - b).cross(p - b)) >= 0 &&
        normal.dot((a - c).cross(p - c)) >= 0 && !normal.isZero(0)) {
        return std::abs(normal.dot(p - a)) / normal.norm();
    }
    return std::sqrt(std::min({(nearestOnSegment(a, b, p) - p).squaredNorm(),
                               (nearestOnSegment(b, c, p) - p).squaredNorm(),
                               (nearestOnSegment(c, a, p) - p).squaredNorm()}));
}

Real nearest(std::span<const Corners* const> triangles, const Point& p) {
    Real least = std::numeric_limits<Real>::infinity();
    for (const Corners* each : triangles) {
        least = std::min(least, distanceTo(*each, p));
    }
    return least;
}

// The least distance [m] on the map by which the point is inside of an edge; negative outside.
Real depthIn(const Corners& triangle, Real x, Real z) {
    const auto areaOf = [](const Point& from, const Point& to, Real px, Real pz) {
        return (to.z() - from.z()) * (px - from.x()) - (to.x() - from.x()) * (pz - from.z());
    };
    const auto& [a, b, c] = triangle;
    const Real turn = areaOf(a, b, c.x(), c.z()) < 0 ? -1 : 1;
    Real depth = std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& from = triangle[i];
        const Point& to = triangle[(i + 1) % 3];
        const Real length = std::hypot(to.x() - from.x(), to.z() - from.z());
        depth = std::min(depth, turn * areaOf(from, to, x, z) / length);
    }
    return depth;
}

Real heightOf(const Corners& triangle, Real x, Real z) {
    const auto& [a, b, c] = triangle;
    const Point normal = (b - a).cross(c - a);
    return a.y() - (normal.x() * (x - a.x()) + normal.z() * (z - a.z())) / normal.y();
}

// Within the rounding of a point of the map to single precision.
constexpr Real kOnEdge = 1e-5L;  // [m]

}  // namespace

ExactGround::ExactGround(const GroundMesh& mesh) {
    for (std::uint32_t i = 0; i < mesh.triangles(); ++i) {
        const TriangleCorners corners = mesh.corners(i);
        Aabb<float> box;
        for (const Vector3<float>& corner : corners) {
            box.extend(corner);
        }
        boxes_.push_back(box);
        triangles_.push_back(
            {corners[0].cast<Real>(), corners[1].cast<Real>(), corners[2].cast<Real>()});
    }
}

std::vector<const ExactGround::Corners*> ExactGround::trianglesBelow(float x, float z,
                                                                     float radius) const {
    std::vector<const Corners*> found;
    const float reach = radius + GroundMesh::kEdge;
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
    std::optional<Real> height;
    for (const Corners* each : trianglesBelow(x, z, 0)) {
        if (depthIn(*each, x, z) >= -kOnEdge) {
            height = std::max(height.value_or(-std::numeric_limits<Real>::infinity()),
                              heightOf(*each, x, z));
        }
    }
    return height ? std::optional(static_cast<double>(*height)) : std::nullopt;
}

bool ExactGround::isAt(std::uint32_t triangle, float x, float z) const {
    return triangle < triangles_.size() && depthIn(triangles_[triangle], x, z) >= -kOnEdge;
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
    const bool isBelow = surface(x, z).value_or(-std::numeric_limits<double>::infinity()) > height;
    const Real depth = static_cast<Real>(radius) + (isBelow ? distance : -distance);
    return static_cast<double>(std::max<Real>(depth, 0));
}

}  // namespace hashphase::demos
