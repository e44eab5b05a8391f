// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/pair_workload.hpp>

#include <demos/scenes/random.hpp>
#include <demos/scenes/scatter.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace hashphase::benchmarks {
namespace {

using Sizes = std::vector<std::size_t>;

const demos::BoxSceneKind& sceneKind(std::string_view name) {
    const auto kinds = demos::boxSceneKinds();
    return *std::find_if(kinds.begin(), kinds.end(),
                         [name](const demos::BoxSceneKind& kind) { return kind.name == name; });
}

Benchmark pairsOf(const char* name, std::string_view scene,
                  Sizes sizes = {1'000, 3'000, 10'000, 30'000, 100'000}) {
    return {.name = name,
            .group = "pairs",
            .description = std::string(sceneKind(scene).description),
            .sizes = std::move(sizes),
            .admits = takesPartInFrames,
            .make = makePairWorkload(sceneNamed(scene))};
}

// A world in which nothing moves, and what is handed in nevertheless.
Benchmark stillBenchmark(const char* name, const char* description, Setting setting) {
    return {.name = name,
            .group = "pairs",
            .description = description,
            .sizes = {1'000, 3'000, 100'000},
            .admits = takesPartInFrames,
            .make = makePairWorkload(brownian([](std::size_t objects, std::uint64_t seed) {
                                         demos::ScatterPlan plan;
                                         plan.movingShare = 0;
                                         demos::BrownianBoxes boxes = scatter(plan, objects, seed);
                                         boxes.filters.resize(objects);
                                         for (std::size_t i = 0; i < objects; i += 2) {
                                             boxes.filters[i] = demos::kStaticFilter;
                                         }
                                         return boxes;
                                     }),
                                     setting)};
}

Benchmark scatterBenchmark(std::string name, const char* group, const demos::ScatterPlan& plan,
                           std::size_t objects) {
    return {.name = std::move(name),
            .group = group,
            .description = describe(plan),
            .sizes = {objects},
            .takesOtherSizes = false,
            .admits = takesPartInFrames,
            .make = makePairWorkload(brownian([plan](std::size_t count, std::uint64_t seed) {
                return scatter(plan, count, seed);
            }))};
}

// One size, and sizes from a micrometre to a thousand kilometres, so to speak, as dense.
Benchmark sizesBenchmark(const char* name, demos::SizeLaw sizes, float ratio) {
    demos::ScatterPlan plan;
    plan.overlapsPerBox = 1;
    plan.sizes = sizes;
    plan.sizeRatio = ratio;
    Benchmark benchmark = scatterBenchmark(name, "pairs", plan, 20'000);
    benchmark.onRequest = true;
    return benchmark;
}

std::vector<Benchmark> randomBenchmarks(std::uint64_t seed) {
    constexpr std::size_t kRandomScenes = 8;
    std::vector<Benchmark> all;
    for (std::size_t i = 1; i <= kRandomScenes; ++i) {
        const demos::RandomScene drawn = demos::drawScene(seed * kRandomScenes + i);
        all.push_back(
            scatterBenchmark("random-" + std::to_string(i), "random", drawn.plan, drawn.objects));
    }
    return all;
}

}  // namespace

MakeScene brownian(std::function<demos::BrownianBoxes(std::size_t, std::uint64_t)> scatter) {
    return [scatter = std::move(scatter)](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<demos::BrownianScene>(scatter(objects, seed), seed);
    };
}

MakeScene cubesIn(const Vector3<float>& room, float halfEdge, float step) {
    return brownian([=](std::size_t objects, std::uint64_t seed) {
        demos::Random random(seed);
        demos::BrownianBoxes boxes;
        for (std::size_t i = 0; i < objects; ++i) {
            const Vector3<float> share(random.unit(), random.unit(), random.unit());
            boxes.bodies.push_back({share.cwiseProduct(room), Vector3<float>::Constant(halfEdge),
                                    step, Aabb<float>(Vector3<float>::Zero(), room)});
        }
        return boxes;
    });
}

MakeScene sceneNamed(std::string_view name) {
    return sceneKind(name).make;
}

bool isFastEnough(const ContestantKind& kind, std::size_t objects) {
    return objects <= kind.upTo;
}

bool takesPartInFrames(const ContestantKind& kind, std::size_t objects) {
    return isFastEnough(kind, objects) && !kind.inBatches && !kind.onThreads;
}

std::vector<Benchmark> pairBenchmarks() {
    Benchmark paper = pairsOf("S1-paper", "paper");
    // At a million every sphere would overlap a hundred others.
    paper.largest = 300'000;
    Benchmark terdiman = pairsOf("terdiman", "terdiman", {1'000, 3'000, 10'000, 100'000});
    // In its fixed cube, pairs grow with the square of the boxes.
    terdiman.takesOtherSizes = false;
    Benchmark tiny = pairsOf("tiny", "uniform", {10, 32, 100, 300, 1000});
    tiny.takesOtherSizes = false;
    Benchmark threads = pairsOf("threads", "uniform", {30'000, 100'000});
    threads.description = "S2-uniform, with hashphase on one thread and on all";
    threads.admits = [](const ContestantKind& kind, std::size_t /*objects*/) {
        return kind.name == kBaseline || kind.name == "hash" || kind.onThreads;
    };
    threads.onRequest = true;
    Benchmark trillion = sizesBenchmark("sizes-trillion", demos::SizeLaw::logUniform, 0x1p40F);
    trillion.admits = [](const ContestantKind& kind, std::size_t objects) {
        // ODE's hash space ends the program where its cells have too large numbers.
        return takesPartInFrames(kind, objects) && !kind.name.starts_with("ode-");
    };
    return {std::move(paper),
            pairsOf("S2-uniform", "uniform"),
            pairsOf("S3-logsizes", "logsizes"),
            pairsOf("S4-moving-5", "moving-5"),
            pairsOf("S4-moving-2", "moving-2"),
            pairsOf("S5-static-90", "static-90"),
            pairsOf("S6-piles", "piles"),
            std::move(terdiman),
            pairsOf("brownian", "brownian"),
            std::move(tiny),
            stillBenchmark("quiet", "uniform boxes, all set again in each frame, unchanged",
                           Setting::everything),
            stillBenchmark("sleeping", "uniform boxes, half static, half asleep: none is set",
                           Setting::nothing),
            std::move(threads),
            sizesBenchmark("sizes-one", demos::SizeLaw::equal, demos::ScatterPlan().sizeRatio),
            std::move(trillion)};
}

std::vector<Benchmark> catalog(std::uint64_t seed) {
    std::vector<Benchmark> all;
    for (std::vector<Benchmark>& part : std::array{
             pairBenchmarks(), randomBenchmarks(seed), populationBenchmarks(), rayBenchmarks(),
             neighbourBenchmarks(), crowdBenchmarks(), cullingBenchmarks(), sweepBenchmarks(),
             terrainBenchmarks(), cellSizeBenchmarks(), farBenchmarks(), effectsBenchmarks()}) {
        std::move(part.begin(), part.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace hashphase::benchmarks
