// SPDX-License-Identifier: Zlib

// Who is seen from where; in lives of all scenes: ai_scenes_test.cpp.

#include <integration/ai/sight.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class SightTest : public testing::Test {
protected:
    static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
    static constexpr Scalar kPi = std::numbers::pi_v<Scalar>;

    ProxyId addPoint(Scalar x, Scalar y, Scalar z) {
        const Vector3<Scalar> point(x, y, z);
        return grid.add({point, point});
    }
    bool sees(const Viewer<Scalar>& viewer, ProxyId target) {
        std::vector<ProxyId> seen;
        visibleFrom(grid, viewer, seen);
        const bool isAmong = std::find(seen.begin(), seen.end(), target) != seen.end();
        EXPECT_EQ(canSee(grid, viewer, target), isAmong);
        return isAmong;
    }

    Grid<Scalar> grid;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SightTest, Scalars);

TYPED_TEST(SightTest, OfAConeIsByTheAngleToItsAxis) {
    // The definition, in higher precision.
    Random random(0x5eed0b03);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        Viewer<TypeParam> viewer;
        viewer.direction = random.pointIn(-1, 1).cast<TypeParam>() *
                           static_cast<TypeParam>(random.logBetween(1e-12, 1e12));
        viewer.halfAngle = static_cast<TypeParam>(random.chance(0.3) ? random.logBetween(1e-4, 1)
                                                                     : random.between(0, 3.1));
        Vector3<TypeParam> point = random.pointIn(-9, 9).cast<TypeParam>();
        if (random.chance(0.5)) {
            const auto aside = static_cast<TypeParam>(random.between(0, 2)) * viewer.halfAngle;
            point = viewer.direction.normalized() + point.normalized() * aside;
        }
        const Vector3<long double> axis = viewer.direction.template cast<long double>();
        const Vector3<long double> offset = point.template cast<long double>();
        const long double angle = std::atan2(axis.cross(offset).norm(), axis.dot(offset));
        const long double slack = 16 * std::numeric_limits<TypeParam>::epsilon();
        const TypeParam key = SightRegion<TypeParam>(viewer).key({point, point});
        if (angle < viewer.halfAngle - slack) {
            ASSERT_GE(key, 0) << static_cast<double>(angle) << ' ' << viewer.halfAngle;
            ++inside;
        }
        if (angle > viewer.halfAngle + slack) {
            ASSERT_EQ(key, -1) << static_cast<double>(angle) << ' ' << viewer.halfAngle;
        }
    }
    EXPECT_GT(inside, 4000);
}

TYPED_TEST(SightTest, OfAConeLooksAsFarAsItsSurfaceReachesAlongEachAxis) {
    Random random(0x5eed0b07);
    int seen = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector3<double> axis = random.pointIn(-1, 1).normalized();
        const double halfAngle = random.between(0, 3.1);
        Viewer<TypeParam> viewer;
        viewer.eye = random.pointIn(-100, 100).cast<TypeParam>();
        viewer.direction = axis.cast<TypeParam>();
        viewer.halfAngle = static_cast<TypeParam>(halfAngle);
        viewer.range = static_cast<TypeParam>(random.logBetween(0.1, 1000));
        const SightRegion<TypeParam> view(viewer);
        for (int side = 0; side < 6; ++side) {
            // The direction of the cone that is nearest to this side of an axis.
            const Vector3<double> unit =
                Vector3<double>::Unit(side / 2) * (side % 2 == 0 ? 1.0 : -1.0);
            const double apart = std::acos(unit.dot(axis));
            const Vector3<double> across = (unit - unit.dot(axis) * axis).normalized();
            const double turn = std::min(apart, halfAngle * 0.999);
            const Vector3<double> nearest = std::cos(turn) * axis + std::sin(turn) * across;
            const Vector3<TypeParam> point =
                viewer.eye + nearest.cast<TypeParam>() * (viewer.range * TypeParam(0.999));
            seen += view.key({point, point}) >= 0 ? 1 : 0;
            ASSERT_TRUE(view.bounds().contains(point) || view.key({point, point}) < 0)
                << "half angle " << halfAngle << " about " << axis.transpose();
        }
    }
    EXPECT_GT(seen, 11900);
}

TYPED_TEST(SightTest, OfANarrowConeReadsFarLessThanItsBall) {
    Random random(0x5eed0b04);
    for (int i = 0; i < 3000; ++i) {
        this->addPoint(static_cast<TypeParam>(random.between(-50, 50)),
                       static_cast<TypeParam>(random.between(-50, 50)),
                       static_cast<TypeParam>(random.between(-50, 50)));
    }
    Viewer<TypeParam> viewer;
    viewer.range = 50;
    CollectCount count;
    const Aabb<TypeParam> ball = SightRegion<TypeParam>(viewer).bounds();
    viewer.halfAngle = TypeParam(0.2);
    const Aabb<TypeParam> cone = SightRegion<TypeParam>(viewer).bounds();
    EXPECT_LT(cone.volume(), ball.volume() / 40);
    EXPECT_TRUE(ball.contains(cone));
}

