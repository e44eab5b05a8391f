// SPDX-License-Identifier: Zlib

// Objects, joints and characters that come and go between a snapshot and the way back to it.

#include <integration/bullet/world_snapshot.hpp>

#include <tests/integration/bullet/pool_world.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/out_of_memory.hpp>

#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

class Churn : public testing::TestWithParam<PairOrder> {};

TEST_P(Churn, IsTakenBackEightFramesInEachFrameAsIfItHadNotBeen) {
    constexpr std::uint64_t kBack = 8;
    PoolWorld straight(GetParam());
    PoolWorld rolled(GetParam());
    std::array<WorldSnapshot, kBack> ring;
    for (std::uint64_t frame = 0; frame < 400; ++frame) {
        if (frame >= kBack) {
            ASSERT_EQ(rolled.restore(ring[frame % kBack]), "");
            for (std::uint64_t past = frame - kBack; past < frame; ++past) {
                ASSERT_EQ(rolled.save(ring[past % kBack]), "");
                rolled.play(past);
            }
        }
        ASSERT_EQ(rolled.save(ring[frame % kBack]), "");
        ASSERT_EQ(rolled.play(frame), straight.play(frame)) << "frame " << frame;
    }
}

TEST_P(Churn, IsTakenBackFromAnywhereToAnywhere) {
    PoolWorld world(GetParam());
    std::vector<WorldSnapshot> snapshots(200);
    std::vector<std::uint64_t> states;
    for (std::uint64_t frame = 0; frame < snapshots.size(); ++frame) {
        ASSERT_EQ(world.save(snapshots[frame]), "");
        states.push_back(world.play(frame));
    }
    Random random(5);
    for (int round = 0; round < 60; ++round) {
        const std::uint64_t from = random.below(180);
        ASSERT_EQ(world.restore(snapshots[from]), "");
        for (std::uint64_t frame = from; frame < from + 15; ++frame) {
            ASSERT_EQ(world.play(frame), states[frame]) << "frame " << frame << " from " << from;
        }
        for (std::uint64_t noise = 1000; noise < 1000 + random.below(10); ++noise) {
            world.play(noise);
        }
    }
}

