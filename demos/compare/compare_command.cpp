// SPDX-License-Identifier: Zlib
#include <demos/compare/compare_command.hpp>

#include <demos/compare/compare.hpp>
#include <demos/console/options.hpp>

#include <CLI/CLI.hpp>

#include <map>

namespace hashphase::demos {
namespace {

void declare(CLI::App& app, CompareOptions& options) {
    CLI::Option* scene = app.add_option("--scene", options.scene, "built-in scene (see --list)")
                             ->capture_default_str();
    addFileToRead(app, "--file", options.file,
                  "instead of a scene: a .bullet world, a .aabbs recording (as by 'capture' of "
                  "hashphase wander), or a text file of boxes")
        ->excludes(scene);
    app.add_option("--objects", options.objects, "number of objects (default: the scene's)")
        ->transform(wholeFrom(1, 10'000'000));
    app.add_option("--frames", options.frames, "number of frames, warm-up included (default: 120)")
        ->transform(wholeFrom(1, 1'000'000));
    app.add_option("--broadphases", options.broadphases,
                   "which to compare, separated by commas (see --list)")
        ->delimiter(',');
    app.add_option("--seed", options.seed, "seed of the scene, or of the boxes' drift (default: 1)")
        ->transform(seedUpTo());
    app.add_option("--reference", options.reference,
                   "how the exact pairs are found: sweep (along one axis) or brute (all pairs)")
        ->transform(CLI::CheckedTransformer(
                        std::map<std::string, ReferenceMethod>{{"sweep", ReferenceMethod::kSweep},
                                                               {"brute", ReferenceMethod::kBrute}})
                        .description(""))
        ->type_name("sweep|brute");
    addFileToWrite(app, "--json", options.jsonFile, "write everything measured to this file");
    addFileToWrite(app, "--csv", options.csvFile, "write the rows of all frames to this file");
    CLI::Option* html =
        addFileToWrite(app, "--html", options.htmlFile,
                       "write a page with charts to this file; its tab Replay plays the first "
                       "frames in a browser with WebGL2");
    app.add_option("--replay-frames", options.replayFrames,
                   "so many frames to be replayed in the page, however large that makes it; 0 for "
                   "none (default: what keeps it below 6 MB)")
        ->needs(html)
        ->transform(wholeFrom(0, 10'000));
    app.add_option("--time-limit", options.timeLimit, "stop after so many seconds")
        ->transform(positiveSeconds());
    app.add_flag("--quiet", options.quiet, "no progress on stderr");
    app.add_flag("--list", options.list, "say which scenes and broadphases there are");
}

}  // namespace

Subcommand compareCommand(std::span<const BroadphaseKind> kinds) {
    return makeSubcommand<CompareOptions>("compare", declare,
                                          [kinds](const auto& options, Console& console) {
                                              return runCompare(options, kinds, console);
                                          });
}

}  // namespace hashphase::demos
