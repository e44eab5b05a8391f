// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_command.hpp>
#include <demos/accuracy/accuracy_report.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <tests/demos/sample_experiments.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hashphase::demos {
namespace {

Typed runAccuracy(const std::vector<std::string>& arguments,
                  const std::vector<Experiment>& experiments = sampleExperiments()) {
    return typed(accuracyCommand(experiments), arguments);
}

Experiment experimentOf(std::string_view id, std::function<Findings(const Effort&)> find) {
    return {id,
            "Title",
            "Question?",
            1,
            1,
            [find = std::move(find)](const Effort& effort, const TellProgress& /*tell*/) {
                return find(effort);
            }};
}

TEST(Accuracy, SaysWhatItLeftOutForWantOfTime) {
    EXPECT_TRUE(holds(runAccuracy({"--time-limit", "1e-9"}).out,
                      "\n0 experiments, 0 checks: all hold; left out for want of time: S1, S2\n"));
    EXPECT_EQ(runAccuracy({"--time-limit", "nan"}).exitCode, kExitUsage);
}

TEST(Accuracy, EndsWithAVerdict) {
    const Typed ran = runAccuracy({});
    EXPECT_EQ(ran.exitCode, kExitOk) << ran.err;
    EXPECT_TRUE(holds(ran.out, "\n2 experiments, 1 check: all hold\n"));
    EXPECT_TRUE(holds(ran.out, "  holds   Swept modes miss nothing (0 of 1,000,000)\n"));
    EXPECT_TRUE(holds(ran.out, "\nFast movers\n  ")) << "the advice";
    EXPECT_TRUE(holds(ran.out, "\n  2.00      Sweep::line: misses nothing\n"));
    EXPECT_FALSE(holds(ran.out, "misses a fifth")) << "slower and worse than another choice";
}

TEST(Accuracy, PrintsALineOfAnExperimentAndItsTablesOnRequest) {
    const Typed brief = runAccuracy({});
    EXPECT_TRUE(holds(brief.out, "S1 Samples, "));
    EXPECT_FALSE(holds(brief.out, "What do charts look like?"));
    EXPECT_FALSE(holds(brief.out, "  Sweeping along a line costs twice as much"));
    const Typed verbose = runAccuracy({"--verbose"});
    EXPECT_TRUE(holds(verbose.out, "S1 Samples: What do charts look like?\n"));
    EXPECT_TRUE(holds(verbose.out, "  Sweeping along a line costs twice as much"));
    EXPECT_GT(verbose.out.size(), brief.out.size() + 100) << "the tables";
}

TEST(Accuracy, ListsTheExperiments) {
    const Typed ran = runAccuracy({"--list"});
    EXPECT_EQ(ran.exitCode, kExitOk);
    EXPECT_EQ(ran.out,
              "  S1   Samples: What do charts look like?\n"
              "  S2   Nothing: Is nothing found?\n");
}

TEST(Accuracy, RunsOnlyWhatIsAskedFor) {
    const Typed ran = runAccuracy({"--only", "S2"});
    EXPECT_EQ(ran.exitCode, kExitOk);
    EXPECT_TRUE(holds(ran.out, "1 experiment, 0 checks: all hold"));
    EXPECT_FALSE(holds(ran.out, "S1"));
}

TEST(Accuracy, SuggestsTheNearestNameOfAnUnknownExperiment) {
    const Typed ran = runAccuracy({"--only", "S1,S22"});
    EXPECT_EQ(ran.exitCode, kExitUsage);
    EXPECT_EQ(ran.err, "hashphase: There is no experiment 'S22'; did you mean 'S2'?\n");
    EXPECT_EQ(ran.out, "");
}

TEST(Accuracy, FailsAndNamesTheCheckThatIsBroken) {
    const Typed ran = runAccuracy({}, {experimentOf("B1", [](const Effort& /*effort*/) {
                                      Findings findings;
                                      findings.checks = {{"One is one", true, "1 of 1"},
                                                         {"Nothing is missed", false, "3 of 10"}};
                                      return findings;
                                  })});
    EXPECT_EQ(ran.exitCode, kExitCheckFailed);
    EXPECT_TRUE(holds(ran.out, "  BROKEN  Nothing is missed (3 of 10)\n"));
    EXPECT_TRUE(holds(ran.out,
                      "1 experiment, 2 checks: 1 BROKEN\n"
                      "B1: Nothing is missed (3 of 10)\n"));
}

TEST(Accuracy, CountsAnExperimentThatThrowsAsBrokenAndRunsTheOthers) {
    std::vector<Experiment> experiments{experimentOf(
        "T1",
        [](const Effort& /*effort*/) -> Findings { throw std::runtime_error("out of luck"); })};
    experiments.push_back(sampleExperiments().front());
    const Typed ran = runAccuracy({}, experiments);
    EXPECT_EQ(ran.exitCode, kExitCheckFailed);
    EXPECT_TRUE(holds(ran.out, "T1: The experiment comes to its end (out of luck)\n"));
    EXPECT_TRUE(holds(ran.out, "  holds   Swept modes miss nothing"));
}

TEST(Accuracy, PassesEffortAndSeedOn) {
    Effort seen;
    const std::vector<Experiment> experiments{experimentOf("E1", [&seen](const Effort& effort) {
        seen = effort;
        return Findings{};
    })};
    runAccuracy({"--quick", "--seed", "42"}, experiments);
    EXPECT_TRUE(seen.isQuick);
    EXPECT_EQ(seen.seed, 42U);
    EXPECT_EQ(seen.quickOrFull(1, 2), 1);
    EXPECT_EQ(runAccuracy({"--seed", "-1"}, experiments).exitCode, kExitUsage);
}

TEST(Accuracy, WritesAPageAndItsDataToAFolder) {
    const TemporaryFolder folder;
    const std::string output = folder.file("new/report");
    ASSERT_EQ(runAccuracy({"--output", output, "--quick"}).exitCode, kExitOk);

    const auto findings = nlohmann::json::parse(readFile(output + "/S1.json"));
    EXPECT_EQ(findings["schema"], "hashphase-accuracy");
    EXPECT_EQ(findings["experiment"], "S1");
    EXPECT_EQ(findings["quick"], true);
    EXPECT_EQ(findings["provenance"]["commandLine"], "hashphase test");
    EXPECT_EQ(findings["checks"][0]["holds"], true);
    EXPECT_EQ(findings["choices"].size(), 3U);
    EXPECT_EQ(findings["charts"].size(), sampleCharts().size());
    EXPECT_EQ(findings["charts"][1]["mark"], "point");
    EXPECT_TRUE(findings["charts"][1]["data"]["rows"].back()[1].is_null()) << "not measured";
    EXPECT_EQ(nlohmann::json::parse(readFile(output + "/S2.json"))["experiment"], "S2");

    for (const Chart& chart : sampleCharts()) {
        const std::string csv = readFile(output + "/" + chart.name + ".csv");
        EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), chart.data.rows.size() + 1);
    }
    EXPECT_TRUE(
        holds(readFile(output + "/advice.csv"), "Fast movers,2,Sweep::line,misses nothing,0\n"));
    const std::string page = readFile(output + "/accuracy.html");
    EXPECT_LT(page.find("2 experiments, 1 check: all hold"), page.find("What to choose</h2>"));
    EXPECT_LT(page.find("What to choose</h2>"), page.find("S1 Samples</h2>"));
    EXPECT_TRUE(holds(page, "--quick, which measures less; seed 1."));
}

