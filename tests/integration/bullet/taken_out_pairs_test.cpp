// SPDX-License-Identifier: Zlib
//
// Pairs that a program takes out of the cache itself, as many do to reset a body, come back in the next
// step: else whoever lies there would fall through the world.

#include <tests/integration/bullet/ghost_world.hpp>

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <tests/support/out_of_memory.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <new>
#include <optional>
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

/// Boxes of a broadphase alone, each 1 m wide.
struct Boxes {
    explicit Boxes(std::vector<btScalar> places, PairOrder order = PairOrder::arrival)
        : cache(order) {
        for (const btScalar x : places) {
            proxies.push_back(
                broadphase.createProxy({x, 0, 0}, {x + 1, 1, 1}, 0, nullptr, 1, -1, nullptr));
        }
        broadphase.calculateOverlappingPairs(nullptr);
    }
    void put(std::size_t i, btScalar x) {
        broadphase.setAabb(proxies[i], {x, 0, 0}, {x + 1, 1, 1}, nullptr);
    }
    void takeOut(std::size_t i, std::size_t j) {
        cache.removeOverlappingPair(proxies[i], proxies[j], nullptr);
    }
    void calculate() {
        broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(broadphase.validate(), "");
    }
    [[nodiscard]] bool isPair(std::size_t i, std::size_t j) {
        return cache.findPair(proxies[i], proxies[j]) != nullptr;
    }
    /// Unique ids, in the order of the array.
    [[nodiscard]] std::vector<int> order() {
        std::vector<int> ids;
        btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i) {
            ids.push_back(pairs[i].m_pProxy0->m_uniqueId);
            ids.push_back(pairs[i].m_pProxy1->m_uniqueId);
        }
        return ids;
    }

    PairCache cache;
    SpatialHashBroadphase broadphase{&cache};
    std::vector<btBroadphaseProxy*> proxies;
};

// A pair of a proxy whose mask has been written since stands until the two part, whoever else is reset.
TEST(TakenOutPairs, AreNoBusinessOfOtherPairs) {
    Boxes boxes({0, btScalar(0.4), btScalar(0.8), 20});
    boxes.proxies[0]->m_collisionFilterMask = 0;
    boxes.takeOut(1, 2);
    boxes.put(3, 30);
    boxes.calculate();
    EXPECT_TRUE(boxes.isPair(0, 1));
    EXPECT_TRUE(boxes.isPair(1, 2));
}

TEST(TakenOutPairs, OfOneThatManyTouchCostWhatTheyAre) {
    Boxes boxes({});
    btBroadphaseProxy* const floor =
        boxes.broadphase.createProxy({-1, -1, -1}, {9000, 0, 1}, 0, nullptr, 1, -1, nullptr);
    for (int i = 0; i < 3000; ++i) {
        boxes.proxies.push_back(boxes.broadphase.createProxy(
            {btScalar(3 * i), 0, 0}, {btScalar(3 * i + 1), 1, 1}, 0, nullptr, 1, -1, nullptr));
    }
    boxes.calculate();
    ASSERT_EQ(boxes.cache.getNumOverlappingPairs(), 3000);
    struct Count : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* /*a*/,
                                     btBroadphaseProxy* /*b*/) const override {
            ++asked;
            return true;
        }
        mutable int asked = 0;
    } count;
    boxes.cache.setOverlapFilterCallback(&count);
    boxes.calculate();
    count.asked = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        boxes.cache.removeOverlappingPair(floor, boxes.proxies[i], nullptr);
    }
    boxes.calculate();
    EXPECT_EQ(boxes.cache.getNumOverlappingPairs(), 3000);
    EXPECT_EQ(count.asked, 300);
    boxes.cache.setOverlapFilterCallback(nullptr);
}

TEST(TakenOutPairs, AreForgottenWhenThePoolIsReset) {
    Boxes fresh({0, btScalar(0.5), 10, btScalar(10.5)});
    const std::vector<int> order = fresh.order();
    fresh.takeOut(2, 3);
    fresh.broadphase.destroyProxies(fresh.proxies, nullptr);
    fresh.broadphase.resetPool(nullptr);
    fresh.proxies.clear();
    for (const btScalar x : {btScalar(0), btScalar(0.5), btScalar(10), btScalar(10.5)}) {
        fresh.proxies.push_back(
            fresh.broadphase.createProxy({x, 0, 0}, {x + 1, 1, 1}, 0, nullptr, 1, -1, nullptr));
    }
    fresh.calculate();
    EXPECT_EQ(fresh.order(), order);
}

TEST(TakenOutPairs, StayOutWhereTheFilterRefusesThemThoughMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    const auto make = [] {
        auto boxes = std::make_unique<Boxes>(std::vector<btScalar>{0, btScalar(0.5)});
        boxes->proxies[0]->m_collisionFilterMask = 0;
        boxes->takeOut(0, 1);
        return boxes;
    };
    EXPECT_GE(runOutOfMemory(
                  make, [](Boxes& boxes) { boxes.broadphase.calculateOverlappingPairs(nullptr); },
                  [](Boxes& boxes, std::size_t) {
                      boxes.calculate();
                      EXPECT_EQ(boxes.cache.getNumOverlappingPairs(), 0);
                  }),
              2U);
}

