// SPDX-License-Identifier: Zlib
//
// What a change of shape needs: under Bullet cleanProxyFromPairs(), or that the object is removed and
// added again, here shapeChanged(). Pairs that keep the algorithm of the former shape read a sphere as a
// compound, say.

#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/ghost_world.hpp>
#include <tests/integration/bullet/pair_journal.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

/// A body on a floor, in a world that tells ghosts of pairs.
struct BodyOnFloor {
    explicit BodyOnFloor(std::unique_ptr<btBroadphaseInterface> over)
        : broadphase(std::move(over)) {
        world.getPairCache()->setInternalGhostPairCallback(&ghostCallback);
        compound.addChildShape(btTransform::getIdentity(), &box);
        compound.addChildShape(btTransform(btQuaternion::getIdentity(), {0, 1, 0}), &box);
        floor.setWorldTransform(GhostWorld::at({0, -1, 0}));
        body.setWorldTransform(GhostWorld::at({0, btScalar(0.5), 0}));
        world.addRigidBody(&floor);
        world.addRigidBody(&body);
    }
    ~BodyOnFloor() {
        world.removeRigidBody(&body);
        world.removeRigidBody(&floor);
        world.getPairCache()->setInternalGhostPairCallback(nullptr);
    }
    BodyOnFloor(const BodyOnFloor&) = delete;
    BodyOnFloor& operator=(const BodyOnFloor&) = delete;

    void step(int count) {
        body.activate(true);
        for (int i = 0; i < count; ++i) {
            world.stepSimulation(btScalar(1) / 60, 0);
        }
    }
    [[nodiscard]] double height() const { return double(body.getWorldTransform().getOrigin().y()); }
    void shapeChanged(btCollisionObject& object) {
        dynamic_cast<SpatialHashBroadphase&>(*broadphase)
            .shapeChanged(object.getBroadphaseHandle(), &dispatcher);
    }

    btGhostPairCallback ghostCallback;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::unique_ptr<btBroadphaseInterface> broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world{&dispatcher, broadphase.get(), &solver, &configuration};
    btBoxShape ground{btVector3(50, 1, 50)};
    btBoxShape box{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    btSphereShape sphere{2};
    btCompoundShape compound;
    btRigidBody floor{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &ground)};
    btRigidBody body{
        btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &compound, btVector3(1, 1, 1))};
};

using Renew = std::function<void(BodyOnFloor&)>;

void cleanPairs(BodyOnFloor& scene) {
    scene.world.updateSingleAabb(&scene.body);
    scene.world.getPairCache()->cleanProxyFromPairs(scene.body.getBroadphaseHandle(),
                                                    &scene.dispatcher);
}

void callShapeChanged(BodyOnFloor& scene) {
    scene.world.updateSingleAabb(&scene.body);
    scene.shapeChanged(scene.body);
}

/// Where the body rests that was two boxes and is a sphere now.
double heightAsSphere(std::unique_ptr<btBroadphaseInterface> over, const Renew& renew) {
    BodyOnFloor scene(std::move(over));
    scene.step(60);
    scene.body.setCollisionShape(&scene.sphere);
    renew(scene);
    scene.step(240);
    return scene.height();
}

/// Where a sphere rests that has been scaled to half its size.
double heightAsScaled(std::unique_ptr<btBroadphaseInterface> over, const Renew& renew) {
    BodyOnFloor scene(std::move(over));
    scene.body.setCollisionShape(&scene.sphere);
    scene.body.setWorldTransform(GhostWorld::at({0, 2, 0}));
    renew(scene);
    scene.step(60);
    scene.sphere.setLocalScaling(btVector3(1, 1, 1) / 2);
    renew(scene);
    scene.step(240);
    return scene.height();
}

struct Cache {
    const char* name;
    std::function<std::unique_ptr<btOverlappingPairCache>()> make;
};

void PrintTo(const Cache& cache, std::ostream* out) {
    *out << cache.name;
}

std::vector<Cache> caches() {
    return {{"own", [] { return nullptr; }},
            {"arrival", [] { return std::make_unique<PairCache>(); }},
            {"canonical", [] { return std::make_unique<PairCache>(PairOrder::canonical); }},
            {"hashed", [] { return std::make_unique<btHashedOverlappingPairCache>(); }},
            {"deferred", [] { return std::make_unique<btSortedOverlappingPairCache>(); }}};
}

class ChangedShapes : public testing::TestWithParam<Cache> {
protected:
    std::unique_ptr<btBroadphaseInterface> over() {
        cache_ = GetParam().make();
        return std::make_unique<SpatialHashBroadphase>(cache_.get());
    }

private:
    std::unique_ptr<btOverlappingPairCache> cache_;
};

TEST_P(ChangedShapes, RestAsUnderBtDbvtBroadphase) {
    const double expected = heightAsSphere(std::make_unique<btDbvtBroadphase>(), cleanPairs);
    EXPECT_NEAR(expected, 2, 0.05);
    EXPECT_NEAR(heightAsSphere(over(), callShapeChanged), expected, 0.01);
}

