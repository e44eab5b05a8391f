// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/time_step_report.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace hashphase::demos {
namespace {

using Points = std::span<const TaskPoint>;
using Contestants = std::span<const PhysicsContestant>;

std::string axisTitle(const PhysicsMeasure& measure) {
    return measure.title + ", root mean square" +
           (measure.unit.empty() ? "" : " [" + measure.unit + "]");
}

Chart measureChart(const PhysicsTask& task, std::size_t k, Contestants contestants, Points points) {
    const PhysicsMeasure& measure = task.measures[k];
    Chart chart;
    chart.name = "P7-" + task.name + "-" + measure.name;
    chart.title = task.title + ": " + measure.title;
    chart.settings =
        "10 iterations a step, a point for each length of step; " + std::string(kTimeStepSettings);
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
    chart.showFront = true;
    return chart;
}

Chart waysChart(const PhysicsTask& task, Contestants contestants, Points points) {
    Chart chart;
    chart.name = "P7-ways-" + task.name;
    chart.title = task.title + ": what buys accuracy?";
    chart.settings = contestants.front().name + "; " + std::string(kTimeStepSettings);
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

Chart fallChart(const PhysicsTask& task, Contestants contestants, Points points) {
    Chart chart;
    chart.name = "P7-fall-theory";
    chart.title = "Free fall goes wrong as theory says: by half a step at the speed gained";
    chart.settings = std::string(kTimeStepSettings);
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

}  // namespace

std::string stepText(const Stepping& stepping) {
    return "1/" + std::to_string(stepping.stepsPerSecond()) + " s";
}

std::string settingText(const Stepping& stepping) {
    return stepText(stepping) + ", " + std::to_string(stepping.iterations) + " iterations" +
           (stepping.keepsEnergy ? ", contacts that keep energy" : "");
}

std::vector<const TaskPoint*> bySteps(Points points, const PhysicsTask& task,
                                      std::string_view way) {
    std::vector<const TaskPoint*> chosen;
    for (const TaskPoint& point : points) {
        if (point.task == &task && point.way == way) {
            chosen.push_back(&point);
        }
    }
    return chosen;
}

bool isSame(const TaskPoint& point, Contestants contestants) {
    std::vector<std::uint64_t> states;
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        if (contestants[i].isCanonical()) {
            states.push_back(point.outcomes[i].states);
        }
    }
    return std::adjacent_find(states.begin(), states.end(), std::not_equal_to<>()) == states.end();
}

double predictedFallError(const Stepping& stepping) {
    constexpr int kLooks = 60;
    double sum = 0;
    for (int look = 1; look <= kLooks; ++look) {
        const double seconds = static_cast<double>(look) / kLooksPerSecond;
        sum += std::pow(fallErrorOf(1.0 / stepping.stepsPerSecond(), seconds), 2);
    }
    return 1000 * std::sqrt(sum / kLooks);
}

DataTable timeStepTable(Contestants contestants, Points points) {
    DataTable table{{{"task"},
                     {"error", "error, root mean square"},
                     {"step_s", "step"},
                     {"iterations"},
                     {"contacts"},
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
                stepText(point.stepping),
                static_cast<double>(point.stepping.iterations),
                point.stepping.keepsEnergy ? "keep energy" : "as shipped",
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

std::vector<Chart> timeStepCharts(std::span<const PhysicsTask> tasks, Contestants contestants,
                                  Points points) {
    std::vector<Chart> charts;
    for (const PhysicsTask& task : tasks) {
        for (std::size_t k = 0; k < task.measures.size(); ++k) {
            charts.push_back(measureChart(task, k, contestants, points));
        }
        charts.push_back(waysChart(task, contestants, points));
        if (task.name == kFallName) {
            charts.push_back(fallChart(task, contestants, points));
        }
    }
    return charts;
}

}  // namespace hashphase::demos
