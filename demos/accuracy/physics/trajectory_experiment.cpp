// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/trajectory_run.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace hashphase::demos {
namespace {

void judge(const TrajectoryRun& run, Findings& findings) {
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

double meanStepMs(const TrajectoryRun& run, ListOrder order, std::size_t broadphase) {
    double sum = 0;
    for (const auto& scene : run.in(order)) {
        sum += scene[broadphase].stepMs.median;
    }
    return sum / static_cast<double>(run.scenes.size());
}

void offer(const TrajectoryRun& run, Findings& findings) {
    const auto scenes = static_cast<double>(run.scenes.size());
    const std::string task = "A step of a Bullet world that moves as under brute force (mean of " +
                             std::to_string(run.scenes.size()) + " scenes)";
    for (const ListOrder order : kListOrders) {
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

std::string sameSentence(const TrajectoryRun& run, ListOrder order) {
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
std::string dbvtSentence(const TrajectoryRun& run) {
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

std::string timeSentence(const TrajectoryRun& run) {
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

void conclude(const TrajectoryRun& run, Findings& findings) {
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
    const TrajectoryRun run = runTrajectories(broadphases, scenes, settings, tell);
    Findings findings;
    findings.settings = {
        trajectorySettingsText(run) + ".",
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
    findings.tables = trajectoryTables(run);
    findings.charts = trajectoryCharts(run);
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
