// SPDX-License-Identifier: Zlib

// One world of Bullet's that is many: bodies move as they would in worlds of their own, to the last bit, and
// ghosts and rays meet what is in their world.

#include <tests/integration/bullet/dynamics.hpp>
#include <tests/integration/bullet/many_worlds.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

// --- Bodies --------------------------------------------------------------------------------------

constexpr int kTowerBodies = 26;

/// A tower of boxes on a ground of its own, on which balls fall: others in each world.
void buildTower(DynamicsWorld& world, int number) {
    const auto half = btScalar(0.4);
    auto* const box = world.keep(std::make_unique<btBoxShape>(btVector3(half, half, half)));
    auto* const ball = world.keep(std::make_unique<btSphereShape>(half));
    world.addBox({10, 1, 10}, 0, {0, -1, 0});
    for (int i = 0; i < 15; ++i) {
        world.add(box, 1,
                  placeAt({btScalar(i % 3) * btScalar(0.05), half * btScalar(2 * i + 1), 0}));
    }
    BulletRandom random(static_cast<std::uint64_t>(number) + 1);
    while (world.bodyCount() % kTowerBodies != 0) {
        const int thrown = world.add(ball, 1, placeAt(random.vector(-3, 3) + btVector3(0, 9, 0)));
        world.body(thrown).setLinearVelocity(random.vector(-2, 2));
    }
}

/// Bullet sorts contacts by an unstable method, unless it is told to tell each two of them apart.
std::unique_ptr<DynamicsWorld> ordered(std::unique_ptr<btBroadphaseInterface> broadphase,
                                       std::unique_ptr<btOverlappingPairCache> cache) {
    auto world = std::make_unique<DynamicsWorld>(std::move(broadphase), std::move(cache));
    world->world().getDispatchInfo().m_deterministicOverlappingPairs = true;
    return world;
}

std::unique_ptr<DynamicsWorld> makeTower(int number) {
    auto cache = std::make_unique<PairCache>(PairOrder::canonical);
    auto broadphase = std::make_unique<SpatialHashBroadphase>(cache.get());
    auto world = ordered(std::move(broadphase), std::move(cache));
    buildTower(*world, number);
    return world;
}

std::unique_ptr<DynamicsWorld> makeTowers(int count, const SpatialHashConfig& each) {
    auto cache = std::make_unique<PairCache>(PairOrder::canonical);
    WorldsConfig config = worldsByUserIndex(count, each);
    config.worldOf = [](const btCollisionObject& object) {
        return object.getUserIndex() / kTowerBodies;
    };
    auto broadphase = std::make_unique<WorldsBroadphase>(cache.get(), config);
    auto world = ordered(std::move(broadphase), std::move(cache));
    for (int number = 0; number < count; ++number) {
        buildTower(*world, number);
    }
    return world;
}

bool moveAlike(const btRigidBody& a, const btRigidBody& b) {
    return a.getWorldTransform() == b.getWorldTransform() &&
           a.getLinearVelocity() == b.getLinearVelocity() &&
           a.getAngularVelocity() == b.getAngularVelocity() &&
           a.getActivationState() == b.getActivationState();
}

/// A wall, body 0, towards which a ball flies, body 1, by more than the wall's thickness in a step.
int throwFastBall(DynamicsWorld& world) {
    world.world().setGravity({0, 0, 0});
    world.addBox({btScalar(0.1), 4, 4}, 0, {0, 0, 0});
    auto* const ball = world.keep(std::make_unique<btSphereShape>(btScalar(0.2)));
    const int thrown = world.add(ball, 1, placeAt({-5, 0, 0}));
    world.body(thrown).setLinearVelocity({120, 0, 0});
    world.body(thrown).setCcdMotionThreshold(btScalar(0.1));
    world.body(thrown).setCcdSweptSphereRadius(btScalar(0.15));
    return thrown;
}

bool passesTheWall(DynamicsWorld& world, int thrown) {
    world.step(6);
    return world.body(thrown).getWorldTransform().getOrigin().x() > 3;
}

