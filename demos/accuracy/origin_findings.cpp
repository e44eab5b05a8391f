// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin_experiment.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

namespace hashphase::demos {
namespace {

using Points = std::span<const OriginPoint>;
using Methods = std::span<const OriginMethod>;
using SettleMethods = std::span<const SettleMethod>;

double shareOf(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

double percentOf(std::uint64_t part, std::uint64_t whole) {
    return 100 * shareOf(part, whole);
}

/// How much longer than in single precision at the origin [%].
double overhead(const OriginOutcomes& outcomes, std::size_t method) {
    return 100 * (outcomes.methods[method].frameMs.median / outcomes.atOriginMs.median - 1);
}

std::string distanceText(double offset) {
    return withThousands(static_cast<std::uint64_t>(offset)) + " m";
}

std::string countText(std::uint64_t part, std::uint64_t whole) {
    return withThousands(part) + " of " + withThousands(whole);
}

// --- Tables and charts --------------------------------------------------------------------------------

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
                       static_cast<double>(each.missedPairs),
                       percentOf(each.missedPairs, each.pairs), 100 * missed.low, 100 * missed.high,
                       percentOf(each.extraPairs, each.pairs), static_cast<double>(each.hits),
                       static_cast<double>(each.missedHits), percentOf(each.missedHits, each.hits),
                       percentOf(each.falseHits, each.hits), each.frameMs.median,
                       overhead(point.fine, i)});
        }
    }
    return table;
}

/// The origin, and what charts show of a thousand, ten thousand, ... metres: enough for a table.
std::vector<OriginPoint> nextToPowersOfTen(Points points) {
    std::vector<OriginPoint> few;
    std::copy_if(points.begin(), points.end(), std::back_inserter(few), [](const auto& point) {
        return point.offset == 0 || isNextToPowerOfTen(point.offset);
    });
    return few;
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

std::string settingsText(const OriginSettings& settings) {
    return withThousands(settings.boxes) + " moving boxes of 0.5 to 2 m within 20 m, and " +
           withThousands(settings.rays) +
           " rays, moved away from the origin by powers of two along all three axes; coordinates "
           "are multiples of 1/16 m, so many boxes just touch; 60 frames, 6 of them compared with "
           "integer arithmetic; seed " +
           std::to_string(settings.seed);
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

std::vector<Chart> charts(const OriginSettings& settings, const DataTable& fine,
                          const DataTable& settled) {
    const std::string text = settingsText(settings);
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

// --- Checks -------------------------------------------------------------------------------------------

/// Sums of a method over all distances, of one of the two scenes.
OriginOutcome sumOf(Points points, OriginOutcomes OriginPoint::*scene, std::size_t method) {
    OriginOutcome sum;
    for (const OriginPoint& point : points) {
        const OriginOutcome& each = (point.*scene).methods[method];
        sum.pairs += each.pairs;
        sum.missedPairs += each.missedPairs;
        sum.extraPairs += each.extraPairs;
        sum.hits += each.hits;
        sum.missedHits += each.missedHits;
        sum.falseHits += each.falseHits;
    }
    return sum;
}

void judgeMethod(const OriginMethod& method, const OriginOutcome& fine, const OriginOutcome& coarse,
                 std::vector<Check>& checks) {
    if (method.isExact) {
        checks.push_back({method.name + " finds the same pairs at every distance",
                          fine.missedPairs == 0 && fine.extraPairs == 0,
                          countText(fine.missedPairs, fine.pairs) + " missed, " +
                              withThousands(fine.extraPairs) + " false"});
    } else if (method.missesNoPair) {
        checks.push_back({method.name + " misses no pair at any distance", fine.missedPairs == 0,
                          countText(fine.missedPairs, fine.pairs)});
    }
    if (method.missesNoHit) {
        checks.push_back({method.name + " misses no hit of a ray at any distance",
                          fine.missedHits == 0, countText(fine.missedHits, fine.hits)});
    }
    checks.push_back({method.name + " finds the same pairs at every distance where all coordinates "
                                    "are exact",
                      coarse.missedPairs == 0 && coarse.extraPairs == 0,
                      countText(coarse.missedPairs, coarse.pairs) + " missed, " +
                          withThousands(coarse.extraPairs) + " false"});
}

void judgeSettling(SettleMethods methods, Points points, std::vector<Check>& checks) {
    constexpr double kTolerance = 1e-3;  // [m]
    for (std::size_t i = 0; i < methods.size(); ++i) {
        if (!methods[i].shiftsOrigin) {
            continue;
        }
        double worst = 0;
        std::size_t same = 0;
        for (const OriginPoint& point : points) {
            worst = std::max(worst, point.settled[i].positionError);
            same += point.settled[i].localState == points.front().settled[i].localState ? 1 : 0;
        }
        checks.push_back({methods[i].name + ": balls rest within a millimetre of their place, in "
                                            "the same state at every distance",
                          worst <= kTolerance && same == points.size(),
                          "at most " + fixed(1000 * worst, 3) +
                              " mm; the same to the last bit at " + std::to_string(same) + " of " +
                              std::to_string(points.size()) + " distances"});
    }
}

// --- Choices and conclusions --------------------------------------------------------------------------

constexpr double kFar = 1e7;  // ten thousand kilometres [m]

/// The point nearest to that distance.
const OriginPoint& farPoint(Points points) {
    return *std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return std::abs(a.offset - kFar) < std::abs(b.offset - kFar);
    });
}

void offer(Methods methods, SettleMethods settleMethods, const OriginSettings& settings,
           Points points, std::vector<Choice>& choices) {
    const OriginPoint& far = farPoint(points);
    const std::string where = distanceText(far.offset) + " from the origin";
    const std::string boxes = withThousands(settings.boxes) + " boxes " + where + ", a frame: ";
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const OriginOutcome& each = far.fine.methods[i];
        choices.push_back({boxes + "no pair missed", methods[i].name, each.frameMs.median,
                           shareOf(each.missedPairs, each.pairs),
                           "misses " + countText(each.missedPairs, each.pairs) + " pairs",
                           methods[i].isOurs});
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const OriginOutcome& each = far.fine.methods[i];
        choices.push_back({boxes + "no false pair", methods[i].name, each.frameMs.median,
                           shareOf(each.extraPairs, each.pairs),
                           fixed(percentOf(each.extraPairs, each.pairs), 1) + " % false pairs",
                           methods[i].isOurs});
    }
    for (std::size_t i = 0; i < settleMethods.size(); ++i) {
        const SettleOutcome& each = far.settled[i];
        choices.push_back({"16 balls that come to rest " + where + ", a step",
                           settleMethods[i].name, each.stepMs.median, each.positionError,
                           "rests " + valueText(1000 * each.positionError) + " mm off",
                           settleMethods[i].broadphase.isOurs});
    }
}

