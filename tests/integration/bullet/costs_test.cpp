// SPDX-License-Identifier: Zlib
//
// Costs that are promised, by counting, never by the clock.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/queries.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace hashphase::test {
namespace {

/// `count` boxes so thin in space that each has a few neighbours.
void fill(AnyBoxes& boxes, int count, std::uint64_t seed) {
    BulletRandom random(seed);
    const double half = std::cbrt(count) * 0.55;
    for (int i = 0; i < count; ++i) {
        const btVector3 center = random.vector(-half, half);
        boxes.create(boxAround(center, random.vector(0.3, 0.6)));
    }
    boxes.step();
}

TEST(RemovalCost, OfAThousandInFiftyThousandIsThatOfTheirPairsUnderOursAndDbvt) {
    for (const bool isOurs : {true, false}) {
        auto owned = std::make_unique<PairCache>();
        PairCache& cache = *owned;
        AnyBoxes boxes(isOurs ? std::unique_ptr<btBroadphaseInterface>(hashOver(&cache))
                              : std::make_unique<btDbvtBroadphase>(&cache),
                       std::move(owned));
        fill(boxes, 50'000, 1);
        const std::vector<Uids> before = boxes.list();
        ASSERT_GT(before.size(), 50'000U);
        const auto theirPairs = std::ranges::count_if(
            before, [](const Uids& pair) { return pair.first % 50 == 0 || pair.second % 50 == 0; });
        const std::uint64_t visitedBefore = cache.pairsVisited();
        for (std::size_t i = boxes.proxies.size(); i-- > 0;) {
            if (boxes.proxies[i]->m_uniqueId % 50 == 0) {
                boxes.destroy(boxes.proxies[i]);
            }
        }
        EXPECT_EQ(boxes.pairCount(), int(before.size()) - theirPairs);
        EXPECT_EQ(cache.pairsVisited() - visitedBefore, std::uint64_t(theirPairs));
        EXPECT_EQ(cache.validate(), "");
    }
}

TEST(StepCost, OfAWorldAtRestIsNothing) {
    Boxes boxes;
    fill(boxes, 20'000, 2);
    for (int step = 0; step < 30; ++step) {
        for (btBroadphaseProxy* const proxy : boxes.proxies) {
            boxes.set(proxy, boxOf(*proxy));  // as btCollisionWorld does for everything
        }
        boxes.step();
        EXPECT_EQ(boxes.cost().grid.changed, 0U);
    }
    EXPECT_EQ(boxes.cost().grid.filed, 0U);
    EXPECT_EQ(boxes.cost().boxesTested, 0U);
    EXPECT_EQ(boxes.cost().pairsWatched, 0U);
}

TEST(StepCost, FollowsWhatMovesAmongManyAtRest) {
    constexpr std::size_t kMovers = 100;
    Boxes boxes;
    fill(boxes, 20'000, 3);
    BulletRandom random(4);
    for (int step = 0; step < 40; ++step) {
        for (std::size_t i = 0; i < kMovers; ++i) {
            boxes.move(boxes.proxies[i], random.vector(-0.2, 0.2));
        }
        boxes.step();
        EXPECT_EQ(boxes.cost().grid.changed, kMovers);
        if (step >= 20) {
            EXPECT_LE(boxes.cost().grid.filed, 2U * kMovers) << "step " << step;
            EXPECT_LE(boxes.cost().boxesTested, 200U * kMovers) << "step " << step;
            EXPECT_LE(boxes.cost().pairsWatched, 20U * kMovers) << "step " << step;
        }
    }
}

// A query must not pay for a rebuild after every box that is set.
TEST(QueryCost, OfSettingABoxAndCastingARayInTurnIsNoRebuildEach) {
    constexpr int kObjects = 30'000;
    constexpr int kTurns = 1000;
    Boxes boxes;
    fill(boxes, kObjects, 5);
    BulletRandom random(6);
    for (int turn = 0; turn < kTurns; ++turn) {
        btBroadphaseProxy* const proxy = boxes.proxies[std::size_t(random.below(kObjects))];
        boxes.move(proxy, random.vector(-3, 3));
        const Ray ray{proxy->m_aabbMin - btVector3(1, 1, 1), proxy->m_aabbMax};
        ReportTo<btBroadphaseRayCallback> report;
        setFields(report, ray);
        boxes.broadphase.rayTest(ray.from, ray.to, report);
        EXPECT_EQ(std::ranges::count(report.found, proxy), 1);
    }
    boxes.step();
    // A hundredth of a rebuild for each turn at the most.
    EXPECT_LE(boxes.cost().grid.filed, kTurns / 100U * kObjects);
}

}  // namespace
}  // namespace hashphase::test
