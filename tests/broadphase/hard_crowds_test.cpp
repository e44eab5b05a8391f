// SPDX-License-Identifier: Zlib

// Crowds that have broken broadphases: all in one cell, all at one place, all in one bucket of the
// hash though far apart, in any order, and none at all. Costs are counted.

#include <broadphase/detail/limits.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
using Boxes = std::vector<Aabb<Scalar>>;

GridConfig cellsOf(double size) {
    GridConfig config;
    config.cellSize = size;
    return config;
}

/// Numbers of boxes that overlap, found by sorting along x; and how many tests of two boxes that
/// takes.
struct Swept {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> couples;
    std::uint64_t tests = 0;

    template <class Scalar>
    explicit Swept(const Boxes<Scalar>& boxes) {
        std::vector<std::uint32_t> order(boxes.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return boxes[a].min()[0] < boxes[b].min()[0];
        });
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Aabb<Scalar>& box = boxes[order[i]];
            for (std::size_t j = i + 1;
                 j < order.size() && boxes[order[j]].min()[0] <= box.max()[0]; ++j) {
                ++tests;
                if (overlaps(box, boxes[order[j]])) {
                    couples.push_back(std::minmax(order[i], order[j]));
                }
            }
        }
        std::sort(couples.begin(), couples.end());
    }
};

/// The pairs are those of the sweep; returns what they cost.
template <class Scalar>
PairCost expectPairsOfSweep(const Boxes<Scalar>& boxes, const GridConfig& config,
                            const Swept& swept) {
    Grid<Scalar> grid(config);
    Pairs<Scalar> pairs(grid);
    for (const Aabb<Scalar>& box : boxes) {
        static_cast<void>(grid.add(box));
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const ProxyPair& pair : pairs.update([](ProxyId, ProxyId) { return true; }).born) {
        found.emplace_back(pair.first.index, pair.second.index);
    }
    EXPECT_EQ(differences(found, swept.couples), "");
    EXPECT_EQ(grid.validate(), "");
    return pairs.lastCost();
}

template <class Scalar>
PairCost expectPairsOfSweep(const Boxes<Scalar>& boxes, const GridConfig& config) {
    return expectPairsOfSweep(boxes, config, Swept(boxes));
}

template <class Scalar>
class HardCrowds : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HardCrowds, Scalars);

template <class Scalar>
Boxes<Scalar> crowd(std::uint32_t count, double side, std::uint64_t seed) {
    Random random(seed);
    Boxes<Scalar> boxes;
    for (std::uint32_t i = 0; i < count; ++i) {
        boxes.push_back(boxAround<Scalar>(random.pointIn(1, side - 1), random.pointIn(0.1, 0.5)));
    }
    return boxes;
}

/// So many boxes elsewhere, each in a cell of 1e4 m of its own, that the crowds at the origin are
/// not in the middle of all, where cells begin.
template <class Scalar>
void addAnchors(Boxes<Scalar>& boxes) {
    const auto count = static_cast<int>(boxes.size() + 1);
    for (int i = 0; i < count; ++i) {
        const Vector3<double> at = Vector3<double>(i % 50, i / 50 % 50, i / 2500) * 2e4;
        boxes.push_back(boxAround<Scalar>((at.array() + 25e3).matrix(), {0.5, 0.5, 0.5}));
    }
}

