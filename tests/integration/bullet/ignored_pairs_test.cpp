// SPDX-License-Identifier: Zlib
//
// Pairs that are ignored, named by the program or by Bullet's lists of objects without collision checks.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/ghost_world.hpp>
#include <tests/support/out_of_memory.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

class IgnoredByName : public testing::TestWithParam<CacheKind> {};
INSTANTIATE_TEST_SUITE_P(Caches, IgnoredByName, testing::ValuesIn(kCacheKinds),
                         [](const testing::TestParamInfo<CacheKind>& kind) {
                             return std::string(kind.param.name);
                         });

TEST_P(IgnoredByName, GoAndComeAtOnce) {
    AnyBoxes boxes(GetParam().make());
    SpatialHashBroadphase& hash = boxes.hash();
    for (const double x : {0., 0.5, 0.9}) {
        boxes.create(cubeAt(btScalar(x)));
    }
    const std::vector<btBroadphaseProxy*> each = boxes.proxies;
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 3);
    hash.ignorePair(each[1], each[0], nullptr);
    EXPECT_EQ(boxes.pairCount(), 2);
    EXPECT_FALSE(boxes.isPair(0, 1));
    EXPECT_TRUE(hash.isIgnoredPair(each[0], each[1]));
    boxes.step(3);
    hash.refilterAll(nullptr);
    EXPECT_EQ(boxes.pairCount(), 2);
    hash.stopIgnoringPair(each[0], each[1], nullptr);
    EXPECT_TRUE(boxes.isPair(0, 1));
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 3);
    // A proxy that has the memory of another one is not ignored in its place.
    hash.ignorePair(each[0], each[1], nullptr);
    boxes.destroy(each[1]);
    boxes.step();
    boxes.create(cubeAt(btScalar(0.5)));
    boxes.step();
    EXPECT_EQ(boxes.pairCount(), 3);
    EXPECT_EQ(hash.validate(), "");
}

TEST_P(IgnoredByName, AreThoseOfBruteForceInRandomScripts) {
    AnyBoxes boxes(GetParam().make(), eagerCharactersAndSensors());
    SpatialHashBroadphase& hash = boxes.hash();
    BulletRandom random(0x5eed0a01);
    std::set<Uids> ignored;
    const auto anyProxy = [&] {
        return boxes.proxies[std::size_t(random.below(int(boxes.proxies.size())))];
    };
    const auto anywhere = [&] {
        const btVector3 low = random.vector(-2, 2);
        return Box{low, low + btVector3(1, 1, 1)};
    };
    for (int frame = 0; frame < 150; ++frame) {
        SCOPED_TRACE(frame);
        while (boxes.proxies.size() < 40) {
            boxes.create(anywhere(), random.chance(0.2) ? btBroadphaseProxy::CharacterFilter : 1);
        }
        for (int i = 0; i < 12; ++i) {
            boxes.set(anyProxy(), anywhere());
        }
        for (int i = 0; i < 30; ++i) {
            btBroadphaseProxy* const a = anyProxy();
            btBroadphaseProxy* const b = anyProxy();
            if (a == b) {
                continue;
            }
            if (random.chance(0.6)) {
                hash.ignorePair(a, b, nullptr);
                ignored.insert(uidsOf(*a, *b));
                EXPECT_EQ(boxes.pairCache().findPair(a, b), nullptr);
            } else {
                hash.stopIgnoringPair(a, b, nullptr);
                ignored.erase(uidsOf(*a, *b));
            }
        }
        if (frame % 3 == 0) {
            boxes.destroy(anyProxy());
        }
        boxes.step(random.below(3));
        if (frame % 4 == 0) {
            hash.refilterAll(nullptr);
        }
        boxes.step();
        std::vector<Uids> expected = boxes.overlaps();
        std::erase_if(expected, [&](const Uids& pair) { return ignored.contains(pair); });
        std::vector<Uids> pairs = boxes.list();
        std::sort(pairs.begin(), pairs.end());
        ASSERT_EQ(pairs, expected);
        ASSERT_EQ(hash.validate(), "");
    }
    EXPECT_GT(ignored.size(), 100U);
}

