// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase paper`: figures 13, 14 and 15 of the paper, then and today, and what the paper leaves open.

#include <demos/experiment/findings.hpp>
#include <demos/paper/phase_measurement.hpp>

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

inline constexpr float kAiRadius = 10;  // [m]; the paper does not give it

struct PaperPlan {
    std::vector<std::uint32_t> objects{kPrintedObjects.begin(), kPrintedObjects.end()};
    std::uint64_t seed = 1;
    float aiRadius = kAiRadius;
    std::uint32_t sweepObjects = 20'000;  // of the sweeps of radius and cell size
    std::uint32_t sticks = 10'000;
    PhaseEffort effort;
};

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

/// Who is told, and asked, while it is measured.
struct PaperWatch {
    IsTimeUp isTimeUp = [] { return false; };
    std::function<void(std::size_t done, std::string_view what)> tellProgress =
        [](std::size_t, std::string_view) {};
};

/// How many steps it tells of.
[[nodiscard]] std::size_t paperSteps(const PaperPlan& plan);

/// The row of `plan`.
void addPlan(const PaperPlan& plan, Measurements& measured);

/// All rows, which paper.sql names.
[[nodiscard]] Measurements measurePaper(const PaperPlan& plan, const PaperWatch& watch = {});

struct PaperReport {
    /// What paper.sql shows of the measured.
    PaperReport(PaperPlan itsPlan, Measurements itsMeasured, Provenance itsProvenance = {});

    PaperPlan plan;
    Measurements measured;
    Provenance provenance;
    Findings findings;
};

/// kExitCheckFailed when a method found something else than brute force, or nothing was compared.
/// Times do not matter.
[[nodiscard]] int exitCodeOf(const PaperReport& report);

/// The figures as tables, in milliseconds or in frames a second, what was checked, and the verdict.
void printReport(PaperReport& report, bool showMilliseconds, const Console& console);

/// Schema "hashphase-paper".
void writeJson(PaperReport& report, std::ostream& out);

/// A row for each method of each part.
void writeCsv(PaperReport& report, std::ostream& out);

/// All of it as a page with charts.
[[nodiscard]] Page pageOf(const PaperReport& report);

}  // namespace hashphase::demos
