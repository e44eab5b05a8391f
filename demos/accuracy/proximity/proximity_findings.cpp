// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/proximity_findings.hpp>

#include <demos/accuracy/pairs/pair_findings.hpp>
#include <demos/accuracy/proximity/proximity_charts.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

/// Crowds of the same name, which differ by their cells, follow each other.
std::vector<std::span<const ProximityResult>> byCrowd(std::span<const ProximityResult> results) {
    std::vector<std::span<const ProximityResult>> groups;
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= results.size(); ++i) {
        if (i == results.size() || results[i].crowd.name != results[begin].crowd.name) {
            groups.push_back(results.subspan(begin, i - begin));
            begin = i;
        }
    }
    return groups;
}

DataTable statedTable(std::span<const StatedEstimate> stated) {
    DataTable table{{{"radius_by_cell", "estimateWithin in space: radius / cell"},
                     {"found", "found"},
                     {"precision", "of these within the radius"},
                     {"theory", "in theory"},
                     {"stated", "as proximity.hpp states"},
                     {"missed", "missed"},
                     {"too_far", "beyond the stated distance"}},
                    {}};
    for (const StatedEstimate& each : stated) {
        table.add({each.radiusByCell, static_cast<double>(each.found), each.precision(),
                   each.theory, each.statedTenths / 10, static_cast<double>(each.missed),
                   static_cast<double>(each.tooFar)});
    }
    return table;
}

Check exactCheck(std::span<const ProximityResult> results) {
    ProximityMeasurement sum;
    int runs = 0;
    std::string firstWrong;
    for (const ProximityResult& result : results) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            if (!result.methods[i].isExact) {
                continue;
            }
            const ProximityMeasurement& measured = result.measurements[i];
            ++runs;
            sum.neighbours += measured.neighbours;
            sum.found += measured.found;
            sum.wrongly += measured.wrongly;
            sum.wrong += measured.wrong;
            sum.decisions += measured.decisions;
            const bool isWrong =
                measured.found != measured.neighbours || measured.wrongly > 0 || measured.wrong > 0;
            if (isWrong && firstWrong.empty()) {
                firstWrong = "; first " + result.methods[i].name;
            }
        }
    }
    return {"Exact ways find every neighbour and no other, and take no wrong decision",
            runs > 0 && sum.found == sum.neighbours && sum.wrongly == 0 && sum.wrong == 0,
            withThousands(sum.neighbours - sum.found) + " missed and " +
                withThousands(sum.wrongly) + " false of " + withThousands(sum.neighbours) +
                " neighbours, " + withThousands(sum.wrong) + " wrong of " +
                withThousands(sum.decisions) + " decisions in " + std::to_string(runs) + " runs" +
                firstWrong};
}

Check completeCheck(std::span<const ProximityResult> results) {
    std::uint64_t neighbours = 0;
    std::uint64_t missed = 0;
    for (const ProximityResult& result : results) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            if (result.methods[i].isComplete) {
                neighbours += result.measurements[i].neighbours;
                missed += result.measurements[i].neighbours - result.measurements[i].found;
            }
        }
    }
    return {"Cells, with boxes and without, miss nobody who is within the radius", missed == 0,
            withThousands(missed) + " of " + withThousands(neighbours)};
}

std::vector<Check> statedChecks(std::span<const StatedEstimate> stated) {
    constexpr double kHalfATenth = 0.05;
    bool isAsStated = true;
    std::string shares;
    std::uint64_t missed = 0;
    std::uint64_t tooFar = 0;
    std::uint64_t found = 0;
    for (const StatedEstimate& each : stated) {
        isAsStated &= std::abs(each.precision() - each.statedTenths / 10) < kHalfATenth;
        shares += (shares.empty() ? "" : ", ") + fixed(each.precision(), 3) + " (theory " +
                  fixed(each.theory, 3) + ")";
        missed += each.missed;
        tooFar += each.tooFar;
        found += each.found;
    }
    return {{"estimateWithin in space: 1, 2, 3 and 4 in 10 are really within 1, 2, 4 and 8 cells",
             isAsStated, shares},
            {"estimateWithin misses nobody, and nobody is farther than sqrt(3) (radius + cell)",
             missed == 0 && tooFar == 0,
             withThousands(missed) + " missed, " + withThousands(tooFar) + " too far of " +
                 withThousands(found) + " found"}};
}

std::string resultText(const ProximityMeasurement& measured) {
    if (measured.wrong == 0 && measured.wrongly == 0 && measured.found == measured.neighbours) {
        return "every neighbour, every decision right";
    }
    const auto precision = measured.precision();
    return percentText(measured.wrongShare()) + " of decisions wrong; finds " +
           percentText(measured.recall()) + " of the neighbours" +
           (precision ? ", " + percentText(*precision) + " of those named are" : "");
}