TEST(IgnoredPairsOfBullet, FreeAlgorithmsAndTellGhosts) {
    GhostWorld scene;
    btBoxShape shape({1, 1, 1});
    const int number = scene.add(&shape, 1, placeAt({0, 0, 0}));
    btRigidBody& body = scene.body(number);
    btBoxShape floor({9, 1, 9});
    btRigidBody& below = scene.body(scene.add(&floor, 0, placeAt({0, btScalar(-1.9), 0})));
    scene.detect();
    EXPECT_GT(scene.dispatcher().getNumManifolds(), 0);
    const int manifolds = scene.dispatcher().getNumManifolds();
    SpatialHashBroadphase& hash = scene.hash();
    hash.ignorePair(body.getBroadphaseHandle(), below.getBroadphaseHandle(), &scene.dispatcher());
    EXPECT_EQ(scene.dispatcher().getNumManifolds(), manifolds - 1);
    for (btGhostObject* const ghost : scene.ghosts()) {
        EXPECT_TRUE(scene.doesList(*ghost, body));
        hash.ignorePair(ghost->getBroadphaseHandle(), body.getBroadphaseHandle(),
                        &scene.dispatcher());
        EXPECT_FALSE(scene.doesList(*ghost, body));
        putAt(body, {btScalar(0.1), 0, 0});
        scene.world().updateSingleAabb(&body);
        EXPECT_FALSE(scene.doesList(*ghost, body)) << "which would come at once";
        hash.stopIgnoringPair(ghost->getBroadphaseHandle(), body.getBroadphaseHandle(),
                              &scene.dispatcher());
        EXPECT_TRUE(scene.doesList(*ghost, body));
    }
}

// --- Bullet's lists ------------------------------------------------------------------------------

/// Cubes that all touch, and a world that tells of their lists.
struct ListedCubes : DynamicsWorld {
    explicit ListedCubes(std::unique_ptr<btOverlappingPairCache> cache = nullptr)
        : ListedCubes(hashOver(cache.get()), std::move(cache)) {}

    ListedCubes(std::unique_ptr<SpatialHashBroadphase> over,
                std::unique_ptr<btOverlappingPairCache> cache)
        : DynamicsWorld(std::move(over), std::move(cache)) {
        for (int i = 0; i < kCount; ++i) {
            addBox({1, 1, 1}, 1, {btScalar(i) / 10, 0, 0});
        }
        world().performDiscreteCollisionDetection();
    }
    void changed(int number) {
        hash().collisionChecksChanged(body(number).getBroadphaseHandle(), &dispatcher());
    }
    [[nodiscard]] bool isPair(int a, int b) {
        return cache().findPair(body(a).getBroadphaseHandle(), body(b).getBroadphaseHandle()) !=
               nullptr;
    }
    /// The pairs are those for which the dispatcher makes contacts.
    void expectPairsOfDispatcher() {
        for (int a = 0; a < kCount; ++a) {
            for (int b = 0; b < a; ++b) {
                const bool areThere = body(a).isInWorld() && body(b).isInWorld();
                EXPECT_EQ(areThere && isPair(a, b),
                          areThere && dispatcher().needsCollision(&body(a), &body(b)))
                    << a << " and " << b;
            }
        }
        EXPECT_EQ(hash().validate(), "");
    }

    static constexpr int kCount = 9;
};

class IgnoredByLists : public testing::TestWithParam<CacheKind> {};
INSTANTIATE_TEST_SUITE_P(Caches, IgnoredByLists, testing::ValuesIn(kCacheKinds),
                         [](const testing::TestParamInfo<CacheKind>& kind) {
                             return std::string(kind.param.name);
                         });

TEST_P(IgnoredByLists, AreThoseThatTheDispatcherRefuses) {
    ListedCubes cubes(GetParam().make());
    BulletRandom random(0x5eed0a02);
    cubes.expectPairsOfDispatcher();
    for (int round = 0; round < 60; ++round) {
        SCOPED_TRACE(round);
        std::vector<btBroadphaseProxy*> named;
        for (int i = 0; i < 4; ++i) {
            const int a = random.below(cubes.kCount);
            const int b = random.below(cubes.kCount);
            // Twice at times, which Bullet's list allows.
            cubes.body(a).setIgnoreCollisionCheck(&cubes.body(b), random.chance(0.6));
            if (round % 2 == 0) {
                cubes.changed(a);
            }
            named.push_back(cubes.body(a).getBroadphaseHandle());
        }
        cubes.hash().collisionChecksChanged(named, &cubes.dispatcher());
        cubes.expectPairsOfDispatcher();
        cubes.world().performDiscreteCollisionDetection();
        cubes.expectPairsOfDispatcher();
    }
}

