// SPDX-License-Identifier: Zlib
//
// Sizes that differ by twelve orders of magnitude, and cells that were chosen to collide.

#include <demos/stability/cases/cases.hpp>
#include <demos/stability/one_bucket.hpp>

#include <cstdlib>

namespace hashphase::demos {
namespace {

template <class Scalar>
Vector3<Scalar> direction(Random& random) {
    Vector3<Scalar> way;
    do {
        way = Vector3<Scalar>(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    } while (way.norm() > 1 || way.norm() < Scalar(0.1F));
    return way.normalized();
}

// A frame in which everything has moved.
template <class Scalar>
void moveAll(PairScene<Scalar>& scene, Scalar by) {
    Boxes<Scalar> boxes = scene.boxes();
    for (Aabb<Scalar>& box : boxes) {
        box.translate(Vector3<Scalar>(by * box.sizes().x(), 0, 0));
    }
    scene.moveAll(boxes);
    scene.findPairs();
}

template <class Scalar>
double testsOf(const PairScene<Scalar>& scene) {
    return static_cast<double>(scene.cost().boxesTested);
}

// Boxes tested for each object and pair, in a frame in which everything moves.
template <class Scalar>
double testsOfMove(PairScene<Scalar>& scene) {
    moveAll<Scalar>(scene, 0.125F);
    moveAll<Scalar>(scene, -0.125F);
    const double useful =
        static_cast<double>(scene.boxes().size()) + static_cast<double>(scene.reported().size());
    return testsOf(scene) / useful;
}

template <class Scalar>
double timeOf(PairScene<Scalar>& scene) {
    return shortestTime(3, [&] {
        moveAll<Scalar>(scene, 0.125F);
        moveAll<Scalar>(scene, -0.125F);
    });
}

/// Boxes of which each order of magnitude is as frequent as any other, in a cube in which so many pairs
/// are left for each box, on average.
template <class Scalar>
Boxes<Scalar> mixture(std::size_t count, double smallest, double largest, double pairsPerBox,
                      std::uint64_t seed) {
    // The mean of a power of the sizes, which are evenly spread in their logarithms.
    const double spread = std::log(largest / smallest);
    const auto mean = [&](int power) {
        return spread == 0
                   ? std::pow(largest, power)
                   : (std::pow(largest, power) - std::pow(smallest, power)) / (power * spread);
    };
    // Of (a + b)^3: two boxes overlap when their centres are no farther apart than (a + b) / 2.
    const double around = 2 * mean(3) + 6 * mean(2) * mean(1);
    const double side = std::cbrt(static_cast<double>(count) * around / (2 * pairsPerBox));
    Random random(seed);
    Boxes<Scalar> boxes;
    while (boxes.size() < count) {
        const double size = smallest * std::exp(spread * between<double>(random, 0, 1));
        const Vector3<double> center = pointIn<double>(random, 0, side);
        boxes.push_back(cubeAt(center, size).template cast<Scalar>());
    }
    return boxes;
}

/// As many pairs a box of all sizes as of one. The larger ones are tested with many of the smaller,
/// which follow one another in memory: about a hundred tests a box instead of four.
template <class Scalar>
void judgeMixtures(CaseRun<Scalar>& run) {
    for (const double pairsPerBox : {0.1, 1.0}) {
        for (const std::size_t count : {4000U, 20'000U}) {
            const auto judge = [&](double smallest, double largest, double bound) {
                PairScene<Scalar> scene(
                    run, mixture<Scalar>(count, smallest, largest, pairsPerBox, run.seed));
                scene.judge();
                const double pairs = pairsPerBox * static_cast<double>(count);
                run.expect(
                    std::abs(static_cast<double>(scene.reported().size()) - pairs) <= pairs / 4,
                    "boxes of mixed sizes have about the planned number of pairs");
                run.expect(testsOf(scene) <= bound * static_cast<double>(count),
                           "a box costs at most 120 tests, or 6 if all sizes are equal");
            };
            judge(1, 1, 6);
            judge(1e-6, 1e6, 120);
        }
    }
}

constexpr auto allSizes = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    Random random(run.seed);
    const int count = run.quickOrFull(1000, 4000);
    Boxes<Scalar> mixed;
    for (int i = 0; i < count; ++i) {
        const Scalar edge = std::pow(10.0F, random.between(-6, 6));
        mixed.push_back(cubeAt<Scalar>(
            direction<Scalar>(random) * (edge * Scalar(random.between(0, 12))), edge));
    }
    const Scalar side = 1.5F * std::cbrt(static_cast<float>(count));
    PairScene<Scalar> many(run, mixed);
    PairScene<Scalar> one(run, scatteredCubes<Scalar>(mixed.size(), side, 1, 1, run.seed));
    many.judge();
    one.judge();
    if (many.grid() != nullptr) {
        const double pairs = static_cast<double>(many.reported().size());
        run.expect(testsOf(many) <= 120 * (pairs + count),
                   "the scene costs at most 120 tests per pair and box");
        run.addCost(testsOfMove(many) / testsOfMove(one), 3);
        run.note(
            "Cost: boxes tested per object and pair, divided by the value for cubes of one size.");
        judgeMixtures(run);
    } else {
        run.addCost(timeOf(many) / timeOf(one), 3);
        run.note("Cost: time of a frame, divided by the time for as many cubes of one size.");
    }
    many.judge();
};

constexpr auto oneLargeObject = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    constexpr std::size_t kCount = 4000;
    Boxes<Scalar> boxes = scatteredCubes<Scalar>(kCount, 60, 0.4F, 0.8F, run.seed);
    PairScene<Scalar> without(run, boxes, {.cellSize = 1});
    boxes.push_back(cubeAt<Scalar>({3, -2, 1}, 20));
    PairScene<Scalar> with(run, boxes, {.cellSize = 1});
    with.judge();
    if (with.grid() == nullptr) {
        return;
    }
    run.expect(with.cost().grid.filed == boxes.size(), "each box is stored once");
    without.findPairs();
    run.addCost(testsOfMove(with) / testsOfMove(without), 1.25);
    run.note(
        "Cost: boxes tested per object and pair, divided by the value without the large cube.");
};

// --- Collisions -----------------------------------------------------------------------------------

// Two that touch at each of the places, and some that are beside them in the next cells.
template <class Scalar>
Boxes<Scalar> pairsAt(const std::vector<Vector3<float>>& places) {
    Boxes<Scalar> boxes;
    for (const Vector3<float>& place : places) {
        const Vector3<Scalar> at = place.cast<Scalar>();
        boxes.push_back(cubeAt<Scalar>(at + Vector3<Scalar>::Constant(0.5F), 0.5F));
        boxes.push_back(cubeAt<Scalar>(at + Vector3<Scalar>(1, 0.5F, 0.5F), 0.5F));
        boxes.push_back(cubeAt<Scalar>(at + Vector3<Scalar>(0.5F, 1.5F, 0.5F), 0.5F));
    }
    return boxes;
}

// --- One bucket -----------------------------------------------------------------------------------

/// Though far apart, they are in one bucket: sorted there, so that pairs and queries cost little.
template <class Scalar>
void judgeOneBucket(CaseRun<Scalar>& run, const Boxes<Scalar>& boxes) {
    constexpr std::uint64_t kCrowd = 256;  // more than so many share a bucket: it is sorted
    for (const double cellSize : {1.0, 0.0}) {
        PairScene<Scalar> scene(run, boxes, {.cellSize = cellSize});
        scene.judge();
        run.expect(cellSize == 0 || 2 * scene.cost().grid.largestCell >= boxes.size(),
                   "at least half of the boxes are in one bucket");
        run.expect(scene.cost().boxesTested < 5 * kCrowd * boxes.size(),
                   "a crowded bucket is sorted");
        for (std::uint32_t i = 0; i < scene.size(); i += 97) {
            const QueryCost cost = scene.judgeQuery(BoxRegion<Scalar>{boxes[i]});
            run.expect(cost.boxesTested <= (cellSize == 0 ? 32 : 3 * kCrowd),
                       "a query tests only a part of a crowded bucket");
        }
    }
}

/// A long region in a sparse world has more cells than there are buckets.
template <class Scalar>
void judgeLongRegions(CaseRun<Scalar>& run) {
    Random random(run.seed);
    Boxes<Scalar> boxes;
    for (int i = 0; i < 4000; ++i) {
        const Scalar x = between<Scalar>(random, -1e6F, 1e6F);
        const Scalar y = between<Scalar>(random, -30, 30);
        boxes.push_back(cubeAt<Scalar>({x, y, between<Scalar>(random, -30, 30)}, 0.6F));
    }
    PairScene<Scalar> scene(run, boxes, {.cellSize = 1});
    scene.judge();
    for (const double length : {1.0, 100.0, 1e4, 1e5, 1e6}) {
        for (int i = 0; i < 4; ++i) {
            const double x = between<double>(random, -1e6, 1e6 - length);
            const QueryCost cost = scene.judgeQuery(
                BoxRegion<Scalar>{makeBox<Scalar>(x, -15, -15, x + length, 15, 15)});
            run.expect(cost.boxesTested <= boxes.size(), "a query tests each box at most once");
        }
    }
}

constexpr auto cellsThatCollide = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    using Point = Vector3<float>;
    const int side = run.quickOrFull(100, 400);
    std::vector<Point> equalRows;
    std::vector<Point> scattered;
    Random random(run.seed);
    const auto far = [&] {
        return std::floor(1000 * static_cast<float>(side) * random.between(-1, 1));
    };
    for (int i = 0; i < side; ++i) {
        const float y = far();
        scattered.emplace_back(0, y, far());
    }
    // As many, and about as far apart.
    const auto [stepY, stepZ] =
        stepWithinBucket(fileInCellsOfOneMetre(pairsAt<Scalar>(scattered)).levels()[1]);
    for (int i = 0; i < side; ++i) {
        const auto k = static_cast<float>(i - side / 2);
        equalRows.emplace_back(0, k * static_cast<float>(stepY), k * static_cast<float>(stepZ));
    }
    PairScene<Scalar> adversary(run, pairsAt<Scalar>(equalRows), {.cellSize = 1});
    PairScene<Scalar> harmless(run, pairsAt<Scalar>(scattered), {.cellSize = 1});
    adversary.judge();
    harmless.judge();

