// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <demos/console/format.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr double kPercent = 100;

std::string tunnellingSettings(const SweepResults& results) {
    std::string walls;
    for (const double thickness : results.plan.tunnelling.thicknesses) {
        walls += (walls.empty() ? "" : ", ") + valueText(thickness);
    }
    return "bullets of radius 5 mm that touch a wall during a frame, at any moment of it as likely "
           "as at any other; walls of " +
           walls +
           " m, every other one moving; up to 7 degrees aslant; truth in integers; bars: 95 % "
           "intervals; seed " +
           std::to_string(results.seed);
}

/// "200, 40, 10"
std::string judgedText(const FastMoversPlan& plan) {
    std::string text;
    for (const FastMotion& motion : plan.motions) {
        text += (text.empty() ? "" : ", ") + std::to_string(motion.judgedFrames);
    }
    return text;
}

std::string moversSettings(const SweepResults& results) {
    const FastMoversPlan& plan = results.plan.movers;
    return withThousands(plan.movers) + " of " + withThousands(plan.objects) +
           " boxes fly, in new directions each frame, on the ground as far as is said and up or "
           "down by up to half as far; cells of 1 m; " +
           judgedText(plan) + " frames judged, " + std::to_string(plan.timedFrames) +
           " timed, methods in turn; seed " + std::to_string(results.seed);
}

/// All walls, at one ratio.
SweepTally atRatio(const SweepResults& results, double ratio, std::size_t method) {
    SweepTally sum;
    for (const TunnellingPoint& point : results.points) {
        if (point.ratio == ratio) {
            sum += point.tallies[method];
        }
    }
    return sum;
}

/// A line of the chart of tunnelling.
struct DetectionLine {
    std::string name;
    std::vector<std::uint64_t> detected;  // one a ratio
    std::vector<std::uint64_t> contacts;
    std::string same;  // names of those that have the same line

    [[nodiscard]] double percent(std::size_t at) const {
        return kPercent * static_cast<double>(detected[at]) / static_cast<double>(contacts[at]);
    }
    [[nodiscard]] bool liesOn(const DetectionLine& other) const {
        bool isSame = true;
        for (std::size_t i = 0; i < detected.size(); ++i) {
            isSame &= percent(i) == other.percent(i);
        }
        return isSame;
    }
};

std::vector<DetectionLine> allLines(const SweepResults& results) {
    std::vector<DetectionLine> lines;
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        DetectionLine& line =
            lines.emplace_back(DetectionLine{results.methods[i].name, {}, {}, {}});
        for (const double ratio : results.plan.tunnelling.ratios) {
            const SweepTally tally = atRatio(results, ratio, i);
            line.detected.push_back(tally.detected());
            line.contacts.push_back(tally.contacts);
        }
    }
    for (const bool isContinuous : {false, true}) {
        DetectionLine& line = lines.emplace_back();
        for (const FlyingBodiesPoint& point : results.bodies) {
            if (point.isContinuous == isContinuous) {
                line.name = nameOf(point);
                line.detected.push_back(point.bodies - point.tunnelled);
                line.contacts.push_back(point.bodies);
            }
        }
    }
    return lines;
}

/// Lines that lie on each other are drawn once, as that of the first.
std::vector<DetectionLine> differentLines(const SweepResults& results) {
    std::vector<DetectionLine> different;
    for (DetectionLine& line : allLines(results)) {
        const auto twin = std::find_if(different.begin(), different.end(),
                                       [&](const auto& each) { return line.liesOn(each); });
        if (twin == different.end()) {
            different.push_back(std::move(line));
        } else {
            twin->same += (twin->same.empty() ? "" : ", ") + line.name;
        }
    }
    return different;
}

Chart tunnellingChart(const SweepResults& results) {
    Chart chart;
    chart.name = "P1-tunnelling";
    chart.title =
        "Contacts of a bullet with a wall that are detected, by how far the bullet moves "
        "in a frame";
    chart.settings = tunnellingSettings(results);
    chart.data.columns = {{"ratio", "step v dt, in units of wall and bullet, T + 2r"},
                          {"method", "method"},
                          {"detected", "contacts detected, bodies stopped [%]"},
                          {"low"},
                          {"high"},
                          {"theory", "theory for discrete: min(1, (T + 2r) / (v dt))"},
                          {"contacts", "contacts"}};
    const std::vector<double>& ratios = results.plan.tunnelling.ratios;
    for (const DetectionLine& line : differentLines(results)) {
        for (std::size_t i = 0; i < ratios.size(); ++i) {
            const ShareInterval share = wilsonInterval(line.detected[i], line.contacts[i]);
            chart.data.add({ratios[i], line.name, line.percent(i), kPercent * share.low,
                            kPercent * share.high, kPercent * std::min(1.0, 1 / ratios[i]),
                            static_cast<double>(line.contacts[i])});
        }
        if (!line.same.empty()) {
            chart.settings += "; on the line of " + line.name + " also lie: " + line.same;
        }
    }
    chart.x = {"ratio", AxisScale::kLog};
    chart.y = {"detected", AxisScale::kLinear};
    chart.series = "method";
    chart.low = "low";
    chart.high = "high";
    chart.theory = "theory";
    return chart;
}

