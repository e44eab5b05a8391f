// SPDX-License-Identifier: Zlib
//
// The exact answers and the scenes of the experiments.

#include <demos/accuracy/culling/culling_experiment.hpp>
#include <demos/accuracy/origin/origin_experiment.hpp>
#include <demos/accuracy/pairs/pair_experiments.hpp>
#include <demos/accuracy/picking/cell_walks.hpp>
#include <demos/accuracy/picking/picking_experiment.hpp>
#include <demos/accuracy/proximity/proximity_experiment.hpp>
#include <demos/accuracy/sweeps/sweep_experiment.hpp>
#include <demos/accuracy/terrain/terrain_experiment.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

// The camera stands at the origin and looks along -z, 90 degrees high.
TEST(ExactFrustum, SeesWhatTouchesTheViewAndNoMore) {
    CameraPose pose;
    pose.fieldOfView = 1.5707963F;
    const ExactFrustum frustum(cameraView(pose));
    const auto box = [](Vector3<float> low, Vector3<float> high) { return Aabb<float>(low, high); };
    EXPECT_TRUE(frustum.sees(box({-1, -1, -12}, {1, 1, -10})));            // wholly inside
    EXPECT_TRUE(frustum.sees(box({-900, -900, -900}, {900, 900, 900})));   // all around
    EXPECT_TRUE(frustum.sees(box({-900, -0.5F, -11}, {900, 0.5F, -10})));  // across
    EXPECT_TRUE(frustum.sees(box({-1, 9.99F, -10}, {1, 20, -9})));         // over the upper edge
    EXPECT_FALSE(frustum.sees(box({-1, 10.01F, -10}, {1, 20, -9})));       // just above
    EXPECT_FALSE(frustum.sees(box({-1, -1, 1}, {1, 1, 2})));               // behind
    EXPECT_FALSE(frustum.sees(box({-1, -1, -500}, {1, 1, -401})));         // too far
    // Near the corner of the upper and the far plane, which none of them alone has outside.
    EXPECT_FALSE(frustum.sees(box({-900, 450, -900}, {-600, 800, -350})));
}

TEST(OriginScene, TellsExactlyWhetherARayMeetsABox) {
    const IntegerBox box{{0, 0, 0}, {2, 2, 2}};
    EXPECT_TRUE(meetExactly({{-5, 0, 0}, {5, 0, 0}}, box));
    EXPECT_TRUE(meetExactly({{-5, 2, 2}, {5, 2, 2}}, box));   // along an edge
    EXPECT_TRUE(meetExactly({{0, 4, 0}, {4, 0, 0}}, box));    // through an edge, at (2, 2, 0)
    EXPECT_FALSE(meetExactly({{0, 5, 0}, {4, 0, 0}}, box));   // past it
    EXPECT_TRUE(meetExactly({{-5, 0, 0}, {-2, 0, 0}}, box));  // ends on a face
    EXPECT_FALSE(meetExactly({{-5, 0, 0}, {-3, 0, 0}}, box));
    EXPECT_TRUE(meetExactly({{1, 1, 1}, {1, 1, 1}}, box));
    EXPECT_FALSE(meetExactly({{3, 1, 1}, {3, 1, 1}}, box));
}

TEST(PaperGrid, MissesByCornersOnlyWhatLiesInTheMiddleOfALargeBox) {
    // The large one spans cells 0 to 2, the small one lies in cell 1.
    const std::vector<BulletBox> boxes{{{0, 0, 0}, {2.5F, 0.5F, 0.5F}},
                                       {{1.2F, 0.2F, 0.2F}, {1.4F, 0.4F, 0.4F}},
                                       {{2.1F, 0.2F, 0.2F}, {2.3F, 0.4F, 0.4F}}};
    const auto pairsBy = [&](FiledCells filed) {
        const PairSource source = paperGridMethod("paper", 1, filed).make({}, boxes);
        source.step(boxes);
        std::vector<PairKey> pairs;
        source.listPairs(pairs);
        return pairs;
    };
    EXPECT_EQ(pairsBy(FiledCells::kAll), (std::vector<PairKey>{pairKey(0, 1), pairKey(0, 2)}));
    EXPECT_EQ(pairsBy(FiledCells::kCorners), (std::vector<PairKey>{pairKey(0, 2)}));
    EXPECT_EQ(filedCellCount(boxes, 1), 5);
}

TEST(ExactRay, TellsTouchingFromPassingByOneStepOfTheLattice) {
    const Aabb<float> box(Vector3<float>(1, 1, 1), Vector3<float>(2, 2, 2));
    const auto entryAt = [&](float x) {
        return ExactRay({x, 3, 1.5F}, {x + 2, 1, 1.5F}).entry(box);  // over the edge x = y = 2
    };
    EXPECT_EQ(entryAt(1), (Fraction{1, 2}));
    EXPECT_TRUE(entryAt(1 - kLattice));
    EXPECT_FALSE(entryAt(1 + kLattice));
    EXPECT_THROW(ExactRay({kLattice / 2, 0, 0}, {1, 1, 1}), std::logic_error);
}

