// SPDX-License-Identifier: Zlib
#include <demos/accuracy/picking/picking_experiment.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/percent.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/console/format.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr std::string_view kBullet = "btDbvtBroadphase::rayTest";

std::string shareText(std::uint64_t part, std::uint64_t whole) {
    return withThousands(part) + " of " + withThousands(whole);
}

std::string slabText(const PickingPlan& plan, std::uint64_t seed) {
    return withThousands(plan.boxes) +
           " boxes of 0.25 to 1 m in a slab of 300 x 16 x 300 m, cells of 1 m, rays of 10 to 700 "
           "m, "
           "coordinates between 1024 and 2048 m, where an ulp of a float is 0.12 mm; seed " +
           std::to_string(seed);
}

Value missedPercent(const RayMethod& method, const RayTally& tally) {
    return method.findsNearestOnly || tally.hits == 0 ? Value()
                                                      : Value(percentOf(tally.missed, tally.hits));
}

/// All rays of a method near boxes' faces, edges and corners.
RayTally grazeSum(const PickingMeasurement& measured, const RayMethod& method) {
    RayTally sum;
    for (const GrazeRow& row : measured.grazes) {
        if (row.method == &method) {
            sum += row.all;
        }
    }
    return sum;
}

/// All of a method's rays.
RayTally totalSum(const PickingMeasurement& measured, const RayMethod& method) {
    RayTally sum = grazeSum(measured, method);
    for (const LengthRow& row : measured.lengths) {
        if (row.method == &method) {
            sum += row.all;
        }
    }
    return sum;
}

Chart offsetChart(const PickingMeasurement& measured, Contact contact,
                  const std::string& settings) {
    Chart chart;
    const std::string contactName(nameOf(contact));
    chart.name = "P5-offset-" + contactName;
    chart.title = "Boxes that are hit, and missed, when a ray passes the " + contactName +
                  " so many ulps outside of it (negative: inside)";
    chart.settings = settings;
    chart.data.columns = {{"ulps", "offset [ulp]"},
                          {"method", "method"},
                          {"missed", "hits missed [%]"},
                          {"low"},
                          {"high"},
                          {"falsely", "false hits [%]"}};
    for (const GrazeRow& row : measured.grazes) {
        if (row.contact != contact || row.method->findsNearestOnly) {
            continue;
        }
        const RayTally& tally = row.grazed;
        const ShareInterval share =
            wilsonInterval(tally.missed, std::max<std::uint64_t>(tally.hits, 1));
        const bool isHit = tally.hits > 0;
        chart.data.add({static_cast<double>(row.ulps), row.method->name,
                        missedPercent(*row.method, tally), isHit ? Value(100 * share.low) : Value(),
                        isHit ? Value(100 * share.high) : Value(),
                        percentOf(tally.falsely, tally.rays - tally.hits)});
    }
    chart.x = {"ulps"};
    chart.y = {"missed"};
    chart.series = "method";
    chart.low = "low";
    chart.high = "high";
    return chart;
}

Chart lengthChart(const PickingMeasurement& measured, bool ofCells) {
    Chart chart;
    chart.name = ofCells ? "P5-length-cells" : "P5-length";
    chart.title = ofCells ? "Cells, or blocks of boxes, that a ray of that length visits"
                          : "Boxes missed by rays of that length";
    chart.settings =
        "rays from near the origin, boxes of 1 m or, where that is more, of an ulp of their "
        "coordinates, strung along them, about half of them hit; cells of 1 m, single precision";
    chart.data.columns = {{"length", "length [cells]"},
                          {"method", "method"},
                          {"missed", "hits missed [%]"},
                          {"low"},
                          {"high"},
                          {"falsely", "false hits a ray"},
                          {"wrong_nearest", "wrong nearest box [% of rays]"},
                          {"cells", "cells a ray"}};
    for (const LengthRow& row : measured.lengths) {
        const RayTally& tally = row.all;
        const auto rays = static_cast<double>(tally.rays);
        const ShareInterval share =
            wilsonInterval(tally.missed, std::max<std::uint64_t>(tally.hits, 1));
        const bool isCounted = !row.method->findsNearestOnly;
        chart.data.add(
            {row.length, row.method->name, missedPercent(*row.method, tally),
             isCounted ? Value(100 * share.low) : Value(),
             isCounted ? Value(100 * share.high) : Value(),
             static_cast<double>(tally.falsely) / rays,
             percentOf(tally.wrongNearest, tally.raysThatHit),
             tally.cost.cells > 0 ? Value(static_cast<double>(tally.cost.cells) / rays) : Value()});
    }
    chart.x = {"length", AxisScale::kLog};
    chart.y = {ofCells ? "cells" : "missed", ofCells ? AxisScale::kLog : AxisScale::kLogAndZero};
    chart.series = "method";
    if (!ofCells) {
        chart.low = "low";
        chart.high = "high";
    }
    return chart;
}

