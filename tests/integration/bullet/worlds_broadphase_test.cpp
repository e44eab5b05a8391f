// SPDX-License-Identifier: Zlib

// Worlds at one place that never pair, against brute force, and what is asked of one and of all. Whole worlds
// of bodies are in worlds_dynamics_test.cpp, misuse and want of memory in worlds_misuse_test.cpp.

#include <tests/integration/bullet/many_worlds.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kWorldCount = 20;

// --- Pairs ---------------------------------------------------------------------------------------

/// What may happen to boxes between two steps, in several broadphases alike.
class WorldsScript {
public:
    explicit WorldsScript(std::uint64_t seed) : random_(seed) {}

    void add(const SpatialHashConfig& each, PairOrder order) {
        all.push_back(std::make_unique<ManyWorlds>(kWorldCount, each, order));
    }

    void act() {
        const std::size_t count = all[0]->proxies.size();
        const auto one = [&] {
            return static_cast<std::size_t>(random_.below(static_cast<int>(count)));
        };
        const int what = count < 150 ? 0 : random_.below(100);
        if (what < 12) {
            create();
        } else if (what < 20) {
            destroy(one());
        } else if (what < 75) {
            move(one());
        } else if (what < 80) {
            changeWorld(one());
        } else if (what < 87) {
            regroup(one());
        } else if (what < 92) {
            ignore(one(), one(), random_.below(3) > 0);
        } else if (what < 97) {
            takeOut();
        } else {
            destroyMany(one(), one());
        }
    }

    std::vector<std::unique_ptr<ManyWorlds>> all;

private:
    Box anywhere() {
        const btVector3 low = random_.vector(-2, 2);
        return {low, low + random_.vector(0.5, 2)};
    }
    void create() {
        const int world = random_.below(kWorldCount);
        const int group =
            random_.below(8) == 0 ? ManyWorlds::kCharacter : btBroadphaseProxy::DefaultFilter;
        const Box box = anywhere();
        for (const auto& boxes : all) {
            boxes->createIn(world, box, group);
        }
    }
    void destroy(std::size_t i) {
        for (const auto& boxes : all) {
            boxes->destroy(boxes->proxies[i]);
        }
    }
    void destroyMany(std::size_t i, std::size_t k) {
        const std::size_t first = std::min(i, k);
        const std::size_t last = std::min(std::max(i, k), first + 9);
        for (const auto& boxes : all) {
            const auto begin = boxes->proxies.begin() + std::ptrdiff_t(first);
            const auto end = boxes->proxies.begin() + std::ptrdiff_t(last);
            boxes->worlds.destroyProxies(std::span<btBroadphaseProxy* const>(begin, end), nullptr);
            boxes->proxies.erase(begin, end);
        }
    }
    void move(std::size_t i) {
        const Box box = random_.below(3) == 0 ? anywhere() : boxOf(*all[0]->proxies[i]);
        const btVector3 by = random_.vector(-0.3, 0.3);
        for (const auto& boxes : all) {
            boxes->set(boxes->proxies[i], {box.min + by, box.max + by});
        }
    }
    void changeWorld(std::size_t i) {
        const int world = random_.below(kWorldCount);
        for (const auto& boxes : all) {
            boxes->moveToWorld(i, world);
        }
    }
    void regroup(std::size_t i) {
        const int mask =
            random_.below(2) == 0 ? btBroadphaseProxy::AllFilter : ManyWorlds::kCharacter;
        for (const auto& boxes : all) {
            boxes->proxies[i]->m_collisionFilterMask = mask;
            boxes->worlds.refilter(boxes->proxies[i], nullptr);
        }
    }
    void ignore(std::size_t i, std::size_t k, bool ignores) {
        for (const auto& boxes : all) {
            btBroadphaseProxy* const a = boxes->proxies[i];
            btBroadphaseProxy* const b = boxes->proxies[k];
            if (i != k && ignores) {
                boxes->worlds.ignorePair(a, b, nullptr);
                if (boxes->areOfOneWorld(*a, *b)) {
                    boxes->ignored.insert(uidsOf(*a, *b));
                }
                EXPECT_EQ(boxes->worlds.isIgnoredPair(a, b), boxes->areOfOneWorld(*a, *b));
            } else if (i != k) {
                boxes->worlds.stopIgnoringPair(a, b, nullptr);
                boxes->ignored.erase(uidsOf(*a, *b));
            }
        }
    }
    void takeOut() {
        const int count = all[0]->pairCount();
        const int number = count > 0 ? random_.below(count) : 0;
        const Uids uids = count > 0 ? all[0]->list()[static_cast<std::size_t>(number)] : Uids{};
        for (const auto& boxes : all) {
            const btBroadphasePairArray& array = boxes->cache.getOverlappingPairArray();
            for (int i = 0; i < array.size(); ++i) {
                if (uidsOf(array[i]) == uids) {
                    boxes->cache.removeOverlappingPair(array[i].m_pProxy0, array[i].m_pProxy1,
                                                       nullptr);
                    break;
                }
            }
        }
    }

