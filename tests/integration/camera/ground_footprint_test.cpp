// SPDX-License-Identifier: Zlib

#include <integration/camera/ground_footprint.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/convex_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Scalar>
struct FootprintCase {
    Eigen::Matrix<Scalar, 4, 4> matrix;
    DepthRange depthRange{};
    HeightRange<Scalar> heights;
    ScreenRectangle<Scalar> rectangle;
    double farthest = 80;

    [[nodiscard]] GroundFootprint<Scalar> footprint() const {
        return {matrix, depthRange, heights, rectangle, farthest};
    }

    /// The planes of the view between the heights, no farther away than a little less.
    [[nodiscard]] std::vector<OraclePlane> viewPlanes() const {
        auto planes = oraclePlanes<double>(frustumPlanes<double>(
            matrix.template cast<double>(), depthRange, rectangle.template cast<double>()));
        const int up = static_cast<int>(heights.up);
        if (std::isfinite(heights.low)) {
            planes.emplace_back(Vector3<double>::Unit(up), -static_cast<double>(heights.low));
        }
        if (std::isfinite(heights.high)) {
            planes.emplace_back(-Vector3<double>::Unit(up), static_cast<double>(heights.high));
        }
        OraclePlane ahead;
        ahead.coeffs() = -matrix.row(3).transpose().template cast<double>();
        if (const double size = ahead.normal().norm(); size > 0) {
            ahead.coeffs() /= size;
            ahead.offset() += 0.999 * farthest;
            planes.push_back(ahead);
        }
        return planes;
    }
};

template <class Scalar>
FootprintCase<Scalar> randomCase(Random& random) {
    FootprintCase<Scalar> result;
    const CameraLens lens = randomLens(random);
    result.depthRange = lens.depthRange;
    result.matrix = cameraMatrix<Scalar>(lens, random.pointIn(-9, 9), random.pointIn(-9, 9));
    const double low = random.between(-6, 6);
    result.heights.low = static_cast<Scalar>(random.chance(0.05) ? -kInfinity : low);
    result.heights.high = static_cast<Scalar>(random.chance(0.2)    ? low
                                              : random.chance(0.05) ? kInfinity
                                                                    : random.between(low, 8));
    result.heights.up = static_cast<UpAxis>(random.below(3));
    result.rectangle = wholeScreen<Scalar>();
    for (int axis = 0; axis < 2 && random.chance(0.7); ++axis) {
        const double a = random.between(-1, 1);
        const double b = random.chance(0.1) ? a : random.between(-1, 1);
        result.rectangle.min()[axis] = static_cast<Scalar>(std::min(a, b));
        result.rectangle.max()[axis] = static_cast<Scalar>(std::max(a, b));
    }
    return result;
}

template <class Scalar>
std::vector<Eigen::Vector2d> cornersOf(const GroundFootprint<Scalar>& footprint) {
    std::vector<Eigen::Vector2d> corners;
    for (const auto& corner : footprint.corners()) {
        corners.push_back(corner.template cast<double>());
    }
    return corners;
}

/// How deep in the view, at most, a point lies of the vertical line between heights over a place on
/// the map.
double depthOver(const std::vector<OraclePlane>& view, UpAxis upAxis,
                 const Eigen::Vector2d& place) {
    const auto up = static_cast<int>(upAxis);
    const auto axes = mapAxes(upAxis);
    Vector3<double> foot = Vector3<double>::Zero();
    foot[axes[0]] = place[0];
    foot[axes[1]] = place[1];
    // The depth is a concave function of the height: the lowest of lines.
    const auto depthAt = [&](double height) {
        Vector3<double> point = foot;
        point[up] = height;
        double depth = kInfinity;
        for (const OraclePlane& plane : view) {
            depth = std::min(depth, plane.signedDistance(point));
        }
        return depth;
    };
    double low = -1e4;
    double high = 1e4;
    for (int i = 0; i < 200; ++i) {
        const double a = low + (high - low) / 3;
        const double b = high - (high - low) / 3;
        (depthAt(a) < depthAt(b) ? low : high) = depthAt(a) < depthAt(b) ? a : b;
    }
    return depthAt((low + high) / 2);
}

