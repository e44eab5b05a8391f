// SPDX-License-Identifier: Zlib
#include <demos/accuracy/binomial.hpp>

#include <gtest/gtest.h>

#include <random>

namespace hashphase::demos {
namespace {

TEST(WilsonInterval, IsTheOneOfTheTextbooks) {
    const ShareInterval half = wilsonInterval(5, 10);
    EXPECT_NEAR(half.low, 0.2366, 1e-4);
    EXPECT_NEAR(half.high, 0.7634, 1e-4);
    const ShareInterval many = wilsonInterval(300, 1000);
    EXPECT_NEAR(many.low, 0.2724, 1e-4);
    EXPECT_NEAR(many.high, 0.3291, 1e-4);
}

TEST(WilsonInterval, HoldsZeroWithoutAHitAndOneWhereAllHit) {
    EXPECT_EQ(wilsonInterval(0, 10).low, 0);
    EXPECT_NEAR(wilsonInterval(0, 10).high, 0.2775, 1e-4);
    EXPECT_EQ(wilsonInterval(10, 10).high, 1);
    EXPECT_NEAR(wilsonInterval(10, 10).low, 0.7225, 1e-4);
    EXPECT_GT(wilsonInterval(1, 1).low, 0);
}

TEST(WilsonInterval, HoldsTheTrueShareNineteenTimesInTwenty) {
    std::mt19937_64 random(7);
    constexpr double kShare = 0.03;
    constexpr int kExperiments = 2000;
    std::binomial_distribution<std::uint64_t> hits(400, kShare);
    int held = 0;
    for (int i = 0; i < kExperiments; ++i) {
        held += wilsonInterval(hits(random), 400).contains(kShare) ? 1 : 0;
    }
    EXPECT_NEAR(held, 0.95 * kExperiments, 0.02 * kExperiments);
}

}  // namespace
}  // namespace hashphase::demos
