// SPDX-License-Identifier: Zlib

#include <demos/viewer/show/window.hpp>

#include <gtest/gtest.h>

namespace hashphase::demos {
namespace {

TEST(FrameRate, LeavesOutTheFirstSecond) {
    FrameRate rate;
    rate.note(0.25);
    rate.note(0.75);
    for (int frame = 0; frame <= 120; ++frame) {
        rate.note(1.5 + frame / 60.0);
    }
    ASSERT_TRUE(rate.perSecond());
    EXPECT_NEAR(*rate.perSecond(), 60, 1e-9);
}

TEST(FrameRate, IsNoneWhereNothingWasShownAfterIt) {
    FrameRate rate;
    EXPECT_FALSE(rate.perSecond());
    for (int frame = 0; frame < 60; ++frame) {
        rate.note(frame / 60.0);
    }
    EXPECT_FALSE(rate.perSecond());
    rate.note(1.25);
    EXPECT_FALSE(rate.perSecond());
    rate.note(1.5);
    EXPECT_EQ(rate.perSecond(), 4);
}

}  // namespace
}  // namespace hashphase::demos