/// How far apart a convex polygon, counterclockwise, and a rectangle are, along the axis that tells
/// them apart best; negative where they overlap, 0 where they touch.
double gapOnMap(std::span<const Eigen::Vector2d> polygon, const Eigen::AlignedBox2d& rectangle) {
    double gap = -std::numeric_limits<double>::infinity();
    const auto testAlong = [&](const Eigen::Vector2d& axis) {
        double low[2] = {1e300, 1e300};
        double high[2] = {-1e300, -1e300};
        const auto add = [&](int whose, const Eigen::Vector2d& point) {
            low[whose] = std::min(low[whose], axis.dot(point));
            high[whose] = std::max(high[whose], axis.dot(point));
        };
        for (const Eigen::Vector2d& point : polygon) {
            add(0, point);
        }
        for (int corner = 0; corner < 4; ++corner) {
            add(1, rectangle.corner(static_cast<Eigen::AlignedBox2d::CornerType>(corner)));
        }
        gap = std::max({gap, low[0] - high[1], low[1] - high[0]});
    };
    testAlong({1, 0});
    testAlong({0, 1});
    for (std::size_t i = 0; i < polygon.size() && polygon.size() > 1; ++i) {
        const Eigen::Vector2d way = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
        testAlong({-way.y(), way.x()});
    }
    return gap;
}

/// How far a point lies outside of the polygon; negative inside.
double distanceOutside(std::span<const Eigen::Vector2d> polygon, const Eigen::Vector2d& point) {
    double outside = polygon.size() > 2 ? -kInfinity : kInfinity;
    for (std::size_t i = 0; i < polygon.size() && polygon.size() > 2; ++i) {
        const Eigen::Vector2d way = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
        const Eigen::Vector2d off = point - polygon[i];
        outside = std::max(outside, off.x() * way.y() - off.y() * way.x());
    }
    return outside;
}

double reachOf(std::span<const Eigen::Vector2d> polygon) {
    double reach = 1;
    for (const Eigen::Vector2d& point : polygon) {
        reach = std::max(reach, point.norm());
    }
    return reach;
}

template <class Scalar>
class Footprint : public testing::Test {
protected:
    // Closer than rounding can tell, both answers are right.
    static constexpr double kNearly = sizeof(Scalar) == sizeof(float) ? 2e-4 : 1e-7;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Footprint, Scalars);

TYPED_TEST(Footprint, NeverMissesWhatTheViewTouchesAndIsConvexAndNotLargerThanWhatIsSeen) {
    Random random(0x5eed0711);
    int touching = 0;
    int beyond = 0;
    std::size_t cornerCount = 0;
    for (int i = 0; i < 2000; ++i) {
        SCOPED_TRACE(i);
        auto drawn = randomCase<TypeParam>(random);
        const auto footprint = drawn.footprint();
        const auto view = drawn.viewPlanes();
        for (int k = 0; k < 4; ++k) {
            const auto box = boxAround<TypeParam>(
                random.pointIn(-12, 12), Vector3<double>::Constant(random.logBetween(0.02, 10)));
            if (depthInVolume(view, box.template cast<double>()) > -1e-12) {
                ++touching;
                EXPECT_GE(footprint.region().key(box), 0);
            } else {
                beyond += footprint.region().key(box) < 0 ? 1 : 0;
            }
        }
        drawn.farthest *= 1.01;  // and that from the near plane on
        drawn.farthest += 3;
        const auto more = drawn.viewPlanes();
        const auto corners = cornersOf(footprint);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const auto& a = corners[k];
            EXPECT_GT(depthOver(more, drawn.heights.up, a), -this->kNearly * (1 + a.norm()));
            const Eigen::Vector2d edge = corners[(k + 1) % corners.size()] - a;
            const Eigen::Vector2d& c = corners[(k + 2) % corners.size()];
            const Eigen::Vector2d way = c - a;
            const double left = edge.x() * way.y() - edge.y() * way.x();
            EXPECT_TRUE(corners.size() < 3 ||
                        left > -this->kNearly * (1 + c.norm()) * (way.norm() + edge.norm()));
        }
        cornerCount += corners.size();
        EXPECT_LE(corners.size(), GroundFootprint<TypeParam>::kMostCorners);
    }
    EXPECT_GT(touching, 400);
    EXPECT_GT(beyond, 1000);
    EXPECT_GT(cornerCount, 2000U);
}

