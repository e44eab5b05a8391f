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
            if (frame < 20) {
                player.calculate();
            }
        }
    }

    /// Somewhere at an object, but never at the middle of nowhere.
    btVector3 somewhere(BulletRandom& random) const {
        for (;;) {
            const int object = random.below(kQueryProxies);
            const btVector3 size = truth.box(object).max - truth.box(object).min;
            if (truth.isAlive(object) && size.length2() < btScalar(1e10)) {
                return truth.box(object).min + size * random.vector(-1, 2) +
                       random.vector(-0.5, 0.5);
            }
        }
    }

    Script script;
    Truth truth{kQueryProxies};
    Player player = hashPlayer(kQueryProxies);
};

void expectRayAsBruteForce(const Playground& world, const Ray& ray, std::size_t* hitCount) {
    CollectRay collected(ray);
    world.player.broadphase().rayTest(ray.from, ray.to, collected, ray.castMin, ray.castMax);
    const std::vector<int> expected = bruteForceRay(world.truth, kQueryProxies, ray);
    EXPECT_EQ(sorted(collected.found), expected) << describe(ray);
    *hitCount += expected.size();
}

class Queries : public testing::TestWithParam<Scene> {};

TEST_P(Queries, ByRayFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
        expectRayAsBruteForce(world, {world.somewhere(random), world.somewhere(random)}, &hitCount);
    }
    EXPECT_GT(hitCount, 20U);
}

TEST_P(Queries, ByShortRayFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
        const btVector3 from = world.somewhere(random);
        const btScalar length = random.uniform(0, 1);
        expectRayAsBruteForce(world, {from, from + random.direction() * length}, &hitCount);
    }
    EXPECT_GT(hitCount, 20U);
}

TEST_P(Queries, ByAxisParallelRayFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
        const btVector3 from = world.somewhere(random);
        btVector3 to = from;
        to[i % 3] += random.uniform(-20, 20);
        expectRayAsBruteForce(world, {from, to}, &hitCount);
        // Along the faces and edges of boxes.
        const Box& box = world.truth.box(random.below(kQueryProxies));
        Ray edge{box.min, box.min};
        edge.to[i % 3] = box.max[i % 3];
        expectRayAsBruteForce(world, edge, &hitCount);
    }
    EXPECT_GT(hitCount, 20U);
}

TEST_P(Queries, ByCastOfABoxFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 300 && !HasFailure(); ++i) {
        Ray ray{world.somewhere(random), world.somewhere(random)};
        if (i % 5 == 0) {
            ray.to = ray.from;  // a cast of no length asks for the place itself
        }
        ray.castMin = -random.vector(0, 1.5);
        ray.castMax = random.vector(0, 0.5);
        expectRayAsBruteForce(world, ray, &hitCount);
    }
    EXPECT_GT(hitCount, 100U);
}

TEST_P(Queries, ByRayOfNoLengthFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 200 && !HasFailure(); ++i) {
        const btVector3 point = world.somewhere(random);
        expectRayAsBruteForce(world, {point, point}, &hitCount);
    }
}

TEST_P(Queries, ByRayOfAMillionKilometresFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 100 && !HasFailure(); ++i) {
        const btVector3 middle = world.somewhere(random);
        btVector3 far(0, 0, 0);
        far[i % 3] = i % 2 == 0 ? btScalar(5e8) : btScalar(-5e8);
        expectRayAsBruteForce(world, {middle - far, middle + far}, &hitCount);
        const btVector3 diagonal = random.direction() * btScalar(1e9);
        expectRayAsBruteForce(world, {middle, middle + diagonal}, &hitCount);
    }
    EXPECT_GT(hitCount, 0U);
}

// So long that BT_LARGE_FLOAT is a slow inverse of 0: btRayAabb2() hits what is a metre beside it.
TEST_P(Queries, ByRayAsLongAsBulletsLargestNumberFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 100 && !HasFailure(); ++i) {
        const btVector3 middle = world.somewhere(random);
        Ray ray{middle, middle};
        ray.from[i % 3] = -BT_LARGE_FLOAT;
        ray.to[i % 3] = BT_LARGE_FLOAT;
        expectRayAsBruteForce(world, ray, &hitCount);
    }
    EXPECT_GT(hitCount, 0U);
}

