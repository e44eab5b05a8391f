// SPDX-License-Identifier: Zlib

// Which cameras look at which scenes.

#include <tests/benchmarks/catalog.hpp>
#include <tests/benchmarks/culling_workload.hpp>

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/paper_scene.hpp>

#include <utility>

namespace hashphase::benchmarks {
namespace {

std::unique_ptr<demos::BoxScene> terrain(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<demos::PaperScene>(objects, seed);
}

std::unique_ptr<demos::BoxScene> space(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<demos::BrownianScene>(demos::uniformBoxes(objects, seed), seed);
}

using MakeScene = std::unique_ptr<demos::BoxScene> (*)(std::size_t objects, std::uint64_t seed);

Benchmark culling(std::string name, std::string description, MakeScene makeScene,
                  CullingPlan plan) {
    constexpr std::size_t kObjects = 50'000;
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "culling";
    benchmark.description = std::move(description);
    benchmark.sizes = {kObjects};
    benchmark.admits = [](const ContestantKind&, std::size_t) { return true; };
    benchmark.contestants = [](std::size_t, std::uint64_t) { return cullingKinds(); };
    benchmark.make = [makeScene, plan](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<CullingWorkload>(makeScene(objects, seed), plan);
    };
    return benchmark;
}

}  // namespace

std::vector<Benchmark> cullingBenchmarks() {
    const CullingPlan tenthOfTerrain{0, 15, 0.9, 0.37};
    CullingPlan again = tenthOfTerrain;
    again.isSecond = true;
    CullingPlan fourTenths = tenthOfTerrain;
    fourTenths.cameras = 4;
    const CullingPlan tenthOfSpace{0.02, 0, 0.9, 0.7};
    const CullingPlan fromFar{3, 0, 1.2, 10};
    return {
        culling("culling-tenth", "a camera among the paper's spheres that sees a tenth of them",
                terrain, tenthOfTerrain),
        culling("culling-again", "the same camera once more, with all that it reads in the cache",
                terrain, again),
        culling("culling-four", "four cameras in turn, each of which sees a tenth of them", terrain,
                fourTenths),
        culling("culling-all", "a camera far away that sees them all", terrain, fromFar),
        culling("culling-space-tenth", "a camera among uniform boxes that sees a tenth", space,
                tenthOfSpace),
        culling("culling-space-all", "a camera far away that sees all of these", space, fromFar)};
}

}  // namespace hashphase::benchmarks
