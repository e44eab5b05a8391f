// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase effects`: what each effect of a scene costs, and what the scene lacks without it.

#include <demos/console/program.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace hashphase::demos {

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
    bool quiet = false;
    bool list = false;
    bool show = false;    // only write the scene's file
    bool schema = false;  // only write the schema of such files
};

/// Runs the scene with and without each effect, writes the price list, and returns the exit code:
/// kExitCheckFailed when an undeclared effect did anything, or changed a result. Throws InputError
/// for unknown names, broken files, and files that cannot be written. `allocationCount` says how often
/// the program has allocated; null where nobody counts.
int runEffects(const EffectsOptions& options, Console& console,
               std::size_t (*allocationCount)() = nullptr);

}  // namespace hashphase::demos
