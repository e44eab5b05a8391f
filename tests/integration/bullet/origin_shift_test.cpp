// SPDX-License-Identifier: Zlib

// The origin of a Bullet world is shifted: bodies, contacts, joints and pairs go along, and nothing
// wakes up, falls apart or jumps.

#include <integration/bullet/origin_shift.hpp>
#include <tests/integration/bullet/bullet_scenes.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/handlers.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

using Pair = std::pair<int, int>;

btTransform at(const btVector3& place) {
    return btTransform(btQuaternion(0, 0, 0, 1), place);
}

/// A world whose broadphase is known.
struct World : DynamicsWorld {
    World() : DynamicsWorld(std::make_unique<SpatialHashBroadphase>()) {}
    SpatialHashBroadphase& hash() { return static_cast<SpatialHashBroadphase&>(broadphase()); }
    void shift(const btVector3& by) { EXPECT_TRUE(shiftWorldOrigin(world(), hash(), by)); }
};

std::set<Pair> pairsOf(World& world) {
    std::set<Pair> pairs;
    const btBroadphasePairArray& all =
        world.hash().getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < all.size(); ++i) {
        const int a = all[i].m_pProxy0->m_uniqueId;
        const int b = all[i].m_pProxy1->m_uniqueId;
        pairs.emplace(std::min(a, b), std::max(a, b));
    }
    return pairs;
}

std::set<Pair> overlapsOf(World& world) {
    std::set<Pair> pairs;
    const btCollisionObjectArray& objects = world.world().getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        for (int k = 0; k < i; ++k) {
            btBroadphaseProxy* a = objects[i]->getBroadphaseHandle();
            btBroadphaseProxy* b = objects[k]->getBroadphaseHandle();
            const bool isPair =
                TestAabbAgainstAabb2(a->m_aabbMin, a->m_aabbMax, b->m_aabbMin, b->m_aabbMax) &&
                world.hash().getOverlappingPairCache()->needsBroadphaseCollision(a, b);
            if (isPair) {
                pairs.emplace(std::min(a->m_uniqueId, b->m_uniqueId),
                              std::max(a->m_uniqueId, b->m_uniqueId));
            }
        }
    }
    return pairs;
}

int contactCount(World& world) {
    int count = 0;
    for (int i = 0; i < world.dispatcher().getNumManifolds(); ++i) {
        count += world.dispatcher().getManifoldByIndexInternal(i)->getNumContacts();
    }
    return count;
}

/// A wall of bricks on a floor whose top is at y = 0, around `origin`; `origin` is a whole number.
void buildWall(World& world, const btVector3& origin, int rows = 6) {
    world.add(world.keep(std::make_unique<btBoxShape>(btVector3(16, 1, 16))), 0,
              at(origin + btVector3(0, -1, 0)));
    btCollisionShape* const brick = world.keep(
        std::make_unique<btBoxShape>(btVector3(btScalar(0.5), btScalar(0.25), btScalar(0.25))));
    for (int row = 0; row < rows; ++row) {
        for (int i = 0; i < rows - row; ++i) {
            const btScalar x = btScalar(i) + btScalar(row) / 2;
            world.add(brick, 1, at(origin + btVector3(x, btScalar(0.25) + btScalar(row) / 2, 0)));
        }
    }
}

void step(World& world, int count) {
    for (int i = 0; i < count; ++i) {
        world.step();
    }
}

constexpr btScalar kKilometre = 1024;

// --- The broadphase ------------------------------------------------------------------------------

