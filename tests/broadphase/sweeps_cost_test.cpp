// SPDX-License-Identifier: Zlib

// What sweeps take beside others, and how else they are asked.

#include <broadphase/position_region.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/bullet_world.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class SweptProxies : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SweptProxies, Scalars);

// A body that has fallen out of the world, and one that is larger than it.
TYPED_TEST(SweptProxies, CostTheSameBesideAStray) {
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
TYPED_TEST(SweptProxies, TakeRaysOnlyWhereThereAreManyForTheTree) {
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

TYPED_TEST(SweptProxies, AreFoundWhereTheyStandByWhateverAsks) {
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

// What a proxy has met on its way and the filter has refused, is asked about again at once.
TYPED_TEST(SweptProxies, AreFilteredAgainAtOnce) {
    Bullets<TypeParam> bullets;
    bullets.boxes = {makeBox<TypeParam>(0, 0, 0, 1, 1, 1), makeBox<TypeParam>(5, 0, 0, 6, 1, 1)};
    bullets.ways = {{10, 0, 0}};
    BulletWorld<TypeParam> world(bullets, Sweep::line);
    world.pairs.update([](ProxyId, ProxyId) { return false; });
    EXPECT_EQ(world.pairs.refusedCount(), 1U);
    const auto yes = [](ProxyId, ProxyId) { return true; };
    EXPECT_EQ(world.pairs.refilter(world.ids[1], yes).born.size(), 1U);
    EXPECT_EQ(world.pairs.validate(), "");
    const PairChanges next = world.pairs.update(yes);
    EXPECT_TRUE(next.born.empty());
    EXPECT_TRUE(next.died.empty());
}

}  // namespace
}  // namespace hashphase::test
