// SPDX-License-Identifier: Zlib
//
// Many bodies at one place, which groups and masks keep from pairing: they cost what their boxes do. And
// groups and masks that are written without a word.

#include <tests/integration/bullet/broadphases.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

using Proxy = btBroadphaseProxy;

constexpr int kAll = Proxy::AllFilter;
constexpr int kStatic = Proxy::StaticFilter;

struct Kind {
    const char* name;
    int group;
    int mask;
    bool meetsOthers;
};
constexpr Kind kKinds[] = {{"parked", 1, 0, false},
                           {"static", kStatic, kAll ^ kStatic, true},
                           {"debris", 1, 2, false},
                           {"of no group", 0, kAll, false}};

struct RefuseAll : btOverlapFilterCallback {
    bool needBroadphaseCollision(Proxy* /*a*/, Proxy* /*b*/) const override { return false; }
};
struct AcceptAll : btOverlapFilterCallback {
    bool needBroadphaseCollision(Proxy* /*a*/, Proxy* /*b*/) const override { return true; }
};

struct Pool {
    Pool(int count, const Kind& kind, btScalar apart, const SpatialHashConfig& config = {})
        : broadphase(config) {
        for (int i = 0; i < count; ++i) {
            const btVector3 at(apart * btScalar(i % 100), 0, apart * btScalar(i / 100));
            proxies.push_back(broadphase.createProxy(at, at + btVector3(2, 2, 2), 0, nullptr,
                                                     kind.group, kind.mask, nullptr));
        }
    }
    std::uint64_t step() {
        for (Proxy* proxy : proxies) {
            broadphase.setAabb(proxy, proxy->m_aabbMin, proxy->m_aabbMax, nullptr);
        }
        broadphase.calculateOverlappingPairs(nullptr);
        return broadphase.lastCost().boxesTested;
    }
    [[nodiscard]] int pairs() {
        return broadphase.getOverlappingPairCache()->getNumOverlappingPairs();
    }

    SpatialHashBroadphase broadphase;
    std::vector<Proxy*> proxies;
};

TEST(ParkedBodies, CostWhatTheirBoxesDoWhenTheyLieAtOnePlace) {
    constexpr int kCount = 10000;
    for (const Kind& kind : kKinds) {
        SCOPED_TRACE(kind.name);
        Pool pool(kCount, kind, 0);
        Pool apart(kCount, kind, 3);
        for (int frame = 0; frame < 20; ++frame) {
            EXPECT_LE(pool.step(), apart.step() + 50 * kCount);
        }
        EXPECT_LE(pool.broadphase.memoryBytes(), apart.broadphase.memoryBytes() + (1U << 20));
        EXPECT_EQ(pool.pairs(), 0);
        EXPECT_EQ(pool.broadphase.validate(), "");
    }
}

TEST(ParkedBodies, ComeIntoPlayAndGoBackWhenTheirMaskIsWrittenAndTheyAreMoved) {
    for (const Kind& kind : kKinds) {
        SCOPED_TRACE(kind.name);
        Pool pool(1000, kind, 0);
        Proxy* const ground = pool.broadphase.createProxy({-9, 18, -9}, {99, 20, 99}, 0, nullptr,
                                                          kStatic, kAll ^ kStatic, nullptr);
        for (int frame = 0; frame < 20; ++frame) {
            pool.step();
        }
        Proxy& body = *pool.proxies[7];
        body.m_collisionFilterGroup = 1;
        body.m_collisionFilterMask = kAll;
        pool.broadphase.setAabb(&body, {9, 19, 9}, {11, 21, 11}, nullptr);
        pool.broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(pool.pairs(), 1);
        EXPECT_NE(pool.broadphase.getOverlappingPairCache()->findPair(&body, ground), nullptr);
        EXPECT_LE(pool.broadphase.lastCost().boxesTested, 20 * 1000U);
        body.m_collisionFilterGroup = kind.group;
        body.m_collisionFilterMask = kind.mask;
        pool.broadphase.setAabb(&body, {0, 0, 0}, {2, 2, 2}, nullptr);
        pool.broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(pool.pairs(), 0);
        EXPECT_EQ(pool.broadphase.validate(), "");
    }
}

TEST(ParkedBodies, AreFoundByQueries) {
    struct Count : btBroadphaseAabbCallback {
        bool process(const Proxy* /*proxy*/) override { return ++count > 0; }
        int count = 0;
    } found;
    Pool pool(1000, kKinds[0], 0);
    pool.step();
    pool.broadphase.aabbTest({1, 1, 1}, {1, 1, 1}, found);
    EXPECT_EQ(found.count, 1000);
}

