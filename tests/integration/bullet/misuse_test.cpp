// SPDX-License-Identifier: Zlib

// What a caller of the broadphase or of its pair cache may not do is asserted.

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/handlers.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletCollisionCommon.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace hashphase::test {
namespace {

#if HASHPHASE_ENABLE_ASSERTS

btBroadphaseProxy numbered(int uniqueId) {
    btBroadphaseProxy proxy({0, 0, 0}, {1, 1, 1}, nullptr, 1, 1);
    proxy.m_uniqueId = uniqueId;
    return proxy;
}

TEST(PairCacheMisuse, OfProxiesWithTheSameUniqueIdIsAsserted) {
    const ThrowingAsserts throwing;
    PairCache cache;
    btBroadphaseProxy one = numbered(1);
    btBroadphaseProxy two = numbered(2);
    btBroadphaseProxy otherOne = numbered(1);
    btBroadphaseProxy otherTwo = numbered(2);
    cache.addAcceptedPair(&one, &two);
    EXPECT_THROW(cache.addAcceptedPair(&otherOne, &otherTwo), BrokenAssert);
    const BulletProxyPair pair(otherOne, otherTwo);
    EXPECT_THROW(cache.update({}, std::span(&pair, 1), nullptr), BrokenAssert);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
}

TEST(PairCacheMisuse, OfNoKeyIsAsserted) {
    const ThrowingAsserts throwing;
    EXPECT_THROW(PairCache(PairOrder::canonical, nullptr), BrokenAssert);
}

TEST(PairCacheMisuse, OfAFilterThatChangesIsAsserted) {
    struct Filter : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
            ++calls;
            const BulletProxyPair pair(*a, *b);
            EXPECT_THROW(cache.addAcceptedPair(a, b), BrokenAssert);
            EXPECT_THROW(cache.update({}, {&pair, 1}, nullptr), BrokenAssert);
            EXPECT_THROW(cache.removeOverlappingPair(a, known, nullptr), BrokenAssert);
            EXPECT_THROW(cache.removeOverlappingPairsContainingProxy(a, nullptr), BrokenAssert);
            EXPECT_THROW(cache.removeOverlappingPairsContainingProxies({&a, 1}, nullptr),
                         BrokenAssert);
            return true;
        }
        PairCache& cache;
        btBroadphaseProxy* known;
        mutable int calls = 0;
        Filter(PairCache& asked, btBroadphaseProxy& proxy) : cache(asked), known(&proxy) {}
    };
    const ThrowingAsserts throwing;
    PairCache cache;
    btBroadphaseProxy one = numbered(1);
    btBroadphaseProxy two = numbered(2);
    btBroadphaseProxy three = numbered(3);
    cache.addAcceptedPair(&one, &three);
    Filter filter(cache, three);
    cache.setOverlapFilterCallback(&filter);
    EXPECT_NE(cache.addOverlappingPair(&one, &two), nullptr);
    EXPECT_EQ(filter.calls, 1);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 2);
    EXPECT_EQ(cache.validate(), "");
}

TEST(ProxyRanksMisuse, OfNobodyFindsNobody) {
    EXPECT_EQ(detail::ProxyRanks().lowestRank(1, 2), detail::ProxyRanks::kNone);
}

TEST(BroadphaseMisuse, OfACacheThatHasPairsIsAsserted) {
    const ThrowingAsserts throwing;
    PairCache cache;
    btBroadphaseProxy one = numbered(1);
    btBroadphaseProxy two = numbered(2);
    cache.addAcceptedPair(&one, &two);
    EXPECT_THROW(SpatialHashBroadphase{&cache}, BrokenAssert);
}

TEST(BroadphaseMisuse, OfProxiesThatAreNotAliveIsAsserted) {
    const ThrowingAsserts throwing;
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* proxy =
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, 1, nullptr);
    btVector3 low;
    btVector3 high;
    broadphase.getAabb(proxy, low, high);
    EXPECT_EQ(high, btVector3(1, 1, 1));
    broadphase.destroyProxy(proxy, nullptr);
    EXPECT_THROW(broadphase.getAabb(proxy, low, high), BrokenAssert);
    EXPECT_THROW(broadphase.getAabb(nullptr, low, high), BrokenAssert);
    EXPECT_THROW(static_cast<void>(SpatialHashBroadphase::idOf(nullptr)), BrokenAssert);
}

TEST(BroadphaseMisuse, OfProxiesThatAreNotAliveChangesNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    SpatialHashBroadphase broadphase;
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 3; ++i) {
        proxies.push_back(broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, 1, nullptr));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    const ProxyId destroyed = SpatialHashBroadphase::idOf(proxies[1]);
    broadphase.destroyProxy(proxies[1], nullptr);
    broadphase.destroyProxy(proxies[1], nullptr);
    broadphase.setAabb(proxies[1], {5, 5, 5}, {6, 6, 6}, nullptr);
    broadphase.refilter(proxies[1], nullptr);
    EXPECT_EQ(broadphase.proxyOf(destroyed), nullptr);
    EXPECT_EQ(broadphase.proxyOf(ProxyId{}), nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 1);
    for (const int alive : {0, 2}) {
        btVector3 low;
        btVector3 high;
        broadphase.getAabb(proxies[static_cast<std::size_t>(alive)], low, high);
        EXPECT_EQ(high, btVector3(1, 1, 1));
    }
    EXPECT_EQ(broadphase.validate(), "");
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 5 : 0);
}

TEST(BroadphaseMisuse, OfProxiesThatAreNotAliveInABatchChangesNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btGhostPairCallback ghostCallback;
    SpatialHashBroadphase broadphase;
    broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&ghostCallback);
    std::vector<btGhostObject> ghosts(3);
    std::vector<btBroadphaseProxy*> proxies;
    for (btGhostObject& ghost : ghosts) {
        proxies.push_back(
            broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, &ghost, 1, -1, &dispatcher));
        ghost.setBroadphaseHandle(proxies.back());
    }
    broadphase.destroyProxies(std::array{proxies[2], proxies[2]}, &dispatcher);
    broadphase.destroyProxies(std::array{proxies[2]}, &dispatcher);
    broadphase.destroyProxy(proxies[2], &dispatcher);
    broadphase.calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 1);
    EXPECT_EQ(broadphase.validate(), "");
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 2 : 0);
    broadphase.destroyProxies(std::array{proxies[2], proxies[0], proxies[1]}, &dispatcher);
    EXPECT_EQ(broadphase.grid().size(), 0U);
}

TEST(BroadphaseMisuse, OfRaysWithoutACallbackIsAsserted) {
    const ThrowingAsserts throwing;
    SpatialHashBroadphase broadphase;
    const BroadphaseRay ray{{0, 0, 0}, {1, 0, 0}};
    const ClosestRay closest{{0, 0, 0}, {1, 0, 0}};
    EXPECT_THROW(broadphase.rayTests(std::span(&ray, 1)), BrokenAssert);
    EXPECT_THROW(broadphase.closestRays(std::span(&closest, 1)), BrokenAssert);
}

#endif

}  // namespace
}  // namespace hashphase::test
