// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/cell_walks.hpp>
#include <demos/accuracy/picking/exact_ray.hpp>
#include <demos/accuracy/picking/picking_experiment.hpp>

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

// Another one's work, but for a change of what is found.
class Changed final : public RayCaster {
public:
    using Change = std::function<void(std::vector<RayHit>&)>;

    Changed(std::unique_ptr<RayCaster> inner, Change change)
        : inner_(std::move(inner)), change_(std::move(change)) {}

    RayCost cast(const Ray& ray, std::vector<RayHit>& hits) override {
        const RayCost cost = inner_->cast(ray, hits);
        change_(hits);
        return cost;
    }

private:
    std::unique_ptr<RayCaster> inner_;
    Change change_;
};

// The library's rays, changed.
Findings findChanged(const Changed::Change& change) {
    RayMethod method = treeRayMethods().front();
    method.make = [make = method.make, change](std::span<const Aabb<float>> boxes) {
        return std::make_unique<Changed>(make(boxes), change);
    };
    return findPicking(kTinyPicking, 1, std::span(&method, 1), [](double, std::string_view) {});
}

TEST(PickingExperiment, FindsThatConservativeMethodsMissNothing) {
    const Findings findings =
        findPicking(kTinyPicking, 1, rayMethods(), [](double, std::string_view) {});
    ASSERT_EQ(findings.checks.size(), 6U);
    for (const Check& check : findings.checks) {
        EXPECT_TRUE(check.holds) << check.claim << ": " << check.evidence;
    }
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(PickingExperiment, NoticesAHitThatIsMissed) {
    int number = 0;
    const Findings findings = findChanged([number](std::vector<RayHit>& hits) mutable {
        if (++number % 8 == 0 && !hits.empty()) {
            hits.pop_back();
        }
    });
    ASSERT_EQ(findings.checks.size(), 2U);
    EXPECT_FALSE(findings.checks[0].holds);
}

TEST(PickingExperiment, NoticesAWrongNearestHit) {
    const Findings findings = findChanged([](std::vector<RayHit>& hits) {
        for (RayHit& hit : hits) {
            hit.fraction = 1 - hit.fraction;
        }
    });
    ASSERT_EQ(findings.checks.size(), 2U);
    EXPECT_TRUE(findings.checks[0].holds);
    EXPECT_FALSE(findings.checks[1].holds);
}

TEST(ExactRay, TellsTouchingFromPassingByOneStepOfTheLattice) {
    const Aabb<float> box(Vector3<float>(1, 1, 1), Vector3<float>(2, 2, 2));
    const auto entryAt = [&](float x) {
        return ExactRay({x, 3, 1.5F}, {x + 2, 1, 1.5F}).entry(box);  // over the edge x = y = 2
    };
    ASSERT_TRUE(entryAt(1));
    EXPECT_EQ(*entryAt(1), Fraction(1, 2));
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
