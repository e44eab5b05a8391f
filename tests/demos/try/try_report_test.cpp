// SPDX-License-Identifier: Zlib

// What `hashphase try` makes of the steps that were recorded.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

using tryout::StepRow;

/// That has taken so long by either clock.
StepRow stepOf(float milliseconds) {
    StepRow row{};
    row.isStep = 1;
    row.step = {milliseconds, milliseconds};
    row.calculations = 1;
    row.allProcessor = StepRow::kNotTaken;
    return row;
}

/// A run of these steps with either broadphase.
Trial trialOf(const std::vector<StepRow>& stock, const std::vector<StepRow>& ours) {
    Trial trial;
    trial.runs.resize(2);
    trial.runs[0].rows = stock;
    trial.runs[1].broadphase = tryout::Broadphase::hash;
    trial.runs[1].rows = ours;
    return trial;
}

/// Of a hundred such steps.
Trial trialOf(const StepRow& stock, const StepRow& ours) {
    return trialOf(std::vector(100, stock), std::vector(100, ours));
}

/// What is made of such steps.
StepSummary summaryOf(const std::vector<StepRow>& rows) {
    return compareSteps(trialOf(rows, rows)).value().stock;
}

std::string textOf(const Trial& trial) {
    std::ostringstream out;
    printTrial(trial, out);
    return out.str();
}

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
    StepRow stock = stepOf(2);
    stock.calculate = {1, 1};
    stock.pairCount = 10;
    StepRow ours = stepOf(1);
    ours.calculate = {0.25F, 0.25F};
    ours.pairCount = 8;
    Trial trial = trialOf(std::vector(100, stock), std::vector(60, ours));
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
    std::vector<StepRow> rows;
    for (int i = 0; i < 300; ++i) {
        const float rays = i % 3 == 0 ? 3.0F : 0.0F;
        rows.push_back(stepOf(1 + rays));
        rows.back().rays = rays;
    }
    const StepSummary step = summaryOf(rows);
    EXPECT_NEAR(step.rays, 1, 0.06);
    EXPECT_NEAR(step.step.value(), 1 + step.rays, 1e-6);
}

// Counts are those of all steps, and what the rare ones took is said.
TEST(TryReport, SaysWhenRareStepsTakeLong) {
    std::vector<StepRow> rows(98, stepOf(1));
    rows.resize(100, stepOf(50));
    rows[98].rays = rows[99].rays = 40;
    rows[98].rayCount = rows[99].rayCount = 200;
    const StepSummary step = summaryOf(rows);
    EXPECT_DOUBLE_EQ(step.step.value(), 1);
    EXPECT_DOUBLE_EQ(step.rayCount, 4);
    const std::string text = textOf(trialOf(rows, rows));
    EXPECT_TRUE(has(text,
                    "without the slowest twentieth of the steps, which took 52 % of all time with "
                    "Bullet's and 52 % with hashphase: 20.6 and 20.6 ms a step"))
        << text;
}

TEST(TryReport, CountsPairsByTheCalculation) {
    StepRow one = stepOf(1);
    one.pairCount = 10;
    one.truePairCount = 5;
    StepRow three = stepOf(1);
    three.calculations = 3;
    three.pairCount = 30;
    three.truePairCount = 15;
    const StepSummary step = summaryOf({one, three});
    EXPECT_DOUBLE_EQ(step.pairCount, 10);
    EXPECT_DOUBLE_EQ(step.truePairCount.value(), 5);
    EXPECT_DOUBLE_EQ(step.stalePairCount().value(), 5);
}

// --- The verdict ---------------------------------------------------------------------------------

TEST(TryReport, SaysOfWhatTheChangeOfAStepConsists) {
    StepRow stock = stepOf(202);
    stock.calculate = {12, 12};
    stock.narrowPhase = {180, 180};
    stock.pairCount = 50'000;
    stock.truePairCount = 1000;
    StepRow ours = stepOf(42.3F);
    ours.calculate = {6, 6};
    ours.narrowPhase = {28, 28};
    ours.pairCount = 1000;
    ours.truePairCount = 1000;
    EXPECT_EQ(lastLineOf(textOf(trialOf(stock, ours))),
              "With hashphase a step takes 42.3 ms instead of 202 (4.78x): 6.00 ms less in the "
              "broadphase, 152 ms less in the narrow phase, which visits 1,000 pairs instead of "
              "50,000, 49,000 of which do not overlap, and 1.70 ms less elsewhere.");
    ours.narrowPhase = stock.narrowPhase;
    EXPECT_TRUE(has(textOf(trialOf(stock, ours)),
                    "as long in the narrow phase, which visits 1,000 pairs instead of 50,000"));
}

// Who has no processor works no slower for it.
TEST(TryReport, TakesTheProcessorsTimeWhereOthersAreBusy) {
    StepRow stock = stepOf(2.38F);
    stock.step.wall = 6.2F;
    stock.calculate = {3, 1};
    stock.rays = 0.62F;
    StepRow ours = stepOf(2);
    ours.step.wall = 10;
    ours.calculate = {0.5F, 0.5F};
    const Trial trial = trialOf(stock, ours);
    const StepSummary step = compareSteps(trial).value().stock;
    EXPECT_NEAR(step.step.value(), 2.38, 1e-6);
    EXPECT_NEAR(step.calculate, 1, 1e-6);
    EXPECT_NEAR(step.rays, 0.238, 1e-6);  // of which only that clock is known
    const std::string text = textOf(trial);
    EXPECT_TRUE(has(text, "a step takes 2.00 ms instead of 2.38 (1.19x)")) << text;
    EXPECT_EQ(lastLineOf(text),
              "Other programs were busy, or the program waited for something: the calling thread "
              "had it for 38 % of the time with Bullet's, and for 20 % with hashphase. Trust the "
              "times above, and not those by the clock on the wall: 6.20 and 10.0 ms a step "
              "(0.62x).");
}

