// SPDX-License-Identifier: Zlib

// A world that goes back takes the same steps again, to the last bit of all that Bullet knows: whatever happened
// between.

#include <integration/bullet/world_snapshot.hpp>

#include <demos/scenes/hard_worlds.hpp>
#include <demos/scenes/physics_world.hpp>
#include <tests/integration/bullet/counted_bullet.hpp>
#include <tests/integration/bullet/snapshot_worlds.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

using demos::HardWorld;
using demos::ListOrder;
using demos::PhysicsWorld;

/// A world over our broadphase.
struct SavedWorld {
    SavedWorld(const HardWorld& hard, ListOrder order) : physics(snapshotBroadphase(hard), order) {
        hard.fill(physics.contents(), btVector3(0, 0, 0), hard.size);
    }
    [[nodiscard]] std::uint64_t step() {
        physics.step(btScalar(1) / 60);
        return wholeState(physics.world());
    }
    void save(WorldSnapshot& snapshot) {
        ASSERT_EQ(snapshot.save(physics.world(), broadphase()), "");
    }
    void restore(const WorldSnapshot& snapshot) {
        ASSERT_EQ(snapshot.restore(physics.world(), broadphase()), "");
    }
    [[nodiscard]] SpatialHashBroadphase& broadphase() {
        return static_cast<SpatialHashBroadphase&>(*physics.world().getBroadphase());
    }

    PhysicsWorld physics;
};

struct Case {
    HardWorld world;
    ListOrder order;
};

void PrintTo(const Case& each, std::ostream* out) {
    *out << each.world.name;
}

std::vector<Case> cases() {
    std::vector<Case> all;
    for (const HardWorld& world : snapshotWorlds()) {
        all.push_back({world, ListOrder::asShipped});
    }
    return all;
}

class WorldSnapshots : public testing::TestWithParam<Case> {};

TEST_P(WorldSnapshots, TakeTheSameStepsAgainWhateverHappenedBetween) {
    constexpr int kSteps = 600;
    constexpr int kAgain = 70;
    constexpr std::array kSaved{0, 1, 2, 5, 13, 40, 90, 150, 290, 510};
    SavedWorld world(GetParam().world, GetParam().order);
    std::vector<std::uint64_t> states;
    std::vector<WorldSnapshot> snapshots;
    for (int step = 0; step < kSteps; ++step) {
        if (std::find(kSaved.begin(), kSaved.end(), step) != kSaved.end()) {
            world.save(snapshots.emplace_back());
        }
        states.push_back(world.step());
    }
    Random random(3);
    for (int round = 0; round < 14; ++round) {
        const auto which = round < 2 ? static_cast<std::size_t>(round)
                                     : random.below(static_cast<std::uint32_t>(kSaved.size()));
        SCOPED_TRACE("round " + std::to_string(round) + ", step " + std::to_string(kSaved[which]));
        world.restore(snapshots[which]);
        for (int step = kSaved[which]; step < kSaved[which] + kAgain; ++step) {
            ASSERT_EQ(world.step(), states[static_cast<std::size_t>(step)]) << "step " << step;
        }
        world.broadphase().calculateOverlappingPairs(world.physics.world().getDispatcher());
        ASSERT_EQ(world.broadphase().validate(), "");
        disturb(world.physics.world(), random);
        for (int step = static_cast<int>(random.below(30)); step > 0; --step) {
            static_cast<void>(world.step());
        }
    }
}

TEST_P(WorldSnapshots, GoBackEightStepsInEachStepAsIfTheyHadNeverGoneBack) {
    constexpr std::size_t kBack = 8;
    constexpr std::size_t kSteps = 600;
    SavedWorld straight(GetParam().world, GetParam().order);
    SavedWorld rolled(GetParam().world, GetParam().order);
    std::array<WorldSnapshot, kBack> ring;
    for (std::size_t step = 0; step < kSteps; ++step) {
        if (step >= kBack) {
            rolled.restore(ring[step % kBack]);
            for (std::size_t past = step - kBack; past < step; ++past) {
                rolled.save(ring[past % kBack]);
                static_cast<void>(rolled.step());
            }
        }
        rolled.save(ring[step % kBack]);
        ASSERT_EQ(rolled.step(), straight.step()) << "step " << step;
    }
}

TEST_P(WorldSnapshots, TakeTheSameStepsWhereTheyAreSent) {
    SavedWorld here(GetParam().world, GetParam().order);
    SavedWorld there(GetParam().world, GetParam().order);
    for (const int steps : {0, 1, 30, 90, 150}) {
        for (int step = 0; step < steps; ++step) {
            static_cast<void>(here.step());
        }
        WorldSnapshot snapshot;
        here.save(snapshot);
        std::vector<std::byte> bytes;
        ASSERT_EQ(snapshot.write(bytes), "");
        WorldSnapshot received;
        ASSERT_EQ(received.read(bytes, there.physics.world(), there.broadphase()), "");
        there.restore(received);
        std::vector<std::byte> again;
        WorldSnapshot saved;
        there.save(saved);
        ASSERT_EQ(saved.write(again), "");
        EXPECT_EQ(bytes, again);
        for (int step = 0; step < 40; ++step) {
            ASSERT_EQ(there.step(), here.step()) << "step " << step << " after " << steps;
        }
    }
}

TEST_P(WorldSnapshots, TakeNoMemoryInASteadyFrame) {
    const CountedBullet counted;
    SavedWorld world(GetParam().world, GetParam().order);
    WorldSnapshot snapshot;
    for (int step = 0; step < 60; ++step) {
        static_cast<void>(world.step());
        for (int round = 0; round < 2; ++round) {
            const std::size_t before = allocationCount();
            world.save(snapshot);
            world.restore(snapshot);
            if (round > 0) {
                ASSERT_EQ(allocationCount(), before) << "step " << step;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, WorldSnapshots, testing::ValuesIn(cases()), [](const auto& each) {
    std::string name = each.param.world.name;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

}  // namespace
}  // namespace hashphase::test
