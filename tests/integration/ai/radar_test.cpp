// SPDX-License-Identifier: Zlib

// How many are where around an agent; in lives of all scenes: ai_scenes_test.cpp.

#include <integration/ai/radar.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace hashphase::test {
namespace {

using Counts = std::vector<std::uint32_t>;

template <class Scalar>
class RadarTest : public testing::Test {
protected:
    static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();

    ProxyId addPoint(Scalar x, Scalar y, Scalar z) {
        const Vector3<Scalar> point(x, y, z);
        return grid.add({point, point});
    }
    Counts scan(const RadarWindow<Scalar>& window) {
        const auto counts = radar.scan(grid, window, 1, [](ProxyId) { return 0U; });
        return {counts.begin(), counts.end()};
    }

    Grid<Scalar> grid;
    Radar<Scalar> radar;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RadarTest, Scalars);

TYPED_TEST(RadarTest, CountsABorderOnceInTheCellAboveIt) {
    for (int x = -3; x <= 3; ++x) {
        for (int z = -3; z <= 3; ++z) {
            this->addPoint(static_cast<TypeParam>(x), static_cast<TypeParam>(100 * x),
                           static_cast<TypeParam>(z));
        }
    }
    RadarWindow<TypeParam> window;
    window.cellSize = 1;
    window.columns = 3;
    window.rows = 3;
    EXPECT_EQ(this->scan(window), Counts(9, 1));
    window.cellSize = 2;
    window.columns = 2;
    window.rows = 2;
    EXPECT_EQ(this->scan(window), (Counts{4, 4, 4, 4}));
    window.heading = TypeParam(0);  // the same window, as its centre is a corner of cells
    EXPECT_EQ(this->scan(window), (Counts{4, 4, 4, 4}));
}

TYPED_TEST(RadarTest, DoesNotFlickerWhileTheAgentMovesWithinItsCell) {
    this->addPoint(5, 0, 5);
    this->addPoint(-25, 0, 5);
    RadarWindow<TypeParam> window;
    window.columns = 7;
    window.rows = 1;
    const Counts expected{1, 0, 0, 1, 0, 0, 0};
    for (const double x : {0.0, 1.0, 5.5, 9.9}) {
        window.center = Vector3<TypeParam>(static_cast<TypeParam>(x), 0, TypeParam(9.5));
        EXPECT_EQ(this->scan(window), expected) << x;
    }
    window.center[0] = 10;
    EXPECT_EQ(this->scan(window), (Counts{0, 0, 1, 0, 0, 0, 0}));
}

TYPED_TEST(RadarTest, TurnsWithTheHeading) {
    // Ahead along the heading is up in rows; to its side is up in columns.
    constexpr auto kQuarter = static_cast<TypeParam>(std::numbers::pi / 2);
    RadarWindow<TypeParam> window;
    window.center = {100, 0, 200};
    window.columns = 3;
    window.rows = 3;
    this->addPoint(100, 0, 210);
    window.heading = TypeParam(0);
    EXPECT_EQ(this->scan(window), (Counts{0, 0, 0, 0, 0, 0, 0, 1, 0})) << "ahead";
    window.heading = kQuarter;  // looks along x
    EXPECT_EQ(this->scan(window), (Counts{0, 0, 0, 1, 0, 0, 0, 0, 0})) << "at its left";
    window.heading = 2 * kQuarter;
    EXPECT_EQ(this->scan(window), (Counts{0, 1, 0, 0, 0, 0, 0, 0, 0})) << "behind";
    window.heading = -kQuarter;
    EXPECT_EQ(this->scan(window), (Counts{0, 0, 0, 0, 0, 1, 0, 0, 0})) << "at its right";
    window.heading = kQuarter / 2;
    EXPECT_EQ(this->scan(window), (Counts{0, 0, 0, 0, 0, 0, 1, 0, 0})) << "ahead, on the left";
}

TYPED_TEST(RadarTest, SeesAllFourCornersWhateverTheHeading) {
    Random random(0x5eed0d03);
    for (int i = 0; i < 200; ++i) {
        RadarWindow<TypeParam> window;
        window.center = random.pointIn(-100, 100).cast<TypeParam>();
        window.columns = 1 + random.below(9);
        window.rows = 1 + random.below(9);
        const double heading = random.between(-7, 7);
        window.heading = static_cast<TypeParam>(heading);
        std::vector<ProxyId> corners;
        for (const auto& [right, ahead] : {std::pair(-1, -1), {-1, 1}, {1, -1}, {1, 1}}) {
            const double column = right * 4.999 * window.columns;
            const double row = ahead * 4.999 * window.rows;
            const double x = column * std::cos(heading) + row * std::sin(heading);
            const double z = row * std::cos(heading) - column * std::sin(heading);
            corners.push_back(this->addPoint(window.center[0] + static_cast<TypeParam>(x), 0,
                                             window.center[2] + static_cast<TypeParam>(z)));
        }
        const Counts counts = this->scan(window);
        ASSERT_EQ(std::accumulate(counts.begin(), counts.end(), 0U), 4U) << heading;
        const std::size_t lastRow = counts.size() - window.columns;
        ASSERT_TRUE(counts.front() > 0 && counts[window.columns - 1] > 0 && counts[lastRow] > 0 &&
                    counts.back() > 0);
        for (const ProxyId corner : corners) {
            this->grid.remove(corner);
        }
        this->grid.update();
    }
}

TYPED_TEST(RadarTest, CountsByGroupAndLayerAndSkipsOtherGroups) {
    const ProxyId low = this->addPoint(0, -5, 0);
    const ProxyId high = this->addPoint(0, 5, 0);
    const ProxyId other = this->addPoint(0, 5, 0);
    this->addPoint(0, 1000, 0);
    RadarWindow<TypeParam> window;
    window.columns = 1;
    window.rows = 1;
    window.layers = 2;
    const auto groupOf = [&](ProxyId id) {
        return id == low || id == high ? 1U : id == other ? 7U : 0U;
    };
    const auto counts = this->radar.scan(this->grid, window, 2, groupOf);
    EXPECT_EQ(Counts(counts.begin(), counts.end()), (Counts{0, 0, 1, 1}));
    window.layers = 0;
    const auto flat = this->radar.scan(this->grid, window, 2, groupOf);
    EXPECT_EQ(Counts(flat.begin(), flat.end()), (Counts{1, 2}));
}

TYPED_TEST(RadarTest, OfBadDataCountsNobody) {
    this->addPoint(0, 0, 0);
    const auto scanned = [&](auto change) {
        RadarWindow<TypeParam> window;
        window.columns = 1;
        window.rows = 1;
        change(window);
        return this->scan(window);
    };
    using W = RadarWindow<TypeParam>;
    EXPECT_EQ(scanned([](W&) {}), Counts{1});
    for (const TypeParam bad : {TypeParam(0), TypeParam(-1), this->kNan, this->kInfinity}) {
        EXPECT_EQ(scanned([bad](W& w) { w.cellSize = bad; }), Counts{0}) << bad;
    }
    for (const TypeParam bad : {this->kNan, this->kInfinity}) {
        EXPECT_EQ(scanned([bad](W& w) { w.center[1] = bad; }), Counts{0}) << bad;
        EXPECT_EQ(scanned([bad](W& w) { w.heading = bad; }), Counts{0}) << bad;
    }
    EXPECT_EQ(scanned([](W& w) { w.rows = 0; }), Counts{});
    EXPECT_EQ(scanned([](W& w) { w.cellSize = TypeParam(1e30); }), Counts{1});
    EXPECT_EQ(scanned([](W& w) { w.center[0] = TypeParam(1e30); }), Counts{0});
    EXPECT_EQ(scanned([](W& w) { w.heading = TypeParam(1e30); }), Counts{1});
    EXPECT_TRUE(this->radar.scan(this->grid, {}, 0, [](ProxyId) { return 0U; }).empty());
}

}  // namespace
}  // namespace hashphase::test