TEST(SpatialHashBroadphaseOriginShift, MovesEveryBoxAndNoPair) {
    SpatialHashBroadphase broadphase;
    BulletRandom random(0x5eed2201);
    std::vector<btBroadphaseProxy*> proxies;
    for (int i = 0; i < 300; ++i) {
        const btVector3 low(btScalar(random.below(20)), btScalar(random.below(20)),
                            btScalar(random.below(20)));
        const int group =
            i % 2 == 0 ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter;
        proxies.push_back(broadphase.createProxy(low, low + btVector3(3, 3, 3), 0, nullptr, group,
                                                 btBroadphaseProxy::AllFilter, nullptr));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    const int pairCount = broadphase.getOverlappingPairCache()->getNumOverlappingPairs();
    ASSERT_GT(pairCount, 100);
    const btVector3 low = proxies[7]->m_aabbMin;

    const btVector3 shift(kKilometre, -3, 5);
    EXPECT_EQ(broadphase.shiftOrigin(shift), 0U);
    EXPECT_EQ(proxies[7]->m_aabbMin, low - shift);
    EXPECT_EQ(broadphase.grid().box(SpatialHashBroadphase::idOf(proxies[7])).min()[0],
              low[0] - kKilometre);
    // What is set as it is has not moved.
    broadphase.setAabb(proxies[7], low - shift, proxies[7]->m_aabbMax, nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(broadphase.lastCost().grid.changed, 0U);
    EXPECT_EQ(broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), pairCount);
    EXPECT_EQ(broadphase.validate(), "");
}

// --- A world -------------------------------------------------------------------------------------

TEST(WorldOriginShift, KeepsContactsPairsAndManifolds) {
    World world;
    buildWall(world, {kKilometre, 0, 0});
    step(world, 30);
    const std::set<Pair> pairs = pairsOf(world);
    const int manifolds = world.dispatcher().getNumManifolds();
    const int contacts = contactCount(world);
    ASSERT_GT(contacts, 60);
    std::vector<const void*> before;
    for (int i = 0; i < manifolds; ++i) {
        before.push_back(world.dispatcher().getManifoldByIndexInternal(i));
    }

    world.shift({kKilometre, 0, 0});
    EXPECT_EQ(pairsOf(world), pairs);
    EXPECT_EQ(contactCount(world), contacts);
    for (int i = 0; i < manifolds; ++i) {
        const btPersistentManifold& manifold = *world.dispatcher().getManifoldByIndexInternal(i);
        ASSERT_EQ(&manifold, before[static_cast<std::size_t>(i)]);
        for (int k = 0; k < manifold.getNumContacts(); ++k) {
            EXPECT_LT(std::abs(manifold.getContactPoint(k).getPositionWorldOnA().x()), 20);
            EXPECT_LT(std::abs(manifold.getContactPoint(k).getPositionWorldOnB().x()), 20);
        }
    }
    world.step();
    EXPECT_EQ(pairsOf(world), overlapsOf(world));
    EXPECT_EQ(world.dispatcher().getNumManifolds(), manifolds);
    EXPECT_EQ(contactCount(world), contacts);
}

// Towards the origin nothing is rounded, so the way back leads to the very same world.
TEST(WorldOriginShift, ThereAndBackLeavesNoTrace) {
    World shifted;
    World untouched;
    for (World* world : {&shifted, &untouched}) {
        buildWall(*world, {kKilometre, kKilometre, -kKilometre});
    }
    for (int frame = 0; frame < 60; ++frame) {
        if (frame % 10 == 5) {
            shifted.shift({kKilometre, kKilometre, -kKilometre});
            EXPECT_LT(shifted.body(3).getWorldTransform().getOrigin().length(), 20);
            shifted.shift({-kKilometre, -kKilometre, kKilometre});
        }
        shifted.step();
        untouched.step();
        ASSERT_EQ(firstDifferentBody(shifted, untouched), -1) << "frame " << frame;
    }
}

// What does not touch goes on to the bit where it was shifted to, in numbers that are exact.
TEST(WorldOriginShift, LeavesWhatFliesOnItsWay) {
    World shifted;
    World untouched;
    for (World* world : {&shifted, &untouched}) {
        world->world().setGravity({0, 0, 0});
        btCollisionShape* const ball = world->keep(std::make_unique<btSphereShape>(btScalar(0.5)));
        for (int i = 0; i < 8; ++i) {
            world->add(ball, 1, at({btScalar(4 * i), 0, 0}));
            world->body(i).setLinearVelocity({0, btScalar(i), btScalar(-2 * i)});
        }
    }
    const auto stepBoth = [&] {
        for (World* world : {&shifted, &untouched}) {
            world->world().stepSimulation(btScalar(1) / 64, 0);
        }
    };
    const btVector3 by(-256, 512, 64);
    for (int frame = 0; frame < 64; ++frame) {
        stepBoth();
        if (frame == 20) {
            shifted.shift(by);
        }
    }
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(shifted.body(i).getWorldTransform().getOrigin() + by,
                  untouched.body(i).getWorldTransform().getOrigin());
        EXPECT_EQ(shifted.body(i).getLinearVelocity(), untouched.body(i).getLinearVelocity());
    }
}