// By the corners, in two dimensions, without regard to how the region finds it.
TYPED_TEST(Footprint, SelectsExactlyWhatTouchesOrIsInsideThePrism) {
    Random random(0x5eed0714);
    std::array<int, 4> answers{};
    for (int i = 0; i < 1500; ++i) {
        SCOPED_TRACE(i);
        const auto drawn = randomCase<TypeParam>(random);
        const auto footprint = drawn.footprint();
        const auto corners = cornersOf(footprint);
        const auto touched = footprint.region();
        const auto inside = footprint.region(Containment::inside);
        const auto up = static_cast<int>(drawn.heights.up);
        const auto axes = mapAxes(drawn.heights.up);
        for (int k = 0; k < 10; ++k) {
            const auto box = boxAround<TypeParam>(
                random.pointIn(-15, 15), Vector3<double>::Constant(random.logBetween(0.01, 5)));
            if (corners.empty()) {
                EXPECT_LT(touched.key(box), 0);
                continue;
            }
            const Aabb<double> exact = box.template cast<double>();
            const Eigen::AlignedBox2d onMap(
                Eigen::Vector2d(exact.min()[axes[0]], exact.min()[axes[1]]),
                Eigen::Vector2d(exact.max()[axes[0]], exact.max()[axes[1]]));
            const auto low = static_cast<double>(drawn.heights.low);
            const auto high = static_cast<double>(drawn.heights.high);
            double gap = gapOnMap(corners, onMap);
            gap = std::max({gap, low - exact.max()[up], exact.min()[up] - high});
            double outside = std::max(low - exact.min()[up], exact.max()[up] - high);
            for (unsigned corner = 0; corner < 4; ++corner) {
                const auto type = static_cast<Eigen::AlignedBox2d::CornerType>(corner);
                outside = std::max(outside, distanceOutside(corners, onMap.corner(type)));
            }
            const double doubt = this->kNearly * reachOf(corners);
            if (std::abs(gap) > doubt) {
                EXPECT_EQ(touched.key(box) >= 0, gap < 0) << gap;
                ++answers[gap < 0 ? 0 : 1];
            }
            if (std::abs(outside) > doubt) {
                EXPECT_EQ(inside.key(box) >= 0, outside < 0) << outside;
                ++answers[outside < 0 ? 2 : 3];
            }
        }
    }
    for (const int count : answers) {
        EXPECT_GT(count, 200);
    }
}

// --- Particular views ----------------------------------------------------------------------------

/// 10 m above the ground, which is y = 0, looking at a point on it.
template <class Scalar>
Eigen::Matrix<Scalar, 4, 4> cameraOver(const Vector3<double>& target, double farPlane = kInfinity) {
    CameraLens lens;
    lens.farPlane = farPlane;
    return cameraMatrix<Scalar>(lens, {0, 10, 0}, target);
}

// The near corners are as good as one, seen from so far.
TYPED_TEST(Footprint, OfWhatIsEnormouslyFarDoesNotOverflow) {
    const auto matrix = cameraOver<TypeParam>({0, 10, -20});
    for (const double farthest : {1e36, 1e60, 1e200, 1e308}) {
        const GroundFootprint<TypeParam> footprint(matrix, DepthRange::zeroToOne, {},
                                                   wholeScreen<TypeParam>(), farthest);
        EXPECT_GE(footprint.corners().size(), 3U) << farthest;
        for (const auto& corner : footprint.corners()) {
            EXPECT_TRUE(corner.allFinite()) << farthest;
        }
        const auto region = footprint.region();
        EXPECT_GE(region.key(boxAround<TypeParam>({0, 0, -1e35}, {1, 1, 1})), 0) << farthest;
        const double behind = std::min(farthest, sizeof(TypeParam) == sizeof(float) ? 1e37 : 1e99);
        EXPECT_LT(region.key(boxAround<TypeParam>({0, 0, behind}, {1, 1, 1})), 0) << farthest;
    }
}

