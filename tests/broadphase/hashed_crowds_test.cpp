// SPDX-License-Identifier: Zlib

// Crowds that are all in one bucket of the hash though far apart, and regions of more cells than
// there are buckets. Pairs and queries are exact, and costs are counted.

#include <broadphase/core/limits.hpp>
#include <broadphase/pairs.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/fill_table.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
using Attack = std::vector<Aabb<Scalar>>;

GridConfig hashedCellsOf(double size) {
    return {.cellSize = size};
}

template <class Scalar>
class HashedCrowds : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HashedCrowds, Scalars);

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
bool areInOneBucket(const Attack<Scalar>& boxes) {
    detail::Table<Scalar> table;
    fill(table, boxes, detail::fixedLevels(1, 4));
    std::vector<std::uint32_t> buckets;
    const detail::Level<Scalar>& hashed = table.levels()[1];
    for (std::uint32_t i = hashed.firstEntry; i < hashed.lastEntry; ++i) {
        buckets.push_back(hashed.bucket(
            hashed.cell(table.box(i).min()[0], 0),
            {hashed.cell(table.box(i).min()[1], 1), hashed.cell(table.box(i).min()[2], 2)}));
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
constexpr std::size_t kTwins = 300;        // of them, each a pair with its own

/// Boxes whose rows have one and the same hash of 32 bits.
template <class Scalar>
Attack<Scalar> boxesInRowsOfOneHash() {
    Attack<Scalar> boxes;
    for (const auto [y, z] : rowsOfOneHash()) {
        boxes.push_back(boxInCell<Scalar>(7, y, z));
    }
    EXPECT_GE(boxes.size(), 12'000U);
    boxes.resize(kAttackers);
    return boxes;
}

/// Boxes in rows of any hash, each as far along its row as makes up for it.
template <class Scalar>
Attack<Scalar> boxesThatMakeUpForTheirRows() {
    // Rows are counted from the median of the population.
    Attack<Scalar> boxes(kAttackers);
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
Attack<Scalar> boxesInALongRow() {
    Attack<Scalar> boxes;
    for (std::int32_t i = 0; i < kAttackers; ++i) {
        boxes.push_back(boxInCell<Scalar>(std::int64_t{kBuckets} * (i - kAttackers / 2), 3, 5));
    }
    return boxes;
}

/// Crowds in one bucket, each in a way of its own, with some pairs in it.
template <class Scalar>
std::array<Attack<Scalar>, 3> attacksWithPairs() {
    std::array attacks{boxesInRowsOfOneHash<Scalar>(), boxesThatMakeUpForTheirRows<Scalar>(),
                       boxesInALongRow<Scalar>()};
    for (Attack<Scalar>& boxes : attacks) {
        EXPECT_TRUE(areInOneBucket(boxes));
        for (std::size_t i = 0; i < kTwins; ++i) {
            const Aabb<Scalar> box = boxes[i * 37];
            boxes.push_back(box);
        }
    }
    return attacks;
}

TYPED_TEST(HashedCrowds, InOneBucketAreSweptToo) {
    const auto attacks = attacksWithPairs<TypeParam>();
    for (const Attack<TypeParam>& boxes : attacks) {
        SCOPED_TRACE(testing::Message() << "attack " << &boxes - attacks.data());
        for (const double cellSize : {1.0, 0.0}) {
            Grid<TypeParam> grid(hashedCellsOf(cellSize));
            Pairs<TypeParam> pairs(grid);
            for (const Aabb<TypeParam>& box : boxes) {
                static_cast<void>(grid.add(box));
            }
            pairs.update();
            EXPECT_EQ(pairs.count(), kTwins);
            EXPECT_LT(pairs.lastCost().boxesTested, 5 * detail::kCrowdedBucket * boxes.size())
                << "cells of " << cellSize;
        }
    }
}

/// Every 97th box as a region finds what it does by brute force, asked alone and asked together,
/// within so many tests.
template <class Scalar>
void expectFewTestsAQuery(const Attack<Scalar>& boxes, double cellSize, std::uint64_t most) {
    SCOPED_TRACE(testing::Message() << "cells of " << cellSize);
    Grid<Scalar> grid(hashedCellsOf(cellSize));
    std::vector<Placed<Scalar>> proxies;
    for (const Aabb<Scalar>& box : boxes) {
        proxies.push_back({grid.add(box), box});
    }
    grid.update();
    std::vector<BoxRegion<Scalar>> regions;
    for (std::size_t i = 0; i < boxes.size(); i += 97) {
        regions.push_back({boxes[i]});
    }
    std::vector<CollectKeys<Scalar>> together(regions.size());
    const QueryCost cost = grid.visitEach(std::span<const BoxRegion<Scalar>>(regions),
                                          std::span<CollectKeys<Scalar>>(together));
    EXPECT_LE(cost.boxesTested, most * regions.size());
    for (std::size_t i = 0; i < regions.size(); ++i) {
        CollectKeys<Scalar> expected;
        visitByBruteForce<Scalar>(proxies, regions[i], expected);
        ASSERT_GE(expected.sorted().size(), 1U);
        ASSERT_EQ(differences(find(grid, regions[i]), expected.sorted()), "") << i;
        ASSERT_EQ(differences(together[i].sorted(), expected.sorted()), "") << i;
        CollectCount count;
        ASSERT_LE(grid.visit(regions[i], count).boxesTested, most) << i;
    }
}

// Cells of 1 m are those that the boxes are made for: there the bucket is sorted.
TYPED_TEST(HashedCrowds, InOneBucketAreFoundByQueriesOfFewTests) {
    const auto attacks = attacksWithPairs<TypeParam>();
    for (const Attack<TypeParam>& boxes : attacks) {
        SCOPED_TRACE(testing::Message() << "attack " << &boxes - attacks.data());
        expectFewTestsAQuery<TypeParam>(boxes, 1, 3 * detail::kCrowdedBucket);
        expectFewTestsAQuery<TypeParam>(boxes, 0, 32);
    }
}

// A long region in a sparse world has more cells than there are buckets.
TYPED_TEST(HashedCrowds, AreLookedAtOnceAQueryHoweverLarge) {
    Random random(0x5eed1306);
    std::vector<Placed<TypeParam>> proxies;
    Grid<TypeParam> grid(hashedCellsOf(1));
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

}  // namespace
}  // namespace hashphase::test
