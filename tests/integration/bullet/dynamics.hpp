// SPDX-License-Identifier: Zlib
#pragma once

// Bullet worlds that are built and disturbed by script, so that two of them, over different
// broadphases, can be compared bit by bit.

#include <demos/scenes/ordered_dispatcher.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <vector>

namespace hashphase::test {

/// A world with everything that it needs. Bodies are numbered; a body's number is its user index.
class DynamicsWorld {
public:
    /// The pair cache is what the broadphase was given; null when it has its own.
    explicit DynamicsWorld(std::unique_ptr<btBroadphaseInterface> broadphase,
                           std::unique_ptr<btOverlappingPairCache> cache = nullptr);
    DynamicsWorld(const DynamicsWorld&) = delete;
    DynamicsWorld& operator=(const DynamicsWorld&) = delete;
    ~DynamicsWorld();

    /// Keeps the shape for the bodies made of it.
    template <class Shape>
    Shape* keep(std::unique_ptr<Shape> shape) {
        Shape* const kept = shape.get();
        shapes_.push_back(std::move(shape));
        return kept;
    }

    /// Mass 0 makes a static body. Returns the body's number.
    int add(btCollisionShape* shape, btScalar mass, const btTransform& place);

    /// Takes the body out of the world and puts it back in, at rest and awake, at another place.
    void readd(int number, const btTransform& place);

    void takeOut(int number);

    /// Hangs a point of `b` onto a point of `a`, given in the frame of each.
    void link(int a, int b, const btVector3& pointInA, const btVector3& pointInB);

    /// One step of 1/60 s.
    void step() { world_.stepSimulation(btScalar(1) / 60, 0); }

    [[nodiscard]] btDiscreteDynamicsWorld& world() { return world_; }
    [[nodiscard]] btCollisionDispatcher& dispatcher() { return dispatcher_; }
    [[nodiscard]] btBroadphaseInterface& broadphase() { return *broadphase_; }
    [[nodiscard]] int bodyCount() const { return static_cast<int>(bodies_.size()); }
    [[nodiscard]] btRigidBody& body(int number) const {
        return *bodies_[static_cast<std::size_t>(number)];
    }
    [[nodiscard]] int sleepingCount() const;

private:
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> links_;
    btDefaultCollisionConfiguration configuration_;
    demos::OrderedDispatcher dispatcher_{&configuration_};
    std::unique_ptr<btOverlappingPairCache> cache_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, broadphase_.get(), &solver_, &configuration_};
};

/// Number of the first body whose transform, velocities or activation state differ in any bit; -1
/// when none does.
int firstDifferentBody(const DynamicsWorld& a, const DynamicsWorld& b);

struct DynamicsScene {
    const char* name;
    void (*build)(DynamicsWorld&);
    void (*disturb)(DynamicsWorld&, int step);  ///< called before each step
    bool sleeps;                                ///< whether bodies fall asleep within 900 steps
};

void PrintTo(const DynamicsScene& scene, std::ostream* out);

/// pile, stack, compounds, chains, pileWithChurn, compoundsWithChurn, chainsOnAPlane.
const std::vector<DynamicsScene>& dynamicsScenes();

}  // namespace hashphase::test
