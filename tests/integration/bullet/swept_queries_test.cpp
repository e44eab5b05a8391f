// SPDX-License-Identifier: Zlib

// SpatialHashConfig::sweep: whoever asks where a fast body is finds it where Bullet has it, as without
// a sweep.

#include <integration/bullet/origin_shift.hpp>
#include <tests/integration/bullet/shooting_range.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

ProxyId idOf(const btRigidBody& body) {
    return SpatialHashBroadphase::idOf(body.getBroadphaseProxy());
}

const Aabb<btScalar>& boxInGrid(ShootingRange& range, const btRigidBody& body) {
    return range.hash().grid().box(idOf(body));
}

bool isAt(const Aabb<btScalar>& box, const btVector3& point) {
    return box.contains(toEigen(point));
}

bool isWhereItIs(ShootingRange& range, const btRigidBody& body) {
    return isAt(boxInGrid(range, body), body.getWorldTransform().getOrigin());
}

/// The same range without a sweep and with one.
struct TwoRanges {
    ShootingRange plain{Sweep::none};
    ShootingRange fast{Sweep::automatic};

    TwoRanges(std::uint64_t seed, bool doHit) {
        for (ShootingRange* range : {&plain, &fast}) {
            range->fill(seed, 15);
            btRigidBody& lift = range->add(range->wall, 0, btVector3(40, 0, 0));
            lift.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
            lift.setInterpolationWorldTransform(placeAt({45, 0, 0}));
            if (doHit) {
                range->letThemHit();
            }
        }
    }

    /// The grids have the same boxes, and hand out the same.
    void expectTheSameBoxes() {
        ASSERT_EQ(fast.hash().validate(), "");
        for (int i = 0; i < plain.bodyCount(); ++i) {
            const Aabb<btScalar>& expected = boxInGrid(plain, plain.body(i));
            ASSERT_TRUE(isSameBits(boxInGrid(fast, fast.body(i)), expected)) << "body " << i;
            Box box;
            fast.hash().getAabb(fast.body(i).getBroadphaseProxy(), box.min, box.max);
            ASSERT_TRUE(isSameBits(toAabb(box.min, box.max), expected)) << "body " << i;
        }
        Box expected;
        Box all;
        plain.hash().getBroadphaseAabb(expected.min, expected.max);
        fast.hash().getBroadphaseAabb(all.min, all.max);
        EXPECT_TRUE(isSameBits(toAabb(all.min, all.max), toAabb(expected.min, expected.max)));
    }
};

TEST(SweptQueries, SeeEachBoxOfTheGridAsWithoutASweep) {
    for (const bool doHit : {false, true}) {
        TwoRanges ranges(0x5eed0e10, doHit);
        ranges.expectTheSameBoxes();
        for (int step = 0; step < (doHit ? 2 : 8); ++step) {
            ranges.plain.step();
            ranges.fast.step();
            ranges.expectTheSameBoxes();
        }
        EXPECT_GT(ranges.fast.hash().sweeps()->size(), 30U);
    }
}

TEST(SweptQueries, SeeThemSoBetweenSubSteps) {
    TwoRanges ranges(0x5eed0e11, false);
    struct Tick {
        ShootingRange& range;
        std::vector<Aabb<btScalar>> boxes;
    };
    std::array<Tick, 2> ticks{Tick{ranges.plain, {}}, Tick{ranges.fast, {}}};
    for (Tick& tick : ticks) {
        tick.range.world().setInternalTickCallback(
            [](btDynamicsWorld* world, btScalar) {
                auto& own = *static_cast<Tick*>(world->getWorldUserInfo());
                for (int i = 0; i < own.range.bodyCount(); ++i) {
                    const btRigidBody& body = own.range.body(i);
                    own.boxes.push_back(boxInGrid(own.range, body));
                    EXPECT_TRUE(body.isStaticOrKinematicObject() || isWhereItIs(own.range, body));
                }
            },
            &tick);
        tick.range.world().stepSimulation(btScalar(3.5) * kStep, 4, kStep);
    }
    ASSERT_EQ(ticks[0].boxes.size(), 3 * std::size_t(ranges.plain.bodyCount()));
    ASSERT_EQ(ticks[1].boxes.size(), ticks[0].boxes.size());
    for (std::size_t i = 0; i < ticks[0].boxes.size(); ++i) {
        ASSERT_TRUE(isSameBits(ticks[0].boxes[i], ticks[1].boxes[i])) << i;
    }
    ranges.expectTheSameBoxes();
}

// m_useContinuous off: Bullet hands in where the body is, and no more.
TEST(SweptQueries, FindABodyWhereTheStepHasLeftItWithoutBulletsOwnBoxes) {
    ShootingRange range(Sweep::automatic);
    range.world().getDispatchInfo().m_useContinuous = false;
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {300, 300, 0});
    for (int step = 0; step < 3; ++step) {
        const btVector3 before = ball.getWorldTransform().getOrigin();
        range.step();
        EXPECT_TRUE(isAt(boxInGrid(range, ball), before));
        EXPECT_TRUE(isWhereItIs(range, ball));
    }
}

