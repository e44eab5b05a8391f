// SPDX-License-Identifier: Zlib

// Proxies that sweep make pairs with everything that they touch on their way, in whatever mode. Far, fast, and at
// thin walls: demos/stability/cases.

#include <broadphase/position_region.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/bullet_world.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/motion_oracle.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class SweptPairs : public testing::Test {
    CaughtMessages aboutNan_;

protected:
    static Aabb<Scalar> cubeAt(double x) { return makeBox<Scalar>(x, 0, 0, x + 1, 1, 1); }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SweptPairs, Scalars);

/// A way from the box towards another one of the scene, now and then far beyond.
template <class Scalar>
Vector3<Scalar> drawWay(const BoxScene<Scalar>& scene, Random& random, const Aabb<Scalar>& box) {
    const auto share = static_cast<Scalar>(random.logBetween(0.01, 4));
    return (scene.draw(random).min() - box.max()) * share;
}

/// Sorted.
template <class Scalar, class Region>
std::vector<ProxyId> foundIn(const Sweeps<Scalar>& sweeps, const Region& region) {
    std::vector<ProxyId> ids;
    CollectAll collector(ids);
    const QueryCost cost = sweeps.visit(region, collector);
    EXPECT_GE(cost.hits, ids.size());
    std::sort(ids.begin(), ids.end());
    return ids;
}

template <class Scalar>
void playSwept(const BoxScene<Scalar>& scene, const GridConfig& config, std::uint64_t seed,
               int frames) {
    SCOPED_TRACE(testing::Message() << scene.name << ", cell size " << config.cellSize);
    Script<Scalar> script(scene, seed, {.recolour = 0.01});
    PairWorld<Scalar> world(config,
                            [&script](ProxyId a, ProxyId b) { return script.accepts(a, b); });
    script.begin(world);
    for (int frame = 0; frame < frames; ++frame) {
        SCOPED_TRACE(testing::Message() << "frame " << frame);
        script.playFrame(world);
        Random& random = script.random();
        const bool isAllStill = frame % 5 == 2 || frame % 5 == 3;
        if (isAllStill || random.chance(0.2)) {
            world.renewSweeps(!isAllStill);
        } else if (frame % 5 == 4) {
            world.pairs.setSweeps(&world.sweeps);
        }
        for (const Placed<Scalar>& proxy : script.proxies()) {
            if (!isAllStill && random.chance(0.04)) {
                const Sweep mode = random.chance(0.4) ? Sweep::none : kSweepModes[random.below(3)];
                const Aabb<Scalar> start =
                    random.chance(0.5) ? scene.nudge(random, proxy.box) : scene.draw(random);
                const Vector3<Scalar> way = drawWay(scene, random, start);
                if (random.chance(0.5)) {
                    world.sweep(proxy.id, MovingBox<Scalar>{start, way}, mode);
                } else {
                    world.sweep(proxy.id, way, mode);
                }
            } else if (random.chance(0.01)) {
                world.findPairsNow(proxy.id);
            }
        }
        world.update();
        ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(script.proxies()));
    }
}

TYPED_TEST(SweptPairs, EqualBruteForceInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (const double cellSize : {0.0, 1.5}) {
            playSwept(scene, {.cellSize = cellSize, .updatesBeforeRest = 2}, 0x5eed0d01, 6);
            if (this->HasFatalFailure()) {
                return;
            }
        }
    }
}

