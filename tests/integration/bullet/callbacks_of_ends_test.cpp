// SPDX-License-Identifier: Zlib

// Callbacks that are told of the end of pairs while proxies are destroyed, set or filtered in a batch, and change
// others of the batch, or bring about new pairs with who is on the way out.

#include <tests/integration/bullet/cache_side.hpp>
#include <tests/integration/bullet/many_worlds.hpp>
#include <tests/support/handlers.hpp>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

const Box kPlace = ManyWorlds::kPlace;
const Box kFar = boxAround({50, 0, 0}, {1, 1, 1});

/// Two worlds, in which who is eager finds pairs at once.
struct Ends : ManyWorlds {
    explicit Ends() : ManyWorlds(2, eagerCharactersAndSensors()) {
        cache.setInternalGhostPairCallback(&journal);
    }
    /// The first end of a pair does this.
    void onFirstEnd(std::function<void()> act) {
        journal.onDeath = [isFirst = true, act = std::move(act)](btBroadphaseProxy*,
                                                                 btBroadphaseProxy*) mutable {
            if (std::exchange(isFirst, false)) {
                act();
            }
        };
    }
    PairJournal journal;
};

TEST(CallbacksOfEnds, FindNoPairsThatOutliveAProxyOnItsWayOut) {
    using Destroy = std::function<void(Ends&, btBroadphaseProxy*)>;
    const std::array<Destroy, 4> ways{
        [](Ends& ends, btBroadphaseProxy* x) { ends.worlds.destroyProxy(x, nullptr); },
        [](Ends& ends, btBroadphaseProxy* x) {
            ends.worlds.destroyProxies({&x, 1}, nullptr);
        },
        [](Ends& ends, btBroadphaseProxy* x) { ends.worlds.world(0).destroyProxy(x, nullptr); },
        [](Ends& ends, btBroadphaseProxy* x) {
            ends.worlds.world(0).destroyProxies({&x, 1}, nullptr);
        }};
    const auto nothing = [](Ends& /*ends*/) {};
    const std::array<std::function<void(Ends&)>, 3> calculations{
        nothing, [](Ends& ends) { ends.step(); },
        [](Ends& ends) { ends.worlds.world(0).calculateOverlappingPairs(nullptr); }};
    for (const Destroy& destroy : ways) {
        for (const auto& calculate : calculations) {
            Ends ends;
            btBroadphaseProxy* const x = ends.createIn(0, kPlace);
            ends.createIn(0, kPlace);
            btBroadphaseProxy* const eager = ends.createIn(0, kFar, ManyWorlds::kCharacter);
            btBroadphaseProxy* const plain = ends.createIn(0, kFar);
            ends.step();
            const bool isEager = &calculate == &calculations[0];
            ends.onFirstEnd([&] {
                ends.set(isEager ? eager : plain, kPlace);
                calculate(ends);
            });
            destroy(ends, x);
            std::erase(ends.proxies, x);
            ends.check();
            ends.set(isEager ? eager : plain, kFar);
            ends.check();
            EXPECT_EQ(ends.list().size(), 1U) << "the two that are far away";
        }
    }
}

TEST(CallbacksOfEnds, MayMakeEagerProxiesWhereOneGoes) {
    Ends ends;
    btBroadphaseProxy* const x = ends.createIn(0, kPlace);
    ends.createIn(0, kPlace);
    ends.step();
    int made = 0;
    ends.journal.onDeath = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        if (++made < 100) {
            ends.createIn(0, kPlace, ManyWorlds::kCharacter);
        }
    };
    ends.destroy(x);
    EXPECT_LT(made, 10) << "one that has left finds no more pairs";
    ends.journal.onDeath = nullptr;
    ends.check();
}

TEST(CallbacksOfEnds, MayDestroyOthersOfABatchAndMakeNewOnesInTheirPlaces) {
    for (const bool isNewOneMade : {false, true}) {
        for (const bool isOneWorld : {false, true}) {
            Ends ends;
            for (int i = 0; i < 4; ++i) {
                ends.createIn(0, kPlace);
            }
            ends.step();
            const std::vector<btBroadphaseProxy*> batch(ends.proxies.begin(),
                                                        ends.proxies.begin() + 3);
            ends.onFirstEnd([&] {
                ends.destroy(batch[2]);
                if (isNewOneMade) {
                    ends.createIn(0, kPlace);
                }
            });
            if (isOneWorld) {
                ends.worlds.world(0).destroyProxies(batch, nullptr);
            } else {
                ends.worlds.destroyProxies(batch, nullptr);
            }
            std::erase(ends.proxies, batch[0]);
            std::erase(ends.proxies, batch[1]);
            EXPECT_EQ(ends.worlds.world(0).grid().size(), isNewOneMade ? 2U : 1U);
            ends.check();
        }
    }
}

