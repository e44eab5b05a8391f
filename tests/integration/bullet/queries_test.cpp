// SPDX-License-Identifier: Zlib
//
// rayTest and aabbTest against brute force with Bullet's own predicates: every proxy that passes,
// once, whatever has or has not happened since it was created or set.

#include <demos/stability/run_together.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/integration/bullet/scripted_boxes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr std::uint64_t kQuerySeed = 7;

/// A scene after some life in it, the last frames of which the broadphase has not yet calculated.
struct Playground {
    explicit Playground(const BoxScene<btScalar>& scene) : script(scene, kQuerySeed) {
        script.begin(world);
        for (int frame = 0; frame < 30; ++frame) {
            script.playFrame(world);
            world.all.front().step(frame < 20 ? 1 : 0);
        }
    }

    /// Somewhere at an object, but never at the middle of nowhere.
    btVector3 somewhere() {
        for (;;) {
            const Box box = anyBox();
            const btVector3 size = box.max - box.min;
            if (size.length2() < btScalar(1e10) && box.min.length2() < btScalar(1e20)) {
                return box.min + size * random.vector(-1, 2) + random.vector(-0.5, 0.5);
            }
        }
    }
    Ray someRay() {
        const btVector3 from = somewhere();
        return {from, somewhere()};
    }
    Box anyBox() {
        for (;;) {
            const int count = static_cast<int>(script.proxies().size());
            const auto& box = script.proxies()[static_cast<std::size_t>(random.below(count))].box;
            if (!hasNan(box)) {
                return boxOf(box);
            }
        }
    }

    std::vector<int> found(const Ray& ray, bool answer = true) const {
        CollectRay collector(ray);
        collector.answer = answer;
        broadphase.rayTest(ray.from, ray.to, collector, ray.castMin, ray.castMax);
        return collector.sorted();
    }
    std::vector<int> found(const Box& box, bool answer = true) const {
        CollectBox collector;
        collector.answer = answer;
        broadphase.aabbTest(box.min, box.max, collector);
        return collector.sorted();
    }
    template <class Question>
    std::vector<int> expected(const Question& question) const {
        return metByBruteForce(script.proxies(), question,
                               [](ProxyId id) { return static_cast<int>(id.index); });
    }
    /// Returns how many there are.
    template <class Question>
    std::size_t expectAsBruteForce(const Question& question, bool answer = true) const {
        const std::vector<int> all = expected(question);
        EXPECT_EQ(found(question, answer), all) << describe(question);
        return all.size();
    }

    const CaughtMessages aboutNan;
    ScriptedBoxes world;
    SpatialHashBroadphase& broadphase = world.all.emplace_back(makeCache<PairCache>()).hash();
    Script<btScalar> script;
    BulletRandom random{kQuerySeed};
};

/// Those in which Bullet's own arithmetic holds.
std::vector<BoxScene<btScalar>> scenes() {
    std::vector<BoxScene<btScalar>> all = allBoxScenes<btScalar>();
    std::erase_if(all, [](const BoxScene<btScalar>& scene) {
        return scene.name == "denormal" || scene.name == "enormous";
    });
    return all;
}

struct RayKind {
    const char* name;
    int count;
    std::size_t leastHits;  // in all scenes
    Ray (*make)(Playground&, int i);
};