TYPED_TEST(Footprint, EndsAtTheFarthestDistanceWhereTheHorizonIsSeen) {
    const auto matrix = cameraOver<TypeParam>({0, 10, -20});
    const GroundFootprint<TypeParam> footprint(matrix, DepthRange::zeroToOne, {},
                                               wholeScreen<TypeParam>(), 500);
    ASSERT_EQ(footprint.corners().size(), 4U);
    for (const auto& corner : footprint.corners()) {
        EXPECT_GT(corner.y(), -501);
        EXPECT_LT(corner.y(), 0);
    }
    EXPECT_GE(footprint.region().key(makeBox<TypeParam>(0, 0, -499, 1, 1, -498)), 0);
    EXPECT_LT(footprint.region().key(makeBox<TypeParam>(0, 0, -503, 1, 1, -502)), 0);
    // By default, far away.
    const GroundFootprint<TypeParam> whole(matrix, DepthRange::zeroToOne, {});
    EXPECT_GE(whole.region().key(makeBox<TypeParam>(0, 0, -9e5, 1, 1, -8.9e5)), 0);
}

TYPED_TEST(Footprint, OfARectangleWithoutAreaIsALineOrAPoint) {
    const auto matrix = cameraOver<TypeParam>({3, 0, -20});
    auto rectangle = wholeScreen<TypeParam>();
    rectangle.min().x() = rectangle.max().x() = TypeParam(0.25);
    const GroundFootprint<TypeParam> line(matrix, DepthRange::zeroToOne, {}, rectangle);
    EXPECT_EQ(line.corners().size(), 2U);
    rectangle.min().y() = rectangle.max().y() = TypeParam(-0.5);
    const GroundFootprint<TypeParam> point(matrix, DepthRange::zeroToOne, {}, rectangle);
    ASSERT_EQ(point.corners().size(), 1U);
    const Vector3<double> place(static_cast<double>(point.corners()[0].x()), 0,
                                static_cast<double>(point.corners()[0].y()));
    for (const auto* footprint : {&line, &point}) {
        const auto here = boxAround<TypeParam>(place, {0.01, 0.01, 0.01});
        EXPECT_GE(footprint->region().key(here), 0);
        const Vector3<double> beside = place + Vector3<double>(0.05, 0, 0.001);
        const auto there = boxAround<TypeParam>(beside, {0.01, 0.01, 0.01});
        EXPECT_LT(footprint->region().key(there), 0);
        EXPECT_LT(footprint->region(Containment::inside).key(here), 0);
    }
}

TYPED_TEST(Footprint, SaysWhatIsWrong) {
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    const auto good = cameraOver<TypeParam>({0, 0, -20});
    const auto errorOf = [](const auto& matrix, const HeightRange<TypeParam>& heights,
                            double farthest = 100) {
        const auto screen = wholeScreen<TypeParam>();
        EXPECT_TRUE(
            GroundFootprint<TypeParam>(matrix, DepthRange::zeroToOne, heights, screen, farthest)
                .region()
                .isEmpty());
        return footprintError<TypeParam>(matrix, heights, screen, farthest);
    };
    auto bad = good;
    bad(2, 1) = nan;
    EXPECT_NE(errorOf(bad, {}).find("finite"), std::string::npos);
    bad = good;
    bad.row(0) = bad.row(1);
    EXPECT_NE(errorOf(bad, {}).find("singular"), std::string::npos);
    EXPECT_NE(errorOf(good, {TypeParam(1), TypeParam(0)}).find("low not above high"),
              std::string::npos);
    EXPECT_NE(errorOf(good, {TypeParam(1), nan}).find("heights"), std::string::npos);
    EXPECT_NE(errorOf(good, {}, 0).find("farthest"), std::string::npos);
    EXPECT_NE(errorOf(good, {}, kInfinity).find("farthest"), std::string::npos);
    ScreenRectangle<TypeParam> none;
    EXPECT_TRUE(GroundFootprint<TypeParam>(good, DepthRange::zeroToOne, {}, none).isEmpty());
    EXPECT_NE(footprintError(good, HeightRange<TypeParam>{}, none).find("rectangle"),
              std::string::npos);
    EXPECT_EQ(footprintError(good, HeightRange<TypeParam>{}), "");
}

}  // namespace
}  // namespace hashphase::test
