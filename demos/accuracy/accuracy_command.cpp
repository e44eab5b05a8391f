// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_command.hpp>

#include <demos/accuracy/accuracy_report.hpp>
#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/other_programs.hpp>
#include <demos/system/process.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

using Experiments = std::vector<const Experiment*>;

struct AccuracyOptions {
    std::vector<std::string> only;  // ids; empty: all
    Effort effort;
    std::string folder;               // for the report and its data; empty: none is written
    std::optional<double> timeLimit;  // [s], after which no experiment begins
    bool isVerbose = false;           // print tables and conclusions
    bool quiet = false;
    bool list = false;
};

void declare(CLI::App& app, AccuracyOptions& options) {
    app.add_option("--only", options.only,
                   "run only these experiments, separated by commas; --list prints all")
        ->type_name("ID")
        ->delimiter(',');
    app.add_flag("--quick", options.effort.isQuick,
                 "measure less: under a minute instead of about ten");
    addFolderToWrite(app, "--output", options.folder,
                     "write the report (accuracy.html) and its data (JSON, CSV) to this folder");
    app.add_option("--seed", options.effort.seed, "seed of all random numbers")
        ->transform(seedUpTo())
        ->capture_default_str();
    app.add_option("--time-limit", options.timeLimit, "begin no experiment after this many seconds")
        ->transform(positiveSeconds());
    app.add_flag("--verbose", options.isVerbose, "print all tables and conclusions");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list, "print the experiments, and exit");
}

// An experiment that cannot go on has not shown what it was to show.
Findings findingsOf(const Experiment& experiment, const Effort& effort, const TellProgress& tell) {
    try {
        return experiment.run(effort, tell);
    } catch (const Interrupted&) {
        throw;
    } catch (const std::exception& error) {
        Findings findings;
        findings.checks.push_back({"The experiment comes to its end", false, error.what()});
        return findings;
    }
}

/// Tells the progress of all experiments by how long each is expected to take.
void run(const Experiments& chosen, const AccuracyOptions& options, AccuracyReport& report,
         Console& console) {
    constexpr std::size_t kSteps = 1000;
    Progress progress(console.err, progressStyle(console, options.quiet), "accuracy", kSteps);
    const auto secondsOf = [&](const Experiment& each) {
        return options.effort.isQuick ? each.quickSeconds : each.fullSeconds;
    };
    double total = 0;
    for (const Experiment* each : chosen) {
        total += secondsOf(*each);
    }
    double done = 0;
    const TimeLimit limit(options.timeLimit);
    for (const Experiment* each : chosen) {
        if (limit.isOver()) {
            report.leftOut.emplace_back(each->id);
            continue;
        }
        const auto tell = [&](double share, std::string_view what) {
            throwIfInterrupted();
            const double now = done + secondsOf(*each) * std::clamp(share, 0.0, 1.0);
            progress.update(static_cast<std::size_t>(kSteps * now / total),
                            std::string(each->id) + ": " + std::string(what));
        };
        const Stopwatch stopwatch;
        try {
            tell(0, each->title);
            Findings findings = findingsOf(*each, options.effort, tell);
            report.outcomes.push_back({each, std::move(findings), stopwatch.milliseconds() / 1000});
        } catch (const Interrupted&) {
            report.leftOut.emplace_back(each->id);
        }
        done += secondsOf(*each);
    }
}

int runAccuracy(const AccuracyOptions& options, std::span<const Experiment> experiments,
                Console& console) {
    if (options.list) {
        for (const Experiment& each : experiments) {
            console.out << "  " << each.id << std::string(5 - each.id.size(), ' ') << each.title
                        << ": " << each.question << '\n';
        }
        return kExitOk;
    }
    const Experiments chosen = chosenOf("experiment", options.only, experiments,
                                        [](const Experiment& each) { return each.id; });
    if (!options.folder.empty()) {
        std::error_code error;
        std::filesystem::create_directories(options.folder, error);
        if (error) {
            throw InputError("The folder " + options.folder +
                             " cannot be made: " + error.message() + ".");
        }
    }
    ResultFile page(options.folder.empty() ? "" : options.folder + "/accuracy.html");
    pinToThisCore();
    AccuracyReport report{options.effort, {}, {}, gatherProvenance(console.commandLine)};
    const OtherPrograms others;
    run(chosen, options, report, console);
    report.provenance.coresOfOthers = others.cores();

    printReport(report, options.isVerbose, console);
    ResultFaults faults;
    if (!options.folder.empty()) {
        faults.collect([&] { writeReport(report, options.folder); });
    }
    faults.collect([&] { deliverPage(pageOf(report), page, console); });
    faults.throwIfAny();
    return brokenChecks(report).empty() ? kExitOk : kExitCheckFailed;
}

}  // namespace

Subcommand accuracyCommand(std::span<const Experiment> known) {
    return makeSubcommand<AccuracyOptions>("accuracy", declare,
                                           [known](const auto& options, Console& console) {
                                               return runAccuracy(options, known, console);
                                           });
}

}  // namespace hashphase::demos
