// SPDX-License-Identifier: Zlib
//
// Bullet's task schedulers: none, its sequential one, one of the program's own, and Bullet's own threads, which
// a Bullet has that was built with BT_THREADSAFE (and Debian's was not). Worlds on these threads.

#include <demos/stability/run_together.hpp>
#include <integration/bullet/bullet_parallel_for.hpp>
#include <integration/bullet/parallel_aabbs.hpp>
#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/threaded_for.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorldMt.h>
#include <LinearMath/btThreads.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace hashphase::test {
namespace {

/// A program's own, on three threads where there are threads.
class OwnScheduler : public btITaskScheduler {
public:
    OwnScheduler() : btITaskScheduler("own") {}
    [[nodiscard]] int getMaxNumThreads() const override { return demos::hasThreads() ? 3 : 1; }
    [[nodiscard]] int getNumThreads() const override { return getMaxNumThreads(); }
    void setNumThreads(int /*count*/) override {}
    void parallelFor(int begin, int end, int grain, const btIParallelForBody& body) override {
        threads_(static_cast<std::size_t>(end - begin), static_cast<std::size_t>(grain),
                 [&](std::size_t from, std::size_t to) {
                     body.forLoop(begin + static_cast<int>(from), begin + static_cast<int>(to));
                 });
    }
    btScalar parallelSum(int begin, int end, int /*grain*/,
                         const btIParallelSumBody& body) override {
        return body.sumLoop(begin, end);
    }

private:
    ThreadedFor threads_{3, 0x5eed0910};
};

/// A scheduler that is Bullet's in this scope.
class Scheduled {
public:
    explicit Scheduled(btITaskScheduler* scheduler) { btSetTaskScheduler(scheduler); }
    ~Scheduled() { btSetTaskScheduler(nullptr); }
    Scheduled(const Scheduled&) = delete;
    Scheduled& operator=(const Scheduled&) = delete;

    [[nodiscard]] static int threadCount() {
        return btGetTaskScheduler() == nullptr ? 1 : btGetTaskScheduler()->getNumThreads();
    }
};

/// Null where Bullet was built without threads. It is never deleted: its destructor writes before the array of
/// its threads when a thread that has finished once is at work again (btThreadSupportPosix::waitForResponse()).
btITaskScheduler* bulletsThreads() {
    static btITaskScheduler* const scheduler = btCreateDefaultTaskScheduler();
    if (scheduler != nullptr) {
        scheduler->setNumThreads(std::min(4, scheduler->getMaxNumThreads()));
    }
    return scheduler;
}

/// Runs the test under each scheduler.
template <class Test>
void underEachScheduler(const Test& test) {
    {
        SCOPED_TRACE("no scheduler");
        test();
    }
    {
        SCOPED_TRACE("the sequential scheduler");
        const Scheduled scheduled(btGetSequentialTaskScheduler());
        test();
    }
    {
        SCOPED_TRACE("a scheduler of the program's own");
        OwnScheduler own;
        const Scheduled scheduled(&own);
        test();
    }
    if (btITaskScheduler* const threads = bulletsThreads()) {
        SCOPED_TRACE("Bullet's threads");
        const Scheduled scheduled(threads);
        test();
    }
}

SpatialHashConfig onBulletsThreads() {
    SpatialHashConfig config;
    config.parallelFor = bulletFor;
    return config;
}

TEST(BulletFor, RunsEveryIterationOnce) {
    underEachScheduler([] {
        for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
            std::vector<int> times(count, 0);
            bulletFor(count, 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    ++times[i];
                }
            });
            EXPECT_EQ(std::ranges::count(times, 1), static_cast<std::ptrdiff_t>(count));
        }
    });
}

// Each range waits for another one to begin, which only another thread can do.
TEST(BulletFor, RunsOnTheThreadsOfTheScheduler) {
    underEachScheduler([] {
        const bool hasThreads = Scheduled::threadCount() > 1;
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        std::atomic<int> begun = 0;
        bulletFor(8, 1, [&](std::size_t, std::size_t) {
            ++begun;
            while (hasThreads && begun < 2 && std::chrono::steady_clock::now() < deadline) {
                std::this_thread::yield();
            }
        });
        EXPECT_GE(begun, hasThreads ? 2 : 1);
        EXPECT_LT(std::chrono::steady_clock::now(), deadline);
    });
}

TEST(BulletFor, ThrowsWhatALoopThrows) {
    underEachScheduler([] {
        const auto fail = [](std::size_t, std::size_t) {
            throw std::runtime_error("as one part does");
        };
        EXPECT_THROW(bulletFor(1000, 16, fail), std::runtime_error);
    });
}

TEST(BulletFor, GivesTheSamePairsInTheSameOrder) {
    underEachScheduler([] { expectPairsOfSerialFrames(onBulletsThreads(), 3); });
}

