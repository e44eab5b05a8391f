// SPDX-License-Identifier: Zlib
//
// Pairs that a program takes out of the cache itself, as many do to reset a body, come back in the next
// step: else whoever lies there would fall through the world.

#include <tests/integration/bullet/ghost_world.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

/// A box that lies on a plane.
struct LyingBox {
    explicit LyingBox(btBroadphaseInterface& over) : broadphase(over) {
        world.addRigidBody(&floor);
        box.setWorldTransform(GhostWorld::at({0, btScalar(0.5), 0}));
        box.setActivationState(DISABLE_DEACTIVATION);
        world.addRigidBody(&box);
        step(1);
    }
    ~LyingBox() {
        world.removeRigidBody(&box);
        world.removeRigidBody(&floor);
    }
    LyingBox(const LyingBox&) = delete;
    LyingBox& operator=(const LyingBox&) = delete;

    void step(int count) {
        for (int i = 0; i < count; ++i) {
            world.stepSimulation(btScalar(1) / 64, 0);
        }
    }
    [[nodiscard]] btOverlappingPairCache& cache() { return *world.getPairCache(); }
    [[nodiscard]] btScalar height() const { return box.getWorldTransform().getOrigin().y(); }

    btBroadphaseInterface& broadphase;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
    btStaticPlaneShape plane{btVector3(0, 1, 0), 0};
    btBoxShape cube{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btRigidBody floor{0, nullptr, &plane};
    btRigidBody box{1, nullptr, &cube, btVector3(1, 1, 1)};
};

/// Refuses every pair while it is told to.
struct Refuse : btOverlapFilterCallback {
    bool needBroadphaseCollision(btBroadphaseProxy* /*a*/,
                                 btBroadphaseProxy* /*b*/) const override {
        return !doesRefuse;
    }
    bool doesRefuse = true;
};

struct RemoveAll : btOverlapCallback {
    bool processOverlap(btBroadphasePair& /*pair*/) override { return true; }
};

using TakeOut = std::function<void(LyingBox&)>;

void removePairsOfBox(LyingBox& scene) {
    scene.cache().removeOverlappingPairsContainingProxy(scene.box.getBroadphaseHandle(),
                                                        &scene.dispatcher);
}

const std::vector<TakeOut>& waysToTakeOut() {
    static const std::vector<TakeOut> kWays{
        removePairsOfBox,
        [](LyingBox& scene) {
            scene.cache().removeOverlappingPair(scene.floor.getBroadphaseHandle(),
                                                scene.box.getBroadphaseHandle(), &scene.dispatcher);
        },
        [](LyingBox& scene) {
            RemoveAll all;
            scene.cache().processAllOverlappingPairs(&all, &scene.dispatcher);
        },
        [](LyingBox& scene) {
            RemoveAll all;
            btDispatcherInfo info;
            info.m_deterministicOverlappingPairs = true;
            scene.cache().processAllOverlappingPairs(&all, &scene.dispatcher, info);
        },
        [](LyingBox& scene) {
            std::vector<btBroadphaseProxy*> all(4, scene.box.getBroadphaseHandle());
            if (auto* const cache = dynamic_cast<PairCache*>(&scene.cache())) {
                cache->removeOverlappingPairsContainingProxies(all, &scene.dispatcher);
            }
        }};
    return kWays;
}

TEST(TakenOutPairs, ComeBackInTheNextStep) {
    for (const TakeOut& takeOut : waysToTakeOut()) {
        for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
            for (const Sweep sweep : {Sweep::none, Sweep::automatic}) {
                PairCache cache(order);
                SpatialHashConfig config;
                config.sweep = sweep;
                SpatialHashBroadphase broadphase(&cache, config);
                LyingBox scene(broadphase);
                ASSERT_EQ(cache.getNumOverlappingPairs(), 1);
                takeOut(scene);
                ASSERT_EQ(cache.getNumOverlappingPairs(), 0);
                scene.step(1);
                EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
                EXPECT_EQ(broadphase.validate(), "");
                scene.step(300);
                EXPECT_GT(scene.height(), btScalar(0.4));
            }
        }
    }
}

TEST(TakenOutPairs, ComeBackToACacheOfTheBroadphasesOwn) {
    SpatialHashBroadphase broadphase;
    LyingBox scene(broadphase);
    removePairsOfBox(scene);
    EXPECT_EQ(broadphase.validate(), "");
    scene.step(300);
    EXPECT_GT(scene.height(), btScalar(0.4));
    EXPECT_EQ(broadphase.validate(), "");
}

// As whoever excludes them does who knows that the filter is not asked again about what stands.
TEST(TakenOutPairs, StayOutWhereTheFilterRefusesThem) {
    SpatialHashBroadphase broadphase;
    LyingBox scene(broadphase);
    Refuse refuse;
    scene.cache().setOverlapFilterCallback(&refuse);
    removePairsOfBox(scene);
    scene.step(2);
    EXPECT_EQ(scene.cache().getNumOverlappingPairs(), 0);
    EXPECT_EQ(broadphase.validate(), "");
    refuse.doesRefuse = false;
    broadphase.refilterAll(&scene.dispatcher);
    EXPECT_EQ(scene.cache().getNumOverlappingPairs(), 1);
    scene.cache().setOverlapFilterCallback(nullptr);

    scene.box.getBroadphaseHandle()->m_collisionFilterMask = 0;
    removePairsOfBox(scene);
    scene.step(2);
    EXPECT_EQ(scene.cache().getNumOverlappingPairs(), 0);
    EXPECT_EQ(broadphase.validate(), "");
}

TEST(TakenOutPairs, OfWhatHasGoneSinceDoNotComeBackNorGather) {
    GhostWorld scene;
    scene.world.performDiscreteCollisionDetection();
    auto& broadphase = dynamic_cast<SpatialHashBroadphase&>(*scene.broadphase);
    std::size_t bytes = 0;
    for (int i = 0; i < 1000; ++i) {  // without a step
        btRigidBody spawned(1, nullptr, &scene.small);
        scene.world.addRigidBody(&spawned);
        EXPECT_TRUE(GhostWorld::doesList(scene.ghost, spawned));
        broadphase.getOverlappingPairCache()->removeOverlappingPairsContainingProxy(
            spawned.getBroadphaseHandle(), &scene.dispatcher);
        EXPECT_FALSE(GhostWorld::doesList(scene.ghost, spawned));
        scene.world.removeRigidBody(&spawned);
        bytes = i == 100 ? broadphase.memoryBytes() : bytes;
    }
    EXPECT_LE(broadphase.memoryBytes(), bytes);
    broadphase.releaseUnusedMemory();
    scene.world.performDiscreteCollisionDetection();
    EXPECT_EQ(broadphase.validate(), "");
}

TEST(TakenOutPairs, AreToldToGhostsAgain) {
    GhostWorld scene;
    btRigidBody visitor(1, nullptr, &scene.small);
    scene.world.addRigidBody(&visitor);
    scene.world.performDiscreteCollisionDetection();
    scene.world.getPairCache()->removeOverlappingPair(
        visitor.getBroadphaseHandle(), scene.ghost.getBroadphaseHandle(), &scene.dispatcher);
    EXPECT_FALSE(GhostWorld::doesList(scene.ghost, visitor));
    scene.world.performDiscreteCollisionDetection();
    EXPECT_TRUE(GhostWorld::doesList(scene.ghost, visitor));
    EXPECT_TRUE(GhostWorld::doesList(scene.cachingGhost, visitor));
    scene.world.removeRigidBody(&visitor);
}

}  // namespace
}  // namespace hashphase::test