TYPED_TEST(SweptPairs, AreTheSameOnAnyNumberOfThreads) {
    Random random(0x5eed0d03);
    for (const double length : {20.0, 1e4}) {
        const Bullets<TypeParam> bullets(20'000, 2000, length, random);
        const std::vector<ProxyPair> expected =
            BulletWorld<TypeParam>(bullets, Sweep::automatic).update();
        for (const std::size_t threads : {2U, 5U}) {
            ThreadedFor threadedFor(threads, 0x5eed0d04);
            BulletWorld<TypeParam> world(bullets, Sweep::automatic);
            EXPECT_EQ(differences(world.update(threadedFor), expected), "") << length;
            EXPECT_GT(threadedFor.mostRanges(), 1U);
        }
    }
}

// Without Pairs nobody tells Sweeps of an update: who comes into the place of what swept is found.
TYPED_TEST(SweptPairs, HideNobodyWhoComesIntoTheirPlace) {
    Grid<TypeParam> grid;
    Sweeps<TypeParam> sweeps(grid);
    const Aabb<TypeParam> box = this->cubeAt(0);
    const ProxyId bullet = grid.add(box);
    sweeps.set(bullet, {100, 0, 0});
    grid.remove(bullet);
    grid.update();
    const ProxyId next = grid.add(box);
    ASSERT_EQ(next.index, bullet.index);
    EXPECT_EQ(foundIn(sweeps, BoxRegion<TypeParam>{box}), std::vector{next});
}

TYPED_TEST(SweptPairs, CostNothingWhereNothingSweeps) {
    Random random(0x5eed0d07);
    const Bullets<TypeParam> still(2000, 0, 1, random);
    BulletWorld<TypeParam> world(still, Sweep::automatic);
    world.update();
    const SweepCost& cost = world.sweeps.lastCost();
    EXPECT_EQ(cost.segments + cost.rays + cost.boxesTested + cost.contactsTested, 0U);
    EXPECT_EQ(world.sweeps.memoryBytes(), sizeof(world.sweeps));
}

TYPED_TEST(SweptPairs, TakeABadDisplacementForNone) {
    PairWorld<TypeParam> world;
    const CaughtMessages messages;
    world.add(this->cubeAt(5));
    const ProxyId bullet = world.add(this->cubeAt(0));
    world.sweep(bullet, {10, 0, 0}, Sweep::automatic);
    world.update();
    EXPECT_EQ(world.set().size(), 1U);
    for (const TypeParam bad : {std::numeric_limits<TypeParam>::quiet_NaN(),
                                std::numeric_limits<TypeParam>::infinity()}) {
        world.sweeps.set(bullet, {bad, 0, 0});
        EXPECT_EQ(world.sweeps.size(), 0U);
    }
    world.update();
    EXPECT_TRUE(world.set().empty());
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("displacement"), std::string::npos);
}

// Queries that ask for swept boxes: nothing that the way touches is left out, and who stands is found
// as ever.
TYPED_TEST(SweptPairs, AreFoundByQueriesAlongTheirWay) {
    Random random(0x5eed0d08);
    const Bullets<TypeParam> bullets(2000, 200, 25, random);
    for (const Sweep mode : kSweepModes) {
        BulletWorld<TypeParam> world(bullets, mode);
        world.update();
        int onTheWay = 0;
        int metOnTheWay = 0;
        for (int i = 0; i < 300; ++i) {
            const auto box = boxesIn<TypeParam>(-10., 42., 0, 3)(random);
            const std::vector<ProxyId> ids = foundIn(world.sweeps, BoxRegion<TypeParam>{box});
            ASSERT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end()) << "found twice";
            for (std::size_t j = 0; j < world.ids.size(); ++j) {
                const bool isFound = std::binary_search(ids.begin(), ids.end(), world.ids[j]);
                const MovingBox<TypeParam> motion = world.sweeps.motion(world.ids[j]);
                if (firstContactByRationals(motion, MovingBox<TypeParam>{box})) {
                    ASSERT_TRUE(isFound) << j;
                    onTheWay += overlaps(motion.box, box) ? 0 : 1;
                } else if (isFound) {
                    ASSERT_TRUE(overlaps(sweptBounds(motion), box)) << j;
                    ASSERT_LT(j, bullets.ways.size()) << "who stands is found where it is";
                }
            }
            // Wherever they are at some time a ray finds them.
            const Vector3<TypeParam> from = random.pointIn(-10, 42).cast<TypeParam>();
            const RayRegion<TypeParam> ray(from, random.pointIn(-10, 42).cast<TypeParam>());
            const std::vector<ProxyId> met = foundIn(world.sweeps, ray);
            for (std::size_t j = 0; j < bullets.ways.size() && i % 3 == 0; ++j) {
                for (int step = 0; step <= 16; ++step) {
                    const Vector3<TypeParam> by = bullets.ways[j] * TypeParam(step) / 16;
                    const Aabb<TypeParam> there(bullets.boxes[j].min() + by,
                                                bullets.boxes[j].max() + by);
                    if (ray.key(there) >= 0) {
                        ASSERT_TRUE(std::binary_search(met.begin(), met.end(), world.ids[j]));
                        metOnTheWay += ray.key(bullets.boxes[j]) >= 0 ? 0 : 1;
                    }
                }
            }
        }
        EXPECT_GT(onTheWay, 100);
        EXPECT_GT(metOnTheWay, 100);
    }
}

