// SPDX-License-Identifier: Zlib

// `hashphase try`, on programs that are compiled with Bullet's headers and know nothing of hashphase.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <iterator>
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

std::vector<std::string> words(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

const std::vector<std::string> kPrograms = words(
    "pile wall hinged-door spheres-on-terrain bullets-with-ccd vehicle character ghost-zone "
    "sub-steps simple-world sweep-16 sweep-32 sweep-without-trees sweep-at-rest own-cache "
    "sorted-cache fields-written derived-broadphase bare-broadphase own-profiler "
    "rays-from-ticks rays-between-steps pairs-by-hand contact-tests collision-world "
    "filter-callback cloth deformable multibody several-worlds threads churn hello-world "
    "cache-goes-first exit-anyhow forks throws-from-tick");

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
    const std::vector<std::string> listed = words(runCommand(kStock).out);
    EXPECT_EQ(std::set<std::string>(listed.begin(), listed.end()),
              std::set<std::string>(kPrograms.begin(), kPrograms.end()));
}

// --- What is counted -----------------------------------------------------------------------------

TEST(TryMeasures, StepsThatHoldTheirParts) {
    for (const std::string name : {"wall", "pairs-by-hand", "rays-from-callback"}) {
        const auto [output, json] = measure("", kStock + name);
        for (const Json& run : json["runs"]) {
            for (const Json& step : run["steps"]) {
                double parts = 0;
                for (const char* part :
                     {"updateAabbsMs", "calculateMs", "narrowPhaseMs", "raysMs"}) {
                    parts += step[part].get<double>();
                }
                EXPECT_GE(step["stepMs"], parts) << name;
            }
        }
    }
}

// Parts add up where a callback of calculateOverlappingPairs() casts rays.
TEST(TryMeasures, RaysApartFromWhatCastsThem) {
    const auto [output, json] = measure("", kStock + "rays-from-callback");
    for (const Json& run : json["runs"]) {
        ASSERT_EQ(run["steps"].size(), 6U);
        EXPECT_EQ(run["steps"][3]["rays"], 20'000);
        EXPECT_GT(run["steps"][3]["raysMs"], run["steps"][3]["calculateMs"]);
    }
}

// Bullet lists what is near as well.
TEST(TryMeasures, MorePairsOfBullets) {
    const auto [output, json] = measure("", kStock + "wall");
    EXPECT_GT(json["bulletStep"]["pairs"], json["hashphaseStep"]["pairs"]);
    EXPECT_EQ(json["hashphaseStep"]["pairs"], json["hashphaseStep"]["overlappingPairs"]);
}

// As if others had it: a step waits for 3 ms.
TEST(TryMeasures, StepsByTheProcessorOfTheirThread) {
    const auto [output, json] = measure("", kStock + "waits-in-steps");
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

TEST(TryMeasures, StepsInWhichSeveralThreadsWorkOnTheWall) {
    const auto [output, json] = measure("", kStock + "works-on-threads");
    EXPECT_EQ(json["clock"], "wall");
    EXPECT_GE(json["bulletStep"]["stepMs"], 3);
    EXPECT_EQ(json["bulletStep"]["stepMs"], json["bulletStep"]["stepWallMs"]);
    EXPECT_TRUE(has(output.out, "in which several threads work, they are those on the wall"))
        << output.out;
}

// A step is all that the program waits for: solver, sub-steps, ticks.
TEST(TryMeasures, StepsAsTheProgramItselfDoes) {
    const auto [output, json] = measure("", kStock + "timed-steps");
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

TEST(TryMeasures, StepsWithTheirSubSteps) {
    const auto [output, json] = measure("", kStock + "sub-steps");
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

TEST(TryMeasures, TruePairsOfASweepWhoseBoxesAreNeverSet) {
    const auto [output, json] = measure("", kStock + "sweep-at-rest");
    const Json& step = json["bulletStep"];
    EXPECT_GT(step["overlappingPairs"].get<double>(), 0.95 * step["pairs"].get<double>());
}

}  // namespace
}  // namespace hashphase::demos
