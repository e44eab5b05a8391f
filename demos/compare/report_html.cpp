// SPDX-License-Identifier: Zlib
#include <demos/compare/report.hpp>

#include <demos/console/format.hpp>
#include <demos/replay/replay_tab.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr const char* kIntroduction =
    "A broadphase finds the pairs of bodies whose bounding boxes overlap. This page shows one "
    "scene "
    "under hashphase, a spatial hash for the Bullet physics engine, and under Bullet's own "
    "broadphases: whether each listed exactly the pairs that overlap, in every frame, and how long "
    "it took. All got the same frames, one after another in each frame.";

Value nameOf(const Result& result) {
    return std::string(result.kind->name);
}

/// In charts: as the other parts of a report call the same method.
Value classOf(const Result& result) {
    return std::string(result.kind->title);
}

Value number(std::size_t count) {
    return static_cast<double>(count);
}

template <class Number>
Value numberOrNothing(const std::optional<Number>& number) {
    return number ? Value(static_cast<double>(*number)) : Value();
}

void addSpread(std::vector<Value>& row, const std::optional<Spread>& spread) {
    if (!spread) {
        row.resize(row.size() + 3);
        return;
    }
    row.insert(row.end(), {spread->median, spread->low, spread->high});
}

std::vector<Check> checks(const Report& report) {
    std::vector<Check> all;
    for (const Result& result : report.comparison.results) {
        if (result.kind->ours && !result.rows.empty()) {
            all.push_back({"'" + std::string(result.kind->name) +
                               "' lists exactly the pairs that overlap, in every frame",
                           !result.firstFault,
                           withThousands(tallyOf(result, &FrameVerdict::missing).total) +
                               " missing and " +
                               withThousands(tallyOf(result, &FrameVerdict::extra).total) +
                               " extra in " + std::to_string(result.rows.size()) + " frames"});
        }
    }
    return all;
}

PageSection correctness(const Report& report) {
    PageSection section;
    section.heading = "Are the pairs right?";
    section.sentences = {
        "Sums over all frames. Missing pairs overlap but are not listed, so that bodies fall "
        "through "
        "each other. Extra pairs are listed but do not overlap, which costs time further on; those "
        "that overlapped once and were not removed since are stale."};
    section.checks = checks(report);
    DataTable table{{{"broadphase", "broadphase"},
                     {"class", "class"},
                     {"pairs", "listed pairs"},
                     {"missing", "missing"},
                     {"extra", "extra"},
                     {"stale", "of these stale"}},
                    {}};
    for (const Result& result : report.comparison.results) {
        if (result.leftOutAfter) {
            section.sentences.push_back(leftOutSentence(report, result));
            continue;
        }
        table.add({nameOf(result), classOf(result),
                   number(tallyOf(result, &FrameVerdict::pairs).total),
                   number(tallyOf(result, &FrameVerdict::missing).total),
                   number(tallyOf(result, &FrameVerdict::extra).total),
                   number(tallyOf(result, &FrameVerdict::stale).total)});
    }
    section.tables = {std::move(table)};
    return section;
}

std::string settingsOf(const Report& report) {
    return report.scene + ", " + withThousands(report.objects) + " " + report.noun + ", " +
           std::to_string(report.comparison.framesDone - report.comparison.warmUpFrames) +
           " frames timed after " + std::to_string(report.comparison.warmUpFrames) +
           " to warm up, seed " + std::to_string(report.options.sceneSeed()) + ", one thread.";
}

Chart mediansChart(const Report& report) {
    Chart chart{"compare-times",
                "Time of a frame: setAabb for all objects, then calculateOverlappingPairs",
                settingsOf(report) + " Medians, with the 5th to 95th percentile.",
                ChartMark::kBar,
                {{{"broadphase", "broadphase"},
                  {"frame_ms", "median [ms a frame]"},
                  {"p5_ms", "5th percentile [ms]"},
                  {"p95_ms", "95th percentile [ms]"}},
                 {}},
                {"broadphase", AxisScale::kNames},
                {"frame_ms", AxisScale::kLog},
                "broadphase",
                "p5_ms",
                "p95_ms"};
    for (const Result& result : report.comparison.results) {
        if (result.leftOutAfter) {
            continue;
        }
        std::vector<Value> row{classOf(result)};
        const std::optional<Timing> timing = timingOf(result);
        addSpread(row, timing ? std::optional(timing->both) : std::nullopt);
        chart.data.add(std::move(row));
    }
    return chart;
}

/// More frames than this are drawn as the median, least and most of so many together.
constexpr std::size_t kMostTracePoints = 1000;

std::size_t framesOfATracePoint(const Report& report) {
    const int timed = report.comparison.framesDone - report.comparison.warmUpFrames;
    return (static_cast<std::size_t>(std::max(timed, 1)) - 1) / kMostTracePoints + 1;
}

