// SPDX-License-Identifier: Zlib
#pragma once

// What try.sql makes of a trial: text for people, JSON for programs.

#include <demos/experiment/findings.hpp>
#include <demos/try/tried_run.hpp>

#include <iosfwd>

namespace hashphase::demos {

struct TrialReport {
    Provenance provenance;
    Measurements measured;
    Findings findings;  // which hold where all is well
};

[[nodiscard]] TrialReport reportOf(const Trial& trial);

/// How the program has ended comes last, where that is not with status 0.
void printTrial(const TrialReport& report, std::ostream& out);
void writeTrialJson(TrialReport& report, std::ostream& out);

}  // namespace hashphase::demos
