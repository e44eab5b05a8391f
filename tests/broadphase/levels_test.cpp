// SPDX-License-Identifier: Zlib

#include <broadphase/hash/levels.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hashphase::detail {
namespace {

using test::boxAround;
using test::Random;

void addCubes(SizeCensus& census, Random& random, int count, double size, double spread) {
    const Vector3<double> half = Vector3<double>::Constant(size / 2);
    for (int i = 0; i < count; ++i) {
        census.add(boxAround<double>(random.pointIn(-spread / 2, spread / 2), half));
    }
}

/// The finest cells that are large enough for proxies of `size`.
double cellSizeFor(const LevelSizes& levels, double size) {
    for (int i = 0; i < levels.count; ++i) {
        if (levels.cellSize[static_cast<std::size_t>(i)] >= size) {
            return levels.cellSize[static_cast<std::size_t>(i)];
        }
    }
    return std::numeric_limits<double>::infinity();
}

void expectAscending(const LevelSizes& levels) {
    for (int i = 1; i < levels.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        EXPECT_LT(levels.cellSize[at - 1], levels.cellSize[at]);
    }
}

TEST(AutomaticLevels, OfOneSizeAreOneLevelALittleAboveIt) {
    for (const double size : {1e-3, 0.3, 1.0, 2.0, 500.0}) {
        Random random(0x5eed0301);
        SizeCensus census;
        addCubes(census, random, 10000, size, 40 * size);
        const LevelSizes levels = census.cheapestLevels();
        ASSERT_EQ(levels.count, 1) << size;
        EXPECT_GE(levels.cellSize[0], size);
        EXPECT_LE(levels.cellSize[0], 2 * size);
    }
}

TEST(AutomaticLevels, AreFlatAcrossATerrainAndNotInAFilledSpace) {
    for (int thinAxis = 0; thinAxis < 3; ++thinAxis) {
        Random random(0x5eed0310);
        SizeCensus terrain;
        for (int i = 0; i < 10000; ++i) {
            Vector3<double> center = random.pointIn(-200, 200);
            center[thinAxis] /= 40;
            terrain.add(boxAround<double>(center, {1, 1, 1}));
        }
        const LevelSizes levels = terrain.cheapestLevels();
        ASSERT_EQ(levels.count, 1);
        // Rows run along x, where cells cost no look-ups.
        EXPECT_EQ(levels.flatAxes[0], thinAxis == 0 ? 0 : 1 << thinAxis);
    }
    Random random(0x5eed0311);
    SizeCensus space;
    addCubes(space, random, 10000, 1, 30);
    EXPECT_EQ(space.cheapestLevels().flatAxes[0], 0);
}

// Along an axis that few piles share, all of them would be read for each.
TEST(AutomaticLevels, AreNotFlatAcrossHighPilesThatLieFarApart) {
    Random random(0x5eed0312);
    SizeCensus census;
    for (int pile = 0; pile < 8; ++pile) {
        const Vector3<double> away = random.pointIn(-5000, 5000);
        for (int i = 0; i < 1250; ++i) {
            census.add(boxAround<double>(away + random.pointIn(0, 12.5), {0.5, 0.5, 0.5}));
        }
    }
    const LevelSizes levels = census.cheapestLevels();
    ASSERT_EQ(levels.count, 1);
    EXPECT_EQ(levels.flatAxes[0], 0);
}

TEST(AutomaticLevels, ListAFewHugeBoxesAmongManySmallOnes) {
    Random random(0x5eed0302);
    SizeCensus census;
    addCubes(census, random, 10000, 1, 40);
    addCubes(census, random, 5, 1e6, 40);
    const LevelSizes levels = census.cheapestLevels();
    ASSERT_GE(levels.count, 1);
    EXPECT_LE(levels.cellSize[0], 2);
    EXPECT_EQ(cellSizeFor(levels, 1e6), std::numeric_limits<double>::infinity());
}

TEST(AutomaticLevels, GiveManyLargeBoxesALevelOfTheirOwn) {
    Random random(0x5eed0303);
    SizeCensus census;
    // A cell for the large ones holds a hundred small ones.
    addCubes(census, random, 50000, 0.1, 100);
    addCubes(census, random, 500, 10, 100);
    const LevelSizes levels = census.cheapestLevels();
    expectAscending(levels);
    EXPECT_GE(levels.count, 2);
    EXPECT_LT(cellSizeFor(levels, 10), 40);
    EXPECT_LT(cellSizeFor(levels, 0.1), cellSizeFor(levels, 10));
}

TEST(AutomaticLevels, SpreadPointsOverCellsThoughTheyHaveNoSize) {
    Random random(0x5eed0304);
    SizeCensus census;
    addCubes(census, random, 10000, 0, 100);
    const LevelSizes levels = census.cheapestLevels();
    ASSERT_EQ(levels.count, 1);
    // A cell holds a few: neither all of them nor one in thousands.
    const double cells = std::pow(100 / levels.cellSize[0], 3);
    EXPECT_GE(cells, 10000 / 20);
    EXPECT_LE(cells, 10000 * 20);
}

TEST(AutomaticLevels, AreNotSpoiledByASingleFarOutlier) {
    for (const double distance : {1e6, 1e12, 1e30}) {
        Random random(0x5eed0305);
        SizeCensus census;
        census.add(
            boxAround<double>(Vector3<double>::Constant(distance), Vector3<double>::Constant(0.5)));
        addCubes(census, random, 10000, 0, 100);
        ASSERT_EQ(census.cheapestLevels().count, 1);
        EXPECT_LE(census.cheapestLevels().cellSize[0], 20);
        EXPECT_LT(std::abs(census.middle()[0]), 50);
    }
}

TEST(AutomaticLevels, CoverAllSizesOfAWideMixture) {
    Random random(0x5eed0306);
    SizeCensus census;
    for (int i = 0; i < 20000; ++i) {
        const double half = random.logBetween(0.5e-3, 0.5e3);
        census.add(boxAround<double>(random.pointIn(-500, 500), Vector3<double>::Constant(half)));
    }
    const LevelSizes levels = census.cheapestLevels();
    expectAscending(levels);
    EXPECT_GE(levels.count, 2);
    EXPECT_LE(levels.count, kMaxLevels);
    LevelSizes single;
    single.count = 1;
    single.cellSize[0] = 1024;
    EXPECT_LT(census.modelledCost(levels), census.modelledCost(single));
}

TEST(AutomaticLevels, AreTheCheapestOfAllUnderTheirOwnModel) {
    Random random(0x5eed0307);
    SizeCensus census;
    addCubes(census, random, 3000, 1, 60);
    addCubes(census, random, 300, 6, 60);
    addCubes(census, random, 30, 30, 60);
    const double least = census.modelledCost(census.cheapestLevels());
    for (int i = 0; i < 500; ++i) {
        LevelSizes other;
        other.count = 1 + static_cast<int>(random.below(3));
        double size = random.logBetween(1, 64);
        for (int level = 0; level < other.count; ++level) {
            // Quarter octaves, as the choice has them.
            other.cellSize[static_cast<std::size_t>(level)] = size;
            size *= random.between(1.5, 8);
        }
        EXPECT_LE(least, census.modelledCost(other) * (1 + 1e-9));
    }
}

TEST(AutomaticLevels, OfHostileBoxesAndOfTheWholeRangeOfNumbersAreFinite) {
    const double extreme = std::numeric_limits<double>::max() * 0.9;
    for (const bool areHostile : {false, true}) {
        Random random(0x5eed0308);
        SizeCensus census;
        for (int i = 0; i < 5000; ++i) {
            if (areHostile) {
                census.add(test::hostileBox<float>(random));
                census.add(test::hostileBox<double>(random));
            } else {
                census.add(boxAround<double>(random.pointIn(-extreme, extreme), {1, 1, 1}));
            }
        }
        const LevelSizes levels = census.cheapestLevels();
        expectAscending(levels);
        for (int i = 0; i < levels.count; ++i) {
            const double size = levels.cellSize[static_cast<std::size_t>(i)];
            EXPECT_TRUE(std::isfinite(size) && size > 0) << size;
        }
        for (const double x : census.middle()) {
            EXPECT_TRUE(std::isfinite(x));
        }
    }
}

TEST(AutomaticLevels, OfAPopulationSpreadOverDenormalNumbersAreFoundInTheEnd) {
    for (double spread = 1; spread > 0; spread /= 2) {
        SizeCensus census;
        for (int i = 0; i < 400; ++i) {
            const Vector3<double> corner = Vector3<double>::Constant(i % 2 == 0 ? 0 : spread);
            census.add(Aabb<double>(corner, corner));
        }
        EXPECT_GT(census.cheapestLevels().cellSize[0], 0) << spread;
    }
}

TEST(AutomaticLevels, OfNothingAreNone) {
    SizeCensus census;
    EXPECT_EQ(census.cheapestLevels().count, 0);
    EXPECT_EQ(census.middle(), (std::array<double, 3>{0, 0, 0}));
}

TEST(AutomaticLevels, AreChosenAnewAfterClear) {
    const auto chosen = [](SizeCensus& census) {
        Random random(0x5eed030b);
        addCubes(census, random, 3000, 1, 40);
        addCubes(census, random, 3000, 7, 400);
        return census.cheapestLevels().cellSize;
    };
    SizeCensus fresh;
    SizeCensus used;
    Random random(0x5eed030a);
    addCubes(used, random, 10000, 50, 4000);
    used.clear();
    EXPECT_EQ(chosen(used), chosen(fresh));
}

TEST(FixedLevels, BeginAtTheGivenSizeAndGrowByTheRatio) {
    const LevelSizes levels = fixedLevels(0.5, 4);
    ASSERT_EQ(levels.count, kMaxLevels);
    EXPECT_EQ(levels.cellSize[0], 0.5);
    for (int i = 1; i < levels.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        EXPECT_EQ(levels.cellSize[at], 4 * levels.cellSize[at - 1]);
    }
}

TEST(FixedLevels, EndWhereNumbersDo) {
    const LevelSizes levels = fixedLevels(1e28, 64);
    ASSERT_EQ(levels.count, 2);
    EXPECT_LE(levels.cellSize[1], 1e30);
}

}  // namespace
}  // namespace hashphase::detail