// In canonical order, algorithms of pairs that are gone wait to be freed.
TEST_P(Churn, IsSavedBetweenRemovalAndStep) {
    PoolWorld straight(GetParam());
    PoolWorld saved(GetParam());
    WorldSnapshot snapshot;
    const auto remove = [](PoolWorld& world) {
        for (std::size_t i = 0; i < world.pool.size(); i += 2) {
            if (world.isIn(i)) {
                world.world.removeRigidBody(world.pool[i].get());
            }
        }
    };
    for (PoolWorld* world : {&straight, &saved}) {
        for (std::uint64_t frame = 0; frame < 60; ++frame) {
            world->play(frame);
        }
        remove(*world);
    }
    ASSERT_EQ(saved.save(snapshot), "");
    for (std::uint64_t frame = 900; frame < 910; ++frame) {
        saved.play(frame);
    }
    ASSERT_EQ(saved.restore(snapshot), "");
    for (std::uint64_t frame = 60; frame < 90; ++frame) {
        ASSERT_EQ(saved.play(frame), straight.play(frame)) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Orders, Churn, testing::Values(PairOrder::arrival, PairOrder::canonical),
                         [](const auto& order) {
                             return order.param == PairOrder::arrival ? "Arrival" : "Canonical";
                         });

TEST(WorldSnapshot, TakesOutWhatWasAddedSince) {
    FewBodies few;
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    few.add(10, btVector3(0, 2, 0));
    btPoint2PointConstraint joint(*few.pool[0], btVector3(0, 1, 0));
    few.world.addConstraint(&joint);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_EQ(few.restoreWithout(snapshot), "");
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_FALSE(few.isIn(10));
    EXPECT_EQ(few.world.getNumConstraints(), 0);
    EXPECT_EQ(few.world.getNumCollisionObjects(), 7);
}

// The first end of a contact takes the others to another world.
TEST(WorldSnapshot, TakesOutWhatIsLeftOfWhatWasAddedSince) {
    FewBodies few;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld other(&few.dispatcher, &broadphase, &few.solver, &few.configuration);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    for (std::size_t i = 10; i < 14; ++i) {
        few.add(i, btVector3(static_cast<btScalar>(i) / 4, btScalar(0.4), 5));
    }
    few.world.stepSimulation(btScalar(1) / 60, 0);
    std::vector<btRigidBody*> moved;
    static std::function<void(const btPersistentManifold&)> onEnd;
    onEnd = [&, isFirst = true](const btPersistentManifold& manifold) mutable {
        for (std::size_t i = 10; isFirst && i < 14; ++i) {
            btRigidBody* const body = few.pool[i].get();
            if (body != manifold.getBody0() && body != manifold.getBody1()) {
                moved.push_back(body);
            }
        }
        if (std::exchange(isFirst, false)) {
            for (btRigidBody* const body : moved) {
                few.world.removeRigidBody(body);
                other.addRigidBody(body);
            }
        }
    };
    gContactEndedCallback = [](btPersistentManifold* const& manifold) { onEnd(*manifold); };
    EXPECT_EQ(few.restoreWithout(snapshot), "");
    gContactEndedCallback = nullptr;
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_EQ(few.world.getNumCollisionObjects(), 7);
    EXPECT_GE(moved.size(), 2U);
    EXPECT_EQ(other.getNumCollisionObjects(), static_cast<int>(moved.size()));
    for (btRigidBody* const body : moved) {
        other.removeRigidBody(body);
    }
}

TEST(WorldSnapshot, NamesWhatWasRemovedSinceAndChangesNothing) {
    FewBodies few;
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    few.world.removeRigidBody(few.pool[3].get());
    few.world.stepSimulation(btScalar(1) / 60, 0);
    const std::uint64_t without = wholeState(few.world);
    EXPECT_EQ(few.restoreWithout(snapshot),
              "Object 4 (unique id 5) was removed from the world after it was saved. Hand it over "
              "as Returned::objects.");
    EXPECT_EQ(wholeState(few.world), without);
    btCollisionObject* const removed = few.pool[3].get();
    EXPECT_EQ(few.restoreWithout(snapshot, {.objects = {&removed, 1}}), "");
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_TRUE(few.isIn(3));
}

TEST(WorldSnapshot, NamesAJointThatWasRemovedSince) {
    FewBodies few;
    btHingeConstraint joint(*few.pool[0], *few.pool[1], btVector3(0, 1, 0), btVector3(0, -1, 0),
                            btVector3(0, 0, 1), btVector3(0, 0, 1));
    few.world.addConstraint(&joint, true);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    few.world.removeConstraint(&joint);
    joint.enableAngularMotor(true, 5, 1);
    EXPECT_EQ(
        few.restoreWithout(snapshot),
        "Joint 0 was removed from the world after it was saved. Hand it over as Returned::joints.");
    btTypedConstraint* const removed = &joint;
    EXPECT_EQ(few.restoreWithout(snapshot, {.joints = {&removed, 1}}), "");
    EXPECT_EQ(few.world.getNumConstraints(), 1);
    EXPECT_FALSE(joint.getEnableAngularMotor());
    EXPECT_EQ(few.pool[0]->getNumConstraintRefs(), 1);
    EXPECT_FALSE(few.pool[0]->checkCollideWith(few.pool[1].get()));
}

// It may be another one that has come to lie there.
TEST(WorldSnapshot, AsksWhetherAnObjectOfAnotherShapeIsTheSame) {
    FewBodies few;
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    btRigidBody& body = *few.pool[4];
    few.world.removeRigidBody(&body);
    body.setCollisionShape(&few.ball);
    ASSERT_NE(&few.ball, &few.shapeOf(4));
    few.world.addRigidBody(&body);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    EXPECT_EQ(
        few.restoreWithout(snapshot),
        "Object 5 (unique id 6) was removed after it was saved, and an object with another shape "
        "was added at its address. If it is the same object, hand it over as Returned::objects.");
    btCollisionObject* const same = &body;
    EXPECT_EQ(few.restoreWithout(snapshot, {.objects = {&same, 1}}), "");
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_EQ(body.getCollisionShape(), &few.shapeOf(4));
}

TEST(WorldSnapshot, GivesAnObjectItsShapeBack) {
    FewBodies few;
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    few.pool[1]->setCollisionShape(&few.pill);
    few.broadphase.shapeChanged(few.pool[1]->getBroadphaseHandle(), &few.dispatcher);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_EQ(few.restoreWithout(snapshot), "");
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_EQ(few.pool[1]->getCollisionShape(), &few.shapeOf(1));
}

TEST(WorldSnapshot, TellsMotionStatesWhereTheirBodiesAre) {
    FewBodies few;
    std::array<btDefaultMotionState, 2> states;
    for (std::size_t i = 0; i < states.size(); ++i) {
        states[i].setWorldTransform(few.pool[i]->getWorldTransform());
        few.pool[i]->setMotionState(&states[i]);
    }
    few.world.stepSimulation(btScalar(1) / 60, 0);
    // Not before: in a step, it would be woken by what it touches.
    few.pool[1]->forceActivationState(ISLAND_SLEEPING);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::array<btTransform, 2> places{states[0].m_graphicsWorldTrans,
                                            few.pool[1]->getWorldTransform()};
    for (std::size_t i = 0; i < states.size(); ++i) {
        few.pool[i]->activate(true);
        few.pool[i]->setLinearVelocity(btVector3(9, 9, 9));
    }
    for (int step = 0; step < 20; ++step) {
        few.world.stepSimulation(btScalar(1) / 60, 0);
    }
    ASSERT_FALSE(states[1].m_graphicsWorldTrans == places[1]);
    ASSERT_EQ(few.restoreWithout(snapshot), "");
    for (std::size_t i = 0; i < states.size(); ++i) {
        EXPECT_TRUE(states[i].m_graphicsWorldTrans == places[i]) << i;
        few.pool[i]->setMotionState(nullptr);
    }
}

// The program has taken pairs out of the cache: these come back in the next step, after it as before.
TEST(WorldSnapshot, KeepsWhatWasTakenOutOfTheCache) {
    PoolWorld straight;
    PoolWorld saved;
    WorldSnapshot snapshot;
    for (PoolWorld* world : {&straight, &saved}) {
        for (std::uint64_t frame = 0; frame < 60; ++frame) {
            world->play(frame);
        }
        const btBroadphasePair pair = world->cache.getOverlappingPairArray()[0];
        world->cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &world->dispatcher);
    }
    ASSERT_EQ(saved.save(snapshot), "");
    for (std::uint64_t frame = 900; frame < 910; ++frame) {
        saved.play(frame);
    }
    ASSERT_EQ(saved.restore(snapshot), "");
    ASSERT_EQ(saved.restore(snapshot), "");
    for (std::uint64_t frame = 60; frame < 90; ++frame) {
        ASSERT_EQ(saved.play(frame), straight.play(frame)) << "frame " << frame;
    }
}