/// What a ray costs and gets wrong, by method.
DataTable timeTable(const PickingPlan& plan, const PickingMeasurement& measured,
                    std::span<const RayMethod> methods) {
    DataTable table{{{"method", "method"},
                     {"time", "a ray [ns]"},
                     {"low", "5 % [ns]"},
                     {"high", "95 % [ns]"},
                     {"ratio", "of Bullet's time"},
                     {"missed", "hits missed [%]"},
                     {"falsely", "false hits a ray"},
                     {"wrong_nearest", "wrong nearest [% of rays]"},
                     {"cells", "cells or blocks a ray"},
                     {"boxes", "boxes tested a ray"}},
                    {}};
    const auto bullet = std::find_if(methods.begin(), methods.end(),
                                     [](const RayMethod& each) { return each.name == kBullet; });
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const RayTally sum = grazeSum(measured, methods[i]);
        const auto rays = static_cast<double>(sum.rays);
        const double toNs = 1e6 / static_cast<double>(plan.raysPerFrame);
        const Spread& time = measured.milliseconds[i];
        const bool tells = sum.cost.boxes > 0;
        Value ratio;
        if (bullet != methods.end()) {
            const auto b = static_cast<std::size_t>(bullet - methods.begin());
            ratio = time.median / measured.milliseconds[b].median;
        }
        table.add({methods[i].name, time.median * toNs, time.low * toNs, time.high * toNs, ratio,
                   missedPercent(methods[i], sum), static_cast<double>(sum.falsely) / rays,
                   percentOf(sum.wrongNearest, sum.raysThatHit),
                   tells ? Value(static_cast<double>(sum.cost.cells) / rays) : Value(),
                   tells ? Value(static_cast<double>(sum.cost.boxes) / rays) : Value()});
    }
    return table;
}

Chart timeChart(const DataTable& times, const std::string& settings, bool ofNearest) {
    Chart chart;
    chart.name = ofNearest ? "P5-nearest-time" : "P5-missed-time";
    chart.title = ofNearest ? "Rays with a wrong nearest box against the time of a ray"
                            : "Boxes missed against the time of a ray";
    chart.settings = settings + "; medians of at least 60 frames";
    chart.mark = ChartMark::kPoint;
    chart.data = times;
    chart.x = {"time", AxisScale::kLog};
    chart.y = {ofNearest ? "wrong_nearest" : "missed", AxisScale::kLogAndZero};
    chart.series = "method";
    chart.showFront = true;
    return chart;
}

void addChecks(const PickingMeasurement& measured, std::span<const RayMethod> methods,
               Findings& findings) {
    for (const RayMethod& method : methods) {
        if (!method.mustFindAll) {
            continue;
        }
        const RayTally sum = totalSum(measured, method);
        if (method.findsNearestOnly) {
            findings.checks.push_back(
                {method.name + " finds a box where a ray meets one",
                 sum.noneFound == 0 && sum.raysThatHit > 0,
                 shareText(sum.noneFound, sum.raysThatHit) + " rays found none"});
        } else {
            findings.checks.push_back({method.name + " misses no box that a ray meets",
                                       sum.missed == 0 && sum.hits > 0,
                                       shareText(sum.missed, sum.hits) + " hits missed"});
        }
        findings.checks.push_back(
            {method.name +
                 ": the box that it puts first is met no later than others, but for rounding",
             sum.farFromNearest == 0 && sum.raysThatHit > 0,
             shareText(sum.farFromNearest, sum.raysThatHit) +
                 " rays off by more; by rounding, and false hits, " +
                 withThousands(sum.wrongNearest - sum.farFromNearest)});
    }
}

