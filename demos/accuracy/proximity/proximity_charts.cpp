// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/proximity_charts.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/accuracy/pairs/pair_findings.hpp>
#include <demos/accuracy/proximity/estimate_formula.hpp>

#include <algorithm>

namespace hashphase::demos {

double nanoseconds(const ProximityResult& result, std::size_t method) {
    return result.measurements[method].time.median * 1e6 / static_cast<double>(result.crowd.agents);
}

std::optional<double> bulletNanoseconds(std::span<const ProximityResult> results,
                                        const ProximityCase& crowd) {
    for (const ProximityResult& result : results) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            if (result.crowd.name == crowd.name &&
                result.methods[i].origin == MethodOrigin::kBullet) {
                return nanoseconds(result, i);
            }
        }
    }
    return std::nullopt;
}

namespace {

std::vector<Value> rowOf(std::span<const ProximityResult> results, const ProximityResult& result,
                         std::size_t i) {
    const ProximityMeasurement& measured = result.measurements[i];
    const double ns = nanoseconds(result, i);
    const double perAgent =
        static_cast<double>(measured.neighbours) / static_cast<double>(measured.decisions);
    const ShareInterval wrong =
        intervalOverFrames(measured.wrong, measured.decisions, measured.judgedFrames);
    std::optional<double> speed = bulletNanoseconds(results, result.crowd);
    if (speed) {
        *speed /= ns;
    }
    std::optional<double> theory;
    if (result.methods[i].isEstimate) {
        theory = estimatePrecisionOnPlain(result.crowd.radius, result.crowd.cellSize(), kAgentEdge);
    }
    std::optional<double> ratio;
    if (result.methods[i].usesCells) {
        ratio = result.crowd.radiusByCell;
    }
    return {result.crowd.name,
            result.methods[i].name,
            valueOf(ratio),
            ns,
            ns / perAgent,
            valueOf(speed),
            measured.recall(),
            valueOf(measured.precision()),
            valueOf(theory),
            measured.wrongShare(),
            wrong.low,
            wrong.high,
            static_cast<double>(measured.worse) / static_cast<double>(measured.decisions)};
}

}  // namespace

DataTable resultTable(std::span<const ProximityResult> all,
                      std::span<const ProximityResult> shown) {
    DataTable table{{{"crowd", "crowd"},
                     {"method", "method"},
                     {"radius_by_cell", "radius / cell"},
                     {"ns", "time [ns/agent]"},
                     {"ns_neighbour", "time [ns/neighbour]"},
                     {"speed", "times as fast as btDbvtBroadphase"},
                     {"recall", "neighbours found (recall)"},
                     {"precision", "of those named, neighbours (precision)"},
                     {"theory", "precision in theory"},
                     {"wrong", "wrong decisions"},
                     {"wrong_low", "at least"},
                     {"wrong_high", "at most (95 %)"},
                     {"worse", "decisions for a colour that is not even equally rare"}},
                    {}};
    for (const ProximityResult& result : shown) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            table.add(rowOf(all, result, i));
        }
    }
    return table;
}

Chart decisionChart(std::span<const ProximityResult> group, std::size_t number) {
    Chart chart;
    chart.name = "P3-decisions-" + std::to_string(number);
    chart.title = "Wrong decisions against time: " + group.front().crowd.name;
    chart.settings = kProximitySettings;
    chart.mark = ChartMark::kPoint;
    chart.data = resultTable(group, group);
    chart.x = {"ns", AxisScale::kLog};
    chart.y = {"wrong", AxisScale::kLogAndZero};
    chart.series = "method";
    chart.low = "wrong_low";
    chart.high = "wrong_high";
    chart.label = "radius_by_cell";
    chart.showFront = true;
    return chart;
}

Chart listChart(std::span<const ProximityResult> group, bool isRecall) {
    Chart chart;
    chart.name = isRecall ? "P3-recall" : "P3-precision";
    chart.title = isRecall ? "How many of the neighbours are found"
                           : "How many of those named are neighbours";
    chart.settings = kProximitySettings;
    chart.data = resultTable(group, group);
    const std::size_t ratio = chart.data.columnOf("radius_by_cell");
    std::erase_if(chart.data.rows, [ratio](const std::vector<Value>& row) {
        return std::holds_alternative<std::monostate>(row[ratio]);
    });
    chart.x = {"radius_by_cell", AxisScale::kLog};
    chart.y = {isRecall ? "recall" : "precision", AxisScale::kLinear};
    chart.series = "method";
    if (!isRecall) {
        chart.theory = "theory";
    }
    return chart;
}

}  // namespace hashphase::demos
