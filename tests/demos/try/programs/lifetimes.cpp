// SPDX-License-Identifier: Zlib

// How worlds come and go.

#include "program.hpp"

#include <cstdlib>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace programs {
namespace {

int boxesOf(const Scene<>& scene) {
    return scene.things.countNear({4, 2, 0}, 8) - 1;
}

// Three worlds in turn, destroyed in another order than they were made, and a fourth made in between.
COMPARED_PROGRAM(severalWorlds) {
    std::unique_ptr<Pile> scenes[4];
    for (int i = 0; i < 3; ++i) {
        scenes[i] = std::make_unique<Pile>(0, nullptr, 1 + i);
    }
    for (int i = 0; i < 60; ++i) {
        scenes[i % 3]->step(1);
    }
    scenes[1].reset();
    scenes[3] = std::make_unique<Pile>(0, nullptr, 2);
    for (int i = 0; i < 60; ++i) {
        scenes[i % 2 == 0 ? 0 : 3]->step(1);
    }
    scenes[0].reset();
    scenes[2]->step(30);
    scenes[3].reset();
    say("boxes of the last world", boxesOf(*scenes[2]));
    scenes[2].reset();
}

// Worlds that are stepped on threads of their own, all at once.
COMPARED_PROGRAM(threads) {
    std::vector<std::thread> all;
    std::vector<int> resting(4);
    for (int i = 0; i < 4; ++i) {
        all.emplace_back([i, &resting] { resting[i] = boxesOf(Pile(50 + 10 * i)); });
    }
    for (std::thread& thread : all) {
        thread.join();
    }
    say("boxes", std::accumulate(resting.begin(), resting.end(), 0));
}

// Bodies come and go while the world is stepped, at a fixed seed.
COMPARED_PROGRAM(churn) {
    Scene<> scene;
    scene.addGround();
    auto* sphere = scene.things.sphere(btScalar(0.5));
    std::mt19937 random(1);
    std::vector<btRigidBody*> alive;
    for (int i = 0; i < 200; ++i) {
        for (int added = 0; added < 2; ++added) {
            const auto x = btScalar(random() % 10);
            const auto z = btScalar(random() % 10);
            alive.push_back(scene.add(sphere, 1, {x, 8, z}));
        }
        if (alive.size() > 100) {
            for (int removed = 0; removed < 2; ++removed) {
                const std::size_t which = random() % alive.size();
                scene.world.removeRigidBody(alive[which]);
                alive[which] = alive.back();
                alive.pop_back();
            }
        }
        scene.step(1);
    }
    say("bodies", scene.world.getNumCollisionObjects());
}

// The order of the tutorial "Hello World": world, solver, broadphase, dispatcher, all on the heap; bodies
// are left to the world, and the broadphase is deleted through its base.
COMPARED_PROGRAM(helloWorld) {
    auto* configuration = new btDefaultCollisionConfiguration();
    auto* dispatcher = new btCollisionDispatcher(configuration);
    btBroadphaseInterface* broadphase = new btDbvtBroadphase();
    auto* solver = new btSequentialImpulseConstraintSolver();
    auto* world = new btDiscreteDynamicsWorld(dispatcher, broadphase, solver, configuration);
    Things things;
    world->addRigidBody(things.body(things.box(50, 50, 50), 0, {0, -50, 0}));
    btRigidBody* ball = things.body(things.sphere(1), 1, {2, 10, 0});
    world->addRigidBody(ball);
    for (int i = 0; i < 150; ++i) {
        world->stepSimulation(btScalar(1) / 60, 10);
    }
    say("height", ball->getWorldTransform().getOrigin().y());
    delete world;
    delete solver;
    delete broadphase;
    delete dispatcher;
    delete configuration;
}

// A cache that dies before the broadphase that uses it; Bullet never looks at it then.
COMPARED_PROGRAM(cacheGoesFirst) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    auto cache = std::make_unique<btHashedOverlappingPairCache>();
    btDbvtBroadphase broadphase(cache.get());
    Things things;
    {
        btSequentialImpulseConstraintSolver solver;
        btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
        auto* sphere = things.sphere(1);
        for (int i = 0; i < 10; ++i) {
            world.addRigidBody(things.body(sphere, 1, {btScalar(i), 0, 0}));
        }
        world.stepSimulation(btScalar(1) / 60, 0);
        say("pairs", cache->getNumOverlappingPairs() >= 9 ? 1 : 0);
    }
    cache.reset();
}

// Leaves the program in the middle, with everything alive.
COMPARED_PROGRAM(exitAnyhow) {
    static const Pile scene(30);
    say("steps", 30);
    std::exit(0);
}

// A child that steps a world of its own beside its parent's.
COMPARED_PROGRAM(forks) {
    Pile scene(30);
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        scene.step(30);
        _exit(7);
    }
    int status = 0;
    waitpid(child, &status, 0);
    say("child", WEXITSTATUS(status));
    scene.step(30);
}

// A tick that fails in one step, which the program gets over.
COMPARED_PROGRAM(throwsFromTick) {
    Pile scene;
    static int ticks = 0;
    scene.world.setInternalTickCallback([](btDynamicsWorld* /*world*/, btScalar /*step*/) {
        if (++ticks == 10) {
            throw std::runtime_error("a tick has failed");
        }
    });
    int failures = 0;
    for (int i = 0; i < 30; ++i) {
        try {
            scene.step(1);
        } catch (const std::runtime_error&) {
            ++failures;
        }
    }
    say("failures", failures);
}

}  // namespace
}  // namespace programs