TYPED_TEST(SightTest, StopsAtAWallAndNotAtWhatIsBehindOrBeside) {
    const ProxyId target = this->addPoint(10, 0, 0);
    Viewer<TypeParam> viewer;
    EXPECT_TRUE(this->sees(viewer, target));
    const ProxyId wall = this->grid.add(makeBox<TypeParam>(5, -1, -1, 6, 1, 1));
    EXPECT_FALSE(this->sees(viewer, target));
    const auto notTheWall = [wall](ProxyId id) { return id != wall; };
    EXPECT_TRUE(canSee(this->grid, viewer, target, notTheWall));
    this->grid.move(wall, makeBox<TypeParam>(11, -1, -1, 12, 1, 1));
    EXPECT_TRUE(this->sees(viewer, target)) << "behind, and seen at once";
    this->grid.move(wall, makeBox<TypeParam>(10, -1, -1, 12, 1, 1));
    EXPECT_TRUE(this->sees(viewer, target)) << "begins where the line ends";
    this->grid.move(wall, makeBox<TypeParam>(5, 1, -1, 6, 2, 1));
    EXPECT_TRUE(this->sees(viewer, target)) << "beside";
    this->grid.move(wall, makeBox<TypeParam>(5, 0, -1, 6, 2, 1));
    EXPECT_FALSE(this->sees(viewer, target)) << "grazed";
    this->grid.move(wall, makeBox<TypeParam>(-1, -1, -1, 1, 1, 1));
    EXPECT_TRUE(this->sees(viewer, target)) << "around the eye";
    this->grid.move(wall, makeBox<TypeParam>(TypeParam(0.5), -1, -1, 1, 1, 1));
    EXPECT_FALSE(this->sees(viewer, target)) << "before the eye";
    viewer.self = wall;
    EXPECT_TRUE(this->sees(viewer, target)) << "the viewer's own body";
    EXPECT_FALSE(canSee(this->grid, viewer, wall)) << "itself";
    EXPECT_FALSE(hasLineOfSight(this->grid, {0, 0, 0}, {10, 0, 0}));
    EXPECT_TRUE(hasLineOfSight(this->grid, {0, 0, 0}, {10, 0, 0}, acceptAll, wall, target));
    this->grid.remove(target);
    EXPECT_FALSE(this->sees(viewer, target)) << "no longer there";
}

TYPED_TEST(SightTest, DoesNotEndAtTheTargetsOwnBox) {
    const ProxyId target = this->grid.add(makeBox<TypeParam>(9, -1, -1, 11, 1, 1));
    EXPECT_TRUE(this->sees({}, target));
    Viewer<TypeParam> within;
    within.eye = {TypeParam(9.5), 0, 0};
    EXPECT_TRUE(this->sees(within, target));
}

TYPED_TEST(SightTest, HasADefinedAnswerForDegenerateViewers) {
    const ProxyId ahead = this->addPoint(10, 0, 0);
    const ProxyId behind = this->addPoint(-10, 0, 0);
    const ProxyId beside = this->addPoint(0, 10, 0);
    const ProxyId here = this->grid.add(makeBox<TypeParam>(0, 0, 0, 0, 0, 0));
    const std::vector<ProxyId> none;
    const auto seenBy = [&](auto change) {
        Viewer<TypeParam> viewer;
        viewer.halfAngle = 1;
        change(viewer);
        std::vector<ProxyId> seen;
        const auto no = [](ProxyId) { return false; };
        visibleFrom(this->grid, viewer, seen, acceptAll, no);
        return seen;
    };
    using V = Viewer<TypeParam>;
    const TypeParam nan = this->kNan;
    const TypeParam infinity = this->kInfinity;
    EXPECT_EQ(seenBy([](V&) {}), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = 0; }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = TypeParam(1.6); }),
              (std::vector{ahead, beside, here}));
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = TypeParam(3.14); }),
              (std::vector{ahead, beside, here}));
    EXPECT_EQ(seenBy([&](V& v) { v.halfAngle = this->kPi; }),
              (std::vector{ahead, behind, beside, here}));
    EXPECT_EQ(seenBy([&](V& v) { v.halfAngle = infinity; }).size(), 4U);
    EXPECT_EQ(seenBy([](V& v) { v.halfAngle = -1; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.halfAngle = nan; }), none);
    EXPECT_EQ(seenBy([](V& v) { v.direction.setZero(); }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.direction[1] = nan; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.direction[0] = infinity; }), none);
    EXPECT_EQ(seenBy([&](V& v) {
                  v.direction.setZero();
                  v.halfAngle = 4;
              }).size(),
              4U);
    EXPECT_EQ(seenBy([&](V& v) {
                  v.direction[1] = nan;
                  v.halfAngle = this->kPi;
              }).size(),
              4U);
    EXPECT_EQ(seenBy([](V& v) { v.direction *= TypeParam(1e-30); }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.direction *= std::numeric_limits<TypeParam>::max(); }),
              (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.range = 10; }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([](V& v) { v.range = 9; }), std::vector{here});
    EXPECT_EQ(seenBy([](V& v) { v.range = 0; }), std::vector{here});
    EXPECT_EQ(seenBy([](V& v) { v.range = -1; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.range = nan; }), none);
    EXPECT_EQ(seenBy([](V& v) { v.range = TypeParam(1e30); }), (std::vector{ahead, here}));
    EXPECT_EQ(seenBy([&](V& v) { v.eye[0] = nan; }), none);
    EXPECT_EQ(seenBy([&](V& v) { v.eye[0] = infinity; }), none);
    EXPECT_EQ(seenBy([](V& v) { v.eye[0] = TypeParam(-1e30); }).size(), 4U);
    EXPECT_FALSE(hasLineOfSight(this->grid, {nan, 0, 0}, {0, 0, 0}));
    EXPECT_FALSE(hasLineOfSight(this->grid, {0, 0, 0}, {infinity, 0, 0}));
    EXPECT_FALSE(canSee(this->grid, V{}, ProxyId{}));
}

}  // namespace
}  // namespace hashphase::test