TEST(ParkedBodies, CostNothingUnderACallbackThatRefusesMoreThanMasksDo) {
    SpatialHashConfig config;
    config.filterRefusesMore = true;
    constexpr int kCount = 10000;
    AcceptAll filter;
    Pool pool(0, kKinds[0], 0, config);
    pool.broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&filter);
    for (int i = 0; i < kCount; ++i) {
        pool.proxies.push_back(
            pool.broadphase.createProxy({0, 0, 0}, {2, 2, 2}, 0, nullptr, 1, 0, nullptr));
    }
    EXPECT_LE(pool.step(), 50U * kCount);
    EXPECT_LE(pool.broadphase.memoryBytes(), 8U << 20);
    EXPECT_EQ(pool.pairs(), 0);
}

TEST(ParkedBodies, ThatOnlyACallbackRefusesTakeNoMemoryForThat) {
    constexpr int kCount = 3000;
    struct RefuseAndCount : RefuseAll {
        bool needBroadphaseCollision(Proxy* a, Proxy* b) const override {
            ++count;
            return RefuseAll::needBroadphaseCollision(a, b);
        }
        mutable std::size_t count = 0;
    } filter;
    Pool pool(0, kKinds[0], 0);
    pool.broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&filter);
    for (int i = 0; i < kCount; ++i) {
        pool.proxies.push_back(
            pool.broadphase.createProxy({0, 0, 0}, {2, 2, 2}, 0, nullptr, 1, kAll, nullptr));
    }
    pool.step();
    EXPECT_LE(pool.broadphase.memoryBytes(), 8U << 20);
    EXPECT_EQ(filter.count, std::size_t{kCount} * (kCount - 1) / 2);
    filter.count = 0;
    pool.broadphase.setAabb(pool.proxies[5], {0, 0, 0}, {2, 3, 2}, nullptr);
    pool.step();
    EXPECT_EQ(filter.count, kCount - 1U);
    EXPECT_LE(pool.broadphase.lastCost().boxesTested, 20U * kCount);
    EXPECT_EQ(pool.pairs(), 0);
    EXPECT_EQ(pool.broadphase.validate(), "");
}

// --- Written without a word ----------------------------------------------------------------------

const Box kHere = boxAround({0, 0, 0}, {1, 1, 1});
const Box kBeside = boxAround({1, 0, 0}, {1, 1, 1});
const Box kThere = boxAround({9, 0, 0}, {1, 1, 1});

/// A player over our broadphase, or over Bullet's, as exact as ours.
Player playerOf(bool isOurs) {
    return isOurs ? hashPlayer(6) : Player(6, std::make_unique<ExactDbvt>());
}

TEST(WrittenMasks, CountWhenEitherOfTheTwoMovesAsUnderDbvt) {
    for (const bool isOurs : {false, true}) {
        for (const int moved : {0, 1}) {
            for (const int stepsBefore : {1, 40}) {
                SCOPED_TRACE(testing::Message() << isOurs << moved << stepsBefore);
                Player player = playerOf(isOurs);
                player.play({Action::create, 0, kHere, 1, 0});
                player.play({Action::create, 1, kThere, 1, kAll});
                for (int i = 0; i < stepsBefore; ++i) {
                    player.calculate();
                }
                player.proxy(0)->m_collisionFilterMask = kAll;
                player.calculate();
                EXPECT_EQ(player.pairs(), ObjectPairs{});
                player.play({Action::set, moved, moved == 0 ? kThere : kHere, 0, 0});
                player.calculate();
                EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
            }
        }
    }
}

TEST(WrittenMasks, CountWhenTheBoxIsSetToWhatItWas) {
    Player player = hashPlayer(6);
    player.play({Action::create, 0, kHere, 1, 0});
    player.play({Action::create, 1, kBeside, 1, kAll});
    for (int i = 0; i < 20; ++i) {
        player.calculate();
    }
    player.proxy(0)->m_collisionFilterMask = kAll;
    player.play({Action::set, 0, kHere, 0, 0});
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    player.proxy(0)->m_collisionFilterMask = 0;
    player.play({Action::set, 0, kHere, 0, 0});
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}})) << "A pair stays one until its boxes part.";
    player.play({Action::set, 0, kThere, 0, 0});
    player.calculate();
    EXPECT_EQ(player.pairs(), ObjectPairs{});
}

