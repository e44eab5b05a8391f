// SPDX-License-Identifier: Zlib
#include <demos/paper/paper.hpp>

#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/paper/paper_report.hpp>
#include <demos/report/stopwatch.hpp>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
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

int runPaper(const PaperOptions& options, Console& console) {
    const PaperPlan plan = planOf(options);
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);

    PaperReport report;
    report.provenance = gatherProvenance(console.commandLine);
    {
        const Stopwatch watch;
        PaperWatch watcher;
        watcher.isTimeUp = [&] {
            return options.timeLimit && watch.milliseconds() > 1000 * *options.timeLimit;
        };
        Progress progress(console.err, progressStyle(console, options.quiet), "paper",
                          paperSteps(plan));
        watcher.tellProgress = [&](std::size_t done, std::string_view what) {
            progress.update(done, what);
        };
        report.results = measurePaper(plan, watcher);
    }
    printReport(report, options.showMilliseconds, console.out);
    json.write([&report](std::ostream& out) { writeJson(report, out); });
    csv.write([&report](std::ostream& out) { writeCsv(report, out); });
    deliverPage(pageOf(report), html, console);
    return exitCodeOf(report.results);
}

int exitCodeOf(const PaperResults& results) {
    return results.outcome() == CheckOutcome::holds ? kExitOk : kExitCheckFailed;
}

}  // namespace hashphase::demos
