// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/benchmark_command.hpp>

#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/time_limit.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/other_programs.hpp>

#include <algorithm>
#include <memory>
#include <ostream>
#include <regex>
#include <utility>

namespace hashphase::benchmarks {
namespace {

constexpr const char* kDescription =
    "Measures hashphase next to Bullet's broadphases and the broadphases of other libraries. In "
    "each frame all contestants run one after the other on the same objects, and every answer is "
    "checked. Prints a table per case, and one for all cases. All cases take 40 minutes. Above "
    "100,000 objects (--sizes) btDbvtBroadphase takes seconds per frame.";

constexpr int kQuickFrames = 5;
constexpr int kQuickWarmUpFrames = 3;

void declare(CLI::App& app, BenchmarkOptions& options) {
    app.add_option(
           "--only", options.only,
           "run only cases whose name matches one of these regular expressions, separated by "
           "commas; some cases, such as 'cellsize', run only on request")
        ->delimiter(',')
        ->type_name("REGEX");
    app.add_option("--sizes", options.sizes,
                   "numbers of objects, separated by commas, for the cases that take any number")
        ->delimiter(',')
        ->transform(demos::wholeFrom(1, 10'000'000));
    app.add_option("--contestants", options.contestants,
                   "run only these contestants, separated by commas; --list prints all. Without "
                   "dbvt there are no ratios")
        ->type_name("NAME")
        ->delimiter(',');
    app.add_option("--frames", options.frames,
                   "measured frames per case (default: 60; up to 1,000 objects 300; for effects "
                   "1,000)")
        ->transform(demos::wholeFrom(1, 1'000'000));
    app.add_option("--seed", options.seed, "seed of all scenes")
        ->transform(demos::seedUpTo())
        ->capture_default_str();
    app.add_option("--time-limit", options.timeLimit, "stop after this many seconds")
        ->transform(demos::positiveSeconds());
    demos::addFileToWrite(app, "--json", options.jsonFile, "write all results to this file");
    app.add_flag("--quick", options.quick,
                 "check the answers only: at most 300 objects and 5 frames");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list, "print the cases and contestants, and exit");
}

void printLists(const std::vector<Benchmark>& benchmarks, const std::vector<ContestantKind>& kinds,
                std::ostream& out) {
    const auto line = [&out](const std::string& name, const std::string& description) {
        constexpr std::size_t kWidth = 26;
        out << "  " << name << std::string(kWidth - std::min(name.size(), kWidth - 1), ' ')
            << description << '\n';
    };
    out << "Cases (name/objects):\n";
    for (const Benchmark& benchmark : benchmarks) {
        line(benchmark.name, benchmark.description + (benchmark.onRequest ? " (on request)" : ""));
    }
    out << "Contestants:\n";
    for (const ContestantKind& kind : kinds) {
        line(kind.name, kind.description);
    }
}

// --- From what was asked for to the cases to run ----------------------------------------------------

using demos::InputError;

constexpr std::size_t kLargestQuick = 300;

std::vector<std::regex> compiled(const std::vector<std::string>& patterns) {
    std::vector<std::regex> expressions;
    for (const std::string& pattern : patterns) {
        try {
            expressions.emplace_back(pattern);
        } catch (const std::regex_error&) {
            throw InputError("'" + pattern + "' is not a regular expression.");
        }
    }
    return expressions;
}

bool isChosen(const Benchmark& benchmark, const std::string& name,
              const std::vector<std::regex>& expressions) {
    if (expressions.empty()) {
        return !benchmark.onRequest;
    }
    return std::any_of(
        expressions.begin(), expressions.end(),
        [&name](const std::regex& expression) { return std::regex_search(name, expression); });
}

std::vector<std::size_t> sizesOf(const Benchmark& benchmark, const BenchmarkOptions& options) {
    std::vector<std::size_t> sizes = benchmark.sizes;
    if (!options.sizes.empty() && benchmark.takesOtherSizes) {
        sizes = options.sizes;
    }
    for (std::size_t& size : sizes) {
        size = std::min(size, options.quick ? kLargestQuick : benchmark.largest);
    }
    std::sort(sizes.begin(), sizes.end());
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    return sizes;
}

std::vector<ContestantKind> chosenKinds(const std::vector<ContestantKind>& kinds,
                                        const std::vector<std::string>& names) {
    if (names.empty()) {
        return kinds;
    }
    std::vector<std::string> known;
    for (const ContestantKind& kind : kinds) {
        known.push_back(kind.name);
    }
    for (const std::string& name : names) {
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            throw InputError(demos::unknownNameSentence("contestant", name, known));
        }
    }
    std::vector<ContestantKind> chosen = kinds;
    std::erase_if(chosen, [&](const ContestantKind& kind) {
        return std::find(names.begin(), names.end(), kind.name) == names.end();
    });
    return chosen;
}

std::vector<ContestantKind> contestantsOf(const Benchmark& benchmark, std::size_t objects,
                                          const std::vector<ContestantKind>& chosen,
                                          std::uint64_t seed) {
    if (benchmark.contestants) {
        return benchmark.contestants(objects, seed);
    }
    std::vector<ContestantKind> admitted = chosen;
    std::erase_if(admitted,
                  [&](const ContestantKind& kind) { return !benchmark.admits(kind, objects); });
    return admitted;
}

