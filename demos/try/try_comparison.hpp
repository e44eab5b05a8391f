// SPDX-License-Identifier: Zlib
#pragma once

// What is said of the steps of a trial.

#include <demos/try/step_summary.hpp>
#include <demos/try/try.hpp>

#include <iosfwd>

namespace hashphase::demos {

void printStepTable(const StepComparison& steps, std::ostream& out);

/// What the swap makes of a step, in parts that add up; whether the machine was busy, and what to trust then.
void printVerdict(const StepComparison& steps, const Provenance& machine, std::ostream& out);

/// Of a trial that was ended in its first run, or whose program does something else each time.
void printNotCompared(const Trial& trial, std::ostream& out);

}  // namespace hashphase::demos