void addChoices(const PickingPlan& plan, const PickingMeasurement& measured,
                std::span<const RayMethod> methods, Findings& findings) {
    const std::string rays = withThousands(plan.raysPerFrame) + " grazing rays";
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const RayMethod& method = methods[i];
        const RayTally sum = grazeSum(measured, method);
        const double milliseconds = measured.milliseconds[i].median;
        const double missed = percentOf(sum.missed, sum.hits);
        const double wrong = percentOf(sum.wrongNearest, sum.raysThatHit);
        if (!method.findsNearestOnly) {
            findings.choices.push_back(
                {"All boxes on " + rays + ": missed", method.name, milliseconds, missed,
                 "misses " + valueText(missed) + " % of hits", method.isOurs});
        }
        findings.choices.push_back(
            {"The nearest box on " + rays + ": wrong", method.name, milliseconds, wrong,
             "another box, or none, on " + valueText(wrong) + " % of rays", method.isOurs});
    }
}

void addConclusions(const PickingPlan& plan, const PickingMeasurement& measured,
                    std::span<const RayMethod> methods, Findings& findings) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const RayMethod& method = methods[i];
        const RayTally graze = grazeSum(measured, method);
        const double ns =
            1e6 * measured.milliseconds[i].median / static_cast<double>(plan.raysPerFrame);
        std::string sentence = method.name + ": " + valueText(ns) + " ns a ray; ";
        if (!method.findsNearestOnly) {
            sentence +=
                "of grazing rays' hits " + shareText(graze.missed, graze.hits) + " are missed, ";
        }
        sentence += withThousands(graze.falsely) + " false hits, a wrong nearest box on " +
                    shareText(graze.wrongNearest, graze.raysThatHit) + " rays";
        const LengthRow* longest = nullptr;
        for (const LengthRow& row : measured.lengths) {
            longest = row.method == &method ? &row : longest;
        }
        if (longest != nullptr && !method.findsNearestOnly) {
            sentence +=
                "; of rays of " + withThousands(static_cast<std::uint64_t>(longest->length)) +
                " cells it misses " + shareText(longest->all.missed, longest->all.hits) + " hits";
        }
        findings.conclusions.push_back(sentence + ".");
    }
}

PickingPlan planOf(const Effort& effort) {
    return {5000,
            effort.quickOrFull(60, 600),
            kFewestFrames,
            effort.quickOrFull<std::size_t>(50, 500),
            effort.quickOrFull<std::size_t>(1000, 4000),
            8,
            effort.quickOrFull(1e6, 1e7),
            effort.quickOrFull(1e5, 1e8)};
}

}  // namespace

Findings findPicking(const PickingPlan& plan, std::uint64_t seed,
                     std::span<const RayMethod> methods, const TellProgress& tell) {
    const PickingMeasurement measured = measurePicking(plan, seed, methods, tell);
    const std::string slab = slabText(plan, seed);
    Findings findings;
    findings.settings = {
        slab + ".",
        "All coordinates are multiples of 2^-13 m, and the truth, about all boxes, is found in "
        "128-bit integers without rounding: touching is a hit.",
        "Ways through cells test the boxes in them alike, by RayRegion::key(); they differ by the "
        "cells that they visit. The paper's plane lies in the middle of the boxes' heights.",
        "Methods that take time for each cell are given rays of up to " +
            withThousands(static_cast<std::uint64_t>(plan.longestCellWalk)) + " cells."};
    for (const Contact contact : kContacts) {
        findings.charts.push_back(offsetChart(measured, contact, slab));
    }
    findings.charts.push_back(lengthChart(measured, false));
    findings.charts.push_back(lengthChart(measured, true));
    findings.tables = {timeTable(plan, measured, methods)};
    findings.charts.push_back(timeChart(findings.tables.front(), slab, false));
    findings.charts.push_back(timeChart(findings.tables.front(), slab, true));
    addChecks(measured, methods, findings);
    addChoices(plan, measured, methods, findings);
    addConclusions(plan, measured, methods, findings);
    return findings;
}

Experiment pickingExperiment() {
    return {"P5",
            "Picking rays",
            "How many boxes does a ray miss that grazes them, or that is long?",
            3,
            60,
            [](const Effort& effort, const TellProgress& tell) {
                return findPicking(planOf(effort), effort.seed, rayMethods(), tell);
            }};
}

}  // namespace hashphase::demos
