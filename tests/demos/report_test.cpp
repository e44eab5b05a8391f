// SPDX-License-Identifier: Zlib
#include <demos/report/chart_scripts.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_command.hpp>
#include <demos/report/report_text.hpp>
#include <demos/system/other_programs.hpp>
#include <tests/demos/sample_experiments.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include <array>
#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace hashphase::demos {
namespace {

/// What a part was run with.
struct PartCall {
    std::size_t size = 10;
    std::uint64_t seed = 0;
    double timeLimit = 0;
    bool quiet = false;
    int count = 0;
};

ReportPart samplePart(const std::string& name, std::optional<bool> holds,
                      std::shared_ptr<PartCall> call) {
    ReportPart part;
    part.command.name = name;
    part.command.description = "A sample";
    part.command.declareOptions = [call](CLI::App& app) {
        app.add_option("--size", call->size);
        app.add_option("--seed", call->seed);
        app.add_option("--time-limit", call->timeLimit);
        app.add_flag("--quiet", call->quiet);
    };
    part.command.run = [=](Console& console) {
        ++call->count;
        console.out << "what " << name << " prints\n";
        Page page{"Page of " + name, "Introduction.", "Verdict of " + name + ".", holds, {}, {}};
        page.provenance.commandLine = console.commandLine;
        page.sections.push_back({"First", {"Sentence"}, {}, {}, sampleCharts(), {}, {}});
        page.sections.push_back({"Second", {"Sentence"}, {}, {}, {}, {}, {}});
        ResultFile none("");
        deliverPage(page, none, console);
        return holds.value_or(true) ? kExitOk : kExitCheckFailed;
    };
    part.quickOptions = {"--size", "3"};
    return part;
}

struct ReportSeen : Typed {
    std::string html;  // without the scripts that the page brings along
};

ReportSeen runReport(const std::vector<ReportPart>& parts, const std::vector<std::string>& options,
                     const std::string& htmlFile = {}) {
    const TemporaryFolder folder;
    const std::string path = folder.file("page.html");
    std::vector<std::string> arguments{"--html", htmlFile.empty() ? path : htmlFile};
    arguments.insert(arguments.end(), options.begin(), options.end());
    ReportSeen seen{typed(reportCommand(parts), arguments), {}};
    std::ifstream file(path);
    seen.html.assign(std::istreambuf_iterator<char>(file), {});
    const std::string_view code = chartScripts().code;
    if (const std::size_t at = seen.html.find(code); !code.empty() && at != std::string::npos) {
        seen.html.erase(at, code.size());
    }
    return seen;
}

/// One that holds, one that may not.
std::vector<ReportPart> twoParts(std::optional<bool> secondHolds = true) {
    return {samplePart("alpha", true, std::make_shared<PartCall>()),
            samplePart("beta", secondHolds, std::make_shared<PartCall>())};
}

std::vector<std::string> matches(const std::string& text, const char* pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) {
        found.push_back((*at)[1]);
    }
    return found;
}

TEST(JoinedReport, HasUniqueIdsAndALinkToEachPartAndSection) {
    const ReportSeen seen = runReport(twoParts(), {});
    EXPECT_EQ(seen.exitCode, kExitOk) << seen.err;
    const std::vector<std::string> all = matches(seen.html, " id=\"([^\"]*)\"");
    const std::set<std::string> ids(all.begin(), all.end());
    EXPECT_EQ(ids.size(), all.size());
    EXPECT_EQ(ids.size(), 1 + 2 * (1 + 2 + sampleCharts().size()) + 1);

    const std::vector<std::string> links = matches(seen.html, " href=\"#([^\"]*)\"");
    EXPECT_EQ(links.size(), 1 + 2 * (1 + 2) + 1U);
    for (const std::string& link : links) {
        EXPECT_TRUE(ids.contains(link)) << link;
    }
    EXPECT_EQ(links[1], "part-1");
    EXPECT_EQ(links[4], "part-2");
}

