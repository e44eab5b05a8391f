// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_experiment.hpp>

#include <demos/accuracy/binomial.hpp>
#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/percent.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/console/format.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr std::string_view kBullet = "btDbvt::collideKDOP";

double lostPercent(const CullingTally& tally) {
    return percentOf(tally.lost, tally.visible);
}

double inVainPercent(const CullingTally& tally) {
    return percentOf(tally.inVain, tally.visible);
}

std::string percentText(double percent) {
    return valueText(percent) + " %";
}

std::string settingsText(const CullingPlan& plan, std::uint64_t seed) {
    return withThousands(plan.objects) +
           " boxes of 1 to 3 m on flat ground of 1000 m x 1000 m; camera 120 m above it, far plane "
           "400 m; unless varied: field of view 60 degrees, pitch -45, yaw 20, objects up to 10 m, "
           "cells of 10 m; seed " +
           std::to_string(seed);
}

Chart settingsChart(std::span<const CullingRow> rows, const std::string& settings, bool ofLost) {
    Chart chart;
    chart.name = ofLost ? "P4-lost" : "P4-overdraw";
    chart.title = ofLost ? "Visible objects that are not drawn: none may be lost"
                         : "Objects that are drawn though nothing of them is visible";
    chart.settings = settings;
    chart.mark = ChartMark::kBar;
    chart.data.columns = {{"setting", "setting"},
                          {"method", "method"},
                          {"lost", "visible objects lost [%]"},
                          {"low"},
                          {"high"},
                          {"in_vain", "drawn in vain [% of visible]"},
                          {"cells", "cells a frame"},
                          {"boxes", "boxes tested a frame"}};
    for (const CullingRow& row : rows) {
        const CullingTally& tally = row.tally;
        const ShareInterval share =
            wilsonInterval(tally.lost, std::max<std::uint64_t>(tally.visible, 1));
        const auto aView = [&](std::uint64_t number) {
            return static_cast<double>(number) / std::max(tally.views, 1);
        };
        chart.data.add({row.setting->name, row.method->name, lostPercent(tally), 100 * share.low,
                        100 * share.high, inVainPercent(tally), aView(tally.cost.cells),
                        aView(tally.cost.boxes)});
    }
    chart.x = {"setting", AxisScale::kNames};
    chart.y = {ofLost ? "lost" : "in_vain"};
    chart.series = "method";
    if (ofLost) {
        chart.low = "low";
        chart.high = "high";
    }
    return chart;
}

/// What a method got wrong in all settings.
struct Losses {
    CullingTally sum;
    double worst = 0;  // [%]
    std::string worstSetting;
};

Losses lossesOf(std::span<const CullingRow> rows, const CullingMethod& method) {
    Losses losses;
    for (const CullingRow& row : rows) {
        if (row.method != &method) {
            continue;
        }
        losses.sum.visible += row.tally.visible;
        losses.sum.lost += row.tally.lost;
        losses.sum.inVain += row.tally.inVain;
        if (lostPercent(row.tally) > losses.worst) {
            losses.worst = lostPercent(row.tally);
            losses.worstSetting = row.setting->name;
        }
    }
    return losses;
}

Chart timeChart(std::span<const CullingRow> rows, const std::string& settings, bool ofLost) {
    Chart chart;
    chart.name = ofLost ? "P4-lost-time" : "P4-overdraw-time";
    chart.title =
        ofLost ? "Visible objects lost against the time of a look"
               : "Objects drawn in vain against the time of a look, by methods that lose none";
    chart.settings = settings + "; medians of at least 60 flights of 8 looks";
    chart.mark = ChartMark::kPoint;
    chart.data.columns = {
        {"method", "method"},
        {"cell", "cells"},
        {"time", "a look [us]"},
        {"error", ofLost ? "visible objects lost [%]" : "drawn in vain [% of visible]"}};
    for (const CullingRow& row : rows) {
        if (row.isTimed && (ofLost || lossesOf(rows, *row.method).sum.lost == 0)) {
            chart.data.add({row.method->name,
                            row.method->takesCells
                                ? valueText(static_cast<double>(row.setting->cellSize)) + " m"
                                : "",
                            row.microseconds.median,
                            ofLost ? lostPercent(row.tally) : inVainPercent(row.tally)});
        }
    }
    chart.x = {"time", AxisScale::kLog};
    chart.y = {"error", AxisScale::kLogAndZero};
    chart.series = "method";
    chart.label = "cell";
    chart.showFront = true;
    return chart;
}

