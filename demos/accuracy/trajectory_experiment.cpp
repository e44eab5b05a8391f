// SPDX-License-Identifier: Zlib
#include <demos/accuracy/trajectory_experiment.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/scene_run.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

constexpr std::array kOrders{ListOrder::canonical, ListOrder::byUniqueId, ListOrder::asShipped};

/// Everything that was run: outcomes[order][scene][broadphase].
struct Run {
    std::span<const PhysicsBroadphase> broadphases;
    std::span<const PhysicsScene> scenes;
    TrajectorySettings settings;
    std::vector<std::vector<std::vector<SceneOutcome>>> outcomes;

    [[nodiscard]] std::size_t objects(const PhysicsScene& scene) const {
        return settings.isQuick ? scene.quickObjects : scene.fullObjects;
    }
    [[nodiscard]] std::size_t indexOf(std::string_view name) const {
        const auto at = std::find_if(broadphases.begin(), broadphases.end(),
                                     [name](const auto& each) { return each.name == name; });
        return static_cast<std::size_t>(at - broadphases.begin());
    }
    [[nodiscard]] const std::vector<std::vector<SceneOutcome>>& in(ListOrder order) const {
        return outcomes[static_cast<std::size_t>(std::find(kOrders.begin(), kOrders.end(), order) -
                                                 kOrders.begin())];
    }
    /// In how many scenes the broadphase moves bodies as the reference does.
    [[nodiscard]] std::size_t sameCount(ListOrder order, std::size_t broadphase) const {
        const auto& scenesOfOrder = in(order);
        return static_cast<std::size_t>(
            std::count_if(scenesOfOrder.begin(), scenesOfOrder.end(),
                          [&](const auto& scene) { return scene[broadphase].isSame(); }));
    }
    [[nodiscard]] std::string sameText(ListOrder order, std::size_t broadphase) const {
        return std::to_string(sameCount(order, broadphase)) + " of " +
               std::to_string(scenes.size());
    }
};

Run runAll(std::span<const PhysicsBroadphase> broadphases, std::span<const PhysicsScene> scenes,
           const TrajectorySettings& settings, const TellProgress& tell) {
    Run run{broadphases, scenes, settings, {}};
    const std::size_t reference = run.indexOf(kSimpleName);
    double done = 0;
    for (const ListOrder order : kOrders) {
        auto& outcomes = run.outcomes.emplace_back();
        for (const PhysicsScene& scene : scenes) {
            tell(done++ / static_cast<double>(kOrders.size() * scenes.size()), scene.name);
            outcomes.push_back(runScene(scene, run.objects(scene), settings.seed, settings.steps,
                                        broadphases, order, reference));
        }
    }
    return run;
}

