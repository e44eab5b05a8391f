// SPDX-License-Identifier: Zlib
//
// Pairs that a program takes out of the cache itself, as many do to reset a body, come back in the next
// step: else whoever lies there would fall through the world.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/ghost_world.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <optional>

namespace hashphase::test {
namespace {

/// A box that lies on a plane.
struct LyingBox : DynamicsWorld {
    explicit LyingBox(btOverlappingPairCache* cache = nullptr, Sweep sweep = Sweep::none)
        : DynamicsWorld(hashOver(cache, {.sweep = sweep})) {
        add(keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0))), 0,
            placeAt({0, 0, 0}));
        addBox({btScalar(0.5), btScalar(0.5), btScalar(0.5)}, 1, {0, btScalar(0.5), 0})
            .setActivationState(DISABLE_DEACTIVATION);
        step();
    }
    [[nodiscard]] btBroadphaseProxy* floor() { return body(0).getBroadphaseHandle(); }
    [[nodiscard]] btBroadphaseProxy* box() { return body(1).getBroadphaseHandle(); }
    void removePairsOfBox() { cache().removeOverlappingPairsContainingProxy(box(), &dispatcher()); }
    void removeAll(bool isDeterministic) {
        ProcessBy all([](btBroadphasePair&) { return true; });
        btDispatcherInfo info;
        info.m_deterministicOverlappingPairs = isDeterministic;
        cache().processAllOverlappingPairs(&all, &dispatcher(), info);
    }
    void expectLying() {
        step(300);
        EXPECT_GT(body(1).getWorldTransform().getOrigin().y(), btScalar(0.4));
        EXPECT_EQ(hash().validate(), "");
    }
};

using TakeOut = void (*)(LyingBox&);
constexpr std::array<TakeOut, 5> kWaysToTakeOut{
    [](LyingBox& scene) { scene.removePairsOfBox(); },
    [](LyingBox& scene) {
        scene.cache().removeOverlappingPair(scene.floor(), scene.box(), &scene.dispatcher());
    },
    [](LyingBox& scene) { scene.removeAll(false); }, [](LyingBox& scene) { scene.removeAll(true); },
    [](LyingBox& scene) {
        const std::array all{scene.box(), scene.box(), scene.box(), scene.box()};
        dynamic_cast<PairCache&>(scene.cache())
            .removeOverlappingPairsContainingProxies(all, &scene.dispatcher());
    }};

TEST(TakenOutPairs, ComeBackInTheNextStep) {
    for (const TakeOut takeOut : kWaysToTakeOut) {
        for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
            for (const Sweep sweep : {Sweep::none, Sweep::automatic}) {
                PairCache cache(order);
                LyingBox scene(&cache, sweep);
                ASSERT_EQ(scene.pairCount(), 1);
                takeOut(scene);
                ASSERT_EQ(scene.pairCount(), 0);
                scene.step();
                EXPECT_EQ(scene.pairCount(), 1);
                scene.expectLying();
            }
        }
    }
}

TEST(TakenOutPairs, ComeBackToACacheOfTheBroadphasesOwn) {
    LyingBox scene;
    scene.removePairsOfBox();
    EXPECT_EQ(scene.hash().validate(), "");
    scene.expectLying();
}

// As whoever excludes them does who knows that the filter is not asked again about what stands.
TEST(TakenOutPairs, StayOutWhereTheFilterRefusesThem) {
    FilterBy refuse(false);
    LyingBox scene;
    scene.cache().setOverlapFilterCallback(&refuse);
    scene.removePairsOfBox();
    scene.step(2);
    EXPECT_EQ(scene.pairCount(), 0);
    EXPECT_EQ(scene.hash().validate(), "");
    refuse.answer = true;
    scene.hash().refilterAll(&scene.dispatcher());
    EXPECT_EQ(scene.pairCount(), 1);
    scene.cache().setOverlapFilterCallback(nullptr);

    scene.box()->m_collisionFilterMask = 0;
    scene.removePairsOfBox();
    scene.step(2);
    EXPECT_EQ(scene.pairCount(), 0);
    EXPECT_EQ(scene.hash().validate(), "");
}

TEST(TakenOutPairs, OfWhatHasGoneSinceDoNotComeBackNorGather) {
    GhostWorld scene;
    scene.detect();
    std::size_t bytes = 0;
    for (int i = 0; i < 1000; ++i) {  // without a step
        btRigidBody spawned(1, nullptr, &scene.small);
        scene.world().addRigidBody(&spawned);
        EXPECT_TRUE(GhostWorld::doesList(scene.ghost, spawned));
        scene.cache().removeOverlappingPairsContainingProxy(spawned.getBroadphaseHandle(),
                                                            &scene.dispatcher());
        EXPECT_FALSE(GhostWorld::doesList(scene.ghost, spawned));
        scene.world().removeRigidBody(&spawned);
        bytes = i == 100 ? scene.hash().memoryBytes() : bytes;
    }
    EXPECT_LE(scene.hash().memoryBytes(), bytes);
    scene.hash().releaseUnusedMemory();
    scene.detect();
    EXPECT_EQ(scene.hash().validate(), "");
}

TEST(TakenOutPairs, AreToldToGhostsAgain) {
    GhostWorld scene;
    btRigidBody visitor(1, nullptr, &scene.small);
    scene.world().addRigidBody(&visitor);
    scene.detect();
    scene.cache().removeOverlappingPair(visitor.getBroadphaseHandle(),
                                        scene.ghost.getBroadphaseHandle(), &scene.dispatcher());
    EXPECT_FALSE(GhostWorld::doesList(scene.ghost, visitor));
    scene.detect();
    EXPECT_TRUE(GhostWorld::doesList(scene.ghost, visitor));
    EXPECT_TRUE(GhostWorld::doesList(scene.cachingGhost, visitor));
    scene.world().removeRigidBody(&visitor);
}

