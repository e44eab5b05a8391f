// SPDX-License-Identifier: Zlib
#pragma once

// A world of walls, and of balls and rods that fly through them.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/detail/body_motion.hpp>
#include <tests/integration/bullet/dynamics.hpp>
#include <tests/support/random.hpp>

#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {

inline constexpr btScalar kStep = btScalar(1) / 60;

/// Walls that stand, and balls that fly through them without touching: no response.
struct ShootingRange : DynamicsWorld {
    explicit ShootingRange(Sweep sweep)
        : ShootingRange(
              std::make_unique<SpatialHashBroadphase>(SpatialHashConfig{.sweep = sweep})) {}
    explicit ShootingRange(std::unique_ptr<btBroadphaseInterface> over)
        : DynamicsWorld(std::move(over)) {
        world().setGravity(btVector3(0, 0, 0));
    }
    ~ShootingRange() {
        for (int i = 0; i < bodyCount(); ++i) {
            takeOut(i);
        }
    }

    btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& position,
                     const btVector3& velocity = btVector3(0, 0, 0)) {
        btRigidBody& flying = body(DynamicsWorld::add(&shape, mass, placeAt(position)));
        flying.setLinearVelocity(velocity);
        flying.setDamping(0, 0);
        flying.setActivationState(DISABLE_DEACTIVATION);
        flying.setCollisionFlags(flying.getCollisionFlags() |
                                 btCollisionObject::CF_NO_CONTACT_RESPONSE);
        return flying;
    }

    /// 200 walls here and there, 60 balls and rods of which two in three are fast; all so far from
    /// the origin, along each axis.
    void fill(std::uint64_t seed, double reach = 9, double offset = 0, double speed = 400) {
        Random random(seed);
        const auto somewhere = [&](double low, double high) {
            return Vector3<double>(random.pointIn(low, high));
        };
        const auto bullets = [](const Vector3<double>& v) { return toBullet(v.cast<btScalar>()); };
        for (int i = 0; i < 200; ++i) {
            add(wall, 0, bullets(somewhere(offset - reach, offset + reach)));
        }
        for (int i = 0; i < 60; ++i) {
            const Vector3<double> place = somewhere(offset - reach, offset + reach);
            const Vector3<double> way = somewhere(-1, 1).normalized() * (i % 3 == 0 ? 2 : speed);
            btCollisionShape* const shapes[] = {&ball, &rod};
            add(*shapes[i % 2], 1, bullets(place), bullets(way))
                .setAngularVelocity(btVector3(0, btScalar(i), 0));
        }
    }
    /// From now on they touch what they meet, and Bullet sweeps them.
    void letThemHit() {
        for (int i = 0; i < bodyCount(); ++i) {
            body(i).setCollisionFlags(body(i).getCollisionFlags() &
                                      ~btCollisionObject::CF_NO_CONTACT_RESPONSE);
            body(i).setCcdMotionThreshold(btScalar(0.05));
            body(i).setCcdSweptSphereRadius(btScalar(0.04));
        }
    }

    /// What a broadphase must know of the step that begins, by looking at every two bodies.
    [[nodiscard]] std::set<Uids> expectedPairs(btScalar share) const {
        std::vector<MovingBox<btScalar>> motions;
        for (int i = 0; i < bodyCount(); ++i) {
            const btBroadphaseProxy& proxy = *body(i).getBroadphaseProxy();
            const std::optional<detail::BodyMotion> motion = detail::fastMotion(proxy, share);
            motions.push_back(motion
                                  ? motion->way
                                  : MovingBox<btScalar>{toAabb(proxy.m_aabbMin, proxy.m_aabbMax)});
            const Vector3<btScalar> margin = Vector3<btScalar>::Constant(hash().margin(&proxy));
            Aabb<btScalar>& box = motions.back().box;
            box = {box.min() - margin, box.max() + margin};
        }
        std::set<Uids> expected;
        for (int i = 0; i < bodyCount(); ++i) {
            for (int k = i + 1; k < bodyCount(); ++k) {
                if ((!body(i).isStaticObject() || !body(k).isStaticObject()) &&
                    firstContact(motions[std::size_t(i)], motions[std::size_t(k)])) {
                    expected.insert(
                        uidsOf(*body(i).getBroadphaseProxy(), *body(k).getBroadphaseProxy()));
                }
            }
        }
        return expected;
    }
    [[nodiscard]] std::set<Uids> pairs() { return uidPairs(cache()); }

    btBoxShape wall{btVector3(1, 1, btScalar(0.01))};
    btSphereShape ball{btScalar(0.1)};
    btCapsuleShape rod{btScalar(0.05), 1};
};

}  // namespace hashphase::test
