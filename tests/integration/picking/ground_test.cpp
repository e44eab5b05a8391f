// SPDX-License-Identifier: Zlib

#include <integration/picking/drag_selection.hpp>
#include <integration/picking/ground.hpp>
#include <integration/picking/pick.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/picking_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Ground : public testing::Test {
protected:
    static constexpr double kNearly = sizeof(Scalar) == sizeof(float) ? 1e-4 : 1e-11;

    static Camera<Scalar> viewFrom(const Vector3<double>& eye, const Vector3<double>& target) {
        CameraLens lens;
        lens.farPlane = std::numeric_limits<double>::infinity();
        return {cameraMatrix<Scalar>(lens, eye, target), lens.depthRange, kViewport};
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Ground, Scalars);

// Whatever stands between the heights is met by the whole ray just when it is by the part.
TYPED_TEST(Ground, TheRayBetweenTheHeightsMeetsWhatTheRayMeetsThere) {
    Random random(0x5eed0741);
    int met = 0;
    int missed = 0;
    for (int i = 0; i < 40000; ++i) {
        SCOPED_TRACE(i);
        const auto up = static_cast<UpAxis>(random.below(3));
        const auto axis = static_cast<int>(up);
        const double low = random.between(-5, 5);
        const double high = random.chance(0.1) ? low : random.between(low, 8);
        const HeightRange<TypeParam> heights{static_cast<TypeParam>(low),
                                             static_cast<TypeParam>(high), up};
        Vector3<double> to = random.pointIn(-10, 10);
        const Vector3<double> from = random.pointIn(-10, 10);
        if (random.chance(0.1)) {
            to[axis] = from[axis];
        }
        const RayRegion<TypeParam> whole(from.cast<TypeParam>(), to.cast<TypeParam>());
        auto box = boxAround<TypeParam>(random.pointIn(-10, 10), random.pointIn(0.1, 3));
        box.min()[axis] =
            static_cast<TypeParam>(random.chance(0.3) ? low : random.between(low, high));
        box.max()[axis] =
            static_cast<TypeParam>(random.chance(0.3) ? high : random.between(low, high));
        if (box.min()[axis] > box.max()[axis]) {
            std::swap(box.min()[axis], box.max()[axis]);
        }
        const RayRegion<TypeParam> part = clipToHeights(whole, heights);
        const Vector3<TypeParam> doubt =
            Vector3<TypeParam>::Constant(static_cast<TypeParam>(this->kNearly));
        Aabb<TypeParam> smaller = box;
        Aabb<TypeParam> larger(box.min() - doubt, box.max() + doubt);
        for (int other = 0; other < 3; ++other) {
            if (other != axis) {
                smaller.min()[other] += doubt[other];
                smaller.max()[other] -= doubt[other];
            }
        }
        if (whole.key(smaller) >= 0) {
            ++met;
            const TypeParam key = part.key(box);
            EXPECT_GE(key, 0);
            const Vector3<TypeParam> point = part.from() + key * part.direction();
            const Vector3<TypeParam> expected = whole.from() + whole.key(box) * whole.direction();
            EXPECT_LT((point - expected).norm(), 10 * this->kNearly);
        } else if (whole.key(larger) < 0) {
            ++missed;
            EXPECT_LT(part.key(box), 0);
        }
        if (!part.isEmpty()) {
            const TypeParam margin = doubt[0];
            for (const auto& end :
                 {part.from(), Vector3<TypeParam>(part.from() + part.direction())}) {
                EXPECT_GE(end[axis], heights.low - margin);
                EXPECT_LE(end[axis], heights.high + margin);
            }
        }
    }
    EXPECT_GT(met, 600);
    EXPECT_GT(missed, 10000);
}

// The paper's way, hashing the point where the ray meets the ground, does not find the tower that
// stands in front of that point, on which the pointer is.
TYPED_TEST(Ground, APickFindsWhatHasHeightInFrontOfThePointOnTheGround) {
    GridConfig config;
    config.cellSize = 5;
    Grid<TypeParam> grid(config);
    const ProxyId tower = grid.add(makeBox<TypeParam>(-1, 0, -21, 1, 9, -19));
    const ProxyId bush = grid.add(makeBox<TypeParam>(-1, 0, -41, 1, 1, -39));
    const auto view = this->viewFrom({0, 10, 0}, {0, 0, -40});
    const RayRegion<TypeParam> ray = view.rayThrough(middleOf(kViewport));
    const auto point = groundPoint(ray);
    ASSERT_TRUE(point.has_value());
    EXPECT_NEAR(point->z(), -40, 1e-3);
    std::vector<ProxyId> inCell;
    CollectAll collector(inCell);
    grid.visitCell(grid.cellAt(*point), collector);
    EXPECT_EQ(inCell, std::vector{bush});
    const auto part = clipToHeights(ray, {TypeParam(0), TypeParam(9)});
    EXPECT_EQ(pickNearest(grid, part).id, tower);
    std::vector<Picked<TypeParam>> all;
    pickAll(grid, part, all);
    EXPECT_EQ(all.size(), 2U);
    // Along no more than it takes: from z = -4 to the ground.
    EXPECT_NEAR(part.from().y(), 9, 1e-4);
    EXPECT_NEAR((part.from() + part.direction()).y(), 0, 1e-4);
}

