// SPDX-License-Identifier: Zlib

// Boxes of sizes that have broken broadphases: without extent, larger than any cell, of all sizes
// at once, on many cells and levels.

#include <tests/support/box_scenes.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class HardSizes : public testing::Test {
protected:
    static GridConfig cellsOf(double size) {
        GridConfig config;
        config.cellSize = size;
        return config;
    }

    /// What it takes to find all pairs of the boxes, and how many they are.
    static PairCost costOf(const std::vector<Aabb<Scalar>>& boxes, const GridConfig& config = {},
                           std::size_t* pairCount = nullptr) {
        Grid<Scalar> grid(config);
        Pairs<Scalar> pairs(grid);
        for (const Aabb<Scalar>& box : boxes) {
            static_cast<void>(grid.add(box));
        }
        pairs.update([](ProxyId, ProxyId) { return true; });
        if (pairCount != nullptr) {
            *pairCount = pairs.count();
        }
        return pairs.lastCost();
    }

    /// Boxes of which each order of magnitude is as frequent as any other, in a cube whose side is
    /// so many times the largest.
    static std::vector<Aabb<Scalar>> mixture(std::size_t count, double smallest, double largest,
                                             double room = 16) {
        Random random(0x5eed1201);
        std::vector<Aabb<Scalar>> boxes;
        const double side = room * largest;
        while (boxes.size() < count) {
            const double size = random.logBetween(smallest, largest);
            const Vector3<double> center = random.pointIn(0, side);
            boxes.push_back(boxAround<Scalar>(center, Vector3<double>::Constant(size / 2)));
        }
        return boxes;
    }

    /// The same in as large a cube as leaves so many pairs for each box, on average.
    static std::vector<Aabb<Scalar>> mixtureWithPairs(std::size_t count, double smallest,
                                                      double largest, double pairsPerBox) {
        // The mean of a power of the sizes, which are evenly spread in their logarithms.
        const auto mean = [&](int power) {
            const double spread = std::log(largest / smallest);
            return spread == 0
                       ? std::pow(largest, power)
                       : (std::pow(largest, power) - std::pow(smallest, power)) / (power * spread);
        };
        // Of (a + b)^3: two boxes overlap when their centres are no farther apart than (a + b) / 2.
        const double around = 2 * mean(3) + 6 * mean(2) * mean(1);
        const double side = std::cbrt(static_cast<double>(count) * around / (2 * pairsPerBox));
        return mixture(count, smallest, largest, side / largest);
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(HardSizes, Scalars);

// Bullet's planes: 1e18 to all sides in single precision, 1e30 in double.
TYPED_TEST(HardSizes, OfAPlaneCostEachOtherBoxOneTest) {
    constexpr std::uint32_t kCount = 3000;
    const double huge = sizeof(TypeParam) == sizeof(float) ? 1e18 : 1e30;
    Random random(0x5eed1202);
    std::vector<Aabb<TypeParam>> boxes;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        boxes.push_back(boxAround<TypeParam>(random.pointIn(0, 30), random.pointIn(0.3, 0.6)));
    }
    for (const double cellSize : {0.0, 1.0}) {
        const PairCost without = this->costOf(boxes, this->cellsOf(cellSize));
        boxes.push_back(makeBox<TypeParam>(-huge, -huge, -huge, huge, huge, huge));
        const PairCost with = this->costOf(boxes, this->cellsOf(cellSize));
        EXPECT_EQ(with.grid.filed, kCount + 1);
        EXPECT_LE(with.boxesTested, without.boxesTested + kCount + kCount / 20);

        Grid<TypeParam> grid(this->cellsOf(cellSize));
        Pairs<TypeParam> pairs(grid);
        for (const Aabb<TypeParam>& box : boxes) {
            static_cast<void>(grid.add(box));
        }
        std::size_t ofThePlane = 0;
        for (const ProxyPair& pair : pairs.update([](ProxyId, ProxyId) { return true; }).born) {
            ofThePlane += pair.second.index == kCount ? 1 : 0;
        }
        EXPECT_EQ(ofThePlane, kCount) << "paired with everyone";
        boxes.pop_back();
    }
}

