// SPDX-License-Identifier: Zlib

// What a caller of the broadphase or of its pair cache may not do is asserted, and changes nothing in
// programs that are compiled without assertions.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/cache_side.hpp>
#include <tests/support/handlers.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>

namespace hashphase::test {
namespace {

#if HASHPHASE_ENABLE_ASSERTS

const Box kThisPlace = boxAround({0, 0, 0}, {1, 1, 1});
constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();

struct Misuse {
    const char* sentence;  // a part of the assertion's
    std::function<void()> call;
};

void expectAsserted(const std::vector<Misuse>& all) {
    const ThrowingAsserts throwing;
    for (std::size_t i = 0; i < all.size(); ++i) {
        try {
            all[i].call();
            ADD_FAILURE() << i << " is not asserted: " << all[i].sentence;
        } catch (const BrokenAssert& broken) {
            EXPECT_NE(std::string(broken.what()).find(all[i].sentence), std::string::npos)
                << i << ": " << broken.what();
        }
    }
}

// --- The pair cache ------------------------------------------------------------------------------

TEST(PairCacheMisuse, OfProxiesWithTheSameUniqueIdOrOfNoKeyIsAsserted) {
    CacheSide side;
    side.add(1, 2);
    side.proxies[3].m_uniqueId = 1;
    side.proxies[4].m_uniqueId = 2;
    const std::vector<BulletProxyPair> same = side.pairs({{3, 4}});
    expectAsserted({{"", [&] { side.cache.addAcceptedPair(side.proxy(3), side.proxy(4)); }},
                    {"", [&] { side.cache.update({}, same, nullptr); }},
                    {"", [] { PairCache(PairOrder::canonical, nullptr); }}});
    EXPECT_EQ(side.cache.getNumOverlappingPairs(), 1);
}

TEST(PairCacheMisuse, OfAFilterThatChangesIsAsserted) {
    CacheSide side;
    PairCache& cache = side.cache;
    side.add(1, 3);
    FilterBy filter([&](btBroadphaseProxy& a, btBroadphaseProxy& b) {
        const BulletProxyPair pair(a, b);
        btBroadphaseProxy* const one = &a;
        expectAsserted({{"", [&] { cache.addAcceptedPair(&a, &b); }},
                        {"", [&] { cache.update({}, std::span(&pair, 1), nullptr); }},
                        {"", [&] { cache.removeOverlappingPair(&a, side.proxy(3), nullptr); }},
                        {"", [&] { cache.removeOverlappingPairsContainingProxy(&a, nullptr); }},
                        {"", [&] {
                             cache.removeOverlappingPairsContainingProxies(std::span(&one, 1),
                                                                           nullptr);
                         }}});
        return true;
    });
    cache.setOverlapFilterCallback(&filter);
    EXPECT_NE(side.add(1, 2), nullptr);
    EXPECT_EQ(filter.asked, 1U);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 2);
    EXPECT_EQ(cache.validate(), "");
}

TEST(ProxyRanksMisuse, OfNobodyFindsNobody) {
    EXPECT_EQ(detail::ProxyRanks().lowestRank(1, 2), detail::ProxyRanks::kNone);
}

// --- The broadphase ------------------------------------------------------------------------------

TEST(BroadphaseMisuse, IsAsserted) {
    CacheSide full;
    full.add(1, 2);
    Boxes boxes;
    Boxes other;
    SpatialHashBroadphase& broadphase = boxes.broadphase;
    btBroadphaseProxy* const alive = boxes.create(kThisPlace);
    btBroadphaseProxy* const foreign = other.create(kThisPlace);
    btBroadphaseProxy* const dead = boxes.create(kThisPlace);
    const ProxyId deadId = SpatialHashBroadphase::idOf(dead);
    boxes.destroy(dead);
    const BroadphaseRay ray{{0, 0, 0}, {1, 0, 0}};
    const ClosestRay closest{{0, 0, 0}, {1, 0, 0}};
    std::array<btBroadphaseProxy*, 2> two{alive, nullptr};
    const std::array twice{alive, alive};
    const std::vector<ProxyDefinition> three(3);
    const std::vector<btVector3> one(1, btVector3(0, 0, 0));
    const std::vector<btVector3> both(2, btVector3(0, 0, 0));
    const char* const notOurs = "null, destroyed or of another broadphase";
    const char* const badMargin = "the margin is negative, NaN or infinite";
    Box box;
    expectAsserted(
        {{"already has pairs", [&] { SpatialHashBroadphase{&full.cache}; }},
         {notOurs, [&] { broadphase.destroyProxy(dead, nullptr); }},
         {notOurs, [&] { broadphase.destroyProxy(nullptr, nullptr); }},
         {notOurs, [&] { boxes.set(dead, kThisPlace); }},
         {notOurs, [&] { broadphase.refilter(dead, nullptr); }},
         {notOurs, [&] { broadphase.ignorePair(alive, dead, nullptr); }},
         {notOurs, [&] { broadphase.stopIgnoringPair(dead, alive, nullptr); }},
         {notOurs, [&] { broadphase.collisionChecksChanged(dead, nullptr); }},
         {notOurs, [&] { broadphase.setMargin(dead, 1, nullptr); }},
         {notOurs, [&] { static_cast<void>(broadphase.margin(nullptr)); }},
         {badMargin, [&] { broadphase.setMargin(alive, btScalar(-0.1), nullptr); }},
         {badMargin, [&] { broadphase.setMargin(alive, kInfinity, nullptr); }},
         {badMargin, [&] { broadphase.setMargin(alive, kInfinity - kInfinity, nullptr); }},
         {"both proxies are the same", [&] { broadphase.ignorePair(alive, alive, nullptr); }},
         {"", [&] { broadphase.getAabb(dead, box.min, box.max); }},
         {"", [&] { broadphase.getAabb(nullptr, box.min, box.max); }},
         {"", [&] { static_cast<void>(SpatialHashBroadphase::idOf(nullptr)); }},
         {"proxyOf(): the id is null, stale, or of another broadphase",
          [&] { static_cast<void>(broadphase.proxyOf(deadId)); }},
         {notOurs, [&] { broadphase.destroyProxy(foreign, nullptr); }},
         {notOurs, [&] { boxes.set(foreign, kThisPlace); }},
         {notOurs, [&] { broadphase.ignorePair(foreign, alive, nullptr); }},
         {notOurs, [&] { broadphase.destroyProxies(std::span(&foreign, 1), nullptr); }},
         {notOurs, [&] { broadphase.setAabbs(std::span(&foreign, 1), one, one, nullptr); }},
         {notOurs, [&] { broadphase.destroyProxies(two, nullptr); }},
         {"one proxy for each definition", [&] { broadphase.createProxies(three, two, nullptr); }},
         {"one box for each proxy",
          [&] { broadphase.setAabbs(std::span(&alive, 1), both, one, nullptr); }},
         {"one box for each proxy",
          [&] { broadphase.setAabbs(std::span(&alive, 1), one, both, nullptr); }},
         {"", [&] { broadphase.rayTests(std::span(&ray, 1)); }},
         {"", [&] { broadphase.closestRays(std::span(&closest, 1)); }},
         {"a proxy is named twice", [&] { broadphase.destroyProxies(twice, nullptr); }}});
    boxes.proxies.clear();  // the last call has destroyed it, once
}

TEST(BroadphaseMisuse, OfResetPoolByACallbackIsAsserted) {
    const ThrowingAsserts throwing;
    Boxes boxes;
    boxes.create(kThisPlace);
    ReportTo<btBroadphaseAabbCallback> report([&](btBroadphaseProxy* proxy) {
        boxes.broadphase.resetPool(nullptr);  // a proxy is alive: does nothing
        boxes.destroy(proxy);
        EXPECT_THROW(boxes.broadphase.resetPool(nullptr), BrokenAssert);
    });
    boxes.broadphase.aabbTest(kThisPlace.min, kThisPlace.max, report);
    EXPECT_EQ(boxes.broadphase.grid().size(), 0U);
    boxes.broadphase.resetPool(nullptr);
    EXPECT_EQ(boxes.create(kThisPlace)->getUid(), 1);
}

#endif

TEST(BroadphaseMisuse, OfProxiesThatAreNotAliveChangesNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    const Box place = boxAround({0, 0, 0}, {1, 1, 1});
    Boxes boxes;
    for (int i = 0; i < 3; ++i) {
        boxes.create(place);
    }
    boxes.step();
    btBroadphaseProxy* const dead = boxes.proxies[1];
    const ProxyId deadId = SpatialHashBroadphase::idOf(dead);
    boxes.destroy(dead);
    boxes.broadphase.destroyProxy(dead, nullptr);
    boxes.set(dead, {{5, 5, 5}, {6, 6, 6}});
    boxes.broadphase.refilter(dead, nullptr);
    boxes.broadphase.ignorePair(boxes.proxies[0], dead, nullptr);
    boxes.broadphase.ignorePair(boxes.proxies[0], boxes.proxies[0], nullptr);
    boxes.broadphase.collisionChecksChanged(dead, nullptr);
    boxes.broadphase.setMargin(dead, 9, nullptr);
    boxes.broadphase.setMargin(boxes.proxies[0], -1, nullptr);
    EXPECT_EQ(boxes.broadphase.margin(boxes.proxies[0]), 0);
    EXPECT_EQ(boxes.broadphase.proxyOf(deadId), nullptr);
    EXPECT_EQ(boxes.broadphase.proxyOf(ProxyId{}), nullptr);
    boxes.check();
    EXPECT_EQ(boxes.pairCount(), 1);
    for (const btBroadphaseProxy* alive : boxes.proxies) {
        EXPECT_TRUE(isSame(boxOf(*alive), place));
    }
    EXPECT_GE(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 10 : 0);
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

}  // namespace
}  // namespace hashphase::test
