// SPDX-License-Identifier: Zlib
//
// rayTest and aabbTest against brute force with Bullet's own predicates: every proxy that passes,
// once, whatever has or has not happened since it was created or set.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/queries.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kQueryProxies = 250;
constexpr std::uint64_t kQuerySeed = 7;

/// A scene after some life in it, the last frames of which the broadphase has not yet calculated.
struct Playground {
    explicit Playground(const Scene& scene)
        : script(makeScript(scene, kQueryProxies, 30, kQuerySeed)) {
        for (std::size_t frame = 0; frame < script.frames.size(); ++frame) {
            truth.play(script.frames[frame]);
            player.play(script.frames[frame]);
            player.calculate(frame < 20 ? 1 : 0);
        }
    }

    /// Somewhere at an object, but never at the middle of nowhere.
    btVector3 somewhere() {
        for (;;) {
            const int object = random.below(kQueryProxies);
            const btVector3 size = truth.box(object).max - truth.box(object).min;
            if (truth.isAlive(object) && size.length2() < btScalar(1e10)) {
                return truth.box(object).min + size * random.vector(-1, 2) +
                       random.vector(-0.5, 0.5);
            }
        }
    }
    Ray someRay() {
        const btVector3 from = somewhere();
        return {from, somewhere()};
    }
    const Box& anyBox() { return truth.box(random.below(kQueryProxies)); }

    std::vector<int> onRay(const Ray& ray, bool answer = true) const {
        CollectRay found(ray);
        found.answer = answer;
        player.broadphase().rayTest(ray.from, ray.to, found, ray.castMin, ray.castMax);
        return sorted(found.found);
    }
    std::vector<int> inBox(const Box& box, bool answer = true) const {
        CollectBox found;
        found.answer = answer;
        player.broadphase().aabbTest(box.min, box.max, found);
        return sorted(found.found);
    }
    std::vector<int> expectedOnRay(const Ray& ray) const {
        return bruteForceRay(truth, kQueryProxies, ray);
    }
    std::vector<int> expectedInBox(const Box& box) const {
        return bruteForceBox(truth, kQueryProxies, box);
    }

    /// Both return how many there are.
    std::size_t expectAsBruteForce(const Ray& ray) const {
        EXPECT_EQ(onRay(ray), expectedOnRay(ray)) << describe(ray);
        return expectedOnRay(ray).size();
    }
    std::size_t expectAsBruteForce(const Box& box) const {
        EXPECT_EQ(inBox(box), expectedInBox(box)) << describe(box);
        return expectedInBox(box).size();
    }

    Script script;
    Truth truth{kQueryProxies};
    Player player = hashPlayer(kQueryProxies);
    BulletRandom random{kQuerySeed};
};

struct RayKind {
    const char* name;
    int count;
    std::size_t leastHits;
    Ray (*make)(Playground&, int i);
};

constexpr RayKind kRayKinds[] = {
    {"any", 400, 21, [](Playground& world, int) { return world.someRay(); }},
    {"short", 400, 21,
     [](Playground& world, int) {
         const btVector3 from = world.somewhere();
         const btScalar length = world.random.uniform(0, 1);
         return Ray{from, from + world.random.direction() * length};
     }},
    // Every other one along the edge of a box.
    {"parallel to an axis", 2000, 21,
     [](Playground& world, int i) {
         const Box& box = world.anyBox();
         Ray ray{box.min, box.min};
         ray.to[i % 3] = box.max[i % 3];
         if (i % 2 == 0) {
             ray.from = ray.to = world.somewhere();
             ray.to[i % 3] += world.random.uniform(-20, 20);
         }
         return ray;
     }},
    {"cast of a box", 400, 101,
     [](Playground& world, int i) {
         Ray ray = world.someRay();
         if (i % 5 == 0) {
             ray.to = ray.from;  // a cast of no length asks for the place itself
         }
         ray.castMin = -world.random.vector(0, 1.5);
         ray.castMax = world.random.vector(0, 0.5);
         return ray;
     }},
    {"of no length", 200, 0,
     [](Playground& world, int) {
         const btVector3 point = world.somewhere();
         return Ray{point, point};
     }},
    {"of a million kilometres", 200, 1,
     [](Playground& world, int i) {
         const btVector3 middle = world.somewhere();
         if (i % 2 == 0) {
             return Ray{middle, middle + world.random.direction() * btScalar(1e9)};
         }
         btVector3 far(0, 0, 0);
         far[i % 3] = i % 4 == 1 ? btScalar(5e8) : btScalar(-5e8);
         return Ray{middle - far, middle + far};
     }},
    // So long that BT_LARGE_FLOAT is a slow inverse of 0: btRayAabb2() hits what is a metre beside it.
    {"as long as Bullet's largest number", 300, 1,
     [](Playground& world, int i) {
         const btVector3 middle = world.somewhere();
         Ray ray{middle, middle};
         ray.from[i % 3] = -BT_LARGE_FLOAT;
         ray.to[i % 3] = BT_LARGE_FLOAT;
         return ray;
     }},
    // Soft-body worlds put 1e30, not BT_LARGE_FLOAT, where the ray does not move: the callback's fields
    // are to be trusted for the hit, and not for the way.
    {"with another inverse of 0", 100, 0,
     [](Playground& world, int i) {
         Ray ray = world.someRay();
         ray.to[i % 3] = ray.from[i % 3];
         ray.inverseOfZero = btScalar(1e30);
         return ray;
     }},
};

