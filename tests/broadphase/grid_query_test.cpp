// SPDX-License-Identifier: Zlib

// What queries find: the same as looking at everything, in every scene, at any moment of a frame.

#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class GridQuery : public testing::Test {
protected:
    void expectLikeBruteForceAround(const Grid<Scalar>& grid,
                                    std::span<const Placed<Scalar>> proxies, Random& random,
                                    int count) {
        RegionMaker<Scalar> make(random, proxies);
        for (int i = 0; i < count && !this->HasFailure(); ++i) {
            found_ += expectLikeBruteForce(grid, proxies, make.box());
            found_ += expectLikeBruteForce(grid, proxies, make.sphere());
            found_ += expectLikeBruteForce(grid, proxies, make.ray());
            found_ += expectLikeBruteForce(grid, proxies, make.ray(true));
            found_ += expectLikeBruteForce(grid, proxies, make.convex());
        }
    }

    std::size_t found_ = 0;

private:
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GridQuery, Scalars);

TYPED_TEST(GridQuery, FindsWhatBruteForceFindsInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 1.5, 1e-3, 1e4}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            GridConfig config;
            config.cellSize = cellSize;
            GridWorld<TypeParam> world(config);
            Script<TypeParam> script(scene, 0x5eed0501);
            script.begin(world);
            for (int frame = 0; frame < 16; ++frame) {
                SCOPED_TRACE(testing::Message() << "frame " << frame);
                // Right after the changes, which wait in a list, are filed, or are both.
                this->expectLikeBruteForceAround(world.grid, script.proxies(), script.random(), 3);
                if (frame % 3 != 1) {
                    world.grid.update();
                    this->expectLikeBruteForceAround(world.grid, script.proxies(), script.random(),
                                                     3);
                }
                ASSERT_EQ(world.grid.validate(), "");
                ASSERT_FALSE(this->HasFailure());
                script.playFrame(world);
            }
        }
    }
    EXPECT_GT(this->found_, 20000U);
}