/// Throws InputError for unknown contestants, bad expressions, and when nothing is chosen. The cases
/// point into `benchmarks`.
std::vector<Case> selectCases(const std::vector<Benchmark>& benchmarks,
                              const std::vector<ContestantKind>& kinds,
                              const BenchmarkOptions& options) {
    const std::vector<std::regex> expressions = compiled(options.only);
    const std::vector<ContestantKind> chosen = chosenKinds(kinds, options.contestants);
    std::vector<Case> cases;
    for (const Benchmark& benchmark : benchmarks) {
        for (const std::size_t size : sizesOf(benchmark, options)) {
            Case candidate{&benchmark, size, {}};
            if (!isChosen(benchmark, candidate.name(), expressions)) {
                continue;
            }
            candidate.contestants = contestantsOf(benchmark, size, chosen, options.seed);
            if (!candidate.contestants.empty()) {
                cases.push_back(std::move(candidate));
            }
        }
    }
    if (cases.empty()) {
        throw InputError(
            "No case matches --only, --sizes and --contestants; --list prints all cases.");
    }
    return cases;
}

// --- Running them ------------------------------------------------------------------------------------

// As many as were asked for, else as the case needs.
int framesOf(const Case& toRun, const BenchmarkReport& report) {
    const bool areAskedFor = report.options.frames || report.options.quick;
    if (areAskedFor) {
        return report.settings.frames;
    }
    const int needed = toRun.benchmark->frames;
    return needed != 0 ? needed : report.settings.framesOf(toRun.objects);
}

int warmUpFramesOf(const Case& toRun, const BenchmarkReport& report) {
    const int needed = toRun.benchmark->warmUpFrames;
    return needed != 0 && !report.options.quick ? needed : report.settings.warmUpFrames;
}

// What a frame of the case roughly costs, for foretelling how long all will take.
std::size_t weightOf(const Case& toRun) {
    return toRun.objects * toRun.contestants.size() + 1;
}

// Returns how many it has run.
std::size_t runCases(const std::vector<Case>& cases, BenchmarkReport& report,
                     demos::Console& console) {
    const demos::TimeLimit limit(report.options.timeLimit);
    const auto isTimeUp = [&limit] { return limit.isOver(); };
    const auto allFramesOf = [&report](const Case& toRun) {
        return static_cast<std::size_t>(framesOf(toRun, report) + warmUpFramesOf(toRun, report));
    };
    std::size_t total = 0;
    for (const Case& toRun : cases) {
        total += weightOf(toRun) * allFramesOf(toRun);
    }
    demos::Progress progress(console.err, demos::progressStyle(console, report.options.quiet),
                             "benchmarks", total);
    std::size_t done = 0;
    std::size_t i = 0;
    for (; i < cases.size() && !isTimeUp(); ++i) {
        const std::size_t frames = allFramesOf(cases[i]);
        MeasurementSettings settings = report.settings;
        settings.frames = framesOf(cases[i], report);
        settings.warmUpFrames = warmUpFramesOf(cases[i], report);
        settings.isTimeUp = isTimeUp;
        settings.tellProgress = [&](int framesDone) {
            progress.update(done + weightOf(cases[i]) * static_cast<std::size_t>(framesDone),
                            cases[i].name() + " (" + std::to_string(i + 1) + " of " +
                                std::to_string(cases.size()) + "), frame " +
                                std::to_string(framesDone) + " of " + std::to_string(frames));
        };
        const std::int64_t number = measure(cases[i], settings, report.measured);
        done += weightOf(cases[i]) * frames;
        progress.clear();
        report.stopped = isTimeUp() ? limit.reason() : "";
        printCase(report, number, console.out);
    }
    report.stopped = isTimeUp() ? limit.reason() : "";
    return i;
}

int runBenchmarks(const BenchmarkOptions& options, const std::vector<ContestantKind>& kinds,
                  demos::Console& console) {
    const std::vector<Benchmark> benchmarks = catalog(options.seed);
    if (options.list) {
        printLists(benchmarks, kinds, console.out);
        return demos::kExitOk;
    }
    const std::vector<Case> cases = selectCases(benchmarks, kinds, options);
    BenchmarkReport report;
    report.options = options;
    if (options.quick) {
        report.settings.frames = kQuickFrames;
        report.settings.warmUpFrames = kQuickWarmUpFrames;
    }
    report.settings.frames = options.frames.value_or(report.settings.frames);
    report.settings.seed = options.seed;
    report.provenance = demos::gatherProvenance(console.commandLine);
    const demos::OtherPrograms others;
    report.casesAsked = cases.size();
    demos::ResultFile json(options.jsonFile);

    printSetting(report, kinds, console.out);
    if (runCases(cases, report, console) == 0) {
        demos::throwIfInterrupted();
        console.out << report.stopped << " before the first case.\n";
        return demos::kExitCheckFailed;
    }
    report.provenance.coresOfOthers = others.cores();
    const bool isExact = printSummary(report, console.out);
    json.write([&report](std::ostream& file) { writeJson(report, file); });
    return isExact ? demos::kExitOk : demos::kExitCheckFailed;
}

}  // namespace

demos::Subcommand benchmarkCommand(std::vector<ContestantKind> kinds) {
    auto options = std::make_shared<BenchmarkOptions>();
    demos::Subcommand command;
    command.name = "tests/benchmarks/run";
    command.description = kDescription;
    command.declareOptions = [options](CLI::App& app) { declare(app, *options); };
    command.run = [options, kinds = std::move(kinds)](demos::Console& console) {
        return runBenchmarks(*options, kinds, console);
    };
    return command;
}

}  // namespace hashphase::benchmarks
