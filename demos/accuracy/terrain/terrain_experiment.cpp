// SPDX-License-Identifier: Zlib
#include <demos/accuracy/terrain/terrain_experiment.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/percent.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr std::string_view kBullet = "Bullet: sphere swept down";

// Far above the rounding of heights to single precision, far below what anybody sees; a share of the
// radius.
constexpr double kRests = 1e-3;

// How deep a sphere is in a slope when it is lifted by its radius; a share of the radius.
double theoryAt(double slope) {
    return 1 - std::cos(slope * std::numbers::pi / 180);
}

std::string meshText(std::uint64_t seed) {
    return "48 x 48 quads of 1 m, two triangles each; spheres of 0.3 to 1 m; seed " +
           std::to_string(seed);
}

Chart slopeChart(const TerrainMeasurement& measured, GroundKind kind, const std::string& settings) {
    const bool isSlope = kind == GroundKind::slope;
    Chart chart;
    chart.name = isSlope ? "P9-slope" : "P9-terraces";
    chart.title = isSlope
                      ? "How deep spheres are in a slope; dashed: r (1 - n_y)"
                      : "How deep spheres are in terraces: flat, up, flat and down, over 4 m each";
    chart.settings = settings;
    chart.data.columns = {{"slope", "slope [degrees]"},
                          {"method", "method"},
                          {"depth", "mean depth in the ground [share of r]"},
                          {"worst_depth", "worst depth"},
                          {"height", "mean height above it [share of r]"},
                          {"worst_height", "worst height"},
                          {"no_ground", "no ground found [%]"},
                          {"theory", "r (1 - n_y)"}};
    for (const RestRow& row : measured.rests) {
        if (row.kind == kind) {
            chart.data.add({row.slope, row.method->name, row.meanDepth, row.worstDepth,
                            row.meanHeight, row.worstHeight, percentOf(row.noGround, row.spheres),
                            theoryAt(row.slope)});
        }
    }
    chart.x = {"slope"};
    chart.y = {"depth"};
    chart.series = "method";
    chart.theory = isSlope ? "theory" : "";
    return chart;
}

Chart pointsChart(const TerrainMeasurement& measured, const std::string& settings) {
    Chart chart;
    chart.name = "P9-points";
    chart.title = "Points on the ground for which no triangle is found";
    chart.settings = settings + "; hills, vertices moved by up to 0.3 m";
    chart.mark = ChartMark::kBar;
    chart.data.columns = {{"place", "points"},
                          {"method", "method"},
                          {"no_ground", "no ground found [%]"},
                          {"low"},
                          {"high"},
                          {"wrong_triangle", "wrong triangle [%]"}};
    for (const PointRow& row : measured.points) {
        const ShareInterval share = wilsonInterval(row.noGround, row.points);
        chart.data.add(
            {std::string(nameOf(row.place)), row.method->name, percentOf(row.noGround, row.points),
             100 * share.low, 100 * share.high,
             row.tellsTriangle ? Value(percentOf(row.wrongTriangle, row.points)) : Value()});
    }
    chart.x = {"place", AxisScale::kNames};
    chart.y = {"no_ground"};
    chart.series = "method";
    chart.low = "low";
    chart.high = "high";
    return chart;
}

DataTable timeTable(const TerrainPlan& plan, const TerrainMeasurement& measured) {
    DataTable table{{{"configuration", "method, on hills"},
                     {"method", "kind"},
                     {"time", "a sphere [ns]"},
                     {"low", "5 % [ns]"},
                     {"high", "95 % [ns]"},
                     {"ratio", "of Bullet's sweep"},
                     {"depth", "mean depth [share of r]"},
                     {"worst_depth", "worst depth"},
                     {"height", "mean height above"},
                     {"worst_height", "worst height"},
                     {"no_ground", "no ground [%]"}},
                    {}};
    const auto bullet =
        std::find_if(measured.rests.begin(), measured.rests.end(),
                     [](const RestRow& row) { return row.isTimed && row.method->name == kBullet; });
    const double toNs = 1e6 / static_cast<double>(plan.spheresPerFrame);
    for (const RestRow& row : measured.rests) {
        if (row.isTimed) {
            const Spread& time = row.milliseconds;
            table.add({row.name(), row.method->name, time.median * toNs, time.low * toNs,
                       time.high * toNs,
                       bullet != measured.rests.end()
                           ? Value(time.median / bullet->milliseconds.median)
                           : Value(),
                       row.meanDepth, row.worstDepth, row.meanHeight, row.worstHeight,
                       percentOf(row.noGround, row.spheres)});
        }
    }
    return table;
}