    BulletRandom random_;
};

TEST(WorldsBroadphase, HasThePairsOfEachWorldAndNoOthersOnAnyNumberOfThreads) {
    ThreadedFor threadedFor(3, 5);
    SpatialHashConfig onThreads = eagerCharactersAndSensors();
    onThreads.parallelFor = std::ref(threadedFor);
    for (std::uint64_t seed = 1; seed <= 5 && !testing::Test::HasFailure(); ++seed) {
        WorldsScript script(seed);
        script.add(eagerCharactersAndSensors(), PairOrder::arrival);
        script.add(onThreads, PairOrder::arrival);
        script.add({}, PairOrder::canonical);
        std::size_t pairCount = 0;
        for (int step = 0; step < 60 && !testing::Test::HasFailure(); ++step) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", step " << step);
            for (int i = 0; i < (step % 10 == 0 ? 300 : 20); ++i) {
                script.act();
            }
            for (const auto& boxes : script.all) {
                boxes->check();
            }
            EXPECT_EQ(script.all[1]->list(), script.all[0]->list()) << "on threads";
            pairCount += script.all[0]->list().size();
        }
        EXPECT_GT(pairCount, 3000U);
    }
    EXPECT_GT(threadedFor.mostRanges(), 1U);
}

TEST(WorldsBroadphase, UpdatesOnlyWorldsInWhichSomethingHasChanged) {
    ManyWorlds boxes(3);
    for (int world = 0; world < 3; ++world) {
        for (int i = 0; i < 3; ++i) {
            boxes.createIn(world, ManyWorlds::kPlace);
        }
    }
    boxes.check();
    boxes.move(boxes.proxies[4], {1, 0, 0});
    boxes.check();
    EXPECT_EQ(boxes.worlds.world(1).lastCost().grid.changed, 1U);
    boxes.destroy(boxes.proxies[8]);
    boxes.check();
    EXPECT_EQ(boxes.worlds.world(1).lastCost().grid.changed, 1U) << "of the update before";
    EXPECT_EQ(boxes.worlds.world(0).lastCost().grid.changed, 3U) << "of the first one";
}

TEST(WorldsBroadphase, FollowsAFilterThatComesAndGoes) {
    ThreadedFor threadedFor(2, 6);
    SpatialHashConfig each;
    each.parallelFor = std::ref(threadedFor);
    ManyWorlds boxes(20, each);
    for (int i = 0; i < 60; ++i) {
        boxes.createIn(i % 20, ManyWorlds::kPlace);
    }
    const auto caller = std::this_thread::get_id();
    FilterBy filter([&](btBroadphaseProxy& a, btBroadphaseProxy& b) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_TRUE(boxes.areOfOneWorld(a, b));
        return b.m_uniqueId - a.m_uniqueId == 40;
    });
    boxes.cache.setOverlapFilterCallback(&filter);
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 20);
    EXPECT_EQ(filter.asked, 60U);
    boxes.cache.setOverlapFilterCallback(nullptr);
    boxes.worlds.refilterAll(nullptr);
    EXPECT_EQ(boxes.pairCount(), 60);
    boxes.check();
}