// However much too large the cells are that were asked for.
TYPED_TEST(HardCrowds, OfAHundredThousandInACellCostWhatSweepingAlongAnAxisDoes) {
    constexpr std::uint32_t kCount = 102'000;
    auto boxes = crowd<TypeParam>(kCount, 400, 0x5eed1301);
    const Swept swept(boxes);
    const PairCost inCellsOfTheirSize = expectPairsOfSweep(boxes, {}, swept);
    addAnchors(boxes);
    const PairCost inOneCell = expectPairsOfSweep(boxes, cellsOf(1e4), swept);
    EXPECT_LE(inOneCell.boxesTested, swept.tests + swept.tests / 2);
    EXPECT_GE(inOneCell.grid.largestCell, 100'000U) << "and it is told";
    EXPECT_LT(inCellsOfTheirSize.boxesTested, 10U * kCount);
    EXPECT_LT(inCellsOfTheirSize.grid.largestCell, 50U);
}

// A long box is tested with everyone, and makes nobody else slower.
TYPED_TEST(HardCrowds, OfWhichAFewAreLongCostNoMoreThanThese) {
    constexpr std::uint32_t kCount = 10'000;
    auto boxes = crowd<TypeParam>(kCount, 100, 0x5eed1302);
    const std::uint64_t without = expectPairsOfSweep(boxes, cellsOf(1e4)).boxesTested;
    for (int i = 0; i < 3; ++i) {
        boxes.push_back(
            makeBox<TypeParam>(20 * i, 20 * i, 20 * i, 20 * i + 55, 20 * i + 55, 20 * i + 55));
    }
    EXPECT_LE(expectPairsOfSweep(boxes, cellsOf(1e4)).boxesTested, without + 4 * kCount);
}

// Of three crowds, each is flat along another axis: no axis is good for all.
TYPED_TEST(HardCrowds, OfEachCellAreSweptAlongAnAxisOfItsOwn) {
    Random random(0x5eed1303);
    Boxes<TypeParam> boxes;
    constexpr std::uint32_t kCount = 9'000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const int flat = static_cast<int>(i % 3);
        Vector3<double> center = random.pointIn(1, 99);
        center[flat] = 50;
        center += Vector3<double>(flat * 1000, 0, 0);
        boxes.push_back(boxAround<TypeParam>(center, Vector3<double>::Constant(0.2)));
    }
    EXPECT_LT(expectPairsOfSweep(boxes, cellsOf(1000)).boxesTested, 200U * kCount);
}

TEST(HardCrowd, AtOnePlaceArePairsOfAllAndNoMoreMemoryEachTime) {
    constexpr std::uint32_t kCount = 2000;
    constexpr std::size_t kPairs = std::size_t{kCount} * (kCount - 1) / 2;
    static_assert(kPairs == 1'999'000);
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const auto acceptAll = [](ProxyId, ProxyId) { return true; };
    const Aabb<float> place = makeBox<float>(3, 4, 5, 4, 5, 6);
    std::vector<ProxyId> ids;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        ids.push_back(grid.add(place));
    }
    std::size_t bytes = 0;
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(pairs.update(acceptAll).born.size(), kPairs);
        EXPECT_EQ(pairs.count(), kPairs);
        EXPECT_LE(pairs.lastCost().boxesTested, kPairs + kPairs / 10);
        for (std::uint32_t i = 0; i < kCount; ++i) {
            grid.move(ids[i], makeBox<float>(9.0 * i, 0, 0, 9.0 * i + 1, 1, 1));
        }
        EXPECT_EQ(pairs.update(acceptAll).died.size(), kPairs);
        EXPECT_EQ(pairs.count(), 0U);
        for (const ProxyId id : ids) {
            grid.move(id, place);
        }
        EXPECT_LT(pairs.memoryBytes(), 160 * kPairs);
        EXPECT_TRUE(round == 0 || pairs.memoryBytes() <= bytes);
        bytes = pairs.memoryBytes();
    }
}

// --- Collisions of the hash ----------------------------------------------------------------------

/// The hash of a row of cells, as detail::Level has it where rows are hashed.
std::uint32_t hashOfRow(std::int32_t y, std::int32_t z) {
    return detail::mixRow(static_cast<std::uint32_t>(y) * 0x9e3779b1U +
                          static_cast<std::uint32_t>(z) * 0x85ebca77U);
}

