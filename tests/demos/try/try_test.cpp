// SPDX-License-Identifier: Zlib

// `hashphase try`, on programs that are compiled with Bullet's headers and know nothing of hashphase.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace hashphase::demos {
namespace {

// --- Programs of all kinds -----------------------------------------------------------------------

class TriedProgramTest : public testing::TestWithParam<std::tuple<std::string, std::string>> {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(program())) {
            GTEST_SKIP() << program() << " was not built";
        }
    }
    [[nodiscard]] static std::string program() { return stock(std::get<0>(GetParam())); }
    [[nodiscard]] static std::string call() { return program() + " " + std::get<1>(GetParam()); }
};

const std::vector<std::string> kPrograms{"pile",
                                         "wall",
                                         "hinged-door",
                                         "spheres-on-terrain",
                                         "bullets-with-ccd",
                                         "vehicle",
                                         "character",
                                         "ghost-zone",
                                         "sub-steps",
                                         "simple-world",
                                         "sweep-16",
                                         "sweep-32",
                                         "sweep-without-trees",
                                         "sweep-at-rest",
                                         "own-cache",
                                         "sorted-cache",
                                         "fields-written",
                                         "derived-broadphase",
                                         "bare-broadphase",
                                         "own-profiler",
                                         "rays-from-ticks",
                                         "rays-between-steps",
                                         "pairs-by-hand",
                                         "contact-tests",
                                         "collision-world",
                                         "filter-callback",
                                         "cloth",
                                         "deformable",
                                         "multibody",
                                         "several-worlds",
                                         "threads",
                                         "churn",
                                         "hello-world",
                                         "cache-goes-first",
                                         "exit-anyhow",
                                         "forks",
                                         "throws-from-tick"};

TEST_P(TriedProgramTest, HasTheSameOutcomeUnderVerification) {
    const Output plain = runCommand(call());
    ASSERT_EQ(plain.status, 0);
    ASSERT_FALSE(plain.out.empty());
    const auto [output, json] = measure("--verify", call());
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_EQ(output.out.rfind(plain.out, 0), 0U)
        << "before: " << plain.out << "now: " << output.out;
    ASSERT_TRUE(json.is_object());
    const Json& verification = json["verification"];
    EXPECT_GT(verification["calculations"], 0) << output.out;
    EXPECT_EQ(verification["missing"], 0) << output.out;
    EXPECT_EQ(verification["extra"], 0) << output.out;
    EXPECT_EQ(verification["bulletMissing"], 0) << output.out;
    EXPECT_GE(verification["bulletPairs"], verification["bulletExtra"]);
}

TEST_P(TriedProgramTest, HasTheSameOutcomeWithEitherBroadphase) {
    const Output plain = runCommand(call());
    const auto [output, json] = measure("", call());
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_EQ(countOf(output.out, plain.out), 2U) << "before: " << plain.out << output.out;
    ASSERT_TRUE(json.is_object());
    ASSERT_EQ(json["runs"].size(), 2U);
    EXPECT_EQ(json["runs"][0]["steps"].size(), json["runs"][1]["steps"].size());
    EXPECT_EQ(json["runs"][0]["dbvts"], json["runs"][1]["dbvts"]);
    EXPECT_EQ(json["runs"][0]["axisSweeps"], json["runs"][1]["axisSweeps"]);
    for (const Json& step : json["runs"][1]["steps"]) {
        if (!step["overlappingPairs"].is_null()) {
            EXPECT_EQ(step["overlappingPairs"], step["pairs"]);
        }
    }
}

std::string nameOf(const testing::TestParamInfo<TriedProgramTest::ParamType>& info) {
    std::string name = std::get<1>(info.param);
    for (char& letter : name) {
        letter = std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
    }
    return (has(std::get<0>(info.param), "64") ? "double_" : "single_") + name;
}

INSTANTIATE_TEST_SUITE_P(Stock, TriedProgramTest,
                         testing::Combine(testing::Values(std::string("stock-programs"),
                                                          std::string("stock-programs-float64")),
                                          testing::ValuesIn(kPrograms)),
                         nameOf);

TEST(TriedPrograms, AreAllThatThereAre) {
    std::istringstream lines(runCommand(stock("stock-programs")).out);
    std::set<std::string> names;
    for (std::string name; std::getline(lines, name);) {
        names.insert(name);
    }
    EXPECT_EQ(names, std::set<std::string>(kPrograms.begin(), kPrograms.end()));
}

