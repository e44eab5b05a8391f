// SPDX-License-Identifier: Zlib
#include <demos/accuracy/time_step_experiment.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace hashphase::demos {
namespace {

using Points = std::span<const TaskPoint>;
using Contestants = std::span<const PhysicsContestant>;

std::string stepText(const Stepping& stepping) {
    return "1/" + std::to_string(stepping.stepsPerSecond()) + " s";
}

std::string settingText(const Stepping& stepping) {
    return stepText(stepping) + ", " + std::to_string(stepping.iterations) + " iterations";
}

std::string withUnit(double error, const PhysicsMeasure& measure) {
    const std::string number = valueText(measure.unit.empty() ? 100 * error : error);
    return number + " " + (measure.unit.empty() ? "%" : measure.unit);
}

std::string axisTitle(const PhysicsMeasure& measure) {
    return measure.title + ", root mean square" +
           (measure.unit.empty() ? "" : " [" + measure.unit + "]");
}

/// The points of a task by smaller steps alone, the longest steps first.
std::vector<const TaskPoint*> bySteps(Points points, const PhysicsTask& task) {
    std::vector<const TaskPoint*> chosen;
    for (const TaskPoint& point : points) {
        if (point.task == &task && point.way == kSmallerSteps) {
            chosen.push_back(&point);
        }
    }
    return chosen;
}

/// True where all contestants with canonical lists passed through the same states.
bool isSame(const TaskPoint& point, Contestants contestants) {
    std::vector<std::uint64_t> states;
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        if (contestants[i].isCanonical()) {
            states.push_back(point.outcomes[i].states);
        }
    }
    return std::adjacent_find(states.begin(), states.end(), std::not_equal_to<>()) == states.end();
}

// --- Tables and charts --------------------------------------------------------------------------------

DataTable allTable(Contestants contestants, Points points) {
    DataTable table{{{"task"},
                     {"error", "error, root mean square"},
                     {"step_s", "step"},
                     {"iterations"},
                     {"same", "same states in canonical order"}},
                    {}};
    for (const PhysicsContestant& each : contestants) {
        table.columns.push_back({each.name + " error", each.name + ": error"});
        table.columns.push_back({each.name + " ms", "ms a simulated second"});
    }
    for (const TaskPoint& point : points) {
        for (std::size_t k = 0; k < point.task->measures.size(); ++k) {
            const PhysicsMeasure& measure = point.task->measures[k];
            std::vector<Value> row{
                point.task->name,
                measure.name + (measure.unit.empty() ? "" : " [" + measure.unit + "]"),
                stepText(point.stepping), static_cast<double>(point.stepping.iterations),
                isSame(point, contestants) ? "yes" : "no"};
            for (const TaskOutcome& outcome : point.outcomes) {
                row.emplace_back(outcome.errors[k]);
                row.emplace_back(outcome.secondMs.median);
            }
            table.add(std::move(row));
        }
    }
    return table;
}

const std::string kChartSettings =
    "Bullet 3 in single precision; two simulated seconds, looked at 30 times a second; the time is "
    "that of a simulated second, a real-time factor of 1 being 1,000 ms; lower left is better";

Chart measureChart(const PhysicsTask& task, std::size_t k, Contestants contestants, Points points) {
    const PhysicsMeasure& measure = task.measures[k];
    Chart chart;
    chart.name = "P7-" + task.name + "-" + measure.name;
    chart.title = task.title + ": " + measure.title;
    chart.settings = "10 iterations a step, a point for each length of step; " + kChartSettings;
    chart.data.columns = {{"method"},
                          {"step_s", "step"},
                          {"second_ms", "time of a simulated second [ms]"},
                          {"low_ms", "5 % [ms]"},
                          {"high_ms", "95 % [ms]"},
                          {"real_time_factor", "real-time factor"},
                          {"error", axisTitle(measure)}};
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        for (const TaskPoint* point : bySteps(points, task)) {
            const TaskOutcome& outcome = point->outcomes[i];
            chart.data.add({contestants[i].name, stepText(point->stepping), outcome.secondMs.median,
                            outcome.secondMs.low, outcome.secondMs.high,
                            1000 / outcome.secondMs.median, outcome.errors[k]});
        }
    }
    chart.x = {"second_ms", AxisScale::kLog};
    chart.y = {"error", AxisScale::kLogAndZero};
    chart.series = "method";
    chart.label = "step_s";
    return chart;
}