/// Rows of one hash, so near that numbers of single precision tell their cells apart.
std::vector<detail::Row> rowsOfOneHash() {
    constexpr std::int32_t kMost = 1 << 22;
    // What z has to be follows from y: the factor of z is odd, and has an inverse.
    std::uint32_t inverse = 1;
    for (int i = 0; i < 5; ++i) {
        inverse *= 2 - 0x85ebca77U * inverse;
    }
    std::vector<detail::Row> rows;
    for (std::int32_t y = -kMost; y < kMost; ++y) {
        const auto z =
            static_cast<std::int32_t>(0 - static_cast<std::uint32_t>(y) * 0x9e3779b1U * inverse);
        if (std::abs(z) < kMost) {
            rows.push_back({y, z});
        }
    }
    return rows;
}

template <class Scalar>
Aabb<Scalar> boxInCell(std::int64_t x, std::int64_t y, std::int64_t z) {
    const Vector3<double> cell(static_cast<double>(x), static_cast<double>(y),
                               static_cast<double>(z));
    return boxAround<Scalar>((cell.array() + 0.5).matrix(), Vector3<double>::Constant(0.125));
}

/// Whether most boxes lie in one bucket.
template <class Scalar>
bool areInOneBucket(const Boxes<Scalar>& boxes) {
    detail::Table<Scalar> table;
    fill(table, boxes, detail::fixedLevels(1, 4));
    std::vector<std::uint32_t> buckets;
    const detail::Level<Scalar>& hashed = table.levels()[1];
    for (std::uint32_t i = hashed.firstEntry; i < hashed.lastEntry; ++i) {
        buckets.push_back(hashed.bucket({hashed.cell(table.box(i).min()[0], 0),
                                         hashed.cell(table.box(i).min()[1], 1),
                                         hashed.cell(table.box(i).min()[2], 2)}));
    }
    std::sort(buckets.begin(), buckets.end());
    std::size_t most = 0;
    for (std::size_t i = 0; i < buckets.size();) {
        const auto end = std::upper_bound(buckets.begin(), buckets.end(), buckets[i]);
        most = std::max(most, static_cast<std::size_t>(end - buckets.begin()) - i);
        i = static_cast<std::size_t>(end - buckets.begin());
    }
    return 2 * most >= boxes.size();
}

constexpr std::int32_t kAttackers = 12'000;
constexpr std::int32_t kBuckets = 32'768;  // for so many

/// Boxes whose rows have one and the same hash of 32 bits.
template <class Scalar>
Boxes<Scalar> boxesInRowsOfOneHash() {
    Boxes<Scalar> boxes;
    for (const auto [y, z] : rowsOfOneHash()) {
        boxes.push_back(boxInCell<Scalar>(7, y, z));
    }
    EXPECT_GE(boxes.size(), 12'000U);
    boxes.resize(kAttackers);
    return boxes;
}

/// Boxes in rows of any hash, each as far along its row as makes up for it.
template <class Scalar>
Boxes<Scalar> boxesThatMakeUpForTheirRows() {
    // Rows are counted from the median of the population.
    Boxes<Scalar> boxes(kAttackers);
    Vector3<double> origin(0, 0, 0);
    for (int pass = 0; pass < 2; ++pass) {
        for (std::int32_t i = 0; i < kAttackers; ++i) {
            const std::int32_t y = 40 * (i % 110);
            const std::int32_t z = 40 * (i / 110);
            const std::uint32_t hash = hashOfRow(y - static_cast<std::int32_t>(origin[1]),
                                                 z - static_cast<std::int32_t>(origin[2]));
            boxes[static_cast<std::size_t>(i)] = boxInCell<Scalar>((0U - hash) % kBuckets, y, z);
        }
        detail::Table<Scalar> table;
        fill(table, boxes, detail::fixedLevels(1, 4));
        const detail::Level<Scalar>& level = table.levels()[1];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin[static_cast<int>(axis)] = static_cast<double>(level.origin[axis]);
        }
    }
    return boxes;
}

