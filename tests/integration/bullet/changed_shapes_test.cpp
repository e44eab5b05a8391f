// SPDX-License-Identifier: Zlib
//
// What a change of shape needs: under Bullet cleanProxyFromPairs(), or that the object is removed and
// added again, here shapeChanged(). Pairs that keep the algorithm of the former shape read a sphere as a
// compound, say.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/dynamics.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

/// A body of two boxes on a floor, in a world that tells ghosts of pairs.
struct BodyOnFloor : DynamicsWorld {
    explicit BodyOnFloor(std::unique_ptr<btBroadphaseInterface> over)
        : DynamicsWorld(std::move(over)) {
        tellGhosts();
        addBox({50, 1, 50}, 0, {0, -1, 0});
        compound.addChildShape(placeAt({0, 0, 0}), &box);
        compound.addChildShape(placeAt({0, 1, 0}), &box);
        add(&compound, 1, placeAt({0, btScalar(0.5), 0}));
    }
    ~BodyOnFloor() { takeOut(1); }

    [[nodiscard]] btRigidBody& lying() { return body(1); }
    [[nodiscard]] double heightAfter(int steps) {
        lying().activate(true);
        step(steps);
        return double(lying().getWorldTransform().getOrigin().y());
    }
    void shapeChanged(btCollisionObject& object) {
        world().updateSingleAabb(&object);
        hash().shapeChanged(object.getBroadphaseHandle(), &dispatcher());
    }

    btBoxShape box{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btSphereShape sphere{2};
    btCompoundShape compound;
};

/// What is called when the body's shape has changed.
using Renew = void (*)(BodyOnFloor&);

void cleanPairs(BodyOnFloor& scene) {
    scene.world().updateSingleAabb(&scene.lying());
    scene.cache().cleanProxyFromPairs(scene.lying().getBroadphaseHandle(), &scene.dispatcher());
}
void callShapeChanged(BodyOnFloor& scene) {
    scene.shapeChanged(scene.lying());
}
// As programs do under btDbvtBroadphase.
void removeAndAdd(BodyOnFloor& scene) {
    scene.takeOut(1);
    scene.world().addRigidBody(&scene.lying());
}
void refresh(BodyOnFloor& scene) {
    scene.world().refreshBroadphaseProxy(&scene.lying());
}

/// Where the body rests that was two boxes and is a sphere then, and where when that is half as large.
std::pair<double, double> heights(std::unique_ptr<btBroadphaseInterface> over, Renew renew) {
    BodyOnFloor scene(std::move(over));
    static_cast<void>(scene.heightAfter(60));
    scene.lying().setCollisionShape(&scene.sphere);
    renew(scene);
    const double whole = scene.heightAfter(240);
    scene.sphere.setLocalScaling(btVector3(1, 1, 1) / 2);
    renew(scene);
    return {whole, scene.heightAfter(240)};
}

class ChangedShapes : public testing::TestWithParam<CacheKind> {};

TEST_P(ChangedShapes, RestAsUnderBtDbvtBroadphaseWhateverIsCalled) {
    const auto [whole, half] = heights(makeBroadphase<btDbvtBroadphase>(), cleanPairs);
    EXPECT_NEAR(whole, 2, 0.05);
    EXPECT_NEAR(half, 1, 0.05);
    for (const Renew renew : {callShapeChanged, cleanPairs, removeAndAdd, refresh}) {
        const std::unique_ptr<btOverlappingPairCache> cache = GetParam().make();
        const auto [ourWhole, ourHalf] = heights(hashOver(cache.get()), renew);
        EXPECT_NEAR(ourWhole, whole, 0.01);
        EXPECT_NEAR(ourHalf, half, 0.01);
    }
}

INSTANTIATE_TEST_SUITE_P(Caches, ChangedShapes, testing::ValuesIn(kCacheKinds),
                         [](const auto& kind) { return kind.param.name; });

// A ghost's cache has algorithms of its own, which characters make in each step.
TEST(ChangedShapesBesideGhosts, LeaveNoAlgorithmInTheirCaches) {
    for (const CacheKind& kind : {kCacheKinds[0], kCacheKinds[3]}) {
        const std::unique_ptr<btOverlappingPairCache> cache = kind.make();
        btCapsuleShape capsule(1, 1);
        BodyOnFloor scene(hashOver(cache.get()));
        btPairCachingGhostObject& ghost = scene.addGhost(&capsule, {btScalar(1.2), 1, 0});
        const auto algorithm = [&]() -> btCollisionAlgorithm* {
            const btBroadphasePair* const pair = ghost.getOverlappingPairCache()->findPair(
                ghost.getBroadphaseHandle(), scene.lying().getBroadphaseHandle());
            EXPECT_NE(pair, nullptr) << "It is one before any step, and stays one.";
            return pair != nullptr ? pair->m_algorithm : nullptr;
        };
        const auto dispatch = [&] {
            scene.dispatcher().dispatchAllCollisionPairs(ghost.getOverlappingPairCache(),
                                                         scene.world().getDispatchInfo(),
                                                         &scene.dispatcher());
            EXPECT_NE(algorithm(), nullptr);
        };
        dispatch();
        for (btCollisionObject* changed : {static_cast<btCollisionObject*>(&scene.lying()),
                                           static_cast<btCollisionObject*>(&ghost)}) {
            changed->setCollisionShape(&scene.sphere);
            scene.shapeChanged(*changed);
            EXPECT_EQ(algorithm(), nullptr);
            dispatch();
        }
        scene.step(10);
    }
}

TEST(ChangedShapesInACache, KeepTheirPairsAndEndAndBeginForGhosts) {
    PairJournal journal;
    Boxes boxes;
    boxes.cache.setInternalGhostPairCallback(&journal);
    for (int i = 0; i < 20; ++i) {
        boxes.create(boxAround({btScalar(i), 0, 0}, {1, 1, 1}));
    }
    boxes.check();
    journal.takeTouched();
    const std::uint64_t visited = boxes.cache.pairsVisited();
    boxes.broadphase.shapeChanged(boxes.proxies[7], nullptr);
    EXPECT_EQ(boxes.cache.pairsVisited() - visited, 4U) << "as many as the proxy has pairs";
    EXPECT_EQ(journal.takeTouched().size(), 4U);
    EXPECT_EQ(journal.errors, std::vector<std::string>{});
    EXPECT_EQ(journal.alive, uidPairs(boxes.cache));
    boxes.check();
}

}  // namespace
}  // namespace hashphase::test
