// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_results.hpp>

#include <broadphase/radius_search.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::array kRadii{2.5F, 5.0F, 10.0F, 20.0F, 40.0F};                          // [m]
constexpr std::array<double, 11> kCellSizes{1, 2, 3, 5, 7, 10, 15, 25, 50, 100, 200};  // [m]
constexpr std::array<double, 2> kRadiusCellSizes{5, 25};                               // [m]

/// Something to measure, or to leave out.
struct Step {
    std::string what;
    std::size_t weight;
    std::function<void(PaperResults&, const IsTimeUp&)> run;
};

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

/// The kinds that run together: all, or in a hurry one after the other, the cheapest first, so that
/// what is slow takes no time from the others.
std::vector<std::vector<MethodKind>> roundsOf(const PaperPlan& plan) {
    using enum MethodKind;
    return plan.effort.isHurried
               ? std::vector<std::vector<MethodKind>>{{hashphase}, {paperGrid}, {unoptimized}}
               : std::vector<std::vector<MethodKind>>{{hashphase, paperGrid, unoptimized}};
}

/// Another round has other methods.
void addRound(PhaseResult round, std::vector<PhaseResult>& figures) {
    for (PhaseResult& figure : figures) {
        if (figure.task.phase == round.task.phase && figure.task.objects == round.task.objects) {
            figure.found = std::max(figure.found, round.found);
            std::move(round.methods.begin(), round.methods.end(),
                      std::back_inserter(figure.methods));
            return;
        }
    }
    figures.push_back(std::move(round));
}

void addFigures(const PaperPlan& plan, std::vector<Step>& steps) {
    for (const std::vector<MethodKind>& kinds : roundsOf(plan)) {
        for (const Phase phase : kPhases) {
            for (const std::uint32_t objects : plan.objects) {
                std::vector<MethodSpec> specs = figureMethods(phase, objects, plan.aiRadius);
                std::erase_if(specs, [&](const MethodSpec& spec) {
                    return std::find(kinds.begin(), kinds.end(), spec.kind) == kinds.end();
                });
                if (specs.empty()) {
                    continue;
                }
                std::string what = std::string(nameOf(phase)) + " of " + withThousands(objects);
                what += kinds.size() == 1 ? ", " + std::string(nameOf(kinds[0])) : "";
                steps.push_back(
                    {what, objects, [=, &plan](PaperResults& results, const IsTimeUp& isTimeUp) {
                         addRound(measurePhase({phase, objects, plan.seed, plan.aiRadius}, specs,
                                               plan.effort, isTimeUp),
                                  results.figures);
                     }});
            }
        }
    }
}

void addRadii(const PaperPlan& plan, std::vector<Step>& steps) {
    for (const float radius : kRadii) {
        const PhaseTask task{Phase::ai, plan.sweepObjects, plan.seed, radius};
        steps.push_back(
            {"AI within " + fixed(static_cast<double>(radius), 1) + " m", plan.sweepObjects,
             [=, &plan](PaperResults& results, const IsTimeUp& isTimeUp) {
                 std::vector<MethodSpec> specs{
                     methodSpec(Phase::ai, MethodKind::hashphase, std::nullopt, radius)};
                 for (const double cellSize : kRadiusCellSizes) {
                     specs.push_back(
                         methodSpec(Phase::ai, MethodKind::paperGrid, cellSize, radius));
                 }
                 results.radii.push_back(measurePhase(task, specs, plan.effort, isTimeUp));
                 results.neighbours.push_back(meanNeighbours(task));
             }});
    }
}

void addCellSizes(const PaperPlan& plan, std::vector<Step>& steps) {
    steps.push_back(
        {"cell sizes", std::size_t{2} * plan.sweepObjects,
         [&plan](PaperResults& results, const IsTimeUp& isTimeUp) {
             const float radius = plan.aiRadius;
             std::vector<MethodSpec> specs;
             for (const double size : kCellSizes) {
                 for (const MethodKind kind : {MethodKind::paperGrid, MethodKind::hashphase}) {
                     specs.push_back(methodSpec(Phase::collision, kind, size, radius));
                 }
             }
             specs.push_back(
                 methodSpec(Phase::collision, MethodKind::hashphase, std::nullopt, radius));
             results.cellSizes =
                 measurePhase({Phase::collision, plan.sweepObjects, plan.seed, radius}, specs,
                              plan.effort, isTimeUp);
         }});
}

std::vector<Step> stepsOf(const PaperPlan& plan) {
    std::vector<Step> steps;
    addFigures(plan, steps);
    addRadii(plan, steps);
    addCellSizes(plan, steps);
    steps.push_back(
        {"bounding volumes", plan.sticks, [&plan](PaperResults& results, const IsTimeUp& isTimeUp) {
             results.volumes = measureVolumes(plan.sticks, plan.effort, plan.seed, isTimeUp);
         }});
    return steps;
}