// Bullet casts them through the whole broadphase, not by its pairs.
TEST(WorldsDynamics, FastBodiesMeetNobodyOfAnotherWorld) {
    for (const int worldOfBall : {0, 1}) {
        auto cache = std::make_unique<PairCache>();
        WorldsConfig config;
        config.worldCount = 2;
        config.worldOf = [=](const btCollisionObject& object) {
            return object.getUserIndex() == 0 ? 0 : worldOfBall;
        };
        auto broadphase = std::make_unique<WorldsBroadphase>(cache.get(), config);
        DynamicsWorld world(std::move(broadphase), std::move(cache));
        const int thrown = throwFastBall(world);
        EXPECT_EQ(passesTheWall(world, thrown), worldOfBall == 1);
    }
}

TEST(WorldsDynamics, FastBodiesPassWhatTheyIgnore) {
    for (const bool ignoresIt : {false, true}) {
        auto cache = std::make_unique<PairCache>();
        auto broadphase = std::make_unique<SpatialHashBroadphase>(cache.get());
        SpatialHashBroadphase& hash = *broadphase;
        PairCache& pairCache = *cache;
        DynamicsWorld world(std::move(broadphase), std::move(cache));
        const int thrown = throwFastBall(world);
        btBroadphaseProxy* const wall = world.body(0).getBroadphaseHandle();
        btBroadphaseProxy* const ball = world.body(thrown).getBroadphaseHandle();
        EXPECT_EQ(pairCache.getOverlapFilterCallback(), nullptr);
        if (ignoresIt) {
            hash.ignorePair(wall, ball, nullptr);
            // What is set back is as if it had not been set.
            pairCache.setOverlapFilterCallback(pairCache.getOverlapFilterCallback());
            EXPECT_FALSE(pairCache.hasFilterCallback());
            EXPECT_EQ(pairCache.addOverlappingPair(wall, ball), nullptr);
        }
        EXPECT_EQ(pairCache.needsBroadphaseCollision(wall, ball), !ignoresIt);
        EXPECT_EQ(passesTheWall(world, thrown), ignoresIt);
        hash.stopIgnoringPair(wall, ball, nullptr);
        EXPECT_EQ(pairCache.getOverlapFilterCallback(), nullptr);
    }
}

TEST(WorldsDynamics, MoveBodiesAsInWorldsOfTheirOwnToTheLastBit) {
    constexpr int kCount = 9;
    ThreadedFor threadedFor(2, 3);
    SpatialHashConfig onThreads;
    onThreads.parallelFor = std::ref(threadedFor);
    for (const SpatialHashConfig& each : {SpatialHashConfig(), onThreads}) {
        const std::unique_ptr<DynamicsWorld> towers = makeTowers(kCount, each);
        std::vector<std::unique_ptr<DynamicsWorld>> alone;
        for (int number = 0; number < kCount; ++number) {
            alone.push_back(makeTower(number));
        }
        int sleeping = 0;
        for (int step = 0; step < 400 && !testing::Test::HasFailure(); ++step) {
            towers->step();
            int pairCount = 0;
            for (int number = 0; number < kCount; ++number) {
                DynamicsWorld& one = *alone[static_cast<std::size_t>(number)];
                one.step();
                pairCount += one.pairCount();
                for (int i = 0; i < kTowerBodies; ++i) {
                    ASSERT_TRUE(moveAlike(towers->body(number * kTowerBodies + i), one.body(i)))
                        << "world " << number << ", body " << i << ", step " << step;
                }
            }
            ASSERT_EQ(towers->pairCount(), pairCount);
            sleeping = std::max(sleeping, towers->sleepingCount());
        }
        EXPECT_GT(sleeping, 0);
    }
}

// --- Ghosts and rays -----------------------------------------------------------------------------

