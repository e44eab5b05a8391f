// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase accuracy`: runs experiments, writes what they found, and says what to choose.

#include <demos/accuracy/experiment.hpp>
#include <demos/console/program.hpp>
#include <demos/report/provenance.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct AccuracyOptions {
    std::vector<std::string> only;  // ids; empty: all
    Effort effort;
    std::string folder;               // for the report and its data; empty: none is written
    std::optional<double> timeLimit;  // [s], after which no experiment begins
    bool quiet = false;
    bool list = false;
};

/// One experiment, done.
struct Outcome {
    const Experiment* experiment = nullptr;
    Findings findings;
    double seconds = 0;
};

struct AccuracyReport {
    Effort effort;
    std::vector<Outcome> outcomes;
    std::vector<std::string> leftOut;  // ids, for want of time
    Provenance provenance;
};

/// P1 to P10.
[[nodiscard]] std::span<const Experiment> experiments();

/// Runs the experiments, prints what they found, writes the report, and returns the exit code:
/// kExitCheckFailed when a check does not hold. Throws InputError for unknown ids and for files that
/// cannot be written.
int runAccuracy(const AccuracyOptions& options, std::span<const Experiment> experiments,
                Console& console);

/// The checks of all outcomes that do not hold, as "P1: claim (evidence)".
[[nodiscard]] std::vector<std::string> brokenChecks(const AccuracyReport& report);

/// The choices of all experiments, in their order.
[[nodiscard]] std::vector<Choice> allChoices(const AccuracyReport& report);

/// One sentence: how many experiments and checks, whether all hold, and what was left out.
[[nodiscard]] std::string verdictLine(const AccuracyReport& report);

}  // namespace hashphase::demos
