// SPDX-License-Identifier: Zlib

// That `hashphase try --verify` sees what is wrong, and whose fault it is.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

TEST(Try, FindsPairsThatAreMissing) {
    const auto [output, json] = measure("--verify", stock("stock-programs") + " sabotage");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_EQ(json["verification"]["calculations"], 1);
    EXPECT_EQ(json["verification"]["missing"], 1) << output.out;
    EXPECT_TRUE(has(output.out, "NOT EXACT")) << output.out;
    EXPECT_TRUE(has(output.out, "The first fault, calculation 1: the pair of proxies"))
        << output.out;
}

TEST(Try, FindsPairsThatGoMissingAtRest) {
    const auto [output, json] =
        measure("--verify", stock("stock-programs") + " loses-resting-pair");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_EQ(json["verification"]["missing"], 3) << output.out;  // from the fourth step on
    EXPECT_TRUE(has(output.out, "The first fault, calculation 4: the pair of proxies"))
        << output.out;
}

TEST(Try, FindsPairsThatTheFilterRefuses) {
    const auto [output, json] =
        measure("--verify", stock("stock-programs") + " makes-refused-pair");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_EQ(json["verification"]["missing"], 0) << output.out;
    EXPECT_EQ(json["verification"]["extra"], 1) << output.out;
    EXPECT_TRUE(has(output.out, "is made although the filter refuses it")) << output.out;
}

TEST(Try, JudgesWhatACallbackHasMovedAfterTheNextCalculation) {
    const auto [output, json] =
        measure("--verify", stock("stock-programs") + " moves-from-callback");
    EXPECT_EQ(output.status, kExitOk) << output.out;
    EXPECT_EQ(json["verification"]["notJudged"], 2) << output.out;
    EXPECT_EQ(json["verification"]["bulletMissing"], 0) << output.out;
    EXPECT_TRUE(has(output.out, "2 times a pair was not judged, as a callback had moved"))
        << output.out;
}

TEST(Try, SaysHowAVerifiedProgramEnds) {
    const auto [output, json] = measure("--verify", stock("stock-programs") + " failing");
    EXPECT_EQ(output.status, kExitOk);
    EXPECT_TRUE(has(output.out, "The program ended with status 3.\n")) << output.out;
}

TEST(Try, IsNotContentWithPairsOfAProgramThatCrashes) {
    const auto [output, json] = measure("--verify", stock("stock-programs") + " crashing");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_EQ(json["verification"]["missing"], 0) << output.out;
    EXPECT_EQ(lastLineOf(output.out), "The program was ended by signal 6 (Aborted).");
}

TEST(Try, FindsPairsThatAreExtra) {
    const auto [output, json] = measure("--verify", stock("stock-programs") + " tampering");
    EXPECT_EQ(output.status, kExitCheckFailed);
    EXPECT_EQ(json["verification"]["calculations"], 2);
    EXPECT_EQ(json["verification"]["missing"], 0) << output.out;
    EXPECT_EQ(json["verification"]["removedByProgram"], 0) << output.out;
    EXPECT_EQ(json["verification"]["extra"], 1) << output.out;
    EXPECT_TRUE(has(json["verification"]["firstFault"], "calculation 2: the pair of proxies"));
}

TEST(Try, FindsPairsThatTheProgramRemovedBackInTheNextStep) {
    const auto [output, json] = measure("--verify", stock("stock-programs") + " removes-pairs");
    EXPECT_EQ(output.status, kExitOk) << output.out;
    EXPECT_EQ(json["verification"]["missing"], 0);
    EXPECT_EQ(json["verification"]["removedByProgram"], 0);
}

TEST(Try, TellsPairsThatTheProgramRemovedFromMissingOnes) {
    const auto [output, json] =
        measure("--verify", stock("stock-programs") + " removes-pairs-of-its-cache");
    EXPECT_EQ(output.status, kExitOk) << output.out;
    EXPECT_EQ(json["verification"]["missing"], 0);
    EXPECT_GT(json["verification"]["removedByProgram"], 0);
    EXPECT_TRUE(has(output.out, "that the program had taken out of its own cache itself"))
        << output.out;
}

TEST(Try, TellsPairsThatWaitForAMoveFromMissingOnes) {
    const auto [output, json] = measure("--verify", stock("stock-programs") + " changes-filter");
    EXPECT_EQ(output.status, kExitOk) << output.out;
    EXPECT_EQ(json["verification"]["missing"], 0);
    EXPECT_GT(json["verification"]["waitForAMove"], 0) << output.out;
    EXPECT_TRUE(has(output.out, "See refilter().")) << output.out;
}

}  // namespace
}  // namespace hashphase::demos
