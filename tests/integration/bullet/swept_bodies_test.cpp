// SPDX-License-Identifier: Zlib

// SpatialHashConfig::sweep: fast bodies make pairs with what they pass, and with nothing else.

#include <tests/integration/bullet/shooting_range.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

void expectPairsOfWhatIsPassed(double offset, double speed = 400) {
    for (const Sweep sweep : {Sweep::box, Sweep::line, Sweep::automatic}) {
        Random random(0x5eed0e01);
        ShootingRange range(swept(sweep));
        range.fill(random, 9, offset, speed);
        const auto& broadphase = static_cast<const SpatialHashBroadphase&>(*range.broadphase);
        std::size_t most = 0;
        struct Check {
            ShootingRange& range;
            std::size_t& most;
        } check{range, most};
        // Before each step, with the same prediction.
        range.world.setInternalTickCallback(
            [](btDynamicsWorld* world, btScalar) {
                auto& own = *static_cast<Check*>(world->getWorldUserInfo());
                for (const auto& body : own.range.bodies) {
                    btTransform predicted;
                    body->predictIntegratedTransform(kStep, predicted);
                    body->setInterpolationWorldTransform(predicted);
                }
                own.range.world.updateAabbs();
                own.range.broadphase->calculateOverlappingPairs(&own.range.dispatcher);
                EXPECT_EQ(own.range.pairs(), own.range.expectedPairs(1));
                own.most = std::max(own.most, own.range.pairs().size());
            },
            &check, true);
        for (int step = 0; step < 10; ++step) {
            range.world.stepSimulation(kStep, 0);
            EXPECT_EQ(broadphase.validate(), "");
        }
        EXPECT_GT(most, 20U);
        EXPECT_EQ(broadphase.sweeps()->size(), 40U);
    }
}

TEST(SweptBodies, MakePairsWithWhatTheyPassAndNothingElse) {
    expectPairsOfWhatIsPassed(0);
}