TEST(WorldsBroadphase, BringsOneWorldUpToDateAlone) {
    ManyWorlds boxes(2);
    for (int i = 0; i < 4; ++i) {
        boxes.createIn(i % 2, ManyWorlds::kPlace);
    }
    boxes.worlds.world(1).calculateOverlappingPairs(nullptr);
    EXPECT_EQ(boxes.list(), std::vector<Uids>({{2, 4}}));
    boxes.cache.removeOverlappingPair(boxes.proxies[1], boxes.proxies[3], nullptr);
    boxes.worlds.world(0).calculateOverlappingPairs(nullptr);
    EXPECT_EQ(boxes.list(), std::vector<Uids>({{1, 3}}));
    boxes.check();
    EXPECT_EQ(boxes.pairCount(), 2);
}

TEST(WorldsBroadphase, CatchesUpWithWhatCallbacksChange) {
    ManyWorlds boxes(3, eagerCharactersAndSensors());
    PairJournal journal;
    boxes.cache.setInternalGhostPairCallback(&journal);
    BulletRandom random(4);
    for (int i = 0; i < 60; ++i) {
        boxes.createIn(i % 3, boxAround(random.vector(-3, 3), {1, 1, 1}),
                       i % 5 == 0 ? ManyWorlds::kCharacter : 1);
    }
    int moves = 0;
    journal.onBirth = [&](btBroadphaseProxy* a, btBroadphaseProxy* /*b*/) {
        if (++moves % 4 == 0) {  // of this and of other worlds, while pairs of all are under way
            const auto i = static_cast<std::size_t>(random.below(60));
            boxes.move(boxes.proxies[i], random.vector(-1, 1));
            boxes.move(a, random.vector(-1, 1));
        }
    };
    for (int step = 0; step < 20; ++step) {
        for (btBroadphaseProxy* const proxy : boxes.proxies) {
            boxes.move(proxy, random.vector(-0.3, 0.3));
        }
        boxes.step();
    }
    EXPECT_GT(moves, 100);
    journal.onBirth = nullptr;
    boxes.step();
    boxes.check();
    EXPECT_EQ(uidPairs(boxes.cache), journal.alive);
    EXPECT_TRUE(journal.errors.empty());
}

// --- Life ----------------------------------------------------------------------------------------

TEST(WorldsBroadphase, BeginsAnewWhenAllWorldsAreEmptyAndOneByOne) {
    ManyWorlds boxes(2);
    boxes.createIn(0, ManyWorlds::kPlace);
    boxes.createIn(1, ManyWorlds::kPlace);
    boxes.step();
    boxes.destroy(boxes.proxies[1]);
    boxes.worlds.resetPool(nullptr);
    boxes.worlds.world(1).resetPool(nullptr);
    EXPECT_EQ(boxes.createIn(1, ManyWorlds::kPlace)->m_uniqueId, 3)
        << "a proxy of the other one is alive";
    boxes.check();
    boxes.destroyAll();
    boxes.worlds.resetPool(nullptr);
    EXPECT_EQ(boxes.createIn(1, ManyWorlds::kPlace)->m_uniqueId, 1);
    boxes.createIn(0, ManyWorlds::kPlace);
    boxes.check();
    EXPECT_EQ(boxes.pairCount(), 0);
}

