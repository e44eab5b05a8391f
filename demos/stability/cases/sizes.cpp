// SPDX-License-Identifier: Zlib
//
// Sizes that differ by twelve orders of magnitude, cells that were chosen to collide, and cells of
// no size.

#include <demos/stability/cases/cases.hpp>

#include <demos/compare/reference_pairs.hpp>
#include <demos/compare/trial.hpp>
#include <demos/scenes/random.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

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
Boxes pairsAt(const std::vector<Point>& places) {
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
    PairScene adversary(context, pairsAt(equalRows), {.cellSize = 1});
    PairScene harmless(context, pairsAt(scattered), {.cellSize = 1});
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
        judgePairs(context, tally, pairsAt(places), {.cellSize = 1});
    }
    if (adversary.hash() != nullptr) {
        tally.addCost(testsOf(adversary) / testsOf(harmless), 3);
        tally.note(
            "Cost: boxes tested for each object and pair, by those of rows that do not "
            "collide.");
    }
    return tally.outcome();
}

// --- Cells of no size -----------------------------------------------------------------------------

// What a scene says: its pairs, and who is around the origin, in the order in which it tells.
struct Answers {
    explicit Answers(PairScene& scene) {
        scene.findPairs();
        pairs = scene.reported();
        NoteObjects callback;
        scene.broadphase().aabbTest({-2, -2, -2}, {2, 2, 2}, callback);
        found = std::move(callback.found);
    }
    friend bool operator==(const Answers&, const Answers&) = default;

    std::vector<PairKey> pairs;
    Objects found;
};

template <class Make>
bool isRefused(const Make& make) {
    try {
        static_cast<void>(make());
    } catch (const std::invalid_argument& refusal) {
        return *refusal.what() != '\0';
    }
    return false;
}

// A grid of either precision, and a broadphase, to which a pair cache is given.
void expectRefused(double cellSize, PairCache& cache, CaseTally& tally) {
    SpatialHashConfig config;
    config.grid.cellSize = cellSize;
    constexpr std::string_view kWhat = "a cell of that size is refused with a reason";
    tally.expect(isRefused([&] { return std::make_unique<Grid<float>>(config.grid); }), kWhat);
    tally.expect(isRefused([&] { return std::make_unique<Grid<double>>(config.grid); }), kWhat);
    tally.expect(isRefused([&] { return std::make_unique<SpatialHashBroadphase>(&cache, config); }),
                 kWhat);
    tally.expect(!configError(config.grid).empty(), kWhat);
}

// The cache serves a broadphase.
void judgeCache(PairCache& cache, const Boxes& boxes, CaseTally& tally) {
    SpatialHashBroadphase broadphase(&cache);
    for (const Aabb<float>& box : boxes) {
        broadphase.createProxy(toBullet(box.min()), toBullet(box.max()), 0, nullptr, 1, -1,
                               nullptr);
    }
    broadphase.calculateOverlappingPairs(nullptr);
    const auto numberOf = [](const btBroadphaseProxy& proxy) {
        return static_cast<std::uint32_t>(proxy.m_uniqueId) - 1;
    };
    std::vector<PairKey> reported;
    std::vector<PairKey> exact;
    listPairs(cache, numberOf, reported);
    findExactPairs(ReferenceMethod::kBrute, boxes, {}, exact);
    tally.compare(reported, exact);
}

CaseOutcome cellSizesThatAreNone(const CaseContext& context) {
    if (!context.kind.ours) {
        return {};
    }
    CaseTally tally;
    PairScene scene(context, scatteredCubes(60, 8, 0.5F, 1.5F, context.seed));
    scene.judge(tally);
    const Answers before(scene);
    PairCache cache;
    const std::size_t cacheBytes = cache.memoryBytes();
    using Limits = std::numeric_limits<double>;
    for (const double size : {-1.0, Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(),
                              1e31, 1e-31, Limits::denorm_min()}) {
        expectRefused(size, cache, tally);
    }
    tally.expect(configError({.cellSize = 0}).empty(), "0 chooses the size");
    tally.expect(Answers(scene) == before, "what runs already answers as before");
    tally.expect(cache.memoryBytes() == cacheBytes && cache.validate().empty(),
                 "a pair cache given to what is refused stays as it was");
    judgeCache(cache, scene.boxes(), tally);
    for (std::uint32_t i = 0; i < scene.size(); i += 3) {
        scene.move(i, scene.boxes()[i].translated(Point(0.5F, 0, 0)));
    }
    scene.judge(tally);
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
        "cells of 1 m; pairs in rows of cells that our hash cannot tell apart, on multiples of "
        "table sizes, and of large primes",
        "exact pairs, and bounded work", cellsThatCollide},
    HardCase{"H31", "cell sizes that are none",
             "a cell size of -1, NaN, +-infinity, 1e31, 1e-31, the smallest denormal; and 0",
             "refused with a reason by grids of both precisions and the broadphase; 0 chooses one; "
             "what runs already answers as before, and the pair cache that the refused one was "
             "given serves another",
             cellSizesThatAreNone},
};

}  // namespace

std::span<const HardCase> sizeCases() {
    return kSizeCases;
}

}  // namespace hashphase::demos
