// SPDX-License-Identifier: Zlib
#include <demos/scenes/scatter.hpp>

#include <demos/compare/reference_pairs.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace hashphase::demos {
namespace {

bool sameBodies(const BrownianBoxes& a, const BrownianBoxes& b) {
    return std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), b.bodies.end(),
                      [](const BrownianBoxes::Body& left, const BrownianBoxes::Body& right) {
                          return left.centre == right.centre && left.halfEdges == right.halfEdges &&
                                 left.step == right.step;
                      });
}

double overlapsPerBox(const ScatterPlan& plan, std::size_t objects, std::uint64_t seed) {
    const BrownianScene scene(scatter(plan, objects, seed), seed);
    std::vector<PairKey> pairs;
    findExactPairs(ReferenceMethod::kSweep, scene.boxes(), {}, pairs);
    return 2.0 * static_cast<double>(pairs.size()) / static_cast<double>(objects);
}

std::vector<ScatterPlan> allKindsOfPlans() {
    std::vector<ScatterPlan> plans;
    for (const SizeLaw sizes :
         {SizeLaw::equal, SizeLaw::near, SizeLaw::logUniform, SizeLaw::fewLarge}) {
        for (const Placement placement : {Placement::cube, Placement::plain, Placement::clusters}) {
            ScatterPlan plan;
            plan.sizes = sizes;
            plan.sizeRatio = 20;
            plan.placement = placement;
            plan.movingShare = 0.5F;
            plans.push_back(plan);
        }
    }
    return plans;
}

TEST(Scatter, DependsOnPlanNumberAndSeedAlone) {
    for (const ScatterPlan& plan : allKindsOfPlans()) {
        EXPECT_TRUE(sameBodies(scatter(plan, 500, 1), scatter(plan, 500, 1))) << describe(plan);
        EXPECT_FALSE(sameBodies(scatter(plan, 500, 1), scatter(plan, 500, 2))) << describe(plan);
    }
}

TEST(Scatter, IsAboutAsDenseAsPlanned) {
    for (ScatterPlan plan : allKindsOfPlans()) {
        plan.overlapsPerBox = 3;
        // A box at a border has fewer neighbours than one in the middle, a large one many fewer.
        const double overlaps = overlapsPerBox(plan, 4000, 1);
        EXPECT_GT(overlaps, 1.5) << describe(plan);
        EXPECT_LT(overlaps, 4.5) << describe(plan);
    }
}

TEST(Scatter, MovesThePlannedShareWithinItsRooms) {
    ScatterPlan plan;
    plan.placement = Placement::clusters;
    plan.movingShare = 0.25F;
    BrownianScene scene(scatter(plan, 4000, 1), 1);
    const std::vector<Aabb<float>> before = scene.boxes();
    for (int frame = 0; frame < 50; ++frame) {
        scene.advance();
    }
    int moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        moved += isSameBits(before[i], scene.boxes()[i]) ? 0 : 1;
        ASSERT_TRUE(scene.bounds().contains(scene.boxes()[i]));
    }
    EXPECT_NEAR(moved, 1000, 100);
}

TEST(RandomScenes, DependOnTheSeedAloneAndDiffer) {
    std::set<std::string> descriptions;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const RandomScene drawn = drawScene(seed);
        EXPECT_EQ(describe(drawn.plan), describe(drawScene(seed).plan));
        EXPECT_EQ(drawn.objects, drawScene(seed).objects);
        EXPECT_GE(drawn.objects, 299U);
        EXPECT_LE(drawn.objects, 50'000U);
        EXPECT_LE(drawn.plan.movingShare, 1);
        descriptions.insert(describe(drawn.plan));
    }
    EXPECT_GE(descriptions.size(), 39U);
}

}  // namespace
}  // namespace hashphase::demos
