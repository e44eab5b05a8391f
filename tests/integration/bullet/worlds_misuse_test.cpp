// SPDX-License-Identifier: Zlib

// What a caller of many worlds may not do, and what becomes of them where memory runs out.

#include <tests/integration/bullet/many_worlds.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

TEST(WorldsBroadphase, RefusesWorldsThatAreNoneOfThem) {
    const auto errorOf = [](const auto& call) -> std::string {
        try {
            call();
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    ManyWorlds boxes(3);
    for (const int world : {-1, 3, std::numeric_limits<int>::max()}) {
        EXPECT_EQ(errorOf([&] { boxes.createIn(world, ManyWorlds::kPlace); }),
                  "WorldsConfig::worldOf returned " + std::to_string(world) +
                      ", but must return a world from 0 to 2.");
    }
    EXPECT_NE(errorOf([&] {
                  boxes.create(ManyWorlds::kPlace);
              }).find("without a btCollisionObject the world is unknown"),
              std::string::npos);
    EXPECT_TRUE(boxes.proxies.empty());
    for (const int count : {-1, 0, WorldsBroadphase::kMostWorlds + 1}) {
        EXPECT_NE(errorOf([&] {
                      WorldsBroadphase all(worldsByUserIndex(count));
                  }).find("worldCount is " + std::to_string(count)),
                  std::string::npos);
    }
    EXPECT_NE(errorOf([] { WorldsBroadphase all(WorldsConfig{}); }).find("worldOf is empty"),
              std::string::npos);
    WorldsConfig slow = worldsByUserIndex(1);
    slow.each.fastFrom = -1;
    EXPECT_NE(configError(slow).find("fastFrom"), std::string::npos);
}

#if HASHPHASE_ENABLE_ASSERTS

template <class Call>
std::string assertedBy(const Call& call) {
    const ThrowingAsserts throwing;
    try {
        call();
    } catch (const BrokenAssert& broken) {
        return broken.what();
    }
    return "nothing";
}

TEST(WorldsBroadphaseMisuse, IsAsserted) {
    ManyWorlds boxes(2);
    btBroadphaseProxy* const proxy = boxes.createIn(0, ManyWorlds::kPlace);
    boxes.createIn(0, ManyWorlds::kPlace);
    PairJournal journal;
    boxes.cache.setInternalGhostPairCallback(&journal);
    std::vector<std::string> within;
    journal.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        within = {assertedBy([&] { boxes.step(); }), assertedBy([&] {
                      boxes.worlds.shiftOrigin({1, 0, 0});
                  }),
                  assertedBy([&] { boxes.worlds.resetPool(nullptr); }),
                  assertedBy([&] { boxes.worlds.world(1).calculateOverlappingPairs(nullptr); }),
                  assertedBy([&] {
                      boxes.worlds.world(0).shiftOrigin({1, 0, 0});
                  })};
    };
    const std::string notCalculated =
        "calculateOverlappingPairs() was called from one of its own callbacks. Call it, or step the "
        "world, after it returns.";
    const std::string notShifted =
        "shiftOrigin() was called from a callback of calculateOverlappingPairs(). Call it after "
        "the step.";
    const std::vector<std::string> expected{
        notCalculated, notShifted,
        "resetPool() was called from a callback or a query. Call it after the step or the query.",
        notCalculated, notShifted};
    boxes.step();
    EXPECT_EQ(within, expected);
    boxes.createIn(0, ManyWorlds::kPlace);
    boxes.worlds.world(0).calculateOverlappingPairs(nullptr);
    EXPECT_EQ(within, expected);
    journal.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        const CaughtAsserts caught;
        boxes.worlds.releaseUnusedMemory();
        EXPECT_EQ(caught.count(), 1);
    };
    boxes.createIn(1, ManyWorlds::kPlace);
    boxes.createIn(1, ManyWorlds::kPlace);
    boxes.step();
    journal.onBirth = nullptr;
    const std::string none =
        "WorldsBroadphase::world(): there is no world of that number. Pass 0 to worldCount() - 1.";
    EXPECT_EQ(assertedBy([&] { static_cast<void>(boxes.worlds.world(-1)); }), none);
    EXPECT_EQ(assertedBy([&] { static_cast<void>(std::as_const(boxes.worlds).world(2)); }), none);
    EXPECT_NE(assertedBy([&] { boxes.worlds.destroyProxy(nullptr, nullptr); }), "nothing");
    EXPECT_NE(assertedBy([&] { boxes.worlds.setAabbs({&proxy, 1}, {}, {}, nullptr); }), "nothing");
    btBroadphaseProxy* const nobody = nullptr;
    const btVector3 origin(0, 0, 0);
    EXPECT_EQ(assertedBy([&] {
                  boxes.worlds.setAabbs({&nobody, 1}, {&origin, 1}, {&origin, 1}, nullptr);
              }),
              "A proxy is null. Pass proxies that createProxy() returned.");
    const std::array twice{proxy, proxy};
    EXPECT_NE(assertedBy([&] {
                  boxes.worlds.destroyProxies(twice, nullptr);
              }).find("a proxy is named twice"),
              std::string::npos);
    boxes.destroy(proxy);
    EXPECT_NE(assertedBy([&] { boxes.set(proxy, ManyWorlds::kPlace); }), "nothing");
    EXPECT_NE(assertedBy([&] { boxes.worlds.destroyProxies({&proxy, 1}, nullptr); }), "nothing");
}

