// SPDX-License-Identifier: Zlib

// The pieces of C++ in the README, in order, each in the surroundings that it takes for granted.

#include <broadphase/collectors.hpp>
#include <broadphase/crowd.hpp>
#include <broadphase/frustum.hpp>
#include <broadphase/nearest.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/sweeps.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/bullet_frame.hpp>
#include <integration/effects/observers.hpp>
#include <integration/effects/simulation.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <integration/terrain/terrain.hpp>

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <span>
#include <vector>

namespace hashphase {
namespace {

using Point = Vector3<float>;

Aabb<float> cubeAt(float x, float y, float z) {
    const Point center(x, y, z);
    const Point half(1, 1, 1);
    return {center - half, center + half};
}

// An orthographic camera at the origin that looks along -z and sees 40 x 40 m, from 0 to 100 m.
Eigen::Matrix4f orthographic() {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix(0, 0) = matrix(1, 1) = 1.0F / 20;
    matrix(2, 2) = -1.0F / 100;
    return matrix;
}

/// An agent that looks along -z, an enemy 20 m ahead, and a wall behind that.
class Readme : public testing::Test {
protected:
    Grid<float> grid;
    ProxyId self = grid.add(cubeAt(0, 0, -10));
    ProxyId enemy = grid.add(cubeAt(0, 0, -30));
    ProxyId wall = grid.add(cubeAt(0, 0, -50), Mobility::resting);
    Eigen::Matrix4f viewProjection = orthographic();
};

TEST_F(Readme, BroadphaseIsSwappedInOneLine) {
#include <readme_1.inl>
    btBroadphaseInterface& asBullet = broadphase;
    EXPECT_EQ(asBullet.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
}

TEST(ReadmeWithoutBullet, PairsAreBornAndTheRayHitsTheNearer) {
#include <readme_2.inl>
    EXPECT_EQ(born.size(), 1U);
    EXPECT_TRUE(died.empty());
    EXPECT_EQ(closest.found(), ball);
    EXPECT_GT(cost.boxesTested, 0U);
}

TEST_F(Readme, NeighboursAreListed) {
    int couples = 0;
    {
#include <readme_3.inl>
        couples = static_cast<int>(neighbours.find(grid, 20).size());
    }
    EXPECT_EQ(couples, 2);
}

TEST(ReadmeFastObjects, BulletMeetsTheWallOnItsWay) {
    const Point velocity(0, 0, -4800);
    const float timeStep = 1.0F / 60;
    const auto filter = [](ProxyId, ProxyId) { return true; };
    const Aabb<float> box = cubeAt(0, 0, -10);
    const Aabb<float> target = cubeAt(0, 0, -50);
    const Point displacement(0, 0, -80);
#include <readme_4.inl>
    EXPECT_EQ(pairs.count(), 1U);
    ASSERT_TRUE(when.has_value());
    EXPECT_NEAR(*when, 38.0 / 80, 1e-6);  // 4800 / 60 m are rounded
    EXPECT_EQ(hit.found(), bullet);       // from where it stands, itself
}

TEST(ReadmeOneGrid, FilterKnowsBulletsGroups) {
    constexpr int kEnemyGroup = 64;
    SpatialHashBroadphase broadphase;
    btBroadphaseProxy* proxy =
        broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, kEnemyGroup, -1, nullptr);
#include <readme_5.inl>
    grid.forEach([&](ProxyId id, const Aabb<btScalar>& /*box*/) { EXPECT_TRUE(enemies(id)); });
    EXPECT_EQ(grid.size(), 1U);
    broadphase.destroyProxy(proxy, nullptr);
}

TEST_F(Readme, VisibleObjectsAreDrawn) {
    const std::vector<int> objects{10, 20, 30};
    int sum = 0;
    const auto draw = [&](int object) { sum += object; };
#include <readme_6.inl>
    EXPECT_EQ(sum, 60);
}

TEST_F(Readme, PointerPicksTheNearestEnemy) {
    const float width = 800;
    const float height = 800;
    const float x = 400;
    const float y = 400;
    const float x0 = 300;
    const float y0 = 300;
    const float x1 = 500;
    const float y1 = 500;
    const auto enemies = [&](ProxyId id) { return id == enemy; };
    std::vector<ProxyId> selected;
#include <readme_7.inl>
    EXPECT_EQ(picked.id, enemy);
    EXPECT_EQ(selected.size(), 3U);
}

TEST_F(Readme, AgentsKnowTheirSurroundings) {
    const Point eye(0, 0, -10);
    const Point ahead(0, 0, -1);
    const auto enemies = [&](ProxyId id) { return id == enemy; };
    const auto walls = [&](ProxyId id) { return id == wall; };
    const auto groupOf = [&](ProxyId id) { return enemies(id) ? 1U : 0U; };
    std::vector<ProxyId> near;
    std::vector<ProxyId> seen;
    std::vector<KeyedProxy<float>> nearest;
    const ProxyId swimmer = grid.add(cubeAt(20, 0, 0));
#include <readme_8.inl>
    EXPECT_EQ(near, std::vector<ProxyId>{enemy});
    EXPECT_EQ(nearest.size(), 1U);
    EXPECT_EQ(seen, std::vector<ProxyId>{enemy});
    ASSERT_EQ(zones.update(grid).stayed.size(), 1U);
    EXPECT_EQ(zones.update(grid).stayed[0].proxy, swimmer);
    EXPECT_EQ(crowd.size(), 4U);
}

TEST(ReadmeTerrain, GroundLiesBelow) {
    const std::vector<Point> vertices{{-50, 0, 50}, {50, 0, 50}, {0, 10, -50}};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    const Point point(0, 50, 0);
    const std::vector<Point> centers{point};
    const std::vector<float> radii{1};
    std::vector<Terrain<float>::Found> found(1);
#include <readme_9.inl>
    ASSERT_TRUE(terrain.surfaceBelow(point));
    EXPECT_FLOAT_EQ(terrain.surfaceBelow(point)->height, 5);
    ASSERT_TRUE(found[0]);
    EXPECT_GT(found[0]->height, 6);
}

TEST(ReadmeEffects, RunJustWhatIsDeclared) {
    const Point player(0, 0, 0);
    const float timeStep = 1.0F / 60;
#include <readme_10.inl>
    EXPECT_EQ(late, 0U);
    EXPECT_EQ(cost[SceneCounter::bodiesMoved], 1U);
}

TEST(ReadmeEffects, TellBulletWhatToCompute) {
    const btScalar timeStep = btScalar(1) / 60;
    SceneEffects effects;
    effects.motion.emplace();
    effects.culling.emplace();
    SpatialHashBroadphase broadphase;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    btSphereShape shape(1);
    btRigidBody body(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape));
    world.addRigidBody(&body);
    {
#include <readme_11.inl>
        EXPECT_EQ(observers.culler().count(), 1U);
        EXPECT_FALSE(configurator.effects().rotation);
    }
    world.removeRigidBody(&body);
}

}  // namespace
}  // namespace hashphase
