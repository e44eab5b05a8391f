// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase wander`: the paper's simulation to watch and play with, in a window or to pictures.

#include <demos/console/program.hpp>
#include <demos/viewer/session/scene_choice.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

struct WanderOptions {
    SceneChoice scene;                  // its seed is its own, unless there is one here:
    std::optional<std::uint64_t> seed;  // that was asked for
    std::string size = "1280x800";      // of the picture or window [pixels]
    bool isHeadless = false;
    std::vector<std::string> commands;    // run at the start
    std::string scriptFile;               // run then
    std::string replayFile;               // instead of a scene
    std::string recordFile;               // written at the end; empty: none
    std::string screenshotFile;           // the same
    std::string jsonFile;                 // the same
    std::optional<std::uint64_t> frames;  // to be simulated
    std::optional<double> timeLimit;      // [s]
    std::optional<std::size_t> threads;   // at most; all that there are otherwise
    bool quiet = false;
    bool list = false;
};

/// Shows the scene, and returns the exit code: kExitCheckFailed when an expectation of a script does not
/// hold, or a recording comes out otherwise. Throws InputError for bad options, files and commands, and where
/// no picture can be drawn or written: what was played until then has been written.
int runWander(const WanderOptions& options, Console& console);

/// The subcommand, as its program runs it.
[[nodiscard]] Subcommand wanderCommand();

}  // namespace hashphase::demos