// --- What is counted -----------------------------------------------------------------------------

TEST(Try, CountsStepsObjectsAndPairs) {
    const auto [output, json] = measure("--runs 2", stock("stock-programs") + " wall");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    ASSERT_EQ(json["runs"].size(), 4U);
    const char* const turns[] = {"bullet", "hashphase", "bullet", "hashphase"};
    for (std::size_t i = 0; i < 4; ++i) {
        const Json& run = json["runs"][i];
        EXPECT_EQ(run["broadphase"], turns[i]);
        EXPECT_EQ(run["dbvts"], 1);
        ASSERT_EQ(run["steps"].size(), 300U);
        EXPECT_EQ(run["steps"][0]["objects"], 31);
        EXPECT_EQ(run["steps"][299]["objects"], 32);
        EXPECT_GE(run["steps"][0]["pairs"], 30);  // each brick and the ground
        for (const Json& step : run["steps"]) {
            EXPECT_GE(step["stepMs"], step["calculateMs"].get<double>() +
                                          step["updateAabbsMs"].get<double>() +
                                          step["narrowPhaseMs"].get<double>());
            EXPECT_GT(step["narrowPhaseMs"], 0);
        }
    }
    EXPECT_EQ(json["bulletStep"]["steps"], 600);
    EXPECT_EQ(json["bulletStep"]["objects"], 32);
    EXPECT_TRUE(json["verification"].is_null());
    // Bullet lists what is near as well.
    EXPECT_GT(json["bulletStep"]["pairs"], json["hashphaseStep"]["pairs"]);
    EXPECT_EQ(json["hashphaseStep"]["pairs"], json["hashphaseStep"]["overlappingPairs"]);
    EXPECT_GT(json["bulletStep"]["stalePairs"], 0);
    EXPECT_EQ(json["hashphaseStep"]["stalePairs"], 0);
    for (const char* word : {"updateAabbs [ms]", "calculateOverlappingPairs [ms]", "rays, with",
                             "whole step [ms]", "narrow phase [ms]", "share of the broadphase",
                             "of which overlap", "With hashphase a step takes "}) {
        EXPECT_TRUE(has(output.out, word)) << word << output.out;
    }
}

TEST(Try, CountsRays) {
    const auto [output, json] = measure("", stock("stock-programs") + " rays-from-ticks");
    for (const Json& run : json["runs"]) {
        ASSERT_EQ(run["steps"].size(), 120U);
        EXPECT_EQ(run["steps"][10]["rays"], 25);
        EXPECT_EQ(run["steps"][70]["rays"], 50);  // before the step, and after
        EXPECT_GT(run["steps"][70]["raysMs"], 0);
    }
}

// Parts add up where a callback of calculateOverlappingPairs() casts rays.
TEST(Try, TakesRaysOutOfWhatCastsThem) {
    const auto [output, json] = measure("", stock("stock-programs") + " rays-from-callback");
    for (const Json& run : json["runs"]) {
        ASSERT_EQ(run["steps"].size(), 6U);
        const Json& step = run["steps"][3];
        EXPECT_EQ(step["rays"], 20'000);
        EXPECT_GT(step["raysMs"], step["calculateMs"]);
        EXPECT_GE(step["stepMs"].get<double>(), step["updateAabbsMs"].get<double>() +
                                                    step["calculateMs"].get<double>() +
                                                    step["raysMs"].get<double>());
    }
}

// Nor their trees, in which they look for rays.
TEST(Try, CountsNothingOfSweepsThatAreNotTakenOver) {
    const auto [output, json] = measure("", stock("stock-programs") + " derived-sweep-beside");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    for (const Json& run : json["runs"]) {
        ASSERT_EQ(run["steps"].size(), 10U);
        EXPECT_EQ(run["steps"][9]["objects"], 21);
        EXPECT_EQ(run["steps"][9]["raysBetween"], 0);
    }
}

TEST(Try, TellsAxisSweepsFromTrees) {
    const auto [output, json] = measure("", stock("stock-programs") + " sweep-16");
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["axisSweeps"], 1);
        EXPECT_EQ(run["dbvts"], 0);
        EXPECT_EQ(run["steps"][0]["objects"], 49);
    }
    EXPECT_TRUE(has(output.out, ": 1 axis sweep, single precision")) << output.out;
}