TEST(Accuracy, NamesEachFileThatCannotBeWrittenAndWritesTheOthers) {
    const TemporaryFolder folder;
    const std::string output = folder.file("report");
    for (const char* name : {"/S1.json", "/advice.csv"}) {
        std::filesystem::create_directories(output + name);
    }
    const Typed lost = runAccuracy({"--output", output, "--quick"});
    EXPECT_EQ(lost.exitCode, kExitUsage);
    EXPECT_EQ(lost.err, "hashphase: " + output + "/S1.json is a folder, not a file. " + output +
                            "/advice.csv is a folder, not a file.\n");
    EXPECT_EQ(nlohmann::json::parse(readFile(output + "/S2.json"))["experiment"], "S2");
    EXPECT_TRUE(holds(readFile(output + "/accuracy.html"), "S1 Samples</h2>"));
}

TEST(Accuracy, NamesBrokenChecksOnTopOfThePage) {
    const TemporaryFolder folder;
    runAccuracy({"--output", folder.file("r")}, {experimentOf("B1", [](const Effort& /*effort*/) {
                    Findings findings;
                    findings.checks = {{"Nothing is missed", false, "3 < 10"}};
                    return findings;
                })});
    EXPECT_TRUE(
        holds(readFile(folder.file("r/accuracy.html")),
              "<p class=\"verdict bad\">1 experiment, 1 check: 1 BROKEN. BROKEN: B1: Nothing "
              "is missed (3 &lt; 10).</p>"));
}

/// In which order so many methods are measured, frame by frame.
std::vector<std::vector<int>> measuredOrders(int methodCount, const TimedFrames& timed) {
    std::vector<std::vector<int>> orders;
    std::vector<TimedMethod> methods;
    for (int i = 0; i < methodCount; ++i) {
        methods.push_back({{{"method", i}}, [&orders, i] { orders.back().push_back(i); }});
    }
    Measurements measured;
    measureTimes(
        measured, timed, [&](int) { orders.emplace_back(); }, methods);
    return orders;
}

TEST(MeasuredTimes, AreOfEachMethodOnceAFrameInTheSameOrdersInEachRun) {
    const auto orders = measuredOrders(5, {.frames = 60, .warmUp = 3});
    ASSERT_EQ(orders.size(), 63U);
    for (std::vector<int> order : orders) {
        std::ranges::sort(order);
        EXPECT_EQ(order, (std::vector{0, 1, 2, 3, 4}));
    }
    EXPECT_EQ(measuredOrders(5, {.frames = 60, .warmUp = 3}), orders);
}

