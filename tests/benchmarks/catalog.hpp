// SPDX-License-Identifier: Zlib
#pragma once

// Everything that can be measured, by name.

#include <tests/benchmarks/workload.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::benchmarks {

/// A scene and what is asked of it, at any size.
struct Benchmark {
    std::string name;  // without blanks; "/" and the size are appended for a case
    std::string group;
    std::string description;
    std::string operation = "object";  // what ns are counted per

    std::vector<std::size_t> sizes;  // objects
    bool takesOtherSizes = true;     // --sizes replaces them
    std::size_t largest = 1'000'000;

    /// Measured, unless asked otherwise; 0: as many as of others of that size.
    int frames = 0;

    /// Only measured when it is asked for by name.
    bool onRequest = false;

    /// Contestants slower than the fastest by this factor drop out while warming up; 0 for none.
    double dropFactor = 0;

    std::function<bool(const ContestantKind&, std::size_t objects)> admits;

    /// In place of the chosen contestants, where not empty.
    std::function<std::vector<ContestantKind>(std::size_t objects, std::uint64_t seed)> contestants;

    std::function<std::unique_ptr<Workload>(std::size_t objects, std::uint64_t seed)> make;
};

/// All of them, in the order in which they are run. The seed decides what the random ones are.
[[nodiscard]] std::vector<Benchmark> catalog(std::uint64_t seed);

// The parts of the catalog.
[[nodiscard]] std::vector<Benchmark> pairBenchmarks();
[[nodiscard]] std::vector<Benchmark> randomBenchmarks(std::uint64_t seed);
[[nodiscard]] std::vector<Benchmark> populationBenchmarks();
[[nodiscard]] std::vector<Benchmark> queryBenchmarks();
[[nodiscard]] std::vector<Benchmark> crowdBenchmarks();
[[nodiscard]] std::vector<Benchmark> cullingBenchmarks();
[[nodiscard]] std::vector<Benchmark> sweepBenchmarks();
[[nodiscard]] std::vector<Benchmark> terrainBenchmarks();
[[nodiscard]] std::vector<Benchmark> cellSizeBenchmarks();
[[nodiscard]] std::vector<Benchmark> farBenchmarks();
[[nodiscard]] std::vector<Benchmark> effectsBenchmarks();

/// True for contestants that are not too slow for so many objects.
[[nodiscard]] bool isFastEnough(const ContestantKind& kind, std::size_t objects);

/// True for those of them whose frames differ from those of others.
[[nodiscard]] bool takesPartInFrames(const ContestantKind& kind, std::size_t objects);

}  // namespace hashphase::benchmarks
