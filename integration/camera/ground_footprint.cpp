// SPDX-License-Identifier: Zlib
//
// The view is a cube in normalised device coordinates. Its corners are carried into the world in
// homogeneous coordinates, where points at infinity are like any others, clipped there, and projected.

#include <integration/camera/ground_footprint.hpp>

#include <integration/camera/detail/camera_inverse.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

namespace hashphase {
namespace {

using Point2 = detail::Vector2<double>;

// How exact points are, as a share of their coordinates.
constexpr double kDoubt = 1e-12;

/// A corner of a convex polyhedron of which exactly three faces meet in each corner, if need be with
/// edges of no length.
struct Corner {
    detail::Vector4<double> point;  // homogeneous
    std::uint32_t faces = 0;        // bit i: it lies in face i
};
using Corners = detail::FixedList<Corner, 32>;  // 14, if it were not for rounding

template <class Scalar>
Corners viewCorners(const detail::CameraInverse& inverse, DepthRange depthRange,
                    const detail::ScreenEdges<Scalar>& edges) {
    const auto edge = [&](std::size_t i) { return static_cast<double>(edges[i]); };
    const double nearest = depthRange == DepthRange::zeroToOne ? 0 : -1;
    const Aabb<double> cube =
        boxBetween<double>({edge(0), edge(1), nearest}, {edge(2), edge(3), 1});
    Corners corners;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const auto end = [&](int axis) {
            return ((i >> axis & 1) == 0 ? cube.min() : cube.max())[axis];
        };
        Corner corner{inverse.at(end(0), end(1), end(2))};
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            corner.faces |= 1U << (2 * axis + (i >> axis & 1));
        }
        corners.push(corner);
    }
    return corners;
}

// Leaves what has depthOf(point) >= 0, an affine function; this adds a face, onto which snap(point)
// puts a point that is hardly off it, so that the same face from the other side leaves it there. Does nothing where
// rounding makes more corners than a polyhedron has: the footprint may be too large, never too small.
template <class DepthOf, class Snap>
void clip(Corners& corners, std::uint32_t newFace, const DepthOf& depthOf, const Snap& snap) {
    Corners clipped;
    bool hasRoom = true;
    for (const Corner& inside : corners) {
        const double depth = depthOf(inside.point);
        if (!(depth >= 0)) {
            continue;
        }
        hasRoom = clipped.push(inside) && hasRoom;
        for (const Corner& outside : corners) {
            const double beyond = depthOf(outside.point);
            const std::uint32_t edge = inside.faces & outside.faces;
            if (beyond < 0 && std::popcount(edge) == 2) {
                const double share = depth / (depth - beyond);
                detail::Vector4<double> crossing =
                    inside.point + share * (outside.point - inside.point);
                snap(crossing);
                hasRoom = clipped.push({crossing, edge | 1U << newFace}) && hasRoom;
            }
        }
    }
    if (hasRoom) {
        corners = clipped;
    }
}

template <class Scalar>
void clipToHeights(Corners& corners, const HeightRange<Scalar>& heights) {
    using Point4 = detail::Vector4<double>;
    const auto up = static_cast<int>(heights.up);
    const auto low = static_cast<double>(heights.low);
    const auto high = static_cast<double>(heights.high);
    if (std::isfinite(low)) {
        clip(
            corners, 7, [&](const Point4& point) { return point[up] - low * point.w(); },
            [&](Point4& point) { point[up] = low * point.w(); });
    }
    if (std::isfinite(high)) {
        clip(
            corners, 8, [&](const Point4& point) { return high * point.w() - point[up]; },
            [&](Point4& point) { point[up] = high * point.w(); });
    }
}

double cross(const Point2& a, const Point2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

using PointList = detail::FixedList<Point2, 32>;

// The points from left to right, without those that are hardly to be told from others.
PointList distinctPoints(const PointList& points, double doubt) {
    std::array<Point2, 32> sorted;
    std::copy(points.begin(), points.end(), sorted.begin());
    const std::span fromLeft(sorted.data(), points.size());
    std::ranges::sort(fromLeft, [](const Point2& a, const Point2& b) {
        return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
    });
    PointList distinct;
    for (const Point2& point : fromLeft) {
        const auto isClose = [&](const Point2& other) { return (point - other).norm() <= doubt; };
        if (std::none_of(distinct.begin(), distinct.end(), isClose)) {
            distinct.push(point);
        }
    }
    return distinct;
}

// The corners of the convex hull, counterclockwise, without those that are hardly corners. After
// Andrew, "Another efficient algorithm for convex hulls in two dimensions" (1979).
PointList hullOf(const PointList& points, double doubt) {
    if (points.size() < 2) {
        return points;
    }
    // First below, from left to right, then above and back.
    std::array<Point2, 64> chain;
    std::size_t size = 0;
    std::size_t first = 0;
    const auto append = [&](const Point2& point) {
        while (size >= first + 2) {
            const Point2 way = point - chain[size - 2];
            if (cross(chain[size - 1] - chain[size - 2], way) > doubt * way.norm()) {
                break;
            }
            --size;
        }
        chain[size++] = point;
    };
    std::for_each(points.begin(), points.end(), append);
    first = size - 1;
    for (std::size_t i = points.size() - 1; i > 0; --i) {
        append(points[i - 1]);
    }
    PointList corners;
    for (std::size_t i = 0; i + 1 < size; ++i) {  // the last one is the first
        corners.push(chain[i]);
    }
    return corners;
}

// Inward normals, of length 1, of the lines that bound the hull.
PointList normalsOf(const PointList& corners) {
    PointList normals;
    for (std::size_t i = 0; i < corners.size() && corners.size() > 1; ++i) {
        Point2 way = corners[(i + 1) % corners.size()] - corners[i];
        way.normalize();
        normals.push({-way.y(), way.x()});
    }
    // A line has ends, and a point is a box.
    if (corners.size() == 2) {
        normals.push({normals[0].y(), -normals[0].x()});
        normals.push({-normals[0].y(), normals[0].x()});
    }
    if (corners.size() == 1) {
        for (const double sign : {1.0, -1.0}) {
            normals.push({sign, 0});
            normals.push({0, sign});
        }
    }
    return normals;
}

}  // namespace

