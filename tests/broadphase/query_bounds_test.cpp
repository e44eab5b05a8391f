// SPDX-License-Identifier: Zlib

// The most that a query may cost, however large its region and however the boxes lie: about one test for
// each of them.

#include <broadphase/cells_region.hpp>
#include <broadphase/position_region.hpp>
#include <integration/ai/nearest.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class QueryBounds : public testing::Test {
protected:
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();

    /// Boxes of half a metre between the corners, in cells of the given edge.
    struct World {
        Grid<Scalar> grid;
        std::uint64_t count;
        std::uint32_t largestCell = 0;

        World(std::uint32_t boxes, const Vector3<double>& high, double cellSize)
            : grid(configFor(cellSize)), count(boxes) {
            Random random(0x5eed1101);
            for (std::uint32_t i = 0; i < boxes; ++i) {
                const Vector3<double> at = random.pointIn(Vector3<double>::Zero(), high);
                static_cast<void>(grid.add(boxAround<Scalar>(at, {0.25, 0.25, 0.25})));
            }
            largestCell = grid.update().largestCell;
        }

        /// Many more boxes, far away, each in a cell of 8 m of its own: that they are not looked
        /// at, and that cells do not begin in the middle of the others.
        void addAnchors() {
            for (std::uint64_t i = 0; i <= count; ++i) {
                const Vector3<double> at(1004 + 20.0 * static_cast<double>(i % 1000),
                                         1004 + 20.0 * static_cast<double>(i / 1000), 1004);
                static_cast<void>(grid.add(boxAround<Scalar>(at, {0.25, 0.25, 0.25})));
            }
            largestCell = grid.update().largestCell;
        }

        static GridConfig configFor(double cellSize) {
            GridConfig config;
            config.cellSize = cellSize;
            return config;
        }
    };

    template <class Region>
    static std::size_t expectOneTestEach(const World& world, const Region& region) {
        CollectCount found;
        const QueryCost cost = world.grid.visit(region, found);
        EXPECT_LE(cost.boxesTested, world.count * 5 / 4);
        EXPECT_LE(cost.rowsVisited, world.count);
        if constexpr (requires { region.bounds(); }) {
            constexpr std::uint64_t times = 5;
            const std::vector<Region> regions(times, region);
            std::vector<CollectCount> each(times);
            const QueryCost sum =
                world.grid.visitEach(std::span<const Region>(regions), std::span(each));
            EXPECT_LE(sum.boxesTested, times * world.count * 5 / 4);
            EXPECT_EQ(each[times - 1].count(), found.count());
        }
        return found.count();
    }

    /// Everything, half of everything, and all that is nearly along the x axis.
    static void expectBounds(const World& world, Scalar length) {
        const auto all = Vector3<Scalar>::Constant(Scalar(1e30)).eval();
        const std::size_t count = world.count;
        const auto zero = Vector3<Scalar>::Zero().eval();
        EXPECT_EQ(expectOneTestEach(world, BoxRegion<Scalar>{{-all, all}}), count);
        EXPECT_EQ(expectOneTestEach(world, SphereRegion<Scalar>(zero, Scalar(1e30))), count);
        EXPECT_EQ(expectOneTestEach(world, SphereRegion<Scalar>(zero, kInfinity)), count);
        EXPECT_EQ(expectOneTestEach(world, PositionRegion<Scalar>(all, kInfinity)), count);
        const CellsRegion<Scalar> cells(zero, Scalar(1e30), world.grid.cellSize());
        EXPECT_EQ(expectOneTestEach(world, cells), count);
        Vector3<Scalar> middle = all;
        middle[0] = length / 2;
        expectOneTestEach(world, BoxRegion<Scalar>{{-all, middle}});
        const RayRegion<Scalar> ray({-length, 1, 1}, {2 * length, 1, 1}, {-all, all});
        EXPECT_EQ(expectOneTestEach(world, ray), count);
        using Plane = typename ConvexRegion<Scalar>::Plane;
        const std::vector<Plane> wedge{Plane(Vector3<Scalar>(1, Scalar(1e-3), 0), -length / 4),
                                       Plane(Vector3<Scalar>(-1, 0, Scalar(1e-2)), 3 * length / 4)};
        for (const std::size_t planes : {0U, 1U, 2U}) {
            for (const Containment part : {Containment::touching, Containment::inside}) {
                expectOneTestEach(world,
                                  ConvexRegion<Scalar>(std::span(wedge).first(planes), part));
            }
        }
        std::vector<KeyedProxy<Scalar>> nearest;
        for (const Vector3<Scalar>& from : {zero, all}) {
            const QueryCost cost = findNearest(world.grid, from, 3, kInfinity, nearest);
            EXPECT_EQ(nearest.size(), 3U);
            EXPECT_LE(cost.boxesTested, 4 * world.count);
        }
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(QueryBounds, Scalars);

TYPED_TEST(QueryBounds, HoldInACube) {
    this->expectBounds({4000, {40, 40, 40}, 0}, 40);
    this->expectBounds({4000, {400, 400, 400}, 1}, 400);
}

// Few rows of cells, and each of them so long that it passes every bucket of a hashed table.
TYPED_TEST(QueryBounds, HoldInALongCorridorOfSmallCells) {
    for (const double length : {1e5, 1e8}) {
        this->expectBounds({4000, {length, 25, 25}, 1}, static_cast<TypeParam>(length));
        this->expectBounds({4000, {length, 4, 4}, 1}, static_cast<TypeParam>(length));
        this->expectBounds({4000, {length, 25, 25}, 0}, static_cast<TypeParam>(length));
    }
}

TYPED_TEST(QueryBounds, HoldForAHundredThousandInOneCell) {
    typename TestFixture::World world(102'000, {1, 1, 1}, 8);
    world.addAnchors();
    ASSERT_GE(world.largestCell, 100'000U);
    const auto corner = makeBox<TypeParam>(0, 0, 0, 0.5, 0.5, 0.5);
    EXPECT_GT(this->expectOneTestEach(world, BoxRegion<TypeParam>{corner}), 1000U);
    EXPECT_GT(this->expectOneTestEach(world, RayRegion<TypeParam>({-1, 0, 0}, {2, 1, 1})), 1000U);
    EXPECT_GT(this->expectOneTestEach(world, SphereRegion<TypeParam>({0, 0, 0}, 1)), 1000U);
    CollectCount inCell;
    EXPECT_LE(world.grid.visitCell({0, 0, 0}, inCell).boxesTested, world.count);
    EXPECT_EQ(inCell.count(), world.count);
}

}  // namespace
}  // namespace hashphase::test
