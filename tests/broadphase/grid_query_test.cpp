// SPDX-License-Identifier: Zlib

// What queries find: the same as looking at everything, in every scene, at any moment of a frame.

#include <broadphase/cells_region.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/proxy_filter.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/population.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class GridQuery : public testing::Test {
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GridQuery, Scalars);

// By distance from position to position, and in the cells around.
template <class Scalar>
std::size_t expectPositionsLikeBruteForce(const Grid<Scalar>& grid, const Script<Scalar>& script,
                                          Random& random) {
    RegionMaker<Scalar> make(random, script.proxies());
    const Vector3<Scalar> center = make.point();
    const Scalar size = (make.point() - make.point()).cwiseAbs().maxCoeff();
    const Scalar radius = random.chance(0.05)  ? hostileNumber<Scalar>(random)
                          : random.chance(0.1) ? Scalar(0)
                                               : size * Scalar(random.logBetween(0.05, 2));
    const PositionRegion<Scalar> ball(center, radius);
    const CellsRegion<Scalar> cells(center, radius, grid.cellSize());
    expectLikeBruteForce(grid, script.proxies(), cells);
    for (const auto& [id, key] : find(grid, ball)) {
        EXPECT_EQ(cells.key(grid.box(id)), 0) << "the estimate never misses";
    }
    return expectLikeBruteForce(grid, script.proxies(), ball);
}

TYPED_TEST(GridQuery, FindsWhatBruteForceFindsInEveryScene) {
    std::size_t found = 0;
    std::size_t within = 0;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 1.5, 1e-3, 1e4}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            GridWorld<TypeParam> world({.cellSize = cellSize});
            Script<TypeParam> script(scene, 0x5eed0501);
            Random& random = script.random();
            script.begin(world);
            for (int frame = 0; frame < 16; ++frame) {
                SCOPED_TRACE(testing::Message() << "frame " << frame);
                // Right after the changes, which wait in a list, are filed, or are both; and updated.
                for (int times = 0; times < (frame % 3 != 1 ? 2 : 1); ++times) {
                    found += expectQueriesLikeBruteForce(world.grid, script.proxies(), random, 3);
                    for (int i = 0; i < 3; ++i) {
                        within += expectPositionsLikeBruteForce(world.grid, script, random);
                    }
                    if (frame % 3 != 1) {
                        world.grid.update();
                    }
                }
                ASSERT_EQ(world.grid.validate(), "");
                ASSERT_FALSE(this->HasFailure());
                script.playFrame(world);
            }
        }
    }
    EXPECT_GT(found, 20000U);
    EXPECT_GT(within, 20000U);
}

TYPED_TEST(GridQuery, OfAnEmptyGridFindsNothing) {
    const Grid<TypeParam> grid;
    const Vector3<TypeParam> zero = Vector3<TypeParam>::Zero();
    const Vector3<TypeParam> one = Vector3<TypeParam>::Ones();
    EXPECT_TRUE(find(grid, BoxRegion<TypeParam>{{zero, one}}).empty());
    EXPECT_TRUE(find(grid, SphereRegion<TypeParam>{zero, 1}).empty());
    EXPECT_TRUE(find(grid, RayRegion<TypeParam>(zero, one)).empty());
    EXPECT_TRUE(find(grid, ConvexRegion<TypeParam>({})).empty());
    EXPECT_EQ(grid.cellSize(), 1);
}

// --- Spheres -------------------------------------------------------------------------------------

TYPED_TEST(GridQuery, ASphereIsAClosedBall) {
    using Limits = std::numeric_limits<TypeParam>;
    // 4 x 4 x 4 unit boxes that touch, with a corner at the origin.
    Population<TypeParam> block;
    for (int i = 0; i < 64; ++i) {
        const double x = i % 4;
        const double y = i / 4 % 4;
        const double z = i / 16;
        block.add(makeBox<TypeParam>(x, y, z, x + 1, y + 1, z + 1));
    }
    block.update();
    const auto countWithin = [&block](double x, TypeParam radius) {
        const Vector3<TypeParam> center(static_cast<TypeParam>(x), TypeParam(0.5), TypeParam(0.5));
        return block.expectLikeBruteForce(SphereRegion<TypeParam>{center, radius});
    };
    EXPECT_EQ(countWithin(0.5, 0), 1U);  // a point inside
    EXPECT_EQ(countWithin(1, 0), 2U);    // a point on a face
    EXPECT_EQ(countWithin(-1, 1), 1U);   // touches
    EXPECT_EQ(countWithin(-1, std::nextafter(TypeParam(1), TypeParam(0))), 0U);
    EXPECT_EQ(countWithin(0.5, -1), 0U);
    EXPECT_EQ(countWithin(0.5, -TypeParam(0)), 1U);
    for (const TypeParam large : {Limits::infinity(), Limits::max(), TypeParam(1e30)}) {
        EXPECT_EQ(countWithin(0.5, large), 64U);
    }
    EXPECT_EQ(countWithin(0.5, Limits::quiet_NaN()), 0U);
    EXPECT_EQ(countWithin(std::numeric_limits<double>::quiet_NaN(), 9), 0U);
    EXPECT_EQ(countWithin(1e6, 1), 0U);
}