std::string nameOf(const ProximityResult& result, std::size_t method) {
    return result.methods[method].usesCells ? result.methods[method].name + ", cells of " +
                                                  valueText(result.crowd.cellSize()) + " m"
                                            : result.methods[method].name;
}

void addChoices(std::span<const ProximityResult> results, std::vector<Choice>& choices) {
    for (const ProximityResult& result : results) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            const ProximityMeasurement& measured = result.measurements[i];
            choices.push_back({"Neighbours for AI: " + result.crowd.name, nameOf(result, i),
                               measured.time.median, measured.wrongShare(), resultText(measured),
                               result.methods[i].origin == MethodOrigin::kOurs});
        }
    }
}

/// The fastest exact way, and who is faster at the price of what.
std::string groupSentence(std::span<const ProximityResult> group) {
    const ProximityResult* exactResult = nullptr;
    std::size_t exact = 0;
    for (const ProximityResult& result : group) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            if (result.methods[i].isExact &&
                (exactResult == nullptr ||
                 nanoseconds(result, i) < nanoseconds(*exactResult, exact))) {
                exactResult = &result;
                exact = i;
            }
        }
    }
    if (exactResult == nullptr) {
        return {};
    }
    const double best = nanoseconds(*exactResult, exact);
    std::string text = group.front().crowd.name + ": the fastest exact way is " +
                       nameOf(*exactResult, exact) + " (" + fixed(best, 0) + " ns an agent).";
    std::string faster;
    for (const ProximityResult& result : group) {
        for (std::size_t i = 0; i < result.methods.size(); ++i) {
            if (nanoseconds(result, i) < best) {
                faster += (faster.empty() ? " Faster: " : "; ") + nameOf(result, i) + " (" +
                          fixed(best / nanoseconds(result, i), 1) + "x, " +
                          percentText(result.measurements[i].wrongShare()) + " of decisions wrong)";
            }
        }
    }
    text += faster.empty() ? " No rough way is faster." : faster + ".";
    if (const auto bullet = bulletNanoseconds(group, group.front().crowd)) {
        text += " btDbvtBroadphase takes " + fixed(*bullet / best, 0) + " times as long.";
    }
    return text;
}

/// How agents that ask one by one fare against Bullet, over all cell sizes of a crowd.
std::string oneByOneSentence(std::span<const ProximityResult> group) {
    const auto bullet = bulletNanoseconds(group, group.front().crowd);
    const std::string name = findWithinMethod().name;
    double worst = 0;
    double best = 0;
    for (const ProximityResult& result : group) {
        for (std::size_t i = 0; bullet && i < result.methods.size(); ++i) {
            if (result.methods[i].name == name) {
                const double speed = *bullet / nanoseconds(result, i);
                worst = best == 0 ? speed : std::min(worst, speed);
                best = std::max(best, speed);
            }
        }
    }
    if (best == 0) {
        return {};
    }
    const std::string speeds = fixed(worst, 2) + " to " + fixed(best, 2);
    return group.front().crowd.name + ", asked one by one: " + name + " is " +
           (group.size() > 1 ? speeds + " times as fast as btDbvtBroadphase, by cell size."
                             : fixed(best, 2) + " times as fast as btDbvtBroadphase.");
}

}  // namespace

Findings proximityFindings(std::span<const ProximityResult> results,
                           std::span<const StatedEstimate> stated) {
    Findings findings;
    findings.settings = {
        kProximitySettings,
        "Truth: the distance to every other agent in double precision, for agents that have all "
        "the cells around them within the square. Coordinates are multiples of 1/256 m, so that "
        "single precision decides without rounding.",
        "A decision is wrong when another colour is taken than the rarest, of equally rare ones "
        "the lowest.",
        "Cells: everybody whose box touches a cell that the ball's box touches; with boxes: whose "
        "box touches the ball's box. As printed: the paper's half-open loop over cells, which "
        "counts nobody where the radius is smaller than a cell, and an agent on a border twice."};
    findings.checks = {exactCheck(results), completeCheck(results)};
    for (Check& check : statedChecks(stated)) {
        findings.checks.push_back(std::move(check));
    }
    const auto groups = byCrowd(results);
    for (std::size_t i = 0; i < groups.size(); ++i) {
        findings.charts.push_back(decisionChart(groups[i], i + 1));
        for (std::string& sentence :
             std::vector{groupSentence(groups[i]), oneByOneSentence(groups[i])}) {
            if (!sentence.empty()) {
                findings.conclusions.push_back(std::move(sentence));
            }
        }
    }
    if (!groups.empty()) {
        findings.charts.push_back(listChart(groups.front(), true));
        findings.charts.push_back(listChart(groups.front(), false));
        findings.tables.push_back(resultTable(results, groups.front()));
    }
    findings.tables.push_back(statedTable(stated));
    addChoices(results, findings.choices);
    return findings;
}

}  // namespace hashphase::demos