// --- Cost ----------------------------------------------------------------------------------------

// A body that has fallen out of the world, and one that is larger than it.
TYPED_TEST(SweptPairs, CostTheSameBesideAStray) {
    Random random(0x5eed0d0c);
    const Bullets<TypeParam> bullets(2000, 2000, 25, random);
    BulletWorld<TypeParam> alone(bullets, Sweep::automatic);
    alone.update();
    const SweepCost usual = alone.sweeps.lastCost();
    Bullets<TypeParam> withStray = bullets;
    withStray.boxes.push_back(boxAround<TypeParam>({0, -1e6, 0}, {0.5, 0.5, 0.5}));
    withStray.ways.push_back(Vector3<TypeParam>(0, -100, 0));
    Bullets<TypeParam> withGiant = bullets;
    withGiant.boxes.push_back(boxAround<TypeParam>({0, -2e4, 0}, {1e4, 1e4, 1e4}));
    withGiant.ways.push_back(Vector3<TypeParam>(0, 0, 1e4));
    for (const Bullets<TypeParam>& some : {withStray, withGiant}) {
        BulletWorld<TypeParam> world(some, Sweep::automatic);
        world.update();
        const SweepCost& cost = world.sweeps.lastCost();
        EXPECT_LE(cost.contactsTested, usual.contactsTested * 5 / 4);
        EXPECT_LE(cost.boxesTested, usual.boxesTested * 5 / 4);
    }
}

// For three that fly far, a tree over everything is not worth while.
TYPED_TEST(SweptPairs, TakeRaysOnlyWhereThereAreManyForTheTree) {
    Random random(0x5eed0d0d);
    for (const std::uint32_t sweeping : {3U, 300U}) {
        Bullets<TypeParam> bullets(20'000, sweeping, 1, random);
        bullets.ways.assign(sweeping, {4000, 4000, 4000});
        bullets.boxes.push_back(boxAround<TypeParam>({1e4, 1e4, 1e4}, {0.5, 0.5, 0.5}));
        BulletWorld<TypeParam> world(bullets, Sweep::line);
        world.update();
        EXPECT_EQ(world.sweeps.lastCost().rays, sweeping == 3 ? 0U : 300U);
    }
}

TYPED_TEST(SweptPairs, AreFoundWhereTheyStandByWhateverAsks) {
    Bullets<TypeParam> bullets;
    bullets.boxes = {makeBox<TypeParam>(0, 0, 0, 1, 1, 1)};
    bullets.ways = {{100, 0, 0}};
    for (const Sweep mode : kSweepModes) {
        const BulletWorld<TypeParam> world(bullets, mode);
        std::vector<ProxyId> found;
        CollectAll collector(found);
        world.sweeps.visit(PositionRegion<TypeParam>({0.5, 0.5, 0.5}, 2), collector);
        EXPECT_EQ(found.size(), 1U);
    }
}

}  // namespace
}  // namespace hashphase::test