TYPED_TEST(Ground, ARayThatNeverComesBetweenTheHeightsIsEmpty) {
    using Point = Vector3<TypeParam>;
    const HeightRange<TypeParam> heights{TypeParam(0), TypeParam(2)};
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    const RayRegion<TypeParam> down(Point(0, 5, 0), Point(0, -5, 0));
    EXPECT_FALSE(clipToHeights(down, heights).isEmpty());
    EXPECT_TRUE(
        clipToHeights(RayRegion<TypeParam>(Point(0, 5, 0), Point(9, 6, 0)), heights).isEmpty());
    EXPECT_TRUE(
        clipToHeights(RayRegion<TypeParam>(Point(0, 5, 0), Point(9, 5, 0)), heights).isEmpty());
    EXPECT_TRUE(
        clipToHeights(RayRegion<TypeParam>(Point(0, nan, 0), Point(9, 1, 0)), heights).isEmpty());
    EXPECT_TRUE(clipToHeights(down, {TypeParam(2), TypeParam(0)}).isEmpty());
    EXPECT_TRUE(clipToHeights(down, {nan, TypeParam(0)}).isEmpty());
    // Along the ground, and at an end.
    EXPECT_FALSE(
        clipToHeights(RayRegion<TypeParam>(Point(0, 2, 0), Point(9, 2, 0)), heights).isEmpty());
    EXPECT_FALSE(
        clipToHeights(RayRegion<TypeParam>(Point(0, 5, 0), Point(9, 2, 0)), heights).isEmpty());
    constexpr auto infinity = std::numeric_limits<TypeParam>::infinity();
    const auto below = clipToHeights(down, {-infinity, TypeParam(2)});
    EXPECT_NEAR(below.from().y(), 2, 1e-4);
    EXPECT_NEAR((below.from() + below.direction()).y(), -5, 1e-4);
    // A fat ray comes there sooner.
    const Aabb<TypeParam> fat(Point(-1, -1, -1), Point(1, 1, 1));
    const auto part =
        clipToHeights(RayRegion<TypeParam>(Point(0, 5, 0), Point(0, -5, 0), fat), heights);
    EXPECT_NEAR(part.from().y(), 3, 1e-4);
    EXPECT_NEAR((part.from() + part.direction()).y(), -1, 1e-4);
}

TYPED_TEST(Ground, ThePointUnderAPixelIsSeenThere) {
    Random random(0x5eed0742);
    int points = 0;
    int overTheHorizon = 0;
    for (int i = 0; i < 4000; ++i) {
        SCOPED_TRACE(i);
        const double height = random.between(-3, 3);
        const Vector3<double> eye(random.between(-50, 50), random.between(4, 30),
                                  random.between(-50, 50));
        const auto view = this->viewFrom(eye, eye + random.pointIn({-20, -12, -20}, {20, 4, 20}));
        const Pixel pixel(kViewport.x + random.between(0, kViewport.width),
                          kViewport.y + random.between(0, kViewport.height));
        const RayRegion<TypeParam> ray = view.rayThrough(pixel);
        const auto point = groundPoint(ray, static_cast<TypeParam>(height));
        const bool isDownwards = ray.direction().y() < -1;  // of a million metres
        if (!isDownwards && ray.direction().y() > -100) {
            EXPECT_FALSE(point.has_value());
            ++overTheHorizon;
            continue;
        }
        if (ray.direction().y() > -1e4) {
            continue;  // rounding moves the point by metres
        }
        ASSERT_TRUE(point.has_value());
        ++points;
        EXPECT_EQ(point->y(), static_cast<TypeParam>(height));
        const Pixel seen = pixelOf(
            clipCoordinates(view.viewProjection(), point->template cast<double>()), kViewport);
        EXPECT_LT((seen - pixel).cwiseAbs().maxCoeff(), 2e3 * this->kNearly);
    }
    EXPECT_GT(points, 1000);
    EXPECT_GT(overTheHorizon, 200);
}

