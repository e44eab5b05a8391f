// SPDX-License-Identifier: Zlib

#include <broadphase/aabb.hpp>
#include <broadphase/grid.hpp>

#include <gtest/gtest.h>

#include <type_traits>

namespace hashphase::test {
namespace {

template <class Scalar>
class BoxOf : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BoxOf, Scalars);

TYPED_TEST(BoxOf, NumbersHasThemAsItsCorners) {
    const auto box = boxBetween<TypeParam>({-1, 2, 0}, {4, 2.5F, 1});
    static_assert(std::is_same_v<decltype(box), const Aabb<TypeParam>>);
    EXPECT_EQ(box.min(), Vector3<TypeParam>(-1, 2, 0));
    EXPECT_EQ(box.max(), Vector3<TypeParam>(4, TypeParam(2.5), 1));
    Grid<TypeParam> grid;
    const ProxyId id = grid.add(boxBetween<TypeParam>({3, 0, 0}, {-3, 0, 0}));
    EXPECT_EQ(grid.box(id).min().x(), 3) << "an inverted box stays as it is";
}

TYPED_TEST(BoxOf, ACentreReachesAsFarToEitherSide) {
    const Vector3<TypeParam> center(10, -20, 30);
    const Aabb<TypeParam> box = boxAround(center, {1, 2, TypeParam(0.5)});
    EXPECT_EQ(box.min(), Vector3<TypeParam>(9, -22, TypeParam(29.5)));
    EXPECT_EQ(box.max(), Vector3<TypeParam>(11, -18, TypeParam(30.5)));
    const Vector3<TypeParam> half(2, 2, 2);
    EXPECT_EQ(boxAround(center, half / 2).min(), Vector3<TypeParam>(9, -21, 29));
}

TYPED_TEST(BoxOf, ABallIsTheCubeAroundIt) {
    const Vector3<TypeParam> center(1, 2, 3);
    const Aabb<TypeParam> box = boxAround(center, 0.5);
    EXPECT_EQ(box.min(), Vector3<TypeParam>(TypeParam(0.5), TypeParam(1.5), TypeParam(2.5)));
    EXPECT_EQ(box.max(), Vector3<TypeParam>(TypeParam(1.5), TypeParam(2.5), TypeParam(3.5)));
}

}  // namespace
}  // namespace hashphase::test
