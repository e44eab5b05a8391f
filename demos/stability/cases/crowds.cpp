// SPDX-License-Identifier: Zlib
//
// Many at one place.

#include <demos/stability/cases/cases.hpp>

#include <broadphase/radius_search.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <stdexcept>

namespace hashphase::demos {
namespace {

// What sorting along an axis and testing what overlaps there tests.
template <class Scalar>
double testsAlongAnAxis(const Boxes<Scalar>& boxes) {
    const LimitPause pause;
    std::vector<Scalar> starts;
    for (const Aabb<Scalar>& box : boxes) {
        starts.push_back(box.min().x());
    }
    std::sort(starts.begin(), starts.end());
    double tests = 0;
    for (const Aabb<Scalar>& box : boxes) {
        const auto first = std::upper_bound(starts.begin(), starts.end(), box.min().x());
        tests += static_cast<double>(std::upper_bound(first, starts.end(), box.max().x()) - first);
    }
    return tests;
}

template <class Scalar>
Boxes<Scalar> crowd(std::size_t count, Scalar side, std::uint64_t seed) {
    Random random(seed);
    Boxes<Scalar> boxes;
    while (boxes.size() < count) {
        const Vector3<Scalar> center = pointIn<Scalar>(random, 1, side - 1);
        const Vector3<Scalar> half = pointIn<Scalar>(random, Scalar(0.1), Scalar(0.5));
        boxes.emplace_back(center - half, center + half);
    }
    return boxes;
}

/// As many boxes elsewhere, each in a cell of 1e4 m of its own, so that the crowd at the origin is not
/// in the middle of all, where cells begin.
template <class Scalar>
void addAnchors(Boxes<Scalar>& boxes) {
    const auto count = static_cast<int>(boxes.size() + 1);
    for (int i = 0; i < count; ++i) {
        const Vector3<Scalar> at =
            Vector3<int>(i % 50, i / 50 % 50, i / 2500).cast<Scalar>() * Scalar(2e4);
        boxes.push_back(cubeAt<Scalar>(at.array() + Scalar(25e3), 1));
    }
}

/// However much too large the cells are, a crowd costs what sweeping along an axis does, and is told; in
/// cells of its size it costs little.
template <class Scalar>
void judgeMuchTooLargeCells(CaseRun<Scalar>& run) {
    constexpr std::size_t kCount = 102'000;
    Boxes<Scalar> boxes = crowd<Scalar>(kCount, 400, run.seed);
    const double alongAnAxis = testsAlongAnAxis(boxes);
    PairScene<Scalar> fitting(run, boxes);
    fitting.judge();
    run.expect(fitting.cost().boxesTested < 10 * kCount && fitting.cost().grid.largestCell < 50,
               "cells of a fitting size hold few boxes");
    addAnchors(boxes);
    PairScene<Scalar> inOneCell(run, boxes, {.cellSize = 1e4});
    inOneCell.judge();
    run.expect(static_cast<double>(inOneCell.cost().boxesTested) <= 1.5 * alongAnAxis,
               "a crowd costs at most 1.5 times a sweep along one axis");
    run.expect(inOneCell.cost().grid.largestCell >= 100'000,
               "the cost includes the size of the crowded cell");
}

/// A long box is tested with everyone, and makes nobody else slower. Three crowds are each flat along
/// another axis: no axis is good for all.
template <class Scalar>
void judgeUnevenCrowds(CaseRun<Scalar>& run) {
    constexpr std::uint32_t kCount = 9'000;
    Boxes<Scalar> boxes = crowd<Scalar>(kCount, 100, run.seed);
    PairScene<Scalar> even(run, boxes, {.cellSize = 1e4});
    even.judge();
    for (int i = 0; i < 3; ++i) {
        boxes.push_back(cubeAt<Scalar>(Vector3<Scalar>::Constant(20 * Scalar(i) + 27.5F), 55));
    }
    PairScene<Scalar> withLong(run, boxes, {.cellSize = 1e4});
    withLong.judge();
    run.expect(withLong.cost().boxesTested <= even.cost().boxesTested + 4 * kCount,
               "long boxes add only tests of their own");

    Random random(run.seed);
    Boxes<Scalar> flat;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const int axis = static_cast<int>(i % 3);
        Vector3<Scalar> center = pointIn<Scalar>(random, 1, 99);
        center[axis] = 50;
        center[0] += static_cast<Scalar>(axis * 1000);
        flat.push_back(cubeAt(center, Scalar(0.4)));
    }
    PairScene<Scalar> inPlanes(run, flat, {.cellSize = 1000});
    inPlanes.judge();
    run.expect(inPlanes.cost().boxesTested < 200 * kCount,
               "each crowd is sorted along an axis that suits it");
}

/// Queries want a few of a crowd, of whom some have left, or moved, since they were sorted.
template <class Scalar>
void judgeQueriesInACrowd(CaseRun<Scalar>& run) {
    constexpr std::uint32_t kCount = 8'000;
    Boxes<Scalar> boxes = crowd<Scalar>(kCount, 100, run.seed);
    for (int i = 0; i < 3; ++i) {
        boxes.push_back(makeBox<Scalar>(30 * i, 1, 1, 30 * i + 35, 9, 9));
    }
    addAnchors(boxes);
    PairScene<Scalar> scene(run, boxes, {.cellSize = 1e4});
    scene.judge();
    run.expect(scene.cost().grid.largestCell > kCount - 100, "the crowd is in one cell");
    for (std::uint32_t i = 0; i < kCount; i += 50) {
        scene.move(i, boxes[i + 1]);
        scene.destroy(i + 25);
    }
    Random random(run.seed);
    constexpr std::uint64_t kQueries = 60;
    QueryCost cost;
    for (std::uint64_t i = 0; i < kQueries; ++i) {
        cost += scene.judgeQuery(SphereRegion<Scalar>{pointIn<Scalar>(random, 0, 100), 3});
    }
    run.expect(cost.hits > kQueries && cost.boxesTested < kQueries * kCount / 8,
               "a query tests a small part of a crowd");
}

constexpr auto oneCell = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    const std::size_t count = run.template quickOrFull<std::size_t>(20'000, 200'000);
    const Boxes<Scalar> boxes = scatteredCubes<Scalar>(count, 0.98F, 0.008F, 0.008F, run.seed);
    PairScene<Scalar> scene(run, boxes, {.cellSize = 1});
    scene.judge();
    if (scene.grid() == nullptr) {
        return;
    }
    run.addCost(static_cast<double>(scene.cost().boxesTested) / testsAlongAnAxis(boxes), 1.25);
    run.note("Cost: boxes tested, divided by the boxes that a sweep along x tests.");
    run.expect(scene.cost().grid.largestCell >= count / 2,
               "the cost includes the size of the crowded cell");
    judgeMuchTooLargeCells(run);
    judgeUnevenCrowds(run);
    judgeQueriesInACrowd(run);
};

