// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/cell_size.hpp>

#include <demos/accuracy/baselines/paper_grid.hpp>
#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/pairs/cell_size_charts.hpp>
#include <demos/accuracy/pairs/cell_size_findings.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

// With more the paper's grid would hold little else, or compare everything with everything.
constexpr double kMostCellsPerObject = 64;
constexpr double kMostTestsPerObject = 300;

struct Population {
    const char* name;
    SizeLaw sizes;
    float sizeRatio;
    Placement placement;
};
constexpr std::array kPopulations{
    Population{"uniform", SizeLaw::near, 1, Placement::cube},
    Population{"clustered", SizeLaw::near, 1, Placement::clusters},
    Population{"sizes 1:1000", SizeLaw::logUniform, 1000, Placement::cube},
};

CellCase cellCase(const Population& population, std::size_t objects,
                  std::span<const double> factors) {
    CellCase each;
    each.population = population.name;
    each.plan.sizes = population.sizes;
    each.plan.sizeRatio = population.sizeRatio;
    each.plan.placement = population.placement;
    each.objects = objects;
    each.factors.assign(factors.begin(), factors.end());
    return each;
}

// Those that can be told to be out of the question before they are tried.
std::vector<CellMethod> affordable(std::vector<CellMethod> methods, const BoxScene& scene) {
    std::vector<BulletBox> boxes;
    toBulletBoxes(scene.boxes(), boxes);
    std::erase_if(methods, [&](const CellMethod& each) {
        return each.filingCellSize > 0 &&
               filedCellCount(boxes, each.filingCellSize) >
                   kMostCellsPerObject * static_cast<double>(boxes.size());
    });
    return methods;
}

}  // namespace

std::string CellMethod::name() const {
    return factor ? pairs.name + ", " + factorText(*factor) : pairs.name;
}

std::string CellCase::name() const {
    return population + ", " + withThousands(objects);
}

std::vector<CellCase> cellCases(const Effort& effort) {
    constexpr std::array kAll{0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};
    constexpr std::array kFew{0.25, 1.0, 2.0, 4.0, 16.0, 64.0};
    constexpr std::array kLikely{0.5, 1.0, 2.0, 4.0, 8.0};  // where a frame takes long
    constexpr std::array kAroundTheBest{2.0, 4.0};
    std::vector<CellCase> cases;
    for (const Population& population : kPopulations) {
        if (effort.isQuick) {
            cases.push_back(cellCase(population, 1'000, kFew));
            cases.push_back(cellCase(population, 3'000, kFew));
        } else {
            cases.push_back(cellCase(population, 1'000, kAll));
            cases.push_back(cellCase(population, 10'000, kAll));
            cases.push_back(cellCase(population, 100'000, kLikely));
        }
    }
    if (!effort.isQuick) {
        cases.push_back(cellCase(kPopulations[0], 1'000'000, kAroundTheBest));
        cases.back().judgedFrames = 1;
    }
    return cases;
}

std::vector<CellMethod> cellMethods(const CellCase& each, double meanEdge) {
    // Beyond, each of them would take longer than all others together.
    constexpr std::size_t kOthersUpTo = 20'000;
    std::vector<CellMethod> methods;
    methods.push_back({hashMethod("automatic levels")});
    methods.back().isAutomatic = true;
    for (const double factor : each.factors) {
        GridConfig config;
        config.cellSize = factor * meanEdge;
        methods.push_back({hashMethod("levels", config), factor});
    }
    if (each.objects > kOthersUpTo) {
        return methods;
    }
    for (const double factor : each.factors) {
        const double cellSize = factor * meanEdge;
        for (const PairMethod& paper :
             std::array{paperGridMethod("one grid, all cells (paper)", cellSize, FiledCells::kAll),
                        paperGridMethod("one grid, corner cells (paper)", cellSize,
                                        FiledCells::kCorners)}) {
            methods.push_back({paper, factor});
            methods.back().filingCellSize = cellSize;
            methods.back().pairs.mostTestsTimed =
                kMostTestsPerObject * static_cast<double>(each.objects);
        }
    }
    methods.push_back({dbvtMethod(false)});
    return methods;
}

namespace {

CellCaseResult measure(const CellCase& each, const CellMethods& methodsOf, std::uint64_t seed) {
    const BrownianBoxes boxes = scatter(each.plan, each.objects, seed);
    const double edge = meanEdge(boxes);
    BrownianScene scene(boxes, seed);
    CellCaseResult result;
    result.name = each.name();
    result.population = each.population;
    result.objects = each.objects;
    result.methods = affordable(methodsOf(each, edge), scene);
    for (const BrownianBoxes::Body& body : boxes.bodies) {
        const double largest = 2 * static_cast<double>(body.halfEdges.maxCoeff());
        result.largestEdgeByMean = std::max(result.largestEdgeByMean, largest / edge);
    }
    std::vector<PairMethod> methods;
    for (const CellMethod& method : result.methods) {
        methods.push_back(method.pairs);
    }
    PairTrialPlan plan;
    plan.judgedFrames = each.judgedFrames;
    plan.rounds = kFewestFrames;
    result.trial = tryPairs(scene, methods, plan);
    return result;
}

}  // namespace

Findings measureCellSizes(std::span<const CellCase> cases, const CellMethods& methods,
                          const Effort& effort, const TellProgress& tell) {
    std::size_t total = 0;
    for (const CellCase& each : cases) {
        total += each.objects;
    }
    std::vector<CellCaseResult> results;
    std::size_t done = 0;
    for (const CellCase& each : cases) {
        tell(static_cast<double>(done) / static_cast<double>(total), each.name());
        done += each.objects;
        results.push_back(measure(each, methods, effort.seed));
    }
    return cellSizeFindings(results);
}

Experiment cellSizeExperiment() {
    return {"P2",
            "Cell size",
            "What does a cell size cost that is too small or too large, and what does it miss?",
            4,
            100,
            [](const Effort& effort, const TellProgress& tell) {
                return measureCellSizes(cellCases(effort), cellMethods, effort, tell);
            }};
}

}  // namespace hashphase::demos