TYPED_TEST(Ground, IsNotMetByRaysThatAreParallelOrEndBefore) {
    using Point = Vector3<TypeParam>;
    using Ray = RayRegion<TypeParam>;
    EXPECT_FALSE(groundPoint(Ray(Point(0, 1, 0), Point(9, 1, 0))).has_value());
    EXPECT_FALSE(groundPoint(Ray(Point(0, 0, 0), Point(9, 0, 0))).has_value());
    EXPECT_FALSE(groundPoint(Ray(Point(0, 2, 0), Point(9, 1, 0))).has_value());
    EXPECT_FALSE(groundPoint(Ray(Point(0, 2, 0), Point(9, 3, 0))).has_value());
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    EXPECT_FALSE(groundPoint(Ray(Point(0, 2, nan), Point(9, -3, 0))).has_value());
    EXPECT_FALSE(groundPoint(Ray(Point(0, 2, 0), Point(9, -3, 0)), nan).has_value());
    EXPECT_EQ(groundPoint(Ray(Point(0, 2, 0), Point(8, 0, 0))), Point(8, 0, 0));
    EXPECT_EQ(groundPoint(Ray(Point(1, 2, 3), Point(1, 2, -1)), 1, UpAxis::z), Point(1, 2, 1));
}

TYPED_TEST(Ground, IsMetByEveryRayThatEndsOnIt) {
    Random random(0x5eed0744);
    for (int i = 0; i < 20000; ++i) {
        const double far = random.logBetween(1e-3, 1e6);
        const Vector3<TypeParam> from = random.pointIn(-far, far).template cast<TypeParam>();
        Vector3<TypeParam> to = random.pointIn(-9, 9).template cast<TypeParam>();
        const auto height = static_cast<TypeParam>(random.between(-9, 9));
        to.y() = height;
        const auto point = groundPoint(RayRegion<TypeParam>(from, to), height);
        ASSERT_TRUE(point.has_value() || from.y() == height) << i;
        const TypeParam near =
            8 * std::numeric_limits<TypeParam>::epsilon() * static_cast<TypeParam>(far + 9);
        ASSERT_LE((*point - to).cwiseAbs().maxCoeff(), near) << i;
    }
}

// What is seen between the corners is selected on the map as well, with what is hidden above it.
TYPED_TEST(Ground, ADragCoversOnTheGroundWhateverItSelectsThere) {
    Random random(0x5eed0743);
    Grid<TypeParam> grid;
    const HeightRange<TypeParam> heights{TypeParam(-1), TypeParam(6)};
    for (int i = 0; i < 1000; ++i) {
        const double height = random.between(0.2, 3);
        (void)grid.add(boxAround<TypeParam>(
            {random.between(-60, 60), height - 1, random.between(-60, 60)}, {1, height, 1}));
    }
    std::size_t seen = 0;
    std::size_t covered = 0;
    std::vector<ProxyId> selected;
    for (int i = 0; i < 300; ++i) {
        SCOPED_TRACE(i);
        const auto view = this->viewFrom(random.pointIn({-30, 8, -30}, {30, 25, 30}),
                                         random.pointIn({-20, 0, -20}, {20, 9, 20}));
        const Pixel a(random.between(-100, 1400), random.between(-100, 800));
        const Pixel b(random.between(-100, 1400), random.between(-100, 800));
        const auto footprint = dragFootprint(view, a, b, heights, 500);
        std::vector<ProxyId> onMap;
        CollectAll collector(onMap);
        grid.visit(footprint.region(), collector);
        std::sort(onMap.begin(), onMap.end());
        select(grid, view, a, b, selected);
        const auto planes =
            planesBetween(view.viewProjection(), view.depthRange(), kViewport, a, b);
        for (const ProxyId id : selected) {
            if (!std::binary_search(onMap.begin(), onMap.end(), id)) {
                const double depth = depthInVolume(planes, grid.box(id).template cast<double>());
                EXPECT_LT(depth, 0) << "Only what rounding takes for seen may be missing.";
            }
        }
        seen += selected.size();
        covered += onMap.size();
        // The same in any order of corners.
        const auto reversed = dragFootprint(view, b, a, heights, 500);
        EXPECT_TRUE(std::equal(footprint.corners().begin(), footprint.corners().end(),
                               reversed.corners().begin(), reversed.corners().end()));
    }
    EXPECT_GT(seen, 5000U);
    EXPECT_GT(covered, seen);
    const auto bad =
        Camera<TypeParam>(Eigen::Matrix<TypeParam, 4, 4>::Zero(), DepthRange::zeroToOne, kViewport);
    EXPECT_TRUE(dragFootprint(bad, {0, 0}, {9, 9}, heights).isEmpty());
}

}  // namespace
}  // namespace hashphase::test