TEST(SweptBodies, DoSoFarFromTheOrigin) {
    expectPairsOfWhatIsPassed(16'384);
    expectPairsOfWhatIsPassed(-1'048'576);
}

// Nearly a million metres in a step: boxes of more than that Bullet takes out of the simulation.
TEST(SweptBodies, DoSoHoweverFastTheyAre) {
    expectPairsOfWhatIsPassed(0, 1e5);
    expectPairsOfWhatIsPassed(0, 5.9e7);
}

TEST(SweptBodies, HaveFewerPairsThanBoxesAroundStartAndEnd) {
    std::vector<std::size_t> counts;
    for (const Sweep sweep : {Sweep::none, Sweep::automatic}) {
        Random random(0x5eed0e02);
        ShootingRange range(swept(sweep));
        range.fill(random);
        range.world.stepSimulation(kStep, 0);
        counts.push_back(range.pairs().size());
    }
    EXPECT_LT(5 * counts[1], 2 * counts[0]);
    EXPECT_GT(counts[1], 0U);
}

// m_useContinuous off: Bullet hands in where a body is, and no more.
TEST(SweptBodies, PassNoThinWallUnnoticedWithoutBulletsOwnBoxes) {
    for (const Sweep sweep : {Sweep::none, Sweep::line}) {
        ShootingRange range(swept(sweep));
        range.world.getDispatchInfo().m_useContinuous = false;
        range.add(range.wall, 0, btVector3(0, 0, 0));
        range.add(range.ball, 1, btVector3(0, 0, -2), btVector3(0, 0, 240));
        std::size_t noticed = 0;
        for (int step = 0; step < 3; ++step) {
            range.world.stepSimulation(kStep, 0);
            noticed += range.pairs().size();
        }
        EXPECT_EQ(noticed, sweep == Sweep::none ? 0U : 1U);
    }
}

// Each ball has a wall of its own, and meets it at another moment of its step.
TEST(SweptBodies, PassNoThinWallUnnoticedWhereverInTheirStepItStands) {
    constexpr int kPhases = 1000;
    for (const double thickness : {0.1, 0.01, 0.001}) {
        for (const Sweep sweep : {Sweep::none, Sweep::box, Sweep::line, Sweep::automatic}) {
            ShootingRange range(swept(sweep));
            range.world.getDispatchInfo().m_useContinuous = false;
            btBoxShape thinWall(btVector3(1, 1, btScalar(thickness / 2)));
            std::set<ShootingRange::RawPair> expected;
            for (int i = 0; i < kPhases; ++i) {
                const auto x = btScalar(3 * i);
                const btRigidBody& wall = range.add(thinWall, 0, btVector3(x, 0, 0));
                // 4 m a step.
                const btRigidBody& ball =
                    range.add(range.ball, 1, btVector3(x, 0, btScalar(-4 * (i + 0.5) / kPhases)),
                              btVector3(0, 0, 240));
                expected.insert(std::minmax<const btBroadphaseProxy*>(wall.getBroadphaseProxy(),
                                                                      ball.getBroadphaseProxy()));
            }
            range.world.stepSimulation(kStep, 0);
            if (sweep == Sweep::none) {
                EXPECT_LT(range.pairs().size(), std::size_t{kPhases} / 10);
            } else {
                EXPECT_EQ(range.pairs(), expected) << thickness;
            }
        }
    }
}

TEST(SweptBodies, AreFoundByRaysWhereTheStepHasLeftThem) {
    ShootingRange range(swept(Sweep::automatic));
    btRigidBody& ball = range.add(range.ball, 1, btVector3(0, 0, 0), btVector3(300, 300, 0));
    range.add(range.wall, 0, btVector3(0, 50, 0));
    range.world.stepSimulation(kStep, 0);
    const btVector3 now = ball.getWorldTransform().getOrigin();
    EXPECT_NEAR(now.x(), 5, 1e-3);
    const btVector3 from = now + btVector3(0, 0, 5);
    const btVector3 to = now - btVector3(0, 0, 5);
    btCollisionWorld::ClosestRayResultCallback stock(from, to);
    range.world.rayTest(from, to, stock);
    EXPECT_EQ(stock.m_collisionObject, &ball);
    btCollisionWorld::ClosestRayResultCallback closest(from, to);
    static_cast<SpatialHashBroadphase&>(*range.broadphase).closestRay(from, to, closest);
    EXPECT_EQ(closest.m_collisionObject, &ball);

    struct Count final : btBroadphaseAabbCallback {
        bool process(const btBroadphaseProxy*) override { return ++count > 0; }
        int count = 0;
    } count;
    range.broadphase->aabbTest(now, now, count);
    EXPECT_EQ(count.count, 1);
    btVector3 low;
    btVector3 high;
    range.broadphase->getBroadphaseAabb(low, high);
    EXPECT_GT(high.x(), now.x());
}

// Bullet casts convex shapes by fat rays through the broadphase.
TEST(SweptBodies, AreMetByConvexSweepsAsUnderBulletsTree) {
    const auto hits = [](std::unique_ptr<btBroadphaseInterface> broadphase) {
        Random random(0x5eed0e03);
        ShootingRange range(std::move(broadphase));
        range.fill(random);
        range.world.stepSimulation(kStep, 0);
        std::vector<std::pair<int, btScalar>> found;
        for (int i = 0; i < 300; ++i) {
            const Vector3<double> from = random.pointIn(-20, 20);
            const Vector3<double> to = random.pointIn(-20, 20);
            const btTransform start(
                btMatrix3x3::getIdentity(),
                btVector3(btScalar(from.x()), btScalar(from.y()), btScalar(from.z())));
            const btTransform end(btMatrix3x3::getIdentity(),
                                  btVector3(btScalar(to.x()), btScalar(to.y()), btScalar(to.z())));
            btCollisionWorld::ClosestConvexResultCallback closest(start.getOrigin(),
                                                                  end.getOrigin());
            const btSphereShape sphere(btScalar(0.3));
            range.world.convexSweepTest(&sphere, start, end, closest);
            if (closest.hasHit()) {
                found.emplace_back(closest.m_hitCollisionObject->getWorldArrayIndex(),
                                   closest.m_closestHitFraction);
            }
        }
        return found;
    };
    const auto expected = hits(std::make_unique<btDbvtBroadphase>());
    EXPECT_GT(expected.size(), 100U);
    EXPECT_EQ(hits(swept(Sweep::automatic)), expected);
}

TEST(SweptBodies, MoveAsWithoutSweeps) {
    const auto finalPlaces = [](Sweep sweep) {
        Random random(0x5eed0e04);
        ShootingRange range(swept(sweep));
        // So far apart that nothing touches two others: Bullet's solver heeds the order of contacts.
        range.fill(random, 15);
        for (const auto& body : range.bodies) {
            body->setCollisionFlags(body->getCollisionFlags() &
                                    ~btCollisionObject::CF_NO_CONTACT_RESPONSE);
            body->setCcdMotionThreshold(btScalar(0.05));
            body->setCcdSweptSphereRadius(btScalar(0.04));
        }
        std::vector<btScalar> places;
        for (int step = 0; step < 2; ++step) {
            range.world.stepSimulation(kStep, 0);
        }
        for (const auto& body : range.bodies) {
            for (int axis = 0; axis < 3; ++axis) {
                places.push_back(body->getWorldTransform().getOrigin()[axis]);
            }
        }
        return places;
    };
    EXPECT_EQ(finalPlaces(Sweep::line), finalPlaces(Sweep::none));
}

TEST(SweptBodies, AreDynamicRigidBodiesThatMoveFarForTheirSize) {
    ShootingRange range(swept(Sweep::automatic));
    btRigidBody& ball = range.add(range.ball, 1, btVector3(0, 0, 0));
    const auto predictBy = [](btCollisionObject& object, btScalar way) {
        object.setInterpolationWorldTransform(
            btTransform(btMatrix3x3::getIdentity(),
                        object.getWorldTransform().getOrigin() + btVector3(way, 0, 0)));
    };
    const btBroadphaseProxy& proxy = *ball.getBroadphaseProxy();
    EXPECT_FALSE(detail::fastMotion(proxy, 1));
    predictBy(ball, btScalar(0.2));  // its box, with margins, is 0.24 m long
    EXPECT_FALSE(detail::fastMotion(proxy, 1));
    EXPECT_TRUE(detail::fastMotion(proxy, btScalar(0.5)));
    predictBy(ball, btScalar(0.3));
    ASSERT_TRUE(detail::fastMotion(proxy, 1));
    EXPECT_FLOAT_EQ(static_cast<float>(detail::fastMotion(proxy, 1)->way.displacement.x()), 0.3F);
    predictBy(ball, std::numeric_limits<btScalar>::quiet_NaN());
    EXPECT_FALSE(detail::fastMotion(proxy, 1));

    btRigidBody& wall = range.add(range.wall, 0, btVector3(5, 0, 0));
    predictBy(wall, 9);
    EXPECT_FALSE(detail::fastMotion(*wall.getBroadphaseProxy(), 1));
    btCollisionObject sensor;
    sensor.setCollisionShape(&range.ball);
    range.world.addCollisionObject(&sensor);
    predictBy(sensor, 9);
    EXPECT_FALSE(detail::fastMotion(*sensor.getBroadphaseHandle(), 1));
    range.world.removeCollisionObject(&sensor);
    EXPECT_FALSE(detail::fastMotion(btBroadphaseProxy(), 1));
}

}  // namespace
}  // namespace hashphase::test
