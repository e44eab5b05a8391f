// SPDX-License-Identifier: Zlib
//
// Worlds that are loaded, asked, changed and unloaded, and never stepped: nothing gathers.

#include <tests/integration/bullet/ghost_world.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kPerLevel = 400;
constexpr int kLevels = 40;

struct AskedWorld : ObjectWorld {
    using ObjectWorld::ObjectWorld;
    ~AskedWorld() { unload(); }

    void addOne(bool isGhost, btCollisionShape& shape, const btVector3& at, int group) {
        objects.push_back(isGhost ? std::make_unique<btPairCachingGhostObject>()
                                  : std::make_unique<btCollisionObject>());
        add(*objects.back(), shape, at, group);
    }
    /// Boxes on a floor, of which every fourth is a ghost that touches its neighbours.
    void load() {
        for (int i = 0; i < kPerLevel; ++i) {
            const bool isGhost = i % 4 == 3;
            addOne(isGhost, isGhost ? large : small,
                   {btScalar(i % 20) * 2, 0, btScalar(i / 20) * 2},
                   isGhost      ? btBroadphaseProxy::SensorTrigger
                   : i % 2 == 0 ? btBroadphaseProxy::StaticFilter
                                : btBroadphaseProxy::DefaultFilter);
        }
    }
    void unload() {
        removeAll();
        objects.clear();
    }
    /// Casts rays down at the level.
    QueryCost ask() {
        QueryCost sum;
        for (int i = 0; i < 30; ++i) {
            const btVector3 from(btScalar(i), 9, btScalar(i));
            const btVector3 to(btScalar(i), -9, btScalar(i));
            btCollisionWorld::AllHitsRayResultCallback hits(from, to);
            sum += broadphase.closestRay(from, to, hits);
        }
        return sum;
    }
    [[nodiscard]] std::size_t memoryBytes() const {
        return broadphase.memoryBytes() + cache.memoryBytes();
    }

    btBoxShape small{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btBoxShape large{btVector3(btScalar(1.7), btScalar(0.5), btScalar(1.7))};
    std::vector<std::unique_ptr<btCollisionObject>> objects;
};

TEST(NeverSteppedWorld, HoldsNoMoreAndAsksNoMoreAfterManyLevelsThanAfterAFew) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        SpatialHashConfig config;
        config.sweep = order == PairOrder::arrival ? Sweep::none : Sweep::automatic;
        AskedWorld world(config, order);
        std::size_t memory = 0;
        QueryCost cost;
        std::uint32_t indexLimit = 0;
        for (int level = 1; level <= kLevels; ++level) {
            world.load();
            const QueryCost present = world.ask();
            EXPECT_GT(world.pairCount(), kPerLevel / 4);
            world.unload();
            EXPECT_EQ(world.pairCount(), 0);
            if (level == kLevels / 4) {  // announced pairs are given up now and then
                memory = world.memoryBytes();
                cost = present;
                indexLimit = world.broadphase.grid().indexLimit();
            } else if (level > kLevels / 4) {
                ASSERT_EQ(present.hits, cost.hits);
                ASSERT_LE(present.boxesTested, cost.boxesTested + cost.boxesTested / 4);
            }
        }
        EXPECT_LE(indexLimit, 4U * kPerLevel);
        EXPECT_LE(world.broadphase.grid().indexLimit(), indexLimit);
        EXPECT_LE(world.memoryBytes(), memory);
        world.load();
        world.detect();
        EXPECT_EQ(world.broadphase.validate(), "");
        EXPECT_EQ(world.cache.validate(), "");
        world.unload();
        world.detect();
        EXPECT_EQ(world.broadphase.validate(), "");
    }
}

TEST(NeverSteppedWorld, HoldsNoMoreWhereObjectsAreDragged) {
    AskedWorld world;
    world.load();
    for (int step = 0; step < 20; ++step) {
        world.detect();  // once, until all is at rest
    }
    const std::size_t before = world.memoryBytes();
    std::size_t memory = 0;
    for (int turn = 0; turn < 60; ++turn) {
        for (std::size_t i = 0; i < world.objects.size(); i += 3) {
            btVector3 to = world.objects[i]->getWorldTransform().getOrigin();
            to[1] = btScalar(0.01) * btScalar(turn);
            world.move(*world.objects[i], to);
        }
        EXPECT_LE(world.ask().boxesTested, 30U * 150);
        memory = turn == 30 ? world.memoryBytes() : memory;
    }
    EXPECT_LE(world.memoryBytes(), memory);
    EXPECT_LE(memory, 4 * before);
    EXPECT_EQ(world.broadphase.grid().indexLimit(), static_cast<std::uint32_t>(kPerLevel));
}

TEST(NeverSteppedWorld, HoldsThePairsOfAGhostAroundAllOfThemAlone) {
    btBoxShape around(btVector3(100, 100, 100));
    AskedWorld world;
    world.addOne(true, around, {0, 0, 0}, btBroadphaseProxy::DefaultFilter);
    for (int i = 0; i < 50; ++i) {
        world.addOne(false, world.small, {btScalar(2 * i - 50), 0, 50},
                     btBroadphaseProxy::DefaultFilter);
    }
    world.detect();
    for (int turn = 0; turn < 20; ++turn) {
        for (int i = 0; i < 50; ++i) {
            world.move(*world.objects[std::size_t(i) + 1],
                       {btScalar((i * 7 + turn * 13) % 50), btScalar(i % (turn + 2)), 0});
        }
        EXPECT_EQ(world.pairCount(), 50);
    }
}

}  // namespace
}  // namespace hashphase::test
