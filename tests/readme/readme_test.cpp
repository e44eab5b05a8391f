// SPDX-License-Identifier: Zlib

// The pieces of C++ of README.md.

#include <tests/readme/surroundings.hpp>

namespace hashphase::test {
namespace {

TEST(Readme, BroadphaseIsSwapped) {
#include <readme_1.inl>
    btBroadphaseInterface& asBullet = broadphase;
    EXPECT_EQ(asBullet.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
}

TEST(Readme, OneGridAnswersAll) {
    constexpr int kEnemyGroup = 64;
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* proxy =
        broadphase.createProxy({-1, -1, -31}, {1, 1, -29}, 0, nullptr, kEnemyGroup, -1, nullptr);
    const Eigen::Matrix<btScalar, 4, 4> viewProjection = orthographic().cast<btScalar>();
    const Camera<btScalar> camera(viewProjection, DepthRange::zeroToOne, {0, 0, 800, 800});
    const double x = 400;
    const double y = 400;
    const Vector3<btScalar> eye(0, 0, -10);
    Culler<btScalar> culler;
    std::vector<ProxyId> found;
    Grid<btScalar> ground;
    Terrain<btScalar> terrain(ground);
    terrain.add(std::vector<Vector3<btScalar>>{{-50, -5, 50}, {50, -5, 50}, {0, -5, -50}});
#include <readme_2.inl>
    const ProxyId id = SpatialHashBroadphase::idOf(proxy);
    EXPECT_TRUE(culler.isVisible(id));
    EXPECT_EQ(picked.id, id);
    EXPECT_EQ(found, std::vector{id});
    ASSERT_TRUE(below);
    EXPECT_EQ(below->height, -5);
}

}  // namespace
}  // namespace hashphase::test
