// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/try/try.hpp>

#include <iosfwd>
#include <optional>
#include <string>

namespace hashphase::demos {

/// The middle of all steps with one broadphase. Times in milliseconds, medians; counts a step, means.
struct StepSummary {
    std::size_t stepCount = 0;
    double updateAabbs = 0;
    double calculate = 0;
    double rays = 0;
    std::optional<double> step;  // nothing where the program's Bullet does not tell
    double rayCount = 0;
    double objectCount = 0;  // the most
    double pairCount = 0;
    std::optional<double> truePairCount;  // scaled up from the steps in which they were counted

    [[nodiscard]] double broadphase() const { return updateAabbs + calculate + rays; }
};

/// Nothing where there was no step.
[[nodiscard]] std::optional<StepSummary> summaryOf(const Trial& trial,
                                                   tryout::Broadphase broadphase);

/// The step with Bullet's broadphase, of which ours takes the place; nothing where its time is not known.
[[nodiscard]] std::optional<double> projectedStep(const StepSummary& stock,
                                                  const StepSummary& ours);

void printTrial(const Trial& trial, std::ostream& out);
void writeTrialJson(const Trial& trial, const std::string& commandLine, std::ostream& out);

}  // namespace hashphase::demos
