// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase compare`: a scene run with our broadphase and Bullet's, the pair sets verified in every
// frame, the times side by side.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <demos/console/program.hpp>

#include <cstdint>
#include <optional>
#include <span>
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
    bool quiet = false;               // no progress
    bool list = false;                // only say which scenes and broadphases there are

    [[nodiscard]] std::uint64_t sceneSeed() const noexcept { return seed.value_or(1); }
};

/// Runs the comparison, writes the table and the verdict to console.out, and returns the exit code:
/// kExitCheckFailed when a broadphase of ours missed or invented a pair, or the time limit left no frame
/// of it to verify. Throws InputError for unknown names, broken files, and files that cannot be
/// written.
int runCompare(const CompareOptions& options, std::span<const BroadphaseKind> kinds,
               Console& console);

}  // namespace hashphase::demos