template <class Scalar>
ConvexRegion<Scalar> GroundFootprint<Scalar>::region(Containment containment) const {
    if (isEmpty()) {
        const Plane none(Vector3<Scalar>::Zero(), std::numeric_limits<Scalar>::quiet_NaN());
        return ConvexRegion<Scalar>(std::span(&none, 1), containment);
    }
    return ConvexRegion<Scalar>(std::span(planes_.begin(), planes_.end()), containment);
}

template <class Scalar>
std::string detail::footprintError(const Matrix4<Scalar>& viewProjection,
                                   const HeightRange<Scalar>& heights,
                                   const ScreenEdges<Scalar>& edges, double farthest) {
    if (std::string error = frustumError(viewProjection, edges); !error.empty()) {
        return error;
    }
    if (!CameraInverse(viewProjection.template cast<double>()).isValid()) {
        return "The view-projection matrix is singular: it has no inverse. Check the near and far "
               "planes and the field of view.";
    }
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    if (!(heights.low <= heights.high) || heights.low == infinity || heights.high == -infinity) {
        return "The range of heights is inverted, NaN, or all at one infinity. Pass numbers, low "
               "not above high [m].";
    }
    if (!(farthest > 0) || std::isinf(farthest)) {
        return "The farthest distance is not finite, or not above 0. Pass a finite distance above "
               "0 [m].";
    }
    return {};
}

template <class Scalar>
GroundFootprint<Scalar>::GroundFootprint(const Unaligned& matrix, DepthRange depthRange,
                                         const HeightRange<Scalar>& heights,
                                         const detail::ScreenEdges<Scalar>& edges,
                                         double farthest) {
    const detail::Matrix4<Scalar>& viewProjection = matrix.viewProjection;
    if (!detail::footprintError(viewProjection, heights, edges, farthest).empty()) {
        return;
    }
    const detail::CameraInverse inverse(viewProjection.template cast<double>());
    Corners corners = viewCorners<Scalar>(inverse, depthRange, edges);

    double nearest = 0;
    for (const Corner& corner : corners) {
        nearest = std::max(nearest, corner.point.w());
    }
    if (!(nearest > 0)) {
        return;  // all of it is behind the eye
    }
    // Passes: what is before the farthest distance, and what is between the heights.
    // Farther away, products of corners or the corners themselves would overflow.
    constexpr double kMost = std::min<double>(std::numeric_limits<Scalar>::max() / 4, 1e100);
    const double least = inverse.weightBehind(nearest, std::min(farthest, kMost));
    using Point4 = detail::Vector4<double>;
    clip(
        corners, 6, [&](const Point4& point) { return point.w() - least; },
        [&](Point4& point) { point.w() = least; });
    clipToHeights(corners, heights);
    const std::array<int, 2> axes = mapAxes(heights.up);
    PointList points;
    for (const Corner& corner : corners) {
        points.push(Point2(corner.point[axes[0]], corner.point[axes[1]]) / corner.point.w());
    }
    setHull(points, heights);
}

// Where rounding makes more corners than a hull has, the prism lacks some planes: it is too large.
template <class Scalar>
template <class Points>
void GroundFootprint<Scalar>::setHull(const Points& points, const HeightRange<Scalar>& heights) {
    double doubt = 0;
    for (const Point2& point : points) {
        doubt = std::max(doubt, kDoubt * point.cwiseAbs().maxCoeff());
    }
    const PointList corners = hullOf(distinctPoints(points, doubt), doubt);
    if (corners.empty()) {
        return;
    }
    for (const Point2& corner : corners) {
        corners_.push(corner.cast<Scalar>());
    }
    const Vector3<Scalar> up = Vector3<Scalar>::Unit(static_cast<int>(heights.up));
    planes_.push(Plane(up, -heights.low));
    planes_.push(Plane(-up, heights.high));
    const std::array<int, 2> axes = mapAxes(heights.up);
    for (const Point2& normal : normalsOf(corners)) {
        double least = std::numeric_limits<double>::infinity();
        for (const Point2& point : points) {
            least = std::min(least, normal.dot(point));
        }
        Vector3<double> inwards = Vector3<double>::Zero();
        inwards[axes[0]] = normal.x();
        inwards[axes[1]] = normal.y();
        planes_.push(Plane(inwards.cast<Scalar>(), static_cast<Scalar>(doubt - least)));
    }
}

template class HASHPHASE_INSTANCE_EXPORT GroundFootprint<float>;
template class HASHPHASE_INSTANCE_EXPORT GroundFootprint<double>;

template std::string detail::footprintError(const Matrix4<float>&, const HeightRange<float>&,
                                            const ScreenEdges<float>&, double);
template std::string detail::footprintError(const Matrix4<double>&, const HeightRange<double>&,
                                            const ScreenEdges<double>&, double);

}  // namespace hashphase
