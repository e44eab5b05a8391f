// SPDX-License-Identifier: Zlib
#pragma once

// What must be known to trust a measurement, or to repeat it.

#include <array>
#include <optional>
#include <string>

namespace hashphase::demos {

struct Provenance {
    std::string hashphaseVersion;
    std::string bulletVersion;
    std::string precision;  // "single" or "double"
    std::string compiler;
    std::string compilerFlags;  // of the grid; empty when the build did not tell
    std::string programFlags;   // further ones of what the grid is compared with; empty: none
    bool optimised = false;
    bool hasAssertions = false;
    std::string buildType;        // as CMake calls it: "Release"
    bool isForMeasuring = false;  // the release configuration, without assertions or sanitizers
    std::string instructionSet;   // of the grid's kernels, on this processor: "AVX2"
    std::string cpu;
    unsigned cores = 0;
    std::optional<std::array<double, 3>> loadAverage;  // over 1, 5, 15 minutes
    std::string commandLine;
};

[[nodiscard]] Provenance gatherProvenance(const std::string& commandLine);

}  // namespace hashphase::demos