/// Of one motion: what does one task.
Chart paretoChart(const SweepResults& results, const MotionResult& at, const std::string& name) {
    Chart chart;
    chart.name = name;
    chart.title = "Contacts missed, against the time of a frame, at " + motionText(at.motion);
    chart.settings = moversSettings(results);
    chart.mark = ChartMark::kPoint;
    chart.data = moversTable(results, {&at, 1});
    chart.x = {"frame_ms", AxisScale::kLog};
    chart.y = {"missed_share", AxisScale::kLogAndZero};
    chart.series = "method";
    chart.low = "missed_low";
    chart.high = "missed_high";
    chart.showFront = true;
    return chart;
}

Chart falseChart(const SweepResults& results) {
    Chart chart;
    chart.name = "P1-false";
    chart.title =
        "Pairs that are listed for each fast object though they never touch, and left to "
        "others to test";
    chart.settings = moversSettings(results);
    chart.mark = ChartMark::kBar;
    chart.data = moversTable(results, results.motions);
    chart.x = {"method", AxisScale::kNames};
    chart.y = {"false", AxisScale::kLogAndZero};
    chart.series = "motion";
    return chart;
}

/// Of Bullet's exact way.
std::optional<double> bulletMilliseconds(const SweepResults& results, const MotionResult& at) {
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        if (results.methods[i].origin == SweepOrigin::bullet && results.methods[i].isExact()) {
            return at.milliseconds[i].median;
        }
    }
    return std::nullopt;
}

Value workValue(const SweepTally& tally, std::uint64_t SweepWork::*count) {
    return tally.work && *tally.work.*count > 0 ? Value(tally.perMover(*tally.work.*count))
                                                : Value();
}

}  // namespace

std::string motionText(double motion) {
    return valueText(motion) + (motion == 1 ? " cell a frame" : " cells a frame");
}

DataTable tunnellingTable(const SweepResults& results) {
    DataTable table{{{"method", "bullets at walls: method"},
                     {"contacts", "contacts"},
                     {"missed", "missed"},
                     {"false", "false pairs"}},
                    {}};
    for (std::size_t i = 0; i < results.methods.size(); ++i) {
        const SweepTally sum = wallsOf(results, i);
        table.add({results.methods[i].name, static_cast<double>(sum.contacts),
                   static_cast<double>(sum.missed), static_cast<double>(sum.invented)});
    }
    for (const bool isContinuous : {false, true}) {
        FlyingBodiesPoint sum{0, isContinuous};
        for (const FlyingBodiesPoint& point : results.bodies) {
            if (point.isContinuous == isContinuous) {
                sum.bodies += point.bodies;
                sum.tunnelled += point.tunnelled;
            }
        }
        table.add({nameOf(sum), static_cast<double>(sum.bodies), static_cast<double>(sum.tunnelled),
                   Value()});
    }
    return table;
}

DataTable moversTable(const SweepResults& results, std::span<const MotionResult> motions) {
    DataTable table{{{"motion", "fast objects move by"},
                     {"method", "method"},
                     {"frame_ms", "frame [ms]"},
                     {"low_ms", "5 % [ms]"},
                     {"high_ms", "95 % [ms]"},
                     {"ratio", "of Bullet's time, united and tested"},
                     {"contacts", "contacts"},
                     {"missed", "missed"},
                     {"missed_share", "missed [%]"},
                     {"missed_low", "at least [%]"},
                     {"missed_high", "at most [%]"},
                     {"false", "false pairs an object"},
                     {"cells", "cells or boxes searched an object"},
                     {"tests", "tests an object"},
                     {"time_error", "worst time of contact [frames]"}},
                    {}};
    for (const MotionResult& at : motions) {
        const std::optional<double> bullet = bulletMilliseconds(results, at);
        for (std::size_t i = 0; i < results.methods.size(); ++i) {
            const SweepTally& tally = at.tallies[i];
            const Spread& time = at.milliseconds[i];
            const ShareInterval share = tally.missedInterval();
            table.add({motionText(at.motion), results.methods[i].name, time.median, time.low,
                       time.high, bullet ? Value(time.median / *bullet) : Value(),
                       static_cast<double>(tally.contacts), static_cast<double>(tally.missed),
                       kPercent * tally.missedShare(), kPercent * share.low, kPercent * share.high,
                       tally.perMover(tally.invented), workValue(tally, &SweepWork::cells),
                       workValue(tally, &SweepWork::tests),
                       tally.timesAsked > 0 ? Value(tally.worstTimeError) : Value()});
        }
    }
    return table;
}

DataTable shortMoversTable(const SweepResults& results) {
    const DataTable all = moversTable(results, results.motions);
    DataTable table;
    std::vector<std::size_t> columns;
    columns.reserve(all.columns.size());
    for (const char* name : {"motion", "method", "frame_ms", "ratio", "contacts", "missed_share",
                             "false", "cells", "tests", "time_error"}) {
        columns.push_back(all.columnOf(name));
        table.columns.push_back(all.columns[columns.back()]);
    }
    for (const std::vector<Value>& row : all.rows) {
        std::vector<Value> values;
        for (const std::size_t column : columns) {
            values.push_back(row[column]);
        }
        table.add(std::move(values));
    }
    return table;
}

std::vector<Chart> sweepCharts(const SweepResults& results) {
    std::vector<Chart> charts{tunnellingChart(results)};
    for (const MotionResult& at : results.motions) {
        const bool isFastest = &at == &results.motions.back();
        charts.push_back(paretoChart(
            results, at, isFastest ? "P1-pareto" : "P1-pareto-" + valueText(at.motion) + "-cells"));
    }
    charts.push_back(falseChart(results));
    return charts;
}

}  // namespace hashphase::demos
