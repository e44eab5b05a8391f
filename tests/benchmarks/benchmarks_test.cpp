// SPDX-License-Identifier: Zlib

// What is measured, what the reports make of it, and the program.

#include <tests/benchmarks/benchmark_command.hpp>
#include <tests/benchmarks/pair_workload.hpp>
#include <tests/demos/asked.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <set>
#include <sstream>

namespace hashphase::benchmarks {
namespace {

using demos::asked;
using demos::Measurements;
using demos::pairKey;
using demos::PairKey;
using demos::TemporaryFolder;
using nlohmann::json;

// --- Contestants that know the exact pairs and spoil them on purpose --------------------------------

using Spoil = std::function<void(std::vector<PairKey>&)>;

class FakeContestant : public Contestant {
public:
    explicit FakeContestant(Spoil spoil) : spoil_(std::move(spoil)) {}

    void fill(const FrameBoxes& frame) override { frame_ = frame; }
    void setAll(const FrameBoxes& frame) override { frame_ = frame; }
    void findPairs() override {
        demos::findExactPairs(demos::ReferenceMethod::kBrute, frame_.boxes, frame_.filters, pairs_);
        spoil_(pairs_);
    }
    void listPairs(std::vector<PairKey>& pairs) override { pairs = pairs_; }

private:
    Spoil spoil_;
    FrameBoxes frame_;
    std::vector<PairKey> pairs_;
};

ContestantKind fakeKind(std::string name, bool ours, Spoil spoil) {
    return {.name = std::move(name),
            .title = "a fake",
            .package = "none",
            .ours = ours,
            .make = [spoil = std::move(spoil)](const demos::BroadphaseNeeds&) {
                return std::make_unique<FakeContestant>(spoil);
            }};
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

// --- Measuring ------------------------------------------------------------------------------------

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

TEST(Summary, TellsHowMuchOfTheProcessorOtherProgramsUsed) {
    BenchmarkReport report;
    report.measured = measureFakes({fakeKind("good", true, leaveAlone)});
    report.provenance.cores = 2;
    report.provenance.coresOfOthers = 1.5;
    std::ostringstream out;
    printCase(report, 1, out);
    printSummary(report, out);
    EXPECT_NE(out.str().find("\nOther programs used 1.5 of 2 cores while"), std::string::npos)
        << out.str();
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

TEST(SnapshotShares, AreTheMediansOfTheRatiosToTheFrameItself) {
    Measurements measured = measuredFrames(
        "snapshots", {{"frame", {1, 2, 4}}, {"save", {0.1, 0.1, 0.2}}, {"restore", {1, 1, 1}}});
    EXPECT_NE(summaryOf(measured).find("5.00 %"), std::string::npos);
    EXPECT_EQ(asked(measured, "SELECT name, share FROM shares"), "save 0.05; restore 0.5");
}

// --- The program ----------------------------------------------------------------------------------

struct Outcome {
    int exitCode = 0;
    std::string out;
    std::string err;
};

Outcome run(std::vector<std::string> arguments,
            const std::vector<ContestantKind>& kinds = contestantKinds()) {
    std::ostringstream out;
    std::ostringstream err;
    Outcome outcome;
    outcome.exitCode =
        demos::runSingleCommand(arguments, benchmarkCommand(kinds), {out, err, false, "test"});
    outcome.out = out.str();
    outcome.err = err.str();
    return outcome;
}

// Some are told nothing of the motions.
bool missesByDesign(const json& result, const json& contestant) {
    return result["group"] == "sweeps" && contestant["name"].get<std::string>().starts_with("hash");
}

void expectComplete(const json& contestant, const std::string& where) {
    const bool droppedOut = contestant["droppedOut"];
    EXPECT_EQ(contestant["ms"].is_null(), droppedOut) << where;
    if (!droppedOut) {
        EXPECT_GT(contestant["ms"]["median"], 0) << where;
        EXPECT_LE(contestant["ms"]["p5"], contestant["ms"]["p95"]) << where;
        EXPECT_GT(contestant["nsPerOperation"], 0) << where;
        EXPECT_EQ(contestant["frameMs"].size(), 5U) << where;
        EXPECT_EQ(contestant["answers"]["framesChecked"], 8) << where;
    }
    EXPECT_EQ(contestant["ours"] == true && contestant["answers"]["extra"] != 0, false) << where;
    EXPECT_FALSE(contestant["package"].get<std::string>().empty()) << where;
}

TEST(Benchmarks, MeasureAndCheckEveryCaseAndWriteItDown) {
    const TemporaryFolder folder;
    const std::string path = folder.file("all.json");
    const Outcome outcome = run({"--quick", "--quiet", "--only", ".", "--json", path});
    EXPECT_EQ(outcome.exitCode, demos::kExitOk) << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("All answers of ours exact: yes\n"), std::string::npos);
    EXPECT_NE(outcome.out.find("QUICK: "), std::string::npos);

    const json report = json::parse(std::ifstream(path));
    EXPECT_EQ(report["schema"], "hashphase-benchmarks");
    EXPECT_EQ(report["verdict"]["oursExact"], true);
    std::set<std::string> measured;
    for (const json& result : report["cases"]) {
        const std::string name = result["name"];
        measured.insert(name.substr(0, name.find('/')));
        EXPECT_EQ(result["framesDone"], 5) << name;
        EXPECT_FALSE(result["contestants"].empty()) << name;
        for (const json& contestant : result["contestants"]) {
            const std::string where = name + " " + contestant["name"].get<std::string>();
            expectComplete(contestant, where);
            EXPECT_TRUE(contestant["answers"]["missing"] == 0 || missesByDesign(result, contestant))
                << where;
        }
        if (result["group"] == "cell size") {
            EXPECT_TRUE(result["cellSizeRegret"]["regret"].is_number()) << name;
        } else if (result["group"] == "far") {
            EXPECT_EQ(result["contestants"][0]["name"], "home") << name;
        } else if (result["group"] == "effects") {
            EXPECT_EQ(result["contestants"][0]["name"], "by-hand") << name;
            EXPECT_EQ(result["effectsOverheads"].size(), 3U) << name;
            EXPECT_GT(result["effectsOverheads"][0]["ratio"]["median"], 0) << name;
            EXPECT_EQ(result["effectsOverheads"][0]["bound"], 1.01) << name;
        } else if (result["group"] == "snapshots") {
            EXPECT_EQ(result["contestants"][0]["name"], "frame") << name;
            EXPECT_EQ(result["snapshotShares"].size(), 2U) << name;
            EXPECT_GT(result["snapshotShares"][1]["share"]["median"], 0) << name;
        } else {
            EXPECT_EQ(result["contestants"][0]["name"], "hash") << name;
            EXPECT_GT(result["contestants"][0]["speedAgainstDbvt"], 0) << name;
        }
    }
    for (const Benchmark& benchmark : catalog(1)) {
        EXPECT_EQ(measured.count(benchmark.name), 1U) << benchmark.name;
    }
}

TEST(Benchmarks, FailWhereAnAnswerOfOursIsWrongAndNameIt) {
    const Outcome outcome = run({"--quick", "--only", "S2"}, {fakeKind("hash", true, forgetOne)});
    EXPECT_EQ(outcome.exitCode, demos::kExitCheckFailed);
    EXPECT_NE(outcome.out.find("WRONG: 'hash' missed ("), std::string::npos) << outcome.out;
    EXPECT_EQ(run({"--quick", "--only", "S2"}, {fakeKind("peer", false, inventTwo)}).exitCode,
              demos::kExitOk);
}

TEST(Benchmarks, RunWhatIsOnRequestOnlyWhenItIsNamed) {
    const Outcome outcome = run({"--quick", "--only", "cellsize-uniform-2,removal/"});
    EXPECT_NE(outcome.out.find("cells-auto"), std::string::npos);
    EXPECT_NE(outcome.out.find("Regret: median "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\nremoval/300 "), std::string::npos) << outcome.out;
    EXPECT_EQ(run({"--list"}).out.find("S7"), std::string::npos);
    EXPECT_EQ(run({"--quick", "--quiet"}).out.find("cells-auto"), std::string::npos);
}

TEST(Benchmarks, TellWhatDeclaredEffectsTakeOfAFrameByHand) {
    const Outcome outcome = run({"--only", "effects-pairs", "--sizes", "200", "--frames", "45"});
    EXPECT_EQ(outcome.exitCode, demos::kExitOk) << outcome.out;
    EXPECT_NE(outcome.out.find("Effects: the time of a declared frame"), std::string::npos);
    EXPECT_NE(outcome.out.find("\neffects-pairs/200  "), std::string::npos) << outcome.out;
}

TEST(Benchmarks, TakeSizesSeedFramesAndContestants) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    const Outcome outcome = run({"--only", "S[26],tiny", "--sizes", "70,50", "--seed", "9",
                                 "--frames", "2", "--contestants", "dbvt,hash", "--json", path});
    ASSERT_EQ(outcome.exitCode, demos::kExitOk) << outcome.err;
    const json report = json::parse(std::ifstream(path));
    std::vector<std::string> names;
    for (const json& result : report["cases"]) {
        names.push_back(result["name"]);
        EXPECT_EQ(result["contestants"].size(), 2U);
        EXPECT_EQ(result["framesDone"], 2);
    }
    // Those that have sizes of their own keep them.
    EXPECT_EQ(names, (std::vector<std::string>{"S2-uniform/50", "S2-uniform/70", "S6-piles/50",
                                               "S6-piles/70", "tiny/10", "tiny/32", "tiny/100",
                                               "tiny/300", "tiny/1000"}));
    EXPECT_EQ(report["settings"]["seed"], 9);
}

// Where others may be faster than we are.
TEST(Benchmarks, MeasureEverySceneAtAThousandAndAtThreeThousandObjects) {
    const std::set<std::string> withSizesOfTheirOwn{"tiny", "threads", "large-world", "sizes-one",
                                                    "sizes-trillion"};
    for (const Benchmark& benchmark : pairBenchmarks()) {
        if (withSizesOfTheirOwn.count(benchmark.name) == 0) {
            const std::vector<std::size_t>& sizes = benchmark.sizes;
            EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 1'000), 1) << benchmark.name;
            EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 3'000), 1) << benchmark.name;
        }
    }
}

TEST(Benchmarks, MeasureMoreFramesWhereFramesAreShort) {
    const TemporaryFolder folder;
    const std::string path = folder.file("r.json");
    const auto framesDone = [&](const std::string& size, std::vector<std::string> more) {
        std::vector<std::string> arguments{"--only", "S2", "--sizes", size, "--json", path};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(run(arguments, {fakeKind("hash", true, leaveAlone)}).exitCode, demos::kExitOk);
        return json::parse(std::ifstream(path))["cases"][0]["framesDone"].get<int>();
    };
    EXPECT_EQ(framesDone("100", {}), 300);
    EXPECT_EQ(framesDone("1001", {}), 60);
    EXPECT_EQ(framesDone("100", {"--frames", "7"}), 7);
}

TEST(Benchmarks, StopAtTheTimeLimitAndSayWhatIsLeftOut) {
    const Outcome outcome = run({"--only", "S2", "--sizes", "100,200", "--frames", "1000000",
                                 "--contestants", "hash", "--time-limit", "0.2"});
    EXPECT_EQ(outcome.exitCode, demos::kExitOk);
    EXPECT_NE(outcome.out.find("The time limit of 0.2 s was reached after "), std::string::npos);
    EXPECT_NE(outcome.out.find("The time limit of 0.2 s was reached: 1 of 2 cases are left out.\n"),
              std::string::npos)
        << outcome.out;
}

TEST(Benchmarks, ListAllCasesAndContestants) {
    const Outcome outcome = run({"--list"});
    EXPECT_EQ(outcome.exitCode, demos::kExitOk);
    for (const char* name : {"S1-paper ", "terdiman ", "rays-fat ", "cellsize-clustered-10 ",
                             "random-8 ", "hash ", "grid ", "dbvt-deferred "}) {
        EXPECT_NE(outcome.out.find(std::string("\n  ") + name), std::string::npos) << name;
    }
}

TEST(Benchmarks, RefuseWhatTheyDoNotKnowWithAHint) {
    const auto errorOf = [](const std::vector<std::string>& arguments) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exitCode, demos::kExitUsage) << outcome.out;
        return outcome.err;
    };
    EXPECT_EQ(errorOf({"--contestants", "hahs"}),
              "hashphase: There is no contestant 'hahs'; did you mean 'hash'?\n");
    EXPECT_EQ(errorOf({"--onyl", "S1"}),
              "hashphase: There is no option '--onyl'; did you mean '--only'?\n");
    EXPECT_EQ(errorOf({"--only", "("}), "hashphase: '(' is not a regular expression.\n");
    EXPECT_NE(errorOf({"--only", "S9"}).find("--list prints all cases"), std::string::npos);
    EXPECT_NE(errorOf({"stray"}).find("see tests/benchmarks/run --help"), std::string::npos);
    EXPECT_EQ(run({"--sizes", "0"}).exitCode, demos::kExitUsage);
    EXPECT_EQ(run({"--help"}).exitCode, demos::kExitOk);
}

}  // namespace
}  // namespace hashphase::benchmarks
