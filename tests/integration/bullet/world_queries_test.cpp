// SPDX-License-Identifier: Zlib
//
// What a program asks a btCollisionWorld: the same answers as over btDbvtBroadphase.

#include <tests/integration/bullet/dynamics.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

/// Number of the body, and how far along: the same bits are expected.
using Hits = std::vector<std::pair<int, btScalar>>;

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
        dynamicsScenes().front().build(dbvt);
        dynamicsScenes().front().build(hash);
        dbvt.step(120);
        for (int i = 0; i < dbvt.bodyCount(); ++i) {
            hash.body(i).setWorldTransform(dbvt.body(i).getWorldTransform());
            hash.body(i).setInterpolationWorldTransform(dbvt.body(i).getWorldTransform());
        }
        dbvt.world().updateAabbs();
        hash.world().updateAabbs();
    }

    /// Asks both so often between two random places, and expects so many hits altogether.
    template <class Ask>
    void expectTheSame(int times, std::size_t leastHits, const Ask& ask) {
        std::size_t hitCount = 0;
        for (int i = 0; i < times; ++i) {
            const btVector3 from = random.vector(-6, 6);
            const btVector3 to = random.vector(-6, 6);
            const btQuaternion turn(random.direction(), random.uniform(0, 3));
            Hits expected = ask(dbvt.world(), from, i % 20 == 0 ? from : to, turn);
            Hits found = ask(hash.world(), from, i % 20 == 0 ? from : to, turn);
            std::sort(expected.begin(), expected.end());
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found, expected) << "question " << i;
            hitCount += found.size();
        }
        EXPECT_GT(hitCount, leastHits);
    }

    DynamicsWorld dbvt{std::make_unique<btDbvtBroadphase>()};
    DynamicsWorld hash;
    BulletRandom random{4};
};

TEST_F(WorldQueries, ByRayFindTheSameHitsAndClosestHitAsOverBtDbvtBroadphase) {
    expectTheSame(400, 400,
                  [](btCollisionWorld& world, const btVector3& from, const btVector3& to,
                     const btQuaternion&) {
                      btCollisionWorld::AllHitsRayResultCallback all(from, to);
                      btCollisionWorld::ClosestRayResultCallback closest(from, to);
                      Hits hits;
                      if (from != to) {
                          world.rayTest(from, to, all);
                          world.rayTest(from, to, closest);
                      }
                      for (int k = 0; k < all.m_collisionObjects.size(); ++k) {
                          hits.emplace_back(all.m_collisionObjects[k]->getUserIndex(),
                                            all.m_hitFractions[k]);
                      }
                      if (closest.hasHit()) {
                          hits.emplace_back(-1, closest.m_closestHitFraction);
                      }
                      return hits;
                  });
}

TEST_F(WorldQueries, BySweepFindTheSameHitsAsOverBtDbvtBroadphase) {
    const btBoxShape box({btScalar(0.3), btScalar(0.5), btScalar(0.2)});
    expectTheSame(200, 200,
                  [&](btCollisionWorld& world, const btVector3& from, const btVector3& to,
                      const btQuaternion& turn) {
                      AllSweepHits found;
                      world.convexSweepTest(&box, placeAt(from, turn), placeAt(to, turn), found);
                      return found.hits;
                  });
}

TEST_F(WorldQueries, ByContactFindTheSamePenetrationsAsOverBtDbvtBroadphase) {
    btBoxShape box({1, btScalar(0.5), 1});
    expectTheSame(300, 200,
                  [&](btCollisionWorld& world, const btVector3& at, const btVector3&,
                      const btQuaternion& turn) {
                      btCollisionObject probe;
                      probe.setCollisionShape(&box);
                      probe.setUserIndex(999);
                      probe.setWorldTransform(placeAt(at, turn));
                      Contacts found;
                      world.contactTest(&probe, found);
                      return found.hits;
                  });
}

}  // namespace
}  // namespace hashphase::test
