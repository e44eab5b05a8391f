// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_command.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/effects/effects_prices.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/other_programs.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

constexpr const char* kIntroduction =
    "hashphase is a spatial hash for the Bullet physics engine and for games. A scene declares its "
    "effects, and a frame runs only these. This page shows the cost of each effect in one scene, "
    "and what the scene lacks without it. The scene ran with and without each effect, in turn "
    "within each frame.";

constexpr std::uint32_t kQuickObjects = 2'000;
constexpr std::uint32_t kQuickFrames = 60;

struct EffectsOptions {
    std::string scene = "paper";
    std::string file;  // instead of a scene, where not empty
    std::optional<std::uint32_t> objects;
    std::optional<std::uint32_t> frames;  // measured; the scene's own number otherwise
    std::optional<std::uint32_t> seed;
    std::string jsonFile;  // empty: none
    std::string csvFile;
    std::string htmlFile;
    std::optional<double> timeLimit;  // [s]
    bool isQuick = false;             // fewer objects and frames, unless their numbers are given
    bool quiet = false;
    bool list = false;
    bool show = false;    // only write the scene's file
    bool schema = false;  // only write the schema of such files
};

void declareEffects(CLI::App& app, EffectsOptions& options) {
    CLI::Option* scene =
        app.add_option("--scene", options.scene, "built-in scene; --list prints all")
            ->type_name("NAME")
            ->capture_default_str();
    addFileToRead(app, "--file", options.file, "read this scene file (JSON) instead")
        ->excludes(scene);
    app.add_option("--objects", options.objects, "number of bodies (default: the scene's own)")
        ->transform(wholeFrom(1, 1'000'000));
    app.add_option("--frames", options.frames, "number of frames (default: the scene's own)")
        ->transform(wholeFrom(1, 1'000'000));
    app.add_option("--seed", options.seed, "seed of the scene")
        ->transform(seedUpTo(std::numeric_limits<std::uint32_t>::max()));
    addFileToWrite(app, "--json", options.jsonFile, "write all results to this file");
    addFileToWrite(app, "--csv", options.csvFile,
                   "write a row per variant of the scene to this file");
    addFileToWrite(app, "--html", options.htmlFile, "write a page with charts to this file");
    app.add_option("--time-limit", options.timeLimit, "stop after this many seconds")
        ->transform(positiveSeconds());
    app.add_flag("--quick", options.isQuick,
                 "measure less: at most 2,000 bodies and 60 frames, unless you set them");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list, "print the scenes, and exit");
    app.add_flag("--show", options.show,
                 "print the scene as JSON, to start your own scene file with, and exit");
    app.add_flag("--schema", options.schema, "print the JSON schema of scene files, and exit");
}

EffectsFile chosenScene(const EffectsOptions& options) {
    if (!options.file.empty()) {
        return readEffectsFile(options.file);
    }
    std::vector<std::string> known;
    for (const ExampleScene& each : exampleScenes()) {
        if (each.name == options.scene) {
            return parseEffectsFile(each.text, std::string(each.name) + ".json");
        }
        known.emplace_back(each.name);
    }
    throw InputError(unknownNameSentence("scene", options.scene, known));
}

void printList(std::ostream& out) {
    out << "Scenes:\n";
    for (const ExampleScene& each : exampleScenes()) {
        const EffectsFile file = parseEffectsFile(each.text, std::string(each.name));
        out << "  " << each.name << std::string(13 - each.name.size(), ' ') << file.title
            << "\n               " << file.scene.objects
            << " bodies; effects: " << namesOf(file.effects.set()) << '\n';
    }
}

Measurements measure(const EffectsFile& file, PricingSettings settings,
                     const EffectsOptions& options, Console& console) {
    settings.limit = TimeLimit(options.timeLimit);
    Progress progress(console.err, progressStyle(console, options.quiet), "effects",
                      pricingSteps(file, settings));
    settings.tellProgress = [&](std::size_t done, std::string_view what) {
        progress.update(done, what);
    };
    return priceEffects(file, settings);
}

void printReport(const Findings& findings, const Provenance& provenance, const Console& console) {
    const auto& [caption, prices] = findings.printed.front();
    printSentences({caption}, console);
    printTable(prices, console.out);
    constexpr std::size_t kIndent = 14;  // of what an effect does
    for (const std::string& line : sentencesOf(findings.rows.at("below"))) {
        console.out << wrapped(line, lineWidth(console), kIndent) << '\n';
    }
    printSentences(sentencesOf(findings.rows.at("end of the run")), console);
    printProvenance(provenance, console);
    printVerdict(findings.verdict, console);
}

/// Every variant with its times, counters and bytes, and the prices.
void writeJson(const Findings& findings, const Provenance& provenance, const EffectsFile& file,
               std::ostream& out) {
    const auto rows = [&](const char* name) { return rowsJson(findings.rows.at(name)); };
    Json json{{"schema", "hashphase-effects"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(provenance)},
              {"scene", Json::parse(effectsFileText(file))}};
    json.update(rows("end").front());
    for (const char* name : {"checks", "prices", "variants"}) {
        json[name] = rows(name);
    }
    out << textOf(json);
}

int runEffects(const EffectsOptions& options, Console& console, std::size_t (*allocationCount)()) {
    if (options.list) {
        printList(console.out);
        return kExitOk;
    }
    if (options.schema) {
        console.out << effectsFileSchema();
        return kExitOk;
    }
    EffectsFile file = chosenScene(options);
    if (options.isQuick) {
        file.scene.objects = std::min(file.scene.objects, kQuickObjects);
        file.scene.frames = std::min(file.scene.frames, kQuickFrames);
    }
    file.scene.objects = options.objects.value_or(file.scene.objects);
    file.scene.frames = options.frames.value_or(file.scene.frames);
    file.scene.seed = options.seed.value_or(file.scene.seed);
    if (options.show) {
        console.out << effectsFileText(file);
        return kExitOk;
    }
    const std::string name = options.file.empty() ? options.scene : options.file;
    if (const std::string error = simulationError(file.effects); !error.empty()) {
        throw InputError(name + ": " + error);
    }
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);

    Provenance provenance = gatherProvenance(console.commandLine);
    const OtherPrograms others;
    PricingSettings settings;
    settings.scene = name;
    settings.frames = file.scene.frames;
    settings.allocationCount = allocationCount;
    Measurements measured = measure(file, settings, options, console);
    provenance.coresOfOthers = others.cores();
    const Findings findings = effectsFindings(measured);
    printReport(findings, provenance, console);
    ResultFaults faults;
    faults.collect([&] {
        json.write([&](std::ostream& out) { writeJson(findings, provenance, file, out); });
    });
    faults.collect(
        [&] { csv.write([&](std::ostream& out) { writeCsv(findings.rows.at("csv"), out); }); });
    faults.collect([&] {
        deliverPage({"What each effect costs", kIntroduction, findings.verdict + ".",
                     findings.holds, findings.sections, provenance},
                    html, console);
    });
    faults.throwIfAny();
    return findings.holds.value_or(true) ? kExitOk : kExitCheckFailed;
}

}  // namespace

Subcommand effectsCommand(std::size_t (*allocationCount)()) {
    return makeSubcommand<EffectsOptions>("effects", declareEffects,
                                          [allocationCount](const auto& options, Console& console) {
                                              return runEffects(options, console, allocationCount);
                                          });
}

}  // namespace hashphase::demos
