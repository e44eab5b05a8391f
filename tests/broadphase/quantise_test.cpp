// SPDX-License-Identifier: Zlib

#include <broadphase/geometry/quantise.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace hashphase::detail {
namespace {

using test::Random;

template <class Scalar>
class Quantise : public testing::Test {
protected:
    /// Sorted numbers of every magnitude, and each one's neighbours.
    static std::vector<Scalar> hostileNumbers() {
        using Limits = std::numeric_limits<Scalar>;
        std::vector<Scalar> numbers{0, -Scalar(0), Limits::infinity(), -Limits::infinity()};
        Random random(0x5eed0201);
        const auto insert = [&numbers](Scalar x) {
            for (const Scalar y : {x, -x}) {
                numbers.push_back(std::nextafter(y, -Limits::infinity()));
                numbers.push_back(y);
                numbers.push_back(std::nextafter(y, Limits::infinity()));
            }
        };
        for (const Scalar x : {Limits::denorm_min(), Limits::min(), Limits::max(), Scalar(1e-30),
                               Scalar(3e9), Scalar(1e18), Scalar(1e30), Scalar(16777216),
                               Scalar(kCellLimit), Scalar(2147483648)}) {
            insert(x);
        }
        for (int i = 0; i < 4000; ++i) {
            insert(static_cast<Scalar>(random.logBetween(1e-6, 1e10)));
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
}

TYPED_TEST(Quantise, ClampsWhatIsFarOutsideBeforeTheConversion) {
    using Limits = std::numeric_limits<TypeParam>;
    for (const TypeParam far :
         {TypeParam(3e9), TypeParam(1e18), Limits::max(), Limits::infinity()}) {
        EXPECT_EQ(quantise(far, TypeParam(0), TypeParam(1)), kCellLimit);
        EXPECT_EQ(quantise(-far, TypeParam(0), TypeParam(1)), -kCellLimit);
    }
    EXPECT_EQ(quantise(Limits::quiet_NaN(), TypeParam(0), TypeParam(1)), kCellLimit);
}

TYPED_TEST(Quantise, PutsBothZeroesIntoOneCell) {
    EXPECT_EQ(quantise(TypeParam(0), TypeParam(0), TypeParam(1)), 0);
    EXPECT_EQ(quantise(-TypeParam(0), TypeParam(0), TypeParam(1)), 0);
}

TYPED_TEST(Quantise, PutsTheNeighboursOfABorderIntoTheSameOrNeighbouringCells) {
    // Borders k * cell as rounded: whichever side they fall on, the number below is never in a
    // higher cell, and none is more than one cell off.
    using Limits = std::numeric_limits<TypeParam>;
    for (int tenths = 1; tenths <= 1000; ++tenths) {
        const double size = 0.1 * tenths;
        const auto inverse = static_cast<TypeParam>(1 / size);
        for (int k = -999; k <= 999; k += 3) {
            const auto border = static_cast<TypeParam>(k) * static_cast<TypeParam>(size);
            const std::int32_t below =
                quantise(std::nextafter(border, -Limits::infinity()), TypeParam(0), inverse);
            const std::int32_t at = quantise(border, TypeParam(0), inverse);
            const std::int32_t above =
                quantise(std::nextafter(border, Limits::infinity()), TypeParam(0), inverse);
            ASSERT_LE(below, at);
            ASSERT_LE(at, above);
            ASSERT_GE(below, k - 1);
            ASSERT_LE(above, k);
        }
    }
}

}  // namespace
}  // namespace hashphase::detail
