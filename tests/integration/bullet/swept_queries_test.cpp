// SPDX-License-Identifier: Zlib

// SpatialHashConfig::sweep: whoever asks where a fast body is finds it where Bullet has it, as without
// a sweep.

#include <integration/ai/zones.hpp>
#include <integration/bullet/origin_shift.hpp>
#include <integration/culling/culler.hpp>
#include <tests/integration/bullet/shooting_range.hpp>
#include <tests/support/handlers.hpp>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

const SpatialHashBroadphase& hashOf(const ShootingRange& range) {
    return static_cast<const SpatialHashBroadphase&>(*range.broadphase);
}

const Aabb<btScalar>& boxInGrid(const ShootingRange& range, const btRigidBody& body) {
    return hashOf(range).grid().box(SpatialHashBroadphase::idOf(body.getBroadphaseProxy()));
}

bool isAt(const Aabb<btScalar>& box, const btVector3& point) {
    return box.contains(toEigen(point));
}

/// The same range without a sweep and with one.
struct TwoRanges {
    ShootingRange plain{swept(Sweep::none)};
    ShootingRange fast{swept(Sweep::automatic)};

    explicit TwoRanges(const std::function<void(ShootingRange&)>& fill) {
        fill(plain);
        fill(fast);
    }

    void step(btScalar seconds = kStep, int mostSteps = 0) {
        plain.world.stepSimulation(seconds, mostSteps, kStep);
        fast.world.stepSimulation(seconds, mostSteps, kStep);
    }

    /// The grids have the same boxes, and hand out the same.
    void expectTheSameBoxes() const {
        ASSERT_EQ(hashOf(fast).validate(), "");
        for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
            const Aabb<btScalar>& expected = boxInGrid(plain, *plain.bodies[i]);
            ASSERT_TRUE(isSameBits(boxInGrid(fast, *fast.bodies[i]), expected)) << "body " << i;
            btVector3 low;
            btVector3 high;
            fast.broadphase->getAabb(fast.bodies[i]->getBroadphaseProxy(), low, high);
            ASSERT_TRUE(isSameBits(toAabb(low, high), expected)) << "body " << i;
        }
        std::array<btVector3, 4> world;
        plain.broadphase->getBroadphaseAabb(world[0], world[1]);
        fast.broadphase->getBroadphaseAabb(world[2], world[3]);
        EXPECT_TRUE(isSameBits(toAabb(world[0], world[1]), toAabb(world[2], world[3])));
    }
};

void letThemHit(const ShootingRange& range) {
    for (const auto& body : range.bodies) {
        body->setCollisionFlags(body->getCollisionFlags() &
                                ~btCollisionObject::CF_NO_CONTACT_RESPONSE);
        body->setCcdMotionThreshold(btScalar(0.05));
        body->setCcdSweptSphereRadius(btScalar(0.04));
    }
}

TEST(SweptQueries, SeeEachBoxOfTheGridAsWithoutASweep) {
    for (const bool doHit : {false, true}) {
        TwoRanges ranges([doHit](ShootingRange& range) {
            Random random(0x5eed0e10);
            range.fill(random, 15);
            btRigidBody& lift = range.add(range.wall, 0, btVector3(40, 0, 0));
            lift.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
            lift.setInterpolationWorldTransform(
                btTransform(btMatrix3x3::getIdentity(), btVector3(45, 0, 0)));
            if (doHit) {
                letThemHit(range);
            }
        });
        ranges.expectTheSameBoxes();
        for (int step = 0; step < (doHit ? 2 : 8); ++step) {
            ranges.step();
            ranges.expectTheSameBoxes();
        }
        EXPECT_GT(hashOf(ranges.fast).sweeps()->size(), 30U);
    }
}

TEST(SweptQueries, SeeThemSoBetweenSubSteps) {
    TwoRanges ranges([](ShootingRange& range) {
        Random random(0x5eed0e11);
        range.fill(random, 15);
    });
    std::array<std::vector<Aabb<btScalar>>, 2> boxes;
    ShootingRange* const both[] = {&ranges.plain, &ranges.fast};
    for (std::size_t i = 0; i < 2; ++i) {
        struct Tick {
            const ShootingRange& range;
            std::vector<Aabb<btScalar>>& boxes;
        } tick{*both[i], boxes[i]};
        both[i]->world.setInternalTickCallback(
            [](btDynamicsWorld* world, btScalar) {
                const auto& own = *static_cast<Tick*>(world->getWorldUserInfo());
                for (const auto& body : own.range.bodies) {
                    own.boxes.push_back(boxInGrid(own.range, *body));
                    if (!body->isStaticObject()) {
                        const btVector3& now = body->getWorldTransform().getOrigin();
                        EXPECT_TRUE(isAt(own.boxes.back(), now));
                    }
                }
            },
            &tick);
        both[i]->world.stepSimulation(btScalar(3.5) * kStep, 4, kStep);
    }
    ASSERT_EQ(boxes[0].size(), 3 * ranges.plain.bodies.size());
    ASSERT_EQ(boxes[1].size(), boxes[0].size());
    for (std::size_t i = 0; i < boxes[0].size(); ++i) {
        ASSERT_TRUE(isSameBits(boxes[0][i], boxes[1][i])) << i;
    }
    ranges.expectTheSameBoxes();
}

