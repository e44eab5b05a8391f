// SPDX-License-Identifier: Zlib
//
// What hard worlds are measured by, on small ones: that the measures tell what happens, and that a
// broken broadphase is found out.

#include <demos/stability/physics_cases.hpp>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {
namespace {

HardWorld smallWorld(std::string_view name, int size) {
    const std::vector<HardWorld> all = hardWorlds();
    HardWorld world = *std::find_if(all.begin(), all.end(),
                                    [name](const auto& each) { return each.name == name; });
    world.size = size;
    return world;
}

std::string faultText(const PhysicsOutcome& ours, std::span<const PhysicsOutcome> all) {
    std::string text;
    for (const std::string& fault : faultsOf(ours, all)) {
        text += fault + "\n";
    }
    return text;
}

/// btSimpleBroadphase, but the pair of bodies 0 and 1 is never there.
class ForgetfulSimple : public btSimpleBroadphase {
public:
    explicit ForgetfulSimple(btOverlappingPairCache* cache) : btSimpleBroadphase(1000, cache) {}

    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btSimpleBroadphase::calculateOverlappingPairs(dispatcher);
        btOverlappingPairCache& cache = *getOverlappingPairCache();
        for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
            const btBroadphasePair pair = cache.getOverlappingPairArray()[i];
            if (numberOf(*pair.m_pProxy0) + numberOf(*pair.m_pProxy1) == 1) {
                cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, dispatcher);
                return;
            }
        }
    }

private:
    static int numberOf(const btBroadphaseProxy& proxy) {
        return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
    }
};

TEST(PhysicsCases, FindNothingWrongWithOurs) {
    for (const double offset : kHardOffsets) {
        const HardWorld world = movedTo(offset, smallWorld("tower", 4));
        const std::vector<PhysicsOutcome> outcomes = runPhysicsCase(world, 200);
        ASSERT_EQ(outcomes.size(), 6U);
        EXPECT_EQ(faultText(outcomes.front(), outcomes), "");
        EXPECT_EQ(outcomes.front().scene, world.name);
        EXPECT_EQ(outcomes.front().broadphase, kHashName);
        EXPECT_GT(outcomes.front().settleStep, 0);
        EXPECT_GT(outcomes.front().sleepingBodySteps, 0U);
    }
}

TEST(PhysicsCases, NoticeAPairThatIsForgotten) {
    const HardWorld world = smallWorld("tower", 4);
    std::vector<PhysicsBroadphase> broadphases = hardBroadphases(world);
    broadphases.front() = {"forgetful", true, true, [](PairCache* cache) {
                               return std::make_unique<ForgetfulSimple>(cache);
                           }};
    const std::vector<PhysicsOutcome> outcomes = runPhysicsCase(world, 200, broadphases);
    const std::string faults = faultText(outcomes.front(), outcomes);
    EXPECT_NE(faults.find("differently than under btSimpleBroadphase"), std::string::npos);
    EXPECT_NE(faults.find("later than under btDbvtBroadphase"), std::string::npos);
    // It falls through the floor, which a measure by its own pairs would not see.
    EXPECT_GT(outcomes.front().worstPenetration, 10 * outcomes[1].worstPenetration);
}

TEST(PhysicsCases, CountBulletsThatPassUnnoticed) {
    const HardWorld world = smallWorld("bullets-pass", 6);
    const std::vector<PhysicsOutcome> outcomes = runPhysicsCase(world, world.steps);
    EXPECT_EQ(faultText(outcomes.front(), outcomes), "");
    EXPECT_EQ(outcomes.front().tunnelled, 0);
    EXPECT_GT(outcomes[1].tunnelled, 3);
    EXPECT_NE(faultText(outcomes[1], outcomes), "");
}

TEST(PhysicsCases, CountBulletsThatComeThroughWallsThatDoNotStopThem) {
    HardWorld world = smallWorld("bullets-pass", 6);
    world.bullets = Bullets::stop;  // but Bullet is not told to stop them
    EXPECT_EQ(runPhysicsCase(world, world.steps).front().tunnelled, 6);
}

TEST(PenetrationMeter, TellsHowDeepTheDeepestOverlapIsWhateverTheBroadphaseKnows) {
    PhysicsWorld world(physicsBroadphases().front(), ListOrder::asShipped);
    auto& ball = world.contents().addShape<btSphereShape>(btScalar(1));
    PenetrationMeter meter;
    world.contents().addBody(ball, 1, btVector3(0, 0, 0));
    world.contents().addBody(ball, 0, btVector3(0, 5, 0));
    EXPECT_EQ(meter.deepest(world.contents()), 0);
    world.contents().addBody(ball, 1, btVector3(1.75F, 0, 0));
    world.contents().addBody(ball, 0, btVector3(0, 5.5F, 0));  // both are static
    EXPECT_EQ(world.pairCount(), 0);
    EXPECT_NEAR(meter.deepest(world.contents()), 0.25, 1e-6);
}

// A ball in free fall gains by speed no more than it loses in height; one that is pushed gains.
TEST(HardRun, TellsByHowMuchEnergyGrew) {
    const HardWorld world{"fall",
                          "",
                          1,
                          0,
                          10,
                          false,
                          Bullets::none,
                          [](WorldContents& contents, const btVector3& origin, int) {
                              auto& ball = contents.addShape<btSphereShape>(btScalar(1));
                              contents.addBody(ball, 2, origin);
                          }};
    HardRun run(world, physicsBroadphases().front(), ListOrder::canonical);
    run.step();
    EXPECT_LE(run.outcome().energyDrift, 1e-6);
    run.world().contents().bodies().front()->setLinearVelocity(btVector3(0, 0, 3));
    run.step();
    EXPECT_NEAR(run.outcome().energyDrift, 9, 0.1);
}

}  // namespace
}  // namespace hashphase::demos
