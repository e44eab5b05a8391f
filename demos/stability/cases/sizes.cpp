// SPDX-License-Identifier: Zlib
//
// Sizes that differ by twelve orders of magnitude, and cells that were chosen to collide.

#include <demos/stability/cases/cases.hpp>

#include <demos/scenes/random.hpp>
#include <demos/stability/pair_scene.hpp>

#include <array>
#include <cmath>
#include <cstdlib>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;

Point direction(Random& random) {
    Point way;
    do {
        way = Point(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    } while (way.norm() > 1 || way.norm() < 0.1F);
    return way.normalized();
}

// A frame in which everything has moved.
void moveAll(PairScene& scene, float by) {
    Boxes boxes = scene.boxes();
    for (Aabb<float>& box : boxes) {
        box.translate(Point(by * box.sizes().x(), 0, 0));
    }
    scene.moveAll(boxes);
    scene.findPairs();
}

// Boxes tested for each object and pair, in a frame in which everything moves.
double testsOf(PairScene& scene) {
    moveAll(scene, 0.125F);
    moveAll(scene, -0.125F);
    const double useful =
        static_cast<double>(scene.boxes().size()) + static_cast<double>(scene.reported().size());
    return static_cast<double>(scene.hash()->lastCost().boxesTested) / useful;
}

double timeOf(PairScene& scene) {
    return shortestTime(3, [&] {
        moveAll(scene, 0.125F);
        moveAll(scene, -0.125F);
    });
}

CaseOutcome allSizes(const CaseContext& context) {
    Random random(context.seed);
    const int count = context.quickOrFull(1000, 4000);
    Boxes mixed;
    for (int i = 0; i < count; ++i) {
        const float edge = std::pow(10.0F, random.between(-6, 6));
        mixed.push_back(cubeAt(direction(random) * (edge * random.between(0, 12)), edge));
    }
    const float side = 1.5F * std::cbrt(static_cast<float>(count));
    PairScene many(context, mixed);
    PairScene one(context, scatteredCubes(mixed.size(), side, 1, 1, context.seed));
    CaseTally tally;
    many.judge(tally);
    one.judge(tally);
    if (context.kind.ours && many.hash() != nullptr) {
        tally.addCost(testsOf(many) / testsOf(one), 3);
        tally.note("Cost: boxes tested for each object and pair, by those of one size.");
    } else {
        tally.addCost(timeOf(many) / timeOf(one), 3);
        tally.note("Cost: time of a frame, by that of as many of one size.");
    }
    many.judge(tally);
    return tally.outcome();
}

CaseOutcome oneLargeObject(const CaseContext& context) {
    constexpr std::size_t kCount = 4000;
    Boxes boxes = scatteredCubes(kCount, 60, 0.4F, 0.8F, context.seed);
    PairScene without(context, boxes, {.cellSize = 1});
    boxes.push_back(cubeAt({3, -2, 1}, 20));
    PairScene with(context, boxes, {.cellSize = 1});
    CaseTally tally;
    with.judge(tally);
    if (const SpatialHashBroadphase* hash = with.hash()) {
        tally.expect(hash->lastCost().grid.filed == boxes.size(), "everyone is filed once");
        without.findPairs();
        tally.addCost(testsOf(with) / testsOf(without), 1.25);
        tally.note("Cost: boxes tested for each object and pair, by those without it.");
    }
    return tally.outcome();
}

// --- Collisions -----------------------------------------------------------------------------------

// The step from a row of cells to the nearest one whose number, y * 0x9e3779b1 + z * 0x85ebca77 modulo
// 2^32, is the same: our hash of rows, known to whoever means harm.
std::array<std::int32_t, 2> stepOfEqualRows() {
    constexpr std::uint32_t kY = 0x9e3779b1U;
    constexpr std::uint32_t kZ = 0x85ebca77U;
    std::uint32_t inverse = kY;  // modulo 2^32, by Newton's iteration
    for (int i = 0; i < 5; ++i) {
        inverse *= 2 - kY * inverse;
    }
    std::array<std::int32_t, 2> best{1 << 30, 0};
    for (std::int32_t z = 1; z < (1 << 17); ++z) {
        const auto y = static_cast<std::int32_t>(0U - static_cast<std::uint32_t>(z) * kZ * inverse);
        if (std::max(std::abs(static_cast<std::int64_t>(y)), std::int64_t{z}) <
            std::max(std::abs(static_cast<std::int64_t>(best[0])), std::int64_t{best[1]})) {
            best = {y, z};
        }
    }
    return best;
}

// Two that touch at each of the places, and some that are beside them in the next cells.
Boxes couplesAt(const std::vector<Point>& places) {
    Boxes boxes;
    for (const Point& at : places) {
        boxes.push_back(cubeAt(at + Point::Constant(0.5F), 0.5F));
        boxes.push_back(cubeAt(at + Point(1, 0.5F, 0.5F), 0.5F));
        boxes.push_back(cubeAt(at + Point(0.5F, 1.5F, 0.5F), 0.5F));
    }
    return boxes;
}

CaseOutcome cellsThatCollide(const CaseContext& context) {
    CaseTally tally;
    const int side = context.quickOrFull(100, 400);
    std::vector<Point> equalRows;
    std::vector<Point> scattered;
    const auto [stepY, stepZ] = stepOfEqualRows();
    Random random(context.seed);
    for (int i = -side / 2; i < side / 2; ++i) {
        const auto k = static_cast<float>(i);
        equalRows.emplace_back(0, k * static_cast<float>(stepY), k * static_cast<float>(stepZ));
        // As far apart, but anywhere.
        const auto far = [&](std::int32_t step) {
            return std::floor(static_cast<float>(side) / 2 * static_cast<float>(std::abs(step)) *
                              random.between(-1, 1));
        };
        scattered.emplace_back(0, far(stepY), far(stepZ));
    }
    PairScene adversary(context, couplesAt(equalRows), {.cellSize = 1});
    PairScene harmless(context, couplesAt(scattered), {.cellSize = 1});
    adversary.judge(tally);
    harmless.judge(tally);

    // Multiples of sizes that tables have, and of primes.
    for (const float stride : {64.0F, 1024.0F, 65536.0F, 19937.0F, 131071.0F, 524287.0F}) {
        std::vector<Point> places;
        for (int i = 0; i < 125; ++i) {
            places.push_back(stride * Point(static_cast<float>(i % 5),
                                            static_cast<float>(i / 5 % 5),
                                            static_cast<float>(i / 25)));
        }
        judgePairs(context, tally, couplesAt(places), {.cellSize = 1});
    }
    if (adversary.hash() != nullptr) {
        tally.addCost(testsOf(adversary) / testsOf(harmless), 3);
        tally.note(
            "Cost: boxes tested for each object and pair, by those of rows that do not "
            "collide.");
    }
    return tally.outcome();
}

constexpr std::array kSizeCases{
    HardCase{"H27", "sizes from 1e-6 to 1e6 m",
             "4,000 (--quick: 1,000) cubes of 1e-6 to 1e6 m, as many of each size, within 12 edges "
             "of the origin; as many of 1 m",
             "exact pairs; at most three times the work of one size", allSizes},
    HardCase{"H28", "one object of 8,000 cells",
             "a cube of 20 m among 4,000 of 0.4 to 0.8 m, cells of 1 m",
             "exact pairs; it is filed once, and costs what its pairs do", oneLargeObject},
    HardCase{
        "H29", "cells that collide in the hash",
        "cells of 1 m; couples in rows of cells that our hash cannot tell apart, on multiples of "
        "table sizes, and of large primes",
        "exact pairs, and bounded work", cellsThatCollide},
};

}  // namespace

std::span<const HardCase> sizeCases() {
    return kSizeCases;
}

}  // namespace hashphase::demos
