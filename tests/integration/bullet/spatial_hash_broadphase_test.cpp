// SPDX-License-Identifier: Zlib
//
// What programs rely on in btDbvtBroadphase beyond its pairs and queries.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace hashphase::test {
namespace {

const Box kHere = boxAround({0, 0, 0}, {1, 1, 1});
const Box kThere = boxAround({9, 0, 0}, {1, 1, 1});

// --- Proxies -------------------------------------------------------------------------------------

TEST(SpatialHashBroadphase, CountsUniqueIdsFromOneAndUsesNoneAgain) {
    Boxes boxes;
    btBroadphaseProxy* const first = boxes.create(kHere);
    btBroadphaseProxy* const second = boxes.create(kHere);
    EXPECT_EQ(first->getUid(), 1);
    EXPECT_EQ(second->getUid(), 2);
    boxes.destroy(second);
    EXPECT_EQ(boxes.create(kHere)->getUid(), 3);
    boxes.destroy(first);
    boxes.step();
    EXPECT_EQ(boxes.create(kHere)->getUid(), 4);
}

TEST(SpatialHashBroadphase, CountsFromOneAgainAfterResetPoolOnlyWhenEmpty) {
    Boxes boxes;
    btBroadphaseProxy* const first = boxes.create(kHere);
    boxes.destroy(boxes.create(kHere));
    boxes.broadphase.resetPool(nullptr);
    btBroadphaseProxy* const third = boxes.create(kHere);
    EXPECT_EQ(third->getUid(), 3) << "A proxy is alive: resetPool() does nothing.";
    const ProxyId before = SpatialHashBroadphase::idOf(first);
    boxes.destroy(first);
    boxes.destroy(third);
    boxes.broadphase.resetPool(nullptr);
    const ProxyId after = SpatialHashBroadphase::idOf(boxes.create(kHere));
    EXPECT_EQ(boxes.proxies[0]->getUid(), 1);
    EXPECT_EQ(after.index, before.index);
    EXPECT_TRUE(boxes.broadphase.grid().contains(after));
    EXPECT_FALSE(boxes.broadphase.grid().contains(before)) << "No id of before is valid.";
    EXPECT_EQ(boxes.create(kHere)->getUid(), 2);
    boxes.check();
}

TEST(SpatialHashBroadphase, KeepsTheAddressAndTheContentOfAProxyForItsLife) {
    SpatialHashBroadphase broadphase;
    std::vector<int> clients(5000);
    std::vector<btBroadphaseProxy*> proxies;
    const auto create = [&](std::size_t i, const Box& box) {
        return broadphase.createProxy(box.min, box.max, 0, &clients[i], 5, 7, nullptr);
    };
    for (std::size_t i = 0; i < clients.size(); ++i) {
        proxies.push_back(create(i, cubeAt(btScalar(i))));
    }
    for (std::size_t i = 0; i < proxies.size(); i += 3) {
        broadphase.destroyProxy(proxies[i], nullptr);
        proxies[i] = create(i, kThere);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        ASSERT_EQ(proxies[i]->m_clientObject, &clients[i]);
        ASSERT_TRUE(isSame(boxOf(*proxies[i]), i % 3 == 0 ? kThere : cubeAt(btScalar(i)))) << i;
        ASSERT_EQ(proxies[i]->m_collisionFilterGroup, 5);
        ASSERT_EQ(proxies[i]->m_collisionFilterMask, 7);
    }
}

TEST(SpatialHashBroadphase, KeepsABoxToTheLastBit) {
    Boxes boxes;
    btBroadphaseProxy* const proxy = boxes.create(kHere);
    const btScalar tiny = std::numeric_limits<btScalar>::denorm_min();
    const btScalar odd = btScalar(1) / 3;
    const btScalar large = BT_LARGE_FLOAT;
    for (const Box& box : {Box{{-tiny, btScalar(-0.0), odd}, {tiny, 0, odd}},
                           Box{{-large, -odd, 1}, {large, odd, 1}}, Box{{1, 2, 3}, {-1, -2, -3}}}) {
        boxes.set(proxy, box);
        Box got;
        boxes.broadphase.getAabb(proxy, got.min, got.max);
        for (const Box& kept : {boxOf(*proxy), got}) {
            EXPECT_TRUE(isSameBits(kept.min, box.min) && isSameBits(kept.max, box.max));
        }
    }
}

TEST(SpatialHashBroadphase, MarksNothingWhenABoxIsSetToWhatItIs) {
    Boxes boxes;
    for (int i = 0; i < 100; ++i) {
        boxes.create(cubeAt(btScalar(i)));
    }
    const auto changed = [&] {
        boxes.step();
        return boxes.broadphase.lastCost().grid.changed;
    };
    EXPECT_EQ(changed(), 100U);
    for (btBroadphaseProxy* const proxy : boxes.proxies) {
        boxes.set(proxy, boxOf(*proxy));
    }
    EXPECT_EQ(changed(), 0U);
    boxes.set(boxes.proxies[50], kThere);
    EXPECT_EQ(changed(), 1U);
}

// --- The whole -----------------------------------------------------------------------------------

TEST(SpatialHashBroadphase, KnowsTheBoxAroundEverything) {
    Boxes boxes;
    const auto all = [&] {
        Box box{{1, 1, 1}, {1, 1, 1}};
        boxes.broadphase.getBroadphaseAabb(box.min, box.max);
        return box;
    };
    EXPECT_TRUE(isSame(all(), {{0, 0, 0}, {0, 0, 0}})) << "As btDbvtBroadphase when empty.";
    boxes.create(boxAround({-5, 0, 0}, {1, 2, 3}));
    boxes.create(boxAround({7, 1, 0}, {1, 1, 1}));
    EXPECT_TRUE(isSame(all(), {{-6, -2, -3}, {8, 2, 3}}));
    boxes.destroy(boxes.proxies[0]);
    EXPECT_TRUE(isSame(all(), {{6, 0, -1}, {8, 2, 1}}));
}

// From addCollisionObject, say, which checks nothing.
TEST(SpatialHashBroadphase, ReportsBoxesWithNanOnceCountsThemAndFindsThemNowhere) {
    const CaughtMessages messages;
    Boxes boxes;
    Client good{0};
    Client other{1};
    boxes.create(kHere, 1, -1, &good);
    EXPECT_TRUE(messages.all().empty());
    btBroadphaseProxy* const bad = boxes.create(kThere, 1, -1, &other);
    const Ray ray{{-9, btScalar(0.1), btScalar(0.2)}, {19, btScalar(0.1), btScalar(0.2)}};
    const auto expectFound = [&](std::size_t count) {
        CollectBox byBox;
        boxes.broadphase.aabbTest({-99, -99, -99}, {99, 99, 99}, byBox);
        EXPECT_EQ(byBox.found.size(), count);
        CollectRay byRay(ray);
        boxes.broadphase.rayTest(ray.from, ray.to, byRay);
        EXPECT_EQ(byRay.found.size(), count);
    };
    for (int frame = 0; frame < 24; ++frame) {
        Box box = kThere;
        (frame % 6 < 3 ? box.min : box.max)[frame % 3] = std::numeric_limits<btScalar>::quiet_NaN();
        boxes.set(bad, frame % 4 == 0 ? kThere : box);
        Box all;
        boxes.broadphase.getBroadphaseAabb(all.min, all.max);
        EXPECT_EQ(isSame(all, kHere), frame % 4 != 0);
        expectFound(frame % 4 == 0 ? 2 : 1);
        boxes.check();
        expectFound(frame % 4 == 0 ? 2 : 1);
        EXPECT_EQ(boxes.broadphase.grid().nanCount(), frame % 4 == 0 ? 0U : 1U);
    }
    ASSERT_EQ(messages.all().size(), 1U);
    EXPECT_NE(messages.all()[0].find("NaN"), std::string::npos) << messages.all()[0];
}

TEST(SpatialHashBroadphase, UsesTheCacheItIsGivenAndLeavesItToItsOwner) {
    btHashedOverlappingPairCache cache;
    {
        SpatialHashBroadphase broadphase(&cache);
        EXPECT_EQ(broadphase.getOverlappingPairCache(), &cache);
        EXPECT_EQ(std::as_const(broadphase).getOverlappingPairCache(), &cache);
        std::vector<btBroadphaseProxy*> proxies(2);
        broadphase.createProxies(std::vector<ProxyDefinition>(2), proxies, nullptr);
        broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
        broadphase.destroyProxy(proxies[0], nullptr);
    }
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
}

TEST(SpatialHashBroadphase, MayBeDestroyedWithProxiesAliveThroughItsBase) {
    std::unique_ptr<btBroadphaseInterface> broadphase = std::make_unique<SpatialHashBroadphase>();
    EXPECT_NE(dynamic_cast<PairCache*>(broadphase->getOverlappingPairCache()), nullptr);
    EXPECT_FALSE(broadphase->getOverlappingPairCache()->hasDeferredRemoval());
    for (int i = 0; i < 100; ++i) {
        broadphase->createProxy(kHere.min, kHere.max, 0, nullptr, 1, -1, nullptr);
    }
    broadphase->calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase->getOverlappingPairCache()->getNumOverlappingPairs(), 4950);
    broadphase.reset();
}

