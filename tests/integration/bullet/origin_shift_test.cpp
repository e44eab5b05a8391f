// SPDX-License-Identifier: Zlib

// The origin of a Bullet world is shifted: bodies, contacts, joints and pairs go along, and nothing
// wakes up, falls apart or jumps.

#include <broadphase/core/compiler.hpp>
#include <integration/bullet/origin_shift.hpp>
#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/handlers.hpp>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

constexpr btScalar kKilometre = 1024;

struct World : DynamicsWorld {
    void shift(const btVector3& by) { EXPECT_TRUE(shiftWorldOrigin(world(), hash(), by)); }

    [[nodiscard]] const btVector3& place(int number) const {
        return body(number).getWorldTransform().getOrigin();
    }
    [[nodiscard]] int contactCount() {
        int count = 0;
        for (int i = 0; i < dispatcher().getNumManifolds(); ++i) {
            count += dispatcher().getManifoldByIndexInternal(i)->getNumContacts();
        }
        return count;
    }

    /// Of bricks on a floor whose top is at y = 0, around `origin`; `origin` is a whole number.
    void buildWall(const btVector3& origin, int rows = 6) {
        addBox({16, 1, 16}, 0, origin + btVector3(0, -1, 0));
        const btVector3 brick(btScalar(0.5), btScalar(0.25), btScalar(0.25));
        for (int row = 0; row < rows; ++row) {
            for (int i = 0; i < rows - row; ++i) {
                const btVector3 at(btScalar(i) + btScalar(row) / 2,
                                   btScalar(0.25) + btScalar(row) / 2, 0);
                addBox(brick, 1, origin + at);
            }
        }
    }
};

/// Two worlds of the same, of which one is shifted.
struct Twins {
    World shifted;
    World untouched;

    template <class Act>
    void both(const Act& act) {
        act(shifted);
        act(untouched);
    }
};

// --- The broadphase ------------------------------------------------------------------------------

TEST(SpatialHashBroadphaseOriginShift, MovesEveryBoxAndNoPair) {
    Boxes boxes;
    BulletRandom random(0x5eed2201);
    for (int i = 0; i < 300; ++i) {
        const btVector3 low(btScalar(random.below(20)), btScalar(random.below(20)),
                            btScalar(random.below(20)));
        boxes.create({low, low + btVector3(3, 3, 3)}, i % 2 == 0
                                                          ? btBroadphaseProxy::StaticFilter
                                                          : btBroadphaseProxy::DefaultFilter);
    }
    boxes.step(2);
    const std::vector<Uids> pairs = boxes.list();
    ASSERT_GT(pairs.size(), 100U);
    btBroadphaseProxy* const some = boxes.proxies[7];
    const Box before = boxOf(*some);

    const btVector3 shift(kKilometre, -3, 5);
    EXPECT_EQ(boxes.broadphase.shiftOrigin(shift), 0U);
    const Box after{before.min - shift, before.max - shift};
    EXPECT_TRUE(isSame(boxOf(*some), after));
    EXPECT_EQ(boxes.broadphase.grid().box(SpatialHashBroadphase::idOf(some)).min()[0],
              after.min[0]);
    boxes.set(some, after);  // What is set as it is has not moved.
    boxes.check();
    EXPECT_EQ(boxes.broadphase.lastCost().grid.changed, 0U);
    EXPECT_EQ(boxes.list(), pairs);
}

// --- A world -------------------------------------------------------------------------------------

