// SPDX-License-Identifier: Zlib

// What the automatic cell sizes cost against the best fixed one: the same frames for a grid that
// chooses for itself and for grids with cells of 0.25 to 64 times the mean edge.

#include <demos/console/format.hpp>
#include <demos/scenes/scatter.hpp>
#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/pair_workload.hpp>

#include <array>
#include <string>

namespace hashphase::benchmarks {
namespace {

struct Distribution {
    const char* name;
    demos::SizeLaw sizes;
    float sizeRatio;
    demos::Placement placement;
};

constexpr std::array kDistributions{
    Distribution{"uniform", demos::SizeLaw::near, 1, demos::Placement::cube},
    Distribution{"clustered", demos::SizeLaw::near, 1, demos::Placement::clusters},
    Distribution{"sizes-1000", demos::SizeLaw::logUniform, 1000, demos::Placement::cube},
};
constexpr std::array kOverlapsPerBox{0.2F, 2.0F, 10.0F};
constexpr std::array kCellFactors{0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

// A size that takes so much longer cannot be the best.
constexpr double kHopeless = 5;

std::string factorText(double factor) {
    return demos::fixed(factor, factor < 0.5 ? 2 : factor < 1 ? 1 : 0);
}

std::vector<ContestantKind> gridsFor(const demos::BrownianBoxes& boxes) {
    std::vector<ContestantKind> kinds{gridKind("cells-auto", {})};
    for (const double factor : kCellFactors) {
        GridConfig config;
        config.cellSize = factor * meanEdge(boxes);
        kinds.push_back(gridKind("cells-" + factorText(factor), config));
    }
    return kinds;
}

Benchmark cellSizeBenchmark(const Distribution& distribution, float overlapsPerBox) {
    demos::ScatterPlan plan;
    plan.sizes = distribution.sizes;
    plan.sizeRatio = distribution.sizeRatio;
    plan.placement = distribution.placement;
    plan.overlapsPerBox = overlapsPerBox;
    const auto density = static_cast<double>(overlapsPerBox);
    return {.name = "cellsize-" + std::string(distribution.name) + "-" +
                    demos::fixed(density, density < 1 ? 1 : 0),
            .group = "cell size",
            .description = describe(plan),
            .sizes = {1'000, 10'000, 100'000},
            .onRequest = true,
            .dropFactor = kHopeless,
            .contestants =
                [plan](std::size_t objects, std::uint64_t seed) {
                    return gridsFor(scatter(plan, objects, seed));
                },
            .make = makePairWorkload(brownian([plan](std::size_t objects, std::uint64_t seed) {
                return scatter(plan, objects, seed);
            }))};
}

}  // namespace

std::vector<Benchmark> cellSizeBenchmarks() {
    std::vector<Benchmark> all;
    for (const Distribution& distribution : kDistributions) {
        for (const float overlapsPerBox : kOverlapsPerBox) {
            all.push_back(cellSizeBenchmark(distribution, overlapsPerBox));
        }
    }
    return all;
}

}  // namespace hashphase::benchmarks