TEST(SweptQueries, FindABodyThatAWallHasStopped) {
    ShootingRange range(Sweep::automatic);
    range.add(range.wall, 0, {0, 0, 2});
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {0, 0, 240});
    range.letThemHit();
    range.step();
    EXPECT_LT(ball.getWorldTransform().getOrigin().z(), 2);
    EXPECT_TRUE(isWhereItIs(range, ball));
    EXPECT_EQ(range.pairs().size(), 1U);
}

// Both the box and the way go along.
TEST(SweptQueries, FollowAShiftOfTheOriginInFlight) {
    ShootingRange range(Sweep::automatic);
    range.fill(0x5eed0e12);
    range.step();
    const auto wayOf = [&](int i) { return range.hash().sweeps()->motion(idOf(range.body(i))); };
    std::vector<MovingBox<btScalar>> before;
    for (int i = 0; i < range.bodyCount(); ++i) {
        before.push_back(wayOf(i));
    }
    const auto pairs = range.pairs();
    const btVector3 shift(1024, btScalar(-0.3), 64);
    ASSERT_TRUE(shiftWorldOrigin(range.world(), range.hash(), shift));
    for (int i = 0; i < range.bodyCount(); ++i) {
        const MovingBox<btScalar>& expected = before[std::size_t(i)];
        EXPECT_EQ(wayOf(i).box.min(), Vector3<btScalar>(expected.box.min() - toEigen(shift)));
        EXPECT_EQ(wayOf(i).box.max(), Vector3<btScalar>(expected.box.max() - toEigen(shift)));
        EXPECT_EQ(wayOf(i).displacement, expected.displacement);
        EXPECT_TRUE(isWhereItIs(range, range.body(i)));
    }
    EXPECT_EQ(range.pairs(), pairs);
    EXPECT_EQ(range.hash().validate(), "");
    range.step();
    EXPECT_EQ(range.hash().validate(), "");
}

TEST(SweptQueries, FollowABodyThatSlowsDownIsMovedByHandAndGoes) {
    const CaughtMessages aboutNan;
    ShootingRange range(Sweep::automatic);
    const btRigidBody& wall = range.add(range.wall, 0, {0, 0, 2});
    btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {0, 0, 240});
    SpatialHashBroadphase& broadphase = range.hash();
    range.step();
    EXPECT_EQ(broadphase.sweeps()->size(), 1U);
    EXPECT_EQ(range.pairs().size(), 1U);

    ball.setLinearVelocity({0, 0, 1});
    range.step();
    EXPECT_EQ(broadphase.sweeps()->size(), 0U);
    EXPECT_TRUE(range.pairs().empty());
    EXPECT_TRUE(isWhereItIs(range, ball));

    putAt(ball, {0, 0, 0});
    ball.setLinearVelocity({0, 0, 240});
    range.world().updateSingleAabb(&ball);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {0, 0, 0}));
    range.step();
    EXPECT_EQ(range.pairs().size(), 1U);

    // By hand, to where the body is not, before it flies on and in flight.
    const auto set = [&](btScalar x) {
        broadphase.setAabb(ball.getBroadphaseProxy(), {x, 0, 0}, {91, 1, 1}, nullptr);
    };
    set(90);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {90, 1, 1}));
    ball.setInterpolationWorldTransform(placeAt({0, 0, 50}));
    set(90);
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {90, 1, 1}));
    EXPECT_TRUE(isWhereItIs(range, ball));
    EXPECT_TRUE(isAt(boxInGrid(range, ball), {0, 0, 50}));
    set(std::numeric_limits<btScalar>::quiet_NaN());
    broadphase.calculateOverlappingPairs(&range.dispatcher());
    EXPECT_EQ(broadphase.grid().nanCount(), 1U);
    EXPECT_TRUE(range.pairs().empty());

    range.step();
    range.takeOut(1);
    EXPECT_EQ(broadphase.validate(), "");
    EXPECT_EQ(broadphase.grid().size(), 1U);
    EXPECT_EQ(broadphase.sweeps()->motion(idOf(wall)).displacement, Vector3<btScalar>(0, 0, 0));
}

// The box around the way holds more than the way passes. What a ghost learns at once is exact, too.
TEST(SweptQueries, OfAGhostTakeNoBodyForOneThatOnlyItsBoxTouches) {
    btBoxShape shape(btVector3(1, 1, 1));
    ShootingRange range(Sweep::automatic);
    const btRigidBody& ball = range.add(range.ball, 1, {0, 0, 0}, {300, 300, 0});
    range.step();  // to 5, 5, 0
    btPairCachingGhostObject& ghost = range.addGhost(&shape, {4, 1, 0});
    const btBroadphaseProxy& proxy = *ghost.getBroadphaseHandle();
    ASSERT_TRUE(overlaps(boxInGrid(range, ball), toAabb(proxy.m_aabbMin, proxy.m_aabbMax)));
    EXPECT_EQ(ghost.getNumOverlappingObjects(), 0);
    putAt(ghost, {0, 0, 0});
    range.world().updateSingleAabb(&ghost);
    EXPECT_EQ(ghost.getNumOverlappingObjects(), 1);
    range.world().removeCollisionObject(&ghost);
    range.hash().calculateOverlappingPairs(&range.dispatcher());
    EXPECT_EQ(range.hash().validate(), "");
}

}  // namespace
}  // namespace hashphase::test
