// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/benchmark_command.hpp>
#include <tests/benchmarks/fake_contestant.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

namespace hashphase::benchmarks {
namespace {

using demos::TemporaryFolder;
using nlohmann::json;

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
    const Outcome outcome =
        run({"--quick", "--only", "S2"},
            {fakeKind("hash", true, [](std::vector<demos::PairKey>& pairs) { pairs.pop_back(); })});
    EXPECT_EQ(outcome.exitCode, demos::kExitCheckFailed);
    EXPECT_NE(outcome.out.find("WRONG: 'hash' missed ("), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("All answers of ours exact: NO\n"), std::string::npos);
}

TEST(Benchmarks, DoNotFailForAPeersSuperset) {
    const Outcome outcome = run({"--quick", "--only", "S2"},
                                {fakeKind("peer", false, [](std::vector<demos::PairKey>& pairs) {
                                    pairs.push_back(demos::pairKey(1'000'000, 1));
                                })});
    EXPECT_EQ(outcome.exitCode, demos::kExitOk) << outcome.out;
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
    EXPECT_NE(outcome.out.find("Effects: how many times as long"), std::string::npos);
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
    const std::set<std::string> withSizesOfTheirOwn{"tiny", "threads", "sizes-one",
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
        EXPECT_EQ(run(arguments, {fakeKind("hash", true, [](auto& /*pairs*/) {})}).exitCode,
                  demos::kExitOk);
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
    EXPECT_NE(outcome.out.find("The time limit was reached after "), std::string::npos);
    EXPECT_NE(outcome.out.find("The time limit left out 1 of 2 cases.\n"), std::string::npos)
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
    EXPECT_EQ(errorOf({"--only", "("}), "hashphase: '(' is no regular expression.\n");
    EXPECT_NE(errorOf({"--only", "S9"}).find("--list says what there is"), std::string::npos);
    EXPECT_NE(errorOf({"stray"}).find("see tests/benchmarks/run --help"), std::string::npos);
    EXPECT_EQ(run({"--sizes", "0"}).exitCode, demos::kExitUsage);
    EXPECT_EQ(run({"--help"}).exitCode, demos::kExitOk);
}

}  // namespace
}  // namespace hashphase::benchmarks