DataTable sameTable(const Run& run) {
    DataTable table{{{"order", "order of lists"}, {"scene"}, {"objects"}}, {}};
    for (const PhysicsBroadphase& each : run.broadphases) {
        if (each.name != kSimpleName) {
            table.columns.push_back({each.name, "same bits with " + each.name});
        }
    }
    for (const ListOrder order : kOrders) {
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

DataTable timeTable(const Run& run) {
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

std::string settingsText(const Run& run) {
    return withThousands(static_cast<std::uint64_t>(run.settings.steps)) +
           " steps of 1/60 s, 10 solver iterations, sleeping on, single precision, seed " +
           std::to_string(run.settings.seed);
}

Chart sameChart(const Run& run) {
    Chart chart;
    chart.name = "P8-same-motion";
    chart.title = "In how many scenes do all bodies move as under brute force, to the last bit?";
    chart.settings = settingsText(run) + "; " + std::to_string(run.scenes.size()) + " scenes";
    chart.mark = ChartMark::kCell;
    chart.data.columns = {{"method", "broadphase"},
                          {"order", "order of lists"},
                          {"same", "scenes with the same motion"}};
    for (const ListOrder order : kOrders) {
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

Chart timeChart(const Run& run) {
    Chart chart;
    chart.name = "P8-step-time";
    chart.title = "What a whole step costs under each broadphase";
    chart.settings = settingsText(run) + "; lists as shipped; bars from 5 % to 95 % of the steps";
    chart.mark = ChartMark::kPoint;
    chart.data = timeTable(run);
    chart.x = {"scene", AxisScale::kNames};
    chart.y = {"step_ms", AxisScale::kLog};
    chart.series = "method";
    chart.low = "low_ms";
    chart.high = "high_ms";
    return chart;
}

void judge(const Run& run, Findings& findings) {
    for (std::size_t i = 0; i < run.broadphases.size(); ++i) {
        const PhysicsBroadphase& each = run.broadphases[i];
        if (each.isExact && each.name != kSimpleName) {
            findings.checks.push_back(
                {each.name + " moves all bodies as btSimpleBroadphase does, to the last bit, when "
                             "pairs and contacts are listed in canonical order",
                 run.sameCount(ListOrder::canonical, i) == run.scenes.size(),
                 run.sameText(ListOrder::canonical, i) + " scenes, " +
                     std::to_string(run.settings.steps) + " steps each"});
        }
    }
}

double meanStepMs(const Run& run, ListOrder order, std::size_t broadphase) {
    double sum = 0;
    for (const auto& scene : run.in(order)) {
        sum += scene[broadphase].stepMs.median;
    }
    return sum / static_cast<double>(run.scenes.size());
}

void offer(const Run& run, Findings& findings) {
    const auto scenes = static_cast<double>(run.scenes.size());
    const std::string task = "A step of a Bullet world that moves as under brute force (mean of " +
                             std::to_string(run.scenes.size()) + " scenes)";
    for (const ListOrder order : kOrders) {
        for (std::size_t i = 0; i < run.broadphases.size(); ++i) {
            const auto same = static_cast<double>(run.sameCount(order, i));
            findings.choices.push_back(
                {task, run.broadphases[i].name + ", lists " + std::string(titleOf(order)),
                 meanStepMs(run, order, i), 1 - same / scenes,
                 "the same motion in " + run.sameText(order, i) + " scenes",
                 run.broadphases[i].isOurs});
        }
    }
}

std::string sameSentence(const Run& run, ListOrder order) {
    std::string text;
    for (std::size_t i = 0; i < run.broadphases.size(); ++i) {
        if (run.broadphases[i].name != kSimpleName) {
            text += (text.empty() ? "" : ", ") + run.broadphases[i].name + " in " +
                    run.sameText(order, i);
        }
    }
    return text;
}

/// Why the tree differs from brute force, as far as the runs tell.
std::string dbvtSentence(const Run& run) {
    const std::size_t dbvt = run.indexOf(kDbvtName);
    const std::size_t simple = run.indexOf(kSimpleName);
    double extra = 0;
    double exact = 0;
    long asleep = 0;
    long asleepExact = 0;
    for (const auto& scene : run.in(ListOrder::canonical)) {
        extra += scene[dbvt].pairs - scene[simple].pairs;
        exact += scene[simple].pairs;
        asleep += scene[dbvt].asleep;
        asleepExact += scene[simple].asleep;
    }
    std::string text = "In canonical order btDbvtBroadphase moves bodies as brute force does in " +
                       run.sameText(ListOrder::canonical, dbvt) +
                       " scenes, its contacts sorted by "
                       "Bullet's own flag in " +
                       run.sameText(ListOrder::byUniqueId, dbvt) + ": at the end it lists " +
                       fixed(100 * extra / std::max(exact, 1.0), 1) + " % more pairs than overlap";
    if (asleepExact > 0) {
        text += ", and bodies slept " +
                fixed(100.0 * static_cast<double>(asleep) / static_cast<double>(asleepExact), 1) +
                " % of the time that they sleep under brute force";
    }
    text +=
        ". These pairs have no contacts, but they change the order in which Bullet solves "
        "contacts and who may sleep";
    const auto held = std::find_if(run.broadphases.begin(), run.broadphases.end(),
                                   [](const auto& each) { return each.name == kExactDbvtName; });
    if (held != run.broadphases.end()) {
        text += "; the same tree held to exact boxes agrees in " +
                run.sameText(ListOrder::canonical,
                             static_cast<std::size_t>(held - run.broadphases.begin()));
    }
    return text + ".";
}

std::string timeSentence(const Run& run) {
    const std::size_t dbvt = run.indexOf(kDbvtName);
    const std::size_t hash = run.indexOf(kHashName);
    std::vector<double> ratios;
    for (const auto& scene : run.in(ListOrder::asShipped)) {
        ratios.push_back(scene[dbvt].stepMs.median / scene[hash].stepMs.median);
    }
    std::sort(ratios.begin(), ratios.end());
    return "A whole step over hashphase is " + fixed(ratios.front(), 2) + " to " +
           fixed(ratios.back(), 2) + " times as fast as over btDbvtBroadphase, " +
           fixed(percentile(ratios, 0.5), 2) +
           " times in the median scene: of so few bodies, most of a step is narrowphase and "
           "solver.";
}

void conclude(const Run& run, Findings& findings) {
    findings.conclusions = {
        "Canonical order, the same motion as under btSimpleBroadphase: " +
            sameSentence(run, ListOrder::canonical) + " scenes.",
        dbvtSentence(run),
        "With m_deterministicOverlappingPairs alone: " + sameSentence(run, ListOrder::byUniqueId) +
            ".",
        "As shipped: " + sameSentence(run, ListOrder::asShipped) +
            ". Bullet's own broadphases differ among each other as well: its results depend on the "
            "order of pairs.",
    };
    if (run.indexOf(kHashName) < run.broadphases.size()) {
        findings.conclusions.push_back(timeSentence(run));
    }
}

}  // namespace

Findings compareTrajectories(std::span<const PhysicsBroadphase> broadphases,
                             std::span<const PhysicsScene> scenes,
                             const TrajectorySettings& settings, const TellProgress& tell) {
    const Run run = runAll(broadphases, scenes, settings, tell);
    Findings findings;
    findings.settings = {
        settingsText(run) + ".",
        "Truth: btSimpleBroadphase, which compares all boxes with all. Place, velocities and "
        "activation of all bodies are compared after every step, bit by bit.",
        "Canonical order: pairs sorted by the numbers of the bodies, contact manifolds by age, so "
        "that nothing but the set of pairs can matter.",
        "m_deterministicOverlappingPairs sorts contacts by unique ids, which btSimpleBroadphase "
        "and "
        "bt32BitAxisSweep3 give away again when bodies come back (churn), and the others do not.",
        "lattice: spheres that fall into an open box; bouncing: balls that bounce for ever; "
        "compounds: dumbbells and crosses that fall into a heap; churn: a pile out of which bodies "
        "are taken and dropped again; the others are those of `hashphase compare`.",
    };
    findings.tables = {sameTable(run), timeTable(run)};
    findings.charts = {sameChart(run), timeChart(run)};
    judge(run, findings);
    offer(run, findings);
    conclude(run, findings);
    return findings;
}

Experiment trajectoryExperiment() {
    return {"P8",
            "Does the grid change physics?",
            "Do bodies move to the last bit as under brute force, whatever the broadphase?",
            4,
            60,
            [](const Effort& effort, const TellProgress& tell) {
                const TrajectorySettings settings{effort.quickOrFull(120, 600), effort.seed,
                                                  effort.isQuick};
                return compareTrajectories(physicsBroadphases(), physicsScenes(), settings, tell);
            }};
}

}  // namespace hashphase::demos
