// SPDX-License-Identifier: Zlib

// The pieces of C++ of integration/guide/culling.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

using CullingPage = AgentsBeforeACamera;

TEST_F(CullingPage, VisibleObjectsAreDrawnAndFiltered) {
    const std::vector<int> objects{10, 20, 30};
    int sum = 0;
    const auto draw = [&](int object) { sum += object; };
    const auto isDrawn = isEnemy();
#include <culling_1.inl>
    EXPECT_EQ(sum, 60);
#include <culling_3.inl>
    EXPECT_EQ(culler.count(), 1U);
}

TEST_F(CullingPage, VisibleObjectsOfABulletWorldAreDrawn) {
    FallingSphere sphere;
    SpatialHashBroadphase broadphase;
    btCollisionWorld world(&sphere.dispatcher, &broadphase, &sphere.configuration);
    world.addCollisionObject(&sphere.body);
    std::vector<const btCollisionObject*> drawn;
    const auto drawObject = [&](const btCollisionObject* object) { drawn.push_back(object); };
#include <culling_2.inl>
    EXPECT_EQ(drawn, std::vector<const btCollisionObject*>{&sphere.body});
    world.removeCollisionObject(&sphere.body);
}

TEST_F(CullingPage, SetIsKeptWhileNothingCanHaveComeIn) {
    const float fastest = 1;
    const float timeStep = 1.0F / 60;
    const Eigen::Matrix4f nextViewProjection = viewProjection;
#include <culling_4.inl>
    EXPECT_EQ(culler.findCount(), 1U);
    EXPECT_EQ(culler.count(), 3U);
}

TEST_F(CullingPage, FootprintIsOnTheGround) {
    Culler<float> culler;
#include <culling_5.inl>
    EXPECT_EQ(footprint.corners().size(), 4U);
    EXPECT_EQ(culler.count(), 3U);
}

}  // namespace
}  // namespace hashphase::test
