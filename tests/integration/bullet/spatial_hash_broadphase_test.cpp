// SPDX-License-Identifier: Zlib
//
// What programs rely on in btDbvtBroadphase beyond its pairs and queries.

#include <tests/integration/bullet/bullet_scenes.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

const Box kHere = boxAround({0, 0, 0}, {1, 1, 1});
const Box kThere = boxAround({9, 0, 0}, {1, 1, 1});

btBroadphaseProxy* create(btBroadphaseInterface& broadphase, const Box& box = kHere,
                          void* client = nullptr) {
    return broadphase.createProxy(box.min, box.max, BOX_SHAPE_PROXYTYPE, client,
                                  btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter,
                                  nullptr);
}

void set(btBroadphaseInterface& broadphase, btBroadphaseProxy* proxy, const Box& box) {
    broadphase.setAabb(proxy, box.min, box.max, nullptr);
}

int pairCount(btBroadphaseInterface& broadphase) {
    return broadphase.getOverlappingPairCache()->getNumOverlappingPairs();
}

bool haveSameBits(const btVector3& a, const btVector3& b) {
    return std::memcmp(a.m_floats, b.m_floats, 3 * sizeof(btScalar)) == 0;
}

// --- Proxies -------------------------------------------------------------------------------------

TEST(SpatialHashBroadphase, CountsUniqueIdsFromOneAndUsesNoneAgain) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const first = create(broadphase);
    btBroadphaseProxy* const second = create(broadphase);
    EXPECT_EQ(first->getUid(), 1);
    EXPECT_EQ(second->getUid(), 2);
    broadphase.destroyProxy(second, nullptr);
    EXPECT_EQ(create(broadphase)->getUid(), 3);
    broadphase.destroyProxy(first, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(create(broadphase)->getUid(), 4);
}

TEST(SpatialHashBroadphase, CountsFromOneAgainAfterResetPoolOnlyWhenEmpty) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const first = create(broadphase);
    broadphase.destroyProxy(create(broadphase), nullptr);
    broadphase.resetPool(nullptr);
    btBroadphaseProxy* const third = create(broadphase);
    EXPECT_EQ(third->getUid(), 3) << "A proxy is alive: resetPool() does nothing.";
    broadphase.destroyProxy(first, nullptr);
    broadphase.destroyProxy(third, nullptr);
    broadphase.resetPool(nullptr);
    EXPECT_EQ(create(broadphase)->getUid(), 1);
    EXPECT_EQ(create(broadphase)->getUid(), 2);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(pairCount(broadphase), 1);
    EXPECT_EQ(broadphase.validate(), "");
}

TEST(SpatialHashBroadphase, KeepsTheAddressAndTheContentOfAProxyForItsLife) {
    SpatialHashBroadphase broadphase;
    std::vector<int> clients(5000);
    std::vector<btBroadphaseProxy*> proxies;
    for (int& client : clients) {
        const auto x = btScalar(proxies.size());
        proxies.push_back(create(broadphase, boxAround({x, 0, 0}, {1, 1, 1}), &client));
    }
    for (std::size_t i = 0; i < proxies.size(); i += 3) {
        broadphase.destroyProxy(proxies[i], nullptr);
        proxies[i] = create(broadphase, kThere, &clients[i]);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        const btBroadphaseProxy& proxy = *proxies[i];
        const Box box = i % 3 == 0 ? kThere : boxAround({btScalar(i), 0, 0}, {1, 1, 1});
        ASSERT_EQ(proxy.m_clientObject, &clients[i]);
        ASSERT_TRUE(isSame({proxy.m_aabbMin, proxy.m_aabbMax}, box)) << i;
        ASSERT_EQ(proxy.m_collisionFilterGroup, btBroadphaseProxy::DefaultFilter);
        ASSERT_EQ(proxy.m_collisionFilterMask, btBroadphaseProxy::AllFilter);
    }
}

