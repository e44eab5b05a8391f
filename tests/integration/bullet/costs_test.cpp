// SPDX-License-Identifier: Zlib
//
// Costs that are promised, by counting, never by the clock.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/queries.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace hashphase::test {
namespace {

/// `count` boxes so thin in space that each has a few neighbours.
void fill(Player& player, int count, std::uint64_t seed) {
    BulletRandom random(seed);
    const double half = std::cbrt(count) * 0.55;
    for (int object = 0; object < count; ++object) {
        player.create(object, boxAround(random.vector(-half, half), random.vector(0.3, 0.6)));
    }
    player.calculate();
}

const PairCost& costOf(const Player& player) {
    return hashOf(player).lastCost();
}

void move(Player& player, int object, const btVector3& by) {
    const btBroadphaseProxy& proxy = *player.proxy(object);
    player.set(object, {proxy.m_aabbMin + by, proxy.m_aabbMax + by});
}

TEST(RemovalCost, OfAThousandInFiftyThousandIsThatOfTheirPairsUnderOursAndDbvt) {
    constexpr int kObjects = 50'000;
    for (const bool isOurs : {true, false}) {
        auto owned = std::make_unique<PairCache>();
        PairCache& cache = *owned;
        std::unique_ptr<btBroadphaseInterface> broadphase;
        if (isOurs) {
            broadphase = hashOver(&cache);
        } else {
            broadphase = std::make_unique<btDbvtBroadphase>(&cache);
        }
        Player player(kObjects, std::move(broadphase), std::move(owned));
        fill(player, kObjects, 1);
        const ObjectPairs before = player.pairs();
        ASSERT_GT(before.size(), 50'000U);
        std::uint64_t theirPairs = 0;
        for (const auto& [a, b] : before) {
            theirPairs += a % 50 == 0 || b % 50 == 0;
        }
        const std::uint64_t visitedBefore = cache.pairsVisited();
        for (int object = 0; object < kObjects; object += 50) {
            player.destroy(object);
        }
        EXPECT_EQ(player.pairs().size(), before.size() - theirPairs);
        EXPECT_EQ(cache.pairsVisited() - visitedBefore, theirPairs);
        EXPECT_EQ(cache.validate(), "");
    }
}

TEST(StepCost, OfAWorldAtRestIsNothing) {
    constexpr int kObjects = 20'000;
    Player player = hashPlayer(kObjects);
    fill(player, kObjects, 2);
    for (int step = 0; step < 30; ++step) {
        for (int object = 0; object < kObjects; ++object) {
            move(player, object, {0, 0, 0});  // as btCollisionWorld does for everything
        }
        player.calculate();
        EXPECT_EQ(costOf(player).grid.changed, 0U);
    }
    EXPECT_EQ(costOf(player).grid.filed, 0U);
    EXPECT_EQ(costOf(player).boxesTested, 0U);
    EXPECT_EQ(costOf(player).pairsWatched, 0U);
}

TEST(StepCost, FollowsWhatMovesAmongManyAtRest) {
    constexpr int kObjects = 20'000;
    constexpr int kMoving = 100;
    Player player = hashPlayer(kObjects);
    fill(player, kObjects, 3);
    BulletRandom random(4);
    for (int step = 0; step < 40; ++step) {
        for (int object = 0; object < kMoving; ++object) {
            move(player, object, random.vector(-0.2, 0.2));
        }
        player.calculate();
        EXPECT_EQ(costOf(player).grid.changed, unsigned(kMoving));
        if (step >= 20) {
            EXPECT_LE(costOf(player).grid.filed, 2U * kMoving) << "step " << step;
            EXPECT_LE(costOf(player).boxesTested, 200U * kMoving) << "step " << step;
            EXPECT_LE(costOf(player).pairsWatched, 20U * kMoving) << "step " << step;
        }
    }
}

// A query must not pay for a rebuild after every box that is set.
TEST(QueryCost, OfSettingABoxAndCastingARayInTurnIsNoRebuildEach) {
    constexpr int kObjects = 30'000;
    constexpr int kTurns = 1000;
    Player player = hashPlayer(kObjects);
    fill(player, kObjects, 5);
    BulletRandom random(6);
    std::size_t seen = 0;
    for (int turn = 0; turn < kTurns; ++turn) {
        const int object = random.below(kObjects);
        move(player, object, random.vector(-3, 3));
        const btBroadphaseProxy& proxy = *player.proxy(object);
        const Ray ray{proxy.m_aabbMin - btVector3(1, 1, 1), proxy.m_aabbMax};
        CollectRay byRay(ray);
        player.broadphase().rayTest(ray.from, ray.to, byRay);
        seen += std::count(byRay.found.begin(), byRay.found.end(), object) == 1;
    }
    EXPECT_EQ(seen, unsigned(kTurns));
    player.calculate();
    // A hundredth of a rebuild for each turn at the most.
    EXPECT_LE(costOf(player).grid.filed, kTurns / 100U * kObjects);
}

}  // namespace
}  // namespace hashphase::test
