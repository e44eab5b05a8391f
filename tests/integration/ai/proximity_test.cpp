// SPDX-License-Identifier: Zlib

// Who is near an agent, exactly and by cells; in lives of all scenes: ai_scenes_test.cpp.

#include <integration/ai/proximity.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Proximity : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Proximity, Scalars);

TYPED_TEST(Proximity, LeavesOutTheAgentAndNobodyElse) {
    Grid<TypeParam> grid;
    std::vector<ProxyId> found;
    const ProxyId agent = grid.add(makeBox<TypeParam>(0, 0, 0, 2, 2, 2));
    const ProxyId other = grid.add(makeBox<TypeParam>(0, 0, 0, 2, 2, 2));
    findWithin(grid, {1, 1, 1}, 0, found);
    EXPECT_EQ(found, (std::vector{agent, other}));
    findWithin(grid, {1, 1, 1}, 0, found, acceptAll, agent);
    EXPECT_EQ(found, std::vector{other});
    estimateWithin(grid, {1, 1, 1}, 0, found, acceptAll, agent);
    EXPECT_EQ(found, std::vector{other});
}

TYPED_TEST(Proximity, OfBadDataIsNobody) {
    Grid<TypeParam> grid;
    std::vector<ProxyId> found{ProxyId{7, 7}};
    findWithin(grid, {0, 0, 0}, 1, found);
    EXPECT_TRUE(found.empty()) << "an empty grid";
    static_cast<void>(grid.add(makeBox<TypeParam>(0, 0, 0, 0, 0, 0)));
    using Limits = std::numeric_limits<TypeParam>;
    const TypeParam nan = Limits::quiet_NaN();
    const TypeParam infinity = Limits::infinity();
    const auto countBoth = [&](TypeParam x, TypeParam radius) {
        findWithin(grid, {x, 0, 0}, radius, found);
        const std::size_t exact = found.size();
        estimateWithin(grid, {x, 0, 0}, radius, found);
        return std::pair(exact, found.size());
    };
    const std::pair<std::size_t, std::size_t> nobody(0, 0);
    const std::pair<std::size_t, std::size_t> one(1, 1);
    EXPECT_EQ(countBoth(0, -1), nobody);
    EXPECT_EQ(countBoth(0, nan), nobody);
    EXPECT_EQ(countBoth(nan, 1), nobody);
    EXPECT_EQ(countBoth(infinity, infinity), nobody);
    EXPECT_EQ(countBoth(TypeParam(1e30), 1), nobody);
    EXPECT_EQ(countBoth(0, 0), one);
    EXPECT_EQ(countBoth(TypeParam(1e10), TypeParam(1e30)), one);
    EXPECT_EQ(countBoth(TypeParam(1e30), infinity), one);
    EXPECT_EQ(countBoth(5, Limits::max()), one);
}

TYPED_TEST(Proximity, ByCellsNeverMissesAndErrsByLessThanItsBound) {
    // Cells of 1 m, agents of half a metre; the radius in cells, the density in agents a cell.
    GridConfig config;
    config.cellSize = 1;
    for (const double density : {0.1, 1.0, 10.0}) {
        double lastPrecision = 0;
        for (const double radius : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
            SCOPED_TRACE(testing::Message() << density << " a cell, radius " << radius);
            const double side = std::max(2 * radius + 4, std::cbrt(2000 / density));
            Grid<TypeParam> grid(config);
            Random random(0x5eed0a02);
            const auto count = static_cast<int>(density * side * side * side);
            for (int i = 0; i < count; ++i) {
                const auto half = Vector3<double>::Constant(0.25);
                static_cast<void>(grid.add(boxAround<TypeParam>(random.pointIn(0, side), half)));
            }
            grid.update();
            std::vector<ProxyId> found;
            std::vector<ProxyId> estimated;
            std::size_t within = 0;
            std::size_t reported = 0;
            std::size_t missed = 0;
            for (int i = 0; i < 200 && reported < 300000; ++i) {
                const auto point = Vector3<TypeParam>(
                    random.pointIn(radius + 1, side - radius - 1).cast<TypeParam>());
                const auto reach = static_cast<TypeParam>(radius);
                findWithin(grid, point, reach, found);
                estimateWithin(grid, point, reach, estimated);
                std::vector<ProxyId> lost;
                std::set_difference(found.begin(), found.end(), estimated.begin(), estimated.end(),
                                    std::back_inserter(lost));
                within += found.size();
                reported += estimated.size();
                missed += lost.size();
                for (const ProxyId id : estimated) {
                    const auto away = static_cast<double>(grid.box(id).exteriorDistance(point));
                    ASSERT_LE(away, std::sqrt(3.0) * (radius + 1) * 1.00001);
                }
            }
            EXPECT_EQ(missed, 0U) << "recall";
            const double precision = static_cast<double>(within) /
                                     static_cast<double>(std::max<std::size_t>(1, reported));
            // A ball among the cells that its box touches, r + 1/4 + 1/2 on each side on average, as
            // boxes that stick into a cell are in it.
            const double expected =
                4.18879 * std::pow(radius, 3) / std::pow(2 * (radius + 0.25 + 0.5), 3);
            EXPECT_NEAR(precision, expected, 0.08);
            EXPECT_GT(precision, lastPrecision - 0.01) << "grows with the radius";
            lastPrecision = precision;
        }
        EXPECT_GT(lastPrecision, 0.38);
    }
}

}  // namespace
}  // namespace hashphase::test