TYPED_TEST(GridQuery, OfASphereIsTheSameAtEveryScale) {
    // Scaled by powers of two nothing is rounded, though squares of lengths leave the range of
    // numbers.
    const int extreme = sizeof(TypeParam) == sizeof(float) ? 100 : 900;
    std::vector<ProxyId> expected;
    for (const int exponent : {0, -extreme, -extreme / 2, extreme / 2, extreme}) {
        SCOPED_TRACE(testing::Message() << "scaled by 2^" << exponent);
        const auto scale = std::ldexp(TypeParam(1), exponent);
        Population<TypeParam> world;
        world.addMany(300, [&](Random& random) {
            const auto box = boxesIn<TypeParam>(-7, 7, 0.5, 1)(random);
            return Aabb<TypeParam>(box.min() * scale, box.max() * scale);
        });
        world.update();
        std::vector<ProxyId> found;
        for (int i = 0; i < 20; ++i) {
            const Vector3<TypeParam> center =
                world.random.pointIn(-7, 7).template cast<TypeParam>() * scale;
            const auto radius = static_cast<TypeParam>(world.random.between(0.1, 3)) * scale;
            const SphereRegion<TypeParam> sphere{center, radius};
            world.expectLikeBruteForce(sphere);
            for (const auto& [id, key] : find(world.grid, sphere)) {
                found.push_back(id);
            }
        }
        expected = exponent == 0 ? found : expected;
        ASSERT_EQ(differences(found, expected), "");
    }
}

// --- Collectors ----------------------------------------------------------------------------------

TYPED_TEST(GridQuery, ClosestPrefersTheSmallestIdAmongEquals) {
    Population<TypeParam> world;
    world.addMany(100, [](Random&) { return makeBox<TypeParam>(5, 0, 0, 6, 1, 1); });
    for (int times = 0; times < 2; ++times) {
        CollectClosest<TypeParam> closest;
        world.grid.visit(SphereRegion<TypeParam>{{0, 0, 0}, 10}, closest);
        EXPECT_EQ(closest.found(), world.proxies.front().id);
        EXPECT_EQ(closest.key(), 25);
        world.update();
    }
}

TYPED_TEST(GridQuery, EndsAsSoonAsTheCollectorHasEnough) {
    Population<TypeParam> world;
    world.addMany(5000, cubesIn<TypeParam>(0, 10, 0.5));
    world.update();
    const std::vector<BoxRegion<TypeParam>> regions(3, {makeBox<TypeParam>(0, 0, 0, 9, 9, 9)});
    CollectAny any;
    EXPECT_EQ(world.grid.visit(regions[0], any).hits, 1U);
    EXPECT_FALSE(any.found().isNull());
    std::vector<CollectAny> each(3);
    EXPECT_EQ(world.grid.visitEach(std::span(regions), std::span(each)).hits, 3U);
    EXPECT_FALSE(each[2].found().isNull());
}

TYPED_TEST(GridQuery, OfWhatAFilterAcceptsGoesOnBehindThoseThatAreRefused) {
    Population<TypeParam> world;
    world.addMany(500, cubesIn<TypeParam>(0, 10, 0.25));
    world.update();
    const SphereRegion<TypeParam> ball{Vector3<TypeParam>(5, 5, 5), 4};
    const auto isEven = [](ProxyId id) { return id.index % 2 == 0; };
    std::vector<ProxyId> found;
    CollectAll all(found);
    CollectIf even(all, isEven);
    EXPECT_EQ(world.grid.visit(ball, even).hits, find(world.grid, ball).size());
    EXPECT_TRUE(std::all_of(found.begin(), found.end(), isEven));
    const ProxyId wanted = *std::max_element(found.begin(), found.end());
    CollectAny any;
    const auto isWanted = [wanted](ProxyId id) { return id == wanted; };
    CollectIf only(any, isWanted);
    world.grid.visit(ball, only);
    EXPECT_EQ(any.found(), wanted);
    // And a filter that was made in passing is kept.
    CollectCount count;
    CollectIf none(count, [refused = std::vector<int>(9, 1)](ProxyId id) {
        return refused[id.index % refused.size()] == 0;
    });
    EXPECT_GT(world.grid.visit(ball, none).hits, 20U);
    EXPECT_EQ(count.count(), 0U);
}

// --- Cells ---------------------------------------------------------------------------------------

TYPED_TEST(GridQuery, OfAPointsCellIsTheFloorOfItsCoordinates) {
    const Grid<TypeParam> grid({.cellSize = 0.5});
    using Cell = std::array<std::int64_t, 3>;
    EXPECT_EQ(grid.cellSize(), TypeParam(0.5));
    EXPECT_EQ(grid.cellAt({TypeParam(0.75), TypeParam(-0.25), TypeParam(1)}), (Cell{1, -1, 2}));
    EXPECT_EQ(grid.cellAt({0, -TypeParam(0), TypeParam(-0.5)}), (Cell{0, 0, -1}));
    // Beyond all cells is the last one.
    const auto far = grid.cellAt({std::numeric_limits<TypeParam>::max(), TypeParam(-3e30), 0});
    EXPECT_GT(far[0], 1'000'000'000'000'000'000);
    EXPECT_LT(far[1], -1'000'000'000'000'000'000);
}

TYPED_TEST(GridQuery, OfCellsGoesByTheFinestCellsInUse) {
    Population<TypeParam> world;
    world.addMany(2000, cubesIn<TypeParam>(0, 20, 0.05), 1);
    world.addMany(200, cubesIn<TypeParam>(0, 100, 4));
    for (int frame = 0; frame < 5; ++frame) {
        world.moveTo(2199, shifted(world.random, world.proxies[2199].box, 1));
        world.update();
        EXPECT_LT(world.grid.cellSize(), 4);
    }
}

}  // namespace
}  // namespace hashphase::test
