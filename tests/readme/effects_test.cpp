// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/effects.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

using EffectsPage = AgentsBeforeACamera;

TEST(EffectsPageAlone, RunsJustWhatIsDeclared) {
    const Point player(0, 0, 0);
    const float timeStep = 1.0F / 60;
#include <effects_1.inl>
    EXPECT_EQ(late, 0U);
    EXPECT_EQ(cost[SceneCounter::bodiesMoved], 1U);
#include <effects_2.inl>
    EXPECT_NE(error, "");
}

TEST_F(EffectsPage, ObserversLookAtAnyGrid) {
    int drawn = 0;
    const auto draw = [&](std::uint32_t) { ++drawn; };
#include <effects_3.inl>
    EXPECT_EQ(drawn, 3);
}

TEST(EffectsPageAlone, TellsBulletWhatToCompute) {
    SceneEffects effects;
    effects.motion.emplace();
    effects.culling.emplace();
    FallingSphere sphere;
    const btScalar timeStep = sphere.timeStep;
    SpatialHashBroadphase broadphase;
    btDiscreteDynamicsWorld world(&sphere.dispatcher, &broadphase, &sphere.solver,
                                  &sphere.configuration);
    world.addRigidBody(&sphere.body);
    {
#include <effects_4.inl>
        EXPECT_EQ(observers.culler().count(), 1U);
        EXPECT_FALSE(configurator.effects().rotation);
    }
    world.removeRigidBody(&sphere.body);
}

}  // namespace
}  // namespace hashphase::test
