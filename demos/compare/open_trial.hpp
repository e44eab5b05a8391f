// SPDX-License-Identifier: Zlib
#pragma once

// From the scene or file that was asked for to the trial that runs it.

#include <demos/compare/trial.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

struct CompareOptions {
    std::string scene = "paper";
    std::string file;                      // instead of a scene, where not empty
    std::optional<std::size_t> objects;    // the scene's own number otherwise
    std::optional<int> frames;             // 120, or all that a recording holds, otherwise
    std::vector<std::string> broadphases;  // empty: the default choice
    std::optional<std::uint64_t> seed;     // 1 otherwise
    ReferenceMethod reference = ReferenceMethod::kSweep;
    std::string jsonFile;             // empty: none
    std::string csvFile;              // empty: none
    std::string htmlFile;             // empty: none
    std::optional<int> replayFrames;  // in the page; as many of 120 as leave it small otherwise
    std::optional<double> timeLimit;  // [s]
    bool isQuick = false;             // fewer objects and frames, unless their numbers are given
    bool isVerbose = false;           // all columns in the table
    bool quiet = false;               // no progress
    bool list = false;                // only say which scenes and broadphases there are

    [[nodiscard]] std::uint64_t sceneSeed() const noexcept { return seed.value_or(1); }
};

struct OpenedTrial {
    std::string name;  // of the scene, or the file's path
    std::string description;
    std::string noun;  // what the objects are, in the plural
    std::unique_ptr<Trial> trial;
};

/// Throws InputError for unknown scenes, broken files, and more objects than a file has.
[[nodiscard]] OpenedTrial openTrial(const CompareOptions& options, const TellWaiting& tell = {});

}  // namespace hashphase::demos