TEST(IgnoredPairsOfLists, FollowJointsBetweenLinkedBodies) {
    ListedCubes cubes;
    btPoint2PointConstraint joint(cubes.body(2), cubes.body(5), {0, 0, 0}, {0, 0, 0});
    cubes.world().addConstraint(&joint, true);
    cubes.changed(5);
    EXPECT_FALSE(cubes.isPair(2, 5));
    cubes.expectPairsOfDispatcher();
    cubes.world().removeConstraint(&joint);
    cubes.changed(2);
    EXPECT_TRUE(cubes.isPair(2, 5));
    cubes.expectPairsOfDispatcher();
}

TEST(IgnoredPairsOfLists, MayNameWhatIsGoneElsewhereOrComesLater) {
    ListedCubes cubes;
    ListedCubes others;
    auto gone = std::make_unique<btCollisionObject>();
    cubes.body(0).setIgnoreCollisionCheck(gone.get(), true);
    cubes.body(0).setIgnoreCollisionCheck(&others.body(1), true);
    cubes.body(0).setIgnoreCollisionCheck(&cubes.body(0), true);
    cubes.body(0).setIgnoreCollisionCheck(&cubes.body(1), true);
    gone.reset();
    cubes.takeOut(1);
    cubes.changed(0);
    EXPECT_EQ(cubes.pairCount(), 28);
    cubes.world().addRigidBody(&cubes.body(1));
    cubes.world().performDiscreteCollisionDetection();
    EXPECT_TRUE(cubes.isPair(0, 1)) << "a new proxy, of which nobody has told";
    cubes.changed(0);
    cubes.expectPairsOfDispatcher();
    for (const btCollisionObject* object :
         {static_cast<const btCollisionObject*>(&cubes.body(0)),
          static_cast<const btCollisionObject*>(&others.body(1))}) {
        cubes.body(0).setIgnoreCollisionCheck(object, false);
    }
}

TEST(IgnoredPairsOfLists, TakeThePlaceOfWhatTheProgramHasNamed) {
    ListedCubes cubes;
    const auto proxy = [&](int i) { return cubes.body(i).getBroadphaseHandle(); };
    cubes.hash().ignorePair(proxy(0), proxy(1), &cubes.dispatcher());
    cubes.hash().ignorePair(proxy(2), proxy(3), &cubes.dispatcher());
    cubes.changed(0);
    EXPECT_TRUE(cubes.isPair(0, 1));
    EXPECT_FALSE(cubes.isPair(2, 3));
}

// --- Want of memory ------------------------------------------------------------------------------

TEST(IgnoredPairsOfBullet, AreMadeUpForByTheNextStepWhereMemoryRunsOut) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        const std::size_t failures = runOutOfMemory(
            [&] {
                auto boxes = std::make_unique<Boxes>(SpatialHashConfig{}, order);
                for (int i = 0; i < 40; ++i) {
                    boxes->create(cubeAt(btScalar(i) / 8));
                }
                boxes->step();
                return boxes;
            },
            [](Boxes& boxes) {
                for (std::size_t i = 0; i + 1 < boxes.proxies.size(); ++i) {
                    boxes.broadphase.ignorePair(boxes.proxies[i], boxes.proxies[i + 1], nullptr);
                }
                for (std::size_t i = 0; i + 1 < boxes.proxies.size(); i += 2) {
                    boxes.broadphase.stopIgnoringPair(boxes.proxies[i], boxes.proxies[i + 1],
                                                      nullptr);
                }
            },
            [](Boxes& boxes, std::size_t) {
                boxes.step();
                std::size_t ignored = 0;
                for (std::size_t i = 0; i < boxes.proxies.size(); ++i) {
                    for (std::size_t k = 0; k < i; ++k) {
                        const bool isIgnored =
                            boxes.broadphase.isIgnoredPair(boxes.proxies[i], boxes.proxies[k]);
                        const bool doOverlap =
                            overlap(boxOf(*boxes.proxies[i]), boxOf(*boxes.proxies[k]));
                        ignored += isIgnored ? 1 : 0;
                        EXPECT_EQ(boxes.isPair(i, k), doOverlap && !isIgnored);
                    }
                }
                EXPECT_LE(ignored, 39U);
                EXPECT_EQ(boxes.broadphase.validate(), "");
            });
        EXPECT_GE(failures, 4U);
    }
}

}  // namespace
}  // namespace hashphase::test