TEST(WrittenMasks, BringEagerPairsAtOnce) {
    SpatialHashConfig config;
    config.eagerGroups = Proxy::SensorTrigger;
    Player player = hashPlayer(6, nullptr, config);
    player.play({Action::create, 0, kHere, Proxy::SensorTrigger, 0});
    player.play({Action::create, 1, kBeside, 1, kAll});
    player.calculate();
    EXPECT_EQ(player.pairs(), ObjectPairs{});
    player.proxy(0)->m_collisionFilterMask = kAll;
    player.play({Action::set, 0, kHere, 0, 0});
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    player.calculate();
    EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}}));
    EXPECT_EQ(hashOf(player).validate(), "");
}

// --- Callbacks that come and go ------------------------------------------------------------------

TEST(LateCallbacks, DecideInPlaceOfGroupsAndMasks) {
    for (const bool isHashed : {false, true}) {
        Player player =
            hashPlayer(6, isHashed ? std::make_unique<btHashedOverlappingPairCache>() : nullptr);
        AcceptAll accept;
        RefuseAll refuse;
        player.play({Action::create, 0, kHere, 1, 0});
        player.play({Action::create, 1, kBeside, 1, kAll});
        player.play({Action::create, 2, kHere, 1, kAll});
        player.calculate();
        EXPECT_EQ(player.pairs(), (ObjectPairs{{1, 2}}));
        player.cache().setOverlapFilterCallback(&accept);
        hashOf(player).refilterAll(nullptr);
        EXPECT_EQ(player.pairs(), (ObjectPairs{{0, 1}, {0, 2}, {1, 2}}));
        player.cache().setOverlapFilterCallback(&refuse);
        hashOf(player).refilterAll(nullptr);
        EXPECT_EQ(player.pairs(), ObjectPairs{});
        player.cache().setOverlapFilterCallback(nullptr);
        player.calculate();
        hashOf(player).refilterAll(nullptr);
        EXPECT_EQ(player.pairs(), (ObjectPairs{{1, 2}}));
        player.calculate();
        EXPECT_EQ(player.pairs(), (ObjectPairs{{1, 2}}));
        EXPECT_EQ(hashOf(player).validate(), "");
    }
}

/// Of a kind that Bullet does not know, and takes the two whatever their masks.
struct OwnCache : btHashedOverlappingPairCache {
    bool needsBroadphaseCollision(Proxy* /*a*/, Proxy* /*b*/) const { return true; }
};

TEST(LateCallbacks, AreNotNeededByACacheThatDecidesItself) {
    Player player = hashPlayer(6, std::make_unique<OwnCache>());
    player.play({Action::create, 0, kHere, 1, 0});
    player.play({Action::create, 1, kBeside, 1, 0});
    player.calculate();
    EXPECT_EQ(hashOf(player).validate(), "");
    EXPECT_EQ(hashOf(player).lastCost().pairsWatched, 0U);
    player.play({Action::set, 0, kBeside, 0, 0});
    player.calculate();
    EXPECT_EQ(hashOf(player).lastCost().pairsWatched, 1U) << "the cache was asked";
}

// --- Filtering many again ------------------------------------------------------------------------

TEST(RefilterMany, OfBulletsProxiesAsksOnceAboutEachTwo) {
    struct Counting : btOverlapFilterCallback {
        bool needBroadphaseCollision(Proxy* /*a*/, Proxy* /*b*/) const override {
            ++count;
            return answer;
        }
        mutable int count = 0;
        bool answer = true;
    } filter;
    Pool pool(0, kKinds[0], 0);
    pool.broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&filter);
    for (int i = 0; i < 1000; ++i) {
        const btVector3 at(btScalar(1.5) * btScalar(i), 0, 0);
        pool.proxies.push_back(
            pool.broadphase.createProxy(at, at + btVector3(2, 2, 2), 0, nullptr, 1, kAll, nullptr));
    }
    pool.step();
    ASSERT_EQ(pool.pairs(), 999);
    for (const bool areAll : {true, false}) {
        filter.answer = !filter.answer;
        filter.count = 0;
        if (areAll) {
            pool.broadphase.refilterAll(nullptr);
        } else {
            pool.broadphase.refilter(pool.proxies, nullptr);
        }
        EXPECT_EQ(filter.count, 999);
        EXPECT_EQ(pool.pairs(), filter.answer ? 999 : 0);
        EXPECT_EQ(pool.broadphase.validate(), "");
    }
}

}  // namespace
}  // namespace hashphase::test