const CullingRow* findRow(std::span<const CullingRow> rows, std::string_view method) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const CullingRow& row) {
        return row.isTimed && row.method->name == method;
    });
    return found == rows.end() ? nullptr : &*found;
}

DataTable timeTable(std::span<const CullingRow> rows) {
    DataTable table{{{"method", "method"},
                     {"time", "a look [us]"},
                     {"low", "5 % [us]"},
                     {"high", "95 % [us]"},
                     {"ratio", "of Bullet's time"},
                     {"lost", "visible, lost [%]"},
                     {"in_vain", "drawn in vain [%]"},
                     {"cells", "cells or rows"},
                     {"boxes", "boxes tested"}},
                    {}};
    const CullingRow* bullet = findRow(rows, kBullet);
    for (const CullingRow& row : rows) {
        if (!row.isTimed) {
            continue;
        }
        const auto aView = [&](std::uint64_t number) {
            return static_cast<double>(number) / row.tally.views;
        };
        const bool tellsCost = &row != bullet;
        table.add({row.name(), row.microseconds.median, row.microseconds.low, row.microseconds.high,
                   bullet != nullptr ? Value(row.microseconds.median / bullet->microseconds.median)
                                     : Value(),
                   lostPercent(row.tally), inVainPercent(row.tally),
                   tellsCost ? Value(aView(row.tally.cost.cells)) : Value(),
                   tellsCost ? Value(aView(row.tally.cost.boxes)) : Value()});
    }
    return table;
}

void addChecks(const CullingMeasurement& measured, std::span<const CullingMethod> methods,
               Findings& findings) {
    for (const CullingMethod& method : methods) {
        const CullingTally sum = lossesOf(measured.rows, method).sum;
        const std::string ofVisible = " of " + withThousands(sum.visible) + " visible";
        if (method.mustSeeAll) {
            findings.checks.push_back({method.name + " draws all that is visible",
                                       sum.lost == 0 && sum.visible > 0,
                                       withThousands(sum.lost) + " lost" + ofVisible});
            const CullingTally touching = lossesOf(measured.touching, method).sum;
            findings.checks.push_back({method.name + " draws what just touches the view",
                                       touching.lost == 0 && touching.visible > 0,
                                       withThousands(touching.lost) + " lost of " +
                                           withThousands(touching.visible) + " visible"});
        }
        if (method.mustBeExact) {
            constexpr std::uint64_t oneByRounding = 10'000;  // in so many
            findings.checks.push_back({method.name + " draws nothing else, but for rounding",
                                       sum.inVain <= sum.visible / oneByRounding,
                                       withThousands(sum.inVain) + " in vain" + ofVisible});
        }
    }
}

void addChoices(std::span<const CullingRow> rows, const CullingPlan& plan, Findings& findings) {
    const std::string task = "Culling, " + withThousands(plan.objects) + " objects";
    for (const CullingRow& row : rows) {
        if (!row.isTimed) {
            continue;
        }
        const Losses losses = lossesOf(rows, *row.method);
        const double milliseconds = row.microseconds.median / 1000;
        const double inVain = inVainPercent(row.tally);
        const std::string drawn = "draws " + percentText(inVain) + " in vain";
        const std::string lost = losses.sum.lost == 0 ? "loses nothing"
                                                      : "loses up to " + percentText(losses.worst) +
                                                            " of what is visible";
        findings.choices.push_back({task + ": visible ones lost at worst", row.name(), milliseconds,
                                    losses.worst, lost + ", " + drawn, row.method->isOurs});
        if (losses.sum.lost == 0) {
            findings.choices.push_back({task + ": drawn in vain, none lost", row.name(),
                                        milliseconds, inVain, drawn, row.method->isOurs});
        }
    }
}