TEST_P(ChangedShapes, RestAsUnderBtDbvtBroadphaseWhenScaled) {
    const double expected = heightAsScaled(std::make_unique<btDbvtBroadphase>(), cleanPairs);
    EXPECT_NEAR(expected, 1, 0.05);
    EXPECT_NEAR(heightAsScaled(over(), callShapeChanged), expected, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Caches, ChangedShapes, testing::ValuesIn(caches()),
                         [](const auto& cache) { return cache.param.name; });

// What programs call under btDbvtBroadphase goes on to work.
TEST(ChangedShapesOfPrograms, RestWhateverTheProgramCallsForThem) {
    const Renew removeAndAdd = [](BodyOnFloor& scene) {
        scene.world.removeRigidBody(&scene.body);
        scene.world.addRigidBody(&scene.body);
    };
    const Renew refresh = [](BodyOnFloor& scene) {
        scene.world.refreshBroadphaseProxy(&scene.body);
    };
    for (const Renew& renew : {Renew(cleanPairs), removeAndAdd, refresh}) {
        EXPECT_NEAR(heightAsSphere(std::make_unique<SpatialHashBroadphase>(), renew), 2, 0.05);
        EXPECT_NEAR(heightAsScaled(std::make_unique<SpatialHashBroadphase>(), renew), 1, 0.05);
    }
}

/// The pair that a ghost keeps of another object.
btBroadphasePair* pairOf(btPairCachingGhostObject& ghost, btCollisionObject& other) {
    return ghost.getOverlappingPairCache()->findPair(ghost.getBroadphaseHandle(),
                                                     other.getBroadphaseHandle());
}

// A ghost's cache has algorithms of its own, which characters make in each step.
TEST(ChangedShapesBesideGhosts, LeaveNoAlgorithmInTheirCaches) {
    btHashedOverlappingPairCache hashed;
    for (btOverlappingPairCache* cache : {static_cast<btOverlappingPairCache*>(nullptr),
                                          static_cast<btOverlappingPairCache*>(&hashed)}) {
        BodyOnFloor scene(std::make_unique<SpatialHashBroadphase>(cache));
        btPairCachingGhostObject ghost;
        btCapsuleShape capsule(1, 1);
        ghost.setCollisionShape(&capsule);
        ghost.setWorldTransform(GhostWorld::at({btScalar(1.2), 1, 0}));
        scene.world.addCollisionObject(&ghost);  // a pair at once, before any step
        const auto dispatch = [&] {
            scene.dispatcher.dispatchAllCollisionPairs(
                ghost.getOverlappingPairCache(), scene.world.getDispatchInfo(), &scene.dispatcher);
        };
        dispatch();
        ASSERT_NE(pairOf(ghost, scene.body), nullptr);
        ASSERT_NE(pairOf(ghost, scene.body)->m_algorithm, nullptr);
        for (btCollisionObject* changed : {static_cast<btCollisionObject*>(&scene.body),
                                           static_cast<btCollisionObject*>(&ghost)}) {
            changed->setCollisionShape(&scene.sphere);
            scene.world.updateSingleAabb(changed);
            scene.shapeChanged(*changed);
            ASSERT_NE(pairOf(ghost, scene.body), nullptr) << "The pair stays.";
            EXPECT_EQ(pairOf(ghost, scene.body)->m_algorithm, nullptr);
            dispatch();
            ASSERT_NE(pairOf(ghost, scene.body)->m_algorithm, nullptr);
        }
        scene.step(10);
        scene.world.removeCollisionObject(&ghost);
    }
}

TEST(ChangedShapesInACache, KeepTheirPairsAndEndAndBeginForGhosts) {
    PairJournal journal;
    Player player = hashPlayer(20);
    player.cache().setInternalGhostPairCallback(&journal);
    for (int object = 0; object < 20; ++object) {
        player.play({Action::create, object, boxAround({btScalar(object), 0, 0}, {1, 1, 1}),
                     btBroadphaseProxy::DefaultFilter, btBroadphaseProxy::AllFilter});
    }
    player.calculate();
    const ObjectPairs before = player.pairs();
    journal.takeTouched();
    const auto& cache = dynamic_cast<const PairCache&>(player.cache());
    const std::uint64_t visited = cache.pairsVisited();
    hashOf(player).shapeChanged(player.proxy(7), nullptr);
    EXPECT_EQ(cache.pairsVisited() - visited, 4U) << "as many as the proxy has pairs";
    EXPECT_EQ(player.pairs(), before);
    EXPECT_EQ(journal.takeTouched().size(), 4U);
    EXPECT_EQ(journal.errors(), std::vector<std::string>{});
    EXPECT_EQ(journal.alive(), uidPairs(player.cache()));
    EXPECT_EQ(hashOf(player).validate(), "");
}

}  // namespace
}  // namespace hashphase::test