TEST(WorldOriginShift, LetsWhatSleepsSleep) {
    World world;
    buildWall(world, {kKilometre, 0, 0}, 4);
    for (int i = 0; i < 900 && world.sleepingCount() < world.bodyCount() - 1; ++i) {
        world.step();
    }
    ASSERT_EQ(world.sleepingCount(), world.bodyCount() - 1);
    std::vector<btVector3> places;
    for (int i = 0; i < world.bodyCount(); ++i) {
        places.push_back(world.body(i).getWorldTransform().getOrigin());
    }
    const btVector3 by(kKilometre, 0, 0);
    world.shift(by);
    step(world, 30);
    EXPECT_EQ(world.sleepingCount(), world.bodyCount() - 1);
    for (int i = 0; i < world.bodyCount(); ++i) {
        EXPECT_EQ(world.body(i).getWorldTransform().getOrigin(),
                  places[static_cast<std::size_t>(i)] - by);
    }
}

TEST(WorldOriginShift, MakesNoStackJump) {
    World shifted;
    World untouched;
    for (World* world : {&shifted, &untouched}) {
        buildWall(*world, {0, 0, 0});
        step(*world, 60);
    }
    const btVector3 by(16, -8, 4);
    for (int round = 0; round < 5; ++round) {
        shifted.shift(by);
        const int contacts = contactCount(shifted);
        step(shifted, 6);
        step(untouched, 6);
        EXPECT_NEAR(contactCount(shifted), contacts, 4);
    }
    for (int i = 0; i < shifted.bodyCount(); ++i) {
        const btVector3 off = shifted.body(i).getWorldTransform().getOrigin() + by * 5 -
                              untouched.body(i).getWorldTransform().getOrigin();
        EXPECT_LT(off.length(), 1e-3);
    }
}

TEST(WorldOriginShift, AtAnyMomentLeavesExactPairs) {
    World world;
    BulletRandom random(0x5eed2202);
    buildWall(world, {0, 0, 0}, 5);
    btVector3 origin(0, 0, 0);
    for (int frame = 0; frame < 60; ++frame) {
        if (random.chance(0.4)) {
            const btVector3 by = random.vector(-300, 300);
            world.shift(by);
            origin += by;
        }
        if (random.chance(0.3)) {
            const int number = 1 + random.below(world.bodyCount() - 1);
            world.readd(number, at(random.vector(0, 6) - origin));
        }
        if (random.chance(0.2)) {
            world.shift({64, 0, -64});
            origin += btVector3(64, 0, -64);
        }
        world.step();
        ASSERT_EQ(pairsOf(world), overlapsOf(world)) << "frame " << frame;
        ASSERT_EQ(world.hash().validate(), "") << "frame " << frame;
    }
}

// --- What keeps places of its own ----------------------------------------------------------------

TEST(WorldOriginShift, TellsMotionStates) {
    World world;
    buildWall(world, {0, 0, 0}, 1);
    btDefaultMotionState state(at({5, 6, 7}));
    world.body(1).setMotionState(&state);
    world.body(1).setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    world.body(1).setActivationState(DISABLE_DEACTIVATION);
    world.step();
    world.shift({kKilometre, 0, 0});
    world.step();
    EXPECT_EQ(world.body(1).getWorldTransform().getOrigin(), btVector3(5 - kKilometre, 6, 7));
    EXPECT_EQ(world.body(1).getLinearVelocity(), btVector3(0, 0, 0));
}

TEST(WorldOriginShift, MovesGhostsAndWhatTheyOverlap) {
    btGhostPairCallback callback;  // outlives the world, which tells it of its end
    World world;
    buildWall(world, {0, 0, 0}, 3);
    world.hash().getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
    btSphereShape shape(2);
    btPairCachingGhostObject ghost;
    ghost.setCollisionShape(&shape);
    ghost.setWorldTransform(at({1, 1, 0}));
    world.world().addCollisionObject(&ghost, btBroadphaseProxy::SensorTrigger);
    world.step();
    const int overlapping = ghost.getNumOverlappingObjects();
    EXPECT_GT(overlapping, 3);
    world.shift({kKilometre, kKilometre, 0});
    world.step();
    EXPECT_EQ(ghost.getWorldTransform().getOrigin(), btVector3(1 - kKilometre, 1 - kKilometre, 0));
    EXPECT_EQ(ghost.getNumOverlappingObjects(), overlapping);
    world.world().removeCollisionObject(&ghost);
}