#endif

/// Boxes in three worlds, in want of memory.
struct ScarceWorlds : ManyWorlds {
    ScarceWorlds(const SpatialHashConfig& each, PairOrder order, int count)
        : ManyWorlds(3, each, order) {
        createSome(count, 1);
    }
    void createSome(int count, int group) {
        for (int i = 0; i < count; ++i) {
            createIn(i % 3, boxAround(random.vector(-4, 4), {1, 1, 1}), group);
        }
    }
    void moveAll() {
        for (btBroadphaseProxy* const proxy : proxies) {
            move(proxy, random.vector(-1, 1));
        }
    }
    BulletRandom random{21};
};

TEST(WorldsBroadphaseOutOfMemory, TearsNothing) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    using Attempt = void (*)(ScarceWorlds&);
    const std::array<std::pair<Attempt, std::size_t>, 4> attempts{
        std::pair<Attempt, std::size_t>{[](ScarceWorlds& boxes) { boxes.createSome(40, 1); }, 8},
        {[](ScarceWorlds& boxes) { boxes.createSome(40, ManyWorlds::kCharacter); }, 8},
        {[](ScarceWorlds& boxes) {
             boxes.moveAll();
             boxes.step();
         },
         20},
        {[](ScarceWorlds& boxes) {
             boxes.worlds.destroyProxies(std::span(boxes.proxies).first(30), nullptr);
             boxes.proxies.erase(boxes.proxies.begin(), boxes.proxies.begin() + 30);
         },
         1}};
    ThreadedFor threadedFor(2, 9);
    SpatialHashConfig onThreads = eagerCharactersAndSensors();
    onThreads.parallelFor = std::ref(threadedFor);
    for (const auto& [attempt, leastFailures] : attempts) {
        for (const SpatialHashConfig& each : {eagerCharactersAndSensors(), onThreads}) {
            for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
                const std::size_t failures = runOutOfMemory(
                    [&] {
                        auto boxes = std::make_unique<ScarceWorlds>(each, order, 60);
                        boxes->step();
                        return boxes;
                    },
                    attempt,
                    [](ScarceWorlds& boxes, std::size_t) {
                        boxes.check();
                        boxes.moveAll();
                        boxes.check();
                    });
                EXPECT_GE(failures, leastFailures);
            }
        }
    }
}

}  // namespace
}  // namespace hashphase::test
