// SPDX-License-Identifier: Zlib

// What is left of commands that are interrupted in the middle: all that they measured until then.

#include <demos/accuracy/accuracy_command.hpp>
#include <demos/effects/effects_prices.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/report_command.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/stability_command.hpp>
#include <demos/system/interruption.hpp>
#include <tests/demos/asked.hpp>
#include <tests/demos/interruptible.hpp>
#include <tests/demos/sample_experiments.hpp>
#include <tests/demos/typed.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include <unistd.h>

namespace hashphase::demos {
namespace {

TEST(InterruptedAccuracy, KeepsTheExperimentsThatAreDone) {
    const TemporaryFolder folder;
    std::vector<Experiment> experiments{sampleExperiments().front()};
    const auto add = [&](std::string_view id, std::function<Findings()> find) {
        experiments.push_back(
            {id, "Title", "Question?", 1, 1,
             [find = std::move(find)](const Effort&, const TellProgress&) { return find(); }});
    };
    add("I1", [] {
        std::raise(SIGINT);
        Measurements measured;
        measureTimes(measured, {}, [](int) { ADD_FAILURE() << "no frame begins"; }, {});
        return Findings{};
    });
    add("L1", []() -> Findings {
        ADD_FAILURE() << "is not run";
        return {};
    });
    const Typed ended = typed(accuracyCommand(experiments), {"--output", folder.path().string()});
    EXPECT_EQ(ended.exitCode, 130);
    const std::string verdict =
        "1 experiment, 1 check: all hold; interrupted, which left out I1, L1";
    EXPECT_TRUE(holds(ended.out, "\n" + verdict + "\n"));
    EXPECT_TRUE(holds(ended.out, "  holds   Swept modes miss nothing"));
    EXPECT_TRUE(holds(readFile(folder.file("accuracy.html")), verdict));
    EXPECT_TRUE(std::filesystem::exists(folder.file("S1.json")));
}

TEST(InterruptedStability, EndsTheCaseThatRunsAndLeavesItOut) {
    const TemporaryFolder folder;
    const std::array cases{
        HardCase{"H1", "fine", "what is fine", "that it is",
                 [](CaseRun<float>& run) { run.expect(true, "it is fine"); }},
        HardCase{"H2", "no end", "what never ends", "that it does",
                 [](CaseRun<float>&) {
                     kill(getppid(), SIGINT);
                     pause();
                 }},
        HardCase{"H3", "fine", "what is fine", "that it is", [](CaseRun<float>&) {}}};
    const std::array kinds{broadphaseKinds()[0], broadphaseKinds()[1]};
    const Typed ended =
        typed(stabilityCommand(kinds, cases), {"--quiet", "--json", folder.file("r.json")});
    EXPECT_EQ(ended.exitCode, 130);
    EXPECT_TRUE(holds(ended.out, "\n1 of 1 hard cases hold; interrupted, which left out H2, H3\n"));
    const auto json = nlohmann::json::parse(std::ifstream(folder.file("r.json")));
    EXPECT_EQ(json["interrupted"], true);
    EXPECT_EQ(json["cases"].size(), 1U);
    EXPECT_EQ(json["leftOut"], nlohmann::json::array({"H2", "H3"}));
}

TEST(InterruptedPaper, SaysWhatIsLeftOut) {
    // Before anything is measured: afterwards it is the time limit's way.
    Subcommand command = paperCommand();
    command.run = [run = command.run](Console& console) {
        std::raise(SIGTERM);
        return run(console);
    };
    const Typed ended = typed(command, {"--quick", "--quiet", "--objects", "500"});
    EXPECT_EQ(ended.exitCode, 143);
    EXPECT_TRUE(
        holds(ended.out, "\nThe run was interrupted: what it measured until then is here.\n"));
    EXPECT_TRUE(holds(ended.out, "Left out: collision of 500\n"));
}

TEST(InterruptedEffects, EndOnceAFrameIsMeasured) {
    EffectsFile file = parseEffectsFile(exampleScenes()[0].text, "sample");
    file.scene.objects = 60;
    PricingSettings settings;
    settings.frames = 50;
    settings.warmUpFrames = 1;
    const std::size_t stepsOfFrame = pricingSteps(file, settings) / 51;
    for (const std::size_t frame : {0U, 1U, 3U}) {
        const NotedSignals signals;
        settings.tellProgress = [&](std::size_t done, std::string_view) {
            if (done == frame * stepsOfFrame) {
                std::raise(SIGINT);
            }
        };
        if (frame < 2) {
            EXPECT_THROW(static_cast<void>(priceEffects(file, settings)), Interrupted);
            continue;
        }
        Measurements measured = priceEffects(file, settings);
        EXPECT_EQ(asked(measured, "SELECT frames, interrupted, stopped FROM run"),
                  "3 1 The run was interrupted");
        const Findings findings = effectsFindings(measured);
        EXPECT_TRUE(holds(joined(sentencesOf(findings.rows.at("end of the run")), "\n"),
                          "\nThe run was interrupted after 3 frames."));
    }
}

/// A part that is interrupted; then it `ends`, or has nothing to show.
ReportPart interruptedPart(const std::string& name, bool ends) {
    ReportPart part;
    part.command.name = name;
    part.command.declareOptions = [](CLI::App& app) {
        app.add_option("--seed");
        app.add_option("--time-limit");
        app.add_flag("--quiet");
    };
    part.command.run = [ends](Console& console) {
        std::raise(SIGINT);
        if (!ends) {
            throw Interrupted();
        }
        ResultFile none("");
        deliverPage({"Title", "", "One of two.", std::nullopt, {}, {}}, none, console);
        return int{kExitCheckFailed};
    };
    return part;
}

TEST(InterruptedReport, JoinsThePartsThatAreDone) {
    const TemporaryFolder folder;
    for (const bool ends : {true, false}) {
        const std::vector<ReportPart> parts{interruptedPart("alpha", ends),
                                            interruptedPart("beta", ends)};
        const Typed ended = typed(reportCommand(parts), {"--html", folder.file("r.html")});
        EXPECT_EQ(ended.exitCode, 130);
        const std::string verdict =
            ends ? "Checked 0 of 2 parts; not checked: alpha; interrupted, which left out beta."
                 : "Checked 0 of 2 parts; interrupted, which left out alpha, beta.";
        EXPECT_TRUE(holds(ended.out, verdict));
        EXPECT_TRUE(holds(readFile(folder.file("r.html")), verdict));
        EXPECT_FALSE(holds(ended.out, "BROKEN"));
    }
}

}  // namespace
}  // namespace hashphase::demos
