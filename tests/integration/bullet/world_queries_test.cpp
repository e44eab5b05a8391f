// SPDX-License-Identifier: Zlib
//
// What a program asks a btCollisionWorld: the same answers as over btDbvtBroadphase.

#include <tests/integration/bullet/bullet_scenes.hpp>
#include <tests/integration/bullet/dynamics.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr std::uint64_t kSeed = 4;

/// Number of the body, and how far along: the same bits are expected.
using Hits = std::vector<std::pair<int, btScalar>>;

Hits inOrder(Hits hits) {
    std::sort(hits.begin(), hits.end());
    return hits;
}

struct AllSweepHits : btCollisionWorld::ConvexResultCallback {
    btScalar addSingleResult(btCollisionWorld::LocalConvexResult& result, bool) override {
        hits.emplace_back(result.m_hitCollisionObject->getUserIndex(), result.m_hitFraction);
        return m_closestHitFraction;
    }
    Hits hits;
};

/// Contacts that penetrate; fat boxes show btDbvtBroadphase some that do not touch.
struct Contacts : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                             const btCollisionObjectWrapper* b, int, int) override {
        if (point.getDistance() <= 0) {
            const int first = a->getCollisionObject()->getUserIndex();
            const int second = b->getCollisionObject()->getUserIndex();
            hits.emplace_back(first * 1000 + second, point.getDistance());
        }
        return 0;
    }
    Hits hits;
};

/// Two equal worlds, a pile fallen for a while under btDbvtBroadphase and put into ours as it lay.
class WorldQueries : public testing::Test {
protected:
    WorldQueries() {
        const DynamicsScene& pile = dynamicsScenes().front();
        pile.build(dbvt);
        pile.build(hash);
        for (int step = 0; step < 120; ++step) {
            dbvt.step();
        }
        for (int i = 0; i < dbvt.bodyCount(); ++i) {
            hash.body(i).setWorldTransform(dbvt.body(i).getWorldTransform());
            hash.body(i).setInterpolationWorldTransform(dbvt.body(i).getWorldTransform());
        }
        for (DynamicsWorld* const scene : {&dbvt, &hash}) {
            scene->world().updateAabbs();
        }
    }

    std::pair<btVector3, btVector3> someSegment() {
        return {random.vector(-6, 6), random.vector(-6, 6)};
    }

    DynamicsWorld dbvt{std::make_unique<btDbvtBroadphase>()};
    DynamicsWorld hash{std::make_unique<SpatialHashBroadphase>()};
    BulletRandom random{kSeed};
};

TEST_F(WorldQueries, ByRayFindTheSameHitsAsOverBtDbvtBroadphase) {
    std::size_t hitCount = 0;
    for (int i = 0; i < 400; ++i) {
        const auto [from, to] = someSegment();
        Hits found[2];
        for (DynamicsWorld* const scene : {&dbvt, &hash}) {
            btCollisionWorld::AllHitsRayResultCallback all(from, to);
            scene->world().rayTest(from, to, all);
            Hits& hits = found[scene == &hash];
            for (int k = 0; k < all.m_collisionObjects.size(); ++k) {
                hits.emplace_back(all.m_collisionObjects[k]->getUserIndex(), all.m_hitFractions[k]);
            }
        }
        ASSERT_EQ(inOrder(found[1]), inOrder(found[0])) << "ray " << i;
        hitCount += found[0].size();
    }
    EXPECT_GT(hitCount, 400U);
}

TEST_F(WorldQueries, ByRayFindTheSameClosestHitAsOverBtDbvtBroadphase) {
    for (int i = 0; i < 400; ++i) {
        const auto [from, to] = someSegment();
        btCollisionWorld::ClosestRayResultCallback closest[2]{{from, to}, {from, to}};
        dbvt.world().rayTest(from, to, closest[0]);
        hash.world().rayTest(from, to, closest[1]);
        ASSERT_EQ(closest[1].hasHit(), closest[0].hasHit()) << "ray " << i;
        ASSERT_EQ(closest[1].m_closestHitFraction, closest[0].m_closestHitFraction) << "ray " << i;
    }
}

TEST_F(WorldQueries, BySweepFindTheSameHitsAsOverBtDbvtBroadphase) {
    const btBoxShape box({btScalar(0.3), btScalar(0.5), btScalar(0.2)});
    std::size_t hitCount = 0;
    for (int i = 0; i < 200; ++i) {
        const auto [start, end] = someSegment();
        const btTransform from(btQuaternion(random.direction(), random.uniform(0, 3)), start);
        const btTransform to(from.getRotation(), i % 20 == 0 ? start : end);
        AllSweepHits found[2];
        dbvt.world().convexSweepTest(&box, from, to, found[0]);
        hash.world().convexSweepTest(&box, from, to, found[1]);
        ASSERT_EQ(inOrder(found[1].hits), inOrder(found[0].hits)) << "sweep " << i;
        hitCount += found[0].hits.size();
    }
    EXPECT_GT(hitCount, 200U);
}

TEST_F(WorldQueries, ByContactFindTheSamePenetrationsAsOverBtDbvtBroadphase) {
    btBoxShape box({1, btScalar(0.5), 1});
    std::size_t hitCount = 0;
    for (int i = 0; i < 200; ++i) {
        btCollisionObject probe;
        probe.setCollisionShape(&box);
        probe.setUserIndex(999);
        probe.setWorldTransform(
            btTransform(btQuaternion(random.direction(), 1), random.vector(-4, 4)));
        Contacts found[2];
        dbvt.world().contactTest(&probe, found[0]);
        hash.world().contactTest(&probe, found[1]);
        ASSERT_EQ(inOrder(found[1].hits), inOrder(found[0].hits)) << "probe " << i;
        hitCount += found[0].hits.size();
    }
    EXPECT_GT(hitCount, 200U);
}

}  // namespace
}  // namespace hashphase::test
