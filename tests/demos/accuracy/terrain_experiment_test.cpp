// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/exact_ground.hpp>
#include <demos/accuracy/terrain/terrain_experiment.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

const TerrainPlan kTinyTerrain{.spheres = 3, .points = 100, .frames = 2, .spheresPerFrame = 20};

// Another one's work, but for a change of what it finds for each eighth sphere.
class Changed final : public GroundFinder {
public:
    using Change = std::function<void(std::optional<Standing>&)>;

    Changed(std::unique_ptr<GroundFinder> inner, Change change)
        : inner_(std::move(inner)), change_(std::move(change)) {}

    void find(const SphereBatch& spheres, std::span<std::optional<Standing>> found) override {
        inner_->find(spheres, found);
        for (std::size_t i = 0; i < found.size(); i += 8) {
            change_(found[i]);
        }
    }

private:
    std::unique_ptr<GroundFinder> inner_;
    Change change_;
};

Findings findWith(std::span<const GroundMethod> methods) {
    return findTerrain(kTinyTerrain, 1, methods, [](double, std::string_view) {});
}

// The first of the methods that has the quality, changed.
Findings findChanged(bool GroundMethod::*quality, const Changed::Change& change) {
    std::vector<GroundMethod> methods = groundMethods();
    GroundMethod& method =
        *std::find_if(methods.begin(), methods.end(),
                      [quality](const GroundMethod& each) { return each.*quality; });
    method.make = [make = method.make, change](const GroundMesh& mesh, float cellSize) {
        return std::make_unique<Changed>(make(mesh, cellSize), change);
    };
    return findWith(std::span(&method, 1));
}

void raise(std::optional<Standing>& standing, float by) {
    if (standing) {
        standing->height += by;
    }
}

TEST(TerrainExperiment, FindsThatOurSpheresTouchTheGroundAndThePapersSinkByTheLine) {
    const std::vector<GroundMethod> methods = groundMethods();
    const Findings findings = findWith(methods);
    ASSERT_EQ(findings.checks.size(), 7U);
    for (const Check& check : findings.checks) {
        EXPECT_TRUE(check.holds) << check.claim << ": " << check.evidence;
    }
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(TerrainExperiment, NoticesSpheresInTheGroundAndAboveIt) {
    for (const float by : {-0.01F, 0.01F}) {
        const Findings findings = findChanged(
            &GroundMethod::mustRest, [by](std::optional<Standing>& found) { raise(found, by); });
        ASSERT_EQ(findings.checks.size(), 2U);
        EXPECT_FALSE(findings.checks[0].holds);
        EXPECT_TRUE(findings.checks[1].holds);
    }
}

TEST(TerrainExperiment, NoticesGroundThatIsNotFound) {
    const Findings findings =
        findChanged(&GroundMethod::mustRest, [](std::optional<Standing>& found) { found.reset(); });
    ASSERT_EQ(findings.checks.size(), 2U);
    EXPECT_FALSE(findings.checks[1].holds);
}

TEST(TerrainExperiment, NoticesAWrongTriangle) {
    const Findings findings =
        findChanged(&GroundMethod::mustRest, [](std::optional<Standing>& found) {
            if (found) {
                found->triangle ^= 64;
            }
        });
    ASSERT_EQ(findings.checks.size(), 2U);
    EXPECT_FALSE(findings.checks[1].holds);
}

TEST(TerrainExperiment, NoticesWhatLeavesTheLineOfTheory) {
    const Findings findings = findChanged(
        &GroundMethod::sinksByLine, [](std::optional<Standing>& found) { raise(found, 0.1F); });
    ASSERT_EQ(findings.checks.size(), 1U);
    EXPECT_FALSE(findings.checks[0].holds);
}

TEST(ExactGround, KnowsWhereASphereRestsOnASlopeAndOnAnEdge) {
    const ExactGround slope(GroundMesh([](float x, float) { return x; }, 0, 1));
    EXPECT_NEAR(slope.restingHeight(3.3F, 0.2F, 0.5F), 3.3F + 0.5 * std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(slope.penetration(3.3F, 3.3F + 0.5, 0.2F, 0.5F), 0.5 * (1 - std::sqrt(0.5)), 1e-6);
    EXPECT_NEAR(slope.penetration(0.5F, -0.5, 0.5F, 0.5F), 0.5 + std::sqrt(0.5), 1e-6);  // below
    const ExactGround roof(GroundMesh([](float x, float) { return -std::abs(x); }, 0, 1));
    EXPECT_NEAR(roof.restingHeight(0, 0.2F, 0.5F), 0.5, 1e-6);
    EXPECT_NEAR(*roof.surface(-2.5F, 0.2F), -2.5, 1e-6);
    EXPECT_FALSE(roof.surface(100, 0));
    EXPECT_TRUE(roof.isAt(0, -GroundMesh::kHalf, -GroundMesh::kHalf));
    EXPECT_FALSE(roof.isAt(0, 0, 0));
}

}  // namespace
}  // namespace hashphase::demos
