// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/palette.hpp>

#include <gtest/gtest.h>

#include <cstdlib>

namespace hashphase::demos {
namespace {

/// Of all channels together, from 0 to 765.
int differenceOf(Colour one, Colour other) {
    return std::abs(one.red - other.red) + std::abs(one.green - other.green) +
           std::abs(one.blue - other.blue);
}

TEST(Palette, HasAColourForEachOfSixteenKinds) {
    for (const Theme theme : {Theme::light, Theme::dark}) {
        for (std::size_t kind = 0; kind < kMostKinds; ++kind) {
            for (std::size_t other = 0; other < kind; ++other) {
                EXPECT_GT(differenceOf(kindColour(theme, kind), kindColour(theme, other)), 50)
                    << kind << " and " << other;
            }
        }
        EXPECT_EQ(kindColour(theme, 0), qualitativeColours(theme)[0]);
        EXPECT_EQ(kindColour(theme, 100), kindColour(theme, kMostKinds - 1));
    }
}

}  // namespace
}  // namespace hashphase::demos
