// SPDX-License-Identifier: Zlib

// On which side of a line a point lies: never wrong, wherever rounding would be.

#include <integration/terrain/detail/orientation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace hashphase::detail {
namespace {

int sign(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

TEST(Orientation, IsPositiveWhenThePointsTurnFromXToZ) {
    EXPECT_EQ(orientation({0, 0}, {2, 0}, {0, 3}), 6);
    EXPECT_EQ(orientation({0, 0}, {0, 3}, {2, 0}), -6);
    EXPECT_EQ(orientation({1, 1}, {2, 2}, {5, 5}), 0);
}

// The classic trap: points a few steps of the last bit away from a diagonal (Kettner, Mehlhorn, Pion,
// Schirra, Yap, "Classroom examples of robustness problems in geometric computations", 2008).
TEST(Orientation, HasTheExactSignNextToALine) {
    constexpr std::int64_t kScale = std::int64_t{1} << 53;
    const std::int64_t half = kScale / 2;
    int disagreements = 0;
    for (std::int64_t i = 0; i < 128; ++i) {
        for (std::int64_t k = 0; k < 128; ++k) {
            const Point2 a{std::ldexp(static_cast<double>(half + i), -53),
                           std::ldexp(static_cast<double>(half + k), -53)};
            const Point2 b{12, 12};
            const Point2 c{24, 24};
            // b and c lie on the diagonal: the sign is that of how far a lies off it.
            const int expected = sign(static_cast<double>(k - i));
            ASSERT_EQ(sign(orientation(a, b, c)), expected) << i << ", " << k;
            ASSERT_EQ(sign(orientation(b, c, a)), expected) << i << ", " << k;
            const double rounded = (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
            disagreements += sign(rounded) != sign(orientation(a, b, c)) ? 1 : 0;
        }
    }
    EXPECT_GT(disagreements, 100);  // or this would be no test
}

TEST(Orientation, IsTheSameForNumbersOfVeryDifferentSizes) {
    // 2^-60 to the left of the line through (2^60, 2^60).
    const double large = std::ldexp(1.0, 60);
    const double small = std::ldexp(1.0, -60);
    EXPECT_GT(orientation({0, 0}, {large, large}, {0, small}), 0);
    EXPECT_LT(orientation({0, 0}, {large, large}, {small, 0}), 0);
    EXPECT_EQ(orientation({0, 0}, {large, large}, {small, small}), 0);
    EXPECT_GT(orientation({-large, -large}, {large, large}, {-small, 0}), 0);
}

}  // namespace
}  // namespace hashphase::detail
