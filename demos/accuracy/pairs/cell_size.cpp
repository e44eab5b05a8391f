// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_experiments.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos {
namespace {

constexpr std::string_view kCellSizeDeclaration =
#include <demos/accuracy/pairs/pairs.sql>

#include <demos/accuracy/pairs/cell_size.sql>
    ;

std::vector<CellCase> cellCases(const Effort& effort) {
    const std::vector kAll{0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};
    const std::vector kFew{0.25, 1.0, 2.0, 4.0, 16.0, 64.0};
    const std::vector kLikely{0.5, 1.0, 2.0, 4.0, 8.0};  // where a frame takes long
    const std::vector kAroundTheBest{2.0, 4.0};
    const std::array populations{
        CellCase{"uniform", {SizeLaw::near}},
        CellCase{"clustered", {SizeLaw::near, 1, Placement::clusters}},
        CellCase{"sizes 1:1000", {SizeLaw::logUniform, 1000}},
    };
    std::vector<CellCase> cases;
    const auto add = [&cases](CellCase each, std::size_t objects, std::vector<double> factors) {
        each.objects = objects;
        each.factors = std::move(factors);
        cases.push_back(std::move(each));
    };
    for (const CellCase& population : populations) {
        add(population, 1'000, effort.isQuick ? kFew : kAll);
        add(population, effort.isQuick ? 3'000 : 10'000, effort.isQuick ? kFew : kAll);
        if (!effort.isQuick) {
            add(population, 100'000, kLikely);
        }
    }
    if (!effort.isQuick) {
        add(populations.front(), 1'000'000, kAroundTheBest);
        cases.back().judgedFrames = 1;
    }
    return cases;
}

void measure(const CellCase& each, std::size_t trial, const CellMethods& methodsOf,
             std::uint64_t seed, Measurements& measured) {
    const BrownianBoxes boxes = scatter(each.plan, each.objects, seed);
    const double edge = meanEdge(boxes);
    double largest = 0;
    for (const BrownianBoxes::Body& body : boxes.bodies) {
        largest = std::max(largest, 2 * static_cast<double>(body.halfEdges.maxCoeff()));
    }
    measured.add("trials", {{"trial", trial},
                            {"name", each.name()},
                            {"population", each.population},
                            {"objects", each.objects},
                            {"largest_edge", largest / edge}});
    BrownianScene scene(boxes, seed);
    std::vector<BulletBox> bulletBoxes;
    toBulletBoxes(scene.boxes(), bulletBoxes);
    tryPairs(trial, scene, methodsOf(each, bulletBoxes, edge), {each.judgedFrames, kFewestFrames},
             measured);
}

}  // namespace

std::string CellCase::name() const {
    return population + ", " + withThousands(objects);
}

std::vector<PairMethod> cellMethods(const CellCase& each, std::span<const BulletBox> boxes,
                                    double meanEdge) {
    // Beyond, each of the others would take longer than all of ours together.
    constexpr std::size_t kOthersUpTo = 20'000;
    // With more the paper's grid would hold little else, or compare everything with everything.
    constexpr double kMostCellsPerObject = 64;
    constexpr double kMostTestsPerObject = 300;
    const auto objects = static_cast<double>(each.objects);
    std::vector<PairMethod> methods{hashMethod("automatic levels")};
    for (const double factor : each.factors) {
        methods.push_back(hashMethod("levels", {.cellSize = factor * meanEdge}));
        methods.back().factor = factor;
    }
    if (each.objects > kOthersUpTo) {
        return methods;
    }
    for (const double factor : each.factors) {
        const double cellSize = factor * meanEdge;
        if (filedCellCount(boxes, cellSize) > kMostCellsPerObject * objects) {
            continue;
        }
        for (const FiledCells filed : {FiledCells::kAll, FiledCells::kCorners}) {
            methods.push_back(paperGridMethod(filed == FiledCells::kAll
                                                  ? "one grid, all cells (paper)"
                                                  : "one grid, corner cells (paper)",
                                              cellSize, filed));
            methods.back().factor = factor;
            methods.back().mostTestsTimed = kMostTestsPerObject * objects;
        }
    }
    methods.push_back(dbvtMethod(false));
    return methods;
}

Findings measureCellSizes(std::span<const CellCase> cases, const CellMethods& methods,
                          std::uint64_t seed, const TellProgress& tell) {
    std::size_t total = 0;
    for (const CellCase& each : cases) {
        total += each.objects;
    }
    Measurements measured;
    std::size_t done = 0;
    for (std::size_t trial = 0; trial < cases.size(); ++trial) {
        tell(static_cast<double>(done) / static_cast<double>(total), cases[trial].name());
        measure(cases[trial], trial, methods, seed, measured);
        done += cases[trial].objects;
    }
    return findingsOf(kCellSizeDeclaration, measured);
}

Experiment cellSizeExperiment() {
    return {"P2",
            "Cell size",
            "What do too small or too large cells cost, and what do they miss?",
            4,
            100,
            [](const Effort& effort, const TellProgress& tell) {
                return measureCellSizes(cellCases(effort), cellMethods, effort.seed, tell);
            }};
}

}  // namespace hashphase::demos
