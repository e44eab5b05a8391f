// SPDX-License-Identifier: Zlib
#pragma once

// What the ground must answer, found by looking at every triangle, in long double, by other means
// than the ground's own: heights from planes, and where a sphere rests by moving it down until its
// centre is the radius away from the nearest point of the triangle.

#include <integration/terrain/terrain.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::test {

using Real = long double;
using RealPoint = Vector3<Real>;
using RealTriangle = std::array<RealPoint, 3>;  // y upward

/// How sure it is that something is so: rounding may decide it either way.
enum class Claim : std::uint8_t { no, perhaps, yes };

/// A surface below a point, or a sphere that rests on a triangle.
struct Candidate {
    Claim claim = Claim::no;
    Real height = 0;  // of the surface, or of the sphere's centre
    Real touch = 0;   // how high the point lies that is below, or touched
};

/// The nearest point of a triangle: C. Ericson, "Real-Time Collision Detection", 5.1.5.
[[nodiscard]] inline RealPoint nearestPoint(const RealTriangle& triangle, const RealPoint& p) {
    const auto onSegment = [&p](const RealPoint& a, const RealPoint& b) -> RealPoint {
        const RealPoint way = b - a;
        const Real length = way.squaredNorm();
        if (length == 0) {
            return a;
        }
        return a + way * std::clamp<Real>((p - a).dot(way) / length, 0, 1);
    };
    const auto& [a, b, c] = triangle;
    const RealPoint normal = (b - a).cross(c - a);
    RealPoint best = onSegment(a, b);
    for (const RealPoint& other : {onSegment(b, c), onSegment(c, a)}) {
        best = (other - p).squaredNorm() < (best - p).squaredNorm() ? other : best;
    }
    if (normal.squaredNorm() > 0) {
        const RealPoint foot = p - normal * (normal.dot(p - a) / normal.squaredNorm());
        const bool isInside = normal.dot((b - a).cross(foot - a)) >= 0 &&
                              normal.dot((c - b).cross(foot - b)) >= 0 &&
                              normal.dot((a - c).cross(foot - c)) >= 0;
        best = isInside && (foot - p).squaredNorm() < (best - p).squaredNorm() ? foot : best;
    }
    return best;
}

[[nodiscard]] inline Candidate surfaceOf(const RealTriangle& triangle, const RealPoint& p) {
    Candidate candidate;
    const auto& [a, b, c] = triangle;
    const Real area = (b[0] - a[0]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[0] - a[0]);
    if (area == 0) {
        return candidate;
    }
    candidate.claim = Claim::yes;
    for (std::size_t i = 0; i < 3; ++i) {
        const RealPoint& from = triangle[i];
        const RealPoint& to = triangle[(i + 1) % 3];
        const Real left = (to[0] - from[0]) * (p[2] - from[2]);
        const Real right = (to[2] - from[2]) * (p[0] - from[0]);
        const Real inside = area > 0 ? left - right : right - left;
        const Real error = Real(1e-17) * (std::abs(left) + std::abs(right));
        candidate.claim = std::min(candidate.claim, inside > error    ? Claim::yes
                                                    : inside < -error ? Claim::no
                                                                      : Claim::perhaps);
    }
    const RealPoint normal = (b - a).cross(c - a);
    candidate.height = a[1] - (normal[0] * (p[0] - a[0]) + normal[2] * (p[2] - a[2])) / normal[1];
    candidate.height =
        std::clamp(candidate.height, std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}));
    candidate.touch = candidate.height;
    return candidate;
}

/// A triangle with an area beside which the point lies, as seen from above, by at most the tolerance:
/// may count where meshes meet.
[[nodiscard]] inline Candidate besideOf(const RealTriangle& triangle, const RealPoint& p,
                                        Real tolerance) {
    Candidate candidate;
    const auto flat = [](const RealPoint& v) { return RealPoint(v[0], 0, v[2]); };
    if ((flat(triangle[1] - triangle[0])).cross(flat(triangle[2] - triangle[0]))[1] == 0) {
        return candidate;
    }
    Real closest = tolerance * (1 + Real(1e-6));
    for (std::size_t i = 0; i < 3; ++i) {
        const RealPoint& from = triangle[i];
        const RealPoint way = triangle[(i + 1) % 3] - from;
        const Real length = flat(way).squaredNorm();
        const Real share =
            length > 0 ? std::clamp<Real>(flat(p - from).dot(flat(way)) / length, 0, 1) : 0;
        if (const Real away = flat(from + share * way - p).norm(); away <= closest) {
            closest = away;
            candidate = {Claim::perhaps, from[1] + share * way[1], from[1] + share * way[1]};
        }
    }
    return candidate;
}

