// SPDX-License-Identifier: Zlib

// How many proxies share a cell of a given size, and which cell a coordinate is in.

#include <broadphase/geometry/quantise.hpp>
#include <broadphase/hash/density_estimate.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hashphase::detail {
namespace {

using test::Random;
using Point = std::array<double, 3>;
using Points = std::vector<Point>;

constexpr AxisSet kNone = 0b000;
constexpr AxisSet kFlatY = 0b010;
constexpr AxisSet kFlatYZ = 0b110;

void scatter(Points& points, Random& random, int count, const Point& corner, const Point& extent) {
    for (int i = 0; i < count; ++i) {
        const Vector3<double> at = random.pointIn(0, 1);
        points.push_back({corner[0] + at[0] * extent[0], corner[1] + at[1] * extent[1],
                          corner[2] + at[2] * extent[2]});
    }
}

/// The definition: of all pairs, those whose cells are the same; cells begin anywhere.
double shareByPairs(const Points& points, double size, AxisSet flat) {
    double same = 0;
    double all = 0;
    for (const double begin : {0.0, 0.21, 0.43, 0.77}) {
        for (std::size_t a = 0; a < points.size(); ++a) {
            for (std::size_t b = a + 1; b < points.size(); ++b) {
                bool isSame = true;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const bool isFlat = ((flat >> axis) & 1) != 0;
                    isSame = isSame && (isFlat || std::floor(points[a][axis] / size + begin) ==
                                                      std::floor(points[b][axis] / size + begin));
                }
                same += isSame ? 1 : 0;
                all += 1;
            }
        }
    }
    return same / all;
}

TEST(DensityEstimate, IsTheShareOfPairsInOneCell) {
    Random random(0x5eed0c01);
    Points points;
    scatter(points, random, 700, {-20, 3, 100}, {40, 10, 20});
    scatter(points, random, 300, {5, 5, 105}, {4, 4, 4});
    DensityEstimate crowding;
    crowding.measure(points, {-20, 3, 100}, {20, 13, 120});
    for (const AxisSet flat : {kNone, kFlatY, AxisSet{0b100}, kFlatYZ}) {
        for (const double size : {1.5, 3.0, 6.0, 12.0}) {
            const double expected = shareByPairs(points, size, flat);
            const double share = crowding.shareInCell(size, flat);
            EXPECT_GT(share, 0.6 * expected) << size << ", flat " << int{flat};
            EXPECT_LT(share, 1.6 * expected) << size << ", flat " << int{flat};
        }
    }
    EXPECT_EQ(crowding.shareInCell(1e6, kNone), 1);
}

TEST(DensityEstimate, OfPilesFarApartIsThatOfOnePile) {
    Random random(0x5eed0c02);
    Points points;
    for (int pile = 0; pile < 20; ++pile) {
        scatter(points, random, 100, {500.0 * pile, 0, -300.0 * pile}, {10, 10, 10});
    }
    DensityEstimate crowding;
    crowding.measure(points, {0, 0, -6000}, {10000, 10, 10});
    // A cell of 5 m has an eighth of a pile, which is a twentieth of all.
    EXPECT_NEAR(std::log2(crowding.shareInCell(5, kNone)), std::log2(1.0 / 160), 1);
}

// Where too few of the sample share a cell to be counted.
TEST(DensityEstimate, FallsWithTheVolumeOfSmallCells) {
    Random random(0x5eed0c03);
    Points points;
    scatter(points, random, 2000, {0, 0, 0}, {100, 100, 100});
    DensityEstimate crowding;
    crowding.measure(points, {0, 0, 0}, {100, 100, 100});
    for (const double size : {10.0, 3.0, 1.0}) {
        const double share = crowding.shareInCell(size, kNone);
        EXPECT_NEAR(std::log2(share), 3 * std::log2(size / 100), 2.5) << size;
        EXPECT_NEAR(std::log2(crowding.shareInCell(size / 2, kNone) / share), -3, 0.8) << size;
    }
}

TEST(DensityEstimate, OfPointsAtOnePlaceIsWhole) {
    const Points points(100, Point{1, 2, 3});
    DensityEstimate crowding;
    crowding.measure(points, {0, 0, 0}, {10, 10, 10});
    EXPECT_NEAR(crowding.shareInCell(1e-9, kNone), 1, 1e-9);
    crowding.measure(points, {1, 2, 3}, {1, 2, 3});
    EXPECT_EQ(crowding.shareInCell(1e-9, kNone), 1);
}

TEST(DensityEstimate, DoesNotCountWhatIsFarOutside) {
    Random random(0x5eed0c04);
    Points points;
    scatter(points, random, 900, {0, 0, 0}, {10, 10, 10});
    DensityEstimate alone;
    alone.measure(points, {0, 0, 0}, {10, 10, 10});
    for (int i = 0; i < 100; ++i) {
        points.push_back({1e30, -1e30, 1e300});
    }
    DensityEstimate crowding;
    crowding.measure(points, {0, 0, 0}, {10, 10, 10});
    EXPECT_NEAR(crowding.shareInCell(2, kNone) / alone.shareInCell(2, kNone), 0.81, 0.02);
}