TEST(WorldOriginShift, KeepsContactsPairsAndManifolds) {
    World world;
    world.buildWall({kKilometre, 0, 0});
    world.step(30);
    const std::set<Uids> pairs = uidPairs(world.cache());
    const int contacts = world.contactCount();
    ASSERT_GT(contacts, 60);
    std::vector<const btPersistentManifold*> manifolds;
    for (int i = 0; i < world.dispatcher().getNumManifolds(); ++i) {
        manifolds.push_back(world.dispatcher().getManifoldByIndexInternal(i));
    }
    world.shift({kKilometre, 0, 0});
    EXPECT_EQ(uidPairs(world.cache()), pairs);
    EXPECT_EQ(world.contactCount(), contacts);
    for (std::size_t i = 0; i < manifolds.size(); ++i) {
        ASSERT_EQ(world.dispatcher().getManifoldByIndexInternal(int(i)), manifolds[i]);
        for (int k = 0; k < manifolds[i]->getNumContacts(); ++k) {
            const btManifoldPoint& point = manifolds[i]->getContactPoint(k);
            EXPECT_LT(std::abs(point.getPositionWorldOnA().x()), 20);
            EXPECT_LT(std::abs(point.getPositionWorldOnB().x()), 20);
        }
    }
    world.step();
    world.expectExactPairs();
    EXPECT_EQ(world.dispatcher().getNumManifolds(), int(manifolds.size()));
    EXPECT_EQ(world.contactCount(), contacts);
}

// Towards the origin nothing is rounded, so the way back leads to the very same world.
TEST(WorldOriginShift, ThereAndBackLeavesNoTrace) {
    const btVector3 away(kKilometre, kKilometre, -kKilometre);
    Twins twins;
    twins.both([&](World& world) { world.buildWall(away); });
    for (int frame = 0; frame < 60; ++frame) {
        if (frame % 10 == 5) {
            twins.shifted.shift(away);
            EXPECT_LT(twins.shifted.place(3).length(), 20);
            twins.shifted.shift(-away);
        }
        twins.both([](World& world) { world.step(); });
        ASSERT_EQ(firstDifferentBody(twins.shifted, twins.untouched), -1) << "frame " << frame;
    }
}

// What does not touch goes on to the bit where it was shifted to, in numbers that are exact.
TEST(WorldOriginShift, LeavesWhatFliesOnItsWay) {
    Twins twins;
    twins.both([](World& world) {
        world.world().setGravity({0, 0, 0});
        btCollisionShape* const ball = world.keep(std::make_unique<btSphereShape>(btScalar(0.5)));
        for (int i = 0; i < 8; ++i) {
            world.add(ball, 1, placeAt({btScalar(4 * i), 0, 0}));
            world.body(i).setLinearVelocity({0, btScalar(i), btScalar(-2 * i)});
        }
    });
    const btVector3 by(-256, 512, 64);
    for (int frame = 0; frame < 64; ++frame) {
        twins.both([](World& world) { world.world().stepSimulation(btScalar(1) / 64, 0); });
        if (frame == 20) {
            twins.shifted.shift(by);
        }
    }
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(twins.shifted.place(i) + by, twins.untouched.place(i));
        EXPECT_EQ(twins.shifted.body(i).getLinearVelocity(),
                  twins.untouched.body(i).getLinearVelocity());
    }
}

TEST(WorldOriginShift, LetsWhatSleepsSleep) {
    World world;
    world.buildWall({kKilometre, 0, 0}, 4);
    for (int i = 0; i < 900 && world.sleepingCount() < world.bodyCount() - 1; ++i) {
        world.step();
    }
    ASSERT_EQ(world.sleepingCount(), world.bodyCount() - 1);
    std::vector<btVector3> places;
    for (int i = 0; i < world.bodyCount(); ++i) {
        places.push_back(world.place(i));
    }
    const btVector3 by(kKilometre, 0, 0);
    world.shift(by);
    world.step(30);
    EXPECT_EQ(world.sleepingCount(), world.bodyCount() - 1);
    for (int i = 0; i < world.bodyCount(); ++i) {
        EXPECT_EQ(world.place(i), places[static_cast<std::size_t>(i)] - by);
    }
}

