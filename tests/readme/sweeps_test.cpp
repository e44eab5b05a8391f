// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/sweeps.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

TEST(SweepsPage, BulletMeetsTheWallOnItsWay) {
    const Point velocity(0, 0, -4800);
    const float timeStep = 1.0F / 60;
    const auto filter = [](ProxyId, ProxyId) { return true; };
    const Aabb<float> box = cubeAt(0, 0, -10);
    const Aabb<float> target = cubeAt(0, 0, -50);
    const Point displacement(0, 0, -80);
#include <sweeps_2.inl>
    EXPECT_EQ(pairs.count(), 1U);
    ASSERT_TRUE(when.has_value());
    EXPECT_NEAR(*when, 38.0 / 80, 1e-6);  // 4800 / 60 m are rounded
#include <sweeps_3.inl>
    EXPECT_EQ(hit.found(), bullet);  // from where it stands, itself
}

TEST(SweepsPage, FastBodyMeetsWhatItPassesUnderBullet) {
#include <sweeps_1.inl>
    FallingSphere sphere;
    btDiscreteDynamicsWorld world(&sphere.dispatcher, &broadphase, &sphere.solver,
                                  &sphere.configuration);
    world.addRigidBody(&sphere.body);
    sphere.body.setLinearVelocity({0, 0, -4800});
    broadphase.createProxy({-1, -1, -41}, {1, 1, -40}, 0, nullptr, 1, 0, nullptr);
    world.stepSimulation(sphere.timeStep, 0);
    EXPECT_EQ(broadphase.sweeps()->size(), 1U);
    world.removeRigidBody(&sphere.body);
}

}  // namespace
}  // namespace hashphase::test
