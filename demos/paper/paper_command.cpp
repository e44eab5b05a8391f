// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_command.hpp>

#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/paper/paper.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/system/other_programs.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

void declarePaper(CLI::App& app, PaperOptions& options) {
    app.add_flag("--quick", options.quick, "measure less: 20 seconds instead of 90");
    app.add_option("--objects", options.objects,
                   "numbers of objects, separated by commas (default: the paper's, 500 to 50,000); "
                   "above 50,000 the area grows, so that the density stays")
        ->delimiter(',')
        ->transform(wholeFrom(2, 1'000'000));
    app.add_option("--frames", options.frames,
                   "maximum number of frames per method (default: 60, with --quick 6)")
        ->transform(wholeFrom(1, 100'000));
    app.add_option("--radius", options.aiRadius,
                   "radius in metres in which agents count colours; the paper does not give it")
        ->transform(metresFrom(0, 1000))
        ->capture_default_str();
    app.add_option("--seed", options.seed, "seed of all random numbers")
        ->transform(seedUpTo())
        ->capture_default_str();
    addFileToWrite(app, "--json", options.jsonFile, "write all results to this file");
    addFileToWrite(app, "--csv", options.csvFile, "write a row per measurement to this file");
    addFileToWrite(app, "--html", options.htmlFile,
                   "write a page with tables and charts to this file");
    app.add_option(
           "--time-limit", options.timeLimit,
           "stop measuring after this many seconds; with this option, hashphase is measured before "
           "the other methods")
        ->transform(positiveSeconds());
    app.add_flag("--ms", options.showMilliseconds,
                 "print milliseconds per frame instead of frames per second");
    app.add_flag("--quiet", options.quiet, "print no progress");
}

int runPaper(const PaperOptions& options, Console& console) {
    const PaperPlan plan = planOf(options);
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);
    Provenance provenance = gatherProvenance(console.commandLine);
    const auto measure = [&] {
        const TimeLimit limit(options.timeLimit);
        Progress progress(console.err, progressStyle(console, options.quiet), "paper",
                          paperSteps(plan));
        PaperWatch watcher;
        watcher.isTimeUp = [&limit] { return limit.isOver(); };
        watcher.tellProgress = [&](std::size_t done, std::string_view what) {
            progress.update(done, what);
        };
        return measurePaper(plan, watcher);
    };
    const OtherPrograms others;
    Measurements measured = measure();
    provenance.coresOfOthers = others.cores();
    PaperReport report(plan, std::move(measured), std::move(provenance));
    printReport(report, options.showMilliseconds, console);
    ResultFaults faults;
    faults.collect([&] { json.write([&](std::ostream& out) { writeJson(report, out); }); });
    faults.collect([&] { csv.write([&](std::ostream& out) { writeCsv(report, out); }); });
    faults.collect([&] { deliverPage(pageOf(report), html, console); });
    faults.throwIfAny();
    return exitCodeOf(report);
}

}  // namespace

PaperPlan planOf(const PaperOptions& options) {
    PaperPlan plan;
    plan.seed = options.seed;
    plan.aiRadius = options.aiRadius;
    if (options.quick) {
        plan.sweepObjects = 2'500;
        plan.sticks = 2'000;
        plan.effort.frames = 6;
        plan.effort.fewestFrames = 1;
        plan.effort.methodMilliseconds = 30;
    }
    if (!options.objects.empty()) {
        plan.objects = options.objects;
        std::sort(plan.objects.begin(), plan.objects.end());
        plan.objects.erase(std::unique(plan.objects.begin(), plan.objects.end()),
                           plan.objects.end());
        plan.sweepObjects = std::min(plan.sweepObjects, plan.objects.back());
        plan.sticks = std::min(plan.sticks, plan.objects.back());
    }
    plan.effort.frames = options.frames.value_or(plan.effort.frames);
    plan.effort.fewestFrames = std::min(plan.effort.fewestFrames, plan.effort.frames);
    plan.effort.isHurried = options.timeLimit.has_value();
    return plan;
}

Subcommand paperCommand() {
    return makeSubcommand<PaperOptions>("paper", declarePaper, runPaper);
}

}  // namespace hashphase::demos
