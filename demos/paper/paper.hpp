// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase paper`: figures 13, 14 and 15 of the paper, then and today.

#include <demos/console/program.hpp>
#include <demos/paper/paper_results.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

struct PaperOptions {
    bool quick = false;
    std::vector<std::uint32_t> objects;   // empty: the paper's
    std::optional<std::uint32_t> frames;  // of a method, at most
    float aiRadius = kAiRadius;           // [m]
    std::uint64_t seed = 1;
    std::string jsonFile;  // empty: none
    std::string csvFile;
    std::string htmlFile;
    std::optional<double> timeLimit;  // [s]
    bool showMilliseconds = false;    // in the tables of text, in place of frames a second
    bool quiet = false;
};

/// What the options ask for; hurried where there is a time limit.
[[nodiscard]] PaperPlan planOf(const PaperOptions& options);

/// Measures, writes the figures, and returns exitCodeOf() them. Throws InputError for files that
/// cannot be written.
int runPaper(const PaperOptions& options, Console& console);

/// kExitCheckFailed when a method found something else than brute force, or nothing was compared.
/// Times do not matter.
[[nodiscard]] int exitCodeOf(const PaperResults& results);

}  // namespace hashphase::demos
