// SPDX-License-Identifier: Zlib

// Which scenes are declared, and written by hand.

#include <tests/benchmarks/catalog.hpp>
#include <tests/benchmarks/effects_workload.hpp>

#include <utility>

namespace hashphase::benchmarks {
namespace {

// A median of the ratios of so many frames is known to some thousandths.
constexpr int kFrames = 1000;

Benchmark effectsBenchmark(std::string name, std::string description, EffectSet own) {
    constexpr std::size_t kObjects = 30'000;
    Benchmark benchmark;
    benchmark.name = std::move(name);
    benchmark.group = std::string(kEffectsGroup);
    benchmark.description = std::move(description);
    benchmark.sizes = {kObjects};
    benchmark.frames = kFrames;
    benchmark.onRequest = true;
    benchmark.admits = [](const ContestantKind&, std::size_t) { return true; };
    benchmark.contestants = [](std::size_t, std::uint64_t) { return effectsKinds(); };
    benchmark.make = [own](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<EffectsWorkload>(own, objects, seed);
    };
    return benchmark;
}

}  // namespace

std::vector<Benchmark> effectsBenchmarks() {
    return {effectsBenchmark("effects-pairs", "roaming spheres, and whose boxes overlap",
                             {Effect::motion, Effect::pairs}),
            effectsBenchmark("effects-response", "roaming spheres that bounce off each other",
                             {Effect::motion, Effect::pairs, Effect::response}),
            effectsBenchmark("effects-culling", "roaming spheres, of which a camera sees a tenth",
                             {Effect::motion, Effect::culling}),
            effectsBenchmark("effects-proximity", "roaming agents that take the rarest colour",
                             {Effect::motion, Effect::proximity})};
}

}  // namespace hashphase::benchmarks
