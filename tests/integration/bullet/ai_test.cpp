// SPDX-License-Identifier: Zlib
//
// Agents in a live btDiscreteDynamicsWorld: they ask the broadphase's own grid, and see each move at
// once.

#include <tests/integration/bullet/dynamics.hpp>

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/group_filter.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

using Ids = std::vector<ProxyId>;

constexpr int kEnemies = 64;
constexpr int kWalls = 128;

/// An agent on the ground, a wall beside it, and enemies that fall on both sides of the wall.
class AgentsInAWorld : public testing::Test {
protected:
    AgentsInAWorld() {
        auto* const ground = scene.keep(std::make_unique<btBoxShape>(btVector3(100, 1, 100)));
        auto* const slab = scene.keep(std::make_unique<btBoxShape>(btVector3(1, 20, 20)));
        auto* const cube = scene.keep(std::make_unique<btBoxShape>(btVector3(1, 1, 1)));
        scene.add(ground, 0, placeAt(0, -1, 0));
        wall = scene.add(slab, 0, placeAt(10, 20, 0));
        agent = scene.add(cube, 0, placeAt(0, 2, 0));
        setGroup(wall, kWalls);
        for (int i = 0; i < 12; ++i) {
            const int side = i % 3 == 0 ? -1 : 1;
            enemies.push_back(scene.add(cube, 1, placeAt(20 * side, 10 + 3 * i, 4 * (i / 3))));
            setGroup(enemies.back(), kEnemies);
        }
    }

    static btTransform placeAt(int x, int y, int z) {
        return btTransform(btQuaternion::getIdentity(),
                           btVector3(btScalar(x), btScalar(y), btScalar(z)));
    }
    void setGroup(int body, int group) {
        scene.body(body).getBroadphaseProxy()->m_collisionFilterGroup |= group;
    }
    ProxyId idOf(int body) const {
        return SpatialHashBroadphase::idOf(scene.body(body).getBroadphaseProxy());
    }
    /// By the box that Bullet has set, which lags the body by a part of a step.
    Vector3<btScalar> positionOfBody(int body) const {
        btVector3 low;
        btVector3 high;
        broadphase->getAabb(scene.body(body).getBroadphaseProxy(), low, high);
        return toEigen((low + high) / 2);
    }
    /// Puts the body somewhere else; no step is taken.
    void teleport(int body, const btTransform& place) {
        scene.body(body).setWorldTransform(place);
        scene.body(body).setInterpolationWorldTransform(place);  // or the box spans both places
        scene.world().updateSingleAabb(&scene.body(body));
    }
    const Grid<btScalar>& grid() const { return broadphase->grid(); }
    Ids idsOf(const std::vector<int>& bodies) const {
        Ids ids;
        std::transform(bodies.begin(), bodies.end(), std::back_inserter(ids),
                       [this](int body) { return idOf(body); });
        std::sort(ids.begin(), ids.end());
        return ids;
    }

    SpatialHashBroadphase* broadphase = new SpatialHashBroadphase;  // the scene's
    DynamicsWorld scene{std::unique_ptr<btBroadphaseInterface>(broadphase)};
    int wall = 0;
    int agent = 0;
    std::vector<int> enemies;
    const GroupFilter isEnemy{*broadphase, {.mask = kEnemies}};
    const GroupFilter isWall{*broadphase, {.mask = kWalls}};
};

TEST_F(AgentsInAWorld, KnowTheirNeighboursWhileTheyFall) {
    Ids found;
    std::vector<KeyedProxy<btScalar>> nearest;
    const Vector3<btScalar> here = positionOfBody(agent);
    std::size_t foundCount = 0;
    for (int step = 0; step < 200; ++step) {
        scene.step();
        // Rounded as boxes are, to be compared with what is clearly near or far.
        std::vector<std::pair<btScalar, ProxyId>> byDistance;
        std::size_t clearlyNear = 0;
        std::size_t perhapsNear = 0;
        for (const int enemy : enemies) {
            const btScalar away = (positionOfBody(enemy) - here).norm();
            byDistance.emplace_back(away, idOf(enemy));
            const btVector3 place = scene.body(enemy).getWorldTransform().getOrigin();
            ASSERT_LT((positionOfBody(enemy) - toEigen(place)).norm(), btScalar(0.5));
            clearlyNear += away < btScalar(24.99) ? 1 : 0;
            perhapsNear += away < btScalar(25.01) ? 1 : 0;
        }
        findWithin(grid(), here, 25, found, isEnemy, idOf(agent));
        ASSERT_GE(found.size(), clearlyNear);
        ASSERT_LE(found.size(), perhapsNear);
        foundCount += found.size();
        findNearest(grid(), here, 3, 1000, nearest, isEnemy);
        ASSERT_EQ(nearest.size(), 3U);
        std::sort(byDistance.begin(), byDistance.end());
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_NEAR(std::sqrt(nearest[i].key), byDistance[i].first, btScalar(0.01));
        }
    }
    EXPECT_GT(foundCount, 500U);
}

