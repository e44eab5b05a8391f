// SPDX-License-Identifier: Zlib
#include <demos/accuracy/exact_entry.hpp>
#include <demos/accuracy/picking/cell_walks.hpp>
#include <demos/accuracy/picking/picking_experiment.hpp>
#include <demos/accuracy/picking/ray_scenes.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

const PickingPlan kTinyPicking{.boxes = 200,
                               .graze = 4,
                               .frames = 2,
                               .raysPerFrame = 5,
                               .strungBoxes = 100,
                               .longestPower = 4,
                               .metresInAll = 1e4,
                               .longestCellWalk = 1e3};

/// Which checks hold of the library's rays when what they find is changed.
template <class Change>
std::vector<bool> holdsWhenChanged(const Change& change) {
    std::vector<RayMethod> methods = rayMethods();
    std::erase_if(methods,
                  [](const RayMethod& each) { return !each.isOurs || each.findsNearestOnly; });
    methods.front().make = [=, make = methods.front().make](std::span<const Aabb<float>> boxes) {
        return [=, cast = make(boxes)](const Ray& ray, std::vector<RayHit>& hits) {
            const RayCost cost = cast(ray, hits);
            change(hits);
            return cost;
        };
    };
    std::vector<bool> holds;
    for (const Check& check : findPicking(kTinyPicking, 1, methods, ignoreProgress).checks) {
        holds.push_back(check.holds);
    }
    return holds;
}

TEST(PickingExperiment, FindsThatConservativeMethodsMissNothing) {
    const Findings findings = findPicking(kTinyPicking, 1, rayMethods(), ignoreProgress);
    EXPECT_EQ(findings.checks.size(), 6U);
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    EXPECT_EQ(findings.charts.size(), 7U);
    expectChartsCanBeDrawn(findings);
    EXPECT_EQ(findings.choices.size(), 17U);
    EXPECT_EQ(findings.conclusions.size(), 9U);
}

TEST(PickingExperiment, NoticesAHitThatIsMissedAndAWrongNearestHit) {
    EXPECT_EQ(holdsWhenChanged([](std::vector<RayHit>&) {}), (std::vector{true, true}));
    int number = 0;
    EXPECT_FALSE(holdsWhenChanged([&](std::vector<RayHit>& hits) {
                     if (++number % 8 == 0 && !hits.empty()) {
                         hits.pop_back();
                     }
                 }).front());
    EXPECT_EQ(holdsWhenChanged([](std::vector<RayHit>& hits) {
                  for (RayHit& hit : hits) {
                      hit.fraction = 1 - hit.fraction;
                  }
              }),
              (std::vector{true, false}));
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

}  // namespace
}  // namespace hashphase::demos
