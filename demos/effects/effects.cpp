// SPDX-License-Identifier: Zlib
#include <demos/effects/effects.hpp>

#include <demos/console/nearest_name.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/effects/effects_report.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/scenes/input_error.hpp>

#include <ostream>

namespace hashphase::demos {
namespace {

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

EffectPrices measure(const EffectsFile& file, const EffectsOptions& options, Console& console,
                     std::size_t (*allocationCount)()) {
    PricingSettings settings;
    settings.frames = file.scene.frames;
    settings.allocationCount = allocationCount;
    const Stopwatch watch;
    settings.isTimeUp = [&] {
        return options.timeLimit && watch.milliseconds() > 1000 * *options.timeLimit;
    };
    Progress progress(console.err, progressStyle(console, options.quiet), "effects",
                      pricingSteps(file, settings));
    settings.tellProgress = [&](std::size_t done, std::string_view what) {
        progress.update(done, what);
    };
    return priceEffects(file, settings);
}

}  // namespace

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
    file.scene.objects = options.objects.value_or(file.scene.objects);
    file.scene.frames = options.frames.value_or(file.scene.frames);
    file.scene.seed = options.seed.value_or(file.scene.seed);
    if (options.show) {
        console.out << effectsFileText(file);
        return kExitOk;
    }
    const std::string error = simulationError(file.effects);
    if (!error.empty()) {
        throw InputError((options.file.empty() ? options.scene : options.file) + ": " + error);
    }
    ResultFile json(options.jsonFile);
    ResultFile csv(options.csvFile);
    ResultFile html(options.htmlFile);

    EffectsReport report;
    report.name = options.file.empty() ? options.scene : options.file;
    report.provenance = gatherProvenance(console.commandLine);
    report.prices = measure(file, options, console, allocationCount);
    printReport(report, console.out);
    json.write([&report](std::ostream& out) { writeJson(report, out); });
    csv.write([&report](std::ostream& out) { writeCsv(report, out); });
    deliverPage(pageOf(report), html, console);
    return allHold(report) ? kExitOk : kExitCheckFailed;
}

}  // namespace hashphase::demos