TEST(JoinedReport, SaysWhatEachPartFoundAndHowToHaveItAlone) {
    const ReportSeen seen = runReport(twoParts(), {"--seed", "7"});
    EXPECT_EQ(seen.out.substr(0, seen.out.find("The page is")),
              "alpha: Verdict of alpha.\nbeta: Verdict of beta.\n"
              "Checked 2 of 2 parts: all checks hold. ");
    EXPECT_NE(seen.err.find("part 2 of 2: beta\n"), std::string::npos) << seen.err;
    const std::size_t beta = seen.html.find("<h2>Page of beta</h2>");
    ASSERT_NE(beta, std::string::npos);
    EXPECT_NE(seen.html.find("<p class=\"verdict\">Verdict of beta.</p>", beta), std::string::npos);
    EXPECT_NE(seen.html.find("<code>hashphase beta --seed 7</code>", beta), std::string::npos);
    EXPECT_NE(seen.html.find("<h3>First</h3>", beta), std::string::npos);
    EXPECT_EQ(matches(seen.html, "(Where this was measured</h2>)").size(), 1U);
}

TEST(JoinedReport, IsBadIfOneOfItsPartsIs) {
    const ReportSeen seen = runReport(twoParts(false), {});
    EXPECT_EQ(seen.exitCode, kExitCheckFailed);
    EXPECT_NE(seen.html.find("<p class=\"verdict bad\">Checked 2 of 2 parts: "
                             "checks of 1 are BROKEN.</p>"),
              std::string::npos);
    EXPECT_NE(seen.html.find("<p class=\"verdict\">Verdict of alpha.</p>"), std::string::npos);
    EXPECT_NE(seen.html.find("<p class=\"verdict bad\">Verdict of beta.</p>"), std::string::npos);
}

TEST(JoinedReport, DoesNotHoldWhereNothingWasChecked) {
    const ReportSeen seen = runReport(twoParts(std::nullopt), {});
    EXPECT_EQ(seen.exitCode, kExitOk) << "what was checked holds";
    EXPECT_NE(seen.html.find("<p class=\"verdict\">Checked 1 of 2 parts: all "
                             "checks hold; not checked: beta.</p>"),
              std::string::npos);
    EXPECT_NE(seen.html.find("<p class=\"verdict unchecked\">Verdict of beta.</p>"),
              std::string::npos);
    EXPECT_EQ(matches(seen.html, "class=\"(holds|broken)\"").size(), 1U) << "that of alpha";
    EXPECT_NE(seen.html.find("<li>Not checked: Verdict of beta. (beta, "), std::string::npos);

    const ReportSeen none = runReport(twoParts(std::nullopt), {"--only", "beta"});
    EXPECT_EQ(none.exitCode, kExitCheckFailed);
    EXPECT_NE(none.html.find("<p class=\"verdict unchecked\">Checked 0 of 1 part; "
                             "not checked: beta.</p>"),
              std::string::npos);
    EXPECT_EQ(none.out.find("hold"), std::string::npos) << none.out;
}

TEST(JoinedReport, TellsPartsThatCheckedNothingFromBrokenOnesThoughBothFail) {
    const auto failing = [](std::optional<bool> holds) {
        std::vector<ReportPart> parts = twoParts(holds);
        parts[1].command.run = [run = parts[1].command.run](Console& console) {
            static_cast<void>(run(console));
            return int{kExitCheckFailed};
        };
        return runReport(parts, {});
    };
    EXPECT_TRUE(holds(failing(std::nullopt).out,
                      "Checked 1 of 2 parts: all checks hold; not checked: beta. "));
    EXPECT_TRUE(holds(failing(true).out, "Checked 2 of 2 parts: checks of 1 are BROKEN. "));
}

TEST(JoinedReport, SaysDuringWhichPartOtherProgramsUsedTheProcessor) {
    std::vector<ReportPart> parts = twoParts();
    parts[1].command.run = [run = parts[1].command.run](Console& console) {
        const auto take = console.takePage;
        console.takePage = [&take](Page page) {
            page.provenance.cores = 2;
            page.provenance.coresOfOthers = 1.5;
            take(page);
        };
        return run(console);
    };
    const ReportSeen seen = runReport(parts, {});
    const std::string busy = "Other programs used 1.5 of 2 cores while this ran";
    EXPECT_TRUE(holds(seen.out, "beta: Verdict of beta.\n" + busy));
    EXPECT_GT(seen.html.find(busy), seen.html.find("<h2>Page of beta</h2>"));
    EXPECT_LT(seen.html.find(busy),
              seen.html.find("</article>", seen.html.find("Page of beta</h2>")));
}