TYPED_TEST(GridQuery, SeesEachChangeAtOnce) {
    const BoxScene<TypeParam> scene = spreadScene<TypeParam>("evenly spread", 1, 0);
    GridWorld<TypeParam> world;
    ScriptRates rates;
    rates.nudge = 0.01;  // a handful a frame, never enough to be filed early
    Script<TypeParam> script(scene, 0x5eed0502, rates);
    script.begin(world);
    world.grid.update();
    for (int frame = 0; frame < 100; ++frame) {
        script.playFrame(world);
        this->expectLikeBruteForceAround(world.grid, script.proxies(), script.random(), 4);
        ASSERT_FALSE(this->HasFailure());
    }
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

/// 4 x 4 x 4 unit boxes that touch, with a corner at the origin.
template <class Scalar>
std::vector<Placed<Scalar>> addBlock(Grid<Scalar>& grid) {
    std::vector<Placed<Scalar>> proxies;
    for (int i = 0; i < 64; ++i) {
        const Vector3<Scalar> low(static_cast<Scalar>(i % 4), static_cast<Scalar>(i / 4 % 4),
                                  static_cast<Scalar>(i / 16));
        const Aabb<Scalar> box(low, low + Vector3<Scalar>::Ones());
        proxies.push_back({grid.add(box), box});
    }
    grid.update();
    return proxies;
}

TYPED_TEST(GridQuery, ASphereIsAClosedBall) {
    Grid<TypeParam> grid;
    const auto proxies = addBlock(grid);
    const auto countWithin = [&grid](double x, TypeParam radius) {
        const Vector3<TypeParam> center(static_cast<TypeParam>(x), TypeParam(0.5), TypeParam(0.5));
        return find(grid, SphereRegion<TypeParam>{center, radius}).size();
    };
    EXPECT_EQ(countWithin(0.5, 0), 1U);  // a point inside
    EXPECT_EQ(countWithin(1, 0), 2U);    // a point on a face
    EXPECT_EQ(countWithin(-1, 1), 1U);   // touches
    EXPECT_EQ(countWithin(-1, std::nextafter(TypeParam(1), TypeParam(0))), 0U);
    EXPECT_EQ(countWithin(0.5, -1), 0U);
    EXPECT_EQ(countWithin(0.5, -TypeParam(0)), 1U);
    EXPECT_EQ(countWithin(0.5, std::numeric_limits<TypeParam>::infinity()), 64U);
    EXPECT_EQ(countWithin(0.5, std::numeric_limits<TypeParam>::max()), 64U);
    EXPECT_EQ(countWithin(0.5, TypeParam(1e30)), 64U);
    EXPECT_EQ(countWithin(0.5, std::numeric_limits<TypeParam>::quiet_NaN()), 0U);
    EXPECT_EQ(countWithin(std::numeric_limits<double>::quiet_NaN(), 9), 0U);
    EXPECT_EQ(countWithin(1e6, 1), 0U);
}

TYPED_TEST(GridQuery, OfASphereIsTheSameAtEveryScale) {
    // Scaled by powers of two nothing is rounded, though squares of lengths leave the range of
    // numbers.
    const int extreme = sizeof(TypeParam) == sizeof(float) ? 100 : 900;
    std::vector<std::vector<ProxyId>> answers;
    for (const int exponent : {0, -extreme, -extreme / 2, extreme / 2, extreme}) {
        SCOPED_TRACE(testing::Message() << "scaled by 2^" << exponent);
        const auto scale = std::ldexp(TypeParam(1), exponent);
        Random random(0x5eed0503);
        const BoxScene<TypeParam> scene = spreadScene<TypeParam>("evenly spread", 1, 0);
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies;
        for (int i = 0; i < 300; ++i) {
            const Aabb<TypeParam> box = scene.draw(random);
            const Aabb<TypeParam> scaled(box.min() * scale, box.max() * scale);
            proxies.push_back({grid.add(scaled), scaled});
        }
        grid.update();
        std::vector<ProxyId> found;
        for (int i = 0; i < 20; ++i) {
            const Vector3<TypeParam> center = random.pointIn(-7, 7).cast<TypeParam>() * scale;
            const auto radius = static_cast<TypeParam>(random.between(0.1, 3)) * scale;
            const SphereRegion<TypeParam> sphere{center, radius};
            expectLikeBruteForce<TypeParam>(grid, proxies, sphere);
            for (const auto& [id, key] : find(grid, sphere)) {
                found.push_back(id);
            }
            if (this->HasFailure()) {
                break;
            }
        }
        answers.push_back(found);
        ASSERT_EQ(differences(answers.back(), answers.front()), "");
    }
}

// --- Collectors ----------------------------------------------------------------------------------

TYPED_TEST(GridQuery, ClosestPrefersTheSmallestIdAmongEquals) {
    Grid<TypeParam> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        ids.push_back(grid.add(makeBox<TypeParam>(5, 0, 0, 6, 1, 1)));
    }
    for (const bool updated : {false, true}) {
        CollectClosest<TypeParam> closest;
        grid.visit(SphereRegion<TypeParam>{{0, 0, 0}, 10}, closest);
        EXPECT_EQ(closest.found(), ids.front());
        EXPECT_EQ(closest.key(), 25);
        if (!updated) {
            grid.update();
        }
    }
}

TYPED_TEST(GridQuery, EndsAsSoonAsTheCollectorHasEnough) {
    Grid<TypeParam> grid;
    for (int i = 0; i < 5000; ++i) {
        static_cast<void>(grid.add(makeBox<TypeParam>(i % 10, 0, 0, i % 10 + 1, 1, 1)));
    }
    grid.update();
    CollectAny any;
    const QueryCost cost =
        grid.visit(BoxRegion<TypeParam>{makeBox<TypeParam>(0, 0, 0, 10, 1, 1)}, any);
    EXPECT_FALSE(any.found().isNull());
    EXPECT_EQ(cost.hits, 1U);
}

TYPED_TEST(GridQuery, MayBeAskedFromWithinACollector) {
    Grid<TypeParam> grid;
    const auto proxies = addBlock(grid);
    for (const auto& proxy : proxies) {
        grid.move(proxy.id, {proxy.box.min(), proxy.box.max() * TypeParam(1)});
    }
    struct Nested {
        const Grid<TypeParam>& grid;
        std::size_t neighbours = 0;
        void add(ProxyId id, TypeParam) {
            CollectCount count;
            grid.visit(BoxRegion<TypeParam>{grid.box(id)}, count);
            neighbours += count.count();
        }
        static constexpr double limit() { return std::numeric_limits<double>::infinity(); }
    };
    Nested nested{grid};
    grid.visit(BoxRegion<TypeParam>{makeBox<TypeParam>(0, 0, 0, 4, 4, 4)}, nested);
    EXPECT_EQ(nested.neighbours, 1000U);  // (2 + 3 + 3 + 2) cubed: each and those that touch it
}

