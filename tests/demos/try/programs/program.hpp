// SPDX-License-Identifier: Zlib
#pragma once

// Programs of users of Bullet, who know nothing of hashphase: this folder includes Bullet's headers and the
// standard library, and links Bullet alone.

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <utility>
#include <vector>

namespace programs {

struct Program {
    const char* name;
    void (*run)();
    bool isCompared;
};

/// All programs of all files.
std::vector<Program>& allPrograms();

struct Registered {
    explicit Registered(const Program& program) { allPrograms().push_back(program); }
};

#define REGISTERED_PROGRAM(function, isCompared)                                                   \
    void function();                                                                               \
    const Registered function##IsRegistered(Program{#function, &function, isCompared});            \
    void function()

/// COMPARED_PROGRAM(name) { ... } prints its outcome, which a right broadphase cannot change, and ends with
/// status 0. Of a PROGRAM, what is said of it is tested, not its outcome: it prints times, or goes wrong, or
/// on for ever.
#define COMPARED_PROGRAM(function) REGISTERED_PROGRAM(function, true)
#define PROGRAM(function) REGISTERED_PROGRAM(function, false)

/// What the program ends with.
extern int exitStatus;

/// Says `name = value`, with as many digits as the float of either precision is good for after some seconds
/// of physics.
void say(const char* name, double value);

inline btTransform at(const btVector3& place) {
    return btTransform(btQuaternion::getIdentity(), place);
}

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
    btBoxShape* box(btScalar x, btScalar y, btScalar z) {
        return shape<btBoxShape>(btVector3(x, y, z));
    }
    btBoxShape* unitBox() { return box(btScalar(0.5), btScalar(0.5), btScalar(0.5)); }
    btSphereShape* sphere(btScalar radius) { return shape<btSphereShape>(radius); }

    /// A body of that mass at that place; 0 for one that is static.
    btRigidBody* body(btCollisionShape* shape, btScalar mass, const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shape->calculateLocalInertia(mass, inertia);
        }
        states_.push_back(std::make_unique<btDefaultMotionState>(at(place)));
        bodies.push_back(std::make_unique<btRigidBody>(mass, states_.back().get(), shape, inertia));
        return bodies.back().get();
    }

    template <class Is>
    int count(const Is& is) const {
        int number = 0;
        for (const auto& body : bodies) {
            number += is(*body) ? 1 : 0;
        }
        return number;
    }
    /// How many of the bodies are nearer to that place.
    int countNear(const btVector3& place, btScalar distance) const {
        return count([&](const btRigidBody& body) {
            return body.getWorldTransform().getOrigin().distance(place) < distance;
        });
    }

    std::vector<std::unique_ptr<btRigidBody>> bodies;

private:
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btMotionState>> states_;
};

/// A world as tutorials make it, of any broadphase; results are the same in every run.
template <class Broadphase = btDbvtBroadphase, class World = btDiscreteDynamicsWorld,
          class Configuration = btDefaultCollisionConfiguration,
          class Solver = btSequentialImpulseConstraintSolver>
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
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

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
    btOverlappingPairCache& cache() { return *broadphase.getOverlappingPairCache(); }

    Things things;
    Configuration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    Solver solver;
    Broadphase broadphase;
    World world;
};

/// Twenty boxes on a ground.
void addPile(Scene<>& scene, int height = 1);

/// The same, after so many steps.
struct Pile : Scene<> {
    explicit Pile(int steps = 0, btOverlappingPairCache* cache = nullptr, int height = 1)
        : Scene(cache) {
        addPile(*this, height);
        step(steps);
    }
};

/// Casts a ray, which stops at the first object.
bool isHit(const btCollisionWorld& world, const btVector3& from, const btVector3& to);

/// Casts a ray through all objects.
int countHits(const btCollisionWorld& world, const btVector3& from, const btVector3& to);

}  // namespace programs