constexpr RayKind kRayKinds[] = {
    {"any", 400, 12000, [](Playground& world, int) { return world.someRay(); }},
    {"short", 400, 3000,
     [](Playground& world, int) {
         const btVector3 from = world.somewhere();
         const btScalar length = world.random.uniform(0, 1);
         return Ray{from, from + world.random.direction() * length};
     }},
    // Every other one along the edge of a box.
    {"parallel to an axis", 2000, 30000,
     [](Playground& world, int i) {
         const Box box = world.anyBox();
         Ray ray{box.min, box.min};
         ray.to[i % 3] = box.max[i % 3];
         if (i % 2 == 0) {
             ray.from = ray.to = world.somewhere();
             ray.to[i % 3] += world.random.uniform(-20, 20);
         }
         return ray;
     }},
    {"cast of a box", 400, 40000,
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
    {"of a million kilometres", 200, 4000,
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
    {"as long as Bullet's largest number", 300, 6000,
     [](Playground& world, int i) {
         const btVector3 middle = world.somewhere();
         Ray ray{middle, middle};
         ray.from[i % 3] = -BT_LARGE_FLOAT;
         ray.to[i % 3] = BT_LARGE_FLOAT;
         return ray;
     }},
    // Soft-body worlds put 1e30, not BT_LARGE_FLOAT, where the ray does not move: the callback's fields
    // are to be trusted for the hit, and not for the way.
    {"with another inverse of 0", 100, 2000,
     [](Playground& world, int i) {
         Ray ray = world.someRay();
         ray.to[i % 3] = ray.from[i % 3];
         ray.inverseOfZero = btScalar(1e30);
         return ray;
     }},
};

TEST(Queries, ByRaysOfAllKindsFindWhatBruteForceFinds) {
    for (const RayKind& kind : kRayKinds) {
        std::size_t hitCount = 0;
        for (const BoxScene<btScalar>& scene : scenes()) {
            SCOPED_TRACE(testing::Message() << kind.name << ", " << scene.name);
            Playground world(scene);
            for (int i = 0; i < kind.count && !testing::Test::HasFailure(); ++i) {
                hitCount += world.expectAsBruteForce(kind.make(world, i));
            }
        }
        EXPECT_GE(hitCount, kind.leastHits) << kind.name;
    }
}

TEST(Queries, ByBoxFindWhatBruteForceFinds) {
    for (const BoxScene<btScalar>& scene : scenes()) {
        SCOPED_TRACE(scene.name);
        Playground world(scene);
        std::size_t hitCount = 0;
        for (int i = 0; i < 400 && !testing::Test::HasFailure(); ++i) {
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
}

TEST(Queries, RunOnManyThreadsAtOnceAndGoOnWhenProcessReturnsFalse) {
    for (const std::size_t number : {0U, 9U}) {
        Playground world(scenes()[number]);
        std::vector<Ray> rays;
        for (int i = 0; i < 200; ++i) {
            rays.push_back(world.someRay());
        }
        std::vector<int> wrong(4, 0);
        demos::runTogether(wrong.size(), [&](std::size_t thread) {
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const Ray& ray = rays[(i * 7 + thread * 31) % rays.size()];
                const Box box = boxAround(ray.from, {1, 1, 1});
                wrong[thread] += world.found(ray, i % 2 == 0) != world.expected(ray);
                wrong[thread] += world.found(box, i % 2 == 0) != world.expected(box);
            }
        });
        EXPECT_EQ(wrong, std::vector<int>(4, 0));
    }
}

/// Casts the inner ray and asks for the inner box at every hit of the outer ray.
struct Outer : CollectRay {
    Outer(const Ray& ray, const Playground& playground, const Ray& innerRay)
        : CollectRay(ray), world(playground), inner(innerRay) {}
    bool process(const btBroadphaseProxy* proxy) override {
        world.expectAsBruteForce(inner);
        world.expectAsBruteForce(boxOf(*proxy));
        ++calls;
        return CollectRay::process(proxy);
    }
    std::size_t calls = 0;
    const Playground& world;
    Ray inner;
};

TEST(Queries, RunInsideEachOther) {
    std::size_t calls = 0;
    for (const BoxScene<btScalar>& scene : scenes()) {
        Playground world(scene);
        for (int i = 0; i < 20 && !testing::Test::HasFailure(); ++i) {
            const Ray ray = world.someRay();
            Outer outer(ray, world, world.someRay());
            world.broadphase.rayTest(ray.from, ray.to, outer);
            EXPECT_EQ(outer.sorted(), world.expected(ray));
            calls += outer.calls;
        }
    }
    EXPECT_GT(calls, 500U);
}

TEST(Queries, StopWhenProcessReturnsFalseIfToldTo) {
    SpatialHashConfig config;
    config.stopWhenProcessReturnsFalse = true;
    Client client;
    Boxes boxes(config);
    for (int object = 0; object < 100; ++object) {
        boxes.create({{0, 0, 0}, {1, 1, 1}}, 1, -1, &client);
    }
    for (const bool answer : {false, true}) {
        CollectBox found;
        found.answer = answer;
        boxes.broadphase.aabbTest({0, 0, 0}, {1, 1, 1}, found);
        EXPECT_EQ(found.found.size(), answer ? 100U : 1U);
    }
}

TEST(Queries, OfAnEmptyWorldOrWithNanFindNothingAndHarmNobody) {
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    const btScalar infinity = std::numeric_limits<btScalar>::infinity();
    const Playground world(scenes().front());
    const std::vector<Ray> rays{Ray{{nan, 0, 0}, {1, 1, 1}}, Ray{{0, 0, 0}, {0, nan, 0}},
                                Ray{{-infinity, 0, 0}, {infinity, 0, 0}}};
    const Boxes none;
    for (const Ray& ray : rays) {
        EXPECT_TRUE(world.found(ray).empty()) << describe(ray);
        CollectRay collector(ray);
        none.broadphase.rayTest(ray.from, ray.to, collector);
        EXPECT_TRUE(collector.found.empty());
    }
    EXPECT_TRUE(world.found(Box{{-9, nan, -9}, {9, 9, 9}}).empty());
    world.expectAsBruteForce(
        Box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}});
    CollectBox byBox;
    none.broadphase.aabbTest({-1, -1, -1}, {1, 1, 1}, byBox);
    EXPECT_TRUE(byBox.found.empty());
}

}  // namespace
}  // namespace hashphase::test
