// SPDX-License-Identifier: Zlib
//
// closestRay() against btCollisionWorld::rayTest() over the same broadphase, and batches of rays
// against rays alone.

#include <tests/integration/bullet/dynamics.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/support/threaded_for.hpp>

#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

/// Objects of all kinds of shapes on a plane and a mesh, some of which the filter hides.
class ShapeWorld : public DynamicsWorld {
public:
    ShapeWorld(int count, btScalar side) : side_(side) {
        auto* const sphere = keep(std::make_unique<btSphereShape>(btScalar(0.7)));
        auto* const box = keep(
            std::make_unique<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.9), btScalar(0.3))));
        auto* const compound = keep(std::make_unique<btCompoundShape>());
        compound->addChildShape(placeAt(random.vector(-1, 1)), sphere);
        compound->addChildShape(placeAt(random.vector(-1, 1)), box);
        auto* const hull = keep(std::make_unique<btConvexHullShape>());
        for (int i = 0; i < 8; ++i) {
            hull->addPoint(random.vector(-1, 1));
        }
        addGround();
        btCollisionShape* const shapes[] = {
            sphere,
            box,
            compound,
            hull,
            keep(std::make_unique<btCapsuleShape>(btScalar(0.3), btScalar(1))),
            keep(std::make_unique<btSphereShape>(btScalar(0.05)))};
        for (int i = 0; i < count; ++i) {
            const btQuaternion turn(random.direction(), random.uniform(0, 3));
            const int number = add(shapes[i % 6], 0, placeAt(random.vector(0, side), turn));
            body(number).getBroadphaseProxy()->m_collisionFilterGroup =
                i % 5 == 0 ? btBroadphaseProxy::DebrisFilter : btBroadphaseProxy::DefaultFilter;
        }
        hash().calculateOverlappingPairs(&dispatcher());
    }

    void jump(int i) {
        body(i).getWorldTransform().setOrigin(random.vector(0, side_));
        world().updateSingleAabb(&body(i));
    }

    BulletRandom random{12};

private:
    void addGround() {
        constexpr int kSide = 8;
        for (int i = 0; i < kSide * kSide; ++i) {
            const auto at = [&](int x, int y) {
                const btScalar height = btScalar((x * 7 + y * 5) % 3);
                return btVector3(btScalar(x) * side_ / kSide, height, btScalar(y) * side_ / kSide);
            };
            const int x = i % kSide;
            const int y = i / kSide;
            triangles_.addTriangle(at(x, y), at(x + 1, y), at(x, y + 1));
            triangles_.addTriangle(at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        }
        add(keep(std::make_unique<btBvhTriangleMeshShape>(&triangles_, true)), 0,
            placeAt({0, 0, 0}));
        add(keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(-3))), 0,
            placeAt({0, 0, 0}));
    }

    btScalar side_;
    btTriangleMesh triangles_;
};

/// Counts what it is asked about.
struct Closest : btCollisionWorld::ClosestRayResultCallback {
    using ClosestRayResultCallback::ClosestRayResultCallback;
    bool needsCollision(btBroadphaseProxy* proxy) const override {
        ++asked;
        return ClosestRayResultCallback::needsCollision(proxy);
    }
    mutable int asked = 0;
};

void expectSame(const Closest& actual, const Closest& expected) {
    ASSERT_EQ(actual.hasHit(), expected.hasHit());
    ASSERT_EQ(actual.m_closestHitFraction, expected.m_closestHitFraction);
    if (actual.hasHit()) {
        EXPECT_EQ(actual.m_collisionObject, expected.m_collisionObject);
        EXPECT_EQ((actual.m_hitNormalWorld - expected.m_hitNormalWorld).length2(), 0);
    }
}

TEST(ClosestRay, FindsWhatTheWorldsRayTestFindsAndAsksAboutLess) {
    constexpr btScalar kSide = 24;
    ShapeWorld scene(1500, kSide);
    int hits = 0;
    int asked = 0;
    int askedByWorld = 0;
    for (int i = 0; i < 1500 && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE(i);
        if (i % 10 == 0) {
            scene.jump(2 + scene.random.below(1500));  // waits in the list
        }
        if (i % 500 == 499) {
            scene.hash().calculateOverlappingPairs(nullptr);
        }
        const btScalar length = i % 4 == 0 ? 1 : i % 4 == 1 ? 10 : 100;
        const btVector3 from = scene.random.vector(-1, kSide + 1);
        btVector3 to = from + scene.random.direction() * length;
        if (i % 7 == 0) {
            to[i % 3] = from[i % 3];
        }
        Closest expected(from, to);
        Closest actual(from, to);
        for (Closest* callback : {&expected, &actual}) {
            callback->m_collisionFilterMask =
                i % 3 == 0 ? ~btBroadphaseProxy::DebrisFilter : btBroadphaseProxy::AllFilter;
            if (i % 5 == 0) {
                callback->m_flags = btTriangleRaycastCallback::kF_FilterBackfaces;
            }
        }
        scene.world().rayTest(from, to, expected);
        const QueryCost cost = scene.hash().closestRay(from, to, actual);
        expectSame(actual, expected);
        EXPECT_GE(cost.hits, static_cast<std::uint64_t>(actual.asked));
        hits += actual.hasHit() ? 1 : 0;
        asked += actual.asked;
        askedByWorld += expected.asked;
    }
    EXPECT_GT(hits, 500);
    EXPECT_LT(5 * asked, 4 * askedByWorld);
}