Chart waysChart(const PhysicsTask& task, Contestants contestants, Points points) {
    Chart chart;
    chart.name = "P7-ways";
    chart.title = task.title + ": what buys accuracy, smaller steps or more iterations?";
    chart.settings = contestants.front().name + "; " + kChartSettings;
    chart.data.columns = {{"way"},
                          {"setting"},
                          {"second_ms", "time of a simulated second [ms]"},
                          {"error", axisTitle(task.measures.front())}};
    for (const TaskPoint& point : points) {
        if (point.task == &task) {
            const TaskOutcome& outcome = point.outcomes.front();
            chart.data.add({point.way, settingText(point.stepping), outcome.secondMs.median,
                            outcome.errors.front()});
        }
    }
    chart.x = {"second_ms", AxisScale::kLog};
    chart.y = {"error", AxisScale::kLogAndZero};
    chart.series = "way";
    chart.label = "setting";
    chart.showFront = true;
    return chart;
}

/// The root mean square of what a free fall goes wrong by at the looks [mm].
double predictedFallError(const Stepping& stepping) {
    constexpr int kLooks = 60;
    double sum = 0;
    for (int look = 1; look <= kLooks; ++look) {
        const double seconds = static_cast<double>(look) / kLooksPerSecond;
        sum += std::pow(fallErrorOf(1.0 / stepping.stepsPerSecond(), seconds), 2);
    }
    return 1000 * std::sqrt(sum / kLooks);
}

Chart fallChart(const PhysicsTask& task, Contestants contestants, Points points) {
    Chart chart;
    chart.name = "P7-fall-theory";
    chart.title = "Free fall goes wrong as theory says: by half a step at the speed gained";
    chart.settings = kChartSettings;
    chart.data.columns = {{"method"},
                          {"step_ms", "step [ms]"},
                          {"error", axisTitle(task.measures.front())},
                          {"theory", "g t step / 2 [mm]"}};
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        for (const TaskPoint* point : bySteps(points, task)) {
            chart.data.add({contestants[i].name, 1000.0 / point->stepping.stepsPerSecond(),
                            point->outcomes[i].errors.front(),
                            predictedFallError(point->stepping)});
        }
    }
    chart.x = {"step_ms", AxisScale::kLog};
    chart.y = {"error", AxisScale::kLog};
    chart.series = "method";
    chart.theory = "theory";
    return chart;
}

// --- Checks, choices, conclusions ---------------------------------------------------------------------

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

/// The most that single precision can put the fall off: half a unit in the last place a step, in
/// speed and in place [mm].
double fallRounding(const Stepping& stepping) {
    constexpr double kSeconds = 2;
    constexpr double kGravity = 10;
    constexpr double kUnitRoundoff = 0x1p-24;
    const double depth = kGravity * kSeconds * kSeconds / 2;
    return 1000 * 2 * depth * kUnitRoundoff * kSeconds * stepping.stepsPerSecond();
}

Check fallCheck(const PhysicsTask& task, Points points) {
    bool holds = true;
    double farthest = 0;
    double allowed = 0;
    for (const TaskPoint* point : bySteps(points, task)) {
        for (const TaskOutcome& outcome : point->outcomes) {
            const double away =
                std::abs(outcome.errors.front() - predictedFallError(point->stepping));
            holds = holds && away <= fallRounding(point->stepping);
            farthest = std::max(farthest, away);
        }
        allowed = std::max(allowed, fallRounding(point->stepping));
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
void followSteps(std::span<const PhysicsTask> tasks, Points points,
                 std::vector<std::string>& conclusions) {
    for (const PhysicsTask& task : tasks) {
        const std::vector<const TaskPoint*> own = bySteps(points, task);
        for (std::size_t k = 0; k < task.measures.size(); ++k) {
            const PhysicsMeasure& measure = task.measures[k];
            const double before = own.front()->outcomes.front().errors[k];
            const double after = own.back()->outcomes.front().errors[k];
            conclusions.push_back(
                task.title + ", " + measure.title + ": " + withUnit(before, measure) +
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
        kChartSettings + ".",
        "After SimBenchmark (Kang, Hwangbo and others). Truth: the laws of motion in double "
        "precision; that nothing overlaps. Errors of Bullet's steps against continuous motion are "
        "meant to be seen.",
        "Canonical order: pairs sorted by the numbers of the bodies, contacts by age and with "
        "m_deterministicOverlappingPairs. No body sleeps. Restitution holds at any speed.",
    };
    findings.tables = {allTable(contestants, points)};
    for (const PhysicsTask& task : tasks) {
        for (std::size_t k = 0; k < task.measures.size(); ++k) {
            findings.charts.push_back(measureChart(task, k, contestants, points));
        }
    }
    findings.charts.push_back(waysChart(tasks.front(), contestants, points));
    findings.checks.push_back(sameCheck(contestants, points));
    for (const PhysicsTask& task : tasks) {
        if (task.name == "fall") {
            findings.charts.push_back(fallChart(task, contestants, points));
            findings.checks.push_back(fallCheck(task, points));
        }
    }
    offer(contestants, points, findings.choices);
    compareTimes(contestants, points, findings.conclusions);
    compareWays(tasks.front(), points, findings.conclusions);
    followSteps(tasks, points, findings.conclusions);
    return findings;
}

}  // namespace hashphase::demos
