// SPDX-License-Identifier: Zlib
#pragma once

// From the scene or file that was asked for to the trial that runs it.

#include <demos/compare/compare.hpp>
#include <demos/compare/trial.hpp>
#include <demos/scenes/tell_waiting.hpp>

#include <memory>
#include <string>

namespace hashphase::demos {

struct OpenedTrial {
    std::string name;  // of the scene, or the file's path
    std::string description;
    std::string noun;  // what the objects are, in the plural
    std::unique_ptr<Trial> trial;
};

/// Throws InputError for unknown scenes, broken files, and more objects than a file has.
[[nodiscard]] OpenedTrial openTrial(const CompareOptions& options, const TellWaiting& tell = {});

}  // namespace hashphase::demos
