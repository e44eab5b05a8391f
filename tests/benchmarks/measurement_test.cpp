// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/cell_size.hpp>
#include <tests/benchmarks/fake_contestant.hpp>
#include <tests/benchmarks/measurement.hpp>
#include <tests/benchmarks/pair_workload.hpp>

#include <demos/scenes/brownian_scene.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace hashphase::benchmarks {
namespace {

using demos::pairKey;
using demos::PairKey;

constexpr std::uint64_t kSeed = 5;

Benchmark uniformBenchmark() {
    Benchmark benchmark;
    benchmark.name = "uniform";
    benchmark.group = "pairs";
    benchmark.make = [](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<PairWorkload>(
            std::make_unique<demos::BrownianScene>(demos::uniformBoxes(objects, seed), seed));
    };
    return benchmark;
}

CaseResult measureFakes(const std::vector<ContestantKind>& kinds, double dropFactor = 0) {
    Benchmark benchmark = uniformBenchmark();
    benchmark.dropFactor = dropFactor;
    MeasurementSettings settings;
    settings.frames = 4;
    settings.warmUpFrames = 3;
    settings.seed = kSeed;
    return measure({&benchmark, 200, kinds}, settings);
}

void leaveAlone(std::vector<PairKey>& /*pairs*/) {}
void forgetOne(std::vector<PairKey>& pairs) {
    pairs.erase(pairs.begin());
}
void repeatOne(std::vector<PairKey>& pairs) {
    pairs.push_back(pairs.front());
}
void inventTwo(std::vector<PairKey>& pairs) {
    // Far beyond the objects that there are.
    pairs.insert(pairs.begin(), {pairKey(1'000'000, 7), pairKey(1'000'000, 8)});
}

void workForMilliseconds(int count) {
    // Work, not sleep: only the former counts as processor time.
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(count);
    while (std::chrono::steady_clock::now() < end) {
    }
}

TEST(AnswerAudit, CountsWhatIsMissingExtraAndTwice) {
    const std::vector<Answer> exact{1, 2, 3, 4};
    std::vector<Answer> answers{9, 4, 2, 2, 2, 8};
    AnswerTally tally;
    EXPECT_EQ(auditAnswers(answers, exact, tally), "missed (0, 1)");
    EXPECT_EQ(tally.framesChecked, 1);
    EXPECT_EQ(tally.answers, 6U);
    EXPECT_EQ(tally.exact, 4U);
    EXPECT_EQ(tally.missing, 2U);
    EXPECT_EQ(tally.extra, 2U);
    EXPECT_EQ(tally.duplicates, 2U);
    EXPECT_FALSE(tally.isExact());
}

TEST(AnswerAudit, AddsUpOverFramesAndIsExactWhenAllWere) {
    AnswerTally tally;
    std::vector<Answer> answers{2, 1};
    EXPECT_EQ(auditAnswers(answers, {1, 2}, tally), "");
    answers = {};
    EXPECT_EQ(auditAnswers(answers, {}, tally), "");
    EXPECT_TRUE(tally.isExact());
    EXPECT_EQ(tally.framesChecked, 2);
    answers = {5, 5};
    EXPECT_EQ(auditAnswers(answers, {5}, tally), "reported 1 answers again");
    EXPECT_FALSE(tally.isExact());
}

TEST(Measurement, TellsAPeersMissesSupersetAndDuplicatesApart) {
    const CaseResult result = measureFakes(
        {fakeKind("good", true, leaveAlone), fakeKind("forgets", false, forgetOne),
         fakeKind("repeats", false, repeatOne), fakeKind("invents", false, inventTwo)});
    const std::uint64_t frames = 7;
    const auto tally = [&result](const char* name) { return result.find(name)->tally; };
    EXPECT_TRUE(tally("good").isExact());
    EXPECT_GT(tally("good").answers, 0U);
    EXPECT_EQ(tally("forgets").missing, frames);
    EXPECT_EQ(tally("forgets").extra + tally("forgets").duplicates, 0U);
    EXPECT_EQ(tally("repeats").duplicates, frames);
    EXPECT_EQ(tally("repeats").extra + tally("repeats").missing, 0U);
    EXPECT_EQ(tally("invents").extra, 2 * frames);
    EXPECT_EQ(tally("invents").missing + tally("invents").duplicates, 0U);
    EXPECT_TRUE(result.oursWereExact()) << "what peers get wrong is theirs";
}

TEST(Measurement, DoesNotPassAWrongAnswerOfOurs) {
    for (const Spoil& spoil : {Spoil(forgetOne), Spoil(repeatOne), Spoil(inventTwo)}) {
        const CaseResult result = measureFakes({fakeKind("ours", true, spoil)});
        EXPECT_FALSE(result.oursWereExact());
        EXPECT_NE(result.contestants[0].firstFault.find("in frame 0"), std::string::npos)
            << result.contestants[0].firstFault;
    }
}

TEST(Measurement, TimesEveryMeasuredFrameOfEveryContestant) {
    const CaseResult result =
        measureFakes({fakeKind("a", true, leaveAlone), fakeKind("b", false, leaveAlone)});
    EXPECT_EQ(result.framesDone, 4);
    EXPECT_EQ(result.operations, 200U);
    for (const ContestantResult& contestant : result.contestants) {
        ASSERT_EQ(contestant.frameMs.size(), 4U);
        EXPECT_GT(contestant.spread()->low, 0);
        EXPECT_EQ(contestant.tally.framesChecked, 7);
    }
}

TEST(Measurement, DropsTheHopelessWhereThatIsAllowed) {
    const std::vector<ContestantKind> kinds{
        fakeKind("quick", true, leaveAlone),
        fakeKind("slow", true, [](std::vector<PairKey>&) { workForMilliseconds(30); })};
    EXPECT_FALSE(measureFakes(kinds).find("slow")->droppedOut);
    const CaseResult result = measureFakes(kinds, 3);
    EXPECT_TRUE(result.find("slow")->droppedOut);
    EXPECT_TRUE(result.find("slow")->frameMs.empty());
    EXPECT_FALSE(result.find("quick")->droppedOut);
    EXPECT_EQ(result.find("quick")->frameMs.size(), 4U);
}

TEST(Measurement, StopsBetweenFramesWhenTimeIsUp) {
    Benchmark benchmark = uniformBenchmark();
    MeasurementSettings settings;
    int asked = 0;
    settings.isTimeUp = [&asked] { return ++asked > 12; };
    const CaseResult result =
        measure({&benchmark, 50, {fakeKind("a", true, leaveAlone)}}, settings);
    EXPECT_TRUE(result.timeLimitHit);
    EXPECT_EQ(result.framesDone, 2);
}

TEST(SpeedAgainst, IsTheMedianOfTheRatiosFrameByFrame) {
    ContestantResult own;
    ContestantResult other;
    own.frameMs = {1, 10, 2};
    other.frameMs = {3, 20, 8};  // ratios 3, 2, 4; the ratio of medians would be 4
    EXPECT_EQ(speedAgainst(&other, own), 3);
    EXPECT_EQ(speedAgainst(nullptr, own), std::nullopt);
    EXPECT_EQ(speedAgainst(&other, {}), std::nullopt);
}

TEST(CellSizeRegret, ComparesWithTheBestFixedSize) {
    CaseResult result;
    result.group = kCellSizeGroup;
    for (const auto& [name, ms] :
         {std::pair(std::string(kAutomaticCells), 1.2), std::pair(std::string("cells-1"), 1.0),
          std::pair(std::string("cells-2"), 2.0)}) {
        ContestantResult contestant;
        contestant.kind.name = name;
        contestant.frameMs = {ms, ms};
        result.contestants.push_back(contestant);
    }
    const std::optional<CellSizeRegret> regret = cellSizeRegret(result);
    ASSERT_TRUE(regret);
    EXPECT_NEAR(regret->regret, 0.2, 1e-12);
    EXPECT_EQ(regret->bestFixed, "cells-1");
    result.group = "pairs";
    EXPECT_FALSE(cellSizeRegret(result));
}

}  // namespace
}  // namespace hashphase::benchmarks