// Which may be most of what the swap changes.
TEST(Try, CountsPairsThatTheNarrowPhaseNoLongerVisits) {
    const auto [output, json] = measure("", stock("stock-programs") + " leaves-pairs");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_GT(json["bulletStep"]["stalePairs"], 1000);
    EXPECT_EQ(json["hashphaseStep"]["stalePairs"], 0);
    EXPECT_TRUE(has(output.out, " in the narrow phase, which visits 200 pairs instead of "))
        << output.out;
}

// As if others had it: a step waits for 3 ms.
TEST(Try, TimesStepsByTheProcessorOfTheirThread) {
    const auto [output, json] = measure("", stock("stock-programs") + " waits-in-steps");
    EXPECT_EQ(json["clock"], "processor");
    for (const Json& run : json["runs"]) {
        ASSERT_EQ(run["steps"].size(), 80U);
        for (const Json& step : run["steps"]) {
            EXPECT_GE(step["stepMs"].get<double>(), step["stepProcessorMs"].get<double>() + 2);
            EXPECT_GT(step["stepProcessorMs"], 0);
        }
    }
    EXPECT_GE(json["bulletStep"]["stepWallMs"].get<double>(),
              json["bulletStep"]["stepMs"].get<double>() + 2);
    EXPECT_LT(json["bulletStep"]["processorShare"], 1);
}

TEST(Try, TimesStepsInWhichSeveralThreadsWorkOnTheWall) {
    const auto [output, json] = measure("", stock("stock-programs") + " works-on-threads");
    EXPECT_EQ(json["clock"], "wall");
    EXPECT_GE(json["bulletStep"]["stepMs"], 3);
    EXPECT_EQ(json["bulletStep"]["stepMs"], json["bulletStep"]["stepWallMs"]);
    EXPECT_TRUE(has(output.out, "in which several threads work, they are those on the wall"))
        << output.out;
}

TEST(Try, SaysWhereThereAreNoSteps) {
    const auto [output, json] = measure("", stock("stock-programs") + " bare-broadphase");
    EXPECT_TRUE(json["bulletStep"]["stepMs"].is_null());
    EXPECT_EQ(json["bulletStep"]["steps"], 1);
    EXPECT_TRUE(has(output.out, "The program has made no steps: pairs were calculated by hand."))
        << output.out;
}

// A step is all that the program waits for: solver, sub-steps, ticks.
TEST(Try, TimesStepsAsTheProgramItselfDoes) {
    const auto [output, json] = measure("", stock("stock-programs") + " timed-steps");
    std::istringstream words(output.out);
    std::string word;
    for (const Json& run : json["runs"]) {
        double itsOwn = 0;
        words >> word >> itsOwn;
        double ours = 0;
        for (const Json& step : run["steps"]) {
            ours += step["stepMs"].get<double>();
        }
        EXPECT_EQ(run["steps"].size(), 200U);
        EXPECT_LE(ours, itsOwn * 1.001);
        EXPECT_GE(ours, 200);  // that it waits in all
        words >> std::ws;
    }
}

TEST(Try, CountsStepsWithTheirSubSteps) {
    const auto [output, json] = measure("", stock("stock-programs") + " sub-steps");
    for (const Json& run : json["runs"]) {
        EXPECT_GE(run["steps"].size(), 50U);
        EXPECT_LE(run["steps"].size(), 60U);  // a short call has a sub-step now and then
        std::set<int> subSteps;
        for (const Json& step : run["steps"]) {
            subSteps.insert(step["calculations"].get<int>());
        }
        EXPECT_GT(subSteps.size(), 1U);
    }
}

TEST(Try, CountsStepsAfterOneThatAnExceptionLeft) {
    const auto [output, json] = measure("", stock("stock-programs") + " throws-from-tick");
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["steps"].size(), 30U);
    }
}

