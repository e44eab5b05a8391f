// SPDX-License-Identifier: Zlib
#include <demos/report/report_command.hpp>

#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/report/page.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/system/other_programs.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr const char* kReportIntroduction =
    "hashphase is a spatial hash that replaces the broadphase of the Bullet physics engine. It "
    "finds "
    "the pairs of bodies whose bounding boxes overlap. The same grid answers ray, culling, AI and "
    "terrain queries. This page shows everything that the program measures, part by part, also "
    "where it loses. You can run each part alone.";

struct ReportOptions {
    bool isQuick = false;
    std::vector<std::string> only;  // names; empty: all
    std::uint32_t seed = 1;
    std::string htmlFile = "hashphase-report.html";
    std::optional<double> timeLimit;  // [s]
    bool quiet = false;
};

void declareReport(CLI::App& app, ReportOptions& options) {
    app.add_flag("--quick", options.isQuick,
                 "measure less: 90 seconds instead of a quarter of an hour");
    app.add_option(
           "--only", options.only,
           "run only these of compare, paper, accuracy, effects and stability, separated by commas")
        ->type_name("NAME")
        ->delimiter(',');
    addFileToWrite(app, "--html", options.htmlFile, "write the page to this file")
        ->capture_default_str();
    app.add_option("--seed", options.seed, "seed of all random numbers")
        ->transform(seedUpTo(std::numeric_limits<std::uint32_t>::max()))
        ->capture_default_str();
    app.add_option("--time-limit", options.timeLimit,
                   "seconds for all parts together; the page names what is left out")
        ->transform(positiveSeconds());
    app.add_flag("--quiet", options.quiet, "print no progress");
}

/// Runs the parts, and joins what they hand in.
class ReportRun {
public:
    ReportRun(std::vector<const ReportPart*> parts, const ReportOptions& options, Console& console)
        : parts_(std::move(parts)), options_(options), console_(console) {}

    [[nodiscard]] Page run() {
        page_.title = "hashphase, measured";
        page_.introduction = kReportIntroduction;
        page_.provenance = gatherProvenance(console_.commandLine);
        const OtherPrograms others;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            runPart(i);
        }
        page_.provenance.coresOfOthers = others.cores();
        conclude();
        return std::move(page_);
    }

