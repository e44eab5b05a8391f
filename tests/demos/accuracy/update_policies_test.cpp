// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/update_policies.hpp>
#include <tests/demos/accuracy/broken_pairs.hpp>
#include <tests/demos/accuracy/findings_checks.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

UpdatePlan tinyUpdates() {
    UpdatePlan plan;
    plan.objects = 200;
    plan.motions = {{0}, {0.05}, {1}, {1, 0.2}};
    plan.judgedFrames = 8;
    plan.rounds = 2;
    return plan;
}

Findings measureWith(std::span<const PairMethod> policies) {
    return measurePolicies(tinyUpdates(), policies, 1, ignoreProgress);
}

std::vector<std::string> brokenWith(Flaw flaw, bool isExact) {
    std::vector<PairMethod> policies = updatePolicies();
    for (PairMethod& policy : policies) {
        if (policy.isExact == isExact && policy.isComplete) {
            policy = broken(flaw, policy);
            break;
        }
    }
    return brokenClaims(measureWith(policies));
}

TEST(UpdateExperiment, HoldsForEveryPolicy) {
    const Findings findings = measureWith(updatePolicies());
    EXPECT_EQ(brokenClaims(findings), std::vector<std::string>{});
    expectChartsCanBeDrawn(findings);
    EXPECT_FALSE(findings.choices.empty());
    EXPECT_FALSE(findings.conclusions.empty());
}

TEST(UpdateExperiment, NoticesAnExactPolicyThatInventsAPair) {
    EXPECT_EQ(brokenWith(Flaw::kInventsOne, true).size(), 1U);
}

TEST(UpdateExperiment, NoticesAPolicyThatMissesAPairEvenWhereNothingMoves) {
    EXPECT_EQ(brokenWith(Flaw::kMissesOne, true).size(), 2U);
    EXPECT_EQ(brokenWith(Flaw::kMissesOne, false).size(), 2U);
}

}  // namespace
}  // namespace hashphase::demos