Chart timeChart(const DataTable& times, const std::string& settings) {
    Chart chart;
    chart.name = "P9-time";
    chart.title = "Depth of spheres in hills against the time for one";
    chart.settings = settings + "; medians of at least 60 frames";
    chart.mark = ChartMark::kPoint;
    chart.data = times;
    chart.x = {"time", AxisScale::kLog};
    chart.y = {"depth", AxisScale::kLogAndZero};
    chart.series = "method";
    chart.label = "configuration";
    chart.showFront = true;
    return chart;
}

DataTable slopeTable(const TerrainMeasurement& measured) {
    DataTable table{{{"slope", "slope [degrees]"},
                     {"method", "method"},
                     {"depth", "on a slope: mean depth [share of r]"},
                     {"theory", "r (1 - n_y)"},
                     {"terraces", "on terraces: mean depth"},
                     {"terraces_worst", "worst depth"},
                     {"terraces_height", "mean height above"}},
                    {}};
    for (const RestRow& row : measured.rests) {
        if (row.kind != GroundKind::slope || std::fmod(row.slope, 40) != 0) {
            continue;
        }
        for (const RestRow& other : measured.rests) {
            if (other.kind == GroundKind::terraces && other.slope == row.slope &&
                other.method == row.method) {
                table.add({row.slope, row.method->name, row.meanDepth, theoryAt(row.slope),
                           other.meanDepth, other.worstDepth, other.meanHeight});
            }
        }
    }
    return table;
}

// Depth, height and missing ground, at worst, of all that a method did.
void checkRest(const TerrainMeasurement& measured, const GroundMethod& method, Findings& findings) {
    double worst = 0;
    std::size_t spheres = 0;
    std::size_t lost = 0;
    for (const RestRow& row : measured.rests) {
        if (row.method == &method) {
            worst = std::max({worst, row.worstDepth, row.worstHeight});
            spheres += row.spheres;
            lost += row.noGround;
        }
    }
    findings.checks.push_back(
        {method.name + ": spheres touch the ground, to a thousandth of r",
         spheres > 0 && worst <= kRests,
         "off by " + valueText(worst) + " r at worst of " + withThousands(spheres)});
    std::size_t points = 0;
    std::size_t wrong = 0;
    for (const PointRow& row : measured.points) {
        if (row.method == &method) {
            points += row.points;
            lost += row.noGround;
            wrong += row.wrongTriangle;
        }
    }
    findings.checks.push_back({method.name + " finds ground, and the right triangle, everywhere",
                               points > 0 && lost + wrong == 0,
                               withThousands(lost) + " without ground, " + withThousands(wrong) +
                                   " with a wrong triangle, of " +
                                   withThousands(spheres + points)});
}

void checkLine(const TerrainMeasurement& measured, const GroundMethod& method, Findings& findings) {
    double farthest = 0;
    bool hasAny = false;
    for (const RestRow& row : measured.rests) {
        if (row.method == &method && row.kind == GroundKind::slope) {
            hasAny = true;
            farthest = std::max(farthest, std::abs(row.meanDepth - theoryAt(row.slope)));
        }
    }
    findings.checks.push_back({method.name + ": on slopes the depth is r (1 - n_y)",
                               hasAny && farthest <= kRests,
                               "off by " + valueText(farthest) + " r at most"});
}

// What nobody sees is told as such.
std::string radiusText(double share) {
    return share <= kRests ? "less than 0.1 % of r" : valueText(100 * share) + " % of r";
}

std::string depthText(const RestRow& row) {
    return "sinks in by " + radiusText(row.meanDepth) + ", " + radiusText(row.worstDepth) +
           " at worst; hangs " + radiusText(row.meanHeight) + " above";
}

void addChoices(const TerrainPlan& plan, const TerrainMeasurement& measured, Findings& findings) {
    const std::string task =
        "Standing on hills, " + withThousands(plan.spheresPerFrame) + " spheres: depth by r";
    for (const RestRow& row : measured.rests) {
        if (row.isTimed) {
            // What nobody sees is no error.
            const double error = row.worstDepth <= kRests ? 0 : row.meanDepth;
            findings.choices.push_back({task, row.name(), row.milliseconds.median, error,
                                        depthText(row), row.method->isOurs});
        }
    }
}