TEST(SpatialHashBroadphase, KeepsABoxToTheLastBit) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const proxy = create(broadphase);
    const btScalar tiny = std::numeric_limits<btScalar>::denorm_min();
    const btScalar odd = btScalar(1) / 3;
    const btScalar large = BT_LARGE_FLOAT;
    for (const Box& box : {Box{{-tiny, btScalar(-0.0), odd}, {tiny, 0, odd}},
                           Box{{-large, -odd, 1}, {large, odd, 1}}, Box{{1, 2, 3}, {-1, -2, -3}}}) {
        set(broadphase, proxy, box);
        btVector3 min;
        btVector3 max;
        broadphase.getAabb(proxy, min, max);
        EXPECT_TRUE(haveSameBits(proxy->m_aabbMin, box.min) && haveSameBits(min, box.min));
        EXPECT_TRUE(haveSameBits(proxy->m_aabbMax, box.max) && haveSameBits(max, box.max));
    }
}

TEST(SpatialHashBroadphase, PairsProxiesWithoutClients) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const a = create(broadphase, kHere, nullptr);
    btBroadphaseProxy* const b = create(broadphase, kHere, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    ASSERT_EQ(pairCount(broadphase), 1);
    const btBroadphasePair& pair =
        *broadphase.getOverlappingPairCache()->getOverlappingPairArrayPtr();
    EXPECT_EQ(pair.m_pProxy0, a) << "The lower unique id comes first.";
    EXPECT_EQ(pair.m_pProxy1, b);
}

TEST(SpatialHashBroadphase, MarksNothingWhenABoxIsSetToWhatItIs) {
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 100; ++i) {
        proxies.push_back(create(broadphase, boxAround({btScalar(i), 0, 0}, {1, 1, 1})));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.lastCost().grid.changed, 100U);
    for (btBroadphaseProxy* const proxy : proxies) {
        const Box same{proxy->m_aabbMin, proxy->m_aabbMax};
        set(broadphase, proxy, same);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.lastCost().grid.changed, 0U);
    set(broadphase, proxies[50], kThere);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.lastCost().grid.changed, 1U);
}

TEST(SpatialHashBroadphase, LeadsFromAProxyToItsIdAndBack) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const a = create(broadphase);
    btBroadphaseProxy* const b = create(broadphase, kThere);
    EXPECT_EQ(broadphase.proxyOf(SpatialHashBroadphase::idOf(a)), a);
    EXPECT_EQ(broadphase.proxyOf(SpatialHashBroadphase::idOf(b)), b);
    EXPECT_EQ(broadphase.grid().size(), 2U);
    broadphase.destroyProxy(a, nullptr);
    EXPECT_EQ(broadphase.grid().size(), 1U);
}

// --- The whole -----------------------------------------------------------------------------------

TEST(SpatialHashBroadphase, KnowsTheBoxAroundEverything) {
    SpatialHashBroadphase broadphase;
    btVector3 min(1, 1, 1);
    btVector3 max(1, 1, 1);
    broadphase.getBroadphaseAabb(min, max);
    EXPECT_TRUE(isSame({min, max}, {{0, 0, 0}, {0, 0, 0}})) << "As btDbvtBroadphase when empty.";
    btBroadphaseProxy* const a = create(broadphase, boxAround({-5, 0, 0}, {1, 2, 3}));
    create(broadphase, boxAround({7, 1, 0}, {1, 1, 1}));
    broadphase.getBroadphaseAabb(min, max);
    EXPECT_TRUE(isSame({min, max}, {{-6, -2, -3}, {8, 2, 3}}));
    broadphase.destroyProxy(a, nullptr);
    broadphase.getBroadphaseAabb(min, max);
    EXPECT_TRUE(isSame({min, max}, {{6, 0, -1}, {8, 2, 1}}));
}

TEST(SpatialHashBroadphase, UsesTheCacheItIsGivenAndLeavesItToItsOwner) {
    btHashedOverlappingPairCache cache;
    {
        SpatialHashBroadphase broadphase(&cache);
        EXPECT_EQ(broadphase.getOverlappingPairCache(), &cache);
        EXPECT_EQ(std::as_const(broadphase).getOverlappingPairCache(), &cache);
        btBroadphaseProxy* const proxy = create(broadphase);
        create(broadphase);
        broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
        broadphase.destroyProxy(proxy, nullptr);
    }
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
}

