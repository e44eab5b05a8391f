// SPDX-License-Identifier: Zlib
#include <demos/compare/reference_pairs.hpp>
#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/paper_scene.hpp>
#include <demos/scenes/scatter.hpp>
#include <demos/scenes/world_scenes.hpp>
#include <tests/demos/bullet_file.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

namespace hashphase::demos {
namespace {

constexpr std::uint64_t kSeed = 3;

std::unique_ptr<BoxScene> makeScene(std::string_view name, std::size_t objects,
                                    std::uint64_t seed = kSeed) {
    for (const BoxSceneKind& kind : boxSceneKinds()) {
        if (kind.name == name) {
            return kind.make(objects, seed);
        }
    }
    ADD_FAILURE() << "no scene " << name;
    return nullptr;
}

double overlapsPerBox(const BoxScene& scene) {
    std::vector<PairKey> pairs;
    findExactPairs(ReferenceMethod::kSweep, scene.boxes(), {}, pairs);
    return 2.0 * static_cast<double>(pairs.size()) / static_cast<double>(scene.boxes().size());
}

bool sameBoxes(const BoxScene& a, const BoxScene& b) {
    return std::equal(a.boxes().begin(), a.boxes().end(), b.boxes().begin(), b.boxes().end(),
                      [](const Aabb<float>& left, const Aabb<float>& right) {
                          return left.min() == right.min() && left.max() == right.max();
                      });
}

int movedSince(const std::vector<Aabb<float>>& before, const BoxScene& scene) {
    int moved = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        moved += isSameBits(before[i], scene.boxes()[i]) ? 0 : 1;
    }
    return moved;
}

const auto nameOf = [](const auto& kind) {
    std::string name(kind.param.name);
    std::erase(name, '-');
    return name;
};

class EveryBoxScene : public testing::TestWithParam<BoxSceneKind> {};

TEST_P(EveryBoxScene, DependsOnTheSeedAlone) {
    const auto first = GetParam().make(500, 1);
    const auto again = GetParam().make(500, 1);
    const auto other = GetParam().make(500, 2);
    for (int frame = 0; frame < 20; ++frame) {
        EXPECT_TRUE(sameBoxes(*first, *again)) << frame;
        EXPECT_FALSE(sameBoxes(*first, *other)) << frame;
        first->advance();
        again->advance();
        other->advance();
    }
}

TEST_P(EveryBoxScene, StaysInItsBoundsAndMoves) {
    const auto scene = GetParam().make(500, kSeed);
    const auto start = GetParam().make(500, kSeed);
    ASSERT_EQ(scene->boxes().size(), 500U);
    ASSERT_TRUE(scene->filters().empty() || scene->filters().size() == 500U);
    for (int frame = 0; frame < 300; ++frame) {
        for (const Aabb<float>& box : scene->boxes()) {
            ASSERT_TRUE(scene->bounds().contains(box)) << frame;
        }
        scene->advance();
    }
    EXPECT_FALSE(sameBoxes(*scene, *start));
}

TEST_P(EveryBoxScene, MakesDoWithOneObject) {
    const auto scene = GetParam().make(1, kSeed);
    scene->advance();
    ASSERT_EQ(scene->boxes().size(), 1U);
    EXPECT_FALSE(hasNan(scene->boxes()[0]));
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryBoxScene,
                         testing::ValuesIn(boxSceneKinds().begin(), boxSceneKinds().end()), nameOf);

TEST(PaperScene, HasSpheresOfRadiusOneThatTouchTheGround) {
    const PaperScene scene(200, kSeed);
    const Terrain terrain(kSeed);
    for (const Aabb<float>& box : scene.boxes()) {
        EXPECT_TRUE(box.sizes().isApproxToConstant(2, 1e-4F));
        const Vector3<float> centre = box.center();
        EXPECT_NEAR(box.min().y(), terrain.height(centre.x(), centre.z()), 1e-3F);
    }
    EXPECT_EQ(scene.ground()(30, 50), terrain.height(30, 50));
    EXPECT_EQ(scene.bounds().sizes().x(), 400);
    EXPECT_EQ(scene.bounds().sizes().z(), 400);
}

TEST(PaperScene, WalksAtFiveToFifteenMetresASecond) {
    PaperScene scene(200, kSeed);
    const std::vector<Aabb<float>> before = scene.boxes();
    scene.advance();
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vector3<float> move = scene.boxes()[i].center() - before[i].center();
        const float speed = 60 * std::hypot(move.x(), move.z());
        EXPECT_LE(speed, 15.01F);
        // A bounce cuts a step short.
        const bool atBorder =
            scene.boxes()[i].min().x() < 0.01F || scene.boxes()[i].min().z() < 0.01F ||
            scene.boxes()[i].max().x() > 399.99F || scene.boxes()[i].max().z() > 399.99F;
        EXPECT_TRUE(atBorder || speed >= 4.99F) << speed;
    }
}