TEST_P(Queries, ByBoxFindWhatBruteForceFinds) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 400 && !HasFailure(); ++i) {
        const btScalar half = std::pow(btScalar(10), random.uniform(-2, 1.5));
        Box box = boxAround(world.somewhere(random), random.vector(0, 1) * half);
        if (i % 4 == 0) {
            box = world.truth.box(random.below(kQueryProxies));  // touches its neighbours
        } else if (i % 50 == 1) {
            std::swap(box.min, box.max);
        }
        CollectBox collected;
        world.player.broadphase().aabbTest(box.min, box.max, collected);
        const std::vector<int> expected = bruteForceBox(world.truth, kQueryProxies, box);
        EXPECT_EQ(sorted(collected.found), expected) << describe(box);
        hitCount += expected.size();
    }
    EXPECT_GT(hitCount, 20U);
}

TEST_P(Queries, SeeEachBoxAsItWasLastSet) {
    Playground world(GetParam());
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 500 && !HasFailure(); ++i) {
        const int object = random.below(kQueryProxies);
        Command command{Action::set, object, GetParam().place(random, object),
                        btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter};
        if (!world.truth.isAlive(object)) {
            command.action = Action::create;
        } else if (i % 10 == 0) {
            command.action = Action::destroy;
        }
        world.truth.play({command});
        world.player.play(command);
        expectRayAsBruteForce(world, {world.somewhere(random), world.somewhere(random)}, &hitCount);
    }
    EXPECT_GT(hitCount, 100U);
}

