// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/flying_bodies.hpp>

#include <demos/accuracy/sweeps/tunnelling.hpp>
#include <demos/scenes/random.hpp>

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>

namespace hashphase::demos {
namespace {

constexpr int kBodies = 32;
constexpr btScalar kFrame = btScalar(1) / 60;  // [s]
constexpr auto kRadius = static_cast<btScalar>(kBulletRadius);

/// Walls beside each other, and a sphere before each. Nothing pulls at them.
class FlyingBodies {
public:
    FlyingBodies(double thickness, double step, bool isContinuous, Random& random)
        : thickness_(static_cast<btScalar>(thickness)),
          wall_(btVector3(thickness_ / 2, 1, 1)),
          sphere_(kRadius) {
        world_.setGravity(btVector3(0, 0, 0));
        for (int lane = 0; lane < kBodies; ++lane) {
            const btScalar across = btScalar(4) * static_cast<btScalar>(lane);
            const auto distance = static_cast<btScalar>(step) * (btScalar(1) - random.unit());
            add(wall_, 0, btVector3(thickness_ / 2, 0, across));
            btRigidBody& sphere = add(sphere_, 1, btVector3(-distance - kRadius, 0, across));
            sphere.setLinearVelocity(btVector3(static_cast<btScalar>(step) / kFrame, 0, 0));
            if (isContinuous) {
                sphere.setCcdMotionThreshold(kRadius);
                sphere.setCcdSweptSphereRadius(kRadius);
            }
            spheres_.push_back(&sphere);
        }
    }
    FlyingBodies(const FlyingBodies&) = delete;
    FlyingBodies& operator=(const FlyingBodies&) = delete;
    ~FlyingBodies() {
        for (const auto& body : bodies_) {
            world_.removeRigidBody(body.get());
        }
    }

    /// How many are behind their walls after so many frames.
    [[nodiscard]] std::uint64_t tunnelledAfter(int frames) {
        for (int frame = 0; frame < frames; ++frame) {
            world_.stepSimulation(kFrame, 0);
        }
        std::uint64_t count = 0;
        for (const btRigidBody* sphere : spheres_) {
            count += sphere->getWorldTransform().getOrigin().x() > thickness_ ? 1 : 0;
        }
        return count;
    }

private:
    btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& place) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shape.calculateLocalInertia(mass, inertia);
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform.setOrigin(place);
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        world_.addRigidBody(bodies_.back().get());
        return *bodies_.back();
    }

    btScalar thickness_;
    btBoxShape wall_;
    btSphereShape sphere_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<btRigidBody*> spheres_;
};

}  // namespace

std::string nameOf(const FlyingBodiesPoint& point) {
    return point.isContinuous ? "Bullet's bodies, CCD" : "Bullet's bodies, no CCD";
}

std::vector<FlyingBodiesPoint> measureFlyingBodies(std::span<const double> thicknesses,
                                                   std::span<const double> ratios, int rounds,
                                                   std::uint64_t seed) {
    Random random(seed);
    std::vector<FlyingBodiesPoint> points;
    for (const bool isContinuous : {false, true}) {
        for (const double ratio : ratios) {
            FlyingBodiesPoint point{ratio, isContinuous};
            for (const double thickness : thicknesses) {
                // Until they have met the wall, and could be through.
                const int frames = 3 + static_cast<int>(std::ceil(1 / ratio));
                const double step = ratio * (thickness + 2 * kBulletRadius);
                for (int round = 0; round < rounds; ++round) {
                    FlyingBodies bodies(thickness, step, isContinuous, random);
                    point.tunnelled += bodies.tunnelledAfter(frames);
                    point.bodies += kBodies;
                }
            }
            points.push_back(point);
        }
    }
    return points;
}

}  // namespace hashphase::demos
