// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/terrain_experiment.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

const TerrainPlan kTinyTerrain{.spheres = 3, .points = 100, .frames = 2, .spheresPerFrame = 20};

/// Which checks hold of the first method with the quality when what it finds for each eighth sphere
/// is changed.
template <class Change>
std::vector<bool> holdsWhenChanged(bool GroundMethod::*quality, const Change& change) {
    std::vector<GroundMethod> methods = groundMethods();
    GroundMethod& method =
        *std::find_if(methods.begin(), methods.end(),
                      [quality](const GroundMethod& each) { return each.*quality; });
    method.make = [=, make = method.make](const GroundMesh& mesh, float cellSize) {
        return [=, find = make(mesh, cellSize)](const SphereBatch& spheres,
                                                std::span<std::optional<Standing>> found) {
            find(spheres, found);
            for (std::size_t i = 0; i < found.size(); i += 8) {
                change(found[i]);
            }
        };
    };
    std::vector<bool> holds;
    for (const Check& check :
         findTerrain(kTinyTerrain, 1, std::span(&method, 1), ignoreProgress).checks) {
        holds.push_back(check.holds);
    }
    return holds;
}

auto raising(float by) {
    return [by](std::optional<Standing>& standing) {
        if (standing) {
            standing->height += by;
        }
    };
}

TEST(TerrainExperiment, FindsThatOurSpheresTouchTheGroundAndThePapersSinkByTheLine) {
    const Findings findings = findTerrain(kTinyTerrain, 1, groundMethods(), ignoreProgress);
    EXPECT_EQ(findings.checks.size(), 7U);
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    EXPECT_EQ(findings.charts.size(), 4U);
    expectChartsCanBeDrawn(findings);
    EXPECT_EQ(findings.choices.size(), 21U);
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(TerrainExperiment, NoticesSpheresInTheGroundOrAboveItAndGroundThatIsNotFoundOrElsewhere) {
    for (const float by : {-0.01F, 0.01F}) {
        EXPECT_EQ(holdsWhenChanged(&GroundMethod::mustRest, raising(by)),
                  (std::vector{false, true}));
    }
    EXPECT_EQ(holdsWhenChanged(&GroundMethod::mustRest,
                               [](std::optional<Standing>& found) { found.reset(); }),
              (std::vector{true, false}));
    EXPECT_EQ(holdsWhenChanged(&GroundMethod::mustRest,
                               [](std::optional<Standing>& found) {
                                   if (found) {
                                       *found->triangle ^= 64;
                                   }
                               }),
              (std::vector{true, false}));
}

TEST(TerrainExperiment, NoticesWhatLeavesTheLineOfTheory) {
    EXPECT_EQ(holdsWhenChanged(&GroundMethod::sinksByLine, raising(0)), std::vector{true});
    EXPECT_EQ(holdsWhenChanged(&GroundMethod::sinksByLine, raising(0.1F)), std::vector{false});
}

TEST(ExactGround, KnowsWhereASphereRestsOnASlopeAndOnAnEdge) {
    const ExactGround slope(GroundMesh([](float x, float) { return x; }));
    EXPECT_NEAR(slope.restingHeight(3.3F, 0.2F, 0.5F), 3.3F + 0.5 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(slope.penetration(3.3F, 3.3F + 0.5, 0.2F, 0.5F), 0.5 * (1 - std::sqrt(0.5)), 1e-6);
    EXPECT_NEAR(slope.penetration(0.5F, -0.5, 0.5F, 0.5F), 0.5 + std::sqrt(0.5), 1e-6);  // below
    const ExactGround roof(GroundMesh([](float x, float) { return -std::abs(x); }));
    EXPECT_NEAR(roof.restingHeight(0, 0.2F, 0.5F), 0.5, 1e-6);
    EXPECT_NEAR(*roof.surface(-2.5F, 0.2F), -2.5, 1e-6);
    EXPECT_FALSE(roof.surface(100, 0));
    EXPECT_TRUE(roof.isAt(0, -GroundMesh::kHalf, -GroundMesh::kHalf));
    EXPECT_FALSE(roof.isAt(0, 0, 0));
}

}  // namespace
}  // namespace hashphase::demos