    // Multiples of sizes that tables have, and of primes.
    for (const float stride : {64.0F, 1024.0F, 65536.0F, 19937.0F, 131071.0F, 524287.0F}) {
        std::vector<Point> places;
        for (int i = 0; i < 125; ++i) {
            places.push_back(stride * Point(static_cast<float>(i % 5),
                                            static_cast<float>(i / 5 % 5),
                                            static_cast<float>(i / 25)));
        }
        judgePairs(run, pairsAt<Scalar>(places), {1});
    }
    if (adversary.grid() == nullptr) {
        return;
    }
    run.addCost(testsOfMove(adversary) / testsOfMove(harmless), 3);
    run.note("Cost: boxes tested per object and pair, divided by the value without collisions.");
    for (const CrowdPlace place : {CrowdPlace::anywhere, CrowdPlace::longRows}) {
        judgeOneBucket(run, crowdInOneBucket<Scalar>(place).boxes);
    }
    judgeLongRegions(run);
};

constexpr HardCase kSizeCases[] = {
    {"H27", "sizes from 1e-6 to 1e6 m",
     "4,000 cubes (--quick: 1,000) of 1e-6 to 1e6 m, equally many of each order of magnitude, "
     "within 12 edge lengths of the origin; for comparison, as many cubes of 1 m",
     "exact pairs; at most three times the cost of cubes of one size", allSizes},
    {"H28", "one object as large as 8,000 cells",
     "a cube of 20 m among 4,000 cubes of 0.4 to 0.8 m; cells of 1 m",
     "exact pairs; the large cube is stored once, and costs no more than its pairs",
     oneLargeObject},
    {"H29", "cells with hash collisions",
     "cells of 1 m; pairs of boxes in rows of cells that share a bucket of hashphase's hash table, "
     "at multiples of table sizes, and at multiples of large primes",
     "exact pairs; at most three times the cost without collisions", cellsThatCollide},
};

}  // namespace

std::span<const HardCase> sizeCases() {
    return kSizeCases;
}

}  // namespace hashphase::demos