TEST(CallbacksOfEnds, MayDestroyOthersWhoseBoxesAreToBeSet) {
    for (const bool isOneWorld : {false, true}) {
        Ends ends;
        ends.createIn(0, kPlace);
        btBroadphaseProxy* const eager = ends.createIn(0, kPlace, ManyWorlds::kCharacter);
        btBroadphaseProxy* const other = ends.createIn(0, kPlace);
        ends.step();
        btBroadphaseProxy* made = nullptr;
        ends.journal.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
            if (made == nullptr) {
                made = other;  // once
                ends.destroy(other);
                made = ends.createIn(0, kFar);
            }
        };
        ends.set(eager, kFar);
        ends.step();
        const std::array<btBroadphaseProxy*, 2> batch{eager, other};
        const std::array<btVector3, 2> lows{kPlace.min, btVector3(90, 0, 0)};
        const std::array<btVector3, 2> highs{kPlace.max, btVector3(91, 1, 1)};
        if (isOneWorld) {
            ends.worlds.world(0).setAabbs(batch, lows, highs, nullptr);
        } else {
            ends.worlds.setAabbs(batch, lows, highs, nullptr);
        }
        ASSERT_NE(made, nullptr);
        EXPECT_EQ(made->m_aabbMin, kFar.min);
        ends.check();
    }
}

TEST(CallbacksOfEnds, MayDestroyThoseOfOtherWorldsThatAreFilteredNext) {
    Ends ends;
    btBroadphaseProxy* const first = ends.createIn(0, kPlace);
    ends.createIn(0, kPlace);
    btBroadphaseProxy* const second = ends.createIn(1, kPlace);
    btBroadphaseProxy* const third = ends.createIn(1, kPlace);
    ends.step();
    first->m_collisionFilterMask = 0;
    ends.onFirstEnd([&] { ends.destroy(second); });
    const std::array<btBroadphaseProxy*, 3> batch{first, second, third};
    ends.worlds.refilter(batch, nullptr);
    ends.check();
    ends.worlds.collisionChecksChanged(std::span(batch).first(1), nullptr);
    EXPECT_TRUE(ends.list().empty());
}

// A contact-ended callback may remove a body while the cache frees what is due: before it is given the pairs that a
// step which failed has left out.
template <class MakeBroadphase>
void removeABodyThatIsAboutToPair(const MakeBroadphase& make) {
    static btRigidBody* victim;
    static btDiscreteDynamicsWorld* where;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btSequentialImpulseConstraintSolver solver;
    PairCache cache(PairOrder::canonical);
    const auto broadphase = make(cache);
    btBoxShape shape(btVector3(1, 1, 1));
    btDiscreteDynamicsWorld world(&dispatcher, broadphase.get(), &solver, &configuration);
    world.setGravity({0, 0, 0});
    where = &world;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
    const auto placeAt = [](btScalar x) {
        return btTransform(btQuaternion::getIdentity(), btVector3(x, 0, 0));
    };
    for (const btScalar x : {btScalar(0), btScalar(1.9), btScalar(50), btScalar(70)}) {
        bodies.push_back(std::make_unique<btRigidBody>(1, nullptr, &shape, btVector3(1, 1, 1)));
        bodies.back()->setWorldTransform(placeAt(x));
        bodies.back()->setUserIndex(0);
        bodies.back()->setActivationState(DISABLE_DEACTIVATION);
        world.addRigidBody(bodies.back().get());
    }
    world.stepSimulation(btScalar(1) / 60, 0);
    gContactEndedCallback = [](btPersistentManifold* const& /*manifold*/) {
        if (victim != nullptr) {
            where->removeRigidBody(std::exchange(victim, nullptr));
        }
    };
    PairJournal journal;
    cache.setInternalGhostPairCallback(&journal);
    journal.onBirth = [](auto*, auto*) { throw std::runtime_error("A step fails."); };
    bodies[2]->setWorldTransform(placeAt(btScalar(70.5)));
    world.updateAabbs();
    EXPECT_THROW(broadphase->calculateOverlappingPairs(&dispatcher), std::runtime_error);
    journal.onBirth = nullptr;
    broadphase->ignorePair(bodies[0]->getBroadphaseProxy(), bodies[1]->getBroadphaseProxy(),
                           &dispatcher);
    victim = bodies[2].get();
    broadphase->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(victim, nullptr);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
    EXPECT_EQ(broadphase->validate(), "");
    world.stepSimulation(btScalar(1) / 60, 0);
    gContactEndedCallback = nullptr;
    for (const auto& body : bodies) {
        world.removeRigidBody(body.get());
    }
}

