// SPDX-License-Identifier: Zlib

// What queries find: the same as looking at everything, in every scene, at any moment of a frame.

#include <broadphase/grid.hpp>
#include <broadphase/proxy_filter.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <demos/stability/run_together.hpp>
#include <tests/support/call_each.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/population.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class GridQuery : public testing::Test {
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GridQuery, Scalars);

TYPED_TEST(GridQuery, FindsWhatBruteForceFindsInEveryScene) {
    std::size_t found = 0;
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
    EXPECT_GT(found, 40000U);
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

TYPED_TEST(GridQuery, OfTheClosestInABallDoesNotDependOnItsRadius) {
    using Scalar = TypeParam;
    Population<Scalar> world;
    for (const int x : {9, 4, 7}) {
        const auto box = boxAround<Scalar>({double(x), 0, 0}, {1, 1, 1});
        static_cast<void>(world.grid.add(box, Mobility::mobile));
    }
    world.grid.update();
    for (const Scalar radius :
         {Scalar(5), std::numeric_limits<Scalar>::max(), std::numeric_limits<Scalar>::infinity()}) {
        CollectClosest<Scalar> closest;
        world.grid.visit(SphereRegion<Scalar>({0, 0, 0}, radius), closest);
        EXPECT_EQ(closest.key(), Scalar(9)) << radius;
    }
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

/// What is not above a height. Its key is 0 for a NaN, too.
struct Below {
    [[nodiscard]] static float key(const Aabb<float>& box) {
        return box.min().y() > 3 ? -1.0F : 0.0F;
    }
    [[nodiscard]] static Aabb<float> bounds() {
        return boxAround<float>({0, 0, 0}, {1e9, 1e9, 1e9});
    }
};

// Filed or in the list of changes, and when the collector of a query changes it.
TEST(GridQueryOfNan, FindsNoneWhateverTheRegionsKeyIs) {
    const CaughtMessages aboutNan;
    for (const bool isFiled : {false, true}) {
        SCOPED_TRACE(isFiled);
        Population<float> world;
        world.addMany(100, cubesIn<float>(0, 2, 1));
        world.update();
        world.grid.move(world.proxies[7].id, detail::nanBox<float>());
        const auto begin = [&] {
            for (std::size_t i = 10; i < 90; ++i) {
                world.moveTo(i, shifted(world.random, world.proxies[i].box, 0.1));
            }
            if (isFiled) {
                world.grid.expectQueries(1'000'000);
            }
        };
        begin();
        CollectCount one;
        CollectCount each;
        const Below below;
        world.grid.visit(below, one);
        world.grid.visitEach(std::span(&below, 1), std::span(&each, 1));
        EXPECT_EQ(one.count(), 99U);
        EXPECT_EQ(each.count(), 99U);
        begin();
        std::size_t found = 0;
        CallEach collector{[&](ProxyId first, float) {
            for (std::size_t i = 0; i < 100 && found == 0; ++i) {
                if (world.proxies[i].id != first) {
                    world.grid.move(world.proxies[i].id, detail::nanBox<float>());
                }
            }
            ++found;
        }};
        world.grid.visit(below, collector);
        EXPECT_EQ(found, 1U);
    }
}

TEST(GridQueryOfNan, FindsNoneOnItsWay) {
    const CaughtMessages aboutNan;
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    const Aabb<float> box = makeBox<float>(0, 0, 0, 1, 1, 1);
    sweeps.set(grid.add(detail::nanBox<float>()), {1, 0, 0});
    sweeps.set(grid.add(box), MovingBox<float>{detail::nanBox<float>(), {1, 0, 0}});
    CollectCount none;
    sweeps.visit(Below(), none);
    EXPECT_EQ(none.count(), 0U);
    sweeps.set(grid.add(detail::nanBox<float>()), MovingBox<float>{box, {1, 0, 0}});
    CollectCount one;
    sweeps.visit(Below(), one);
    EXPECT_EQ(one.count(), 1U);
}

// --- On threads ----------------------------------------------------------------------------------

constexpr std::size_t kThreads = 4;

/// Boxes that are added and not filed yet, for readers on several threads.
struct GridThreads : testing::Test {
    GridThreads() { boxes.addMany(1000, scene.draw); }

    void moveAll() {
        for (std::size_t i = 0; i < boxes.proxies.size(); ++i) {
            boxes.moveTo(i, shifted(boxes.random, boxes.proxies[i].box, 0.5));
        }
    }

    /// All start together: the first query is the one that files. Nothing that they say is wrong.
    static void expectNothingWrong(
        const std::function<void(std::size_t thread, std::string& wrong)>& read) {
        std::atomic<std::size_t> ready{0};
        std::array<std::string, kThreads> wrong;
        demos::runTogether(kThreads, [&](std::size_t t) {
            ready.fetch_add(1);
            while (demos::hasThreads() && ready.load() < kThreads) {
                std::this_thread::yield();
            }
            read(t, wrong[t]);
        });
        for (const std::string& text : wrong) {
            ASSERT_EQ(text, "");
        }
    }

    template <class Region>
    void check(const Region& region, std::string& wrong) {
        CollectKeys<float> found;
        CollectKeys<float> expected;
        boxes.grid.visit(region, found);
        visitByBruteForce<float>(boxes.proxies, region, expected);
        wrong += differences(found.sorted(), expected.sorted());
    }

    BoxScene<float> scene = spreadScene<float>("evenly spread", 1, 0);
    Population<float> boxes;
};

// Where nothing waits, as after an update, only the trees are to be made.
TEST_F(GridThreads, QueriesRightAfterManyChangesAllSeeThem) {
    for (int round = 0; round < 40; ++round) {
        moveAll();
        const bool isUpdated = round % 2 == 1;
        if (isUpdated) {
            boxes.update();
        }
        expectNothingWrong([&](std::size_t t, std::string& wrong) {
            Random random(0x5eed0802U + t);
            RegionMaker<float> make(random, boxes.proxies);
            for (int i = 0; i < 5; ++i) {
                if (!isUpdated) {
                    check(make.box(), wrong);
                    check(make.sphere(), wrong);
                }
                check(make.ray(), wrong);
            }
        });
        if (round % 6 == 0) {
            boxes.update();
        }
    }
}

TEST_F(GridThreads, WhateverIsConstMayBeAskedBesideTheQueryThatFiles) {
    const Grid<float>& grid = boxes.grid;
    for (int round = 0; round < 10; ++round) {
        moveAll();
        expectNothingWrong([&](std::size_t t, std::string& wrong) {
            const Placed<float>& proxy = boxes.proxies[t * 100];
            if (t == 0) {
                check(BoxRegion<float>{proxy.box}, wrong);
                return;
            }
            std::size_t seen = 0;
            grid.forEach([&seen](ProxyId, const Aabb<float>&) { ++seen; });
            const bool isRight = grid.contains(proxy.id) && grid.size() == 1000 && seen == 1000 &&
                                 isSameBits(grid.box(proxy.id), proxy.box) &&
                                 grid.cellsOf(proxy.id).lowest == grid.cellAt(proxy.box.min());
            wrong += isRight ? "" : "const members";
        });
    }
}

// Few of many indices have proxies, so that those that are listed are read.
TEST_F(GridThreads, AllProxiesAreReadBesideQueriesAfterAShiftThatRounds) {
    for (int i = 0; i < 9000; ++i) {
        boxes.grid.remove(boxes.grid.add(boxes.proxies[0].box));
        boxes.add(boxes.proxies[0].box);
    }
    boxes.update();
    boxes.keepOnly([](std::size_t i) { return i < 1000; });
    boxes.update();
    const Grid<float>& grid = boxes.grid;
    std::size_t seen = 0;
    const auto count = [&seen](ProxyId, const Aabb<float>&) { ++seen; };
    for (int round = 0; round < 10; ++round) {
        ASSERT_GT(boxes.grid.shiftOrigin({0.1F, 0.3F, 0}), 0U);
        const std::uint64_t filings = grid.filingCount();
        grid.forEach(count);
        EXPECT_EQ(grid.filingCount(), filings + 1) << "before the list is read";
        ASSERT_GT(boxes.grid.shiftOrigin({0.1F, 0.3F, 0}), 0U);
        expectNothingWrong([&](std::size_t t, std::string& wrong) {
            std::size_t found = 0;
            if (t == 0) {
                CollectCount all;
                grid.visit(SphereRegion<float>({0, 0, 0}, 1e9F), all);
                found = all.count();
            } else if (t == 1) {
                RadiusSearch<float> search;
                search.take(grid, 1);
                found = search.size();
            } else {
                grid.forEach([&found](ProxyId, const Aabb<float>&) { ++found; });
            }
            wrong += found == 1000 ? "" : "some are missing";
        });
    }
}

}  // namespace
}  // namespace hashphase::test