/// Boxes in one row, farther apart than there are buckets.
template <class Scalar>
Boxes<Scalar> boxesInALongRow() {
    Boxes<Scalar> boxes;
    for (std::int32_t i = 0; i < kAttackers; ++i) {
        boxes.push_back(boxInCell<Scalar>(std::int64_t{kBuckets} * (i - kAttackers / 2), 3, 5));
    }
    return boxes;
}

TYPED_TEST(HardCrowds, WithEveryBoxInOneBucketAreSweptToo) {
    const Boxes<TypeParam> attacks[] = {boxesInRowsOfOneHash<TypeParam>(),
                                        boxesThatMakeUpForTheirRows<TypeParam>(),
                                        boxesInALongRow<TypeParam>()};
    for (const Boxes<TypeParam>& attack : attacks) {
        SCOPED_TRACE(&attack - attacks);
        Boxes<TypeParam> boxes = attack;
        EXPECT_TRUE(areInOneBucket(boxes));
        for (std::size_t i = 0; i < 300; ++i) {
            boxes.push_back(attack[i * 37]);  // couples
        }
        for (const double cellSize : {1.0, 0.0}) {
            const PairCost cost = expectPairsOfSweep(boxes, cellsOf(cellSize));
            EXPECT_LT(cost.boxesTested, 5 * detail::kCrowd * boxes.size())
                << "cells of " << cellSize;
        }
        Grid<TypeParam> grid(cellsOf(1));
        for (const Aabb<TypeParam>& box : boxes) {
            static_cast<void>(grid.add(box));
        }
        grid.update();
        QueryCost cost;
        for (std::size_t i = 0; i < boxes.size(); i += 97) {
            CollectCount count;
            cost += grid.visit(BoxRegion<TypeParam>{boxes[i]}, count);
            ASSERT_GE(count.count(), 1U);
        }
        EXPECT_LE(cost.boxesTested, 127 * boxes.size()) << "at worst everyone, once a query";
    }
}

// A long region in a sparse world has more cells than there are buckets.
TYPED_TEST(HardCrowds, ThatAreHashedAreLookedAtOnceAQueryHoweverLarge) {
    Random random(0x5eed1306);
    std::vector<Placed<TypeParam>> proxies;
    Grid<TypeParam> grid(cellsOf(1));
    for (int i = 0; i < 4000; ++i) {
        const Vector3<double> at = random.pointIn({-1e6, -30, -30}, {1e6, 30, 30});
        const Aabb<TypeParam> box = boxAround<TypeParam>(at, {0.3, 0.3, 0.3});
        proxies.push_back({grid.add(box), box});
    }
    grid.update();
    std::vector<BoxRegion<TypeParam>> regions;
    for (const double length : {1.0, 100.0, 1e4, 1e5, 1e6}) {
        for (int i = 0; i < 4; ++i) {
            const double begin = random.between(-1e6, 1e6 - length);
            regions.push_back({makeBox<TypeParam>(begin, -15, -15, begin + length, 15, 15)});
        }
    }
    std::uint64_t together = 0;
    for (const BoxRegion<TypeParam>& region : regions) {
        expectLikeBruteForce<TypeParam>(grid, proxies, region);
        CollectCount count;
        EXPECT_LE(grid.visit(region, count).boxesTested, proxies.size());
        CollectCount each;
        together += grid.visitEach(std::span(&region, 1), std::span(&each, 1)).boxesTested;
        EXPECT_EQ(each.count(), count.count());
    }
    EXPECT_LE(together, regions.size() * proxies.size());
}

// --- Order ---------------------------------------------------------------------------------------

