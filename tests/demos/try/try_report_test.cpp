// SPDX-License-Identifier: Zlib

// What `hashphase try` makes of the steps that were recorded.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

TEST(TryReport, ProjectsWhatAStepTakes) {
    StepSummary stock;
    stock.updateAabbs = 4;
    stock.calculate = 2;
    stock.rays = 1;
    stock.step = 10;
    StepSummary ours;
    ours.updateAabbs = 0.5;
    ours.calculate = 1;
    ours.rays = 0.25;
    EXPECT_DOUBLE_EQ(projectedStep(stock, ours).value(), 10 - 7 + 1.75);
    stock.step.reset();
    EXPECT_FALSE(projectedStep(stock, ours).has_value());
}

TEST(TryReport, ComparesTheStepsThatBothRunsHave) {
    Trial trial;
    TriedRun run;
    tryout::StepRow row{};
    row.step = 2;
    row.calculations = 1;
    row.calculate = 1;
    row.pairCount = 10;
    run.rows.assign(100, row);
    trial.runs.push_back(run);
    run.broadphase = tryout::Broadphase::hash;
    row.step = 1;
    row.calculate = 0.25F;
    row.pairCount = 8;
    run.rows.assign(60, row);
    trial.runs.push_back(run);
    const StepComparison steps = compareSteps(trial).value();
    EXPECT_TRUE(steps.isCut);
    EXPECT_EQ(steps.stock.stepCount, 60U);
    EXPECT_EQ(steps.ours.stepCount, 60U);
    EXPECT_EQ(steps.stock.pairCount, 10);
    EXPECT_DOUBLE_EQ(projectedStep(steps.stock, steps.ours).value(), 2 - 1 + 0.25);
    trial.runs.back().rows.clear();
    EXPECT_FALSE(compareSteps(trial).has_value());
}

// Work that is not in every step counts, and parts add up.
TEST(TryReport, TakesMeans) {
    Trial trial;
    TriedRun run;
    for (int i = 0; i < 300; ++i) {
        tryout::StepRow row{};
        row.calculations = 1;
        row.rays = i % 3 == 0 ? 3.0F : 0.0F;
        row.step = 1 + row.rays;
        run.rows.push_back(row);
    }
    trial.runs.push_back(run);
    run.broadphase = tryout::Broadphase::hash;
    trial.runs.push_back(run);
    const StepSummary step = compareSteps(trial).value().stock;
    EXPECT_NEAR(step.rays, 1, 0.06);
    EXPECT_NEAR(step.step.value(), 1 + step.rays, 1e-6);
}

// Counts are those of all steps, and what the rare ones took is said.
TEST(TryReport, SaysWhenRareStepsTakeLong) {
    TriedRun run;
    tryout::StepRow row{};
    row.step = 1;
    row.calculations = 1;
    run.rows.assign(98, row);
    row.step = 50;
    row.rays = 40;
    row.rayCount = 200;
    run.rows.insert(run.rows.end(), 2, row);
    Trial trial;
    trial.runs.push_back(run);
    run.broadphase = tryout::Broadphase::hash;
    trial.runs.push_back(run);
    const StepSummary step = compareSteps(trial).value().stock;
    EXPECT_DOUBLE_EQ(step.step.value(), 1);
    EXPECT_DOUBLE_EQ(step.rayCount, 4);
    std::ostringstream out;
    printTrial(trial, out);
    EXPECT_TRUE(has(out.str(),
                    "without the slowest twentieth of the steps, which took 52 % of all time with "
                    "Bullet's and 52 % with hashphase: 20.6 and 20.6 ms a step"))
        << out.str();
}

TEST(TryReport, CountsPairsByTheCalculation) {
    TriedRun run;
    tryout::StepRow row{};
    row.step = 1;
    row.calculations = 1;
    row.pairCount = 10;
    row.truePairCount = 5;
    run.rows.push_back(row);
    row.calculations = 3;
    row.pairCount = 30;
    row.truePairCount = 15;
    run.rows.push_back(row);
    Trial trial;
    trial.runs.push_back(run);
    run.broadphase = tryout::Broadphase::hash;
    trial.runs.push_back(run);
    const StepSummary step = compareSteps(trial).value().stock;
    EXPECT_DOUBLE_EQ(step.pairCount, 10);
    EXPECT_DOUBLE_EQ(step.truePairCount.value(), 5);
}

std::string endsOf(const std::vector<RunEnd>& ends) {
    Trial trial;
    TriedRun run;
    for (const RunEnd& end : ends) {
        run.end = end;
        run.broadphase =
            trial.runs.size() % 2 == 0 ? tryout::Broadphase::stock : tryout::Broadphase::hash;
        trial.runs.push_back(run);
    }
    std::ostringstream out;
    printTrial(trial, out);
    return out.str();
}

TEST(TryReport, SaysAllEndsThatDiffer) {
    const RunEnd crash{.isCrash = true, .code = 11};
    const RunEnd one{.code = 1};
    const RunEnd ten{.code = 10};
    EXPECT_TRUE(has(endsOf({ten, crash, one, one}),
                    "The program ended with status 1 or ended with status 10 with Bullet's "
                    "broadphase, and ended with status 1 or was ended by signal 11"));
    EXPECT_TRUE(has(endsOf({crash, crash}), "(Segmentation fault), whichever the broadphase."));
    EXPECT_TRUE(has(endsOf({crash}), "(Segmentation fault) with Bullet's broadphase.\n"));
    EXPECT_TRUE(has(endsOf({crash, one, one, one}),
                    "ended with status 1 or was ended by signal 11 (Segmentation fault) with "
                    "Bullet's broadphase, and ended with status 1 with hashphase.\n"));
}

}  // namespace
}  // namespace hashphase::demos