TEST(GrazingRay, PassesAtExactlyTheOffset) {
    Random random(7);
    const std::vector<Aabb<float>> boxes = slabOfBoxes(50, 7);
    for (const Contact contact : kContacts) {
        for (const int ulps : {-5, -1, 0, 1, 5}) {
            for (const Aabb<float>& box : boxes) {
                const Ray ray = grazingRay(box, contact, ulps, random);
                EXPECT_EQ(ExactRay(ray.from, ray.to).entry(box).has_value(), ulps <= 0);
            }
        }
    }
}

// The ray runs through the corner of four cells.
TEST(CellWalks, LayersHaveAllCellsAtACorner) {
    std::vector<Cell> cells;
    walkLayers({0.5F, 1.5F, 0.5F}, {1.5F, 0.5F, 0.5F},
               [&](const Cell& cell) { cells.push_back(cell); });
    for (const Cell& cell : {Cell{0, 1, 0}, Cell{1, 1, 0}, Cell{0, 0, 0}, Cell{1, 0, 0}}) {
        EXPECT_NE(std::find(cells.begin(), cells.end(), cell), cells.end());
    }
}

TEST(CellWalks, EndsInTheLastCellHoweverBordersAreTimed) {
    for (const BorderTimes times : {BorderTimes::accumulated, BorderTimes::multiplied}) {
        std::vector<Cell> cells;
        walkFaces({0.5F, 0.5F, 0.5F}, {-2.5F, 3.25F, 0.5F}, times,
                  [&](const Cell& cell) { cells.push_back(cell); });
        EXPECT_EQ(cells.front(), (Cell{0, 0, 0}));
        EXPECT_EQ(cells.back(), (Cell{-3, 3, 0}));
        EXPECT_EQ(cells.size(), 7U);
    }
}

TEST(AgentScene, KeepsPlacesThatSinglePrecisionHoldsExactly) {
    AgentPlan plan;
    plan.agents = 100;
    plan.side = 50;
    plan.step = 1;
    AgentScene scene(plan, 1);
    for (int frame = 0; frame < 20; ++frame) {
        scene.advance();
        for (const Aabb<float>& box : scene.boxes()) {
            EXPECT_TRUE(scene.bounds().contains(box));
            const Vector3<float> place = 256 * box.center();
            EXPECT_EQ(place, place.array().round().matrix());
            EXPECT_EQ(place.y(), 0);
        }
    }
}

TEST(SweepTruth, IsWhatOneComputesByHand) {
    SweptFrame frame;
    frame.movers = 1;
    const Vector3<float> one(1, 1, 1);
    frame.objects = {{{Vector3<float>(0, 0, 0), one}, Vector3<float>(8, 0, 0)},
                     {{Vector3<float>(4, 1, 0), Vector3<float>(5, 2, 1)}},     // at 3/8
                     {{Vector3<float>(4, 1.5F, 0), Vector3<float>(5, 2, 1)}},  // passed
                     {{Vector3<float>(9, 0, 0), Vector3<float>(10, 1, 1)}},    // at the last moment
                     {{Vector3<float>(-1, 0, 0), Vector3<float>(0, 1, 1)}}};   // at the first
    const SweepTruth truth = findTruth(frame);
    EXPECT_EQ(truth.contacts, (std::vector<PairKey>{pairKey(0, 1), pairKey(0, 3)}));
    EXPECT_EQ(truth.older, std::vector<PairKey>{pairKey(0, 4)});
    EXPECT_EQ(truth.moments, (std::vector<Fraction>{{3, 8}, {1, 1}}));
    EXPECT_EQ(truth.moments[0].errorOf(0.5), 0.125);
    frame.objects[1].box.min().x() += 0x1p-12F;
    EXPECT_THROW(static_cast<void>(exactContact(frame, 0, 1)), std::logic_error);
}

TEST(ExactGround, KnowsWhereASphereRestsOnASlopeAndOnAnEdge) {
    const ExactGround slope(groundOfHeights([](float x, float) { return x; }));
    EXPECT_NEAR(slope.restingHeight(3.3F, 0.2F, 0.5F), 3.3F + 0.5 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(slope.penetration(3.3F, 3.3F + 0.5, 0.2F, 0.5F), 0.5 * (1 - std::sqrt(0.5)), 1e-6);
    EXPECT_NEAR(slope.penetration(0.5F, -0.5, 0.5F, 0.5F), 0.5 + std::sqrt(0.5), 1e-6);  // below
    const ExactGround roof(groundOfHeights([](float x, float) { return -std::abs(x); }));
    EXPECT_NEAR(roof.restingHeight(0, 0.2F, 0.5F), 0.5, 1e-6);
    EXPECT_NEAR(*roof.surface(-2.5F, 0.2F), -2.5, 1e-6);
    EXPECT_FALSE(roof.surface(100, 0));
    EXPECT_TRUE(roof.isAt(0, -kGroundHalf, -kGroundHalf));
    EXPECT_FALSE(roof.isAt(0, 0, 0));
}

}  // namespace
}  // namespace hashphase::demos
