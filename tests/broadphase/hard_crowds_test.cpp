// SPDX-License-Identifier: Zlib

// Crowds that have broken broadphases: all in one cell, all at one place, in any order, and none at
// all. Costs are counted.

#include <broadphase/core/limits.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_sweep.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
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

// Though some have left, or moved, since they were sorted, and a few are long.
TYPED_TEST(HardCrowds, OfWhichQueriesWantAFewAreSearchedAlongAnAxis) {
    constexpr std::uint32_t kCount = 8'000;
    auto boxes = crowd<TypeParam>(kCount, 100, 0x5eed1307);
    for (int i = 0; i < 3; ++i) {
        boxes.push_back(makeBox<TypeParam>(30 * i, 1, 1, 30 * i + 35, 9, 9));
    }
    addAnchors(boxes);
    Grid<TypeParam> grid(cellsOf(1e4));
    std::vector<Placed<TypeParam>> proxies;
    for (const Aabb<TypeParam>& box : boxes) {
        proxies.push_back({grid.add(box), box});
    }
    ASSERT_GT(grid.update().largestCell, kCount - 100);
    for (std::uint32_t i = 0; i < kCount; i += 50) {
        proxies[i].box = proxies[i + 1].box;
        grid.move(proxies[i].id, proxies[i].box);
        grid.remove(proxies[i + 25].id);
    }
    for (std::uint32_t i = kCount; i > 0; i -= 50) {
        proxies.erase(proxies.begin() + (i - 25));
    }
    Random random(0x5eed1308);
    std::uint64_t found = 0;
    std::uint64_t tested = 0;
    constexpr std::uint64_t kQueries = 60;
    for (std::uint64_t i = 0; i < kQueries; ++i) {
        const SphereRegion<TypeParam> sphere(random.pointIn(0, 100).template cast<TypeParam>(), 3);
        found += expectLikeBruteForce<TypeParam>(grid, proxies, sphere);
        CollectCount count;
        tested += grid.visit(sphere, count).boxesTested;
    }
    EXPECT_GT(found, kQueries);
    EXPECT_LT(tested, kQueries * kCount / 8) << "of about " << kCount << " in the cell";
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
    const auto expected = Swept(boxes).pairs;
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