TEST(SpatialHashBroadphase, HoldsNoMoreMemoryAfterManyLives) {
    Boxes boxes;
    std::size_t before = 0;
    for (int life = 0; life < 60; ++life) {
        for (int i = 0; i < 300; ++i) {
            boxes.create(boxAround({btScalar(i + life) / 2, 0, 0}, {1, 1, 1}));
        }
        boxes.step();
        boxes.destroyAll();
        boxes.step();
        before = life == 29 ? boxes.memoryBytes() : before;
    }
    EXPECT_EQ(boxes.memoryBytes(), before);
    EXPECT_GT(before, 300 * sizeof(btBroadphaseProxy));
    EXPECT_EQ(boxes.pairCount(), 0);
}

TEST(SpatialHashBroadphase, RefusesABadConfigurationByName) {
    SpatialHashConfig config;
    config.grid.cellSize = -1;
    try {
        const SpatialHashBroadphase broadphase(config);
        FAIL() << "A negative cell size is accepted.";
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("cellSize"), std::string::npos) << error.what();
    }
    EXPECT_THROW(SpatialHashBroadphase(nullptr, config), std::invalid_argument);
}

TEST(SpatialHashBroadphase, RefusesSharesOfAnEdgeThatAreNone) {
    constexpr btScalar infinity = std::numeric_limits<btScalar>::infinity();
    for (const btScalar bad :
         {btScalar(-1), -infinity, std::numeric_limits<btScalar>::quiet_NaN()}) {
        const SpatialHashConfig config{.fastFrom = bad};
        EXPECT_NE(configError(config).find("fastFrom"), std::string::npos);
        EXPECT_THROW(SpatialHashBroadphase{config}, std::invalid_argument);
    }
    for (const btScalar good : {btScalar(0), btScalar(-0.0), btScalar(1), infinity}) {
        EXPECT_EQ(configError(SpatialHashConfig{.fastFrom = good}), "");
    }
}

}  // namespace
}  // namespace hashphase::test