TEST(ClosestRay, OfNoLengthOrWithNothingLeftToFindAsksAboutNothing) {
    ShapeWorld scene(100, 4);
    const btVector3 from(2, 2, 2);
    Closest atOnce(from, from);
    scene.hash().closestRay(from, from, atOnce);
    EXPECT_FALSE(atOnce.hasHit());
    Closest done(from, {9, 9, 9});
    done.m_closestHitFraction = 0;
    EXPECT_EQ(scene.hash().closestRay(from, {9, 9, 9}, done).boxesTested, 0U);
    EXPECT_EQ(done.asked, 0);
}

TEST(ClosestRay, PassesOverProxiesWithoutAnObject) {
    SpatialHashBroadphase broadphase;
    broadphase.createProxy({-1, -1, -1}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
    Closest closest({-5, 0, 0}, {5, 0, 0});
    EXPECT_EQ(broadphase.closestRay({-5, 0, 0}, {5, 0, 0}, closest).hits, 1U);
    EXPECT_FALSE(closest.hasHit());
}

TEST(ClosestRay, ReportsAllHitsToACallbackThatWantsAll) {
    ShapeWorld scene(800, 16);
    for (int i = 0; i < 200; ++i) {
        const btVector3 from = scene.random.vector(0, 16);
        const btVector3 to = scene.random.vector(0, 16);
        btCollisionWorld::AllHitsRayResultCallback expected(from, to);
        btCollisionWorld::AllHitsRayResultCallback actual(from, to);
        scene.world().rayTest(from, to, expected);
        scene.hash().closestRay(from, to, actual);
        ASSERT_EQ(actual.m_hitFractions.size(), expected.m_hitFractions.size());
    }
}

// --- Batches -------------------------------------------------------------------------------------

/// The proxies here are those of collision objects.
struct CollectIds : CollectRay {
    using CollectRay::CollectRay;
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(proxy->m_uniqueId);
        return true;
    }
};

TEST(RayBatches, CallEachCallbackAsARayAloneDoes) {
    ShapeWorld scene(1500, 24);
    ThreadedFor threads(2, 0x5eed0903);
    for (const ParallelFor parallelFor : {ParallelFor(serialFor), ParallelFor(threads)}) {
        for (int i = 0; i < 500; ++i) {
            scene.jump(2 + i);  // so many that the batch files them
        }
        std::vector<Ray> rays;
        std::deque<CollectIds> collectors;
        std::vector<BroadphaseRay> batch;
        std::deque<Closest> closest;
        std::vector<ClosestRay> closestBatch;
        for (int i = 0; i < 300; ++i) {
            Ray ray{scene.random.vector(0, 24), scene.random.vector(0, 24)};
            if (i % 3 == 0) {
                ray.castMin = -scene.random.vector(0, 1);
                ray.castMax = scene.random.vector(0, 1);
            }
            rays.push_back(ray);
            batch.push_back(
                {ray.from, ray.to, &collectors.emplace_back(ray), ray.castMin, ray.castMax});
            closestBatch.push_back({ray.from, ray.to, &closest.emplace_back(ray.from, ray.to)});
        }
        scene.hash().rayTests(batch, parallelFor);
        scene.hash().closestRays(closestBatch, parallelFor);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Ray& ray = rays[i];
            CollectIds alone(ray);
            scene.hash().rayTest(ray.from, ray.to, alone, ray.castMin, ray.castMax);
            ASSERT_EQ(collectors[i].found, alone.found);
            Closest closestAlone(ray.from, ray.to);
            scene.hash().closestRay(ray.from, ray.to, closestAlone);
            expectSame(closest[i], closestAlone);
        }
    }
    scene.hash().rayTests({});
    scene.hash().closestRays({});
}

}  // namespace
}  // namespace hashphase::test