TEST(TakenOutPairs, AreNotNotedForABroadphaseThatHasEnded) {
    PairCache cache;
    std::optional<SpatialHashBroadphase> first(std::in_place, &cache);
    const auto meetAndPart = [&](btBroadphaseInterface& broadphase) {
        btBroadphaseProxy* const a =
            broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
        btBroadphaseProxy* const b =
            broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
        broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
        cache.removeOverlappingPair(a, b, nullptr);
        broadphase.destroyProxy(a, nullptr);
        broadphase.destroyProxy(b, nullptr);
    };
    meetAndPart(*first);
    first.reset();
    const std::size_t bytes = cache.memoryBytes();
    {
        btDbvtBroadphase other(&cache);
        for (int i = 0; i < 100; ++i) {
            meetAndPart(other);
        }
        EXPECT_LE(cache.memoryBytes(), bytes);
    }
    SpatialHashBroadphase plain(static_cast<btOverlappingPairCache*>(&cache));
    for (int i = 0; i < 100; ++i) {
        meetAndPart(plain);
    }
    EXPECT_LE(cache.memoryBytes(), bytes);
}

// In the wrong order, as some programs end.
TEST(TakenOutPairs, AreNotWrittenToACacheThatHasEnded) {
    alignas(PairCache) std::array<std::byte, sizeof(PairCache)> memory;
    auto* const cache = new (memory.data()) PairCache();
    std::optional<SpatialHashBroadphase> broadphase(std::in_place, cache);
    cache->~PairCache();
    memory.fill(std::byte{0xab});
    broadphase.reset();
    EXPECT_TRUE(std::all_of(memory.begin(), memory.end(),
                            [](std::byte each) { return each == std::byte{0xab}; }));
}

// As by `broadphase = std::make_unique<SpatialHashBroadphase>(&cache)`.
TEST(TakenOutPairs, ComeBackWhereTheCacheHadAnotherBroadphaseUntilThen) {
    PairCache cache;
    auto former = std::make_unique<SpatialHashBroadphase>(&cache);
    SpatialHashBroadphase broadphase(&cache);
    former.reset();
    LyingBox scene(broadphase);
    removePairsOfBox(scene);
    scene.step(1);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
}

/// Forwards to nobody, and does something about one pair.
struct Act : btOverlappingPairCallback {
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        note(added, a, b);
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* /*dispatcher*/) override {
        note(removed, a, b);
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* /*proxy*/,
                                               btDispatcher* /*dispatcher*/) override {}
    static void note(std::function<void(int, int)>& action, btBroadphaseProxy* a,
                     btBroadphaseProxy* b) {
        if (action) {
            action(a->m_uniqueId, b->m_uniqueId);
        }
    }

    std::function<void(int, int)> added;
    std::function<void(int, int)> removed;
};

// While others come back a callback puts one of the two where the other is.
TEST(TakenOutPairs, ComeBackThoughACallbackMovesThem) {
    Boxes boxes({0, btScalar(0.5), 10, btScalar(10.5)});
    Act act;
    act.added = [&](int a, int b) {
        if (a == 3 && b == 4) {
            boxes.put(0, 0);
        }
    };
    boxes.cache.setInternalGhostPairCallback(&act);
    boxes.takeOut(0, 1);
    boxes.put(0, 50);
    boxes.takeOut(2, 3);
    boxes.broadphase.calculateOverlappingPairs(nullptr);
    boxes.calculate();
    EXPECT_TRUE(boxes.isPair(0, 1));
    EXPECT_TRUE(boxes.isPair(2, 3));
    boxes.cache.setInternalGhostPairCallback(nullptr);
}

// The end of a pair is still to be told when a callback begins it anew, at once.
TEST(PairsBegunAnew, ByACallbackAreThereAfterTheNextCalculation) {
    Act act;
    PairCache cache;
    SpatialHashConfig config;
    config.eagerGroups = 2;
    SpatialHashBroadphase broadphase(&cache, config);
    std::vector<btBroadphaseProxy*> proxies;
    const auto put = [&](std::size_t i, btScalar x) {
        broadphase.setAabb(proxies[i], {x, 0, 0}, {x + 1, 1, 1}, nullptr);
    };
    for (const btScalar x : {btScalar(0), btScalar(0.5), btScalar(10), btScalar(10.5)}) {
        proxies.push_back(broadphase.createProxy({x, 0, 0}, {x + 1, 1, 1}, 0, nullptr,
                                                 x == btScalar(10) ? 2 : 1, -1, nullptr));
    }
    broadphase.calculateOverlappingPairs(nullptr);
    ASSERT_EQ(cache.getNumOverlappingPairs(), 2);
    act.removed = [&](int a, int b) {
        if (a == 1 && b == 2) {
            put(2, 10);
        }
    };
    cache.setInternalGhostPairCallback(&act);
    put(0, 50);
    put(2, 70);
    broadphase.calculateOverlappingPairs(nullptr);
    broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
    EXPECT_NE(cache.findPair(proxies[2], proxies[3]), nullptr);
    cache.setInternalGhostPairCallback(nullptr);
}

}  // namespace
}  // namespace hashphase::test