// --- At one place ---------------------------------------------------------------------------------

// Bytes that ours holds for each pair of so many identical boxes; no more when they have been apart in
// between.
template <class Scalar>
double bytesPerPair(CaseRun<Scalar>& run, std::size_t count) {
    const Boxes<Scalar> together(count, cubeAt<Scalar>({1, 2, 3}, 1));
    PairScene<Scalar> scene(run, together);
    scene.judge();
    scene.judge();
    const std::size_t bytes = scene.subject().memoryBytes();
    const double pairs = static_cast<double>(scene.reported().size());
    if (scene.grid() == nullptr) {
        return 1;
    }
    Boxes<Scalar> apart;
    for (std::size_t i = 0; i < count; ++i) {
        apart.push_back(cubeAt<Scalar>({9 * static_cast<Scalar>(i), 0, 0}, 1));
    }
    std::array<std::size_t, 3> bytesThen{};
    for (std::size_t i = 0; i < bytesThen.size(); ++i) {
        scene.moveAll(i % 2 == 0 ? apart : together);
        scene.judge();
        bytesThen[i] = scene.subject().memoryBytes();
    }
    run.expect(bytesThen[2] <= bytesThen[0],
               "memory does not grow when the boxes meet and part again");
    run.expect(static_cast<double>(bytes) < 200 * pairs, "a pair takes less than 200 bytes");
    return static_cast<double>(bytes) / pairs;
}

constexpr auto allTheSame = [](auto& run) {
    const std::size_t count = run.template quickOrFull<std::size_t>(600, 2000);
    const double many = bytesPerPair(run, count);
    if (run.isOurs) {
        run.addCost(many / bytesPerPair(run, count / 2), 2);
        run.note("Cost: bytes per pair (" + rounded(many, 0) +
                 "), divided by the bytes per pair of half as many boxes.");
    }
};

