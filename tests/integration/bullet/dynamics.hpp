// SPDX-License-Identifier: Zlib
#pragma once

// Bullet worlds that are built and disturbed by script, so that two of them, over different
// broadphases, can be compared bit by bit.

#include <demos/scenes/ordered_dispatcher.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/integration/bullet/callbacks.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace hashphase::test {

[[nodiscard]] inline btTransform placeAt(const btVector3& place,
                                         const btQuaternion& turn = btQuaternion(0, 0, 0, 1)) {
    return btTransform(turn, place);
}

/// Moves it there by hand, at rest.
void putAt(btCollisionObject& object, const btVector3& place);

/// A world with everything that it needs. Bodies are numbered; a body's number is its user index.
class DynamicsWorld {
public:
    /// Over our broadphase, which makes its cache.
    DynamicsWorld() : DynamicsWorld(std::make_unique<SpatialHashBroadphase>()) {}
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
    btRigidBody& addBox(const btVector3& halfExtents, btScalar mass, const btVector3& place);

    /// A sensor; ghosts are told of pairs from then on.
    btPairCachingGhostObject& addGhost(btCollisionShape* shape, const btVector3& place);
    void tellGhosts() { cache().setInternalGhostPairCallback(&ghostCallback_); }

    /// Takes the body out of the world and puts it back in, at rest and awake, at another place.
    void readd(int number, const btTransform& place);

    void takeOut(int number);

    /// Steps of 1/60 s.
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            world_.stepSimulation(btScalar(1) / 60, 0);
        }
    }

    /// The pairs are precisely those of objects whose boxes overlap and which the cache lets pair.
    void expectExactPairs();

    [[nodiscard]] btDiscreteDynamicsWorld& world() { return world_; }
    [[nodiscard]] btCollisionDispatcher& dispatcher() { return dispatcher_; }
    [[nodiscard]] btSequentialImpulseConstraintSolver& solver() { return solver_; }
    [[nodiscard]] btBroadphaseInterface& broadphase() { return *broadphase_; }
    [[nodiscard]] SpatialHashBroadphase& hash() {
        return dynamic_cast<SpatialHashBroadphase&>(*broadphase_);
    }
    [[nodiscard]] const SpatialHashBroadphase& hash() const {
        return dynamic_cast<const SpatialHashBroadphase&>(*broadphase_);
    }
    [[nodiscard]] const Grid<btScalar>& grid() const { return hash().grid(); }
    [[nodiscard]] ProxyId idOf(int number) const {
        return SpatialHashBroadphase::idOf(body(number).getBroadphaseProxy());
    }
    [[nodiscard]] btOverlappingPairCache& cache() {
        return *broadphase_->getOverlappingPairCache();
    }
    [[nodiscard]] int pairCount() { return cache().getNumOverlappingPairs(); }
    [[nodiscard]] int bodyCount() const { return static_cast<int>(bodies_.size()); }
    [[nodiscard]] btRigidBody& body(int number) const {
        return *bodies_[static_cast<std::size_t>(number)];
    }
    [[nodiscard]] int sleepingCount() const;

private:
    btGhostPairCallback ghostCallback_;  // outlives the world, which tells it of its end
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btPairCachingGhostObject>> ghosts_;
    btDefaultCollisionConfiguration configuration_;
    demos::OrderedDispatcher dispatcher_{&configuration_};
    std::unique_ptr<btOverlappingPairCache> cache_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, broadphase_.get(), &solver_, &configuration_};
};

/// A world over a broadphase that `make` makes over a pair cache in canonical order of the bodies'
/// numbers: its trajectories depend on its pairs alone.
std::unique_ptr<DynamicsWorld> canonicalWorld(
    std::unique_ptr<btBroadphaseInterface> (*make)(PairCache*));
[[nodiscard]] std::unique_ptr<btBroadphaseInterface> hashOverPairCache(PairCache* cache);

/// Number of the first body whose transform, velocities or activation state differ in any bit; -1
/// when none does.
int firstDifferentBody(const DynamicsWorld& a, const DynamicsWorld& b);

/// Bodies of four shapes that fall on a plane.
void buildPile(DynamicsWorld& world);
/// Takes bodies out of the pile now and then, and drops them on top of it; called before each step.
void churn(DynamicsWorld& world, int step);

}  // namespace hashphase::test