private:
    /// Of what is left, the part's share of the expected time of all that are to come.
    [[nodiscard]] std::optional<double> secondsFor(std::size_t index) const {
        if (!options_.timeLimit) {
            return std::nullopt;
        }
        const auto expected = [this](const ReportPart* part) {
            return options_.isQuick ? part->quickSeconds : part->fullSeconds;
        };
        double toCome = 0;
        for (std::size_t i = index; i < parts_.size(); ++i) {
            toCome += expected(parts_[i]);
        }
        return limit_.secondsLeft() * expected(parts_[index]) / toCome;
    }

    void runPart(std::size_t index) {
        const ReportPart& part = *parts_[index];
        const std::string& name = part.command.name;
        if (limit_.isOver()) {
            leftOut_.push_back(name);
            return;
        }
        const std::optional<double> seconds = secondsFor(index);
        if (!options_.quiet) {
            console_.err << "part " << index + 1 << " of " << parts_.size() << ": " << name << '\n';
        }
        std::vector<std::string> arguments;
        if (options_.isQuick) {
            arguments = part.quickOptions;
        }
        arguments.insert(arguments.end(), {"--seed", std::to_string(options_.seed)});
        if (seconds) {
            arguments.insert(arguments.end(), {"--time-limit", fixed(std::max(*seconds, 0.1), 1)});
        }
        const Stopwatch watch;
        try {
            page_.parts.push_back(pageOfPart(part, arguments));
        } catch (const Interrupted&) {
            leftOut_.push_back(name);
            return;
        }
        const Page& done = page_.parts.back();
        const std::string evidence = name + ", " + fixed(watch.milliseconds() / 1000, 0) + " s";
        if (done.holds) {
            inShort_.checks.push_back({done.verdict, *done.holds, evidence});
        } else {
            notChecked_.push_back(name);
            inShort_.conclusions.push_back("Not checked: " + done.verdict + " (" + evidence + ")");
        }
        console_.out << name << ": " << done.verdict << '\n';
        if (const std::string overload = overloadSentence(done.provenance); !overload.empty()) {
            console_.out << overload << '\n';
        }
        console_.out << std::flush;
    }

    // A part that cannot go on has not shown what it was to show. Throws Interrupted.
    [[nodiscard]] Page pageOfPart(const ReportPart& part, const std::vector<std::string>& options) {
        std::ostream nowhere(nullptr);
        Page page{part.command.name, "", "It made no page.", false, {}, {}};
        Console console{nowhere, console_.err, console_.errIsTerminal,
                        "hashphase " + part.command.name};
        for (const std::string& option : options) {
            console.commandLine += " " + option;
        }
        console.takePage = [&page](const Page& taken) { page = taken; };
        page.provenance.commandLine = console.commandLine;
        CLI::App app;
        part.command.declareOptions(app);
        std::vector<std::string> arguments(options.rbegin(),
                                           options.rend());  // as CLI11 takes them
        if (options_.quiet) {
            arguments.insert(arguments.begin(), "--quiet");
        }
        try {
            app.parse(std::move(arguments));
            // A part that had no time to check anything ends like one that is broken, but says nothing that holds.
            if (part.command.run(console) != kExitOk && !isInterrupted() && page.holds) {
                page.holds = false;
            }
        } catch (const Interrupted&) {
            throw;
        } catch (const std::exception& error) {
            page.holds = false;
            page.verdict = std::string("It failed: ") + error.what();
        }
        return page;
    }

    void conclude() {
        const auto broken = std::ranges::count(inShort_.checks, false, &Check::holds);
        page_.verdict = "Checked " + std::to_string(inShort_.checks.size()) + " of " +
                        std::to_string(parts_.size()) + (parts_.size() == 1 ? " part" : " parts");
        if (!inShort_.checks.empty()) {
            page_.holds = broken == 0;
            page_.verdict += broken == 0 ? ": all checks hold"
                                         : ": checks of " + std::to_string(broken) + " are BROKEN";
        }
        page_.verdict += namesText("; not checked: ", notChecked_) + leftOutText(leftOut_) + ".";
        inShort_.heading = "In short";
        if (options_.isQuick) {
            inShort_.sentences = {"Measured with --quick: fewer objects, fewer frames."};
        }
        page_.sections = {std::move(inShort_)};
    }

    std::vector<const ReportPart*> parts_;
    const ReportOptions& options_;
    Console& console_;
    TimeLimit limit_{options_.timeLimit};
    Page page_;
    PageSection inShort_;                  // the verdict of each part
    std::vector<std::string> notChecked_;  // ran, but had no time to check anything
    std::vector<std::string> leftOut_;     // for want of time
};

int runReport(const std::vector<ReportPart>& parts, const ReportOptions& options,
              Console& console) {
    std::vector<const ReportPart*> chosen =
        chosenOf("part", options.only, std::span(parts),
                 [](const ReportPart& part) { return part.command.name; });
    ResultFile file(options.htmlFile);
    const Page page = ReportRun(std::move(chosen), options, console).run();
    deliverPage(page, file, console);
    console.out << page.verdict << " The page is " << options.htmlFile << ".\n";
    for (const std::string& caution : cautionsOf(page.provenance)) {
        console.out << caution << '\n';
    }
    return page.holds.value_or(false) ? kExitOk : kExitCheckFailed;
}

}  // namespace

Subcommand reportCommand(std::vector<ReportPart> parts) {
    return makeSubcommand<ReportOptions>(
        "report", declareReport, [parts = std::move(parts)](const auto& options, Console& console) {
            return runReport(parts, options, console);
        });
}

}  // namespace hashphase::demos