class Queries : public testing::TestWithParam<Scene> {};

TEST_P(Queries, ByRaysOfAllKindsFindWhatBruteForceFinds) {
    for (const RayKind& kind : kRayKinds) {
        SCOPED_TRACE(kind.name);
        Playground world(GetParam());
        std::size_t hitCount = 0;
        for (int i = 0; i < kind.count && !HasFailure(); ++i) {
            hitCount += world.expectAsBruteForce(kind.make(world, i));
        }
        EXPECT_GE(hitCount, kind.leastHits);
    }
}

TEST_P(Queries, ByBoxFindWhatBruteForceFinds) {
    Playground world(GetParam());
    std::size_t hitCount = 0;
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
        const btScalar half = std::pow(btScalar(10), world.random.uniform(-2, 1.5));
        Box box = boxAround(world.somewhere(), world.random.vector(0, 1) * half);
        if (i % 4 == 0) {
            box = world.anyBox();  // touches its neighbours
        } else if (i % 50 == 1) {
            std::swap(box.min, box.max);
        }
        hitCount += world.expectAsBruteForce(box);
    }
    EXPECT_GT(hitCount, 20U);
}

TEST_P(Queries, RunOnManyThreadsAtOnce) {
    Playground world(GetParam());
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) {
        rays.push_back(world.someRay());
    }
    std::vector<int> wrong(4, 0);
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
        threads.emplace_back([&, thread] {
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const Ray& ray = rays[(i * 7 + thread * 31) % rays.size()];
                const Box box = boxAround(ray.from, {1, 1, 1});
                wrong[thread] += world.onRay(ray) != world.expectedOnRay(ray);
                wrong[thread] += world.inBox(box) != world.expectedInBox(box);
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

/// Casts the inner ray and asks for the inner box at every hit of the outer ray.
struct Outer : CollectRay {
    Outer(const Ray& ray, const Playground& playground, const Ray& innerRay)
        : CollectRay(ray), world(playground), inner(innerRay) {}
    bool process(const btBroadphaseProxy* proxy) override {
        world.expectAsBruteForce(inner);
        world.expectAsBruteForce(Box{proxy->m_aabbMin, proxy->m_aabbMax});
        return CollectRay::process(proxy);
    }
    const Playground& world;
    Ray inner;
};

TEST_P(Queries, RunInsideEachOther) {
    Playground world(GetParam());
    for (int i = 0; i < 20 && !HasFailure(); ++i) {
        const Ray ray = world.someRay();
        Outer outer(ray, world, world.someRay());
        world.player.broadphase().rayTest(ray.from, ray.to, outer);
        EXPECT_EQ(sorted(outer.found), world.expectedOnRay(ray));
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Queries, testing::ValuesIn(allScenes()),
                         [](const auto& scene) { return scene.param.name; });

TEST(Queries, GoOnWhenProcessReturnsFalse) {
    Playground world(sceneNamed("piles"));
    std::size_t hitCount = 0;
    for (int i = 0; i < 50; ++i) {
        const Ray ray = world.someRay();
        EXPECT_EQ(world.onRay(ray, false), world.expectedOnRay(ray));
        const Box box = boxAround(ray.from, {2, 2, 2});
        EXPECT_EQ(world.inBox(box, false), world.expectedInBox(box));
        hitCount += world.expectedOnRay(ray).size() + world.expectedInBox(box).size();
    }
    EXPECT_GT(hitCount, 100U);
}

TEST(Queries, StopWhenProcessReturnsFalseIfToldTo) {
    SpatialHashConfig config;
    config.stopWhenProcessReturnsFalse = true;
    Player player = hashPlayer(100, nullptr, config);
    for (int object = 0; object < 100; ++object) {
        player.create(object, {{0, 0, 0}, {1, 1, 1}});
    }
    for (const bool answer : {false, true}) {
        CollectBox found;
        found.answer = answer;
        player.broadphase().aabbTest({0, 0, 0}, {1, 1, 1}, found);
        EXPECT_EQ(found.found.size(), answer ? 100U : 1U);
    }
}

TEST(Queries, OfAnEmptyWorldOrWithNanFindNothingAndHarmNobody) {
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    const btScalar infinity = std::numeric_limits<btScalar>::infinity();
    const Playground world(sceneNamed("uniform"));
    for (const Ray& ray : {Ray{{nan, 0, 0}, {1, 1, 1}}, Ray{{0, 0, 0}, {0, nan, 0}},
                           Ray{{-infinity, 0, 0}, {infinity, 0, 0}}}) {
        EXPECT_TRUE(world.onRay(ray).empty()) << describe(ray);
    }
    EXPECT_TRUE(world.inBox({{-9, nan, -9}, {9, 9, 9}}).empty());
    EXPECT_EQ(world.inBox({{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}),
              world.expectedInBox({{-99, -99, -99}, {99, 99, 99}}));
    SpatialHashBroadphase broadphase;
    CollectRay byRay({{-1, -1, -1}, {1, 1, 1}});
    broadphase.rayTest({-1, -1, -1}, {1, 1, 1}, byRay);
    CollectBox byBox;
    broadphase.aabbTest({-1, -1, -1}, {1, 1, 1}, byBox);
    EXPECT_TRUE(byRay.found.empty() && byBox.found.empty());
}

}  // namespace
}  // namespace hashphase::test