// How long the methods of ours take beside the fastest of all and Bullet's sweep.
void addTimes(const TerrainPlan& plan, const TerrainMeasurement& measured, Findings& findings) {
    const RestRow* fastest = nullptr;
    const RestRow* sweep = nullptr;
    for (const RestRow& row : measured.rests) {
        if (row.isTimed &&
            (fastest == nullptr || row.milliseconds.median < fastest->milliseconds.median)) {
            fastest = &row;
        }
        sweep = row.isTimed && row.method->name == kBullet ? &row : sweep;
    }
    const auto text = [&](const RestRow& row) {
        return row.name() + " takes " +
               valueText(1e6 * row.milliseconds.median /
                         static_cast<double>(plan.spheresPerFrame)) +
               " ns a sphere";
    };
    for (const RestRow& row : measured.rests) {
        if (row.isTimed && row.method->isOurs && !row.method->takesCells) {
            findings.conclusions.push_back(text(row) + "; the fastest, " + text(*fastest) +
                                           (sweep != nullptr ? "; " + text(*sweep) + "." : "."));
        }
    }
}

void addConclusions(const TerrainMeasurement& measured, Findings& findings) {
    for (const RestRow& row : measured.rests) {
        const bool isSteep = row.kind == GroundKind::terraces && row.slope == 60;
        if (isSteep) {
            findings.conclusions.push_back("On terraces of 60 degrees, " + row.method->name + ' ' +
                                           depthText(row) + ".");
        }
    }
    for (const PointRow& row : measured.points) {
        if (row.noGround + row.wrongTriangle > 0) {
            findings.conclusions.push_back(
                row.method->name + ": of points " + std::string(nameOf(row.place)) + ' ' +
                withThousands(row.noGround) + " have no ground and " +
                withThousands(row.wrongTriangle) + " a wrong triangle, of " +
                withThousands(row.points) + ".");
        }
    }
}

TerrainPlan planOf(const Effort& effort) {
    return {effort.quickOrFull<std::size_t>(60, 500),
            effort.quickOrFull<std::size_t>(5000, 100'000),
            effort.quickOrFull(kFewestFrames, 2 * kFewestFrames),
            effort.quickOrFull<std::size_t>(1000, 5000)};
}

}  // namespace

std::string RestRow::name() const {
    return method->takesCells
               ? method->name + ", " + valueText(static_cast<double>(cellSize)) + " m cells"
               : method->name;
}

Findings findTerrain(const TerrainPlan& plan, std::uint64_t seed,
                     std::span<const GroundMethod> methods, const TellProgress& tell) {
    const TerrainMeasurement measured = measureTerrain(plan, seed, methods, tell);
    const std::string mesh = meshText(seed);
    Findings findings;
    findings.settings = {
        mesh + ".",
        "Slopes are one plane; terraces are flat, go up, are flat and go down, over 4 m each; "
        "hills are random, up to 56 m high.",
        "How deep a sphere is in the ground, or how far above, the nearest points of all triangles "
        "say, in long double. Spheres that are judged ask from 2 m above where they rest, those "
        "that are timed from 2 m above the highest point.",
        "Points that ask for their triangle lie anywhere, on shared edges (as far as single "
        "precision has them there), and on shared corners."};
    findings.tables = {slopeTable(measured), timeTable(plan, measured)};
    findings.charts = {slopeChart(measured, GroundKind::slope, mesh),
                       slopeChart(measured, GroundKind::terraces, mesh),
                       pointsChart(measured, mesh), timeChart(findings.tables.back(), mesh)};
    for (const GroundMethod& method : methods) {
        if (method.mustRest) {
            checkRest(measured, method, findings);
        }
        if (method.sinksByLine) {
            checkLine(measured, method, findings);
        }
    }
    addChoices(plan, measured, findings);
    addConclusions(measured, findings);
    addTimes(plan, measured, findings);
    return findings;
}

Experiment terrainExperiment() {
    return {"P9",
            "Terrain",
            "How deep do spheres sink into slopes and at edges, and who finds no ground?",
            3,
            22,
            [](const Effort& effort, const TellProgress& tell) {
                return findTerrain(planOf(effort), effort.seed, groundMethods(), tell);
            }};
}

}  // namespace hashphase::demos
