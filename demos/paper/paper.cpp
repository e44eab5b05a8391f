// SPDX-License-Identifier: Zlib
#include <demos/paper/paper.hpp>

#include <broadphase/radius_search.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

using enum MethodKind;

constexpr std::array kRadii{2.5F, 5.0F, 10.0F, 20.0F, 40.0F};                          // [m]
constexpr std::array<double, 11> kCellSizes{1, 2, 3, 5, 7, 10, 15, 25, 50, 100, 200};  // [m]

/// Something to measure, or to leave out.
struct Step {
    std::string what;
    std::size_t weight = 0;
    PhaseTask task;
    std::vector<MethodSpec> specs;  // none: of the bounding volumes
};

/// All kinds run together, or in a hurry one after the other, the cheapest first, so that what is slow takes
/// no time from the others.
void addFigures(const PaperPlan& plan, std::vector<Step>& steps) {
    const auto rounds =
        plan.effort.isHurried
            ? std::vector<std::vector<MethodKind>>{{hashphase}, {paperGrid}, {unoptimized}}
            : std::vector<std::vector<MethodKind>>{{hashphase, paperGrid, unoptimized}};
    for (const std::vector<MethodKind>& kinds : rounds) {
        for (const Phase phase : kPhases) {
            for (const std::uint32_t objects : plan.objects) {
                std::vector<MethodSpec> specs = figureMethods(objects);
                std::erase_if(specs, [&](const MethodSpec& spec) {
                    return std::find(kinds.begin(), kinds.end(), spec.kind) == kinds.end();
                });
                if (!specs.empty()) {
                    std::string what = std::string(nameOf(phase)) + " of " + withThousands(objects);
                    what += kinds.size() == 1 ? ", " + std::string(nameOf(kinds[0])) : "";
                    steps.push_back({what,
                                     objects,
                                     {phase, objects, plan.seed, plan.aiRadius, "figure"},
                                     specs});
                }
            }
        }
    }
}

std::vector<Step> stepsOf(const PaperPlan& plan) {
    std::vector<Step> steps;
    addFigures(plan, steps);
    for (const float radius : kRadii) {
        steps.push_back({"AI within " + fixed(static_cast<double>(radius), 1) + " m",
                         plan.sweepObjects,
                         {Phase::ai, plan.sweepObjects, plan.seed, radius, "radius"},
                         {{hashphase, std::nullopt}, {paperGrid, 5}, {paperGrid, 25}}});
    }
    std::vector<MethodSpec> specs;
    for (const double size : kCellSizes) {
        specs.push_back({paperGrid, size});
        specs.push_back({hashphase, size});
    }
    specs.push_back({hashphase, std::nullopt});
    steps.push_back({"cell sizes",
                     std::size_t{2} * plan.sweepObjects,
                     {Phase::collision, plan.sweepObjects, plan.seed, plan.aiRadius, "cell size"},
                     specs});
    steps.push_back({"bounding volumes", plan.sticks, {}, {}});
    return steps;
}

double meanNeighbours(const PhaseTask& task) {
    const TestBed bed(task.objects, task.seed);
    Grid<float> grid;
    for (const Aabb<float>& box : bed.boxes()) {
        static_cast<void>(grid.add(box));
    }
    RadiusSearch<float> search;
    search.take(grid, task.aiRadius);
    std::vector<std::uint32_t> counts(search.size());
    search.count(counts);
    return std::accumulate(counts.begin(), counts.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(counts.size(), 1));
}

}  // namespace

void addPlan(const PaperPlan& plan, Measurements& measured) {
    measured.add("plan", {{"most_objects", plan.objects.empty() ? 0 : plan.objects.back()},
                          {"seed", plan.seed},
                          {"radius", plan.aiRadius},
                          {"colours", TestBed::kColours},
                          {"sweep_objects", plan.sweepObjects},
                          {"sticks", plan.sticks},
                          {"frames", plan.effort.frames},
                          {"fewest_frames", plan.effort.fewestFrames},
                          {"is_hurried", plan.effort.isHurried},
                          {"spot_checked", kSpotChecked},
                          {"most_brute_forced", kMostBruteForced}});
}

Measurements measurePaper(const PaperPlan& plan, const PaperWatch& watch) {
    Measurements measured;
    addPlan(plan, measured);
    std::size_t done = 0;
    for (const Step& step : stepsOf(plan)) {
        watch.tellProgress(done, step.what);
        done += step.weight;
        if (watch.isTimeUp()) {
            measured.add("left_out", {{"what", step.what}});
        } else if (step.specs.empty()) {
            measureVolumes(plan.sticks, plan.effort, plan.seed, measured, watch.isTimeUp);
        } else {
            measurePhase(step.task, step.specs, plan.effort, measured, watch.isTimeUp);
            if (step.task.part == "radius") {
                measured.add("neighbours", {{"radius", step.task.aiRadius},
                                            {"neighbours", meanNeighbours(step.task)}});
            }
        }
    }
    return measured;
}

std::size_t paperSteps(const PaperPlan& plan) {
    const std::vector<Step> steps = stepsOf(plan);
    return std::accumulate(steps.begin(), steps.end(), std::size_t{0},
                           [](std::size_t sum, const Step& step) { return sum + step.weight; });
}

}  // namespace hashphase::demos