void addTrace(const Result& result, std::size_t framesOfAPoint, DataTable& data) {
    std::vector<double> times;
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const FrameRow& row = result.rows[i];
        if (row.measured) {
            times.push_back(row.setAabbMs + row.calculateMs);
        }
        if (times.size() == framesOfAPoint || (!times.empty() && i + 1 == result.rows.size())) {
            const auto [least, most] = std::minmax_element(times.begin(), times.end());
            const auto first =
                static_cast<double>(row.frame) - static_cast<double>(times.size()) + 1;
            data.add({classOf(result), first, spreadOf(times).median, *least, *most});
            times.clear();
        }
    }
}

Chart traceChart(const Report& report) {
    Chart chart{"compare-trace",
                "Time of each frame",
                settingsOf(report) + " setAabb for all objects, then calculateOverlappingPairs.",
                ChartMark::kLine,
                {{{"broadphase", "broadphase"},
                  {"frame", "frame"},
                  {"frame_ms", "setAabb and calculate [ms]"},
                  {"least_ms", "least [ms]"},
                  {"most_ms", "most [ms]"}},
                 {}},
                {"frame"},
                {"frame_ms", AxisScale::kLog},
                "broadphase"};
    const std::size_t framesOfAPoint = framesOfATracePoint(report);
    for (const Result& result : report.comparison.results) {
        addTrace(result, framesOfAPoint, chart.data);
    }
    if (framesOfAPoint == 1) {
        chart.data.columns.resize(3);
        for (std::vector<Value>& row : chart.data.rows) {
            row.resize(3);
        }
    } else {
        const std::string count = std::to_string(framesOfAPoint);
        chart.title = "Time of the frames, " + count + " together";
        chart.settings += " Each point is the median of " + count +
                          " frames, from the least to the most of them; --csv has each frame.";
        chart.low = "least_ms";
        chart.high = "most_ms";
    }
    return chart;
}

/// Scenes without a simulation have no steps, and some broadphases do not tell their memory.
DataTable withoutEmptyColumns(const DataTable& table) {
    DataTable kept;
    kept.rows.resize(table.rows.size());
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const auto isEmpty = [i](const std::vector<Value>& row) { return row[i].index() == 0; };
        if (std::all_of(table.rows.begin(), table.rows.end(), isEmpty)) {
            continue;
        }
        kept.columns.push_back(table.columns[i]);
        for (std::size_t row = 0; row < table.rows.size(); ++row) {
            kept.rows[row].push_back(table.rows[row][i]);
        }
    }
    return kept;
}

PageSection times(const Report& report) {
    PageSection section;
    section.heading = "How long does it take?";
    section.sentences = {"Milliseconds, medians of the timed frames."};
    DataTable table{{{"broadphase", "broadphase"},
                     {"set_aabb_ms", "setAabb for all"},
                     {"calculate_ms", "calculate"},
                     {"both_ms", "both"},
                     {"speed", "times as fast as dbvt"},
                     {"step_ms", "whole step"},
                     {"fill_ms", "creating all objects"},
                     {"remove_ms", "removing " + withThousands(report.comparison.objectsRemoved)},
                     {"memory_mib", "memory [MiB]"}},
                    {}};
    for (const Result& result : report.comparison.results) {
        if (result.leftOutAfter) {
            continue;
        }
        const std::optional<Timing> timing = timingOf(result);
        const auto median = [&timing](Spread Timing::*part) {
            return timing ? Value(((*timing).*part).median) : Value();
        };
        table.add({nameOf(result), median(&Timing::setAabb), median(&Timing::calculate),
                   median(&Timing::both), numberOrNothing(speedAgainstDbvt(report, result)),
                   timing && timing->step ? Value(timing->step->median) : Value(),
                   numberOrNothing(result.fillMs), numberOrNothing(result.removeMs),
                   result.memoryBytes ? Value(static_cast<double>(*result.memoryBytes) / (1 << 20))
                                      : Value()});
    }
    section.tables = {withoutEmptyColumns(table)};
    return section;
}

PageSection drawnTimes(const Report& report) {
    PageSection section;
    section.heading = "The times, drawn";
    section.charts = {mediansChart(report), traceChart(report)};
    return section;
}

}  // namespace

Page pageOf(const Report& report) {
    Page page{"Broadphases compared: " + report.scene,
              kIntroduction,
              verdictLine(report) + ".",
              oursWereExact(report),
              {correctness(report), times(report)},
              report.provenance};
    page.sections.front().sentences.insert(page.sections.front().sentences.begin(),
                                           "The scene: " + report.description + ".");
    if (report.comparison.framesDone > report.comparison.warmUpFrames) {
        page.sections.push_back(drawnTimes(report));
    }
    if (report.comparison.timeLimitHit) {
        page.verdict += " The time limit was reached after " +
                        std::to_string(report.comparison.framesDone) + " of " +
                        std::to_string(report.framesAsked) + " frames.";
    }
    if (report.replay) {
        addReplayTab(*report.replay, static_cast<std::size_t>(report.comparison.framesDone), page);
    }
    return page;
}

}  // namespace hashphase::demos