// --- Counts beyond 32 bits ------------------------------------------------------------------------

// Everybody is everybody's neighbour. What counts is the same code in both precisions, and takes seconds.
template <class Scalar>
void judgeCounts(CaseRun<Scalar>& run) {
    const std::uint32_t count = run.quickOrFull(66'000U, 70'000U);
    Grid<Scalar> grid;
    Random random(run.seed);
    for (std::uint32_t i = 0; i < count; ++i) {
        static_cast<void>(grid.add(cubeAt(pointIn<Scalar>(random, 0, 1), Scalar(0.1F))));
    }
    RadiusSearch<Scalar> search;
    search.take(grid, 10);
    std::vector<std::uint32_t> counts(search.size());
    const QueryCost cost = search.count(counts);
    const std::uint64_t exact = std::uint64_t{count} * (count - 1);
    std::uint64_t sum = 0;
    for (const std::uint32_t each : counts) {
        sum += each;
    }
    run.expect(sum == exact && cost.hits == exact, "all neighbours are counted");
}

template <class Scalar>
void expectMostIsRefused(CaseRun<Scalar>& run) {
    Grid<Scalar> grid;
    const ProxyId id = grid.add(cubeAt<Scalar>({0, 0, 0}, 1));
    constexpr std::size_t kMost = std::size_t{1} << 28;
    // 0 where counts have 32 bits.
    constexpr auto kOnePast32Bits = static_cast<std::size_t>(std::uint64_t{1} << 32);
    for (const std::size_t count :
         {kMost + 1, std::max(kMost + 1, kOnePast32Bits), ~std::size_t{0}}) {
        std::string refusal;
        try {
            grid.reserve(count);
        } catch (const std::length_error& refused) {
            refusal = refused.what();
        }
        run.expect(
            refusal ==
                "A grid holds at most 268,435,456 proxies. Remove some, or use another grid.",
            "reserve() refuses too many proxies, with the expected message");
    }
    run.expect(grid.size() == 1 && grid.contains(id) && grid.validate().empty(),
               "a refused reserve() leaves the grid unchanged");
}

constexpr auto beyond32Bits = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    if (MemoryLimit::isPossible()) {
        constexpr std::size_t kCount = 8000;  // 32 million pairs
        const Boxes<Scalar> together(kCount, cubeAt<Scalar>({0, 0, 0}, 1));
        Boxes<Scalar> apart;
        for (std::size_t i = 0; i < kCount; ++i) {
            apart.push_back(cubeAt<Scalar>({Scalar(0.75F) * static_cast<Scalar>(i), 0, 0}, 1));
        }
        PairScene<Scalar> scene(run, apart);
        scene.judge();
        bool isTold = false;
        {
            const MemoryLimit limit(64 << 20);
            try {
                scene.moveAll(together);
                scene.findPairs();
            } catch (const std::bad_alloc&) {
                isTold = true;
            }
        }
        run.expect(isTold, "std::bad_alloc is thrown when memory runs out");
        // Apart again, all goes on.
        scene.moveAll(apart);
        scene.judge();
    } else {
        run.note("Memory cannot be limited here, for example under a sanitizer.");
    }
    if (run.isOurs) {
        if constexpr (std::is_same_v<Scalar, float>) {
            judgeCounts(run);
        }
        expectMostIsRefused(run);
    }
};

constexpr HardCase kCrowdCases[] = {
    {"H25", "100,000 boxes in one cell",
     "200,000 cubes of 8 mm (--quick: 20,000) in one cubic metre, half of them in one cell",
     "exact pairs; at most 1.25 times the box tests of a sweep along one axis; the reported cost "
     "includes the size of the largest cell",
     oneCell},
    {"H26", "2,000 boxes at one place", "2,000 identical cubes of 1 m (--quick: 600)",
     "1,999,000 pairs, each once; memory proportional to the number of pairs", allTheSame},
    {"H45", "out of memory; counts over 32 bits",
     "8,000 boxes in a row, each touching the next; with 64 MiB of memory left, all move to one "
     "place, where they form 32 million pairs, and then back; for hashphase also a count of 4.9e9 "
     "neighbours (--quick: 4.4e9)",
     "an exception that the caller can catch, and exact pairs afterwards; counts that do not "
     "overflow",
     beyond32Bits},
};

}  // namespace

std::span<const HardCase> crowdCases() {
    return kCrowdCases;
}

}  // namespace hashphase::demos