// --- Of a broadphase alone -----------------------------------------------------------------------

struct Row : Boxes {
    explicit Row(const std::vector<double>& places, const SpatialHashConfig& config = {},
                 const std::vector<int>& groups = {1, 1, 1, 1})
        : Boxes(config) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            create(cubeAt(btScalar(places[i])), groups[i]);
        }
        step();
    }
    void put(std::size_t i, btScalar x) { set(proxies[i], cubeAt(x)); }
    void takeOut(std::size_t i, std::size_t j) {
        cache.removeOverlappingPair(proxies[i], proxies[j], nullptr);
    }
};

TEST(TakenOutPairs, OfOneThatManyTouchCostWhatTheyAre) {
    FilterBy accept(true);
    Boxes boxes;
    btBroadphaseProxy* const floor = boxes.create({{-1, -1, -1}, {9000, 0, 1}});
    for (int i = 0; i < 3000; ++i) {
        boxes.create(cubeAt(btScalar(3 * i)));
    }
    boxes.check();
    ASSERT_EQ(boxes.pairCount(), 3000);
    boxes.cache.setOverlapFilterCallback(&accept);
    boxes.step();
    accept.asked = 0;
    for (std::size_t i = 1; i <= 300; ++i) {
        boxes.cache.removeOverlappingPair(floor, boxes.proxies[i], nullptr);
    }
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 3000);
    EXPECT_EQ(accept.asked, 300U);
}

TEST(TakenOutPairs, AreForgottenWhenThePoolIsReset) {
    const std::vector<double> places{0, 0.5, 10, 10.5};
    Row row(places);
    const std::vector<Uids> order = row.list();
    row.takeOut(2, 3);
    row.broadphase.destroyProxies(row.proxies, nullptr);
    row.broadphase.resetPool(nullptr);
    row.proxies.clear();
    for (const double x : places) {
        row.create(cubeAt(btScalar(x)));
    }
    row.check();
    EXPECT_EQ(row.list(), order);
}

TEST(TakenOutPairs, StayOutWhereTheFilterRefusesThemThoughMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    const auto make = [] {
        auto row = std::make_unique<Row>(std::vector<double>{0, 0.5});
        row->proxies[0]->m_collisionFilterMask = 0;
        row->takeOut(0, 1);
        return row;
    };
    const auto check = [](Row& row, std::size_t) {
        row.check();
        EXPECT_EQ(row.pairCount(), 0);
    };
    EXPECT_GE(runOutOfMemory(
                  make, [](Row& row) { row.step(); }, check),
              2U);
}

TEST(TakenOutPairs, AreNotNotedForABroadphaseThatHasEnded) {
    PairCache cache;
    const auto meetAndPart = [&](btBroadphaseInterface& broadphase) {
        std::array<btBroadphaseProxy*, 2> both{};
        for (btBroadphaseProxy*& each : both) {
            each = broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, -1, nullptr);
        }
        broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
        cache.removeOverlappingPair(both[0], both[1], nullptr);
        for (btBroadphaseProxy* const each : both) {
            broadphase.destroyProxy(each, nullptr);
        }
    };
    std::optional<SpatialHashBroadphase> first(std::in_place, &cache);
    meetAndPart(*first);
    first.reset();
    const std::size_t bytes = cache.memoryBytes();
    std::optional<btDbvtBroadphase> dbvt(std::in_place, &cache);
    for (int i = 0; i < 100; ++i) {
        meetAndPart(*dbvt);
    }
    dbvt.reset();
    EXPECT_LE(cache.memoryBytes(), bytes);
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
    LyingBox scene(&cache);
    former.reset();
    scene.removePairsOfBox();
    scene.step();
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
}

// While others come back a callback puts one of the two where the other is.
TEST(TakenOutPairs, ComeBackThoughACallbackMovesThem) {
    PairJournal act;
    Row row({0, 0.5, 10, 10.5});
    act.onBirth = [&](btBroadphaseProxy* a, btBroadphaseProxy* b) {
        if (uidsOf(*a, *b) == Uids(3, 4)) {
            row.put(0, 0);
        }
    };
    row.cache.setInternalGhostPairCallback(&act);
    row.takeOut(0, 1);
    row.put(0, 50);
    row.takeOut(2, 3);
    row.step();
    row.check();
    EXPECT_TRUE(row.isPair(0, 1));
    EXPECT_TRUE(row.isPair(2, 3));
}

// The end of a pair is still to be told when a callback begins it anew, at once.
TEST(PairsBegunAnew, ByACallbackAreThereAfterTheNextCalculation) {
    PairJournal act;
    SpatialHashConfig config;
    config.eagerGroups = 2;
    Row row({0, 0.5, 10, 10.5}, config, {1, 1, 2, 1});
    ASSERT_EQ(row.pairCount(), 2);
    act.onDeath = [&](btBroadphaseProxy* a, btBroadphaseProxy* b) {
        if (uidsOf(*a, *b) == Uids(1, 2)) {
            row.put(2, 10);
        }
    };
    row.cache.setInternalGhostPairCallback(&act);
    row.put(0, 50);
    row.put(2, 70);
    row.step(2);
    EXPECT_EQ(row.pairCount(), 1);
    EXPECT_TRUE(row.isPair(2, 3));
}

}  // namespace
}  // namespace hashphase::test
