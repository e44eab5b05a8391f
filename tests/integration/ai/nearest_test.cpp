// SPDX-License-Identifier: Zlib

// The nearest ones, where it is known who they are; in lives of all scenes: ai_scenes_test.cpp.

#include <integration/ai/nearest.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/position_oracles.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Nearest : public testing::Test {
protected:
    using Point = Vector3<Scalar>;
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();

    void expectLikeBruteForce(const Grid<Scalar>& grid, std::span<const Placed<Scalar>> proxies,
                              const Point& point, std::size_t count, Scalar maximalDistance,
                              ProxyFilter filter = acceptAll) {
        findNearest(grid, point, count, maximalDistance, nearest, filter);
        findNearestByBruteForce(proxies, point, count, maximalDistance, expected, filter);
        ASSERT_EQ(nearest, expected)
            << count << " within " << maximalDistance << " of " << point.transpose();
    }

    std::vector<KeyedProxy<Scalar>> nearest;
    std::vector<KeyedProxy<Scalar>> expected;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Nearest, Scalars);

TYPED_TEST(Nearest, LeaveOutWhoAsks) {
    Grid<TypeParam> grid;
    const ProxyId self = grid.add(boxBetween<TypeParam>({0, 0, 0}, {1, 1, 1}));
    const ProxyId other = grid.add(boxBetween<TypeParam>({4, 0, 0}, {5, 1, 1}));
    const auto nearestTo = [&](ProxyId without) {
        findNearest(grid, positionOf(grid.box(self)), 1, 10, this->nearest, acceptAll, without);
        return this->nearest.at(0).id;
    };
    EXPECT_EQ(nearestTo({}), self);
    EXPECT_EQ(nearestTo(self), other);
    EXPECT_EQ(nearestTo(other), self);
}

TYPED_TEST(Nearest, AreTheSameFromFarAwayAndFromTheMiddle) {
    Grid<TypeParam> grid;
    Random random(0x5eed0912);
    std::vector<Placed<TypeParam>> proxies;
    const BoxScene<TypeParam> scene = spreadScene<TypeParam>("evenly spread", 1, 0);
    for (int i = 0; i < 500; ++i) {
        const Aabb<TypeParam> box = scene.draw(random);
        proxies.push_back({grid.add(box), box});
    }
    grid.update();
    const auto farthest = std::numeric_limits<TypeParam>::max() / 4;
    for (const TypeParam away : {TypeParam(0), TypeParam(1e3), TypeParam(1e10), farthest}) {
        for (const std::size_t count : {0, 1, 7, 499, 500, 501}) {
            this->expectLikeBruteForce(grid, proxies, {away, -away, 1}, count, this->kInfinity);
            ASSERT_EQ(this->nearest.size(), std::min<std::size_t>(count, 500));
            this->expectLikeBruteForce(grid, proxies, {away, -away, 1}, count, TypeParam(1e30));
        }
    }
}

TYPED_TEST(Nearest, OfEqualOnesAreThoseWithTheSmallestIds) {
    Grid<TypeParam> grid;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        const int side = i % 2 == 0 ? 5 : -5;
        ids.push_back(grid.add(makeBox<TypeParam>(side - 1, 0, 0, side + 1, 0, 0)));
    }
    for (const bool updated : {false, true}) {
        findNearest(grid, {0, 0, 0}, 3, TypeParam(9), this->nearest);
        const std::vector<KeyedProxy<TypeParam>> first{{25, ids[0]}, {25, ids[1]}, {25, ids[2]}};
        EXPECT_EQ(this->nearest, first);
        if (!updated) {
            grid.update();
        }
    }
}

TYPED_TEST(Nearest, WhoseSquaresOverflowCountAsEquallyFar) {
    Grid<TypeParam> grid;
    const TypeParam far = sizeof(TypeParam) == sizeof(float) ? TypeParam(1e30) : TypeParam(1e200);
    std::vector<Placed<TypeParam>> proxies;
    for (const int times : {3, 1, 2}) {
        const auto box =
            Aabb<TypeParam>(Vector3<TypeParam>(static_cast<TypeParam>(times) * far, 0, 0));
        proxies.push_back({grid.add(box), box});
    }
    // So many others, still farther away, that the search takes its time.
    for (int i = 0; i < 5000; ++i) {
        const auto box = Aabb<TypeParam>(Vector3<TypeParam>(0, TypeParam(5) * far, 0));
        proxies.push_back({grid.add(box), box});
    }
    grid.update();
    const auto isOneOfThree = [](ProxyId id) { return id.index < 3; };
    for (const std::size_t count : {1, 2, 3}) {
        for (const TypeParam most : {this->kInfinity, far * TypeParam(2.5)}) {
            this->expectLikeBruteForce(grid, proxies, {0, 0, 0}, count, most, isOneOfThree);
        }
    }
}

TYPED_TEST(Nearest, OfBadDataIsNobody) {
    Grid<TypeParam> grid;
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    findNearest(grid, {0, 0, 0}, 3, this->kInfinity, this->nearest);
    EXPECT_TRUE(this->nearest.empty()) << "an empty grid";
    static_cast<void>(grid.add(makeBox<TypeParam>(0, 0, 0, 0, 0, 0)));
    const auto countNear = [&](TypeParam x, TypeParam most) {
        findNearest(grid, {x, 0, 0}, 3, most, this->nearest);
        return this->nearest.size();
    };
    EXPECT_EQ(countNear(0, 0), 1U);
    EXPECT_EQ(countNear(0, -1), 0U);
    EXPECT_EQ(countNear(0, nan), 0U);
    EXPECT_EQ(countNear(nan, 1), 0U);
    EXPECT_EQ(countNear(this->kInfinity, this->kInfinity), 0U);
    EXPECT_EQ(countNear(1, this->kInfinity), 1U);
}

TYPED_TEST(Nearest, ReadNoMoreThanAFewCellsAndNeverTheGridOverAndOver) {
    Grid<TypeParam> grid;
    Random random(0x5eed0913);
    constexpr std::uint64_t kCount = 20000;
    for (std::uint64_t i = 0; i < kCount; ++i) {
        static_cast<void>(grid.add(boxAround<TypeParam>(random.pointIn(0, 100), {1, 1, 1})));
    }
    grid.update();
    for (int i = 0; i < 100; ++i) {
        const auto point = Vector3<TypeParam>(random.pointIn(0, 100).cast<TypeParam>());
        QueryCost cost = findNearest(grid, point, 4, this->kInfinity, this->nearest);
        EXPECT_LT(cost.boxesTested, kCount / 20);
        const auto none = [](ProxyId) { return false; };
        cost = findNearest(grid, point, 4, this->kInfinity, this->nearest, none);
        EXPECT_LT(cost.boxesTested, 4 * kCount);
        const Vector3<TypeParam> away = point * TypeParam(1e12);
        cost = findNearest(grid, away, 4, this->kInfinity, this->nearest);
        EXPECT_LT(cost.boxesTested, 4 * kCount);
        EXPECT_EQ(this->nearest.size(), 4U);
    }
}

}  // namespace
}  // namespace hashphase::test
