// SPDX-License-Identifier: Zlib
//
// Worlds that compute boxes on several threads, against the same worlds of Bullet: to the bit.

#include <integration/bullet/parallel_aabbs.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/callbacks.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/threaded_for.hpp>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

/// Counts warnings.
struct Drawer : btIDebugDraw {
    void drawLine(const btVector3&, const btVector3&, const btVector3&) override {}
    void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                          const btVector3&) override {}
    void reportErrorWarning(const char*) override { ++warnings; }
    void draw3dText(const btVector3&, const char*) override {}
    void setDebugMode(int) override {}
    [[nodiscard]] int getDebugMode() const override { return 0; }

    int warnings = 0;
};

/// A world with all that its boxes depend on.
template <class World, class Solver = btSequentialImpulseConstraintSolver>
class Fall {
public:
    explicit Fall(std::unique_ptr<btBroadphaseInterface> broadphase)
        : broadphase_(std::move(broadphase)), world_(makeWorld()) {
        compound_.addChildShape(placeAt({1, 0, 0}), &ball_);
        compound_.addChildShape(placeAt({-1, 0, 0}), &box_);
        ground_.setCollisionShape(&plane_);
        world_->addCollisionObject(&ground_, btBroadphaseProxy::StaticFilter,
                                   btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
        BulletRandom random(0x5eed0c01);
        for (int i = 0; i < 2500; ++i) {
            btCollisionShape* const shape = i % 3 == 0   ? static_cast<btCollisionShape*>(&ball_)
                                            : i % 3 == 1 ? static_cast<btCollisionShape*>(&box_)
                                                         : &compound_;
            const bool isKinematic = i % 50 == 7;
            btRigidBody& body = bodies_.emplace_back(btRigidBody::btRigidBodyConstructionInfo(
                isKinematic ? 0 : 1, nullptr, shape, {1, 1, 1}));
            body.setWorldTransform(btTransform(btQuaternion(random.direction(), btScalar(i)),
                                               random.vector(0, 60) + btVector3(0, 2, 0)));
            body.setInterpolationWorldTransform(body.getWorldTransform());
            body.setLinearVelocity(random.vector(-20, 20));
            body.setAngularVelocity(random.vector(-5, 5));
            if (isKinematic) {
                body.setCollisionFlags(body.getCollisionFlags() |
                                       btCollisionObject::CF_KINEMATIC_OBJECT);
            }
            world_->addRigidBody(&body);
        }
        world_->setDebugDrawer(&drawer);
        world_->setGravity({0, -10, 0});
    }
    ~Fall() {
        for (int i = world_->getNumCollisionObjects(); i-- > 0;) {
            world_->removeCollisionObject(world_->getCollisionObjectArray()[i]);
        }
    }

    void step() { static_cast<btDynamicsWorld&>(*world_).stepSimulation(btScalar(1) / 60, 0); }
    [[nodiscard]] World& world() { return *world_; }
    [[nodiscard]] btRigidBody& body(int i) { return bodies_[std::size_t(i)]; }

    /// Boxes, activation states and transforms of all objects, and the pairs.
    [[nodiscard]] std::string state() {
        std::string bytes;
        const auto add = [&](const btVector3& v) {
            bytes.append(reinterpret_cast<const char*>(v.m_floats), 3 * sizeof(btScalar));
        };
        for (int i = 0; i < world_->getNumCollisionObjects(); ++i) {
            const btCollisionObject& object = *world_->getCollisionObjectArray()[i];
            add(object.getBroadphaseHandle()->m_aabbMin);
            add(object.getBroadphaseHandle()->m_aabbMax);
            add(object.getWorldTransform().getOrigin());
            bytes += static_cast<char>(object.getActivationState());
        }
        for (const auto& [a, b] : uidList(*broadphase_->getOverlappingPairCache())) {
            bytes += std::to_string(a) + ' ' + std::to_string(b) + '\n';
        }
        return bytes;
    }

    Drawer drawer;

private:
    std::unique_ptr<World> makeWorld() {
        if constexpr (std::is_base_of_v<btDiscreteDynamicsWorldMt, World>) {
            btSetTaskScheduler(btGetSequentialTaskScheduler());
            return std::make_unique<World>(&dispatcher_, broadphase_.get(), &solvers_, nullptr,
                                           &configuration_);
        } else {
            return std::make_unique<World>(&dispatcher_, broadphase_.get(), &solver_,
                                           &configuration_);
        }
    }

    btStaticPlaneShape plane_{{0, 1, 0}, 0};
    btSphereShape ball_{btScalar(0.5)};
    btBoxShape box_{btVector3(btScalar(0.3), btScalar(0.5), btScalar(0.7))};
    btCompoundShape compound_;
    btSoftBodyRigidBodyCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    Solver solver_;
    btConstraintSolverPoolMt solvers_{1};
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    btCollisionObject ground_;
    std::deque<btRigidBody> bodies_;
    std::unique_ptr<World> world_;
};

/// Ours on so many threads; 0 for none.
std::unique_ptr<btBroadphaseInterface> hashOn(ThreadedFor* threads) {
    SpatialHashConfig config;
    if (threads != nullptr) {
        config.parallelFor = [threads](std::size_t count, std::size_t grain, LoopBody body) {
            (*threads)(count, grain, body);
        };
    }
    return std::make_unique<SpatialHashBroadphase>(config);
}

/// A scene of `World` and one of ParallelAabbs<World>, step by step.
template <class World, class Solver = btSequentialImpulseConstraintSolver, class Act>
void expectSame(std::unique_ptr<btBroadphaseInterface> forOwn,
                std::unique_ptr<btBroadphaseInterface> forBullets, const Act& act) {
    Fall<ParallelAabbs<World>, Solver> own(std::move(forOwn));
    Fall<World, Solver> bullets(std::move(forBullets));
    for (int step = 0; step < 12; ++step) {
        SCOPED_TRACE(step);
        act(own, step);
        act(bullets, step);
        own.step();
        bullets.step();
        ASSERT_EQ(own.state(), bullets.state());
        ASSERT_EQ(own.world().getNumCollisionObjects(), bullets.world().getNumCollisionObjects());
    }
}

constexpr auto kStepOnly = [](auto& /*scene*/, int /*step*/) {};

template <class World, class Solver = btSequentialImpulseConstraintSolver>
void expectSameOnThreads() {
    for (const std::size_t threadCount : {1U, 2U, 3U, 8U}) {
        SCOPED_TRACE(testing::Message() << threadCount << " threads");
        ThreadedFor threads(threadCount, 0x5eed0c02);
        expectSame<World, Solver>(hashOn(&threads), hashOn(nullptr), kStepOnly);
        EXPECT_GT(threads.mostRanges(), 1U);
    }
}

TEST(ParallelAabbs, HaveTheBoxesOfEveryWorld) {
    expectSameOnThreads<btDiscreteDynamicsWorld>();
    expectSameOnThreads<btDiscreteDynamicsWorldMt>();
    expectSameOnThreads<btSoftRigidDynamicsWorld>();
    expectSameOnThreads<btMultiBodyDynamicsWorld, btMultiBodyConstraintSolver>();
}

// What is set by hand between steps, and what Bullet takes out of the simulation.
TEST(ParallelAabbs, FollowTheFlagsOfWorldAndObject) {
    ThreadedFor threads(3, 0x5eed0c03);
    int tooLarge = 0;
    expectSame<btDiscreteDynamicsWorld>(
        hashOn(&threads), hashOn(nullptr), [&](auto& scene, int step) {
            constexpr btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
            scene.world().setForceUpdateAllAabbs(step % 4 != 1);
            scene.world().getDispatchInfo().m_useContinuous = step % 5 != 2;
            for (int i = 0; i < 400; ++i) {
                scene.body(3 * i + step).setActivationState(ISLAND_SLEEPING);
            }
            if (step == 3) {
                scene.body(40).setLinearVelocity({btScalar(1e9), 0, 0});
                scene.body(41).setLinearVelocity({nan, 0, 0});
            }
            if (step == 6) {
                tooLarge += scene.body(40).getActivationState() == DISABLE_SIMULATION ? 1 : 0;
                scene.world().removeRigidBody(&scene.body(100));
                scene.world().addRigidBody(&scene.body(100));
            }
        });
    EXPECT_EQ(tooLarge, 2);  // in both
}

TEST(ParallelAabbs, WorkOverAnyBroadphase) {
    const std::vector<std::unique_ptr<btBroadphaseInterface> (*)()> makers{
        [] { return hashOn(nullptr); }, makeBroadphase<btDbvtBroadphase>,
        makeBroadphase<btSimpleBroadphase>,
        []() -> std::unique_ptr<btBroadphaseInterface> {
            return std::make_unique<bt32BitAxisSweep3>(btVector3(-1000, -1000, -1000),
                                                       btVector3(1000, 1000, 1000), 4000);
        }};
    for (const auto make : makers) {
        expectSame<btDiscreteDynamicsWorld>(make(), make(), kStepOnly);
    }
}

TEST(ParallelAabbs, FollowSoftBodies) {
    const auto scene = [](auto& world, btSoftBodyWorldInfo& info) {
        btSoftBody* const ball =
            btSoftBodyHelpers::CreateEllipsoid(info, {0, 70, 0}, {1, 1, 1}, 60);
        world.addSoftBody(ball);
        return ball;
    };
    ThreadedFor threads(2, 0x5eed0c04);
    Fall<ParallelAabbs<btSoftRigidDynamicsWorld>> own(hashOn(&threads));
    Fall<btSoftRigidDynamicsWorld> bullets(hashOn(nullptr));
    const std::unique_ptr<btSoftBody> one(scene(own.world(), own.world().getWorldInfo()));
    const std::unique_ptr<btSoftBody> other(scene(bullets.world(), bullets.world().getWorldInfo()));
    for (int step = 0; step < 12; ++step) {
        own.step();
        bullets.step();
        ASSERT_EQ(own.state(), bullets.state());
    }
    own.world().removeSoftBody(one.get());
    bullets.world().removeSoftBody(other.get());
}

// The update within the callback sets other boxes: one more, and none of an object that sleeps.
TEST(ParallelAabbs, MayBeUpdatedByACallbackThatAddsAnObject) {
    SpatialHashConfig config;
    config.parallelFor = serialFor;
    config.eagerGroups = btBroadphaseProxy::CharacterFilter;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    SpatialHashBroadphase broadphase(config);
    btSphereShape ball(1);
    std::array<btCollisionObject, 6> objects;
    ParallelAabbs<btCollisionWorld> world(&dispatcher, &broadphase, &configuration);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        objects[i].setCollisionShape(&ball);
        objects[i].setWorldTransform(placeAt({10 * static_cast<btScalar>(i), 0, 0}));
        world.addCollisionObject(&objects[i], i == 0 ? btBroadphaseProxy::CharacterFilter
                                                     : btBroadphaseProxy::DefaultFilter);
    }
    world.updateAabbs();
    world.removeCollisionObject(&objects.back());

    PairJournal journal;
    journal.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        world.addCollisionObject(&objects.back());
        world.setForceUpdateAllAabbs(false);
        world.updateAabbs();
    };
    broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&journal);
    objects[0].setWorldTransform(objects[1].getWorldTransform());
    for (std::size_t i = 1; i < objects.size(); ++i) {
        objects[i].setWorldTransform(placeAt({10 * static_cast<btScalar>(i), 5, 0}));
    }
    objects[2].setActivationState(ISLAND_SLEEPING);
    world.updateAabbs();
    broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
    EXPECT_EQ(journal.all.size(), 1U);
    for (const btCollisionObject& object : objects) {
        const btBroadphaseProxy& proxy = *object.getBroadphaseHandle();
        const btVector3 centre = (proxy.m_aabbMin + proxy.m_aabbMax) / 2;
        EXPECT_LT(centre.distance(object.getWorldTransform().getOrigin()), btScalar(0.01))
            << "object " << &object - objects.data();
    }
}

}  // namespace
}  // namespace hashphase::test