/// Bodies that fall on a plane, every third one so fast that Bullet sweeps it; contacts, islands, sweeps and
/// boxes are computed on the scheduler's threads.
template <class World>
class ThreadedWorld {
public:
    ThreadedWorld() {
        BulletRandom random(0x5eed0912);
        ground_.setCollisionShape(&plane_);
        world_.addCollisionObject(&ground_, btBroadphaseProxy::StaticFilter,
                                  btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
        for (int i = 0; i < 1500; ++i) {
            btCollisionShape* const shape =
                i % 2 == 0 ? static_cast<btCollisionShape*>(&ball_) : &box_;
            btRigidBody& body = bodies_.emplace_back(
                btRigidBody::btRigidBodyConstructionInfo(1, nullptr, shape, {1, 1, 1}));
            body.setWorldTransform(placeAt(random.vector(0, 16) + btVector3(0, 1, 0)));
            body.setLinearVelocity(random.vector(-5, 5));
            if (i % 3 == 0) {
                body.setLinearVelocity(random.vector(-80, 80));
                body.setCcdMotionThreshold(btScalar(0.2));
                body.setCcdSweptSphereRadius(btScalar(0.2));
            }
            world_.addRigidBody(&body);
        }
        world_.setGravity({0, -10, 0});
    }
    ~ThreadedWorld() {
        for (btRigidBody& body : bodies_) {
            world_.removeRigidBody(&body);
        }
        world_.removeCollisionObject(&ground_);
    }
    ThreadedWorld(const ThreadedWorld&) = delete;
    ThreadedWorld& operator=(const ThreadedWorld&) = delete;

    void step() { static_cast<btDynamicsWorld&>(world_).stepSimulation(btScalar(1) / 60, 0); }
    [[nodiscard]] btCollisionWorld& world() { return world_; }
    [[nodiscard]] const SpatialHashBroadphase& broadphase() const { return broadphase_; }
    [[nodiscard]] int contactCount() const { return dispatcher_.getNumManifolds(); }

    [[nodiscard]] std::vector<Uids> pairs() {
        std::vector<Uids> pairs = uidList(*broadphase_.getOverlappingPairCache());
        std::ranges::sort(pairs);
        return pairs;
    }
    /// What every two boxes say.
    [[nodiscard]] std::vector<Uids> overlaps() {
        std::vector<Uids> pairs;
        const btCollisionObjectArray& objects = world_.getCollisionObjectArray();
        for (int i = 0; i < objects.size(); ++i) {
            for (int j = 0; j < i; ++j) {
                const btBroadphaseProxy& a = *objects[i]->getBroadphaseHandle();
                const btBroadphaseProxy& b = *objects[j]->getBroadphaseHandle();
                if (groupsCollide(a, b) && overlap(boxOf(a), boxOf(b))) {
                    pairs.push_back(uidsOf(a, b));
                }
            }
        }
        std::ranges::sort(pairs);
        return pairs;
    }

private:
    btStaticPlaneShape plane_{{0, 1, 0}, 0};
    btSphereShape ball_{btScalar(0.5)};
    btBoxShape box_{btVector3(btScalar(0.4), btScalar(0.5), btScalar(0.3))};
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcherMt dispatcher_{&configuration_, 16};
    btConstraintSolverPoolMt solvers_{Scheduled::threadCount()};
    SpatialHashBroadphase broadphase_{onBulletsThreads()};
    World world_{&dispatcher_, &broadphase_, &solvers_, nullptr, &configuration_};
    btCollisionObject ground_;
    std::deque<btRigidBody> bodies_;
};

// Bullet's Mt classes want a scheduler; one with threads is safe with a Bullet that was built for threads.
template <class Test>
void onTheThreadsOfWorlds(const Test& test) {
    btITaskScheduler* const threads = bulletsThreads();
    if (threads == nullptr) {
        const Scheduled scheduled(btGetSequentialTaskScheduler());
        test();
    } else {
        const Scheduled scheduled(threads);
        test();
    }
}

template <class World>
void expectExactPairs() {
    onTheThreadsOfWorlds([] {
        ThreadedWorld<World> scene;
        for (int step = 0; step < 40; ++step) {
            SCOPED_TRACE(step);
            scene.step();
            ASSERT_EQ(scene.broadphase().validate(), "");
            ASSERT_EQ(scene.pairs(), scene.overlaps());
        }
        EXPECT_GT(scene.contactCount(), 1000);
    });
}

TEST(TaskScheduler, ThreadedWorldsHaveExactPairs) {
    expectExactPairs<btDiscreteDynamicsWorldMt>();
    expectExactPairs<ParallelAabbs<btDiscreteDynamicsWorldMt>>();
}

/// The object that a ray of a world hits first; null if none.
const btCollisionObject* firstHit(btCollisionWorld& world, const btVector3& from,
                                  const btVector3& to) {
    btCollisionWorld::ClosestRayResultCallback callback(from, to);
    world.rayTest(from, to, callback);
    return callback.m_collisionObject;
}

TEST(TaskScheduler, RaysOfManyThreadsHitWhatTheyHitAlone) {
    onTheThreadsOfWorlds([] {
        ThreadedWorld<btDiscreteDynamicsWorldMt> scene;
        scene.step();
        BulletRandom random(0x5eed0913);
        constexpr std::size_t kRayCount = 4000;
        std::vector<Box> rays;  // from corner to corner
        std::vector<const btCollisionObject*> alone;
        for (std::size_t i = 0; i < kRayCount; ++i) {
            rays.push_back({random.vector(-5, 20), random.vector(-5, 20)});
            alone.push_back(firstHit(scene.world(), rays[i].min, rays[i].max));
        }
        std::vector<const btCollisionObject*> together(kRayCount);
        bulletFor(kRayCount, 8, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                together[i] = firstHit(scene.world(), rays[i].min, rays[i].max);
            }
        });
        EXPECT_EQ(together, alone);
        EXPECT_GT(kRayCount - static_cast<std::size_t>(std::ranges::count(alone, nullptr)), 1000U);
    });
}

}  // namespace
}  // namespace hashphase::test