// A view of a metre around where the body is drawn.
TEST(SweptQueries, OfACullerSeeABodyInEveryFrame) {
    ShootingRange range(swept(Sweep::automatic));
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {200, 0, 0});
    Culler<btScalar> culler;
    int visible = 0;
    for (int frame = 0; frame < 20; ++frame) {
        range.world.stepSimulation(kStep, 0);
        const btScalar x = ball.getWorldTransform().getOrigin().x();
        using Plane = ConvexRegion<btScalar>::Plane;
        const std::array planes{Plane({1, 0, 0}, btScalar(0.5) - x),
                                Plane({-1, 0, 0}, btScalar(0.5) + x)};
        culler.look(hashOf(range).grid(), ConvexRegion<btScalar>(planes));
        visible += culler.isVisible(SpatialHashBroadphase::idOf(ball.getBroadphaseProxy())) ? 1 : 0;
    }
    EXPECT_EQ(visible, 20);
}

// The step in which a zone of a metre notices a shot of 3.3 m a step; -1 when never.
int stepNoticed(Sweep sweep, btScalar start) {
    ShootingRange range(swept(sweep));
    range.add(range.ball, 1, {start, 0, 0}, {200, 0, 0});
    Zones<btScalar> zones;
    static_cast<void>(zones.add(
        {BoxRegion<btScalar>{boxBetween<btScalar>({29, -1, -1}, {30, 1, 1})}, Presence::box}));
    int noticed = -1;
    for (int step = 0; step < 15; ++step) {
        range.world.stepSimulation(kStep, 0);
        if (!zones.update(hashOf(range).grid()).entered.empty()) {
            EXPECT_EQ(noticed, -1) << "it enters once";
            noticed = step;
        }
    }
    return noticed;
}

TEST(SweptQueries, OfZonesNoticeEachShotInTheSameStepAsWithoutASweep) {
    for (int shot = 0; shot < 60; ++shot) {
        const btScalar start = btScalar(shot) * 10 / 3 / 60;
        const int expected = stepNoticed(Sweep::none, start);
        EXPECT_GE(expected, 0);
        EXPECT_EQ(stepNoticed(Sweep::automatic, start), expected) << shot;
    }
}

// m_useContinuous off: Bullet hands in where the body is, and no more.
TEST(SweptQueries, FindABodyWhereTheStepHasLeftItWithoutBulletsOwnBoxes) {
    ShootingRange range(swept(Sweep::automatic));
    range.world.getDispatchInfo().m_useContinuous = false;
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {300, 300, 0});
    for (int step = 0; step < 3; ++step) {
        const btVector3 before = ball.getWorldTransform().getOrigin();
        range.world.stepSimulation(kStep, 0);
        EXPECT_TRUE(isAt(boxInGrid(range, ball), before));
        EXPECT_TRUE(isAt(boxInGrid(range, ball), ball.getWorldTransform().getOrigin()));
    }
}

TEST(SweptQueries, FindABodyThatAWallHasStopped) {
    ShootingRange range(swept(Sweep::automatic));
    range.add(range.wall, 0, {0, 0, 2});
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {0, 0, 240});
    letThemHit(range);
    range.world.stepSimulation(kStep, 0);
    const btVector3 now = ball.getWorldTransform().getOrigin();
    EXPECT_LT(now.z(), 2);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), now));
    EXPECT_EQ(range.pairs().size(), 1U);
}

// Both the box and the way go along.
TEST(SweptQueries, FollowAShiftOfTheOriginInFlight) {
    Random random(0x5eed0e12);
    ShootingRange range(swept(Sweep::automatic));
    range.fill(random);
    auto& broadphase = static_cast<SpatialHashBroadphase&>(*range.broadphase);
    range.world.stepSimulation(kStep, 0);
    std::vector<MovingBox<btScalar>> ways;
    for (const auto& body : range.bodies) {
        ways.push_back(
            broadphase.sweeps()->motion(SpatialHashBroadphase::idOf(body->getBroadphaseProxy())));
    }
    const auto pairs = range.pairs();
    const btVector3 shift(1024, btScalar(-0.3), 64);
    ASSERT_TRUE(shiftWorldOrigin(range.world, broadphase, shift));
    for (std::size_t i = 0; i < ways.size(); ++i) {
        const btRigidBody& body = *range.bodies[i];
        const MovingBox<btScalar> way =
            broadphase.sweeps()->motion(SpatialHashBroadphase::idOf(body.getBroadphaseProxy()));
        EXPECT_EQ(way.box.min(), Vector3<btScalar>(ways[i].box.min() - toEigen(shift)));
        EXPECT_EQ(way.box.max(), Vector3<btScalar>(ways[i].box.max() - toEigen(shift)));
        EXPECT_EQ(way.displacement, ways[i].displacement);
        EXPECT_TRUE(isAt(boxInGrid(range, body), body.getWorldTransform().getOrigin()));
    }
    EXPECT_EQ(range.pairs(), pairs);
    EXPECT_EQ(broadphase.validate(), "");
    range.world.stepSimulation(kStep, 0);
    EXPECT_EQ(broadphase.validate(), "");
}

