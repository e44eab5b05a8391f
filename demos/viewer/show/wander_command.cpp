// SPDX-License-Identifier: Zlib
#include <demos/console/options.hpp>
#include <demos/console/subcommands.hpp>
#include <demos/viewer/show/wander.hpp>

#include <CLI/CLI.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace hashphase::demos {
namespace {

/// What is shown, and at its beginning. Returns what a recording decides by itself.
std::vector<CLI::Option*> declareScene(CLI::App& app, WanderOptions& options) {
    CLI::Option* scene =
        app.add_option("--scene", options.scene.name, "scene (see --list)")->capture_default_str();
    CLI::Option* file =
        addFileToRead(app, "--file", options.scene.file,
                      "instead of a scene: a scene file (.json), or a recording of boxes (.aabbs)")
            ->excludes(scene);
    CLI::Option* objects = app.add_option("--objects", options.scene.objects,
                                          "number of bodies (default: the scene's)");
    objects->transform(wholeFrom(1, kMostObjects));
    CLI::Option* seed =
        app.add_option("--seed", options.seed, "seed of the scene (default: 1, or a scene file's)");
    seed->transform(seedUpTo(kMostSeed));
    CLI::Option* commands =
        app.add_option("--do", options.commands, "run a command at the start; may be given again");
    commands->allow_extra_args(false);
    return {scene, file, objects, seed, commands};
}

/// What is done with it, and for how long.
void declareRun(CLI::App& app, WanderOptions& options,
                const std::vector<CLI::Option*>& sceneOptions) {
    CLI::Option* script =
        addFileToRead(app, "--script", options.scriptFile, "then run the commands of this file");
    CLI::Option* replay = addFileToRead(
        app, "--replay", options.replayFile,
        "play back a recording, and compare what comes out; a window pauses it (P), steps "
        "(O) and begins it again (R), but takes no command that would change it");
    replay->excludes(script);
    for (CLI::Option* other : sceneOptions) {
        replay->excludes(other);
    }
    app.add_option("--frames", options.frames,
                   "so many frames (default: until the window is closed; 300 without a window, or "
                   "fewer where a command pauses it)")
        ->transform(wholeFrom(1, 1'000'000'000))
        ->excludes(script)
        ->excludes(replay);
    app.add_option("--time-limit", options.timeLimit,
                   "stop after so many seconds; a script or a replay that this cuts off has failed")
        ->transform(positiveSeconds());
    app.add_option("--threads", options.threads,
                   "simulate on so many threads at most (default: all; Bullet's scenes on one)")
        ->transform(wholeFrom(1, 1024));
}

void declareWander(CLI::App& app, WanderOptions& options) {
    const std::vector<CLI::Option*> sceneOptions = declareScene(app, options);
    declareRun(app, options, sceneOptions);
    app.add_option("--size", options.size, "of the picture in pixels, up to 8,192 each way")
        ->capture_default_str();
    app.add_flag("--headless", options.isHeadless,
                 "without a window: pictures by screenshots only");
    addFileToWrite(app, "--record", options.recordFile, "write a recording at the end");
    addFileToWrite(app, "--screenshot", options.screenshotFile, "write a picture at the end (PNG)");
    addFileToWrite(app, "--json", options.jsonFile, "write all numbers at the end to this file");
    app.add_flag("--quiet", options.quiet, "no progress on stderr");
    app.add_flag("--list", options.list, "say which scenes, commands, keys and readings there are");
}

}  // namespace

Subcommand wanderCommand() {
    auto options = std::make_shared<WanderOptions>();
    Subcommand command;
    command.name = "wander";
    command.description = descriptionOf(command.name);
    command.declareOptions = [options](CLI::App& app) { declareWander(app, *options); };
    command.run = [options](Console& console) { return runWander(*options, console); };
    return command;
}

}  // namespace hashphase::demos
