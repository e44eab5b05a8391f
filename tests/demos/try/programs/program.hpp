// SPDX-License-Identifier: Zlib
#pragma once

// Programs of users of Bullet, who know nothing of hashphase: this folder includes Bullet's headers and the
// standard library, and links Bullet alone. Each program prints its outcome, which a right broadphase cannot
// change, and ends with status 0.

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace programs {

struct Program {
    std::string name;
    int (*run)();
};

const std::vector<Program>& rigidBodyPrograms();
const std::vector<Program>& broadphasePrograms();
const std::vector<Program>& queryPrograms();
const std::vector<Program>& softBodyPrograms();
const std::vector<Program>& lifetimePrograms();

// Of these, what is said of them is tested, not their outcome: they print times, or go wrong, or on for ever.
const std::vector<Program>& measuredPrograms();
const std::vector<Program>& processPrograms();
const std::vector<Program>& misfitPrograms();

/// Runs the program of that name.
int run(const std::string& name);

/// Says `name = value`, with as many digits as the float of either precision is good for after some seconds
/// of physics.
void say(const char* name, double value);

/// What owns bodies and shapes, and outlives the world that they are in.
class Things {
public:
    template <class Shape, class... Arguments>
    Shape* shape(Arguments&&... arguments) {
        auto made = std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
        Shape* shape = made.get();
        shapes_.push_back(std::move(made));
        return shape;
    }

    /// A body of that mass at that place; 0 for one that is static.
    btRigidBody* body(btCollisionShape* shape, btScalar mass, const btVector3& place);

    std::vector<std::unique_ptr<btRigidBody>> bodies;

private:
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btMotionState>> states_;
};

/// A world as tutorials make it, of any broadphase; results are the same in every run.
template <class Broadphase = btDbvtBroadphase, class World = btDiscreteDynamicsWorld>
struct Scene {
    template <class... Arguments>
    explicit Scene(Arguments&&... arguments)
        : broadphase(std::forward<Arguments>(arguments)...),
          world(&dispatcher, &broadphase, &solver, &configuration) {
        world.setGravity({0, -10, 0});
        world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    }
    ~Scene() {
        for (int i = world.getNumConstraints(); i-- > 0;) {
            world.removeConstraint(world.getConstraint(i));
        }
        for (int i = world.getNumCollisionObjects(); i-- > 0;) {
            world.removeCollisionObject(world.getCollisionObjectArray()[i]);
        }
    }

    btRigidBody* add(btCollisionShape* shape, btScalar mass, const btVector3& place) {
        btRigidBody* body = things.body(shape, mass, place);
        world.addRigidBody(body);
        return body;
    }
    btRigidBody* addGround() {
        return add(things.template shape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0,
                   {0, 0, 0});
    }
    void step(int count) {
        for (int i = 0; i < count; ++i) {
            world.stepSimulation(btScalar(1) / 60, 0);
        }
    }

    Things things;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    Broadphase broadphase;
    World world;
};

/// Twenty boxes on a ground.
void addPile(Scene<>& scene);

/// How many of the bodies are nearer to their places than that.
int countNear(const Things& things, const btVector3& place, btScalar distance);

}  // namespace programs
