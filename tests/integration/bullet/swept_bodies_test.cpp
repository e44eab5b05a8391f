// SPDX-License-Identifier: Zlib

// SpatialHashConfig::sweep: fast bodies make pairs with what they pass, and with nothing else.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/shooting_range.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

void expectPairsOfWhatIsPassed(double offset, double speed = 400) {
    for (const Sweep sweep : {Sweep::box, Sweep::line, Sweep::automatic}) {
        ShootingRange range(sweep);
        range.fill(0x5eed0e01, 9, offset, speed);
        struct Check {
            ShootingRange& range;
            std::size_t most = 0;
        } check{range};
        // Before each step, with the same prediction.
        range.world().setInternalTickCallback(
            [](btDynamicsWorld* world, btScalar) {
                auto& own = *static_cast<Check*>(world->getWorldUserInfo());
                for (int i = 0; i < own.range.bodyCount(); ++i) {
                    btTransform predicted;
                    own.range.body(i).predictIntegratedTransform(kStep, predicted);
                    own.range.body(i).setInterpolationWorldTransform(predicted);
                }
                own.range.world().updateAabbs();
                own.range.hash().calculateOverlappingPairs(&own.range.dispatcher());
                EXPECT_EQ(own.range.pairs(), own.range.expectedPairs(1));
                own.most = std::max(own.most, own.range.pairs().size());
            },
            &check, true);
        for (int step = 0; step < 10; ++step) {
            range.step();
            EXPECT_EQ(range.hash().validate(), "");
        }
        EXPECT_GT(check.most, 20U);
        EXPECT_EQ(range.hash().sweeps()->size(), 40U);
    }
}

// Nearly a million metres in a step at most: boxes of more than that Bullet takes out of the simulation.
TEST(SweptBodies, MakePairsWithWhatTheyPassAndNothingElseHoweverFarOrFast) {
    expectPairsOfWhatIsPassed(0);
    expectPairsOfWhatIsPassed(16'384);
    expectPairsOfWhatIsPassed(-1'048'576);
    expectPairsOfWhatIsPassed(0, 1e5);
    expectPairsOfWhatIsPassed(0, 5.9e7);
}

TEST(SweptBodies, HaveFewerPairsThanBoxesAroundStartAndEnd) {
    std::vector<std::size_t> counts;
    for (const Sweep sweep : {Sweep::none, Sweep::automatic}) {
        ShootingRange range(sweep);
        range.fill(0x5eed0e02);
        range.step();
        counts.push_back(range.pairs().size());
    }
    EXPECT_LT(5 * counts[1], 2 * counts[0]);
    EXPECT_GT(counts[1], 0U);
}

// Each ball has a wall of its own, and meets it at another moment of its step. m_useContinuous is off:
// Bullet hands in where a body is, and no more.
TEST(SweptBodies, PassNoThinWallUnnoticedWhereverInTheirStepItStands) {
    constexpr int kPhases = 1000;
    for (const double thickness : {0.1, 0.01, 0.001}) {
        for (const Sweep sweep : {Sweep::none, Sweep::box, Sweep::line, Sweep::automatic}) {
            btBoxShape thinWall(btVector3(1, 1, btScalar(thickness / 2)));
            ShootingRange range(sweep);
            range.world().getDispatchInfo().m_useContinuous = false;
            std::set<Uids> expected;
            for (int i = 0; i < kPhases; ++i) {
                const auto x = btScalar(3 * i);
                const btRigidBody& wall = range.add(thinWall, 0, btVector3(x, 0, 0));
                // 4 m a step.
                const btRigidBody& ball =
                    range.add(range.ball, 1, btVector3(x, 0, btScalar(-4 * (i + 0.5) / kPhases)),
                              btVector3(0, 0, 240));
                expected.insert(uidsOf(*wall.getBroadphaseProxy(), *ball.getBroadphaseProxy()));
            }
            range.step();
            if (sweep == Sweep::none) {
                EXPECT_LT(range.pairs().size(), std::size_t{kPhases} / 10);
            } else {
                EXPECT_EQ(range.pairs(), expected) << thickness;
            }
        }
    }
}

// Bullet casts convex shapes by fat rays through the broadphase.
TEST(SweptBodies, AreMetByConvexSweepsAsUnderBulletsTree) {
    std::vector<std::pair<int, btScalar>> hits[2];
    for (const bool isOurs : {false, true}) {
        const auto range =
            isOurs ? std::make_unique<ShootingRange>(Sweep::automatic)
                   : std::make_unique<ShootingRange>(makeBroadphase<btDbvtBroadphase>());
        range->fill(0x5eed0e03);
        range->step();
        BulletRandom random(0x5eed0e03);
        for (int i = 0; i < 300; ++i) {
            const btVector3 from = random.vector(-20, 20);
            const btVector3 to = random.vector(-20, 20);
            btCollisionWorld::ClosestConvexResultCallback closest(from, to);
            const btSphereShape sphere(btScalar(0.3));
            range->world().convexSweepTest(&sphere, placeAt(from), placeAt(to), closest);
            if (closest.hasHit()) {
                hits[isOurs].emplace_back(closest.m_hitCollisionObject->getWorldArrayIndex(),
                                          closest.m_closestHitFraction);
            }
        }
    }
    EXPECT_GT(hits[0].size(), 100U);
    EXPECT_EQ(hits[1], hits[0]);
}

// So far apart that nothing touches two others: Bullet's solver heeds the order of contacts.
TEST(SweptBodies, MoveAsWithoutSweeps) {
    ShootingRange with(Sweep::line);
    ShootingRange without(Sweep::none);
    for (ShootingRange* range : {&with, &without}) {
        range->fill(0x5eed0e04, 15);
        range->letThemHit();
        range->step(2);
    }
    EXPECT_EQ(firstDifferentBody(with, without), -1);
}

TEST(SweptBodies, AreDynamicRigidBodiesThatMoveFarForTheirSize) {
    ShootingRange range(Sweep::automatic);
    btRigidBody& ball = range.add(range.ball, 1, btVector3(0, 0, 0));
    const auto motionBy = [](btCollisionObject& object, btScalar way, btScalar share = 1) {
        const btVector3& from = object.getWorldTransform().getOrigin();
        object.setInterpolationWorldTransform(placeAt(from + btVector3(way, 0, 0)));
        return detail::fastMotion(*object.getBroadphaseHandle(), share);
    };
    EXPECT_FALSE(motionBy(ball, 0));
    EXPECT_FALSE(motionBy(ball, btScalar(0.2)));  // its box, with margins, is 0.24 m long
    EXPECT_TRUE(motionBy(ball, btScalar(0.2), btScalar(0.5)));
    ASSERT_TRUE(motionBy(ball, btScalar(0.3)));
    EXPECT_FLOAT_EQ(float(motionBy(ball, btScalar(0.3))->way.displacement.x()), 0.3F);
    EXPECT_FALSE(motionBy(ball, std::numeric_limits<btScalar>::quiet_NaN()));
    EXPECT_FALSE(motionBy(range.add(range.wall, 0, btVector3(5, 0, 0)), 9));
    btCollisionObject sensor;
    sensor.setCollisionShape(&range.ball);
    range.world().addCollisionObject(&sensor);
    EXPECT_FALSE(motionBy(sensor, 9));
    range.world().removeCollisionObject(&sensor);
    EXPECT_FALSE(detail::fastMotion(btBroadphaseProxy(), 1));
}

}  // namespace
}  // namespace hashphase::test