void addConclusions(const CullingMeasurement& measured, std::span<const CullingMethod> methods,
                    Findings& findings) {
    const std::span<const CullingRow> rows = measured.rows;
    for (const CullingMethod& method : methods) {
        const Losses losses = lossesOf(rows, method);
        if (losses.sum.lost > 0) {
            findings.conclusions.push_back(method.name + " loses up to " +
                                           percentText(losses.worst) + " of what is visible (" +
                                           losses.worstSetting + ").");
        }
    }
    for (const CullingRow& row : measured.touching) {
        if (row.tally.lost > 0) {
            findings.conclusions.push_back(
                row.method->name + " loses " + percentText(lostPercent(row.tally)) + " of " +
                withThousands(row.tally.visible) + " objects that touch the view's sides by " +
                "what single precision can tell.");
        }
    }
    const CullingRow* bullet = findRow(rows, kBullet);
    for (const CullingRow& row : rows) {
        if (bullet != nullptr && row.isTimed && row.method->mustSeeAll && !row.method->takesCells) {
            findings.conclusions.push_back(
                row.name() + ": a look takes " + valueText(row.microseconds.median) + " us, " +
                std::string(kBullet) + " " + valueText(bullet->microseconds.median) +
                " us; drawn in vain are " + percentText(inVainPercent(row.tally)) + " and " +
                percentText(inVainPercent(bullet->tally)) + ".");
        }
    }
}

CullingPlan planOf(const Effort& effort) {
    return {effort.quickOrFull<std::size_t>(20'000, 50'000), 1000, effort.quickOrFull(1, 8),
            effort.quickOrFull(kFewestFrames, 2 * kFewestFrames)};
}

}  // namespace

std::string CullingRow::name() const {
    return method->takesCells ? method->name + ", " +
                                    valueText(static_cast<double>(setting->cellSize)) + " m cells"
                              : method->name;
}

std::vector<CullingSetting> cullingSettings() {
    std::vector<CullingSetting> settings{{"as stated"}};
    const auto vary = [&](std::string_view what, float CullingSetting::*member,
                          std::string_view unit, std::initializer_list<float> values) {
        for (const float value : values) {
            CullingSetting setting;
            setting.name =
                std::string(what) + ' ' + valueText(static_cast<double>(value)) + std::string(unit);
            setting.*member = value;
            settings.push_back(setting);
        }
    };
    vary("field of view", &CullingSetting::fieldOfView, " deg", {30, 90, 120});
    vary("pitch", &CullingSetting::pitch, " deg", {-90, -70, -20, 0});
    vary("yaw", &CullingSetting::yaw, " deg", {0, 45});
    vary("objects up to", &CullingSetting::tallest, " m", {1, 40});
    vary("cells", &CullingSetting::cellSize, " m", {5, 25, 50, 100});
    CullingSetting best;  // for the paper's camera from above
    best.name = "straight down, yaw 0, 1 m";
    best.pitch = -90;
    best.yaw = 0;
    best.tallest = 1;
    settings.push_back(best);
    return settings;
}

Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                     std::span<const CullingMethod> methods, const TellProgress& tell) {
    const std::vector<CullingSetting> settings = cullingSettings();
    const CullingMeasurement measured = measureCulling(plan, seed, methods, settings, tell);
    const std::span<const CullingRow> rows = measured.rows;
    const std::string text = settingsText(plan, seed);
    Findings findings;
    findings.settings = {
        text + ".",
        "Visible is what shares a point with the frustum: boxes clipped by its planes in long "
        "double.",
        "Objects stand still, so that filing them is not in the times; Bullet's trees are "
        "optimised.",
        "Objects that touch the view's sides hang in the air above the ground, where footprints at "
        "its "
        "height do not look for them.",
        "A flight is 8 looks of a camera at 6 m/s that turns by 12 degrees a second, 60 looks a "
        "second; times are those of a flight by 8."};
    findings.charts = {settingsChart(rows, text, true), settingsChart(rows, text, false),
                       timeChart(rows, text, true), timeChart(rows, text, false)};
    findings.tables = {timeTable(rows)};
    addChecks(measured, methods, findings);
    addChoices(rows, plan, findings);
    addConclusions(measured, methods, findings);
    return findings;
}

Experiment cullingExperiment() {
    return {"P4",
            "Culling",
            "How many visible objects are lost, and how many are drawn in vain?",
            3,
            20,
            [](const Effort& effort, const TellProgress& tell) {
                return findCulling(planOf(effort), effort.seed, cullingMethods(), tell);
            }};
}

}  // namespace hashphase::demos