TEST_F(AgentsInAWorld, SeeWhoIsOnTheirSideOfTheWall) {
    Viewer<btScalar> viewer;
    viewer.eye = positionOfBody(agent);
    viewer.self = idOf(agent);
    viewer.range = 200;
    Ids seen;
    std::vector<int> onThisSide;
    for (const int enemy : enemies) {
        if (positionOfBody(enemy).x() < 0) {
            onThisSide.push_back(enemy);
        }
    }
    visibleFrom(grid(), viewer, seen, isEnemy, isWall);
    EXPECT_EQ(seen, idsOf(onThisSide));
    EXPECT_FALSE(canSee(grid(), viewer, idOf(enemies[1]), isWall));

    // Moves are seen at once: of the wall, of an enemy, of its group.
    teleport(wall, placeAt(500, 20, 0));
    EXPECT_TRUE(canSee(grid(), viewer, idOf(enemies[1]), isWall));
    visibleFrom(grid(), viewer, seen, isEnemy, isWall);
    EXPECT_EQ(seen, idsOf(enemies));
    teleport(wall, placeAt(10, 20, 0));
    teleport(enemies[1], placeAt(-20, 2, -4));
    EXPECT_TRUE(canSee(grid(), viewer, idOf(enemies[1]), isWall));
    scene.body(enemies[1]).getBroadphaseProxy()->m_collisionFilterGroup = 1;
    visibleFrom(grid(), viewer, seen, isEnemy, isWall);
    EXPECT_EQ(seen, idsOf(onThisSide));

    // Behind the back.
    viewer.direction = {1, 0, 0};
    viewer.halfAngle = btScalar(1.2);
    visibleFrom(grid(), viewer, seen, isEnemy, isWall);
    EXPECT_TRUE(seen.empty());
}

TEST_F(AgentsInAWorld, AreToldOnceOfEachThatFallsIntoAZone) {
    // A slab of air that all fall through, the ground below it where they come to rest, and a zone
    // that nobody reaches.
    const auto slab = [](btScalar low, btScalar high) {
        return Zone<btScalar>{BoxRegion<btScalar>{
            {Vector3<btScalar>(-100, low, -100), Vector3<btScalar>(100, high, 100)}}};
    };
    Zones<btScalar> zones;
    const ZoneId air = zones.add(slab(5, 9));
    const ZoneId floor = zones.add(slab(0, 4));
    const ZoneId depth = zones.add(slab(-50, -10));
    std::map<std::pair<ZoneId, ProxyId>, int> entered;
    std::map<std::pair<ZoneId, ProxyId>, int> left;
    const auto isEnemyIn = [this](ZoneId, ProxyId proxy) { return isEnemy(proxy); };
    for (int step = 0; step < 400; ++step) {
        scene.step();
        const ZoneEvents events = zones.update(grid(), isEnemyIn);
        for (const auto [zone, proxy] : events.entered) {
            ++entered[{zone, proxy}];
        }
        for (const auto [zone, proxy] : events.left) {
            ++left[{zone, proxy}];
        }
        ASSERT_EQ(events.entered.size() + events.stayed.size(),
                  zones.occupants(air).size() + zones.occupants(floor).size());
    }
    for (const int enemy : enemies) {
        EXPECT_EQ((entered[{air, idOf(enemy)}]), 1);
        EXPECT_EQ((left[{air, idOf(enemy)}]), 1);
        EXPECT_EQ((entered[{floor, idOf(enemy)}]), 1);
    }
    EXPECT_EQ(entered.size(), 2 * enemies.size());
    EXPECT_TRUE(zones.occupants(depth).empty());
    EXPECT_TRUE(std::ranges::equal(zones.occupants(floor), idsOf(enemies)));

    // Who is taken out of the world leaves under the old id, and comes back as somebody else.
    const ProxyId old = idOf(enemies[0]);
    const btTransform place = scene.body(enemies[0]).getWorldTransform();
    scene.readd(enemies[0], place);
    setGroup(enemies[0], kEnemies);
    ASSERT_NE(idOf(enemies[0]), old);
    const ZoneEvents events = zones.update(grid(), isEnemyIn);
    ASSERT_EQ(events.left.size(), 1U);
    EXPECT_EQ(events.left[0], (ZoneEvent{floor, old}));
    ASSERT_EQ(events.entered.size(), 1U);
    EXPECT_EQ(events.entered[0], (ZoneEvent{floor, idOf(enemies[0])}));
}

TEST_F(AgentsInAWorld, CountWhoIsAroundOnARadar) {
    RadarWindow<btScalar> window;
    window.center = positionOfBody(agent);
    window.columns = 7;
    window.rows = 7;
    // Enemies are group 0, walls group 1, and all else is not shown.
    const auto groupOf = [this](ProxyId id) { return isEnemy(id) ? 0U : isWall(id) ? 1U : 2U; };
    Radar<btScalar> radar;
    const auto countAt = [&](std::size_t group, std::size_t row, std::size_t column) {
        return radar.scan(grid(), window, 2, groupOf)[(group * 7 + row) * 7 + column];
    };
    // At x = 20: z = 0, 4, 8 in the agent's row, 12 in the next one; two in each place.
    EXPECT_EQ(countAt(0, 3, 5), 6U);
    EXPECT_EQ(countAt(0, 4, 5), 2U);
    EXPECT_EQ(countAt(0, 3, 1), 3U);
    EXPECT_EQ(countAt(1, 3, 4), 1U);
    EXPECT_EQ(countAt(0, 0, 0), 0U);
    teleport(enemies[1], placeAt(-29, 50, -29));
    EXPECT_EQ(countAt(0, 3, 5), 5U);
    EXPECT_EQ(countAt(0, 0, 0), 1U) << "seen at once, whatever the height";
    scene.takeOut(enemies[1]);
    EXPECT_EQ(countAt(0, 0, 0), 0U);
    scene.world().addRigidBody(&scene.body(enemies[1]));
}

}  // namespace
}  // namespace hashphase::test