TEST(Try, KeepsRaysBetweenStepsApart) {
    const auto [output, json] = measure("", stock("stock-programs") + " rays-between-steps");
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["steps"].size(), 60U);
        for (const Json& step : run["steps"]) {
            EXPECT_EQ(step["rays"], 0);
        }
        EXPECT_EQ(run["steps"][0]["raysBetween"], 0);
        EXPECT_EQ(run["steps"][1]["raysBetween"], 50);
        EXPECT_GT(run["steps"][1]["raysBetweenMs"], 0);
    }
    EXPECT_TRUE(has(output.out, "rays between steps")) << output.out;
}

TEST(Try, TakesPairsThatAreCalculatedByHandForNoStep) {
    const auto [output, json] = measure("", stock("stock-programs") + " pairs-by-hand");
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["steps"].size(), 40U);
        EXPECT_EQ(run["steps"][20]["raysBetween"], 1);
        EXPECT_EQ(run["foreignCalculations"], 0);
        for (const Json& step : run["steps"]) {
            EXPECT_GE(step["stepMs"].get<double>(), step["updateAabbsMs"].get<double>() +
                                                        step["calculateMs"].get<double>() +
                                                        step["raysMs"].get<double>());
        }
    }
}

TEST(Try, CountsTruePairsOfASweepWhoseBoxesAreNeverSet) {
    const auto [output, json] = measure("", stock("stock-programs") + " sweep-at-rest");
    const Json& step = json["bulletStep"];
    EXPECT_GT(step["overlappingPairs"].get<double>(), 0.95 * step["pairs"].get<double>());
}

// --- Limits and ends -----------------------------------------------------------------------------

TEST(Try, EndsAProgramAfterSoManySteps) {
    const auto [output, json] = measure("--steps 20", stock("stock-programs") + " endless");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["steps"].size(), 20U);
        EXPECT_EQ(run["ended"], "was stopped");
    }
}

// Pairs that are calculated by hand are no steps.
TEST(Try, CountsStepsAloneForALimit) {
    const auto [output, json] = measure("--steps 20", stock("stock-programs") + " endless-by-hand");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    for (const Json& run : json["runs"]) {
        EXPECT_EQ(run["steps"].size(), 20U);
    }
}

TEST(Try, EndsAProgramAfterSoManySeconds) {
    const auto [output, json] = measure("--seconds 0.2", stock("stock-programs") + " endless");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_EQ(json["runs"].size(), 2U);
    EXPECT_GT(json["runs"][1]["steps"].size(), 0U);
}

TEST(Try, KeepsWhatWasMeasuredBeforeACrash) {
    const auto [output, json] = measure("", stock("stock-programs") + " crashing");
    EXPECT_EQ(output.status, kExitOk) << output.out << output.err;
    EXPECT_EQ(json["runs"][0]["steps"].size(), 5U);
    EXPECT_EQ(lastLineOf(output.out),
              "The program was ended by signal 6 (Aborted), whichever the broadphase.");
}

TEST(Try, EndsWithTheCrashOfAProgramThatHasCalculatedNoPairs) {
    const auto [output, json] = measure("", stock("stock-programs") + " crashing-early");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_EQ(lastLineOf(output.out),
              "The program was ended by signal 6 (Aborted), whichever the broadphase.");
    const auto [verified, figures] =
        measure("--verify", stock("stock-programs") + " crashing-early");
    EXPECT_EQ(verified.status, kExitCheckFailed);
    EXPECT_EQ(lastLineOf(verified.out),
              "The program was ended by signal 6 (Aborted) before any pairs were calculated.");
}

TEST(Try, SaysWhenAProgramEndsDifferently) {
    const Output output = tryProgram("-- " + stock("stock-programs") + " casts-cache");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_TRUE(has(output.out,
                    "ended with status 0 with Bullet's broadphase, and ended with "
                    "status 4 with hashphase"))
        << output.out;
}

TEST(Try, LeavesTheStatusOfAProgramThatFailsAlike) {
    const auto [output, json] = measure("", stock("stock-programs") + " failing");
    EXPECT_EQ(output.status, kExitOk);
    EXPECT_EQ(json["runs"][1]["ended"], "ended with status 3");
    EXPECT_TRUE(has(output.out, "The program ended with status 3, whichever the broadphase."))
        << output.out;
}

TEST(Try, IsNotContentWithNothingToCompare) {
    const auto [output, json] = measure("", stock("stock-programs") + " no-steps-without-trees");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_TRUE(has(output.out, "No steps were compared")) << output.out;
}

}  // namespace
}  // namespace hashphase::demos