/// The nearest distance at which something is so, in words; "nowhere" where it never is.
template <class IsSo>
std::string firstDistance(Points points, const IsSo& isSo) {
    const auto at = std::find_if(points.begin(), points.end(), isSo);
    return at == points.end() ? "at no distance" : "from " + distanceText(at->offset) + " on";
}

std::string timesText(const OriginOutcomes& outcomes, std::size_t method) {
    return fixed(1 + overhead(outcomes, method) / 100, 2);
}

void concludeMethods(Methods methods, Points points, std::vector<std::string>& conclusions) {
    const OriginPoint& far = farPoint(points);
    conclusions.push_back(methods.front().name + " at the origin, timed twice in the same run: " +
                          timesText(points.front().fine, 0) +
                          " times as long; smaller differences mean nothing.");
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const OriginOutcome& each = far.fine.methods[i];
        conclusions.push_back(
            methods[i].name + ": misses pairs " +
            firstDistance(points,
                          [i](const OriginPoint& p) { return p.fine.methods[i].missedPairs > 0; }) +
            ", false ones are more than 1 % " +
            firstDistance(points,
                          [i](const OriginPoint& p) {
                              const OriginOutcome& outcome = p.fine.methods[i];
                              return percentOf(outcome.extraPairs, outcome.pairs) > 1;
                          }) +
            ", misses hits of rays " +
            firstDistance(points,
                          [i](const OriginPoint& p) { return p.fine.methods[i].missedHits > 0; }) +
            "; at " + distanceText(far.offset) + " " +
            fixed(percentOf(each.missedPairs, each.pairs), 1) + " % of pairs missed, " +
            fixed(percentOf(each.extraPairs, each.pairs), 1) + " % false, a frame takes " +
            timesText(far.fine, i) + " times as long as float at the origin (" +
            timesText(points.front().fine, i) + " when there as well).");
    }
}

void concludeSettling(SettleMethods methods, Points points, std::vector<std::string>& conclusions) {
    constexpr double kMillimetre = 1e-3;
    const OriginPoint& far = farPoint(points);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        conclusions.push_back(methods[i].name + ": balls rest more than a millimetre off " +
                              firstDistance(points,
                                            [i](const OriginPoint& p) {
                                                return p.settled[i].positionError > kMillimetre;
                                            }) +
                              "; " + valueText(1000 * far.settled[i].positionError) + " mm at " +
                              distanceText(far.offset) + ", " +
                              valueText(1000 * points.front().settled[i].positionError) +
                              " mm at the origin.");
    }
}

}  // namespace

Findings judgeOrigin(Methods methods, SettleMethods settleMethods, const OriginSettings& settings,
                     Points points) {
    Findings findings;
    findings.settings = {
        settingsText(settings) + ".",
        "Truth: integer arithmetic. The coordinates given are exact in double precision at every "
        "distance; the same scene in steps of 128 m has coordinates that are exact in single "
        "precision as well.",
        "float: bounds rounded to the nearest number. float positions: the centre is rounded, and "
        "the bounds computed from it, as Bullet does in single precision. Integer cell: numbers "
        "count from the corner of a cell of 1,024 m, which is subtracted in double precision.",
        "A frame: convert and set all boxes, bring the pairs up to date. The ground truth of rays "
        "is the segment before rounding.",
    };
    findings.charts =
        charts(settings, fineTable(methods, points), settleTable(settleMethods, points));
    const std::vector<OriginPoint> few = nextToPowersOfTen(points);
    findings.tables = {fineTable(methods, few), settleTable(settleMethods, few)};
    for (std::size_t i = 0; i < methods.size(); ++i) {
        if (methods[i].isOurs) {
            judgeMethod(methods[i], sumOf(points, &OriginPoint::fine, i),
                        sumOf(points, &OriginPoint::coarse, i), findings.checks);
        }
    }
    judgeSettling(settleMethods, points, findings.checks);
    offer(methods, settleMethods, settings, points, findings.choices);
    concludeMethods(methods, points, findings.conclusions);
    concludeSettling(settleMethods, points, findings.conclusions);
    return findings;
}

}  // namespace hashphase::demos