TEST(SweptQueries, FollowABodyThatSlowsDownIsMovedByHandAndGoes) {
    const CaughtMessages aboutNan;
    ShootingRange range(swept(Sweep::automatic));
    const btRigidBody& wall = range.add(range.wall, 0, {0, 0, 2});
    btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {0, 0, 240});
    auto& broadphase = static_cast<SpatialHashBroadphase&>(*range.broadphase);
    range.world.stepSimulation(kStep, 0);
    EXPECT_EQ(broadphase.sweeps()->size(), 1U);
    EXPECT_EQ(range.pairs().size(), 1U);

    ball.setLinearVelocity({0, 0, 1});
    range.world.stepSimulation(kStep, 0);
    EXPECT_EQ(broadphase.sweeps()->size(), 0U);
    EXPECT_TRUE(range.pairs().empty());
    EXPECT_TRUE(isAt(boxInGrid(range, ball), ball.getWorldTransform().getOrigin()));

    const btTransform back(btMatrix3x3::getIdentity(), {0, 0, 0});
    ball.setWorldTransform(back);
    ball.setInterpolationWorldTransform(back);
    ball.setLinearVelocity({0, 0, 240});
    range.world.updateSingleAabb(&ball);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {0, 0, 0}));
    range.world.stepSimulation(kStep, 0);
    EXPECT_EQ(range.pairs().size(), 1U);

    // By hand, to where the body is not, before it flies on and in flight.
    broadphase.setAabb(ball.getBroadphaseProxy(), {90, 0, 0}, {91, 1, 1}, nullptr);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {90, 1, 1}));
    ball.setInterpolationWorldTransform(btTransform(btMatrix3x3::getIdentity(), {0, 0, 50}));
    broadphase.setAabb(ball.getBroadphaseProxy(), {90, 0, 0}, {91, 1, 1}, nullptr);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {90, 1, 1}));
    EXPECT_TRUE(isAt(boxInGrid(range, ball), ball.getWorldTransform().getOrigin()));
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {0, 0, 50}));
    const btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();
    broadphase.setAabb(ball.getBroadphaseProxy(), {nan, 0, 0}, {91, 1, 1}, nullptr);
    broadphase.calculateOverlappingPairs(&range.dispatcher);
    EXPECT_EQ(broadphase.grid().nanCount(), 1U);
    EXPECT_TRUE(range.pairs().empty());

    range.world.stepSimulation(kStep, 0);
    range.world.removeRigidBody(&ball);
    EXPECT_EQ(broadphase.validate(), "");
    EXPECT_EQ(broadphase.grid().size(), 1U);
    EXPECT_EQ(broadphase.sweeps()
                  ->motion(SpatialHashBroadphase::idOf(wall.getBroadphaseProxy()))
                  .displacement,
              Vector3<btScalar>(0, 0, 0));
    range.bodies.pop_back();
}

// The box around the way holds more than the way passes. What a ghost learns at once is exact, too.
TEST(SweptQueries, OfAGhostTakeNoBodyForOneThatOnlyItsBoxTouches) {
    ShootingRange range(swept(Sweep::automatic));
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {300, 300, 0});
    range.world.stepSimulation(kStep, 0);  // to 5, 5, 0
    btGhostPairCallback callback;
    range.broadphase->getOverlappingPairCache()->setInternalGhostPairCallback(&callback);
    btPairCachingGhostObject ghost;
    btBoxShape shape(btVector3(1, 1, 1));
    ghost.setCollisionShape(&shape);
    ghost.setCollisionFlags(btCollisionObject::CF_NO_CONTACT_RESPONSE);
    const auto placeAt = [&](const btVector3& place) {
        ghost.setWorldTransform(btTransform(btMatrix3x3::getIdentity(), place));
        ghost.setInterpolationWorldTransform(ghost.getWorldTransform());
    };
    placeAt({4, 1, 0});
    range.world.addCollisionObject(&ghost, btBroadphaseProxy::SensorTrigger,
                                   btBroadphaseProxy::AllFilter);
    ASSERT_TRUE(overlaps(boxInGrid(range, ball), toAabb(ghost.getBroadphaseHandle()->m_aabbMin,
                                                        ghost.getBroadphaseHandle()->m_aabbMax)));
    EXPECT_EQ(ghost.getNumOverlappingObjects(), 0);
    placeAt({0, 0, 0});
    range.world.updateSingleAabb(&ghost);
    EXPECT_EQ(ghost.getNumOverlappingObjects(), 1);
    range.world.removeCollisionObject(&ghost);
    range.broadphase->calculateOverlappingPairs(&range.dispatcher);
    EXPECT_EQ(hashOf(range).validate(), "");
}

}  // namespace
}  // namespace hashphase::test