TEST(JoinedReport, TellsHowMuchOfTheProcessorOtherProgramsUsedMeanwhile) {
    std::vector<ReportPart> parts = twoParts();
    parts[0].command.run = [](Console&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(501));
        return int{kExitOk};
    };
    EXPECT_EQ(holds(runReport(parts, {}).html, "<td>cores that other programs used meanwhile</td>"),
              processorTimes().has_value());
}

TEST(JoinedReport, GoesOnAfterAPartThatThrows) {
    std::vector<ReportPart> parts = twoParts();
    parts[0].command.run = [](Console&) -> int { throw std::runtime_error("no more <paper>"); };
    const ReportSeen seen = runReport(parts, {});
    EXPECT_EQ(seen.exitCode, kExitCheckFailed);
    EXPECT_NE(seen.html.find("It failed: no more &lt;paper&gt;"), std::string::npos);
    EXPECT_NE(seen.html.find("<h2>Page of beta</h2>"), std::string::npos);
}

TEST(JoinedReport, HandsItsOptionsToTheParts) {
    const auto call = std::make_shared<PartCall>();
    const auto other = std::make_shared<PartCall>();
    const std::vector<ReportPart> parts{samplePart("alpha", true, call),
                                        samplePart("beta", true, other)};
    const ReportSeen seen = runReport(
        parts, {"--quick", "--seed", "9", "--time-limit", "1000", "--quiet", "--only", "alpha"});
    EXPECT_EQ(seen.exitCode, kExitOk);
    EXPECT_EQ(seen.err, "");
    EXPECT_EQ(call->size, 3U);
    EXPECT_EQ(call->seed, 9U);
    EXPECT_NEAR(call->timeLimit, 1000, 5);
    EXPECT_TRUE(call->quiet);
    EXPECT_EQ(call->count, 1);
    EXPECT_EQ(other->count, 0) << "not asked for";
    EXPECT_NE(seen.out.find("Checked 1 of 1 part: all checks hold."), std::string::npos);
}

TEST(JoinedReport, SaysWhatItLeftOutForWantOfTime) {
    std::vector<ReportPart> parts = twoParts();
    const auto run = parts[0].command.run;
    parts[0].command.run = [run](Console& console) {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return run(console);
    };
    const ReportSeen seen = runReport(parts, {"--time-limit", "0.2"});
    EXPECT_EQ(seen.exitCode, kExitOk);
    EXPECT_NE(seen.html.find(">Checked 1 of 2 parts: all checks hold; "
                             "left out for want of time: beta.</p>"),
              std::string::npos);
    EXPECT_EQ(seen.html.find("Page of beta"), std::string::npos);
}

TEST(JoinedReport, NamesTenOfWhatWasLeftOut) {
    EXPECT_EQ(leftOutText({}), "");
    const std::vector<std::string> names{"a", "b", "c", "d", "e", "f",
                                         "g", "h", "i", "j", "k", "l"};
    EXPECT_EQ(leftOutText(names),
              "; left out for want of time: a, b, c, d, e, f, g, h, i, j and 2 more");
}

TEST(JoinedReport, RefusesWhatItDoesNotKnow) {
    EXPECT_EQ(runReport(twoParts(), {"--only", "alpha,bta"}).err,
              "hashphase: There is no part 'bta'; did you mean 'beta'?\n");
    EXPECT_EQ(runReport(twoParts(), {"--only", "alpha,bta"}).exitCode, kExitUsage);
    EXPECT_EQ(runReport(twoParts(), {"--quik"}).exitCode, kExitUsage);
    EXPECT_EQ(runReport(twoParts(), {"--time-limit", "nan"}).exitCode, kExitUsage);
    EXPECT_EQ(runReport(twoParts(), {"--seed", "-1"}).exitCode, kExitUsage);
    const ReportSeen seen = runReport(twoParts(), {}, "/no/such/folder/page.html");
    EXPECT_EQ(seen.exitCode, kExitUsage);
    EXPECT_EQ(seen.out, "") << "nothing was run";
}

}  // namespace
}  // namespace hashphase::demos
