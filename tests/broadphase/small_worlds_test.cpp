// SPDX-License-Identifier: Zlib

// A world of a few boxes takes a few bytes: what is not used yet is not there yet.

#include <broadphase/neighbours.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class SmallWorlds : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SmallWorlds, Scalars);

TYPED_TEST(SmallWorlds, TakeLittleMemoryWhileTheyAreEmpty) {
    const std::size_t before = bytesHeld();
    Grid<TypeParam> grid;
    Sweeps<TypeParam> sweeps(grid);
    Pairs<TypeParam> pairs(grid, &sweeps);
    const Neighbours<TypeParam> neighbours;
    const RadiusSearch<TypeParam> search;
    EXPECT_EQ(bytesHeld(), before) << "nothing is allocated";
    EXPECT_LT(grid.memoryBytes(), 3584U);
    EXPECT_LT(pairs.memoryBytes(), 2048U);
    EXPECT_LT(sweeps.memoryBytes(), 2048U);
    EXPECT_LT(neighbours.memoryBytes(), 1024U);
    EXPECT_LT(search.memoryBytes(), 1024U);
    // Nor by a frame of nothing.
    pairs.update();
    EXPECT_LT(bytesHeld(), before + 1024);
}

// Told in full: what is held beside the objects is what was allocated.
TYPED_TEST(SmallWorlds, TakeAFewKilobytesForTenBoxes) {
    const std::size_t before = bytesHeld();
    Grid<TypeParam> grid;
    Pairs<TypeParam> pairs(grid);
    for (int i = 0; i < 10; ++i) {
        const Vector3<TypeParam> low(static_cast<TypeParam>(i) * TypeParam(0.9), 0, 0);
        const auto mobility = i == 0 ? Mobility::resting : Mobility::mobile;
        static_cast<void>(grid.add({low, low + Vector3<TypeParam>::Ones()}, mobility));
    }
    EXPECT_EQ(pairs.update().born.size(), 9U);
    CollectCount count;
    grid.visit(RayRegion<TypeParam>({-1, 0, 0}, {99, 0, 0}), count);
    EXPECT_EQ(count.count(), 10U);
    const std::size_t told = grid.memoryBytes() + pairs.memoryBytes();
    EXPECT_LT(told, (sizeof(TypeParam) == sizeof(float) ? 16U : 20U) * 1024U);
    EXPECT_LE(bytesHeld() - before + sizeof(grid) + sizeof(pairs), told);
}

TYPED_TEST(SmallWorlds, GrowToManyBoxesAndShrinkToNoneAndAnswerAsEver) {
    Grid<TypeParam> grid;
    std::vector<ProxyId> ids;
    for (const std::size_t size : {1U, 31U, 32U, 40U, 33U, 400U, 20U, 0U, 50U, 0U, 3U}) {
        while (ids.size() > size) {
            grid.remove(ids.back());
            ids.pop_back();
        }
        while (ids.size() < size) {
            const auto at = static_cast<TypeParam>(ids.size());
            const Vector3<TypeParam> low(at, 0, 0);
            ids.push_back(grid.add({low, low + Vector3<TypeParam>::Constant(TypeParam(0.5))}));
        }
        grid.update();
        ASSERT_EQ(grid.validate(), "") << size;
        CollectCount byBox;
        CollectCount byRay;
        grid.visit(BoxRegion<TypeParam>{makeBox<TypeParam>(0, 0, 0, 1e6, 1, 1)}, byBox);
        grid.visit(RayRegion<TypeParam>({0, 0, 0}, {1e6, 0, 0}), byRay);
        EXPECT_EQ(byBox.count(), size);
        EXPECT_EQ(byRay.count(), size);
    }
}

}  // namespace
}  // namespace hashphase::test
