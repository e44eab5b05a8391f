// SPDX-License-Identifier: Zlib
#pragma once

// What the steps of a trial took.

#include <demos/try/tried_run.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// The runs of a trial with that broadphase, in their order.
[[nodiscard]] std::vector<const TriedRun*> runsOf(const Trial& trial,
                                                  tryout::Broadphase broadphase);

/// Whether several threads of the program work in a step: whoever waits for others has no processor then, and
/// the clock on the wall is the one that tells how long a step takes.
[[nodiscard]] bool isOnThreads(const std::vector<tryout::StepRow>& rows);

/// A step with one broadphase: means over the same steps of all runs. Times, in milliseconds, are those of the
/// steps but for the fastest and the slowest twentieth, as machines have fits, so that parts add up. They are
/// those of the processor, which other programs do not lengthen; where a step is on threads, those of the narrow
/// phase, of rays and of whole steps are on the wall.
struct StepSummary {
    std::size_t stepCount = 0;
    double updateAabbs = 0;
    double calculate = 0;
    double rays = 0;  // as much of their time on the wall as the thread had a processor
    std::optional<double> narrowPhase;  // on the wall where a step is on threads; nothing: not seen
    std::optional<double> step;         // the same; nothing where the program makes no steps
    double rayCount = 0;
    double raysBetween = 0;  // outside of steps
    double rayBetweenCount = 0;
    double objectCount = 0;               // the most
    double pairCount = 0;                 // after a calculation
    std::optional<double> truePairCount;  // scaled up from the steps in which they were counted

    double slowest = 0;       // a step of the slowest twentieth
    double slowestShare = 0;  // of these, of the time of all steps

    double stepOnWall = 0;
    double processorShare =
        1;  // of that time, in which the thread that waits for nobody had a processor

    [[nodiscard]] double broadphase() const { return updateAabbs + calculate + rays; }

    /// Pairs that do not overlap, which the narrow phase visits all the same.
    [[nodiscard]] std::optional<double> stalePairCount() const;
};

/// Of at least one step.
[[nodiscard]] StepSummary summaryOf(const std::vector<tryout::StepRow>& rows, bool onThreads);

/// Both broadphases over the same steps: run by run, the first ones, as many as both have. Nothing where that
/// is none.
struct StepComparison {
    StepSummary stock;
    StepSummary ours;
    bool onThreads = false;      // in either
    bool isCut = false;          // one of two runs had more steps
    std::size_t allOfStock = 0;  // steps of the runs, those of which there are no others included
    std::size_t allOfOurs = 0;
};
[[nodiscard]] std::optional<StepComparison> compareSteps(const Trial& trial);

/// The step with Bullet's broadphase, of which ours takes the place; nothing where its time is not known.
[[nodiscard]] std::optional<double> projectedStep(const StepSummary& stock,
                                                  const StepSummary& ours);

}  // namespace hashphase::demos