TEST_P(Queries, RunOnManyThreadsAtOnce) {
    const Playground world(GetParam());
    std::vector<Ray> rays;
    std::vector<std::vector<int>> expected;
    BulletRandom random(kQuerySeed);
    for (int i = 0; i < 200; ++i) {
        rays.push_back({world.somewhere(random), world.somewhere(random)});
        expected.push_back(bruteForceRay(world.truth, kQueryProxies, rays.back()));
    }
    std::vector<int> wrong(4, 0);
    std::vector<std::thread> threads;
    for (std::size_t thread = 0; thread < wrong.size(); ++thread) {
        threads.emplace_back([&, thread] {
            for (std::size_t i = 0; i < rays.size(); ++i) {
                const std::size_t k = (i * 7 + thread * 31) % rays.size();
                CollectRay ray(rays[k]);
                world.player.broadphase().rayTest(rays[k].from, rays[k].to, ray);
                const Box box = boxAround(rays[k].from, {1, 1, 1});
                CollectBox inBox;
                world.player.broadphase().aabbTest(box.min, box.max, inBox);
                wrong[thread] += sorted(ray.found) != expected[k];
                wrong[thread] +=
                    sorted(inBox.found) != bruteForceBox(world.truth, kQueryProxies, box);
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST_P(Queries, RunInsideEachOther) {
    const Playground world(GetParam());
    BulletRandom random(kQuerySeed);

    /// Casts the inner ray and asks for the inner box at every hit of the outer ray.
    struct Outer : CollectRay {
        Outer(const Ray& ray, const Playground& playground, const Ray& innerRay)
            : CollectRay(ray), world(playground), inner(innerRay) {}
        bool process(const btBroadphaseProxy* proxy) override {
            CollectRay ray(inner);
            world.player.broadphase().rayTest(inner.from, inner.to, ray);
            EXPECT_EQ(sorted(ray.found), bruteForceRay(world.truth, kQueryProxies, inner));
            const Box box{proxy->m_aabbMin, proxy->m_aabbMax};
            CollectBox inBox;
            world.player.broadphase().aabbTest(box.min, box.max, inBox);
            EXPECT_EQ(sorted(inBox.found), bruteForceBox(world.truth, kQueryProxies, box));
            return CollectRay::process(proxy);
        }
        const Playground& world;
        Ray inner;
    };
    for (int i = 0; i < 20 && !HasFailure(); ++i) {
        const Ray ray{world.somewhere(random), world.somewhere(random)};
        Outer outer(ray, world, {world.somewhere(random), world.somewhere(random)});
        world.player.broadphase().rayTest(ray.from, ray.to, outer);
        EXPECT_EQ(sorted(outer.found), bruteForceRay(world.truth, kQueryProxies, ray));
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Queries, testing::ValuesIn(allScenes()),
                         [](const auto& scene) { return scene.param.name; });

TEST(Queries, GoOnWhenProcessReturnsFalse) {
    const Playground world(sceneNamed("piles"));
    BulletRandom random(kQuerySeed);
    std::size_t hitCount = 0;
    for (int i = 0; i < 50; ++i) {
        const Ray ray{world.somewhere(random), world.somewhere(random)};
        CollectRay byRay(ray);
        byRay.answer = false;
        world.player.broadphase().rayTest(ray.from, ray.to, byRay);
        EXPECT_EQ(sorted(byRay.found), bruteForceRay(world.truth, kQueryProxies, ray));
        const Box box = boxAround(ray.from, {2, 2, 2});
        CollectBox byBox;
        byBox.answer = false;
        world.player.broadphase().aabbTest(box.min, box.max, byBox);
        EXPECT_EQ(sorted(byBox.found), bruteForceBox(world.truth, kQueryProxies, box));
        hitCount += byRay.found.size() + byBox.found.size();
    }
    EXPECT_GT(hitCount, 100U);
}

TEST(Queries, StopWhenProcessReturnsFalseIfToldTo) {
    SpatialHashConfig config;
    config.stopWhenProcessReturnsFalse = true;
    Player player = hashPlayer(100, nullptr, config);
    for (int object = 0; object < 100; ++object) {
        player.play({Action::create, object, {{0, 0, 0}, {1, 1, 1}}, 1, -1});
    }
    CollectBox first;
    first.answer = false;
    player.broadphase().aabbTest({0, 0, 0}, {1, 1, 1}, first);
    EXPECT_EQ(first.found.size(), 1U);
    CollectBox all;
    player.broadphase().aabbTest({0, 0, 0}, {1, 1, 1}, all);
    EXPECT_EQ(all.found.size(), 100U);
}

// Soft-body worlds put 1e30, not BT_LARGE_FLOAT, where the ray does not move.
TEST(Queries, TrustTheCallbacksFieldsForTheHitAndNotForTheWay) {
    const Playground world(sceneNamed("paper"));
    BulletRandom random(kQuerySeed);
    for (int i = 0; i < 100 && !HasFailure(); ++i) {
        Ray ray{world.somewhere(random), world.somewhere(random)};
        ray.to[i % 3] = ray.from[i % 3];
        ray.inverseOfZero = btScalar(1e30);
        std::size_t hitCount = 0;
        expectRayAsBruteForce(world, ray, &hitCount);
    }
}

TEST(Queries, OfAnEmptyWorldFindNothing) {
    SpatialHashBroadphase broadphase;
    const Ray ray{{-1, -1, -1}, {1, 1, 1}};
    CollectRay byRay(ray);
    broadphase.rayTest(ray.from, ray.to, byRay);
    CollectBox byBox;
    broadphase.aabbTest(ray.from, ray.to, byBox);
    EXPECT_TRUE(byRay.found.empty());
    EXPECT_TRUE(byBox.found.empty());
}

TEST(Queries, WithNanFindNothingAndHarmNobody) {
    const Playground world(sceneNamed("uniform"));
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    const btScalar infinity = std::numeric_limits<btScalar>::infinity();
    for (const Ray& ray : {Ray{{nan, 0, 0}, {1, 1, 1}}, Ray{{0, 0, 0}, {0, nan, 0}},
                           Ray{{-infinity, 0, 0}, {infinity, 0, 0}}}) {
        CollectRay byRay(ray);
        world.player.broadphase().rayTest(ray.from, ray.to, byRay);
        EXPECT_TRUE(byRay.found.empty()) << describe(ray);
    }
    CollectBox byBox;
    world.player.broadphase().aabbTest({-9, nan, -9}, {9, 9, 9}, byBox);
    EXPECT_TRUE(byBox.found.empty());
    CollectBox everything;
    world.player.broadphase().aabbTest({-infinity, -infinity, -infinity},
                                       {infinity, infinity, infinity}, everything);
    EXPECT_EQ(sorted(everything.found),
              bruteForceBox(world.truth, kQueryProxies, {{-99, -99, -99}, {99, 99, 99}}));
}

}  // namespace
}  // namespace hashphase::test