// Of which the time of the processor is that of one.
TEST(TryReport, TakesTheTimeOnTheWallWhereSeveralThreadsWorkInAStep) {
    StepRow stock = stepOf(2);
    stock.step.wall = 8;
    stock.narrowPhase = {7, 1};
    stock.calculate = {0.5F, 0.5F};
    stock.allProcessor = 12;
    StepRow ours = stock;
    ours.step.wall = 4;
    ours.narrowPhase.wall = 3;
    const Trial trial = trialOf(stock, ours);
    const StepComparison steps = compareSteps(trial).value();
    EXPECT_TRUE(steps.onThreads);
    EXPECT_DOUBLE_EQ(steps.stock.step.value(), 8);
    EXPECT_DOUBLE_EQ(steps.stock.narrowPhase.value(), 7);
    const std::string text = textOf(trial);
    EXPECT_TRUE(has(text, "in which several threads work, they are those on the wall.")) << text;
    EXPECT_TRUE(has(text, "a step takes 4.00 ms instead of 8.00 (2.00x)")) << text;
    EXPECT_FALSE(has(text, "busy")) << text;  // the thread has only waited for others of its own
}

TEST(TryReport, TakesWhatTheClockItselfTakesForNoThread) {
    StepRow row = stepOf(0.05F);
    row.allProcessor = 0.065F;
    EXPECT_FALSE(compareSteps(trialOf(row, row)).value().onThreads);
}

TEST(TryReport, SaysWhenProgramsWantMoreCoresThanThereAre) {
    Trial trial = trialOf(stepOf(2), stepOf(1));
    trial.provenance.cores = 2;
    trial.provenance.loadAverage = {1.5, 9, 9};
    EXPECT_FALSE(has(textOf(trial), "busy"));
    trial.provenance.loadAverage = {5.25, 0, 0};
    EXPECT_EQ(lastLineOf(textOf(trial)),
              "Other programs kept the processor busy (load 5.2 on 2 cores), which these times are "
              "without.");
}

// As where a program has made the clocks stand still.
TEST(TryReport, TellsStepsByWhatTheyAreAndNotByTheirTime) {
    const std::string text = textOf(trialOf(stepOf(0), stepOf(0)));
    EXPECT_TRUE(has(text, "With hashphase a step takes ")) << text;
    EXPECT_FALSE(has(text, "nan")) << text;
}

// --- How programs end ----------------------------------------------------------------------------

std::string endsOf(const std::vector<RunEnd>& ends) {
    Trial trial;
    TriedRun run;
    for (const RunEnd& end : ends) {
        run.end = end;
        run.broadphase =
            trial.runs.size() % 2 == 0 ? tryout::Broadphase::stock : tryout::Broadphase::hash;
        trial.runs.push_back(run);
    }
    return textOf(trial);
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

TEST(TryReport, EndsWithHowTheProgramEndedWhereThatIsNotWithStatusZero) {
    const RunEnd crash{.isCrash = true, .code = 11};
    const auto lastLine = [](const RunEnd& stock, const RunEnd& ours) {
        Trial trial = trialOf(stepOf(2), stepOf(1));
        trial.runs[0].end = stock;
        trial.runs[1].end = ours;
        return lastLineOf(textOf(trial));
    };
    EXPECT_EQ(lastLine(crash, crash),
              "The program was ended by signal 11 (Segmentation fault), whichever the broadphase.");
    EXPECT_EQ(lastLine({}, crash),
              "The program ended with status 0 with Bullet's broadphase, and was ended by signal "
              "11 (Segmentation fault) with hashphase.");
    EXPECT_EQ(lastLine({.code = 3}, {.code = 3}),
              "The program ended with status 3, whichever the broadphase.");
    EXPECT_TRUE(has(lastLine({}, {}), "With hashphase a step takes "));
    EXPECT_TRUE(has(lastLine({.isStopped = true}, {}), "With hashphase a step takes "));
}

TEST(TryReport, EndsWithHowAVerifiedProgramEnded) {
    Trial trial;
    trial.runs.emplace_back();
    TriedRun& run = trial.runs.front();
    run.broadphase = tryout::Broadphase::verifying;
    EXPECT_EQ(lastLineOf(textOf(trial)),
              "Nothing was verified: no pairs were calculated, and the program ended with status "
              "0.");
    run.end = {.isCrash = true, .code = 11};
    EXPECT_EQ(lastLineOf(textOf(trial)),
              "The program was ended by signal 11 (Segmentation fault) before any pairs were "
              "calculated.");
    run.verification.calculations = 5;
    EXPECT_EQ(lastLineOf(textOf(trial)),
              "The program was ended by signal 11 (Segmentation fault).");
    run.end = {};
    EXPECT_EQ(lastLineOf(textOf(trial)),
              "5 calculations of pairs verified: the pairs of hashphase are exact in each.");
}

}  // namespace
}  // namespace hashphase::demos
