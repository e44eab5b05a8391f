// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/time_step_report.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

using Points = std::span<const TaskPoint>;
using Contestants = std::span<const PhysicsContestant>;

std::string withUnit(double error, const PhysicsMeasure& measure) {
    const std::string number = valueText(measure.unit.empty() ? 100 * error : error);
    return number + " " + (measure.unit.empty() ? "%" : measure.unit);
}

Check sameCheck(Contestants contestants, Points points) {
    const auto same = std::count_if(points.begin(), points.end(), [&](const TaskPoint& point) {
        return isSame(point, contestants);
    });
    return {
        "With lists in canonical order all broadphases pass through the same states, to the "
        "last bit: the curves coincide",
        same == std::ssize(points),
        std::to_string(same) + " of " + std::to_string(points.size()) + " settings"};
}

Check fallCheck(const PhysicsTask& task, Points points) {
    bool holds = true;
    double farthest = 0;
    double allowed = 0;
    for (const TaskPoint* point : bySteps(points, task)) {
        const double rounding = 1000 * fallRoundingOf(1.0 / point->stepping.stepsPerSecond(), 2);
        for (const TaskOutcome& outcome : point->outcomes) {
            const double away =
                std::abs(outcome.errors.front() - predictedFallError(point->stepping));
            holds = holds && away <= rounding;
            farthest = std::max(farthest, away);
        }
        allowed = std::max(allowed, rounding);
    }
    return {"Free fall goes wrong by what theory says of such steps, up to single precision", holds,
            "at most " + fixed(farthest, 3) + " mm away; rounding may add up to " +
                fixed(allowed, 2) + " mm with the shortest steps"};
}

void offer(Contestants contestants, Points points, std::vector<Choice>& choices) {
    for (const TaskPoint& point : points) {
        const PhysicsMeasure& measure = point.task->measures.front();
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            const TaskOutcome& outcome = point.outcomes[i];
            choices.push_back({point.task->title + ", one simulated second",
                               contestants[i].name + ", steps of " + settingText(point.stepping),
                               outcome.secondMs.median, outcome.errors.front(),
                               measure.title + ": " + withUnit(outcome.errors.front(), measure),
                               contestants[i].broadphase.isOurs});
        }
    }
}

/// How many times longer a task takes under the second of two contestants: in the least, the
/// median and the worst setting.
std::string ratioText(Points points, std::size_t first, std::size_t second) {
    std::vector<double> ratios;
    for (const TaskPoint& point : points) {
        ratios.push_back(point.outcomes[second].secondMs.median /
                         point.outcomes[first].secondMs.median);
    }
    std::sort(ratios.begin(), ratios.end());
    return fixed(percentile(ratios, 0.5), 2) + " times the time of the former in the median (" +
           fixed(ratios.front(), 2) + " to " + fixed(ratios.back(), 2) + ")";
}

void compareTimes(Contestants contestants, Points points, std::vector<std::string>& conclusions) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        for (std::size_t j = 0; j < contestants.size(); ++j) {
            if (contestants[i].order == contestants[j].order && contestants[i].broadphase.isOurs &&
                !contestants[j].broadphase.isOurs) {
                conclusions.push_back(contestants[i].name + " against " + contestants[j].name +
                                      ": the latter takes " + ratioText(points, i, j) + ".");
            }
        }
    }
}

/// What smaller steps did to every error, under the first contestant.
void followSteps(std::span<const PhysicsTask> tasks, Points points, std::string_view way,
                 std::vector<std::string>& conclusions) {
    const std::string contacts = way == kKeepingEnergy ? ", contacts that keep energy, " : ", ";
    for (const PhysicsTask& task : tasks) {
        const std::vector<const TaskPoint*> own = bySteps(points, task, way);
        for (std::size_t k = 0; k < task.measures.size(); ++k) {
            const PhysicsMeasure& measure = task.measures[k];
            const double before = own.front()->outcomes.front().errors[k];
            const double after = own.back()->outcomes.front().errors[k];
            conclusions.push_back(
                task.title + contacts + measure.title + ": " + withUnit(before, measure) +
                " with steps of " + stepText(own.front()->stepping) + ", " +
                withUnit(after, measure) + " with " + stepText(own.back()->stepping) +
                (after > before ? "; smaller steps make it worse." : "."));
        }
    }
}

/// The best that each way has reached, and for how much.
void compareWays(const PhysicsTask& task, Points points, std::vector<std::string>& conclusions) {
    std::vector<std::string> ways;
    for (const TaskPoint& point : points) {
        if (point.task == &task && std::find(ways.begin(), ways.end(), point.way) == ways.end()) {
            ways.push_back(point.way);
        }
    }
    const PhysicsMeasure& measure = task.measures.front();
    for (const std::string& way : ways) {
        const TaskPoint* best = nullptr;
        for (const TaskPoint& point : points) {
            const bool isOfWay = point.task == &task && point.way == way;
            if (isOfWay && (best == nullptr || point.outcomes.front().errors.front() <
                                                   best->outcomes.front().errors.front())) {
                best = &point;
            }
        }
        const TaskOutcome& outcome = best->outcomes.front();
        conclusions.push_back(task.title + ", " + way + ": at best " +
                              withUnit(outcome.errors.front(), measure) + ", for " +
                              milliseconds(outcome.secondMs.median) + " ms a simulated second (" +
                              settingText(best->stepping) + ").");
    }
}

}  // namespace

Findings judgeTimeSteps(std::span<const PhysicsTask> tasks, Contestants contestants,
                        Points points) {
    Findings findings;
    findings.settings = {
        std::string(kTimeStepSettings) + ".",
        "After SimBenchmark (Kang, Hwangbo and others). Truth: the laws of motion in double "
        "precision; that nothing overlaps. Errors of Bullet's steps against continuous motion are "
        "meant to be seen.",
        "Canonical order: pairs sorted by the numbers of the bodies, contacts by age and with "
        "m_deterministicOverlappingPairs. No body sleeps. Restitution holds at any speed.",
        "Contacts that keep energy: setContactProcessingThreshold(0), so that only what touches is "
        "in contact, and m_splitImpulsePenetrationThreshold above 0, so that overlap is undone "
        "without adding speed.",
    };
    findings.tables = {timeStepTable(contestants, points)};
    findings.charts = timeStepCharts(tasks, contestants, points);
    findings.checks.push_back(sameCheck(contestants, points));
    for (const PhysicsTask& task : tasks) {
        if (task.name == kFallName) {
            findings.checks.push_back(fallCheck(task, points));
        }
    }
    offer(contestants, points, findings.choices);
    compareTimes(contestants, points, findings.conclusions);
    compareWays(tasks.front(), points, findings.conclusions);
    followSteps(tasks, points, kSmallerSteps, findings.conclusions);
    followSteps(tasks, points, kKeepingEnergy, findings.conclusions);
    return findings;
}

}  // namespace hashphase::demos
