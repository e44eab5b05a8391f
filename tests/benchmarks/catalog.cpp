// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/catalog.hpp>

#include <demos/scenes/scatter.hpp>
#include <tests/benchmarks/pair_workload.hpp>
#include <tests/benchmarks/population_workload.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace hashphase::benchmarks {
namespace {

constexpr std::size_t kRandomScenes = 8;
constexpr std::size_t kRemovals = 1000;

const demos::BoxSceneKind& sceneKind(std::string_view name) {
    const auto kinds = demos::boxSceneKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const demos::BoxSceneKind& kind) { return kind.name == name; });
}

Benchmark pairsOf(std::string name, std::string_view scene, std::vector<std::size_t> sizes) {
    const demos::BoxSceneKind& kind = sceneKind(scene);
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "pairs";
    benchmark.description = kind.description;
    benchmark.sizes = std::move(sizes);
    benchmark.admits = takesPartInFrames;
    benchmark.make = [&kind](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<PairWorkload>(kind.make(objects, seed));
    };
    return benchmark;
}

// A world in which nothing moves, and what is handed in nevertheless.
Benchmark stillBenchmark(std::string name, std::string description, Setting setting) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "pairs";
    benchmark.description = std::move(description);
    benchmark.sizes = {1'000, 3'000, 100'000};
    benchmark.admits = takesPartInFrames;
    benchmark.make = [setting](std::size_t objects, std::uint64_t seed) {
        demos::ScatterPlan plan;
        plan.movingShare = 0;
        demos::BrownianBoxes boxes = scatter(plan, objects, seed);
        boxes.filters.resize(objects);
        for (std::size_t i = 0; i < objects; i += 2) {
            boxes.filters[i] = demos::kStaticFilter;
        }
        return std::make_unique<PairWorkload>(
            std::make_unique<demos::BrownianScene>(std::move(boxes), seed), setting);
    };
    return benchmark;
}

Benchmark removalBenchmark(std::string name, std::string description, RemovalTiming timing) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "population";
    benchmark.description = std::move(description);
    benchmark.operation = "removal";
    benchmark.sizes = {50'000};
    benchmark.admits = [timing](const ContestantKind& kind, std::size_t objects) {
        // The grid alone notes a removal and deals with it when it is asked for pairs.
        const bool complete = kind.bullet != nullptr || timing == RemovalTiming::removalsAndPairs;
        return isFastEnough(kind, objects) && objects <= kind.fillsUpTo && complete &&
               kind.changes && !kind.onThreads;
    };
    benchmark.make = [timing](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<RemovalWorkload>(sceneKind("uniform").make(objects, seed),
                                                 kRemovals, timing, seed);
    };
    return benchmark;
}

Benchmark scatterBenchmark(std::string name, std::string group, const demos::ScatterPlan& plan,
                           std::size_t objects) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = std::move(group);
    benchmark.description = describe(plan);
    benchmark.sizes = {objects};
    benchmark.takesOtherSizes = false;
    benchmark.admits = takesPartInFrames;
    benchmark.make = [plan](std::size_t count, std::uint64_t seed) {
        return std::make_unique<PairWorkload>(
            std::make_unique<demos::BrownianScene>(scatter(plan, count, seed), seed));
    };
    return benchmark;
}

}  // namespace

bool isFastEnough(const ContestantKind& kind, std::size_t objects) {
    return objects <= kind.upTo;
}

bool takesPartInFrames(const ContestantKind& kind, std::size_t objects) {
    return isFastEnough(kind, objects) && !kind.inBatches && !kind.onThreads;
}

