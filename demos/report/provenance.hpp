// SPDX-License-Identifier: Zlib
#pragma once

// What must be known to trust a measurement, or to repeat it.

#include <chrono>
#include <optional>
#include <string>

namespace hashphase::demos {

struct Provenance {
    std::string date;  // when it began: "2025-11-29T13:05:07Z"
    std::string hashphaseVersion;
    std::string commit;  // of the source: "1a2b3c4d-dirty"; the version where there was no checkout
    std::string bulletVersion;
    std::string precision;  // "single" or "double"
    bool hasBulletThreads = false;
    bool hasBulletProfileZones = false;
    std::string
        bulletPackage;  // "libbullet3.24 3.24+dfsg-2"; empty: from no package that the build knows
    std::string compiler;
    std::string compilerFlags;  // of the grid; empty when the build did not tell
    std::string programFlags;   // further ones of what the grid is compared with; empty: none
    bool optimised = false;
    bool hasAssertions = false;
    std::string buildType;        // as CMake calls it: "Release"
    bool isForMeasuring = false;  // the release configuration, without assertions or sanitizers
    std::string instructionSet;   // of the grid's kernels, on this processor: "AVX2"
    std::string operatingSystem;  // "Linux 6.1.0-18-amd64 x86_64"
    std::string cpu;
    unsigned cores = 0;
    std::optional<double>
        coresOfOthers;  // that other programs used meanwhile: OtherPrograms::cores()
    std::string commandLine;
};

/// All that is known when measuring begins.
[[nodiscard]] Provenance gatherProvenance(const std::string& commandLine);

/// The time in UTC as "2025-11-29T13:05:07Z".
[[nodiscard]] std::string utcText(std::chrono::system_clock::time_point time);

/// Which state of the source the program was built from: see Provenance::commit.
[[nodiscard]] const char* sourceCommit() noexcept;

}  // namespace hashphase::demos