TEST(CallbacksOfEnds, OfContactsMayRemoveABodyThatIsAboutToPair) {
    removeABodyThatIsAboutToPair(
        [](PairCache& cache) { return std::make_unique<SpatialHashBroadphase>(&cache); });
    removeABodyThatIsAboutToPair([](PairCache& cache) {
        return std::make_unique<WorldsBroadphase>(&cache, worldsByUserIndex(1));
    });
}

TEST(CallbacksOfEnds, MayDestroyOthersWhilePairsLeaveACacheThatDefersRemoval) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    std::vector<Uids> freed;
    AnyBoxes boxes(std::make_unique<btSortedOverlappingPairCache>());
    for (const double x : {0.0, 0.5, 10.0, 10.5, 10.6}) {
        boxes.create(cubeAt(btScalar(x)));
    }
    boxes.step();
    ASSERT_EQ(boxes.pairCount(), 4);
    const NotedAlgorithm::Act destroyAnother = [&](const Uids& /*ended*/) {
        boxes.destroy(boxes.proxies[3]);
    };
    btBroadphasePair* const parting =
        boxes.pairCache().findPair(boxes.proxies[0], boxes.proxies[1]);
    ASSERT_NE(parting, nullptr);
    NotedAlgorithm::giveTo(*parting, dispatcher, freed, destroyAnother);
    boxes.set(boxes.proxies[0], cubeAt(50));
    boxes.over->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(freed, std::vector<Uids>{Uids(1, 2)});
    ASSERT_EQ(boxes.pairCount(), 1) << "the one that the destroyed proxy has no part in";
    EXPECT_EQ(boxes.list(), std::vector<Uids>{Uids(3, 5)});
    boxes.over->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(boxes.list(), std::vector<Uids>{Uids(3, 5)});
    EXPECT_EQ(boxes.hash().validate(), "");
}

TEST(CallbacksOfEnds, MayDestroyProxiesOfPairsThatAreYetToLeaveACacheThatDefersRemoval) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    std::vector<Uids> freed;
    AnyBoxes boxes(std::make_unique<btSortedOverlappingPairCache>());
    for (const double x : {0.0, 0.5, 0.6}) {
        boxes.create(cubeAt(btScalar(x)));
    }
    boxes.step();
    const NotedAlgorithm::Act destroyTheOther = [&](const Uids& ended) {
        if (freed.size() == 1) {
            const std::size_t other = ended == Uids(1, 2) ? 2 : 1;
            boxes.over->destroyProxy(boxes.proxies[other], &dispatcher);
            EXPECT_EQ(freed.size(), 2U) << "before its object may go";
            boxes.proxies.erase(boxes.proxies.begin() + static_cast<std::ptrdiff_t>(other));
        }
    };
    for (const std::size_t other : {1U, 2U}) {
        btBroadphasePair* const pair =
            boxes.pairCache().findPair(boxes.proxies[0], boxes.proxies[other]);
        ASSERT_NE(pair, nullptr);
        NotedAlgorithm::giveTo(*pair, dispatcher, freed, destroyTheOther);
    }
    boxes.set(boxes.proxies[0], cubeAt(50));
    boxes.over->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(freed.size(), 2U);
    EXPECT_EQ(boxes.pairCount(), 0);
    boxes.over->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(boxes.hash().validate(), "");
}