/// What was begun and not measured to the end.
void noteUnmeasured(PaperResults& results) {
    const auto look = [&results](const PhaseResult& result) {
        for (const MethodResult& method : result.methods) {
            if (!method.isMeasured()) {
                results.leftOut.push_back(std::string(nameOf(result.task.phase)) + " of " +
                                          withThousands(result.task.objects) + ", " +
                                          describe(method));
            }
        }
    };
    std::for_each(results.figures.begin(), results.figures.end(), look);
    std::for_each(results.radii.begin(), results.radii.end(), look);
    look(results.cellSizes);
}

bool isRealTime(const PhaseResult& result, MethodKind kind, std::optional<double> cellSize) {
    const MethodResult* method = result.find(kind, cellSize);
    return method != nullptr && method->rate().value_or(0) >= kRealTimeRate;
}

}  // namespace

const PhaseResult* PaperResults::figure(Phase phase, std::uint32_t objects) const {
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const PhaseResult& each) {
        return each.task.phase == phase && each.task.objects == objects;
    });
    return found == figures.end() ? nullptr : &*found;
}

CheckOutcome PaperResults::outcome() const {
    const auto has = [this](CheckOutcome outcome) {
        return std::any_of(checks.begin(), checks.end(),
                           [=](const PaperCheck& check) { return check.outcome == outcome; });
    };
    if (has(CheckOutcome::broken)) {
        return CheckOutcome::broken;
    }
    return checks.empty() || has(CheckOutcome::notChecked) ? CheckOutcome::notChecked
                                                           : CheckOutcome::holds;
}

RealTimeTally tallyRealTime(const PaperResults& results) {
    RealTimeTally tally;
    const auto look = [](const PhaseResult& result, MethodKind kind, std::optional<double> cellSize,
                         CellTally& cells) {
        if (isTooSlow(printedRate(result.task.phase, result.task.objects, cellSize))) {
            ++cells.tooSlow;
            cells.today += isRealTime(result, kind, cellSize) ? 1 : 0;
            cells.hashphase += isRealTime(result, MethodKind::hashphase, cellSize) ? 1 : 0;
        }
    };
    for (const PhaseResult& result : results.figures) {
        const auto phase = static_cast<std::size_t>(result.task.phase);
        look(result, MethodKind::unoptimized, std::nullopt, tally.unoptimized[phase]);
        for (const double cellSize : kPrintedCellSizes) {
            look(result, MethodKind::paperGrid, cellSize, tally.grid[phase]);
        }
    }
    return tally;
}

LossTally tallyLosses(const PaperResults& results) {
    LossTally tally;
    for (const PhaseResult& result : results.figures) {
        for (const double cellSize : kPrintedCellSizes) {
            const MethodResult* paper = result.find(MethodKind::paperGrid, cellSize);
            const MethodResult* ours = result.find(MethodKind::hashphase, cellSize);
            if (paper == nullptr || ours == nullptr || !paper->isMeasured() ||
                !ours->isMeasured()) {
                continue;
            }
            const double ratio = ours->time().median / paper->time().median;
            ++tally.compared;
            tally.lost += ratio > 1 ? 1 : 0;
            if (ratio > tally.worstRatio) {
                tally.worstRatio = ratio;
                tally.worst = std::string(nameOf(result.task.phase)) + " of " +
                              withThousands(result.task.objects) + ", cells of " +
                              fixed(cellSize, 0) + " m";
            }
        }
    }
    return tally;
}

PaperResults measurePaper(const PaperPlan& plan, const PaperWatch& watch) {
    PaperResults results;
    results.plan = plan;
    std::size_t done = 0;
    for (const Step& step : stepsOf(plan)) {
        watch.tellProgress(done, step.what);
        if (watch.isTimeUp()) {
            results.leftOut.push_back(step.what);
        } else {
            step.run(results, watch.isTimeUp);
        }
        done += step.weight;
    }
    noteUnmeasured(results);
    std::vector<PhaseResult> all = results.figures;
    all.insert(all.end(), results.radii.begin(), results.radii.end());
    all.push_back(results.cellSizes);
    results.checks = results.volumes.checks;
    results.checks.insert(results.checks.begin(), agreement(all));
    return results;
}

std::size_t paperSteps(const PaperPlan& plan) {
    const std::vector<Step> steps = stepsOf(plan);
    return std::accumulate(steps.begin(), steps.end(), std::size_t{0},
                           [](std::size_t sum, const Step& step) { return sum + step.weight; });
}

}  // namespace hashphase::demos
