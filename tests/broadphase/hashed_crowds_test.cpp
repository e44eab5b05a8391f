// SPDX-License-Identifier: Zlib

// Crowds that are all in one bucket of the hash though far apart, and regions of more cells than
// there are buckets. Pairs and queries are exact, and costs are counted.

#include <broadphase/core/limits.hpp>
#include <broadphase/pairs.hpp>
#include <demos/stability/one_bucket.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

using demos::CrowdPlace;

constexpr CrowdPlace kPlaces[] = {CrowdPlace::anywhere, CrowdPlace::longRows};

GridConfig hashedCellsOf(double size) {
    return {.cellSize = size};
}

template <class Scalar>
class HashedCrowds : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HashedCrowds, Scalars);

/// Boxes that are mostly in one bucket, as filed in cells of 1 m.
template <class Scalar>
std::vector<Aabb<Scalar>> crowdAt(CrowdPlace place) {
    const demos::FiledCrowd<Scalar> crowd = demos::crowdInOneBucket<Scalar>(place);
    EXPECT_EQ(crowd.table.validate(), "");
    EXPECT_EQ(crowd.table.levels()[1].kind, detail::LevelKind::hashed);
    EXPECT_GE(2 * crowd.table.largestCell(), crowd.boxes.size()) << "in one bucket";
    EXPECT_GE(crowd.table.levels()[1].sortedCount, 1U);
    return crowd.boxes;
}

TYPED_TEST(HashedCrowds, InOneBucketAreSweptToo) {
    for (const CrowdPlace place : kPlaces) {
        SCOPED_TRACE(testing::Message() << "place " << static_cast<int>(place));
        const std::vector<Aabb<TypeParam>> boxes = crowdAt<TypeParam>(place);
        for (const double cellSize : {1.0, 0.0}) {
            Grid<TypeParam> grid(hashedCellsOf(cellSize));
            Pairs<TypeParam> pairs(grid);
            for (const Aabb<TypeParam>& box : boxes) {
                static_cast<void>(grid.add(box));
            }
            pairs.update();
            EXPECT_EQ(pairs.count(), demos::kCrowdTwins);
            EXPECT_LT(pairs.lastCost().boxesTested, 5 * detail::kCrowdedBucket * boxes.size())
                << "cells of " << cellSize;
        }
    }
}

/// Every 97th box as a region finds what it does by brute force, asked alone and asked together,
/// within so many tests.
template <class Scalar>
void expectFewTestsAQuery(const std::vector<Aabb<Scalar>>& boxes, double cellSize,
                          std::uint64_t most) {
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
    for (const CrowdPlace place : kPlaces) {
        SCOPED_TRACE(testing::Message() << "place " << static_cast<int>(place));
        const std::vector<Aabb<TypeParam>> boxes = crowdAt<TypeParam>(place);
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
