// SPDX-License-Identifier: Zlib
#include <demos/swarm/scaling_plan.hpp>
#include <demos/swarm/swarm_scene.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace hashphase::demos {
namespace {

TEST(SwarmScene, MovesEverySphereALittleAndNoneForGood) {
    for (const SwarmKindName& kind : swarmKinds()) {
        SCOPED_TRACE(kind.name);
        const SwarmScene scene(kind.kind, 1000, 5);
        for (std::uint64_t number = 0; number < 1000; number += 7) {
            for (std::uint32_t frame = 1; frame < 40; ++frame) {
                const Aabb<float> before = scene.box(number, frame - 1);
                const Aabb<float> now = scene.box(number, frame);
                EXPECT_LT((now.min() - before.min()).cwiseAbs().maxCoeff(), 0.5F);
                EXPECT_FALSE(hasNan(now));
                EXPECT_TRUE(isSameBits(now, scene.box(number, frame)));
            }
        }
    }
}

TEST(SwarmScene, HasHalfAPairForEachSphereWhereTheyAreSpreadEvenly) {
    const std::uint64_t count = 4000;
    const SwarmScene scene(SwarmKind::uniform, count, 1);
    std::vector<Aabb<float>> boxes;
    for (std::uint64_t number = 0; number < count; ++number) {
        boxes.push_back(scene.box(number, 10));
    }
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < count; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            pairs += overlaps(boxes[a], boxes[b]) ? 1 : 0;
        }
    }
    EXPECT_NEAR(0.45 * count, static_cast<double>(pairs), 0.1 * count);
}

// Counted over all spheres, the plan is what ranks would do.
TEST(ScalingPlan, CountsFollowTheSurfaceLaw) {
    const MachineModel model;
    const auto small = planFrame(SwarmKind::uniform, 1, {100'000, 8}, model);
    const auto large = planFrame(SwarmKind::uniform, 1, {800'000, 8}, model);
    const auto more = planFrame(SwarmKind::uniform, 1, {800'000, 64}, model);
    EXPECT_DOUBLE_EQ(8 * small.objects, large.objects);
    // Eight times the volume has four times the surface; as many spheres a rank have as much, but for the border.
    EXPECT_NEAR(4, large.ghosts / small.ghosts, 0.5);
    EXPECT_GT(more.ghosts, small.ghosts);
    EXPECT_LT(more.ghosts, 3 * small.ghosts);
    EXPECT_EQ(7, small.mostMessages);
    EXPECT_GT(large.efficiency, small.efficiency);
    EXPECT_LT(large.efficiency, 1);
}

TEST(ScalingPlan, SaysWhereItStopsToScale) {
    std::vector<PlannedFrame> frames(3);
    for (std::uint32_t i = 0; i < 3; ++i) {
        frames[i].size = {1'000'000, 64U << i};
    }
    const auto with = [&](double first, double second, double third) {
        frames[0].efficiency = first;
        frames[1].efficiency = second;
        frames[2].efficiency = third;
        return planSentences(frames).at(0);
    };
    EXPECT_NE(std::string::npos, with(0.9, 0.6, 0.4).find("on up to 128 ranks"));
    EXPECT_NE(std::string::npos, with(0.9, 0.8, 0.7).find("on all these"));
    EXPECT_NE(std::string::npos, with(0.4, 0.3, 0.2).find("on none of these"));
}

}  // namespace
}  // namespace hashphase::demos