TYPED_TEST(HardCrowds, InAnyOrderOnAnyNumberOfThreadsAreTheSamePairs) {
    Random random(0x5eed1304);
    Boxes<TypeParam> boxes;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (int i = 0; i < 200; ++i) {
            const Aabb<TypeParam> box = scene.draw(random);
            boxes.push_back(hasNan(box) ? makeBox<TypeParam>(0, 0, 0, 1, 1, 1) : box);
        }
    }
    const auto expected = Swept(boxes).couples;
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0U);
    for (const std::size_t threadCount : {1U, 2U, 3U, 5U, 8U, 16U}) {
        ThreadedFor threads(threadCount, 0x5eed1305 + threadCount);
        Grid<TypeParam> grid;
        Pairs<TypeParam> pairs(grid);
        for (const std::uint32_t i : order) {
            static_cast<void>(grid.add(boxes[i]));
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
        const auto born = pairs.update([](ProxyId, ProxyId) { return true; }, threads).born;
        EXPECT_TRUE(std::is_sorted(born.begin(), born.end()));
        for (const ProxyPair& pair : born) {
            found.push_back(std::minmax(order[pair.first.index], order[pair.second.index]));
        }
        std::sort(found.begin(), found.end());
        EXPECT_EQ(differences(found, expected), "") << threadCount << " threads";
        for (std::size_t i = order.size(); i > 1; --i) {
            std::swap(order[i - 1], order[random.below(static_cast<std::uint32_t>(i))]);
        }
    }
}

// --- Few, none, and too many ---------------------------------------------------------------------

TYPED_TEST(HardCrowds, OfNobodyOrOneOrOnlyStraysAreNoPairs) {
    const auto most = std::numeric_limits<TypeParam>::max();
    const Aabb<TypeParam> everywhere(Vector3<TypeParam>::Constant(-most),
                                     Vector3<TypeParam>::Constant(most));
    for (const double cellSize : {0.0, 1e-30, 1.0}) {
        for (const std::uint32_t count : {0U, 1U, 40U}) {
            // Beyond all cells, each in a corner of its own.
            std::vector<Placed<TypeParam>> proxies;
            PairWorld<TypeParam> world(cellsOf(cellSize));
            for (std::uint32_t i = 0; i < count; ++i) {
                const auto far = static_cast<TypeParam>(1e25 * (1 + i));
                const Vector3<TypeParam> at(far, -far, i % 2 == 0 ? far : -far);
                proxies.push_back({world.add({at, at}), {at, at}});
            }
            for (int frame = 0; frame < 12; ++frame) {
                world.update();
                world.checkThoroughly(proxies);
                EXPECT_EQ(world.pairs.count(), 0U);
            }
            EXPECT_EQ(find(world.grid, BoxRegion<TypeParam>{everywhere}).size(), count);
            CollectClosest<TypeParam> closest;
            world.grid.visit(RayRegion<TypeParam>({0, 0, 0}, {1, 1, 1}), closest);
            EXPECT_TRUE(closest.found().isNull());
            for (const Placed<TypeParam>& proxy : proxies) {
                world.remove(proxy.id);
            }
            world.update();
            world.checkThoroughly({});
            // Two that touch are a pair all the same.
            static_cast<void>(world.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1)));
            static_cast<void>(world.add(makeBox<TypeParam>(1, 1, 1, 2, 2, 2)));
            EXPECT_EQ(world.update().born.size(), 1U);
        }
    }
}

TYPED_TEST(HardCrowds, OfMoreThanThereMayBeAreRefusedInASentence) {
    Grid<TypeParam> grid;
    const ProxyId id = grid.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    for (const std::size_t count :
         {detail::kMostProxies + 1, std::size_t{1} << 32, ~std::size_t{0}}) {
        try {
            grid.reserve(count);
            ADD_FAILURE() << "there is room for " << count;
        } catch (const std::length_error& refused) {
            EXPECT_STREQ(refused.what(), "A grid holds at most 268,435,456 proxies.");
        }
    }
    EXPECT_EQ(grid.size(), 1U);
    EXPECT_TRUE(grid.contains(id));
    EXPECT_EQ(grid.validate(), "");
}

}  // namespace
}  // namespace hashphase::test