/// The highest place of the centre at which it is `radius` away from the triangle. How far away it is
/// is a convex function of its height.
[[nodiscard]] inline Candidate restOf(const RealTriangle& triangle, const RealPoint& center,
                                      Real radius) {
    const auto distanceAt = [&](Real y) {
        const RealPoint at(center[0], y, center[2]);
        return (nearestPoint(triangle, at) - at).norm();
    };
    const auto [lowest, highest] = std::minmax({triangle[0][1], triangle[1][1], triangle[2][1]});
    Real low = lowest;
    Real high = highest;
    for (int i = 0; i < 120; ++i) {
        const Real third = (high - low) / 3;
        const bool isBelow = distanceAt(low + third) <= distanceAt(high - third);
        (isBelow ? high : low) = isBelow ? high - third : low + third;
    }
    Real touching = (low + high) / 2;
    const Real closest = distanceAt(touching);
    const Real tolerance = Real(1e-9) * (1 + radius);
    Candidate candidate;
    if (closest > radius + tolerance) {
        return candidate;
    }
    candidate.claim = closest < radius - tolerance ? Claim::yes : Claim::perhaps;
    Real apart = highest + radius + 1;
    for (int i = 0; i < 120; ++i) {
        const Real middle = (touching + apart) / 2;
        (distanceAt(middle) <= radius ? touching : apart) = middle;
    }
    candidate.height = touching;
    candidate.touch = nearestPoint(triangle, {center[0], touching, center[2]})[1];
    return candidate;
}

/// The triangles of a terrain, turned so that y is up, for a slow look at all of them.
template <class Scalar>
class TerrainOracle {
public:
    explicit TerrainOracle(const Terrain<Scalar>& terrain, UpAxis up = UpAxis::y)
        : terrain_(terrain), up_(static_cast<int>(up)) {
        for (std::uint32_t i = 0; i < terrain.size(); ++i) {
            const auto corners = terrain.corners(i);
            triangles_.push_back({turned(corners[0]), turned(corners[1]), turned(corners[2])});
        }
    }

    /// Empty when `found` is right for surfaceBelow(point), else what is wrong.
    [[nodiscard]] std::string checkSurface(const Vector3<Scalar>& point,
                                           const std::optional<Ground<Scalar>>& found) const {
        const RealPoint p = turned(point);
        return check(found, p, [&](const RealTriangle& t) {
            const Candidate below = surfaceOf(t, p);
            return below.claim == Claim::no ? besideOf(t, p, toleranceAt(point)) : below;
        });
    }

    /// The same for restingHeight(center, radius).
    [[nodiscard]] std::string checkRest(const Vector3<Scalar>& center, Scalar radius,
                                        const std::optional<Ground<Scalar>>& found) const {
        const RealPoint p = turned(center);
        const auto r = static_cast<Real>(radius);
        return check(found, p, [&](const RealTriangle& t) {
            const bool isFar = std::min({t[0][0], t[1][0], t[2][0]}) > p[0] + r + 1 ||
                               std::max({t[0][0], t[1][0], t[2][0]}) < p[0] - r - 1 ||
                               std::min({t[0][2], t[1][2], t[2][2]}) > p[2] + r + 1 ||
                               std::max({t[0][2], t[1][2], t[2][2]}) < p[2] - r - 1;
            Candidate rest = isFar ? Candidate{} : restOf(t, p, r);
            if (rest.claim == Claim::no && r < toleranceAt(center)) {
                rest = besideOf(t, p, toleranceAt(center));
                rest.height += r;
            }
            return rest;
        });
    }

private:
    [[nodiscard]] Real toleranceAt(const Vector3<Scalar>& point) const {
        return static_cast<Real>(terrain_.seamTolerance(point));
    }

    template <class CandidateOf>
    std::string check(const std::optional<Ground<Scalar>>& found, const RealPoint& p,
                      const CandidateOf& candidateOf) const {
        // Heights are rounded to Scalar; where a sphere just reaches a corner, a little more is lost.
        const auto epsilon = static_cast<Real>(std::numeric_limits<Scalar>::epsilon());
        const Real tolerance = (4 * epsilon + Real(1e-7)) * (1 + std::abs(p[1]));
        for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
            const bool isIt = found && found->triangle == i;
            if (!triangles_[i][0].allFinite()) {
                if (isIt) {
                    return "A refused triangle was found.";
                }
                continue;
            }
            const Candidate candidate = candidateOf(triangles_[i]);
            const Real height = found ? static_cast<Real>(found->height) : -1e30L;
            const Real slack = tolerance + 4 * epsilon * std::abs(candidate.height);
            std::ostringstream text;
            text.precision(20);
            text << "triangle " << i << " at height " << candidate.height << ", touched at "
                 << candidate.touch << ", claim " << static_cast<int>(candidate.claim) << "; found "
                 << (found ? found->triangle : ~0U) << " at height " << height
                 << "; asked at height " << p[1];
            if (candidate.claim == Claim::yes && candidate.touch <= p[1] - slack &&
                candidate.height > height + slack) {
                return "A higher one was missed: " + text.str();
            }
            if (isIt && (candidate.claim == Claim::no || candidate.touch > p[1] + slack ||
                         std::abs(candidate.height - height) > slack)) {
                return "The one found is wrong: " + text.str();
            }
        }
        return {};
    }

    template <class Other>
    [[nodiscard]] RealPoint turned(const Vector3<Other>& v) const {
        return {static_cast<Real>(v[(up_ + 2) % 3]), static_cast<Real>(v[up_]),
                static_cast<Real>(v[(up_ + 1) % 3])};
    }

    const Terrain<Scalar>& terrain_;
    int up_;
    std::vector<RealTriangle> triangles_;
};

}  // namespace hashphase::test
