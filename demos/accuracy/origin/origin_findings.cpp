// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_report.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace hashphase::demos {
namespace {

using Points = std::span<const OriginPoint>;
using Methods = std::span<const OriginMethod>;
using SettleMethods = std::span<const SettleMethod>;

std::string distanceText(double offset) {
    return withThousands(static_cast<std::uint64_t>(offset)) + " m";
}

std::string countText(std::uint64_t part, std::uint64_t whole) {
    return withThousands(part) + " of " + withThousands(whole);
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
                           each.missedPairPercent() / 100,
                           "misses " + countText(each.missedPairs, each.pairs) + " pairs",
                           methods[i].isOurs});
    }
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const OriginOutcome& each = far.fine.methods[i];
        choices.push_back({boxes + "no false pair", methods[i].name, each.frameMs.median,
                           each.extraPairPercent() / 100,
                           fixed(each.extraPairPercent(), 1) + " % false pairs",
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
    return fixed(1 + overheadPercent(outcomes, method) / 100, 2);
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
                              return outcome.extraPairPercent() > 1;
                          }) +
            ", misses hits of rays " +
            firstDistance(points,
                          [i](const OriginPoint& p) { return p.fine.methods[i].missedHits > 0; }) +
            "; at " + distanceText(far.offset) + " " + fixed(each.missedPairPercent(), 1) +
            " % of pairs missed, " + fixed(each.extraPairPercent(), 1) +
            " % false, a frame takes " + timesText(far.fine, i) +
            " times as long as float at the origin (" + timesText(points.front().fine, i) +
            " when there as well).");
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
        originSettingsText(settings) + ".",
        "Truth: integer arithmetic. The coordinates given are exact in double precision at every "
        "distance; the same scene in steps of 128 m has coordinates that are exact in single "
        "precision as well.",
        "float: bounds rounded to the nearest number. float positions: the centre is rounded, and "
        "the bounds computed from it, as Bullet does in single precision. Integer cell: numbers "
        "count from the corner of a cell of 1,024 m, which is subtracted in double precision.",
        "A frame: convert and set all boxes, bring the pairs up to date. The ground truth of rays "
        "is the segment before rounding.",
    };
    findings.tables = originTables(methods, settleMethods, points);
    findings.charts = originCharts(methods, settleMethods, settings, points);
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
