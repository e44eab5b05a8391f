// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_command.hpp>

#include <demos/console/options.hpp>
#include <demos/console/subcommands.hpp>
#include <demos/effects/effects.hpp>

#include <CLI/CLI.hpp>

#include <limits>
#include <memory>

namespace hashphase::demos {
namespace {

void declareEffects(CLI::App& app, EffectsOptions& options) {
    CLI::Option* scene = app.add_option("--scene", options.scene, "built-in scene (see --list)")
                             ->capture_default_str();
    addFileToRead(app, "--file", options.file, "instead of a scene: a scene file of yours (JSON)")
        ->excludes(scene);
    app.add_option("--objects", options.objects, "number of bodies (default: the scene's)")
        ->transform(wholeFrom(1, 1'000'000));
    app.add_option("--frames", options.frames, "number of frames (default: the scene's)")
        ->transform(wholeFrom(1, 1'000'000));
    app.add_option("--seed", options.seed, "seed of the scene")
        ->transform(seedUpTo(std::numeric_limits<std::uint32_t>::max()));
    addFileToWrite(app, "--json", options.jsonFile, "write everything measured to this file");
    addFileToWrite(app, "--csv", options.csvFile, "write a row for each variant to this file");
    addFileToWrite(app, "--html", options.htmlFile, "write a page with charts to this file");
    app.add_option("--time-limit", options.timeLimit, "stop after so many seconds")
        ->transform(positiveSeconds());
    app.add_flag("--quiet", options.quiet, "no progress on stderr");
    app.add_flag("--list", options.list, "say which scenes there are");
    app.add_flag("--show", options.show, "write the scene as a file, to begin one of yours with");
    app.add_flag("--schema", options.schema, "write the JSON schema of scene files");
}

}  // namespace

Subcommand effectsCommand(std::size_t (*allocationCount)()) {
    auto options = std::make_shared<EffectsOptions>();
    Subcommand command;
    command.name = "effects";
    command.description = descriptionOf(command.name);
    command.declareOptions = [options](CLI::App& app) { declareEffects(app, *options); };
    command.run = [options, allocationCount](Console& console) {
        return runEffects(*options, console, allocationCount);
    };
    return command;
}

}  // namespace hashphase::demos