TYPED_TEST(HardSizes, OfPointsAndPlatesAreClosedToo) {
    for (const double x : {0.0, 0.1, 1.0, -7.3, 1e6}) {
        std::vector<Aabb<TypeParam>> boxes;
        const Aabb<TypeParam> point = makeBox<TypeParam>(x, x, x, x, x, x);
        for (int i = 0; i < 40; ++i) {
            boxes.push_back(point);
        }
        boxes.push_back(
            makeBox<TypeParam>(x - 1, x, x - 1, x + 1, x, x + 1));          // a plate through it
        boxes.push_back(makeBox<TypeParam>(x, x, x, x + 1, x + 1, x + 1));  // a corner at it
        boxes.push_back(makeBox<TypeParam>(x - 1, x - 1, x - 1, x, x, x));
        boxes.push_back(makeBox<TypeParam>(x, x - 1, x, x, x + 1, x));  // an edge through it
        for (const double cellSize : {0.0, 0.1, 1.0, 100.0}) {
            EXPECT_EQ(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)),
                      44U * 43 / 2);
        }
    }
}

// Each of 27 corners of 8 cells is touched by 8 boxes.
TYPED_TEST(HardSizes, OfACellWholeTouchInTheCornerOfEightOnce) {
    for (const double cellSize : {1.0, 0.1, 0.7}) {
        for (const double first : {-2.0, 97.0, -100'001.0}) {
            std::vector<Aabb<TypeParam>> boxes;
            const auto cell = static_cast<TypeParam>(cellSize);
            for (int i = 0; i < 64; ++i) {
                const Vector3<double> low =
                    Vector3<double>(i % 4, i / 4 % 4, i / 16).array() + first;
                const Vector3<double> high = (low.array() + 1).matrix();
                boxes.emplace_back(low.cast<TypeParam>() * cell, high.cast<TypeParam>() * cell);
            }
            // They share faces, edges and corners.
            EXPECT_EQ(expectPairsOfBruteForce<TypeParam>(boxes, this->cellsOf(cellSize)),
                      144U + 216 + 108);
        }
    }
}

TYPED_TEST(HardSizes, FromAMicrometreToAThousandKilometresPairAsBruteForceSays) {
    EXPECT_GT(expectPairsOfBruteForce<TypeParam>(this->mixture(800, 1e-6, 1e6, 2)), 100U);
}

// As many pairs a box of all sizes as of one. The larger ones are tested with many of the smaller,
// which follow one another in memory: 98 tests a box here instead of 4, in 1.1 times the time
// (tests/benchmarks/run --only '^sizes').
TYPED_TEST(HardSizes, FromAMicrometreToAThousandKilometresCostAHundredTestsABox) {
    for (const double pairsPerBox : {0.1, 1.0}) {
        for (const std::size_t count : {4000U, 20'000U}) {
            SCOPED_TRACE(testing::Message() << pairsPerBox << " pairs a box of " << count);
            const double pairs = pairsPerBox * static_cast<double>(count);
            std::size_t found = 0;
            const PairCost ofOne =
                this->costOf(this->mixtureWithPairs(count, 1, 1, pairsPerBox), {}, &found);
            EXPECT_NEAR(static_cast<double>(found), pairs, pairs / 4);
            const PairCost ofAll =
                this->costOf(this->mixtureWithPairs(count, 1e-6, 1e6, pairsPerBox), {}, &found);
            EXPECT_NEAR(static_cast<double>(found), pairs, pairs / 4);
            EXPECT_LE(ofOne.boxesTested, 6 * count);
            EXPECT_LE(ofAll.boxesTested, 120 * count);
        }
    }
}

// As many of each size lie within twelve of its edges as of any other, and so many more of all
// sizes, that it costs what levels of cells cannot spare; numbers are fine enough for the smallest.
TYPED_TEST(HardSizes, OfAllKindsAtOnePlacePairAsBruteForceSaysAtAFractionOfItsCost) {
    constexpr std::size_t kCount = 4000;
    for (const double largest : {1.0, 1e3, 1e6}) {
        SCOPED_TRACE(largest);
        Random random(0x5eed1205);
        std::vector<Aabb<TypeParam>> boxes;
        while (boxes.size() < kCount) {
            const double size = random.logBetween(1 / largest, largest);
            const Vector3<double> center = random.pointIn(-6, 6) * size;
            boxes.push_back(boxAround<TypeParam>(center, Vector3<double>::Constant(size / 2)));
        }
        const std::size_t pairs = expectPairsOfBruteForce<TypeParam>(boxes);
        EXPECT_GT(pairs, 2 * kCount);
        const std::uint64_t tests = this->costOf(boxes).boxesTested;
        EXPECT_LE(tests, kCount * kCount / 2 / (largest == 1 ? 50 : 4));
        EXPECT_LE(tests, (largest == 1 ? 4 : 120) * (pairs + kCount)) << "for each box and pair";
    }
}

TYPED_TEST(HardSizes, OfThousandsOfCellsAreFiledOnce) {
    Random random(0x5eed1203);
    Grid<TypeParam> grid(this->cellsOf(1));
    std::vector<Placed<TypeParam>> proxies;
    const auto add = [&](const Aabb<TypeParam>& box) { proxies.push_back({grid.add(box), box}); };
    for (int i = 0; i < 2000; ++i) {
        add(boxAround<TypeParam>(random.pointIn(-15, 15), random.pointIn(0.2, 0.5)));
    }
    for (int i = 0; i < 40; ++i) {
        add(boxAround<TypeParam>(random.pointIn(-15, 15), {10, 10, 10}));  // 8,000 cells
    }
    EXPECT_EQ(grid.update().filed, 2040U);
    EXPECT_EQ(grid.validate(), "");
    QueryCost cost;
    for (int i = 0; i < 200; ++i) {
        const BoxRegion<TypeParam> region{boxAround<TypeParam>(random.pointIn(-20, 20), {1, 1, 1})};
        CollectCount count;
        cost += grid.visit(region, count);
        expectLikeBruteForce<TypeParam>(grid, proxies, region);
    }
    EXPECT_LT(cost.rowsVisited, 200U * 30);
}

// Those of a level touch in corners of its cells; those of all levels are around the same corners.
TYPED_TEST(HardSizes, OfThreeLevelsAreOnePairEachHoweverManyCellsTheyShare) {
    PairWorld<TypeParam> world(this->cellsOf(1));
    std::vector<Placed<TypeParam>> proxies;
    Random random(0x5eed1204);
    for (int i = 0; i < 300; ++i) {
        const double size = i % 3 == 0 ? 0.9 : i % 3 == 1 ? 3.6 : 14.4;
        // Around corners of the largest cells, which are corners of the others too.
        const Vector3<double> corner = random.pointIn(0, 3).array().floor().matrix() * 16;
        const Aabb<TypeParam> box =
            boxAround<TypeParam>(corner, Vector3<double>::Constant(size / 2));
        proxies.push_back({world.add(box), box});
    }
    EXPECT_GT(world.update().born.size(), 1000U);
    world.checkThoroughly(proxies);
    // To another corner, and away from everything: PairWorld sees each born and dying once.
    for (const double way : {16.0, 1000.0}) {
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            const double step = way * (way == 16 ? 1 : static_cast<double>(i + 1));
            const Vector3<TypeParam> by(static_cast<TypeParam>(step), 0, 0);
            proxies[i].box = {proxies[i].box.min() + by, proxies[i].box.max() + by};
            world.move(proxies[i].id, proxies[i].box);
            if (i % 3 == 0) {
                world.update();
                ASSERT_NO_FATAL_FAILURE(world.check(proxies));
            }
        }
        world.update();
        ASSERT_NO_FATAL_FAILURE(world.check(proxies));
        EXPECT_EQ(world.pairs.validate(), "");
    }
    EXPECT_EQ(world.pairs.count(), 0U);
}

}  // namespace
}  // namespace hashphase::test