std::vector<Benchmark> pairBenchmarks() {
    const std::vector<std::size_t> sizes{1'000, 3'000, 10'000, 30'000, 100'000};
    std::vector<Benchmark> all;
    all.push_back(pairsOf("S1-paper", "paper", sizes));
    // At a million every sphere would overlap a hundred others.
    all.back().largest = 300'000;
    all.push_back(pairsOf("S2-uniform", "uniform", sizes));
    all.push_back(pairsOf("S3-logsizes", "logsizes", sizes));
    all.push_back(pairsOf("S4-moving-5", "moving-5", sizes));
    all.push_back(pairsOf("S4-moving-2", "moving-2", sizes));
    all.push_back(pairsOf("S5-static-90", "static-90", sizes));
    all.push_back(pairsOf("S6-piles", "piles", sizes));
    all.push_back(pairsOf("terdiman", "terdiman", {1'000, 3'000, 10'000, 100'000}));
    // In its fixed cube, pairs grow with the square of the boxes.
    all.back().takesOtherSizes = false;
    all.push_back(pairsOf("brownian", "brownian", sizes));
    all.push_back(pairsOf("tiny", "uniform", {10, 32, 100, 300, 1000}));
    all.back().takesOtherSizes = false;
    all.push_back(stillBenchmark("quiet", "uniform boxes, all set again in each frame, unchanged",
                                 Setting::everything));
    all.push_back(stillBenchmark("sleeping", "uniform boxes, half static, half asleep: none is set",
                                 Setting::nothing));
    Benchmark threads = pairsOf("threads", "uniform", {30'000, 100'000});
    threads.description = "S2-uniform, with hashphase on one thread and on all";
    threads.admits = [](const ContestantKind& kind, std::size_t /*objects*/) {
        return kind.name == kBaseline || kind.name == "hash" || kind.onThreads;
    };
    threads.onRequest = true;
    all.push_back(std::move(threads));
    // One size, and sizes from a micrometre to a thousand kilometres, so to speak, as dense.
    demos::ScatterPlan plan;
    plan.overlapsPerBox = 1;
    plan.sizes = demos::SizeLaw::equal;
    all.push_back(scatterBenchmark("sizes-one", "pairs", plan, 20'000));
    all.back().onRequest = true;
    plan.sizes = demos::SizeLaw::logUniform;
    plan.sizeRatio = 0x1p40F;
    all.push_back(scatterBenchmark("sizes-trillion", "pairs", plan, 20'000));
    all.back().onRequest = true;
    all.back().admits = [](const ContestantKind& kind, std::size_t objects) {
        // ODE's hash space ends the program where its cells have too large numbers.
        return takesPartInFrames(kind, objects) && !kind.name.starts_with("ode-");
    };
    return all;
}

std::vector<Benchmark> randomBenchmarks(std::uint64_t seed) {
    std::vector<Benchmark> all;
    for (std::size_t i = 1; i <= kRandomScenes; ++i) {
        const demos::RandomScene drawn = demos::drawScene(seed * kRandomScenes + i);
        all.push_back(
            scatterBenchmark("random-" + std::to_string(i), "random", drawn.plan, drawn.objects));
    }
    return all;
}

std::vector<Benchmark> populationBenchmarks() {
    std::vector<Benchmark> all;
    all.push_back(removalBenchmark("removal", "1,000 of uniform boxes are destroyed",
                                   RemovalTiming::removals));
    all.push_back(removalBenchmark("removal-and-pairs", "the same, until the pairs are complete",
                                   RemovalTiming::removalsAndPairs));
    Benchmark creation;
    creation.name = "creation";
    creation.group = "population";
    creation.description = "uniform boxes are created, until the pairs are complete";
    creation.sizes = {1'000, 3'000, 10'000};
    creation.admits = [](const ContestantKind& kind, std::size_t objects) {
        return isFastEnough(kind, objects) && objects <= kind.fillsUpTo && !kind.onThreads;
    };
    creation.make = [](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<CreationWorkload>(sceneKind("uniform").make(objects, seed));
    };
    all.push_back(std::move(creation));
    return all;
}

std::vector<Benchmark> catalog(std::uint64_t seed) {
    std::vector<Benchmark> all;
    for (std::vector<Benchmark>& part : std::array{
             pairBenchmarks(), randomBenchmarks(seed), populationBenchmarks(), queryBenchmarks(),
             crowdBenchmarks(), cullingBenchmarks(), sweepBenchmarks(), terrainBenchmarks(),
             cellSizeBenchmarks(), farBenchmarks(), effectsBenchmarks()}) {
        std::move(part.begin(), part.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace hashphase::benchmarks
