// SPDX-License-Identifier: Zlib

// Which scenes have fast objects, and who finds what they pass.

#include <tests/benchmarks/catalog.hpp>
#include <tests/benchmarks/grid_contestant.hpp>
#include <tests/benchmarks/peers/peers.hpp>
#include <tests/benchmarks/sweep_workload.hpp>

#include <demos/scenes/brownian_scene.hpp>
#include <demos/scenes/paper_scene.hpp>

#include <utility>

namespace hashphase::benchmarks {
namespace {

// The same without what is passed: it shows what sweeping costs.
ContestantKind discrete(ContestantKind kind, std::string description) {
    kind.description = std::move(description);
    kind.ours = false;
    return kind;
}

std::vector<ContestantKind> sweepKinds() {
    std::vector<ContestantKind> kinds{
        discrete(gridKind("hash", {}), "the grid without Bullet; what is passed is missing"),
        discrete(sweepingGridKind("hash-unused", Sweep::none, serialFor),
                 "the same, and a Sweeps that nobody uses"),
        sweepingGridKind("sweep-box", Sweep::box, serialFor),
        sweepingGridKind("sweep-line", Sweep::line, serialFor),
        sweepingGridKind("sweep-automatic", Sweep::automatic, serialFor)};
    if (const std::optional<ParallelFor> threaded = threadedLoop()) {
        kinds.push_back(discrete(sweepingGridKind("hash-unused-threads", Sweep::none, *threaded),
                                 "hash-unused, tbbFor"));
        kinds.back().onThreads = true;
        kinds.push_back(sweepingGridKind("sweep-line-threads", Sweep::line, *threaded));
        kinds.back().onThreads = true;
    }
    ContestantKind dbvt = contestantKind(kBaseline);
    dbvt.description = "Bullet's trees, given the box around start and end";
    kinds.push_back(std::move(dbvt));
    return kinds;
}

std::unique_ptr<demos::BoxScene> space(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<demos::BrownianScene>(demos::uniformBoxes(objects, seed), seed);
}

std::unique_ptr<demos::BoxScene> terrain(std::size_t objects, std::uint64_t seed) {
    return std::make_unique<demos::PaperScene>(objects, seed);
}

using MakeScene = std::unique_ptr<demos::BoxScene> (*)(std::size_t objects, std::uint64_t seed);

Benchmark sweeps(std::string name, std::string description, MakeScene makeScene, float cells) {
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = "sweeps";
    benchmark.description = std::move(description);
    benchmark.sizes = {30'000};
    // The exact answers take quadratic time.
    benchmark.largest = 100'000;
    benchmark.admits = [](const ContestantKind&, std::size_t) { return true; };
    benchmark.contestants = [](std::size_t, std::uint64_t) { return sweepKinds(); };
    benchmark.make = [makeScene, cells](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<SweepWorkload>(makeScene(objects, seed), cells, ~seed);
    };
    return benchmark;
}

}  // namespace

std::vector<Benchmark> sweepBenchmarks() {
    std::vector<Benchmark> all;
    all.push_back(
        sweeps("sweeps-10", "every 30th of uniform boxes sweeps, by 10 cells a frame", space, 10));
    all.push_back(sweeps("sweeps-10-paper",
                         "every 30th of the paper's spheres sweeps, by 10 cells a frame", terrain,
                         10));
    all.push_back(sweeps("sweeps-100", "every 30th of uniform boxes sweeps, by 100 cells a frame",
                         space, 100));
    all.push_back(sweeps("sweeps-100-paper",
                         "every 30th of the paper's spheres sweeps, by 100 cells a frame", terrain,
                         100));
    // Bullet takes seconds a frame for these.
    for (std::size_t i = 2; i < all.size(); ++i) {
        all[i].onRequest = true;
    }
    return all;
}

}  // namespace hashphase::benchmarks
