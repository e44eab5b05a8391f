// SPDX-License-Identifier: Zlib

// Memory runs out at every allocation of ours; Bullet's own arrays have memory of their own.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/cache_side.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kCharacter = btBroadphaseProxy::CharacterFilter;

/// A ghost callback that needs no memory.
struct Silent : btOverlappingPairCallback {
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*) override {
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*, btDispatcher*) override {
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}
};

/// Boxes that are told to ghosts or not.
struct Scarce : Boxes {
    explicit Scarce(int count, PairOrder order = PairOrder::arrival, int group = 1,
                    bool hasGhosts = false)
        : Boxes(eagerCharactersAndSensors(), order) {
        cache.setInternalGhostPairCallback(hasGhosts ? &ghosts : nullptr);
        createSome(count, group);
    }

    Box anywhere() {
        const btVector3 low = random.vector(-5, 5);
        return {low, low + btVector3(2, 2, 2)};
    }
    void createSome(int count, int group) {
        for (int i = 0; i < count; ++i) {
            create(anywhere(), group, -1, this);
        }
    }
    /// Steps, while each trembles about where it was at first, until all have settled.
    void stepTrembling() {
        std::vector<Box> homes;
        {
            const WorkingAllocations working;
            for (const btBroadphaseProxy* proxy : proxies) {
                homes.push_back(boxOf(*proxy));
            }
        }
        for (int i = 0; i < 40; ++i) {
            for (std::size_t k = 0; k < proxies.size(); ++k) {
                const btVector3 by = random.vector(-0.02F, 0.02F);
                set(proxies[k], {homes[k].min + by, homes[k].max + by});
            }
            step();
        }
        const WorkingAllocations working;
        EXPECT_EQ(cost().grid.resting, proxies.size());
    }
    void moveSome(std::size_t stride) {
        for (std::size_t i = 0; i < proxies.size(); i += stride) {
            set(proxies[i], anywhere());
        }
    }
    void checkTwice() {
        check();
        moveSome(7);
        check();
    }

    BulletRandom random{11};
    Silent ghosts;
};

/// Creates 40 at once, and keeps those that are written.
void createBatch(Scarce& boxes) {
    std::vector<ProxyDefinition> definitions;
    std::vector<btBroadphaseProxy*> created;
    {
        const WorkingAllocations working;
        created.resize(40);
        for (int i = 0; i < 40; ++i) {
            const Box box = boxes.anywhere();
            definitions.push_back({box.min, box.max, &boxes, i % 4 == 0 ? kCharacter : 1});
        }
    }
    const auto keep = [&] {
        const WorkingAllocations working;
        std::copy_if(created.begin(), created.end(), std::back_inserter(boxes.proxies),
                     [](const btBroadphaseProxy* proxy) { return proxy != nullptr; });
    };
    try {
        boxes.broadphase.createProxies(definitions, created, nullptr);
    } catch (const std::bad_alloc&) {
        keep();
        throw;
    }
    keep();
}

void destroyBatch(Scarce& boxes) {
    boxes.broadphase.destroyProxies(std::span(boxes.proxies).first(50), nullptr);
    boxes.proxies.erase(boxes.proxies.begin(), boxes.proxies.begin() + 50);
}

/// Told of one pair after the other, the cache has some of a new proxy's when memory runs out.
void checkClients(Scarce& boxes) {
    EXPECT_EQ(boxes.broadphase.grid().size(), boxes.proxies.size());
    for (int i = 0; i < boxes.pairCount(); ++i) {
        const btBroadphasePair& pair = boxes.cache.getOverlappingPairArray()[i];
        EXPECT_NE(pair.m_pProxy0->m_clientObject, nullptr);
        EXPECT_NE(pair.m_pProxy1->m_clientObject, nullptr);
    }
}

/// What is done to how many boxes, of which group, after how many steps; and how often it fails at least.
struct Scarcity {
    const char* name;
    int count;
    int group;
    int steps;
    bool hasGhosts;
    void (*attempt)(Scarce&);
    std::size_t leastFailures;
    bool isMost = false;  // and at most
};