TEST(WorldOriginShift, MakesNoStackJump) {
    Twins twins;
    twins.both([](World& world) {
        world.buildWall({0, 0, 0});
        world.step(60);
    });
    const btVector3 by(16, -8, 4);
    for (int round = 0; round < 5; ++round) {
        twins.shifted.shift(by);
        const int contacts = twins.shifted.contactCount();
        twins.both([](World& world) { world.step(6); });
        EXPECT_NEAR(twins.shifted.contactCount(), contacts, 4);
    }
    for (int i = 0; i < twins.shifted.bodyCount(); ++i) {
        const btVector3 off = twins.shifted.place(i) + by * 5 - twins.untouched.place(i);
        EXPECT_LT(off.length(), 1e-3);
    }
}

TEST(WorldOriginShift, AtAnyMomentLeavesExactPairs) {
    World world;
    BulletRandom random(0x5eed2202);
    world.buildWall({0, 0, 0}, 5);
    btVector3 origin(0, 0, 0);
    const auto shift = [&](const btVector3& by) {
        world.shift(by);
        origin += by;
    };
    for (int frame = 0; frame < 60 && !testing::Test::HasFailure(); ++frame) {
        if (random.chance(0.4)) {
            shift(random.vector(-300, 300));
        }
        if (random.chance(0.3)) {
            const int number = 1 + random.below(world.bodyCount() - 1);
            world.readd(number, placeAt(random.vector(0, 6) - origin));
        }
        if (random.chance(0.2)) {
            shift({64, 0, -64});
        }
        world.step();
        world.expectExactPairs();
    }
}

// --- What keeps places of its own ----------------------------------------------------------------

TEST(WorldOriginShift, TellsMotionStates) {
    World world;
    world.buildWall({0, 0, 0}, 1);
    btDefaultMotionState state(placeAt({5, 6, 7}));
    world.body(1).setMotionState(&state);
    world.body(1).setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    world.body(1).setActivationState(DISABLE_DEACTIVATION);
    world.step();
    world.shift({kKilometre, 0, 0});
    world.step();
    EXPECT_EQ(world.place(1), btVector3(5 - kKilometre, 6, 7));
    EXPECT_EQ(world.body(1).getLinearVelocity(), btVector3(0, 0, 0));
}

TEST(WorldOriginShift, MovesGhostsAndWhatTheyOverlap) {
    btSphereShape shape(2);
    World world;
    world.buildWall({0, 0, 0}, 3);
    const btGhostObject& ghost = world.addGhost(&shape, {1, 1, 0});
    world.step();
    const int overlapping = ghost.getNumOverlappingObjects();
    EXPECT_GT(overlapping, 3);
    world.shift({kKilometre, kKilometre, 0});
    world.step();
    EXPECT_EQ(ghost.getWorldTransform().getOrigin(), btVector3(1 - kKilometre, 1 - kKilometre, 0));
    EXPECT_EQ(ghost.getNumOverlappingObjects(), overlapping);
}

// As a program's that shows bodies, and asks nothing of them.
TEST(WorldOriginShift, TellsMotionStatesThatAnswerNothingWhereTheirBodiesAre) {
    struct WriteOnly : btMotionState {
        void getWorldTransform(btTransform& /*place*/) const override {}
        void setWorldTransform(const btTransform& place) override { last = place; }
        btTransform last = btTransform::getIdentity();
    };
    World world;
    world.buildWall({0, 0, 0}, 1);
    WriteOnly state;
    world.body(1).setMotionState(&state);
    const btTransform before = placeAt({5, 6, 7}, btQuaternion(btVector3(0, 1, 0), 1));
    world.body(1).setWorldTransform(before);
    world.shift({kKilometre, 0, 0});
    EXPECT_EQ(state.last.getOrigin(), btVector3(5 - kKilometre, 6, 7));
    EXPECT_TRUE(state.last.getBasis() == before.getBasis());
}

template <class Joint, class... Arguments>
std::unique_ptr<btTypedConstraint> make(btRigidBody& body, const btTransform& frame,
                                        Arguments... arguments) {
    return std::make_unique<Joint>(body, frame, arguments...);
}

