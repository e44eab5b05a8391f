// SPDX-License-Identifier: Zlib
//
// Agents in a live btDiscreteDynamicsWorld: they ask the broadphase's own grid, and see each move at
// once.

#include <tests/integration/bullet/dynamics.hpp>

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
class AgentsInAWorld : public testing::Test, protected DynamicsWorld {
protected:
    AgentsInAWorld() {
        auto* const cube = keep(std::make_unique<btBoxShape>(btVector3(1, 1, 1)));
        addBox({100, 1, 100}, 0, {0, -1, 0});
        addBox({1, 20, 20}, 0, {10, 20, 0});
        setGroup(wall, kWalls);
        add(cube, 0, placeAt({0, 2, 0}));
        for (int i = 0; i < 12; ++i) {
            const btScalar side = i % 3 == 0 ? -20 : 20;
            const btVector3 place(side, btScalar(10 + 3 * i), btScalar(4 * (i / 3)));
            enemies.push_back(add(cube, 1, placeAt(place)));
            setGroup(enemies.back(), kEnemies);
        }
    }

    void setGroup(int number, int group) {
        body(number).getBroadphaseProxy()->m_collisionFilterGroup |= group;
    }
    /// By the box that Bullet has set, which lags the body by a part of a step.
    Vector3<btScalar> positionOfBody(int number) const {
        return positionOf(grid().box(idOf(number)));
    }
    /// Puts the body somewhere else; no step is taken.
    void teleport(int number, const btVector3& place) {
        putAt(body(number), place);
        world().updateSingleAabb(&body(number));
    }
    Ids idsOf(const std::vector<int>& numbers) const {
        Ids ids;
        std::transform(numbers.begin(), numbers.end(), std::back_inserter(ids),
                       [this](int number) { return idOf(number); });
        std::sort(ids.begin(), ids.end());
        return ids;
    }

    static constexpr int wall = 1;
    static constexpr int agent = 2;
    std::vector<int> enemies;
    const GroupFilter isEnemy{hash(), {.mask = kEnemies}};
    const GroupFilter isWall{hash(), {.mask = kWalls}};
};

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
    teleport(wall, {500, 20, 0});
    EXPECT_TRUE(canSee(grid(), viewer, idOf(enemies[1]), isWall));
    visibleFrom(grid(), viewer, seen, isEnemy, isWall);
    EXPECT_EQ(seen, idsOf(enemies));
    teleport(wall, {10, 20, 0});
    teleport(enemies[1], {-20, 2, -4});
    EXPECT_TRUE(canSee(grid(), viewer, idOf(enemies[1]), isWall));
    body(enemies[1]).getBroadphaseProxy()->m_collisionFilterGroup = 1;
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
    for (int frame = 0; frame < 400; ++frame) {
        step();
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
    const btTransform place = body(enemies[0]).getWorldTransform();
    readd(enemies[0], place);
    setGroup(enemies[0], kEnemies);
    ASSERT_NE(idOf(enemies[0]), old);
    const ZoneEvents events = zones.update(grid(), isEnemyIn);
    ASSERT_EQ(events.left.size(), 1U);
    EXPECT_EQ(events.left[0], (ZoneEvent{floor, old}));
    ASSERT_EQ(events.entered.size(), 1U);
    EXPECT_EQ(events.entered[0], (ZoneEvent{floor, idOf(enemies[0])}));
}

}  // namespace
}  // namespace hashphase::test
