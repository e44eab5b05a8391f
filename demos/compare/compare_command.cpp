// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>

#include <demos/compare/comparison.hpp>
#include <demos/compare/open_trial.hpp>
#include <demos/compare/report.hpp>
#include <demos/compare/step_profile.hpp>
#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/result_file.hpp>
#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/world_scenes.hpp>
#include <demos/system/other_programs.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <ostream>
#include <string_view>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr int kDefaultFrames = 120;
constexpr int kQuickFrames = 60;

void declare(CLI::App& app, CompareOptions& options) {
    CLI::Option* scene =
        app.add_option("--scene", options.scene, "built-in scene; --list prints all")
            ->type_name("NAME")
            ->capture_default_str();
    addFileToRead(app, "--file", options.file,
                  "read this file instead of a scene: a Bullet world (.bullet), a Broadmark "
                  "recording (.aabbs), or text with a box per line: min x y z max x y z [m]")
        ->excludes(scene);
    app.add_option("--objects", options.objects,
                   "number of objects (default: see --list), or of boxes to read from a file "
                   "(default: all)")
        ->transform(wholeFrom(1, 10'000'000));
    app.add_option("--frames", options.frames, "number of frames, warm-up included (default: 120)")
        ->transform(wholeFrom(1, 1'000'000));
    app.add_option("--broadphases", options.broadphases,
                   "broadphases to compare, separated by commas; --list prints all")
        ->type_name("NAME")
        ->delimiter(',');
    app.add_option(
           "--seed", options.seed,
           "seed of the scene, or of the random drift of boxes from a text file (default: 1)")
        ->transform(seedUpTo());
    app.add_option("--reference", options.reference,
                   "how to find the exact pairs: sweep (along one axis, the default) or brute "
                   "(test every pair)")
        ->transform(CLI::CheckedTransformer(
                        std::map<std::string, ReferenceMethod>{{"sweep", ReferenceMethod::kSweep},
                                                               {"brute", ReferenceMethod::kBrute}})
                        .description(""))
        ->type_name("sweep|brute");
    addFileToWrite(app, "--json", options.jsonFile, "write all results to this file");
    addFileToWrite(app, "--csv", options.csvFile,
                   "write a row per frame and broadphase to this file");
    CLI::Option* html =
        addFileToWrite(app, "--html", options.htmlFile,
                       "write a page with charts to this file; its Replay tab plays the first "
                       "frames, in a browser with WebGL2");
    app.add_option("--replay-frames", options.replayFrames,
                   "number of frames that the page can replay; 0: none (default: as many of 120 as "
                   "fit in 6 MB)")
        ->needs(html)
        ->transform(wholeFrom(0, 10'000));
    app.add_option("--time-limit", options.timeLimit, "stop after this many seconds")
        ->transform(positiveSeconds());
    app.add_flag("--quick", options.isQuick,
                 "measure less: at most 60 frames, and in a built-in scene at most 10,000 objects, "
                 "unless you set them");
    app.add_flag("--verbose", options.isVerbose, "print all columns, and the parts of a step");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list, "print the scenes and broadphases, and exit");
}

void printLists(std::span<const BroadphaseKind> kinds, std::ostream& out) {
    const auto line = [&out](std::string_view name, std::string_view description) {
        out << "  " << name << std::string(16 - name.size(), ' ') << description << '\n';
    };
    const auto scene = [&line](const auto& kind) {
        line(kind.name,
             std::string(kind.description) + " (" + withThousands(kind.defaultObjects) + ")");
    };
    out << "Scenes, with their numbers of objects:\n";
    std::ranges::for_each(boxSceneKinds(), scene);
    std::ranges::for_each(worldSceneKinds(), scene);
    out << "Broadphases:\n";
    for (const BroadphaseKind& kind : kinds) {
        line(kind.name, kind.description);
    }
}

// Throws for unknown names. Nothing named: nothing chosen yet.
std::vector<const BroadphaseKind*> chosenKinds(const std::vector<std::string>& names,
                                               std::span<const BroadphaseKind> kinds) {
    std::vector<std::string> known;
    for (const BroadphaseKind& kind : kinds) {
        known.emplace_back(kind.name);
    }
    std::vector<const BroadphaseKind*> chosen;
    for (const std::string& name : names) {
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            throw InputError(unknownNameSentence("broadphase", name, known));
        }
        const BroadphaseKind* kind = &kinds[static_cast<std::size_t>(found - known.begin())];
        if (std::find(chosen.begin(), chosen.end(), kind) == chosen.end()) {
            chosen.push_back(kind);
        }
    }
    return chosen;
}

std::vector<const BroadphaseKind*> defaultKinds(std::span<const BroadphaseKind> kinds,
                                                std::size_t objects) {
    std::vector<const BroadphaseKind*> chosen;
    for (const BroadphaseKind& kind : kinds) {
        if (objects <= kind.defaultUpTo) {
            chosen.push_back(&kind);
        }
    }
    return chosen;
}

int framesToRun(const CompareOptions& options, const OpenedTrial& opened) {
    const std::optional<int> limit = opened.trial->facts.frameLimit;
    if (limit && options.frames && *options.frames > *limit) {
        throw InputError(opened.name + " holds " + std::to_string(*limit) +
                         " frames, but --frames asks for " + std::to_string(*options.frames) + ".");
    }
    const int frames = options.frames.value_or(options.isQuick ? kQuickFrames : kDefaultFrames);
    return limit ? std::min(frames, *limit) : frames;
}

