// SPDX-License-Identifier: Zlib
#pragma once

// A world of walls, and of balls and rods that fly through them.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/detail/body_motion.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/random.hpp>

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {

inline constexpr btScalar kStep = btScalar(1) / 60;

inline SpatialHashConfig withSweep(Sweep sweep) {
    SpatialHashConfig config;
    config.sweep = sweep;
    return config;
}

/// Walls that stand, and balls that fly through them without touching: no response.
struct ShootingRange {
    using RawPair = std::pair<const btBroadphaseProxy*, const btBroadphaseProxy*>;

    explicit ShootingRange(std::unique_ptr<btBroadphaseInterface> ofWhat)
        : broadphase(std::move(ofWhat)),
          world(&dispatcher, broadphase.get(), &solver, &configuration) {
        world.setGravity(btVector3(0, 0, 0));
    }
    ~ShootingRange() {
        for (const auto& body : bodies) {
            world.removeRigidBody(body.get());
        }
    }

    btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& position,
                     const btVector3& velocity = btVector3(0, 0, 0)) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shape.calculateLocalInertia(mass, inertia);
        }
        auto body = std::make_unique<btRigidBody>(mass, nullptr, &shape, inertia);
        body->setWorldTransform(btTransform(btMatrix3x3::getIdentity(), position));
        body->setInterpolationWorldTransform(body->getWorldTransform());
        body->setLinearVelocity(velocity);
        body->setDamping(0, 0);
        body->setActivationState(DISABLE_DEACTIVATION);
        body->setCollisionFlags(body->getCollisionFlags() |
                                btCollisionObject::CF_NO_CONTACT_RESPONSE);
        world.addRigidBody(body.get());
        bodies.push_back(std::move(body));
        return *bodies.back();
    }

    /// 200 walls here and there, 60 balls and rods of which two in three are fast; all so far from
    /// the origin, along each axis.
    void fill(Random& random, double reach = 9, double offset = 0, double speed = 400) {
        for (int i = 0; i < 200; ++i) {
            const Vector3<double> place = random.pointIn(offset - reach, offset + reach);
            add(wall, 0, btVector3(btScalar(place.x()), btScalar(place.y()), btScalar(place.z())));
        }
        for (int i = 0; i < 60; ++i) {
            const Vector3<double> place = random.pointIn(offset - reach, offset + reach);
            const Vector3<double> way =
                random.pointIn(-1, 1).normalized() * (i % 3 == 0 ? 2 : speed);
            btRigidBody& body =
                add(i % 2 == 0 ? static_cast<btCollisionShape&>(ball)
                               : static_cast<btCollisionShape&>(rod),
                    1, btVector3(btScalar(place.x()), btScalar(place.y()), btScalar(place.z())),
                    btVector3(btScalar(way.x()), btScalar(way.y()), btScalar(way.z())));
            body.setAngularVelocity(btVector3(0, btScalar(i), 0));
        }
    }

    /// What a broadphase must know of the step that begins, by looking at every two bodies.
    [[nodiscard]] std::set<RawPair> expectedPairs(btScalar share) const {
        std::vector<MovingBox<btScalar>> motions;
        for (const auto& body : bodies) {
            const btBroadphaseProxy& proxy = *body->getBroadphaseProxy();
            const std::optional<detail::BodyMotion> motion = detail::fastMotion(proxy, share);
            motions.push_back(motion
                                  ? motion->way
                                  : MovingBox<btScalar>{toAabb(proxy.m_aabbMin, proxy.m_aabbMax)});
        }
        std::set<RawPair> pairs;
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            for (std::size_t j = i + 1; j < bodies.size(); ++j) {
                const bool doStand = bodies[i]->isStaticObject() && bodies[j]->isStaticObject();
                if (!doStand && firstContact(motions[i], motions[j])) {
                    pairs.insert(std::minmax<const btBroadphaseProxy*>(
                        bodies[i]->getBroadphaseProxy(), bodies[j]->getBroadphaseProxy()));
                }
            }
        }
        return pairs;
    }

    [[nodiscard]] std::set<RawPair> pairs() const {
        const btBroadphasePairArray& listed =
            broadphase->getOverlappingPairCache()->getOverlappingPairArray();
        std::set<RawPair> pairs;
        for (int i = 0; i < listed.size(); ++i) {
            pairs.insert(
                std::minmax<const btBroadphaseProxy*>(listed[i].m_pProxy0, listed[i].m_pProxy1));
        }
        return pairs;
    }

    btBoxShape wall{btVector3(1, 1, btScalar(0.01))};
    btSphereShape ball{btScalar(0.1)};
    btCapsuleShape rod{btScalar(0.05), 1};
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::unique_ptr<btBroadphaseInterface> broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
};

inline std::unique_ptr<SpatialHashBroadphase> swept(Sweep sweep) {
    return std::make_unique<SpatialHashBroadphase>(withSweep(sweep));
}

}  // namespace hashphase::test