TEST(DensityEstimate, OfNothingOrOfNumbersAtTheirEndsIsAShare) {
    DensityEstimate crowding;
    crowding.measure({}, {0, 0, 0}, {0, 0, 0});
    EXPECT_EQ(crowding.shareInCell(1, kNone), 1);
    constexpr double most = std::numeric_limits<double>::max();
    Points points{{most, most, most}, {-most, -most, -most}, {0, 0, 0}};
    crowding.measure(points, {-most, -most, -most}, {most, most, most});
    for (const double size : {1e-300, 1.0, 1e300}) {
        const double share = crowding.shareInCell(size, kNone);
        EXPECT_TRUE(share >= 0 && share <= 1) << share;
    }
}

// --- Cells of coordinates ------------------------------------------------------------------------

template <class Scalar>
class Quantise : public testing::Test {
protected:
    using Limits = std::numeric_limits<Scalar>;

    static Scalar below(Scalar x) { return std::nextafter(x, -Limits::infinity()); }
    static Scalar above(Scalar x) { return std::nextafter(x, Limits::infinity()); }

    /// Sorted numbers of every magnitude, and each one's neighbours.
    static std::vector<Scalar> hostileNumbers() {
        std::vector<Scalar> magnitudes{Limits::denorm_min(), Limits::min(),    Limits::max(),
                                       Scalar(1e-30),        Scalar(3e9),      Scalar(1e18),
                                       Scalar(1e30),         Scalar(16777216), Scalar(kCellLimit),
                                       Scalar(2147483648)};
        test::Random random(0x5eed0201);
        for (int i = 0; i < 4000; ++i) {
            magnitudes.push_back(static_cast<Scalar>(random.logBetween(1e-6, 1e10)));
        }
        std::vector<Scalar> numbers{0, -Scalar(0), Limits::infinity(), -Limits::infinity()};
        for (const Scalar x : magnitudes) {
            numbers.insert(numbers.end(), {below(x), x, above(x), below(-x), -x, above(-x)});
        }
        std::sort(numbers.begin(), numbers.end());
        return numbers;
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Quantise, Scalars);

TYPED_TEST(Quantise, NeverDecreasesWhateverTheNumbers) {
    const std::vector<TypeParam> numbers = this->hostileNumbers();
    for (const TypeParam origin : {TypeParam(0), TypeParam(0.1), TypeParam(-1e6), TypeParam(3e9)}) {
        for (const double size : {1e-30, 1e-3, 0.1, 1.0, 7.0, 1e4, 1e30}) {
            const auto inverse = static_cast<TypeParam>(1 / size);
            std::int32_t previous = -kCellLimit;
            for (const TypeParam x : numbers) {
                const std::int32_t cell = quantise(x, origin, inverse);
                ASSERT_LE(previous, cell) << x << " - " << origin << " in cells of " << size;
                ASSERT_LE(cell, kCellLimit);
                previous = cell;
            }
        }
    }
}

TYPED_TEST(Quantise, IsTheFloorWhereNothingIsRounded) {
    for (int eighths = -4000; eighths <= 4000; ++eighths) {
        const auto x = static_cast<TypeParam>(eighths) / 8;
        EXPECT_EQ(quantise(x, TypeParam(0), TypeParam(1)),
                  static_cast<std::int32_t>(std::floor(x)));
        EXPECT_EQ(quantise(x, TypeParam(16), TypeParam(0.25)),
                  static_cast<std::int32_t>(std::floor((x - 16) / 4)));
    }
    EXPECT_EQ(quantise(-TypeParam(0), TypeParam(0), TypeParam(1)), 0);
}

// Borders k * cell as rounded: whichever side they fall on, the number below is never in a higher cell, and
// none is more than one cell off.
TYPED_TEST(Quantise, PutsTheNeighboursOfABorderIntoTheSameOrNeighbouringCells) {
    for (int tenths = 1; tenths <= 1000; ++tenths) {
        const double size = 0.1 * tenths;
        const auto inverse = static_cast<TypeParam>(1 / size);
        for (int k = -999; k <= 999; k += 3) {
            const auto border = static_cast<TypeParam>(k) * static_cast<TypeParam>(size);
            const std::int32_t below = quantise(this->below(border), TypeParam(0), inverse);
            const std::int32_t at = quantise(border, TypeParam(0), inverse);
            const std::int32_t above = quantise(this->above(border), TypeParam(0), inverse);
            ASSERT_LE(below, at);
            ASSERT_LE(at, above);
            ASSERT_GE(below, k - 1);
            ASSERT_LE(above, k);
        }
    }
}

TYPED_TEST(Quantise, ClampsWhatIsFarOutsideBeforeTheConversion) {
    for (const TypeParam far : {TypeParam(3e9), TypeParam(1e18), TestFixture::Limits::max(),
                                TestFixture::Limits::infinity()}) {
        EXPECT_EQ(quantise(far, TypeParam(0), TypeParam(1)), kCellLimit);
        EXPECT_EQ(quantise(-far, TypeParam(0), TypeParam(1)), -kCellLimit);
    }
    EXPECT_EQ(quantise(TestFixture::Limits::quiet_NaN(), TypeParam(0), TypeParam(1)), kCellLimit);
}

}  // namespace
}  // namespace hashphase::detail