TEST(CallbacksOfEnds, MayThrowWhilePairsLeaveACacheThatDefersRemoval) {
    btDefaultCollisionConfiguration configuration;
    ThrowingDispatcher dispatcher(&configuration);
    std::vector<Uids> freed;
    const NotedAlgorithm::Act nothing;
    AnyBoxes boxes(std::make_unique<btSortedOverlappingPairCache>());
    for (const double x : {0.0, 0.5, 0.6, 0.7}) {
        boxes.create(cubeAt(btScalar(x)));
    }
    boxes.step();
    for (const std::size_t other : {1U, 2U, 3U}) {
        btBroadphasePair* const pair =
            boxes.pairCache().findPair(boxes.proxies[0], boxes.proxies[other]);
        ASSERT_NE(pair, nullptr);
        NotedAlgorithm::giveTo(*pair, dispatcher, freed, nothing);
    }
    boxes.set(boxes.proxies[0], cubeAt(50));
    EXPECT_THROW(boxes.over->calculateOverlappingPairs(&dispatcher), std::runtime_error);
    EXPECT_EQ(inOrder(freed), (std::vector<Uids>{{1, 2}, {1, 3}, {1, 4}}));
    EXPECT_EQ(boxes.pairCount(), 3);
    boxes.over->destroyProxy(boxes.proxies[1], &dispatcher);  // looks at what is yet to leave
    boxes.proxies.erase(boxes.proxies.begin() + 1);
    boxes.over->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(boxes.pairCount(), 1);
    EXPECT_EQ(boxes.hash().validate(), "");
}

TEST(CallbacksOfEnds, MayDestroyOthersWhileAShapeChangesInACacheThatDefersRemoval) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    std::vector<Uids> freed;
    AnyBoxes boxes(std::make_unique<btSortedOverlappingPairCache>());
    for (const double x : {0.0, 0.5, 0.6, 0.7}) {
        boxes.create(cubeAt(btScalar(x)));
    }
    boxes.step();
    ASSERT_EQ(boxes.pairCount(), 6);
    const NotedAlgorithm::Act destroyAnother = [&](const Uids& ended) {
        if (freed.size() == 1) {
            const std::size_t other = ended == Uids(1, 2) ? 2 : 1;
            boxes.over->destroyProxy(boxes.proxies[other], &dispatcher);
            boxes.proxies.erase(boxes.proxies.begin() + static_cast<std::ptrdiff_t>(other));
        }
    };
    btBroadphasePairArray& pairs = boxes.pairCache().getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        NotedAlgorithm::giveTo(pairs[i], dispatcher, freed, destroyAnother);
    }
    boxes.hash().shapeChanged(boxes.proxies[0], &dispatcher);
    // Three of the first proxy, and two more of the one that was destroyed.
    EXPECT_EQ(freed.size(), 5U);
    ASSERT_EQ(boxes.pairCount(), 3);
    for (int i = 0; i < pairs.size(); ++i) {
        const bool isOfFirst = uidsOf(pairs[i]).first == 1;
        EXPECT_EQ(pairs[i].m_algorithm == nullptr, isOfFirst);
        boxes.pairCache().cleanOverlappingPair(pairs[i], &dispatcher);
    }
    EXPECT_EQ(freed.size(), 6U);
    boxes.over->calculateOverlappingPairs(&dispatcher);
    EXPECT_EQ(boxes.hash().validate(), "");
}

TEST(CallbacksOfEnds, ReleaseNoMemory) {
    ManyWorlds boxes(1);
    PairJournal journal;
    boxes.cache.setInternalGhostPairCallback(&journal);
    for (const double x : {0.0, 0.5, 1.0}) {
        boxes.createIn(0, cubeAt(btScalar(x)));
    }
    boxes.step();
    const CaughtAsserts caught;
    int calls = 0;
    journal.onDeath = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        ++calls;
        boxes.worlds.world(0).releaseUnusedMemory();
        boxes.worlds.releaseUnusedMemory();
    };
    boxes.worlds.destroyProxies(boxes.proxies, nullptr);
    boxes.proxies.clear();
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(caught.count(), HASHPHASE_ENABLE_ASSERTS ? 2 * calls : 0);
    boxes.step();
    EXPECT_EQ(boxes.worlds.validate(), "");
}

TEST(WorldsBroadphase, HasTheBoundsOfOneBroadphaseWithTheSameBoxes) {
    ManyWorlds boxes(2);
    SpatialHashBroadphase one;
    for (const Box& box : {Box{{5, 5, 5}, {-5, -5, -5}}, Box{{7, 7, 7}, {101, 9, 9}}}) {
        boxes.createIn(boxes.proxies.empty() ? 0 : 1, box);
        one.createProxy(box.min, box.max, 0, nullptr, 1, -1, nullptr);
    }
    Box ofAll;
    Box expected;
    boxes.worlds.getBroadphaseAabb(ofAll.min, ofAll.max);
    one.getBroadphaseAabb(expected.min, expected.max);
    EXPECT_EQ(ofAll.min, expected.min);
    EXPECT_EQ(ofAll.max, expected.max);
}

}  // namespace
}  // namespace hashphase::test