/// What is asked for however large it is must still fit into what a browser opens.
constexpr std::size_t kMostReplayBytes = 200'000'000;

std::optional<ReplayRecording> replayFor(const CompareOptions& options, const OpenedTrial& opened,
                                         const std::vector<Contestant>& contestants,
                                         bool isPageWanted) {
    if (!isPageWanted || options.replayFrames == 0) {
        return std::nullopt;
    }
    ReplaySettings settings;
    settings.scene = opened.name;
    settings.bounds = opened.trial->facts.bounds;
    settings.ground = opened.trial->facts.ground;
    for (const Contestant& each : contestants) {
        if (!each.leftOutAfter) {
            if (each.kind->ours) {
                settings.opensOn = settings.broadphases.size();
            }
            settings.broadphases.emplace_back(each.kind->name);
        }
    }
    settings.noun = opened.noun;
    settings.areSpheres = opened.noun == "spheres";
    settings.sharesBoxes = opened.trial->facts.sharesBoxes;
    if (!settings.sharesBoxes) {
        // Each broadphase's boxes are recorded: the first frame must fit at least.
        settings.objects /= 4;
        settings.pairs /= 4;
    }
    if (options.replayFrames) {
        settings.frames = static_cast<std::size_t>(*options.replayFrames);
        settings.bytes = kMostReplayBytes;
    }
    return ReplayRecording(std::move(settings));
}

OpenedTrial open(const CompareOptions& options, Console& console) {
    Progress progress(console.err, progressStyle(console, options.quiet),
                      "opening " + (options.file.empty() ? options.scene : options.file), 1);
    return openTrial(options, [&progress](std::string_view what) {
        progress.update(0, what);
        throwIfInterrupted();
    });
}

int runCompare(const CompareOptions& options, std::span<const BroadphaseKind> kinds,
               Console& console) {
    if (options.list) {
        printLists(kinds, console.out);
        return kExitOk;
    }
    std::vector<const BroadphaseKind*> chosen = chosenKinds(options.broadphases, kinds);
    const TimeLimit limit(options.timeLimit);
    OpenedTrial opened = open(options, console);
    if (chosen.empty()) {
        chosen = defaultKinds(kinds, opened.trial->facts.objects);
    }

    CompareReport report;
    report.scene = opened.name;
    report.provenance = gatherProvenance(console.commandLine);
    const OtherPrograms others;
    const int frames = framesToRun(options, opened);
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);

    const ComparisonSettings settings{frames, limit, progressStyle(console, options.quiet),
                                      console.err};
    std::vector<Contestant> contestants = fillBroadphases(*opened.trial, chosen, settings);
    report.replay = replayFor(options, opened, contestants,
                              !options.htmlFile.empty() || static_cast<bool>(console.takePage));
    Measurements measured;
    const std::size_t objects = opened.trial->facts.objects;
    const ComparisonEnd end = runFrames(*opened.trial, settings, contestants,
                                        report.replay ? &*report.replay : nullptr, measured);
    if (std::unique_ptr<Trial> profiled = limit.isOver() ? nullptr : opened.trial->profiled()) {
        opened.trial = nullptr;  // makes room for the same worlds again
        profileSteps(*profiled, settings, end, contestants, measured);
    }
    report.provenance.coresOfOthers = others.cores();
    const bool isStopped = end.isStopped || isInterrupted();
    measured.add("run",
                 {{"scene", opened.name},
                  {"description", opened.description},
                  {"noun", opened.noun},
                  {"from_file", !options.file.empty()},
                  {"objects", objects},
                  {"frames_asked", frames},
                  {"warm_up", end.warmUpFrames},
                  {"frames_done", end.framesDone},
                  {"removed", end.objectsToRemove},
                  {"seed", options.sceneSeed()},
                  {"reference", options.reference == ReferenceMethod::kBrute ? "brute" : "sweep"},
                  {"time_limit", options.timeLimit},
                  {"interrupted", isInterrupted()},
                  {"stopped", isStopped ? Datum(limit.reason()) : Datum()}});
    report.framesDone = end.framesDone;
    report.wasAnythingTimed = end.framesDone > end.warmUpFrames;
    report.findings = compareFindings(measured);

    printReport(report, options.isVerbose, console);
    ResultFaults faults;
    faults.collect([&] { json.write([&](std::ostream& file) { writeJson(report, file); }); });
    faults.collect([&] {
        csv.write([&](std::ostream& file) { writeCsv(report.findings.rows.at("csv"), file); });
    });
    faults.collect([&] { deliverPage(pageOf(report), html, console); });
    faults.throwIfAny();
    const bool isVerified =
        end.framesDone > 0 &&
        std::none_of(contestants.begin(), contestants.end(), [](const Contestant& each) {
            return each.kind->ours && (each.isWrong || each.leftOutAfter);
        });
    return isVerified ? kExitOk : kExitCheckFailed;
}

}  // namespace

Subcommand compareCommand(std::span<const BroadphaseKind> kinds) {
    return makeSubcommand<CompareOptions>("compare", declare,
                                          [kinds](const auto& options, Console& console) {
                                              return runCompare(options, kinds, console);
                                          });
}

}  // namespace hashphase::demos