const Scarcity kScarcities[] = {
    {"calculating pairs is repeated", 100, 1, 0, false, [](Scarce& boxes) { boxes.step(); }, 40},
    {"so it is at rest", 60, 1, 11, false,
     [](Scarce& boxes) {
         {
             const WorkingAllocations working;
             boxes.createSome(60, 1);
             boxes.moveSome(2);
         }
         boxes.step();
     },
     10},
    {"so it is where boxes settle", 60, 1, 1, false, [](Scarce& boxes) { boxes.stepTrembling(); },
     10},
    {"a proxy is created or not", 0, 1, 0, false, [](Scarce& boxes) { boxes.createSome(70, 1); },
     8},
    {"an eager proxy is created or not", 0, 1, 0, false,
     [](Scarce& boxes) { boxes.createSome(70, kCharacter); }, 8},
    {"so it is where ghosts are told", 60, 1, 1, true,
     [](Scarce& boxes) {
         boxes.create({{-9, -9, -9}, {9, 9, 9}}, btBroadphaseProxy::SensorTrigger, -1, &boxes);
     },
     6},
    {"of a batch those are created that are written", 30, 1, 0, false, createBatch, 8},
    {"moving what is eager is repeated by the step", 60, kCharacter, 0, false,
     [](Scarce& boxes) { boxes.moveSome(1); }, 1},
    {"destroying needs none", 100, 1, 1, false,
     [](Scarce& boxes) {
         for (int i = 0; i < 50; ++i) {
             boxes.destroy(boxes.proxies.back());
         }
     },
     0, true},
    {"destroying a batch has happened or not", 100, 1, 1, false, destroyBatch, 3},
};

TEST(BulletOutOfMemory, TearsNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    for (const Scarcity& each : kScarcities) {
        for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
            SCOPED_TRACE(each.name);
            const std::size_t failures = runOutOfMemory(
                [&] {
                    auto boxes =
                        std::make_unique<Scarce>(each.count, order, each.group, each.hasGhosts);
                    boxes->step(each.steps);
                    return boxes;
                },
                each.attempt,
                [](Scarce& boxes, std::size_t) {
                    checkClients(boxes);
                    boxes.checkTwice();
                });
            EXPECT_GE(failures, each.leastFailures);
            EXPECT_TRUE(!each.isMost || failures == each.leastFailures);
        }
    }
}

/// Thousands of births and deaths at once.
struct ScarceBatch : CacheSide {
    explicit ScarceBatch(PairOrder order, std::size_t deathCount = 3570) : CacheSide(order) {
        std::vector<Uids> all;
        for (int a = 0; a < int(kProxies); ++a) {
            for (int b = a + 1; b < int(kProxies); ++b) {
                all.emplace_back(a, b);
            }
        }
        const auto middle = all.begin() + std::ptrdiff_t(deathCount);
        died = pairs({all.begin(), middle});
        born = pairs({middle, all.end()});
        cache.update({}, died, &dispatcher);
        cache.releaseUnusedMemory();
        giveAlgorithms();
        freed.reserve(all.size());
    }
    void run() { cache.update(died, born, &dispatcher, threadedFor); }

    std::vector<BulletProxyPair> died;
    std::vector<BulletProxyPair> born;
    ThreadedFor threadedFor{3, 7};
};

TEST(BulletOutOfMemory, ABatchOnThreadsHasRemovedSomeAndAddedNoneAndIsRepeated) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    // A cache of 9 * 2^n pairs has no room for another.
    for (const auto& [order, deathCount] :
         {std::pair{PairOrder::arrival, 3570U}, std::pair{PairOrder::canonical, 3570U},
          std::pair{PairOrder::arrival, 9U * 512}}) {
        const std::size_t failures = runOutOfMemory(
            [order = order, deathCount = deathCount] {
                return std::make_unique<ScarceBatch>(order, deathCount);
            },
            [](ScarceBatch& batch) { batch.run(); },
            [](ScarceBatch& batch, std::size_t) {
                ASSERT_EQ(batch.cache.validate(), "");
                const bool isDone =
                    batch.cache.findPair(batch.born[0].lower(), batch.born[0].upper()) != nullptr;
                const auto countLeft = std::size_t(batch.cache.getNumOverlappingPairs());
                EXPECT_TRUE(isDone ? countLeft == batch.born.size()
                                   : countLeft <= batch.died.size());
                batch.run();
                ASSERT_EQ(batch.cache.validate(), "");
                const std::vector<Uids> left = inOrder(batch.list());
                EXPECT_EQ(left.size(), batch.born.size());
                EXPECT_EQ(batch.freed.size(), batch.died.size())
                    << "no algorithm is lost, or freed twice";
                for (const BulletProxyPair& pair : batch.born) {
                    ASSERT_NE(batch.cache.findPair(pair.lower(), pair.upper()), nullptr);
                }
            });
        EXPECT_GE(failures, 10U);
    }
}

}  // namespace
}  // namespace hashphase::test
