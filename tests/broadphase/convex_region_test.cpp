// SPDX-License-Identifier: Zlib

#include <broadphase/convex_region.hpp>
#include <integration/camera/frustum.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/convex_oracle.hpp>
#include <tests/support/population.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class ConvexQuery : public testing::Test {
protected:
    static ConvexRegion<Scalar> volumeOf(const std::vector<Eigen::Hyperplane<Scalar, 3>>& planes,
                                         Containment containment = Containment::touching,
                                         Touch touch = Touch::exact) {
        return ConvexRegion<Scalar>(planes, containment, touch);
    }
    static bool has(const ConvexRegion<Scalar>& region, const Aabb<Scalar>& box) {
        return region.key(box) >= 0;
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(ConvexQuery, Scalars);

/// The region finds the box as the oracle says; 1 if it does, -1 if not, 0 where rounding decides.
template <class Scalar>
int expectLikeOracle(const ConvexRegion<Scalar>& region, const Aabb<Scalar>& box, double depth,
                     double rounding) {
    const int expected = depth > -1e-12 ? 1 : depth < -rounding ? -1 : 0;
    EXPECT_TRUE(expected == 0 || (region.key(box) >= 0) == (expected > 0)) << depth;
    return expected;
}

// Of frusta, wedges and prisms of every shape; boxes from tiny to larger than the volume.
TYPED_TEST(ConvexQuery, FindsExactlyTheBoxesThatShareAPointWithTheVolume) {
    constexpr double kRounding = sizeof(TypeParam) == sizeof(float) ? 1e-4 : 1e-9;
    Random random(0x5eed0601);
    int touching = 0;
    int falseByPlanes = 0;
    int inside = 0;
    for (int i = 0; i < 10000; ++i) {
        SCOPED_TRACE(i);
        const auto frustum = frustumPlanes<TypeParam>(
            randomCamera<TypeParam>(random, Vector3<double>::Zero(), 10), DepthRange::zeroToOne);
        const std::vector planes(frustum.begin(), frustum.end());
        const auto box = cubesIn<TypeParam>(-30, 30, random.logBetween(0.01, 30))(random);
        const std::vector<OraclePlane> oracle = oraclePlanes<TypeParam>(planes);
        const double depth = depthInVolume(oracle, box.template cast<double>());
        const int touches = expectLikeOracle(this->volumeOf(planes), box, depth, kRounding);
        const bool touchesPlanes =
            this->has(this->volumeOf(planes, Containment::touching, Touch::byPlanes), box);
        EXPECT_TRUE(touchesPlanes || touches <= 0) << depth;
        touching += touches > 0 ? 1 : 0;
        falseByPlanes += touches < 0 && touchesPlanes ? 1 : 0;
        // What lies inside does so with every corner.
        const auto small = cubesIn<TypeParam>(-12, 12, random.logBetween(0.01, 3))(random);
        double least = std::numeric_limits<double>::infinity();
        for (const OraclePlane& plane : oracle) {
            for (unsigned corner = 0; corner < 8; ++corner) {
                const auto type = static_cast<typename Aabb<TypeParam>::CornerType>(corner);
                const Vector3<double> at = small.corner(type).template cast<double>();
                least = std::min(least, plane.signedDistance(at));
            }
        }
        const bool isIn = this->has(this->volumeOf(planes, Containment::inside), small);
        EXPECT_TRUE(isIn == (least > 0) || std::abs(least) <= kRounding) << least;
        inside += least > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 800);
    EXPECT_GT(falseByPlanes, 50);
    EXPECT_GT(inside, 300);
}

// Prisms, wedges and slabs that go on for ever, and some that have no point.
TYPED_TEST(ConvexQuery, FindsExactlyTheBoxesThatShareAPointWithAVolumeWithoutACorner) {
    using Plane = typename ConvexRegion<TypeParam>::Plane;
    constexpr double kRounding = sizeof(TypeParam) == sizeof(float) ? 1e-3 : 1e-7;
    Random random(0x5eed0605);
    std::array<int, 3> answers{};
    int empty = 0;
    for (int i = 0; i < 10000; ++i) {
        SCOPED_TRACE(i);
        // Across an axis, or across a line that is none but for rounding.
        const int axis = random.axis();
        std::vector<Plane> planes;
        const std::uint32_t count = 1 + random.below(4);
        for (std::uint32_t k = 0; k < count; ++k) {
            Vector3<double> normal = random.pointIn(-1, 1);
            normal[axis] = 0;
            planes.emplace_back(normal.normalized().template cast<TypeParam>(),
                                static_cast<TypeParam>(random.between(-1, 4)));
        }
        const ConvexRegion<TypeParam> region(planes);
        const auto box = cubesIn<TypeParam>(-20, 20, random.logBetween(0.01, 10))(random);
        const double depth =
            depthInVolume(oraclePlanes<TypeParam>(planes), box.template cast<double>());
        ++answers.at(static_cast<std::size_t>(1 + expectLikeOracle(region, box, depth, kRounding)));
        empty += region.isEmpty() ? 1 : 0;
    }
    EXPECT_GT(answers[0], 500) << "apart";
    EXPECT_GT(answers[2], 500) << "touching";
    EXPECT_GT(empty, 100);
}

TYPED_TEST(ConvexQuery, IsClosed) {
    using Plane = typename ConvexRegion<TypeParam>::Plane;
    const Vector3<TypeParam> up = Vector3<TypeParam>::UnitY();
    const auto slab = this->volumeOf({Plane(up, TypeParam(-1)), Plane(-up, TypeParam(2))});
    EXPECT_TRUE(this->has(slab, makeBox<TypeParam>(0, 0, 0, 1, 1, 1)));  // from below
    EXPECT_TRUE(this->has(slab, makeBox<TypeParam>(0, 2, 0, 1, 9, 1)));  // from above
    EXPECT_FALSE(this->has(slab, makeBox<TypeParam>(0, 0, 0, 1, 0.99, 1)));
    const auto within =
        this->volumeOf({Plane(up, TypeParam(-1)), Plane(-up, TypeParam(2))}, Containment::inside);
    EXPECT_TRUE(this->has(within, makeBox<TypeParam>(0, 1, 0, 1, 2, 1)));
    EXPECT_FALSE(this->has(within, makeBox<TypeParam>(0, 1, 0, 1, 2.01, 1)));
}

TYPED_TEST(ConvexQuery, HasAnAnswerForEveryPlane) {
    using Plane = typename ConvexRegion<TypeParam>::Plane;
    using Point = Vector3<TypeParam>;
    constexpr auto infinity = std::numeric_limits<TypeParam>::infinity();
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    // The sum of the terms leaves the range of numbers unless normals are made shorter.
    constexpr auto large = std::numeric_limits<TypeParam>::max() / 4;
    const Point zero = Point::Zero();
    const Point up = Point::UnitY();
    const auto unit = makeBox<TypeParam>(0, 0, 0, 1, 1, 1);
    EXPECT_TRUE(this->has(this->volumeOf({}), unit));
    for (const Plane& plane : {Plane(zero, TypeParam(1)), Plane(zero, TypeParam(0)),
                               Plane(up, infinity), Plane(up * large, TypeParam(0))}) {
        EXPECT_TRUE(this->has(this->volumeOf({plane}), unit)) << plane.coeffs().transpose();
    }
    for (const Plane& plane : {Plane(zero, TypeParam(-1)), Plane(up, -infinity), Plane(up, nan),
                               Plane(up * nan, TypeParam(1)), Plane(up * infinity, TypeParam(1)),
                               Plane(up * large, -large * 2)}) {
        EXPECT_FALSE(this->has(this->volumeOf({plane}), unit)) << plane.coeffs().transpose();
    }
    // A volume without a point, though no single plane has the box outside.
    const auto nothing = this->volumeOf(
        {Plane(Point(1, 0, 0), TypeParam(-0.6)), Plane(Point(-1, 0, 0), TypeParam(0.4)),
         Plane(up, TypeParam(0)), Plane(Point(0, 0, 1), TypeParam(0))});
    EXPECT_TRUE(nothing.isEmpty());
    EXPECT_FALSE(this->has(nothing, unit));
    const auto left = Plane(Point(-1, 0, 0), TypeParam(0));
    const auto right = Plane(Point(1, 0, 0), TypeParam(-1));
    EXPECT_TRUE(this->volumeOf({left, right}).isEmpty());
    EXPECT_TRUE(this->volumeOf({Plane(zero, TypeParam(-1))}).isEmpty());
    EXPECT_FALSE(this->volumeOf({}).isEmpty());
    EXPECT_FALSE(this->volumeOf({left}).isEmpty());
}

TYPED_TEST(ConvexQuery, HasAnAnswerForEveryBox) {
    using Plane = typename ConvexRegion<TypeParam>::Plane;
    constexpr auto infinity = std::numeric_limits<TypeParam>::infinity();
    const auto right = Plane(Vector3<TypeParam>::UnitX(), TypeParam(0));
    const auto left = Plane(-Vector3<TypeParam>::UnitX(), TypeParam(1));
    const Aabb<TypeParam> all(Vector3<TypeParam>::Constant(-infinity),
                              Vector3<TypeParam>::Constant(infinity));
    Aabb<TypeParam> nan = all;
    nan.max().y() = std::numeric_limits<TypeParam>::quiet_NaN();
    Aabb<TypeParam> halfSpace = all;
    halfSpace.max().x() = TypeParam(-1);
    for (const Touch touch : {Touch::exact, Touch::byPlanes}) {
        const auto slab = this->volumeOf({right, left}, Containment::touching, touch);
        EXPECT_TRUE(this->has(slab, all));
        EXPECT_FALSE(this->has(slab, nan));
        EXPECT_FALSE(this->has(slab, halfSpace));
    }
    EXPECT_FALSE(this->has(this->volumeOf({right, left}, Containment::inside), all));
    EXPECT_TRUE(this->has(this->volumeOf({}, Containment::inside), all));
}

TEST(FrustumRegion, IsThatOfTheWholeScreenUnlessARectangleIsGiven) {
    const Eigen::Matrix4f cube = Eigen::Matrix4f::Identity();  // what is seen is from -1 to 1
    const auto crossing = boxBetween<float>({0.5F, -0.5F, -0.5F}, {1.5F, 0.5F, 0.5F});
    const auto depths = DepthRange::minusOneToOne;
    EXPECT_GE(frustumRegion(cube, depths, Containment::touching).key(crossing), 0);
    EXPECT_LT(frustumRegion(cube, depths, Containment::inside).key(crossing), 0);
    EXPECT_GE(frustumRegion(cube, depths, Containment::inside)
                  .key(boxBetween<float>({-1, -1, -1}, {1, 1, 1})),
              0);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(ConvexQueryDeathTest, AConvexRegionHasAtMost16Planes) {
    const std::vector<ConvexRegion<float>::Plane> planes(
        17, ConvexRegion<float>::Plane(Vector3<float>::UnitX(), 0.0F));
    EXPECT_DEATH_IF_SUPPORTED(ConvexRegion<float>{planes}, "Pass at most 16 planes");
}
#endif

// --- In a grid -----------------------------------------------------------------------------------

// Large enough that layers, rows and cells are clipped, and cells taken without a test.
TYPED_TEST(ConvexQuery, OfAFrustumIsThatOfBruteForceInLargeScenes) {
    using Corner = Vector3<double>;
    const std::function<Aabb<TypeParam>(Random&)> scenes[] = {
        boxesIn<TypeParam>(-30, 30, 0.1, 0.9),
        cubesIn<TypeParam>(Corner(-90, 0, -90), Corner(90, 6, 90), 1),  // ground
        cubesIn<TypeParam>(Corner(0, -80, -80), Corner(1, 80, 80), 1),  // a wall
        [](Random& random) {
            return cubesIn<TypeParam>(-40, 40, random.logBetween(0.05, 10))(random);
        }};
    std::uint64_t taken = 0;
    std::uint64_t rows = 0;
    for (const auto& draw : scenes) {
        for (const double cellSize : {0.0, 0.4, 40.0}) {
            SCOPED_TRACE(testing::Message() << "cell size " << cellSize);
            Population<TypeParam> world(GridConfig{.cellSize = cellSize});
            world.addMany(12000, draw, 2);
            for (int frame = 0; frame < 6; ++frame) {
                for (int camera = 0; camera < 8; ++camera) {
                    const auto region = frustumRegion<TypeParam>(
                        randomCamera<TypeParam>(world.random, Corner::Zero(), 60),
                        DepthRange::zeroToOne, wholeScreen<TypeParam>(),
                        camera % 4 == 3 ? Containment::inside : Containment::touching,
                        camera % 2 == 0 ? Touch::exact : Touch::byPlanes);
                    CollectKeys<TypeParam> expected;
                    visitByBruteForce<TypeParam>(world.proxies, region, expected);
                    CollectKeys<TypeParam> found;
                    const QueryCost cost = world.grid.visit(region, found);
                    ASSERT_EQ(differences(found.sorted(), expected.sorted()), "");
                    taken += cost.hits - std::min(cost.hits, cost.boxesTested);
                    rows += cost.rowsVisited;
                }
                // Some move, of those at rest as well, and are listed, filed, or both.
                for (int i = 0; i < (frame % 2 == 0 ? 40 : 3000); ++i) {
                    world.moveTo(world.any(), draw(world.random));
                }
                if (frame % 3 != 0) {
                    world.update();
                }
            }
        }
    }
    EXPECT_GT(taken, 20000U);
    EXPECT_GT(rows, 20000U);
}

}  // namespace
}  // namespace hashphase::test
