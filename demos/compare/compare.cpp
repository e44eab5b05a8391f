// SPDX-License-Identifier: Zlib
#include <demos/compare/compare.hpp>

#include <demos/compare/comparison.hpp>
#include <demos/compare/open_trial.hpp>
#include <demos/compare/report.hpp>
#include <demos/console/format.hpp>
#include <demos/console/result_file.hpp>
#include <demos/scenes/box_scene.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/world_scenes.hpp>

#include <algorithm>
#include <ostream>
#include <string_view>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr int kDefaultFrames = 120;

void printLists(std::span<const BroadphaseKind> kinds, std::ostream& out) {
    const auto line = [&out](std::string_view name, std::string_view description) {
        out << "  " << name << std::string(16 - name.size(), ' ') << description << '\n';
    };
    out << "Scenes:\n";
    for (const BoxSceneKind& kind : boxSceneKinds()) {
        line(kind.name, kind.description);
    }
    for (const WorldSceneKind& kind : worldSceneKinds()) {
        line(kind.name, kind.description);
    }
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
    const std::optional<int> limit = opened.trial->frameLimit();
    if (limit && options.frames && *options.frames > *limit) {
        throw InputError(opened.name + " holds " + std::to_string(*limit) + " frames, but " +
                         std::to_string(*options.frames) + " were asked for.");
    }
    const int frames = options.frames.value_or(kDefaultFrames);
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
    settings.bounds = opened.trial->bounds();
    for (const Contestant& each : contestants) {
        if (!each.leftOutAfter) {
            settings.broadphases.emplace_back(each.kind->name);
        }
    }
    settings.noun = opened.noun;
    settings.areSpheres = opened.noun == "spheres";
    settings.sharesBoxes = opened.trial->sharesBoxes();
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
    return openTrial(options, [&progress](std::string_view what) { progress.update(0, what); });
}

}  // namespace

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
        chosen = defaultKinds(kinds, opened.trial->objectCount());
    }

    CompareReport report;
    report.scene = opened.name;
    report.provenance = gatherProvenance(console.commandLine);
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
    const std::size_t objects = opened.trial->objectCount();
    const ComparisonEnd end = runFrames(*opened.trial, settings, contestants,
                                        report.replay ? &*report.replay : nullptr, measured);
    measured.add("run",
                 {{"scene", opened.name},
                  {"description", opened.description},
                  {"noun", opened.noun},
                  {"from_file", !options.file.empty()},
                  {"objects", objects},
                  {"frames_asked", frames},
                  {"warm_up", end.warmUpFrames},
                  {"frames_done", end.framesDone},
                  {"removed", end.objectsRemoved},
                  {"seed", options.sceneSeed()},
                  {"reference", options.reference == ReferenceMethod::kBrute ? "brute" : "sweep"},
                  {"time_limit", options.timeLimit},
                  {"limit_hit", end.timeLimitHit}});
    report.framesDone = end.framesDone;
    report.wasAnythingTimed = end.framesDone > end.warmUpFrames;
    report.findings = compareFindings(measured);

    printReport(report, console.out);
    json.write([&report](std::ostream& file) { writeJson(report, file); });
    csv.write([&report](std::ostream& file) { writeCsv(report.findings.rows.at("csv"), file); });
    deliverPage(pageOf(report), html, console);
    const bool isVerified =
        end.framesDone > 0 &&
        std::none_of(contestants.begin(), contestants.end(), [](const Contestant& each) {
            return each.kind->ours && (each.isWrong || each.leftOutAfter);
        });
    return isVerified ? kExitOk : kExitCheckFailed;
}

}  // namespace hashphase::demos