// --- Cells ---------------------------------------------------------------------------------------

TYPED_TEST(GridQuery, OfACellIsTheInverseOfTheCellsOfAProxy) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 1.5, 0.1, 300.0}) {
            SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << cellSize);
            GridConfig config;
            config.cellSize = cellSize;
            GridWorld<TypeParam> world(config);
            Script<TypeParam> script(scene, 0x5eed0504);
            script.begin(world);
            world.grid.update();
            script.playFrame(world);
            const auto isFinite = [](const Placed<TypeParam>& proxy) {
                return proxy.box.min().allFinite() && proxy.box.max().allFinite();
            };
            for (const Placed<TypeParam>& proxy : script.proxies().first(60)) {
                if (!isFinite(proxy)) {
                    continue;
                }
                const CellRange range = world.grid.cellsOf(proxy.id);
                const auto cell = script.random().chance(0.5) ? range.lowest : range.highest;
                typename CollectKeys<TypeParam>::Found expected;
                for (const Placed<TypeParam>& other : script.proxies()) {
                    if (!isFinite(other)) {
                        continue;
                    }
                    const CellRange cells = world.grid.cellsOf(other.id);
                    bool touches = true;
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        touches = touches && cells.lowest[axis] <= cell[axis] &&
                                  cell[axis] <= cells.highest[axis];
                    }
                    if (touches) {
                        expected.emplace_back(other.id, TypeParam(0));
                    }
                }
                std::sort(expected.begin(), expected.end());
                CollectKeys<TypeParam> found;
                world.grid.visitCell(cell, found);
                ASSERT_EQ(differences(found.sorted(), expected), "");
            }
        }
    }
}

TYPED_TEST(GridQuery, OfAPointsCellIsTheFloorOfItsCoordinates) {
    GridConfig config;
    config.cellSize = 0.5;
    const Grid<TypeParam> grid(config);
    EXPECT_EQ(grid.cellSize(), TypeParam(0.5));
    EXPECT_EQ(grid.cellAt({TypeParam(0.75), TypeParam(-0.25), TypeParam(1)}),
              (std::array<std::int64_t, 3>{1, -1, 2}));
    EXPECT_EQ(grid.cellAt({0, -TypeParam(0), TypeParam(-0.5)}),
              (std::array<std::int64_t, 3>{0, 0, -1}));
    // Beyond all cells is the last one.
    const auto far = grid.cellAt({std::numeric_limits<TypeParam>::max(), TypeParam(-3e30), 0});
    EXPECT_GT(far[0], 1'000'000'000'000'000'000);
    EXPECT_LT(far[1], -1'000'000'000'000'000'000);
}

TYPED_TEST(GridQuery, NeverChangesTheCellsAndSoFindsAProxyInItsCell) {
    Grid<TypeParam> grid;
    Random random(0x5eed0505);
    std::vector<ProxyId> ids;
    for (int i = 0; i < 1000; ++i) {
        const auto half = Vector3<double>::Constant(0.05);
        ids.push_back(grid.add(boxAround<TypeParam>(random.pointIn(0, 20), half)));
    }
    const TypeParam size = grid.cellSize();
    const CellRange cells = grid.cellsOf(ids[7]);
    CollectKeys<TypeParam> found;
    grid.visitCell(cells.lowest, found);
    const auto sorted = found.sorted();
    EXPECT_TRUE(std::any_of(sorted.begin(), sorted.end(),
                            [&](const auto& hit) { return hit.first == ids[7]; }));
    EXPECT_EQ(grid.cellSize(), size);
    EXPECT_EQ(grid.cellsOf(ids[7]), cells);
}

TYPED_TEST(GridQuery, OfCellsGoesByTheFinestCellsInUse) {
    Grid<TypeParam> grid;
    Random random(0x5eed0506);
    for (int i = 0; i < 2000; ++i) {
        const auto half = Vector3<double>::Constant(0.05);
        static_cast<void>(
            grid.add(boxAround<TypeParam>(random.pointIn(0, 20), half), Mobility::resting));
    }
    ProxyId large;
    for (int i = 0; i < 200; ++i) {
        const auto half = Vector3<double>::Constant(4);
        large = grid.add(boxAround<TypeParam>(random.pointIn(0, 100), half));
    }
    for (int frame = 0; frame < 5; ++frame) {
        grid.move(large, shifted(random, grid.box(large), 1));
        grid.update();
        EXPECT_LT(grid.cellSize(), 4);
    }
}

}  // namespace
}  // namespace hashphase::test
