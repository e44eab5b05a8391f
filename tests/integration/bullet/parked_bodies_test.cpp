// SPDX-License-Identifier: Zlib
//
// Many bodies at one place, which groups and masks keep from pairing: they cost what their boxes do.

#include <tests/integration/bullet/boxes.hpp>

#include <gtest/gtest.h>

namespace hashphase::test {
namespace {

constexpr int kAll = btBroadphaseProxy::AllFilter;
constexpr int kStatic = btBroadphaseProxy::StaticFilter;

const Box kPlace{{0, 0, 0}, {2, 2, 2}};

struct Kind {
    const char* name;
    int group;
    int mask;
};
constexpr Kind kKinds[] = {{"parked", 1, 0},
                           {"static", kStatic, kAll ^ kStatic},
                           {"debris", 1, 2},
                           {"of no group", 0, kAll}};

struct Pool : Boxes {
    using Boxes::Boxes;
    void fill(int count, const Kind& kind, btScalar apart = 0) {
        for (int i = 0; i < count; ++i) {
            const btVector3 by(apart * btScalar(i % 100), 0, apart * btScalar(i / 100));
            create({kPlace.min + by, kPlace.max + by}, kind.group, kind.mask);
        }
    }
    /// Sets each box to what it is, as btCollisionWorld does; returns how many were tested.
    std::uint64_t boxesTestedInStep() {
        for (btBroadphaseProxy* proxy : proxies) {
            set(proxy, boxOf(*proxy));
        }
        step();
        return broadphase.lastCost().boxesTested;
    }
};

TEST(ParkedBodies, CostWhatTheirBoxesDoWhenTheyLieAtOnePlace) {
    constexpr int kCount = 10000;
    for (const Kind& kind : kKinds) {
        SCOPED_TRACE(kind.name);
        Pool pool;
        pool.fill(kCount, kind);
        Pool apart;
        apart.fill(kCount, kind, 3);
        for (int frame = 0; frame < 20; ++frame) {
            EXPECT_LE(pool.boxesTestedInStep(), apart.boxesTestedInStep() + 50 * kCount);
        }
        EXPECT_LE(pool.broadphase.memoryBytes(), apart.broadphase.memoryBytes() + (1U << 20));
        EXPECT_EQ(pool.pairCount(), 0);
        EXPECT_EQ(pool.broadphase.validate(), "");
    }
}

TEST(ParkedBodies, ComeIntoPlayAndGoBackWhenTheirMaskIsWrittenAndTheyAreMoved) {
    for (const Kind& kind : kKinds) {
        SCOPED_TRACE(kind.name);
        Pool pool;
        pool.fill(1000, kind);
        btBroadphaseProxy* const ground =
            pool.create({{-9, 18, -9}, {99, 20, 99}}, kStatic, kAll ^ kStatic);
        for (int frame = 0; frame < 20; ++frame) {
            pool.boxesTestedInStep();
        }
        btBroadphaseProxy& body = *pool.proxies[7];
        body.m_collisionFilterGroup = 1;
        body.m_collisionFilterMask = kAll;
        pool.set(&body, {{9, 19, 9}, {11, 21, 11}});
        pool.step();
        EXPECT_EQ(pool.pairCount(), 1);
        EXPECT_NE(pool.cache.findPair(&body, ground), nullptr);
        EXPECT_LE(pool.broadphase.lastCost().boxesTested, 20 * 1000U);
        body.m_collisionFilterGroup = kind.group;
        body.m_collisionFilterMask = kind.mask;
        pool.set(&body, kPlace);
        pool.check();
        EXPECT_EQ(pool.pairCount(), 0);
    }
}

TEST(ParkedBodies, AreFoundByQueries) {
    Pool pool;
    pool.fill(1000, kKinds[0]);
    pool.boxesTestedInStep();
    ReportTo<btBroadphaseAabbCallback> report;
    pool.broadphase.aabbTest({1, 1, 1}, {1, 1, 1}, report);
    EXPECT_EQ(report.found.size(), 1000U);
}

TEST(ParkedBodies, CostNothingUnderACallbackThatRefusesMoreThanMasksDo) {
    FilterBy accept(true);
    SpatialHashConfig config;
    config.filterRefusesMore = true;
    constexpr int kCount = 10000;
    Pool pool(config);
    pool.cache.setOverlapFilterCallback(&accept);
    pool.fill(kCount, kKinds[0]);
    EXPECT_LE(pool.boxesTestedInStep(), 50U * kCount);
    EXPECT_LE(pool.broadphase.memoryBytes(), 8U << 20);
    EXPECT_EQ(pool.pairCount(), 0);
}

TEST(ParkedBodies, ThatOnlyACallbackRefusesTakeNoMemoryForThat) {
    constexpr int kCount = 3000;
    FilterBy refuse(false);
    Pool pool;
    pool.cache.setOverlapFilterCallback(&refuse);
    pool.fill(kCount, {"in play", 1, kAll});
    pool.boxesTestedInStep();
    EXPECT_LE(pool.broadphase.memoryBytes(), 8U << 20);
    EXPECT_EQ(refuse.asked, std::size_t{kCount} * (kCount - 1) / 2);
    refuse.asked = 0;
    pool.set(pool.proxies[5], {{0, 0, 0}, {2, 3, 2}});
    EXPECT_LE(pool.boxesTestedInStep(), 20U * kCount);
    EXPECT_EQ(refuse.asked, kCount - 1U);
    EXPECT_EQ(pool.pairCount(), 0);
    EXPECT_EQ(pool.broadphase.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