// Of 400 frames, each of four methods comes first in 100, and each of two directly before the other in 100, if all
// orders are equally likely.
TEST(MeasuredTimes, FollowThoseOfEachOtherMethodAboutAsOften) {
    std::map<std::pair<int, int>, int> counts;
    for (const std::vector<int>& order : measuredOrders(4, {.frames = 400})) {
        int before = -1;
        for (const int method : order) {
            ++counts[{before, method}];
            before = method;
        }
    }
    EXPECT_EQ(counts.size(), 4U + 4U * 3U);
    for (const auto& [pair, count] : counts) {
        EXPECT_GT(count, 60) << pair.second << " behind " << pair.first;
        EXPECT_LT(count, 140) << pair.second << " behind " << pair.first;
    }
}

TEST(Accuracy, RefusesAFolderThatCannotBeWrittenBeforeItMeasures) {
    const TemporaryFolder folder;
    bool measured = false;
    const std::vector<Experiment> experiments{experimentOf("E1", [&](const Effort& /*effort*/) {
        measured = true;
        return Findings{};
    })};
    const std::string file = folder.write("file", "");
    const Typed below = runAccuracy({"--output", file + "/r"}, experiments);
    EXPECT_EQ(below.exitCode, kExitUsage);
    EXPECT_TRUE(holds(below.err, "The folder " + file + "/r cannot be made: "));
    std::filesystem::create_directories(folder.file("taken/accuracy.html"));
    const Typed taken = runAccuracy({"--output", folder.file("taken")}, experiments);
    EXPECT_EQ(taken.exitCode, kExitUsage);
    EXPECT_EQ(taken.err,
              "hashphase: " + folder.file("taken") + "/accuracy.html is a folder, not a file.\n");
    EXPECT_FALSE(measured);
}

// --- Advice ---

Choice choice(const std::string& task, const std::string& method, double milliseconds,
              double error) {
    return {task, method, milliseconds, error, "error of " + method, true};
}

/// The methods that the table advises.
std::string frontOf(const std::vector<Choice>& choices) {
    const DataTable table = adviceTable(choices);
    std::string methods;
    for (const std::vector<Value>& row : table.rows) {
        methods += "; " + valueText(row[table.columnOf("method")]);
    }
    return methods;
}

TEST(Advice, LeavesOutWhatIsSlowerAndWorse) {
    EXPECT_EQ(frontOf({choice("t", "exact", 4, 0), choice("t", "slow and bad", 5, 0.1),
                       choice("t", "fast", 1, 0.5), choice("t", "as fast, worse", 1, 0.6),
                       choice("t", "slower, as bad", 2, 0.5), choice("t", "between", 3, 0.2)}),
              "; fast; between; exact");
    EXPECT_EQ(frontOf({choice("t", "one", 1, 0), choice("t", "other", 1, 0)}), "; one")
        << "the first of equals stays";
    EXPECT_EQ(frontOf({}), "");
}

// The time of ours varies down to 0.9 ms.
TEST(Advice, SendsNobodyToAnotherForAGainThatCannotBeTold) {
    const auto others = [](double milliseconds, double error) {
        return Choice{"t", "other", milliseconds, error, "", false, 0.9 * milliseconds};
    };
    const Choice own{"t", "ours", 1, 0.5, "", true, 0.9};
    EXPECT_EQ(frontOf({others(0.994, 0.5), own}), "; ours") << "5 %";
    EXPECT_EQ(frontOf({others(0.91, 0.5), own}), "; ours") << "within the spread";
    EXPECT_EQ(frontOf({others(0.89, 0.5), own}), "; other") << "as wrong, and faster";
    EXPECT_EQ(frontOf({others(0.994, 0.4), own}), "; other") << "less wrong";
    EXPECT_EQ(frontOf({others(1.01, 0.4), own}), "; ours; other") << "less wrong";
    EXPECT_EQ(frontOf({choice("t", "quick", 0.994, 0.5), own}), "; quick") << "both ours";
}

TEST(Advice, SaysErrorsInWordsWithTheirUnits) {
    const TemporaryFolder folder;
    runAccuracy({"--output", folder.file("r")});
    const std::string page = readFile(folder.file("r/accuracy.html"));
    const std::size_t at = page.find("What to choose</h2>");
    const std::string advice = page.substr(at, page.find("</table>", at) - at);
    EXPECT_TRUE(holds(advice, "<td>misses half</td></tr>"));
    EXPECT_FALSE(holds(advice, ">error<")) << "shares, metres and percent in one column";
}

TEST(Advice, LetsOnlyChoicesOfOneTaskCompete) {
    EXPECT_EQ(
        frontOf({choice("b", "slow", 9, 1), choice("a", "fast", 1, 0), choice("b", "quick", 8, 1)}),
        "; quick; fast");
}

TEST(Advice, IsARowForEachChoiceThatIsLeft) {
    const DataTable table =
        adviceTable(std::vector{choice("t", "fast", 1, 0.5), choice("t", "exact", 2, 0)});
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[1][table.columnOf("method")], Value("exact"));
    EXPECT_EQ(table.rows[1][table.columnOf("milliseconds")], Value(2.0));
    EXPECT_EQ(table.rows[1][table.columnOf("result")], Value("error of exact"));
}

}  // namespace
}  // namespace hashphase::demos