TEST(WorldsBroadphase, GivesMemoryBack) {
    ManyWorlds boxes(5);
    for (int i = 0; i < 2000; ++i) {
        boxes.createIn(i % 5, cubeAt(btScalar(i / 20)));
    }
    boxes.step();
    const std::size_t full = boxes.worlds.memoryBytes() + boxes.cache.memoryBytes();
    std::vector<btBroadphaseProxy*> most(boxes.proxies.begin() + 10, boxes.proxies.end());
    boxes.worlds.destroyProxies(most, nullptr);
    boxes.proxies.resize(10);
    boxes.step();
    boxes.worlds.releaseUnusedMemory();
    EXPECT_LT(boxes.worlds.memoryBytes() + boxes.cache.memoryBytes(), full / 8);
    boxes.check();
}

TEST(WorldsBroadphase, MayEndAfterItsPairCache) {
    auto cache = std::make_unique<PairCache>();
    auto worlds = std::make_unique<WorldsBroadphase>(cache.get(), worldsByUserIndex(3));
    worlds->world(1).createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, 1, 1, nullptr);
    cache.reset();
    worlds.reset();
}

TEST(WorldsBroadphase, ShiftsAllWorlds) {
    ManyWorlds boxes(2);
    boxes.createIn(0, cubeAt(0));
    boxes.createIn(1, cubeAt(4));
    boxes.worlds.setMargin(boxes.proxies[1], 1, nullptr);
    btVector3 min;
    btVector3 max;
    boxes.worlds.getBroadphaseAabb(min, max);
    EXPECT_TRUE(isSame({min, max}, {{0, -1, -1}, {6, 2, 2}}));
    boxes.worlds.shiftOrigin({2, 0, 0});
    boxes.worlds.getBroadphaseAabb(min, max);
    EXPECT_TRUE(isSame({min, max}, {{-2, -1, -1}, {4, 2, 2}}));
    boxes.worlds.getAabb(boxes.proxies[1], min, max);
    EXPECT_TRUE(isSame({min, max}, cubeAt(2)));
    boxes.destroyAll();
    boxes.worlds.getBroadphaseAabb(min, max);
    EXPECT_TRUE(isSame({min, max}, {{0, 0, 0}, {0, 0, 0}}));
}

// --- Queries -------------------------------------------------------------------------------------

TEST(WorldsBroadphase, AsksOneWorldOrAll) {
    for (const bool stops : {false, true}) {
        SpatialHashConfig each;
        each.stopWhenProcessReturnsFalse = stops;
        ManyWorlds boxes(4, each);
        for (int world = 0; world < 4; ++world) {
            boxes.createIn(world, cubeAt(btScalar(world)));
            boxes.clients.back().object = world;
        }
        const Ray ray{{-1, btScalar(0.5), btScalar(0.5)}, {9, btScalar(0.5), btScalar(0.5)}};
        CollectRay ofAll(ray);
        boxes.worlds.rayTest(ray.from, ray.to, ofAll);
        EXPECT_EQ(ofAll.found, std::vector<int>({0, 1, 2, 3}));
        CollectRay ofOne(ray);
        std::as_const(boxes.worlds).world(2).rayTest(ray.from, ray.to, ofOne);
        EXPECT_EQ(ofOne.found, std::vector<int>({2}));

        const std::vector<int> first = stops ? std::vector<int>{1} : std::vector<int>{1, 2, 3};
        CollectBox inBox;
        inBox.answer = false;
        boxes.worlds.aabbTest({btScalar(1.5), 0, 0}, {9, 1, 1}, inBox);
        EXPECT_EQ(inBox.found, first);
        CollectRay stopped(ray);
        stopped.answer = false;
        boxes.worlds.rayTest({btScalar(1.5), btScalar(0.5), btScalar(0.5)}, ray.to, stopped);
        EXPECT_EQ(stopped.found, first);
        CollectBox inOne;
        std::as_const(boxes.worlds).world(3).aabbTest({0, 0, 0}, {9, 1, 1}, inOne);
        EXPECT_EQ(inOne.found, std::vector<int>({3}));
    }
}

}  // namespace
}  // namespace hashphase::test