// A body that is held by the world alone hangs where it hung, whichever joint holds it.
TEST(WorldOriginShift, MovesJointsThatHoldABodyToTheWorld) {
    const btTransform pivot = at({0, 1, 0});
    using Make = std::unique_ptr<btTypedConstraint> (*)(btRigidBody&, const btTransform&);
    const std::array<Make, 6> joints{
        [](btRigidBody& body, const btTransform& frame) -> std::unique_ptr<btTypedConstraint> {
            return std::make_unique<btPoint2PointConstraint>(body, frame.getOrigin());
        },
        [](btRigidBody& body, const btTransform& frame) -> std::unique_ptr<btTypedConstraint> {
            return std::make_unique<btHingeConstraint>(body, frame);
        },
        [](btRigidBody& body, const btTransform& frame) -> std::unique_ptr<btTypedConstraint> {
            auto joint = std::make_unique<btConeTwistConstraint>(body, frame);
            joint->setFrames(frame, body.getWorldTransform() * frame);
            return joint;
        },
        [](btRigidBody& body, const btTransform& frame) -> std::unique_ptr<btTypedConstraint> {
            return std::make_unique<btSliderConstraint>(body, frame, true);
        },
        [](btRigidBody& body, const btTransform& frame) -> std::unique_ptr<btTypedConstraint> {
            return std::make_unique<btGeneric6DofConstraint>(body, frame, true);
        },
        [](btRigidBody& body, const btTransform& frame) -> std::unique_ptr<btTypedConstraint> {
            return std::make_unique<btGeneric6DofSpring2Constraint>(body, frame);
        }};
    for (const Make& make : joints) {
        World world;
        world.world().setGravity({0, 0, 0});
        btCollisionShape* const ball = world.keep(std::make_unique<btSphereShape>(btScalar(0.5)));
        world.add(ball, 1, at({kKilometre, 3, 0}));
        const std::unique_ptr<btTypedConstraint> joint = make(world.body(0), pivot);
        SCOPED_TRACE(joint->getConstraintType());
        world.world().addConstraint(joint.get());
        step(world, 5);
        const btVector3 place = world.body(0).getWorldTransform().getOrigin();
        world.shift({kKilometre, 0, 0});
        step(world, 30);
        const btVector3 off = world.body(0).getWorldTransform().getOrigin() - place;
        EXPECT_NEAR(off.x(), -kKilometre, 1e-3);
        EXPECT_NEAR(off.y(), 0, 1e-3);
        EXPECT_NEAR(off.z(), 0, 1e-3);
        world.world().removeConstraint(joint.get());
    }
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(WorldOriginShift, OfAnotherWorldOrByWhatIsNotFiniteIsAsserted) {
    const ThrowingAsserts throwing;
    World world;
    SpatialHashBroadphase other;
    EXPECT_THROW(static_cast<void>(shiftWorldOrigin(world.world(), other, {1, 0, 0})),
                 BrokenAssert);
    EXPECT_THROW(world.shift({0, std::numeric_limits<btScalar>::infinity(), 0}), BrokenAssert);
}

#endif

TEST(WorldOriginShift, OfWhatHasUnknownCoordinatesIsRefused) {
    struct Soft : btCollisionObject {
        Soft() { m_internalType = CO_SOFT_BODY; }
    };
    const CaughtAsserts caught;
    World world;
    btSphereShape shape(1);
    Soft soft;
    soft.setCollisionShape(&shape);
    soft.setWorldTransform(at({3, 0, 0}));
    world.world().addCollisionObject(&soft);
    EXPECT_FALSE(shiftWorldOrigin(world.world(), world.hash(), {1, 0, 0}));
    EXPECT_EQ(soft.getWorldTransform().getOrigin().x(), 3);
    world.world().removeCollisionObject(&soft);
}

}  // namespace
}  // namespace hashphase::test