// A body that is held by the world alone hangs where it hung, whichever joint holds it.
TEST(WorldOriginShift, MovesJointsThatHoldABodyToTheWorld) {
    const btTransform frame = placeAt({0, 1, 0});
    using Make = std::unique_ptr<btTypedConstraint> (*)(btRigidBody&, const btTransform&);
    const std::array<Make, 6> joints{
        [](btRigidBody& body, const btTransform& at) -> std::unique_ptr<btTypedConstraint> {
            return std::make_unique<btPoint2PointConstraint>(body, at.getOrigin());
        },
        [](btRigidBody& body, const btTransform& at) { return make<btHingeConstraint>(body, at); },
        [](btRigidBody& body, const btTransform& at) -> std::unique_ptr<btTypedConstraint> {
            auto joint = std::make_unique<btConeTwistConstraint>(body, at);
            joint->setFrames(at, body.getWorldTransform() * at);
            return joint;
        },
        [](btRigidBody& body, const btTransform& at) {
            return make<btSliderConstraint>(body, at, true);
        },
        [](btRigidBody& body, const btTransform& at) {
            return make<btGeneric6DofConstraint>(body, at, true);
        },
        [](btRigidBody& body, const btTransform& at) {
            return make<btGeneric6DofSpring2Constraint>(body, at);
        }};
    for (const Make& makeJoint : joints) {
        World world;
        world.world().setGravity({0, 0, 0});
        btCollisionShape* const ball = world.keep(std::make_unique<btSphereShape>(btScalar(0.5)));
        world.add(ball, 1, placeAt({kKilometre, 3, 0}));
        const std::unique_ptr<btTypedConstraint> joint = makeJoint(world.body(0), frame);
        SCOPED_TRACE(joint->getConstraintType());
        world.world().addConstraint(joint.get());
        world.step(5);
        const btVector3 place = world.place(0);
        world.shift({kKilometre, 0, 0});
        world.step(30);
        EXPECT_LT((world.place(0) - place + btVector3(kKilometre, 0, 0)).length(), 1e-3);
#if HASHPHASE_HAS_RTTI
        btCollisionWorld& anyWorld = world.world();
        EXPECT_TRUE(shiftWorldOrigin(anyWorld, world.hash(), {-kKilometre, 0, 0}));
        world.step(30);
        EXPECT_LT((world.place(0) - place).length(), 1e-3);
#endif
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
    btSphereShape shape(1);
    Soft soft;
    World world;
    soft.setCollisionShape(&shape);
    soft.setWorldTransform(placeAt({3, 0, 0}));
    world.world().addCollisionObject(&soft);
    EXPECT_FALSE(shiftWorldOrigin(world.world(), world.hash(), {1, 0, 0}));
    EXPECT_EQ(soft.getWorldTransform().getOrigin().x(), 3);
}

TEST(WorldOriginShift, OfMultibodiesIsRefusedThoughTheyHaveNoColliders) {
    const CaughtAsserts caught;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btMultiBodyConstraintSolver solver;
    SpatialHashBroadphase broadphase;
    btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    EXPECT_TRUE(shiftWorldOrigin(world, broadphase, {1, 0, 0}));
    btCollisionObject object;
    btSphereShape shape(1);
    object.setCollisionShape(&shape);
    world.addCollisionObject(&object);
    btMultiBody body(0, 1, {1, 1, 1}, false, false);
    world.addMultiBody(&body);
    EXPECT_FALSE(shiftWorldOrigin(world, broadphase, {1, 0, 0}));
#if HASHPHASE_HAS_RTTI
    btCollisionWorld& anyWorld = world;
    EXPECT_FALSE(shiftWorldOrigin(anyWorld, broadphase, {1, 0, 0}));
#endif
    EXPECT_EQ(object.getWorldTransform().getOrigin().x(), 0);
    world.removeMultiBody(&body);
    world.removeCollisionObject(&object);
}

}  // namespace
}  // namespace hashphase::test