TEST(TerdimanScene, BeginsWithThePublishedNumberOfPairs) {
    const auto pairsOf = [](std::size_t objects) {
        std::vector<PairKey> pairs;
        findExactPairs(ReferenceMethod::kSweep, makeScene("terdiman", objects, 1)->boxes(), {},
                       pairs);
        return pairs.size();
    };
    EXPECT_EQ(pairsOf(10'000), 11'811U);
    EXPECT_EQ(pairsOf(100'000), 1'144'045U);
}

TEST(MovingScenes, MoveTheSameSharesAlwaysAsTheirNamesTellAndNothingStatic) {
    for (const auto& [name, share] : {std::pair("moving-5", 0.05), std::pair("moving-2", 0.02),
                                      std::pair("static-90", 0.1), std::pair("resting", 0.02)}) {
        const auto scene = makeScene(name, 1000);
        const std::vector<Aabb<float>> start = scene->boxes();
        for (int frame = 0; frame < 10; ++frame) {
            scene->advance();
            EXPECT_EQ(movedSince(start, *scene) / 1000.0, share) << name;
            for (std::size_t i = 0; i < start.size(); ++i) {
                EXPECT_TRUE(isSameBits(scene->boxes()[i], start[i]) ||
                            filterOf(*scene, i).group == CollisionFilter{}.group)
                    << "a static box moved";
            }
        }
    }
}

TEST(BroadmarkBoxes, FillATenthOfTheirRoomAndMoveByUpToTwoMetres) {
    const auto scene = makeScene("brownian", 8000);
    const float side = scene->bounds().sizes().x() - 1;
    EXPECT_NEAR(8000 / (side * side * side), 0.1, 1e-3);
    const std::vector<Aabb<float>> before = scene->boxes();
    scene->advance();
    float farthest = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        farthest = std::max(farthest, (scene->boxes()[i].center() - before[i].center()).norm());
    }
    EXPECT_LE(farthest, 2.001F);
    EXPECT_GE(farthest, 1.5F);
}

TEST(Terrain, IsContinuousAndWithinItsHeights) {
    const Terrain terrain(kSeed);
    float lowest = Terrain::kHighest;
    float highest = 0;
    for (float x = -50; x < 50; x += 0.25F) {
        const float here = terrain.height(x, 2 * x);
        EXPECT_NEAR(terrain.height(x + 0.01F, 2 * x), here, 0.02F);
        lowest = std::min(lowest, here);
        highest = std::max(highest, here);
    }
    EXPECT_GE(lowest, 0);
    EXPECT_LE(highest, Terrain::kHighest);
    EXPECT_GT(highest - lowest, 2) << "flat land";
}

TEST(BoxScenes, AreAsDenseAsTheySay) {
    for (const auto& [name, objects, overlaps, tolerance] : {std::tuple("uniform", 20'000, 2, 0.2),
                                                             {"piles", 5'000, 4, 1.5},
                                                             {"logsizes", 20'000, 4, 0.8}}) {
        EXPECT_NEAR(overlapsPerBox(*makeScene(name, objects)), overlaps, tolerance) << name;
    }
    EXPECT_GT(makeScene("piles", 5'000)->bounds().sizes().x(), 5'000) << "empty between piles";
}

TEST(LogSizesScene, HasSizesOfAllOrders) {
    const auto scene = makeScene("logsizes", 20'000);
    std::size_t small = 0;
    for (const Aabb<float>& box : scene->boxes()) {
        EXPECT_GT(box.sizes().minCoeff(), 0.099F);
        EXPECT_LT(box.sizes().maxCoeff(), 30.01F);
        small += box.sizes().x() < std::sqrt(0.1F * 30) ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(small), 10'000, 500) << "half are below the middle order";
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
        const auto make = [&plan](std::uint64_t seed) {
            return BrownianScene(scatter(plan, 500, seed), seed);
        };
        EXPECT_TRUE(sameBoxes(make(1), make(1))) << describe(plan);
        EXPECT_FALSE(sameBoxes(make(1), make(2))) << describe(plan);
    }
}

TEST(Scatter, IsAboutAsDenseAsPlanned) {
    for (ScatterPlan plan : allKindsOfPlans()) {
        plan.overlapsPerBox = 3;
        // A box at a border has fewer neighbours than one in the middle, a large one many fewer.
        const double overlaps = overlapsPerBox(BrownianScene(scatter(plan, 4000, 1), 1));
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
    EXPECT_NEAR(movedSince(before, scene), 1000, 100);
    for (const Aabb<float>& box : scene.boxes()) {
        ASSERT_TRUE(scene.bounds().contains(box));
    }
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

class EveryWorldScene : public testing::TestWithParam<WorldSceneKind> {};

TEST_P(EveryWorldScene, FillsTwoWorldsAlikeAndSteps) {
    SmallWorld first;
    SmallWorld second;
    WorldContents firstContents(first.world);
    WorldContents secondContents(second.world);
    GetParam().fill(firstContents, 120, kSeed);
    GetParam().fill(secondContents, 120, kSeed);
    const int objects = first.world.getNumCollisionObjects();
    ASSERT_EQ(second.world.getNumCollisionObjects(), objects);
    EXPECT_GE(objects, 121);
    for (int frame = 0; frame < 10; ++frame) {
        first.world.stepSimulation(btScalar(1) / 60, 0);
        second.world.stepSimulation(btScalar(1) / 60, 0);
    }
    int moved = 0;
    for (int i = 0; i < objects; ++i) {
        const btCollisionObject& a = *first.world.getCollisionObjectArray()[i];
        const btCollisionObject& b = *second.world.getCollisionObjectArray()[i];
        EXPECT_TRUE(a.getWorldTransform() == b.getWorldTransform()) << i;
        EXPECT_LT(a.getWorldTransform().getOrigin().length(), 1000);
        moved += a.getInterpolationLinearVelocity().length() > 0.01F ? 1 : 0;
    }
    EXPECT_GT(moved, 0);
}

TEST(BulletStorm, GoesOn) {
    SmallWorld small;
    WorldContents contents(small.world);
    const auto kinds = worldSceneKinds();
    std::ranges::find(kinds, "bullet-storm", &WorldSceneKind::name)->fill(contents, 200, kSeed);
    for (int frame = 0; frame < 1200; ++frame) {
        small.world.stepSimulation(btScalar(1) / 60, 0);
    }
    int fast = 0;
    int between = 0;
    for (const auto& body : contents.bodies()) {
        const btVector3& at = body->getWorldTransform().getOrigin();
        fast += body->getLinearVelocity().length() > 100 ? 1 : 0;
        between += !body->isStaticObject() && at.x() > 0 && at.x() < 60 && at.y() > 0 && at.y() < 8
                       ? 1
                       : 0;
    }
    EXPECT_GT(fast, 150);
    EXPECT_GT(between, 100);
}

TEST(WorldContents, TakeTheirActionsOutOfTheWorld) {
    struct Count : btActionInterface {
        explicit Count(int& steps) : count(&steps) {}
        void updateAction(btCollisionWorld* /*world*/, btScalar /*seconds*/) override { ++*count; }
        void debugDraw(btIDebugDraw* /*drawer*/) override {}
        int* count;
    };
    SmallWorld small;
    int steps = 0;
    {
        WorldContents contents(small.world);
        contents.addAction(std::make_unique<Count>(steps));
        small.world.stepSimulation(btScalar(1) / 60, 0);
        EXPECT_EQ(steps, 1);
    }
    small.world.stepSimulation(btScalar(1) / 60, 0);
    EXPECT_EQ(steps, 1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryWorldScene,
                         testing::ValuesIn(worldSceneKinds().begin(), worldSceneKinds().end()),
                         nameOf);

}  // namespace
}  // namespace hashphase::demos
