// SPDX-License-Identifier: Zlib

#include <broadphase/grid.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace hashphase::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The sentence names the field, the value's valid range, and is what the constructors throw.
void expectRefused(const GridConfig& config, const std::string& field, const std::string& range) {
    const std::string error = configError(config);
    EXPECT_NE(error.find(field), std::string::npos) << error;
    EXPECT_NE(error.find(range), std::string::npos) << error;
    const auto expectThrow = [&](auto construct) {
        try {
            construct();
            ADD_FAILURE() << "accepted: " << error;
        } catch (const std::invalid_argument& refused) {
            EXPECT_EQ(refused.what(), error);
        }
    };
    expectThrow([&] { const Grid<float> grid(config); });
    expectThrow([&] { const Grid<double> grid(config); });
}

TEST(GridConfig, DefaultsAreGood) {
    EXPECT_EQ(configError({}), "");
}

TEST(GridConfig, CellSizeIsZeroOrPositiveAndFinite) {
    GridConfig config;
    for (const double bad : {-1.0, -1e-40, 9e-31, 1.1e30, kInfinity, -kInfinity, kNan}) {
        config.cellSize = bad;
        expectRefused(config, "cellSize", "0 (choose automatically) or between 1e-30 and 1e30");
    }
    for (const double good : {0.0, -0.0, 1e-30, 1e-3, 1.0, 1e30}) {
        config.cellSize = good;
        EXPECT_EQ(configError(config), "");
        const Grid<float> asFloat(config);
        const Grid<double> asDouble(config);
    }
}

TEST(GridConfig, LevelRatioIsFrom2To64) {
    GridConfig config;
    for (const double bad : {0.0, 1.0, 1.999, 64.1, -4.0, kInfinity, kNan}) {
        config.levelRatio = bad;
        expectRefused(config, "levelRatio", "between 2 and 64");
    }
    for (const double good : {2.0, 2.5, 64.0}) {
        config.levelRatio = good;
        EXPECT_EQ(configError(config), "");
    }
}

TEST(GridConfig, UpdatesBeforeRestAreFrom1To1000000) {
    GridConfig config;
    for (const std::uint32_t bad : {0U, 1'000'001U, std::numeric_limits<std::uint32_t>::max()}) {
        config.updatesBeforeRest = bad;
        expectRefused(config, "updatesBeforeRest", "between 1 and 1000000");
    }
    for (const std::uint32_t good : {1U, 1'000'000U}) {
        config.updatesBeforeRest = good;
        EXPECT_EQ(configError(config), "");
    }
}

}  // namespace
}  // namespace hashphase::test