/// Two worlds at one place, each with a ghost and a ball that it surrounds.
struct TwoWorlds {
    TwoWorlds() {
        broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&ghostCallback);
        for (int number = 0; number < 2; ++number) {
            add(ghosts[std::size_t(number)], large, number, {0, 0, 0});
            add(balls[std::size_t(number)], small, number, {btScalar(number), 0, 0});
        }
    }
    ~TwoWorlds() {
        while (world.getNumCollisionObjects() > 0) {
            world.removeCollisionObject(world.getCollisionObjectArray()[0]);
        }
    }
    TwoWorlds(const TwoWorlds&) = delete;
    TwoWorlds& operator=(const TwoWorlds&) = delete;

    void add(btCollisionObject& object, btCollisionShape& shape, int number, const btVector3& at) {
        object.setCollisionShape(&shape);
        object.setUserIndex(number);
        object.setWorldTransform(placeAt(at));
        world.addCollisionObject(&object);
    }
    /// Numbers of the balls that the ghost has.
    std::vector<int> seenBy(std::size_t number) {
        std::vector<int> seen;
        for (int i = 0; i < ghosts[number].getNumOverlappingObjects(); ++i) {
            seen.push_back(static_cast<int>(
                static_cast<btCollisionObject*>(ghosts[number].getOverlappingObject(i)) -
                balls.data()));
        }
        return seen;
    }

    btSphereShape small{btScalar(0.5)};
    btSphereShape large{3};
    std::array<btPairCachingGhostObject, 2> ghosts;
    std::array<btCollisionObject, 2> balls;
    btGhostPairCallback ghostCallback;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    WorldsBroadphase broadphase{worldsByUserIndex(2)};
    btCollisionWorld world{&dispatcher, &broadphase, &configuration};
};

TEST(WorldsDynamics, TellGhostsAtOnceOfWhatIsInTheirWorld) {
    TwoWorlds worlds;
    EXPECT_EQ(worlds.seenBy(0), std::vector<int>{0});
    EXPECT_EQ(worlds.seenBy(1), std::vector<int>{1});
    worlds.balls[1].setUserIndex(0);
    worlds.world.refreshBroadphaseProxy(&worlds.balls[1]);
    EXPECT_EQ(worlds.broadphase.worldOf(worlds.balls[1].getBroadphaseHandle()), 0);
    EXPECT_EQ(worlds.seenBy(0), std::vector<int>({0, 1}));
    EXPECT_EQ(worlds.seenBy(1), std::vector<int>{});
    worlds.world.performDiscreteCollisionDetection();
    EXPECT_EQ(worlds.seenBy(0), std::vector<int>({0, 1}));
    EXPECT_EQ(worlds.dispatcher.getNumManifolds(), 3) << "of the balls, and of each with the ghost";
    worlds.balls[0].setWorldTransform(placeAt({9, 0, 0}));
    worlds.world.performDiscreteCollisionDetection();
    EXPECT_EQ(worlds.seenBy(0), std::vector<int>{1});
    EXPECT_EQ(worlds.broadphase.validate(), "");
}

TEST(WorldsDynamics, CastRaysInOneWorldOrInAll) {
    TwoWorlds worlds;
    const btVector3 from(-9, 0, 0);
    const btVector3 to(9, 0, 0);
    const auto cast = [&](const auto& broadphase) -> const btCollisionObject* {
        btCollisionWorld::ClosestRayResultCallback closest(from, to);
        closest.m_collisionFilterMask = btBroadphaseProxy::DefaultFilter;
        EXPECT_GT(broadphase.closestRay(from, to, closest).hits, 0U);
        return closest.m_collisionObject;
    };
    for (btPairCachingGhostObject& ghost : worlds.ghosts) {
        ghost.getBroadphaseHandle()->m_collisionFilterGroup = btBroadphaseProxy::SensorTrigger;
    }
    EXPECT_EQ(cast(worlds.broadphase.world(0)), &worlds.balls[0]);
    EXPECT_EQ(cast(worlds.broadphase.world(1)), &worlds.balls[1]);
    EXPECT_EQ(cast(worlds.broadphase), &worlds.balls[0]);
    worlds.balls[1].setWorldTransform(placeAt({-3, 0, 0}));
    worlds.world.updateSingleAabb(&worlds.balls[1]);
    EXPECT_EQ(cast(worlds.broadphase), &worlds.balls[1]);
    btCollisionWorld::AllHitsRayResultCallback all(from, to);
    all.m_collisionFilterMask = btBroadphaseProxy::DefaultFilter;
    worlds.world.rayTest(from, to, all);
    EXPECT_EQ(all.m_collisionObjects.size(), 2);
}

}  // namespace
}  // namespace hashphase::test
