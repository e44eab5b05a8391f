// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_report.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {
namespace {

using Points = std::span<const OriginPoint>;
using Methods = std::span<const OriginMethod>;
using SettleMethods = std::span<const SettleMethod>;

DataTable fineTable(Methods methods, Points points) {
    DataTable table{{{"offset_m", "distance from the origin [m]"},
                     {"method"},
                     {"pairs", "pairs that there are"},
                     {"missed", "missed pairs"},
                     {"missed_percent", "missed pairs [%]"},
                     {"missed_low", "at least [%]"},
                     {"missed_high", "at most [%]"},
                     {"extra_percent", "false pairs [% of those that there are]"},
                     {"hits", "hits of rays that there are"},
                     {"missed_hits", "missed hits"},
                     {"missed_hits_percent", "missed hits [%]"},
                     {"false_hits_percent", "false hits [% of those that there are]"},
                     {"frame_ms", "frame [ms]"},
                     {"overhead_percent", "longer than float at the origin [%]"}},
                    {}};
    for (const OriginPoint& point : points) {
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const OriginOutcome& each = point.fine.methods[i];
            const ShareInterval missed =
                each.pairs == 0 ? ShareInterval{} : wilsonInterval(each.missedPairs, each.pairs);
            table.add({point.offset, methods[i].name, static_cast<double>(each.pairs),
                       static_cast<double>(each.missedPairs), each.missedPairPercent(),
                       100 * missed.low, 100 * missed.high, each.extraPairPercent(),
                       static_cast<double>(each.hits), static_cast<double>(each.missedHits),
                       each.missedHitPercent(), each.falseHitPercent(), each.frameMs.median,
                       overheadPercent(point.fine, i)});
        }
    }
    return table;
}

DataTable settleTable(SettleMethods methods, Points points) {
    DataTable table{{{"offset_m", "distance from the origin [m]"},
                     {"method"},
                     {"position_error_m", "farthest from the place of rest [m]"},
                     {"settle_step", "settled after step"},
                     {"settle_difference", "steps later than at the origin"},
                     {"step_ms", "step [ms]"}},
                    {}};
    for (const OriginPoint& point : points) {
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const SettleOutcome& each = point.settled[i];
            table.add({point.offset, methods[i].name, each.positionError,
                       static_cast<double>(each.settleStep),
                       static_cast<double>(each.settleStep - points.front().settled[i].settleStep),
                       each.stepMs.median});
        }
    }
    return table;
}

Chart lineChart(const std::string& name, const std::string& title, const std::string& settings,
                const DataTable& data, const Axis& y) {
    Chart chart;
    chart.name = "P6-" + name;
    chart.title = title;
    chart.settings = settings;
    chart.data = data;
    chart.x = {"offset_m", AxisScale::kLogAndZero};
    chart.y = y;
    chart.series = "method";
    return chart;
}

/// The origin, and what charts show of a thousand, ten thousand, ... metres: enough for a table.
std::vector<OriginPoint> nextToPowersOfTen(Points points) {
    std::vector<OriginPoint> few;
    std::copy_if(points.begin(), points.end(), std::back_inserter(few), [](const auto& point) {
        return point.offset == 0 || isNextToPowerOfTen(point.offset);
    });
    return few;
}

}  // namespace

double overheadPercent(const OriginOutcomes& outcomes, std::size_t method) {
    return 100 * (outcomes.methods[method].frameMs.median / outcomes.atOriginMs.median - 1);
}

std::string originSettingsText(const OriginSettings& settings) {
    return withThousands(settings.boxes) + " moving boxes of 0.5 to 2 m within 20 m, and " +
           withThousands(settings.rays) +
           " rays, moved away from the origin by powers of two along all three axes; coordinates "
           "are multiples of 1/1,024 m, half of them of 1/16 m, so that many boxes just touch; 60 "
           "frames, 6 of them compared with "
           "integer arithmetic; seed " +
           std::to_string(settings.seed);
}

std::vector<DataTable> originTables(Methods methods, SettleMethods settleMethods, Points points) {
    const std::vector<OriginPoint> few = nextToPowersOfTen(points);
    return {fineTable(methods, few), settleTable(settleMethods, few)};
}

std::vector<Chart> originCharts(Methods methods, SettleMethods settleMethods,
                                const OriginSettings& settings, Points points) {
    const DataTable fine = fineTable(methods, points);
    const DataTable settled = settleTable(settleMethods, points);
    const std::string text = originSettingsText(settings);
    std::vector<Chart> all{
        lineChart("extra-pairs", "How many false pairs there are far from the origin", text, fine,
                  {"extra_percent", AxisScale::kLogAndZero}),
        lineChart("missed-pairs", "How many pairs are missed far from the origin", text, fine,
                  {"missed_percent", AxisScale::kLinear}),
        lineChart("missed-hits", "How many hits of rays are missed far from the origin", text, fine,
                  {"missed_hits_percent", AxisScale::kLinear}),
        lineChart("overhead", "What each way costs, against single precision at the origin", text,
                  fine, {"overhead_percent", AxisScale::kLinear}),
        lineChart("position-error", "How far from their place balls come to rest",
                  "16 balls dropped onto a floor, 300 steps of 1/60 s, Bullet in single precision",
                  settled, {"position_error_m", AxisScale::kLogAndZero})};
    all[1].low = "missed_low";
    all[1].high = "missed_high";
    return all;
}

}  // namespace hashphase::demos