// Of two worlds with one dispatcher, the other one keeps its contacts, and their order.
TEST(WorldSnapshot, LeavesTheContactsOfAnotherWorldAlone) {
    FewBodies few;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld other(&few.dispatcher, &broadphase, &few.solver, &few.configuration);
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    for (std::size_t i = 10; i < 40; ++i) {
        few.pool[i]->setCenterOfMassTransform(
            btTransform(btQuaternion(0, 0, 0, 1), btVector3(0, btScalar(i) / 8, 0)));
        other.addRigidBody(few.pool[i].get());
    }
    other.stepSimulation(btScalar(1) / 60, 0);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    const auto contactsOfOther = [&] {
        std::vector<const btPersistentManifold*> list;
        for (int i = 0; i < few.dispatcher.getNumManifolds(); ++i) {
            const btPersistentManifold* manifold = few.dispatcher.getManifoldByIndexInternal(i);
            if (manifold->getBody0()->getUserIndex() >= 10) {
                list.push_back(manifold);
            }
        }
        return list;
    };
    const std::vector<const btPersistentManifold*> before = contactsOfOther();
    ASSERT_GT(before.size(), 40U);
    ASSERT_EQ(few.restoreWithout(snapshot), "");
    EXPECT_EQ(contactsOfOther(), before);
    for (std::size_t i = 10; i < 40; ++i) {
        other.removeRigidBody(few.pool[i].get());
    }
}

