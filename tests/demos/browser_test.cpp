// SPDX-License-Identifier: Zlib
//
// Pages as browsers show them.

#include <demos/accuracy/accuracy_command.hpp>
#include <demos/compare/compare_command.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/chart_scripts.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_command.hpp>
#include <tests/demos/sample_experiments.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace hashphase::demos {
namespace {

/// What browse.mjs saw of the pages.
Json browsed(const TemporaryFolder& folder, const std::vector<std::string>& pages) {
    std::string command =
        "'" HASHPHASE_NODE "' '" HASHPHASE_BROWSE_SCRIPT "' '" HASHPHASE_CHROMIUM "'";
    for (const std::string& page : pages) {
        command += " '" + page + "'";
    }
    const std::string seen = folder.file("seen.json");
    EXPECT_EQ(std::system((command + " >'" + seen + "'").c_str()), 0) << command;
    return Json::parse(std::ifstream(seen), nullptr, false);
}

TEST(Charts, AreDrawnAsTheyAreDeclared) {
    if (chartScripts().code.empty()) {
        GTEST_SKIP() << chartScripts().whyNone;
    }
    const std::string command =
        "'" HASHPHASE_NODE "' '" HASHPHASE_CHARTS_TEST "' '" HASHPHASE_CHART_PACKAGES "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

void runProgramFor(const std::vector<std::string>& arguments) {
    const std::vector<Experiment> experiments = sampleExperiments();
    const std::vector<std::string> few{"--objects", "60", "--frames", "12"};
    const std::array subcommands{
        accuracyCommand(experiments), compareCommand(), paperCommand(),
        reportCommand({{accuracyCommand(experiments), {}}, {compareCommand(), few}})};
    const Typed done = typed(arguments, subcommands);
    ASSERT_EQ(done.exitCode, kExitOk) << done.err;
}

void expectDrawn(const Json& charts, std::size_t number) {
    EXPECT_EQ(charts.size(), number);
    for (const Json& chart : charts) {
        EXPECT_EQ(chart["drawn"], "yes") << chart;
        EXPECT_EQ(chart["broken"], 0) << chart;
        EXPECT_GT(chart["points"].get<int>() + chart["bars"].get<int>(), 0) << chart;
    }
}

std::set<std::string> chartNamesOf(const Json& charts) {
    std::set<std::string> names;
    for (const Json& chart : charts) {
        names.insert(chart["name"].get<std::string>());
    }
    return names;
}

/// One look a series, whatever chart of the page it is in; some are in several.
void expectOneLook(const Json& charts) {
    std::map<std::string, std::set<std::string>> looks;
    std::size_t series = 0;
    for (const Json& chart : charts) {
        for (const Json& each : chart["series"]) {
            looks[each[0]].insert(each[1].get<std::string>());
            ++series;
        }
    }
    EXPECT_GT(series, looks.size());
    for (const auto& [name, different] : looks) {
        EXPECT_EQ(different.size(), 1U) << name << ": " << testing::PrintToString(different);
    }
}

void expectSound(const Json& page) {
    const Json& with = page["withJavaScript"];
    // The one fault is that of the foreign script, so that breaches are known to be seen.
    EXPECT_EQ(with["foreignScriptRan"], false);
    ASSERT_EQ(with["faults"].size(), 1U) << with["faults"];
    EXPECT_NE(with["faults"][0].get<std::string>().find("Content Security Policy"),
              std::string::npos);
    EXPECT_EQ(with["requests"].size(), 1U) << "of the page alone: " << with["requests"];
    EXPECT_NE(with["inks"][0], with["inks"][1]) << "on a light and a dark screen";
    EXPECT_NE(with["tooltip"], "");
    EXPECT_EQ(with["pdf"]["begin"], "%PDF");

    const Json& without = page["withoutJavaScript"];
    EXPECT_EQ(without["faults"].size(), 0U) << without["faults"];
    EXPECT_EQ(without["drawings"], 0);
    EXPECT_NE(without["notice"].get<std::string>().find("JavaScript, which is off"),
              std::string::npos);
    EXPECT_EQ(without["pdf"]["begin"], "%PDF");
}

TEST(Browser, LaysOutPagesOnWideAndNarrowScreensAndOnPaper) {
    if (std::string(HASHPHASE_CHROMIUM).empty() || std::string(HASHPHASE_NODE).empty()) {
        GTEST_SKIP() << "Chromium and Node.js are needed (Debian: chromium, npm).";
    }
    if (chartScripts().code.empty()) {
        GTEST_SKIP() << chartScripts().whyNone;
    }
    const TemporaryFolder folder;
    runProgramFor({"report", "--quick", "--html", folder.file("joined.html")});
    runProgramFor({"accuracy", "--output", folder.file("accuracy")});
    runProgramFor({"compare", "--scene", "stack", "--objects", "40", "--frames", "8", "--html",
                   folder.file("compare.html")});
    runProgramFor({"paper", "--quick", "--objects", "500,50000", "--frames", "2", "--time-limit",
                   "3", "--html", folder.file("paper.html")});
    std::string command =
        "'" HASHPHASE_NODE "' '" HASHPHASE_BROWSE_LAYOUT_SCRIPT "' '" HASHPHASE_CHROMIUM "'";
    for (const char* page :
         {"joined.html", "accuracy/accuracy.html", "compare.html", "paper.html"}) {
        command += " '" + folder.file(page) + "'";
    }
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

TEST(Browser, DrawsAllChartsUnderThePolicyOfThePage) {
    if (std::string(HASHPHASE_CHROMIUM).empty() || std::string(HASHPHASE_NODE).empty()) {
        GTEST_SKIP() << "Chromium and Node.js are needed (Debian: chromium, npm).";
    }
    if (chartScripts().code.empty()) {
        GTEST_SKIP() << chartScripts().whyNone;
    }
    const TemporaryFolder folder;
    runProgramFor({"accuracy", "--output", folder.file("report")});
    runProgramFor(
        {"compare", "--objects", "60", "--frames", "12", "--html", folder.file("compare.html")});
    runProgramFor({"report", "--quick", "--html", folder.file("joined.html")});
    runProgramFor({"paper", "--quick", "--objects", "500", "--frames", "2", "--html",
                   folder.file("paper.html")});
    const Json pages =
        browsed(folder, {folder.file("report/accuracy.html"), folder.file("compare.html"),
                         folder.file("joined.html"), folder.file("paper.html")});
    ASSERT_EQ(pages.size(), 4U);

    for (const Json& page : pages) {
        expectSound(page);
    }
    expectDrawn(pages[0]["withJavaScript"]["charts"], sampleCharts().size());
    expectDrawn(pages[1]["withJavaScript"]["charts"], 2);
    expectDrawn(pages[2]["withJavaScript"]["charts"], sampleCharts().size() + 2);
    expectOneLook(pages[2]["withJavaScript"]["charts"]);
    expectOneLook(pages[3]["withJavaScript"]["charts"]);
    const std::set<std::string> names = chartNamesOf(pages[3]["withJavaScript"]["charts"]);
    expectDrawn(pages[3]["withJavaScript"]["charts"], names.size());
    for (const char* name : {"paper-collision", "paper-visibility", "paper-AI", "paper-radius"}) {
        EXPECT_EQ(names.count(name), 1U) << name;
    }
    std::size_t rows = 0;
    for (const Chart& chart : sampleCharts()) {
        rows += chart.data.rows.size();
    }
    EXPECT_GT(pages[0]["withoutJavaScript"]["rows"], rows);

    const Json& lines = pages[0]["withJavaScript"]["charts"][0];
    EXPECT_EQ(lines["points"], 3 * 14);
    EXPECT_EQ(lines["lines"], 3 + 1) << "methods and theory";
    EXPECT_EQ(lines["texts"][5], "0") << "the lower end of an axis with 0 apart";
}

}  // namespace
}  // namespace hashphase::demos
