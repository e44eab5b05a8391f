// SPDX-License-Identifier: Zlib

#include <broadphase/convex_region.hpp>
#include <integration/camera/frustum.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/convex_oracle.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <array>
#include <bit>
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

// Of frusta, wedges and prisms of every shape; boxes from tiny to larger than the volume.
TYPED_TEST(ConvexQuery, FindsExactlyTheBoxesThatShareAPointWithTheVolume) {
    Random random(0x5eed0601);
    int touching = 0;
    int falseByPlanes = 0;
    for (int i = 0; i < 10000; ++i) {
        SCOPED_TRACE(i);
        const auto planes = frustumPlanes<TypeParam>(
            randomCamera<TypeParam>(random, Vector3<double>::Zero(), 10), DepthRange::zeroToOne);
        const ConvexRegion<TypeParam> exact(planes);
        const ConvexRegion<TypeParam> byPlanes(planes, Containment::touching, Touch::byPlanes);
        const auto box = boxAround<TypeParam>(
            random.pointIn(-30, 30), Vector3<double>::Constant(random.logBetween(0.01, 30)));
        const std::vector<OraclePlane> volume = oraclePlanes<TypeParam>(planes);
        const double depth = depthInVolume(volume, box.template cast<double>());
        // Closer than rounding can tell, both answers are right.
        constexpr double nearly = sizeof(TypeParam) == sizeof(float) ? 1e-4 : 1e-9;
        if (depth > -1e-12) {
            EXPECT_TRUE(this->has(exact, box)) << depth;
            EXPECT_TRUE(this->has(byPlanes, box)) << depth;
        } else if (depth < -nearly) {
            EXPECT_FALSE(this->has(exact, box)) << depth;
            falseByPlanes += this->has(byPlanes, box) ? 1 : 0;
        }
        touching += depth > -1e-12 ? 1 : 0;
    }
    EXPECT_GT(touching, 800);
    EXPECT_GT(falseByPlanes, 50);
}

// Prisms, wedges and slabs that go on for ever, and some that have no point.
TYPED_TEST(ConvexQuery, FindsExactlyTheBoxesThatShareAPointWithAVolumeWithoutACorner) {
    using Plane = typename ConvexRegion<TypeParam>::Plane;
    Random random(0x5eed0605);
    int touching = 0;
    int apart = 0;
    int empty = 0;
    for (int i = 0; i < 10000; ++i) {
        SCOPED_TRACE(i);
        // Across an axis, or across a line that is none but for rounding.
        const int axis = static_cast<int>(random.below(3));
        std::vector<Plane> planes;
        const std::uint32_t count = 1 + random.below(4);
        for (std::uint32_t k = 0; k < count; ++k) {
            Vector3<double> normal = random.pointIn(-1, 1);
            normal[axis] = 0;
            planes.emplace_back(normal.normalized().template cast<TypeParam>(),
                                static_cast<TypeParam>(random.between(-1, 4)));
        }
        const ConvexRegion<TypeParam> region(planes);
        const auto box = boxAround<TypeParam>(
            random.pointIn(-20, 20), Vector3<double>::Constant(random.logBetween(0.01, 10)));
        const double depth =
            depthInVolume(oraclePlanes<TypeParam>(planes), box.template cast<double>());
        constexpr double nearly = sizeof(TypeParam) == sizeof(float) ? 1e-3 : 1e-7;
        if (depth > -1e-12) {
            EXPECT_TRUE(this->has(region, box)) << depth;
            ++touching;
        } else if (depth < -nearly) {
            EXPECT_FALSE(this->has(region, box)) << depth;
            ++apart;
        }
        empty += region.isEmpty() ? 1 : 0;
    }
    EXPECT_GT(touching, 500);
    EXPECT_GT(apart, 500);
    EXPECT_GT(empty, 100);
}