// As programs have them that ask the broadphase about more than bodies.
TEST(WorldSnapshot, KeepsProxiesWithoutAnObject) {
    FewBodies few;
    few.dispatcher.setNearCallback([](btBroadphasePair& pair, btCollisionDispatcher& dispatcher,
                                      const btDispatcherInfo& info) {
        if (pair.m_pProxy0->m_clientObject != nullptr &&
            pair.m_pProxy1->m_clientObject != nullptr) {
            btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
        }
    });
    btBroadphaseProxy* const mark = few.broadphase.createProxy(
        btVector3(-2, -2, -2), btVector3(2, 9, 2), 0, nullptr, btBroadphaseProxy::DefaultFilter,
        btBroadphaseProxy::AllFilter, &few.dispatcher);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    const int pairs = few.cache.getNumOverlappingPairs();
    WorldSnapshot snapshot;
    ASSERT_EQ(few.save(snapshot), "");
    const std::uint64_t state = wholeState(few.world);
    few.broadphase.setAabb(mark, btVector3(90, 90, 90), btVector3(91, 91, 91), &few.dispatcher);
    few.world.stepSimulation(btScalar(1) / 60, 0);
    ASSERT_LT(few.cache.getNumOverlappingPairs(), pairs);
    ASSERT_EQ(few.restoreWithout(snapshot), "");
    EXPECT_EQ(wholeState(few.world), state);
    EXPECT_EQ(few.cache.getNumOverlappingPairs(), pairs);
    std::vector<std::byte> bytes;
    EXPECT_NE(snapshot.write(bytes).find("the object of a proxy"), std::string::npos);
    few.broadphase.destroyProxy(mark, &few.dispatcher);
}

TEST(WorldSnapshot, ChangesNothingWhereMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "no allocation fails here";
    }
    struct TwoStates : FewBodies {
        TwoStates() {
            static_cast<void>(save(first));
            for (std::size_t i = 6; i < 30; ++i) {
                add(i, btVector3(0, 2, 0));  // so that many pairs go
            }
            world.stepSimulation(btScalar(1) / 60, 0);
            state = wholeState(world);
        }
        WorldSnapshot first;
        std::uint64_t state = 0;
    };
    std::uint64_t then = 0;
    {
        TwoStates whole;
        ASSERT_EQ(whole.restore(whole.first), "");
        then = wholeState(whole.world);
    }
    const std::size_t failures =
        runOutOfMemory([] { return std::make_unique<TwoStates>(); },
                       [](TwoStates& two) { static_cast<void>(two.restoreWithout(two.first)); },
                       [&](TwoStates& two, std::size_t) {
                           if (two.isIn(20)) {
                               EXPECT_EQ(wholeState(two.world), two.state);
                               ASSERT_EQ(two.restoreWithout(two.first), "");
                           }
                           EXPECT_EQ(wholeState(two.world), then);
                       });
    EXPECT_GT(failures, 1U);
    const std::size_t failedSaves = runOutOfMemory(
        [] { return std::make_unique<TwoStates>(); },
        [](TwoStates& two) {
            WorldSnapshot snapshot;
            static_cast<void>(two.save(snapshot));
        },
        [&](TwoStates& two, std::size_t) { EXPECT_EQ(wholeState(two.world), two.state); });
    EXPECT_GT(failedSaves, 10U);
}

}  // namespace
}  // namespace hashphase::test
