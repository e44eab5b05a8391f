// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/trajectory_run.hpp>

#include <demos/console/format.hpp>

namespace hashphase::demos {
namespace {

DataTable sameTable(const TrajectoryRun& run) {
    DataTable table{{{"order", "order of lists"}, {"scene"}, {"objects"}}, {}};
    for (const PhysicsBroadphase& each : run.broadphases) {
        if (each.name != kSimpleName) {
            table.columns.push_back({each.name, "same bits with " + each.name});
        }
    }
    for (const ListOrder order : kListOrders) {
        for (std::size_t scene = 0; scene < run.scenes.size(); ++scene) {
            std::vector<Value> row{std::string(titleOf(order)), run.scenes[scene].name,
                                   static_cast<double>(run.objects(run.scenes[scene]))};
            for (std::size_t i = 0; i < run.broadphases.size(); ++i) {
                const SceneOutcome& outcome = run.in(order)[scene][i];
                if (run.broadphases[i].name != kSimpleName) {
                    row.emplace_back(outcome.isSame()
                                         ? "yes"
                                         : "until step " + std::to_string(outcome.firstDifference));
                }
            }
            table.add(std::move(row));
        }
    }
    return table;
}

constexpr double kStepMs = 1000.0 / 60;

DataTable timeTable(const TrajectoryRun& run) {
    DataTable table{{{"scene"},
                     {"objects"},
                     {"method"},
                     {"step_ms", "step [ms]"},
                     {"low_ms", "5 % of steps [ms]"},
                     {"high_ms", "95 % of steps [ms]"},
                     {"real_time_factor", "real-time factor"},
                     {"ratio_to_dbvt", "times as fast as btDbvtBroadphase"},
                     {"pairs", "pairs at the end"},
                     {"asleep", "asleep on average"}},
                    {}};
    const std::size_t dbvt = run.indexOf(kDbvtName);
    for (std::size_t scene = 0; scene < run.scenes.size(); ++scene) {
        const auto& outcomes = run.in(ListOrder::asShipped)[scene];
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
            const SceneOutcome& each = outcomes[i];
            table.add({run.scenes[scene].name, static_cast<double>(run.objects(run.scenes[scene])),
                       run.broadphases[i].name, each.stepMs.median, each.stepMs.low,
                       each.stepMs.high, kStepMs / each.stepMs.median,
                       outcomes[dbvt].stepMs.median / each.stepMs.median,
                       static_cast<double>(each.pairs),
                       static_cast<double>(each.asleep) / run.settings.steps});
        }
    }
    return table;
}

Chart sameChart(const TrajectoryRun& run) {
    Chart chart;
    chart.name = "P8-same-motion";
    chart.title = "In how many scenes do all bodies move as under brute force, to the last bit?";
    chart.settings =
        trajectorySettingsText(run) + "; " + std::to_string(run.scenes.size()) + " scenes";
    chart.mark = ChartMark::kCell;
    chart.data.columns = {{"method", "broadphase"},
                          {"order", "order of lists"},
                          {"same", "scenes with the same motion"}};
    for (const ListOrder order : kListOrders) {
        for (std::size_t i = 0; i < run.broadphases.size(); ++i) {
            chart.data.add({run.broadphases[i].name, std::string(titleOf(order)),
                            static_cast<double>(run.sameCount(order, i))});
        }
    }
    chart.x = {"method", AxisScale::kNames};
    chart.y = {"order", AxisScale::kNames};
    chart.shade = {"same", AxisScale::kLinear};
    return chart;
}

Chart timeChart(const TrajectoryRun& run) {
    Chart chart;
    chart.name = "P8-step-time";
    chart.title = "What a whole step costs under each broadphase";
    chart.settings =
        trajectorySettingsText(run) + "; lists as shipped; bars from 5 % to 95 % of the steps";
    chart.mark = ChartMark::kPoint;
    chart.data = timeTable(run);
    chart.x = {"scene", AxisScale::kNames};
    chart.y = {"step_ms", AxisScale::kLog};
    chart.series = "method";
    chart.low = "low_ms";
    chart.high = "high_ms";
    return chart;
}

}  // namespace

TrajectoryRun runTrajectories(std::span<const PhysicsBroadphase> broadphases,
                              std::span<const PhysicsScene> scenes,
                              const TrajectorySettings& settings, const TellProgress& tell) {
    TrajectoryRun run{broadphases, scenes, settings, {}};
    const std::size_t reference = run.indexOf(kSimpleName);
    double done = 0;
    for (const ListOrder order : kListOrders) {
        auto& outcomes = run.outcomes.emplace_back();
        for (const PhysicsScene& scene : scenes) {
            tell(done++ / static_cast<double>(kListOrders.size() * scenes.size()), scene.name);
            outcomes.push_back(runScene(scene, run.objects(scene), settings.seed, settings.steps,
                                        broadphases, order, reference));
        }
    }
    return run;
}

std::string trajectorySettingsText(const TrajectoryRun& run) {
    return withThousands(static_cast<std::uint64_t>(run.settings.steps)) +
           " steps of 1/60 s, 10 solver iterations, sleeping on, single precision, seed " +
           std::to_string(run.settings.seed);
}

std::vector<DataTable> trajectoryTables(const TrajectoryRun& run) {
    return {sameTable(run), timeTable(run)};
}

std::vector<Chart> trajectoryCharts(const TrajectoryRun& run) {
    return {sameChart(run), timeChart(run)};
}

}  // namespace hashphase::demos
