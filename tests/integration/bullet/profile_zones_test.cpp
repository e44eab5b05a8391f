// SPDX-License-Identifier: Zlib

// What Bullet's profiler is told of the broadphase.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/integration/bullet/many_worlds.hpp>
#include <tests/support/threaded_for.hpp>

#include <LinearMath/btQuickprof.h>
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

/// Hears of Bullet's zones while it lives, and keeps those that are ours.
class ZoneRecord {
public:
    ZoneRecord() {
        open.clear();
        ours.clear();
        thread = std::this_thread::get_id();
        foreignCount = 0;
        btSetCustomEnterProfileZoneFunc([](const char* name) { enter(name); });
        btSetCustomLeaveProfileZoneFunc([] { leave(); });
    }
    ~ZoneRecord() {
        btSetCustomEnterProfileZoneFunc(enterBefore_);
        btSetCustomLeaveProfileZoneFunc(leaveBefore_);
        EXPECT_TRUE(open.empty());
        EXPECT_EQ(foreignCount, 0);
    }
    ZoneRecord(const ZoneRecord&) = delete;
    ZoneRecord& operator=(const ZoneRecord&) = delete;

    /// In their order, each behind the zone that it is within.
    [[nodiscard]] std::vector<std::string> zones() const { return ours; }

private:
    static void enter(std::string_view name) {
        if (std::this_thread::get_id() != thread) {
            ++foreignCount;
            return;
        }
        if (name.starts_with("hashphase: ")) {
            ours.push_back((open.empty() ? std::string() : open.back() + " > ") +
                           std::string(name));
        }
        open.emplace_back(name);
    }
    static void leave() {
        if (std::this_thread::get_id() == thread) {
            open.pop_back();
        }
    }

    static inline std::vector<std::string> open;
    static inline std::vector<std::string> ours;
    static inline std::thread::id thread;
    static inline std::atomic<int> foreignCount;  // on other threads

    btEnterProfileZoneFunc* enterBefore_ = btGetCurrentEnterProfileZoneFunc();
    btLeaveProfileZoneFunc* leaveBefore_ = btGetCurrentLeaveProfileZoneFunc();
};

const std::vector<std::string> kZonesOfAStep{
    "calculateOverlappingPairs > hashphase: update pairs",
    "calculateOverlappingPairs > hashphase: pair cache",
};

TEST(ProfileZonesOfOurs, ShowTheTwoPartsOfCalculateOverlappingPairs) {
    DynamicsWorld world;
    for (int i = 0; i < 100; ++i) {
        world.addBox(btVector3(1, 1, 1), 1, btVector3(btScalar(i), 0, 0));
    }
    const ZoneRecord record;
    world.step();
    EXPECT_EQ(record.zones(), kZonesOfAStep);
}

TEST(ProfileZonesOfOurs, AreNoMoreWhereThereAreMoreObjectsAndGhosts) {
    DynamicsWorld world;
    world.tellGhosts();
    auto* const ball = world.keep(std::make_unique<btSphereShape>(btScalar(1)));
    std::vector<btPairCachingGhostObject*> ghosts;
    for (int i = 0; i < 300; ++i) {
        world.addBox(btVector3(1, 1, 1), 1, btVector3(btScalar(i), 0, 0));
        ghosts.push_back(&world.addGhost(ball, btVector3(btScalar(i), 1, 0)));
    }
    world.step();
    for (btPairCachingGhostObject* ghost : ghosts) {
        putAt(*ghost, ghost->getWorldTransform().getOrigin() + btVector3(0, 1, 0));
    }
    const ZoneRecord record;
    world.step();
    EXPECT_EQ(record.zones(), kZonesOfAStep);
}

TEST(ProfileZonesOfOurs, ShowBatches) {
    SpatialHashBroadphase broadphase;
    const std::vector<ProxyDefinition> definitions(50);
    std::vector<btBroadphaseProxy*> proxies(definitions.size());
    const std::vector<btVector3> corners(definitions.size(), btVector3(1, 1, 1));
    const ZoneRecord record;
    broadphase.createProxies(definitions, proxies, nullptr);
    broadphase.setAabbs(proxies, corners, corners, nullptr);
    broadphase.destroyProxies(proxies, nullptr);
    EXPECT_EQ(record.zones(),
              (std::vector<std::string>{"hashphase: create proxies", "hashphase: set boxes",
                                        "hashphase: destroy proxies"}));
}

TEST(ProfileZonesOfOurs, AreEnteredOnTheCallersThreadAlone) {
    ThreadedFor threads(4, 0x5eed9e01);
    SpatialHashConfig each;
    each.parallelFor = [&](std::size_t count, std::size_t grain, LoopBody body) {
        threads(count, grain, body);
    };
    ManyWorlds worlds(100, each);
    for (int world = 0; world < 100; ++world) {
        for (int i = 0; i < 3; ++i) {
            worlds.createIn(world, ManyWorlds::kPlace);
        }
    }
    const std::vector<btVector3> mins(worlds.proxies.size(), btVector3(0, 0, 0));
    const std::vector<btVector3> maxs(worlds.proxies.size(), btVector3(1, 1, 1));
    const std::vector<btBroadphaseProxy*> proxies = worlds.proxies;
    const ZoneRecord record;
    worlds.step();
    worlds.worlds.setAabbs(proxies, mins, maxs, nullptr);
    worlds.worlds.destroyProxies(proxies, nullptr);
    worlds.proxies.clear();
    EXPECT_GT(threads.mostRanges(), 1U);
    EXPECT_EQ(record.zones(),
              (std::vector<std::string>{"hashphase: update pairs", "hashphase: pair cache",
                                        "hashphase: set boxes", "hashphase: destroy proxies"}));
}

TEST(ProfileZonesOfOurs, AreLeftWhenTheFilterThrows) {
    struct Thrower : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override {
            throw std::runtime_error("no answer");
        }
    } thrower;
    Boxes boxes;
    for (int i = 0; i < 3; ++i) {
        boxes.create({{0, 0, 0}, {1, 1, 1}});
    }
    boxes.cache.setOverlapFilterCallback(&thrower);
    const ZoneRecord record;  // expects that all are left
    EXPECT_THROW(boxes.step(), std::runtime_error);
    EXPECT_EQ(record.zones(), std::vector<std::string>{"hashphase: update pairs"});
}

}  // namespace
}  // namespace hashphase::test
