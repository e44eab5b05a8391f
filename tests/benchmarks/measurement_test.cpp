// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/fake_contestant.hpp>
#include <tests/benchmarks/pair_workload.hpp>
#include <tests/benchmarks/report.hpp>
#include <tests/demos/asked.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>

namespace hashphase::benchmarks {
namespace {

using demos::asked;
using demos::Measurements;
using demos::pairKey;
using demos::PairKey;

Measurements measureFakes(const std::vector<ContestantKind>& kinds, double dropFactor = 0) {
    const Benchmark benchmark{.name = "uniform",
                              .group = "pairs",
                              .dropFactor = dropFactor,
                              .make = makePairWorkload(brownian(demos::uniformBoxes))};
    MeasurementSettings settings;
    settings.frames = 4;
    settings.warmUpFrames = 3;
    settings.seed = 5;
    Measurements measured;
    static_cast<void>(measure({&benchmark, 200, kinds}, settings, measured));
    return measured;
}

/// What the reports make of it.
std::string summaryOf(Measurements& measured) {
    BenchmarkReport report;
    report.measured = std::move(measured);
    std::ostringstream out;
    printCase(report, 1, out);
    printSummary(report, out);
    measured = std::move(report.measured);
    return out.str();
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
void takeLong(std::vector<PairKey>& /*pairs*/) {
    // Work, not sleep: only the former counts as processor time.
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(30);
    while (std::chrono::steady_clock::now() < end) {
    }
}

TEST(AnswerAudit, CountsWhatIsMissingExtraAndTwice) {
    const auto auditOf = [](std::vector<Answer> answers, const std::vector<Answer>& exact) {
        const FrameAudit audit = auditAnswers(answers, exact);
        std::ostringstream text;
        text << audit.answers << ' ' << audit.missing << ' ' << audit.extra << ' '
             << audit.duplicates << ' ' << audit.fault;
        return text.str();
    };
    EXPECT_EQ(auditOf({9, 4, 2, 2, 2, 8}, {1, 2, 3, 4}), "6 2 2 2 missed (0, 1)");
    EXPECT_EQ(auditOf({2, 1}, {1, 2}), "2 0 0 0 ");
    EXPECT_EQ(auditOf({}, {}), "0 0 0 0 ");
    EXPECT_EQ(auditOf({5, 5}, {5}), "2 0 0 1 reported 1 answers again");
    EXPECT_EQ(auditOf({5, 6}, {5}), "2 0 1 0 reported in excess (0, 6)");
}

TEST(Measurement, TellsAPeersMissesSupersetAndDuplicatesApart) {
    Measurements measured = measureFakes(
        {fakeKind("good", true, leaveAlone), fakeKind("forgets", false, forgetOne),
         fakeKind("repeats", false, repeatOne), fakeKind("invents", false, inventTwo)});
    EXPECT_NE(summaryOf(measured).find("All answers of ours exact: yes\n"), std::string::npos)
        << "what peers get wrong is theirs";
    EXPECT_EQ(
        asked(measured, "SELECT name, checked, missing, extra, duplicates, answers > 0 FROM did"),
        "good 7 0 0 0 1; forgets 7 7 0 0 1; repeats 7 0 0 7 1; invents 7 0 14 0 1");
}

TEST(Measurement, DoesNotPassAWrongAnswerOfOurs) {
    for (const Spoil& spoil : {Spoil(forgetOne), Spoil(repeatOne), Spoil(inventTwo)}) {
        Measurements measured = measureFakes({fakeKind("ours", true, spoil)});
        EXPECT_NE(summaryOf(measured).find("All answers of ours exact: NO\n"), std::string::npos);
        EXPECT_EQ(asked(measured, "SELECT first_fault LIKE '% in frame 0' FROM case_tables"), "1");
    }
}

TEST(Measurement, TimesEveryMeasuredFrameOfEveryContestantInTurn) {
    Measurements measured =
        measureFakes({fakeKind("a", true, leaveAlone), fakeKind("b", false, leaveAlone)});
    static_cast<void>(summaryOf(measured));
    EXPECT_EQ(asked(measured, "SELECT name, frames_done, operations FROM outcomes"),
              "uniform/200 4 200");
    EXPECT_EQ(asked(measured, "SELECT name, frames, low > 0 FROM did"), "a 4 1; b 4 1");
    EXPECT_EQ(asked(measured,
                    "SELECT group_concat(contestant) FROM (SELECT * FROM frames ORDER BY rowid)"),
              "2,1,1,2,2,1,1,2");
}

TEST(Measurement, DropsTheHopelessWhereThatIsAllowed) {
    const std::vector<ContestantKind> kinds{fakeKind("quick", true, leaveAlone),
                                            fakeKind("slow", true, takeLong)};
    Measurements all = measureFakes(kinds);
    Measurements some = measureFakes(kinds, 3);
    static_cast<void>(summaryOf(all) + summaryOf(some));
    const char* outcome =
        "SELECT name, ns LIKE 'too slow', dropped_out, frames "
        "FROM case_tables JOIN did ON did.name = case_tables.contestant";
    EXPECT_EQ(asked(all, outcome), "quick 0 0 4; slow 0 0 4");
    EXPECT_EQ(asked(some, outcome), "quick 0 0 4; slow 1 1 0");
}

TEST(Measurement, StopsBetweenFramesWhenTimeIsUp) {
    const Benchmark benchmark{.name = "uniform",
                              .make = makePairWorkload(brownian(demos::uniformBoxes))};
    MeasurementSettings settings;
    int count = 0;
    settings.isTimeUp = [&count] { return ++count > 12; };
    Measurements measured;
    const Case toRun{&benchmark, 50, {fakeKind("a", true, leaveAlone)}};
    static_cast<void>(measure(toRun, settings, measured));
    EXPECT_EQ(asked(measured, "SELECT count(*) FROM frames"), "2");
}

/// Of contestants whose frames take so long [ms].
Measurements measuredFrames(const char* group,
                            const std::vector<std::pair<const char*, std::vector<double>>>& times) {
    Measurements measured;
    measured.add("cases", {{"name", "case/1"},
                           {"group", group},
                           {"description", ""},
                           {"operation", "object"},
                           {"objects", 1},
                           {"operations", 1},
                           {"warm_up_frames", 0},
                           {"frames_asked", 3}});
    for (const auto& [name, milliseconds] : times) {
        const std::int64_t row = measured.add("contestants", {{"case", 1},
                                                              {"name", name},
                                                              {"title", ""},
                                                              {"package", ""},
                                                              {"ours", false},
                                                              {"fill_ms", 0}});
        for (std::size_t frame = 0; frame < milliseconds.size(); ++frame) {
            measured.add("frames",
                         {{"contestant", row}, {"frame", frame}, {"ms", milliseconds[frame]}});
        }
    }
    return measured;
}

TEST(SpeedAgainst, IsTheMedianOfTheRatiosFrameByFrame) {
    // Ratios 3, 2, 4; the ratio of medians would be 4.
    Measurements measured =
        measuredFrames("pairs", {{"own", {1, 10, 2}}, {"dbvt", {3, 20, 8}}, {"none", {}}});
    static_cast<void>(summaryOf(measured));
    EXPECT_EQ(asked(measured, "SELECT contestant, \"/ dbvt\" FROM case_tables"),
              "own 3.00x; dbvt 1.00x; none -");
}

TEST(CellSizeRegret, ComparesWithTheBestFixedSize) {
    for (const bool isCellSize : {true, false}) {
        Measurements measured =
            measuredFrames(isCellSize ? "cell size" : "pairs", {{"cells-auto", {1.2, 1.2}},
                                                                {"cells-1", {1, 1}},
                                                                {"cells-2", {2, 2}},
                                                                {"cells-4", {}}});
        EXPECT_EQ(summaryOf(measured).find("Regret: median 20.0 %, worst 20.0 % of 1 cases.\n") !=
                      std::string::npos,
                  isCellSize);
        EXPECT_EQ(asked(measured, "SELECT best, fixed(regret, 6) FROM regrets"),
                  isCellSize ? "cells-1 0.200000" : "");
    }
}

TEST(EffectsOverhead, IsTheRatioToTheFrameByHandAndHasBounds) {
    Measurements measured = measuredFrames("effects", {{"by-hand", {1, 2, 4}},
                                                       {"declared", {1.01, 2, 4.4}},
                                                       {"nobody", {1.1, 2.2, 4}},
                                                       {"by-hand-again", {1, 2, 8}}});
    EXPECT_NE(summaryOf(measured).find("NO"), std::string::npos);
    EXPECT_EQ(asked(measured, "SELECT name, ratio, bound, ratio <= bound FROM overheads"),
              "declared 1.01 1.01 1; nobody 1.1 1.02 0; by-hand-again 1 - -");
}

}  // namespace
}  // namespace hashphase::benchmarks
