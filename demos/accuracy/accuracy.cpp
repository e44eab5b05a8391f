// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy.hpp>

#include <demos/accuracy/accuracy_page.hpp>
#include <demos/accuracy/report.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/console/nearest_name.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

void printList(std::span<const Experiment> experiments, std::ostream& out) {
    for (const Experiment& each : experiments) {
        out << "  " << each.id << std::string(5 - each.id.size(), ' ') << each.title << ": "
            << each.question << '\n';
    }
}

std::vector<const Experiment*> chosenExperiments(const std::vector<std::string>& ids,
                                                 std::span<const Experiment> experiments) {
    std::vector<std::string> known;
    for (const Experiment& each : experiments) {
        known.emplace_back(each.id);
    }
    std::vector<const Experiment*> chosen;
    for (const std::string& id : ids) {
        if (std::find(known.begin(), known.end(), id) == known.end()) {
            throw InputError(unknownNameSentence("experiment", id, known));
        }
    }
    for (const Experiment& each : experiments) {
        if (ids.empty() || std::find(ids.begin(), ids.end(), each.id) != ids.end()) {
            chosen.push_back(&each);
        }
    }
    return chosen;
}

/// Tells the progress of all experiments by how long each is expected to take.
class OverallProgress {
public:
    OverallProgress(std::span<const Experiment* const> chosen, const AccuracyOptions& options,
                    Console& console)
        : isQuick_(options.effort.isQuick),
          progress_(console.err, progressStyle(console, options.quiet), "accuracy", kSteps) {
        for (const Experiment* each : chosen) {
            total_ += secondsOf(*each);
        }
    }

    void begin(const Experiment& experiment) { tell(experiment, 0, experiment.title); }
    void tell(const Experiment& experiment, double share, std::string_view what) {
        const double done = done_ + secondsOf(experiment) * std::clamp(share, 0.0, 1.0);
        progress_.update(static_cast<std::size_t>(kSteps * done / total_),
                         std::string(experiment.id) + ": " + std::string(what));
    }
    void end(const Experiment& experiment) { done_ += secondsOf(experiment); }

private:
    static constexpr std::size_t kSteps = 1000;

    [[nodiscard]] double secondsOf(const Experiment& each) const {
        return isQuick_ ? each.quickSeconds : each.fullSeconds;
    }

    bool isQuick_;
    double total_ = 0;
    double done_ = 0;
    Progress progress_;
};

// An experiment that cannot go on has not shown what it was to show.
Findings findingsOf(const Experiment& experiment, const Effort& effort, const TellProgress& tell) {
    try {
        return experiment.run(effort, tell);
    } catch (const std::exception& error) {
        Findings findings;
        findings.checks.push_back({"The experiment comes to its end", false, error.what()});
        return findings;
    }
}

void run(std::span<const Experiment* const> chosen, const AccuracyOptions& options,
         AccuracyReport& report, Console& console) {
    OverallProgress progress(chosen, options, console);
    const Stopwatch sinceBegin;
    for (const Experiment* each : chosen) {
        if (options.timeLimit && sinceBegin.milliseconds() > 1000 * *options.timeLimit) {
            report.leftOut.emplace_back(each->id);
            continue;
        }
        progress.begin(*each);
        const Stopwatch stopwatch;
        Findings findings = findingsOf(
            *each, options.effort,
            [&](double share, std::string_view what) { progress.tell(*each, share, what); });
        progress.end(*each);
        report.outcomes.push_back({each, std::move(findings), stopwatch.milliseconds() / 1000});
    }
}

}  // namespace

std::vector<std::string> brokenChecks(const AccuracyReport& report) {
    std::vector<std::string> broken;
    for (const Outcome& outcome : report.outcomes) {
        for (const Check& check : outcome.findings.checks) {
            if (!check.holds) {
                broken.push_back(std::string(outcome.experiment->id) + ": " + check.claim + " (" +
                                 check.evidence + ")");
            }
        }
    }
    return broken;
}

std::vector<Choice> allChoices(const AccuracyReport& report) {
    std::vector<Choice> choices;
    for (const Outcome& outcome : report.outcomes) {
        const std::vector<Choice>& own = outcome.findings.choices;
        choices.insert(choices.end(), own.begin(), own.end());
    }
    return choices;
}

std::string verdictLine(const AccuracyReport& report) {
    std::size_t checks = 0;
    for (const Outcome& outcome : report.outcomes) {
        checks += outcome.findings.checks.size();
    }
    const std::size_t broken = brokenChecks(report).size();
    const auto counted = [](std::size_t count, const std::string& noun) {
        return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
    };
    return counted(report.outcomes.size(), "experiment") + ", " + counted(checks, "check") + ": " +
           (broken == 0 ? "all hold" : std::to_string(broken) + " BROKEN") +
           leftOutText(report.leftOut);
}

int runAccuracy(const AccuracyOptions& options, std::span<const Experiment> experiments,
                Console& console) {
    if (options.list) {
        printList(experiments, console.out);
        return kExitOk;
    }
    const std::vector<const Experiment*> chosen = chosenExperiments(options.only, experiments);
    if (!options.folder.empty()) {
        std::error_code error;
        std::filesystem::create_directories(options.folder, error);
        if (error) {
            throw InputError(options.folder + " cannot be made: " + error.message() + ".");
        }
    }
    ResultFile page(options.folder.empty() ? "" : options.folder + "/accuracy.html");
    pinToThisCore();
    AccuracyReport report;
    report.effort = options.effort;
    report.provenance = gatherProvenance(console.commandLine);
    run(chosen, options, report, console);

    printReport(report, console.out);
    if (!options.folder.empty()) {
        writeReport(report, options.folder);
    }
    deliverPage(pageOf(report), page, console);
    return brokenChecks(report).empty() ? kExitOk : kExitCheckFailed;
}

}  // namespace hashphase::demos