TEST(SpatialHashBroadphase, MakesAPairCacheOfItsOwn) {
    SpatialHashBroadphase broadphase;
    EXPECT_NE(dynamic_cast<PairCache*>(broadphase.getOverlappingPairCache()), nullptr);
    EXPECT_FALSE(broadphase.getOverlappingPairCache()->hasDeferredRemoval());
}

TEST(SpatialHashBroadphase, MayBeDestroyedWithProxiesAliveThroughItsBase) {
    std::unique_ptr<btBroadphaseInterface> broadphase = std::make_unique<SpatialHashBroadphase>();
    for (int i = 0; i < 100; ++i) {
        create(*broadphase);
    }
    broadphase->calculateOverlappingPairs(nullptr);
    EXPECT_EQ(pairCount(*broadphase), 4950);
    broadphase.reset();
}

TEST(SpatialHashBroadphase, HoldsNoMoreMemoryAfterManyLives) {
    SpatialHashBroadphase broadphase;
    std::size_t before = 0;
    for (int life = 0; life < 60; ++life) {
        std::vector<btBroadphaseProxy*> proxies;
        for (int i = 0; i < 300; ++i) {
            const btScalar x = btScalar(i + life) / 2;
            proxies.push_back(create(broadphase, boxAround({x, 0, 0}, {1, 1, 1})));
        }
        broadphase.calculateOverlappingPairs(nullptr);
        for (btBroadphaseProxy* const proxy : proxies) {
            broadphase.destroyProxy(proxy, nullptr);
        }
        broadphase.calculateOverlappingPairs(nullptr);
        if (life == 29) {
            before = broadphase.memoryBytes();
        }
    }
    EXPECT_EQ(broadphase.memoryBytes(), before);
    EXPECT_GT(before, 300 * sizeof(btBroadphaseProxy));
    EXPECT_EQ(pairCount(broadphase), 0);
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
    constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();
    for (const btScalar bad :
         {btScalar(-1), -kInfinity, std::numeric_limits<btScalar>::quiet_NaN()}) {
        const SpatialHashConfig config{.fastFrom = bad};
        EXPECT_NE(configError(config).find("fastFrom"), std::string::npos);
        EXPECT_THROW(SpatialHashBroadphase{config}, std::invalid_argument);
    }
    for (const btScalar good : {btScalar(0), btScalar(-0.0), btScalar(1), kInfinity}) {
        EXPECT_EQ(configError(SpatialHashConfig{.fastFrom = good}), "");
    }
}

// --- Misuse --------------------------------------------------------------------------------------

#if HASHPHASE_ENABLE_ASSERTS
TEST(SpatialHashBroadphaseDeathTest, AssertsThatAProxyToDestroyIsAlive) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const proxy = create(broadphase);
    create(broadphase);
    broadphase.destroyProxy(proxy, nullptr);
    EXPECT_DEATH(broadphase.destroyProxy(proxy, nullptr), "did not destroy");
    EXPECT_DEATH(broadphase.destroyProxy(nullptr, nullptr), "did not destroy");
}

TEST(SpatialHashBroadphaseDeathTest, AssertsThatAProxyToSetOrRefilterIsAlive) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const proxy = create(broadphase);
    broadphase.destroyProxy(proxy, nullptr);
    EXPECT_DEATH(set(broadphase, proxy, kThere), "did not destroy");
    EXPECT_DEATH(broadphase.refilter(proxy, nullptr), "did not destroy");
}

TEST(SpatialHashBroadphaseDeathTest, AssertsThatAProxyIsItsOwn) {
    SpatialHashBroadphase broadphase;
    create(broadphase);
    SpatialHashBroadphase other;
    btBroadphaseProxy* const foreign = create(other);
    EXPECT_DEATH(broadphase.destroyProxy(foreign, nullptr), "this broadphase created");
    EXPECT_DEATH(set(broadphase, foreign, kThere), "this broadphase created");
}

TEST(SpatialHashBroadphaseDeathTest, AssertsThatAnIdIsOfAProxyAlive) {
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* const proxy = create(broadphase);
    const ProxyId id = SpatialHashBroadphase::idOf(proxy);
    broadphase.destroyProxy(proxy, nullptr);
    EXPECT_DEATH(static_cast<void>(broadphase.proxyOf(id)), "alive");
}
#endif

}  // namespace
}  // namespace hashphase::test
