// SPDX-License-Identifier: Zlib
//
// Worlds that are hard on a physics engine, near the origin and far from it: whatever goes wrong
// there is the solver's doing, or that of rounding, and goes wrong in the same bits under brute
// force.
//
// Pairs are listed by the numbers of the bodies, contacts by age, within an island by unique ids
// (ListOrder::canonicalByUniqueId): then pairs without contacts, of which btDbvtBroadphase has
// some, change nothing but who may sleep.

#include <demos/scenes/hard_run.hpp>
#include <demos/scenes/hard_worlds.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

void PrintTo(const HardWorld& world, std::ostream* out) {
    *out << world.name;
}

}  // namespace hashphase::demos

namespace hashphase::test {
namespace {

using demos::HardRun;
using demos::HardWorld;
using demos::ListOrder;
using demos::PhysicsBroadphase;
using demos::PhysicsOutcome;

constexpr int kHardSteps = 2000;
constexpr double kFar = 16'384;  // [m]

PhysicsBroadphase named(std::string_view name) {
    const std::vector<PhysicsBroadphase> all = demos::physicsBroadphases();
    return *std::find_if(all.begin(), all.end(),
                         [name](const PhysicsBroadphase& each) { return each.name == name; });
}

/// All of them, here and far away, less of what takes long.
std::vector<HardWorld> worlds() {
    std::vector<HardWorld> all;
    for (const double offset : {0.0, kFar}) {
        for (HardWorld world : demos::hardWorlds()) {
            if (world.name == "ragdolls") {
                world.size = 2;
            } else if (world.bullets != demos::Bullets::none) {
                world.size = 24;
            } else if (world.name == "chain" || world.name == "pyramid") {
                world.size = 8;
            }
            all.push_back(movedTo(offset, world));
        }
    }
    return all;
}

HardRun runOver(const HardWorld& world, std::string_view broadphase) {
    return HardRun(world, named(broadphase), ListOrder::canonicalByUniqueId);
}

void expectSame(const PhysicsOutcome& ours, const PhysicsOutcome& exact) {
    EXPECT_EQ(ours.worstPenetration, exact.worstPenetration);
    EXPECT_EQ(ours.energyDrift, exact.energyDrift);
    EXPECT_EQ(ours.settleStep, exact.settleStep);
    EXPECT_EQ(ours.sleepingBodySteps, exact.sleepingBodySteps);
    EXPECT_EQ(ours.tunnelled, exact.tunnelled);
    EXPECT_EQ(ours.trajectoryHash, exact.trajectoryHash);
}

class HardWorlds : public testing::TestWithParam<HardWorld> {};

TEST_P(HardWorlds, MoveAsUnderBtSimpleBroadphaseToTheLastBit) {
    HardRun hash = runOver(GetParam(), demos::kHashName);
    HardRun simple = runOver(GetParam(), demos::kSimpleName);
    for (int step = 0; step < kHardSteps; ++step) {
        hash.step();
        simple.step();
        ASSERT_EQ(hash.state(), simple.state()) << "after step " << step;
    }
    expectSame(hash.outcome(), simple.outcome());
    if (GetParam().rests && GetParam().offset == 0) {
        EXPECT_GE(hash.outcome().settleStep, 0);
    }
    if (GetParam().bullets == demos::Bullets::stop) {
        // Bullet casts spheres through the broadphase.
        EXPECT_EQ(hash.outcome().tunnelled, 0);
    }
    auto& broadphase = dynamic_cast<SpatialHashBroadphase&>(*hash.world().world().getBroadphase());
    EXPECT_EQ(broadphase.validate(), "");
}

/// "tower@2^14" becomes "towerAt2To14": GoogleTest takes letters and digits only.
std::string testName(const testing::TestParamInfo<HardWorld>& info) {
    std::string name;
    for (const char letter : info.param.name) {
        if (letter == '@') {
            name += "At";
        } else if (letter == '^') {
            name += "To";
        } else if (letter != '-') {
            name += letter;
        }
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Worlds, HardWorlds, testing::ValuesIn(worlds()), testName);

// --- Sleep ---------------------------------------------------------------------------------------

/// The numbers of the first steps after which a body sleeps, and after which states differ.
struct Firsts {
    int asleepOverHash = kHardSteps;  // none
    int asleepOverDbvt = kHardSteps;
    int different = kHardSteps;
};

Firsts stepTogether(HardRun& hash, HardRun& dbvt, int steps) {
    Firsts firsts;
    const auto note = [](int& first, bool isSo, int step) {
        first = isSo ? std::min(first, step) : first;
    };
    for (int step = 0; step < steps; ++step) {
        hash.step();
        dbvt.step();
        note(firsts.asleepOverHash, hash.sleepingCount() > 0, step);
        note(firsts.asleepOverDbvt, dbvt.sleepingCount() > 0, step);
        note(firsts.different, hash.state() != dbvt.state(), step);
    }
    return firsts;
}

// Pairs that do not overlap tie islands together, and an island sleeps as one. Up to the first body
// that sleeps, both move alike, so the claim is not one of chance; afterwards they may differ.
TEST(WorldsThatRest, SleepNoLaterAndSinkNoDeeperThanUnderBtDbvtBroadphase) {
    constexpr double kSleepTolerance = 0.02;
    constexpr double kDepthTolerance = 0.1;
    std::uint64_t sumOverHash = 0;
    std::uint64_t sumOverDbvt = 0;
    int earlierCount = 0;
    for (const HardWorld& world : worlds()) {
        if (!world.rests) {
            continue;
        }
        SCOPED_TRACE(world.name);
        HardRun hash = runOver(world, demos::kHashName);
        HardRun dbvt = runOver(world, demos::kDbvtName);
        const Firsts firsts = stepTogether(hash, dbvt, world.steps);
        EXPECT_GE(firsts.different, firsts.asleepOverHash);
        EXPECT_LE(firsts.asleepOverHash, firsts.asleepOverDbvt);
        const PhysicsOutcome& ours = hash.outcome();
        const PhysicsOutcome& theirs = dbvt.outcome();
        EXPECT_GE(static_cast<double>(ours.sleepingBodySteps),
                  (1 - kSleepTolerance) * static_cast<double>(theirs.sleepingBodySteps));
        EXPECT_LE(ours.worstPenetration, (1 + kDepthTolerance) * theirs.worstPenetration);
        EXPECT_LE(ours.energyDrift, (1 + kDepthTolerance) * theirs.energyDrift);
        sumOverHash += ours.sleepingBodySteps;
        sumOverDbvt += theirs.sleepingBodySteps;
        earlierCount += ours.sleepingBodySteps > theirs.sleepingBodySteps ? 1 : 0;
    }
    EXPECT_GT(sumOverHash, sumOverDbvt);
    EXPECT_GE(earlierCount, 2);
}

}  // namespace
}  // namespace hashphase::test
