// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/agent_scene.hpp>
#include <demos/accuracy/proximity/proximity_experiment.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace hashphase::demos {
namespace {

ProximityPlan tinyProximity() {
    ProximityPlan plan;
    plan.crowds = {{"a few agents", 300, 5}, {"a few agents", 300, 5, 5, 4, false}};
    plan.rounds = 2;
    plan.statedEstimates = 100;
    return plan;
}

Findings measureWith(std::span<const NeighbourMethod> methods) {
    return measureProximity(tinyProximity(), methods, 1, ignoreProgress);
}

/// Leaves out the last neighbour of each agent, in lists and decisions.
class ForgetfulSearch : public NeighbourSearch {
public:
    explicit ForgetfulSearch(std::unique_ptr<NeighbourSearch> search)
        : search_(std::move(search)) {}

    void take(const AgentFrame& frame) override { search_->take(frame); }
    void forEach(Visit visit) override {
        search_->forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
            visit(agent, neighbours.first(std::max<std::size_t>(neighbours.size(), 1) - 1));
        });
    }

private:
    std::unique_ptr<NeighbourSearch> search_;
};

/// Of the first method that promises that.
std::vector<std::string> brokenWithForgetful(NeighbourPromise promise) {
    std::vector<NeighbourMethod> methods = neighbourMethods();
    const auto chosen = std::find_if(methods.begin(), methods.end(),
                                     [&](const auto& method) { return method.promise == promise; });
    chosen->make = [make = chosen->make](const NeighbourNeeds& needs) {
        return std::make_unique<ForgetfulSearch>(make(needs));
    };
    return brokenClaims(measureWith(methods));
}

TEST(ProximityExperiment, HoldsForEveryMethod) {
    const Findings findings = measureWith(neighbourMethods());
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    expectChartsCanBeDrawn(findings);
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(ProximityExperiment, NoticesAMethodThatForgetsANeighbour) {
    using enum NeighbourPromise;
    for (const auto& [promise, claim] : {std::pair{kExact, "Exact ways find"},
                                         {kComplete, "Cells, with"},
                                         {kEstimate, "Cells, with"}}) {
        const std::vector<std::string> broken = brokenWithForgetful(promise);
        ASSERT_EQ(broken.size(), 1U);
        EXPECT_TRUE(broken.front().starts_with(claim)) << broken.front();
    }
}

TEST(ProximityExperiment, RefusesASquareThatIsTooSmallForTheCells) {
    ProximityPlan plan = tinyProximity();
    plan.crowds.front().radiusByCell = 0.1;
    EXPECT_THROW(static_cast<void>(measureProximity(plan, neighbourMethods(), 1, ignoreProgress)),
                 std::invalid_argument);
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

}  // namespace
}  // namespace hashphase::demos