TYPED_TEST(ConvexQuery, OfWhatLiesInsideAsksForEveryCorner) {
    Random random(0x5eed0602);
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto planes = frustumPlanes<TypeParam>(
            randomCamera<TypeParam>(random, Vector3<double>::Zero(), 10), DepthRange::zeroToOne);
        const ConvexRegion<TypeParam> region(planes, Containment::inside);
        const auto box = boxAround<TypeParam>(
            random.pointIn(-12, 12), Vector3<double>::Constant(random.logBetween(0.01, 3)));
        double least = std::numeric_limits<double>::infinity();
        for (const OraclePlane& plane : oraclePlanes<TypeParam>(planes)) {
            for (unsigned corner = 0; corner < 8; ++corner) {
                const auto type = static_cast<typename Aabb<TypeParam>::CornerType>(corner);
                least =
                    std::min(least, plane.signedDistance(box.corner(type).template cast<double>()));
            }
        }
        constexpr double nearly = sizeof(TypeParam) == sizeof(float) ? 1e-4 : 1e-9;
        if (std::abs(least) > nearly) {
            EXPECT_EQ(this->has(region, box), least > 0) << i;
        }
        inside += least > 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 300);
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
    constexpr auto infinity = std::numeric_limits<TypeParam>::infinity();
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    const Vector3<TypeParam> zero = Vector3<TypeParam>::Zero();
    const Vector3<TypeParam> up = Vector3<TypeParam>::UnitY();
    const auto unit = makeBox<TypeParam>(0, 0, 0, 1, 1, 1);
    EXPECT_TRUE(this->has(this->volumeOf({}), unit));
    EXPECT_TRUE(this->has(this->volumeOf({Plane(zero, TypeParam(1))}), unit));
    EXPECT_TRUE(this->has(this->volumeOf({Plane(zero, TypeParam(0))}), unit));
    EXPECT_FALSE(this->has(this->volumeOf({Plane(zero, TypeParam(-1))}), unit));
    EXPECT_TRUE(this->has(this->volumeOf({Plane(up, infinity)}), unit));
    EXPECT_FALSE(this->has(this->volumeOf({Plane(up, -infinity)}), unit));
    EXPECT_FALSE(this->has(this->volumeOf({Plane(up, nan)}), unit));
    EXPECT_FALSE(this->has(this->volumeOf({Plane(up * nan, TypeParam(1))}), unit));
    EXPECT_FALSE(this->has(this->volumeOf({Plane(up * infinity, TypeParam(1))}), unit));
    // A volume without a point, though no single plane has the box outside.
    const std::vector<Plane> nothing{Plane(Vector3<TypeParam>(1, 0, 0), TypeParam(-0.6)),
                                     Plane(Vector3<TypeParam>(-1, 0, 0), TypeParam(0.4)),
                                     Plane(up, TypeParam(0)),
                                     Plane(Vector3<TypeParam>(0, 0, 1), TypeParam(0))};
    EXPECT_TRUE(this->volumeOf(nothing).isEmpty());
    EXPECT_FALSE(this->has(this->volumeOf(nothing), unit));
    const auto left = Plane(Vector3<TypeParam>(-1, 0, 0), TypeParam(0));
    const auto right = Plane(Vector3<TypeParam>(1, 0, 0), TypeParam(-1));
    EXPECT_TRUE(this->volumeOf({left, right}).isEmpty());
    EXPECT_TRUE(this->volumeOf({Plane(zero, TypeParam(-1))}).isEmpty());
    EXPECT_FALSE(this->volumeOf({}).isEmpty());
    EXPECT_FALSE(this->volumeOf({left}).isEmpty());
    // The sum of the terms leaves the range of numbers unless normals are made shorter.
    const auto large = static_cast<TypeParam>(std::numeric_limits<TypeParam>::max() / 4);
    EXPECT_TRUE(this->has(this->volumeOf({Plane(up * large, TypeParam(0))}), unit));
    EXPECT_FALSE(this->has(this->volumeOf({Plane(up * large, -large * 2)}), unit));
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
    EXPECT_DEATH(ConvexRegion<float>{planes}, "at most 16 planes");
}
#endif

// --- In a grid -----------------------------------------------------------------------------------

// Large enough that layers, rows and cells are clipped, and cells taken without a test.
template <class Scalar>
std::vector<BoxScene<Scalar>> largeScenes() {
    BoxScene<Scalar> space = spreadScene<Scalar>("space", 1, 0);
    space.draw = [](Random& random) {
        return boxAround<Scalar>(random.pointIn(-30, 30), random.pointIn(0.1, 0.9));
    };
    BoxScene<Scalar> ground = spreadScene<Scalar>("ground", 1, 0);
    ground.draw = [](Random& random) {
        return boxAround<Scalar>(random.pointIn({-90, 0, -90}, {90, 6, 90}), {1, 1, 1});
    };
    BoxScene<Scalar> wall = spreadScene<Scalar>("wall", 1, 0);
    wall.draw = [](Random& random) {
        return boxAround<Scalar>(random.pointIn({0, -80, -80}, {1, 80, 80}), {1, 1, 1});
    };
    BoxScene<Scalar> sizes = spreadScene<Scalar>("sizes", 1, 0);
    sizes.draw = [](Random& random) {
        const double half = random.logBetween(0.05, 10);
        return boxAround<Scalar>(random.pointIn(-40, 40), Vector3<double>::Constant(half));
    };
    return {space, ground, wall, sizes};
}

TYPED_TEST(ConvexQuery, OfAFrustumIsThatOfBruteForceInLargeScenes) {
    std::uint64_t taken = 0;
    std::uint64_t rows = 0;
    for (const BoxScene<TypeParam>& scene : largeScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 0.4, 40.0}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            Random random(0x5eed0603);
            GridConfig config;
            config.cellSize = cellSize;
            Grid<TypeParam> grid(config);
            std::vector<Placed<TypeParam>> proxies;
            for (int i = 0; i < 12000; ++i) {
                const Aabb<TypeParam> box = scene.draw(random);
                const auto mobility = i % 2 == 0 ? Mobility::mobile : Mobility::resting;
                proxies.push_back({grid.add(box, mobility), box});
            }
            for (int frame = 0; frame < 6; ++frame) {
                for (int camera = 0; camera < 8; ++camera) {
                    const auto region = frustumRegion<TypeParam>(
                        randomCamera<TypeParam>(random, Vector3<double>::Zero(), 60),
                        DepthRange::zeroToOne, wholeScreen<TypeParam>(),
                        camera % 4 == 3 ? Containment::inside : Containment::touching,
                        camera % 2 == 0 ? Touch::exact : Touch::byPlanes);
                    CollectKeys<TypeParam> expected;
                    visitByBruteForce<TypeParam>(proxies, region, expected);
                    CollectKeys<TypeParam> found;
                    const QueryCost cost = grid.visit(region, found);
                    ASSERT_EQ(differences(found.sorted(), expected.sorted()), "");
                    taken += cost.hits - std::min(cost.hits, cost.boxesTested);
                    rows += cost.rowsVisited;
                }
                // Some move, of those at rest as well, and are listed, filed, or both.
                for (int i = 0; i < (frame % 2 == 0 ? 40 : 3000); ++i) {
                    auto& proxy = proxies[random.below(12000)];
                    proxy.box = scene.draw(random);
                    grid.move(proxy.id, proxy.box);
                }
                if (frame % 3 != 0) {
                    grid.update();
                }
            }
        }
    }
    EXPECT_GT(taken, 20000U);
    EXPECT_GT(rows, 20000U);
}

}  // namespace
}  // namespace hashphase::test
