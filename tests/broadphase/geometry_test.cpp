// SPDX-License-Identifier: Zlib

// Who is within a distance, from position to position, and who is in the cells around: what the regions say. In
// a grid they are asked in grid_query_test.cpp.

#include <broadphase/aabb.hpp>
#include <broadphase/cells_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/position_region.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace hashphase::test {
namespace {

template <class Scalar>
class PositionQuery : public testing::Test {
protected:
    static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
    static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();

    /// The box from (0, low, 0) to (2, high, 4).
    static Aabb<Scalar> boxAt(Scalar low, Scalar high) {
        return {Vector3<Scalar>(0, low, 0), Vector3<Scalar>(2, high, 4)};
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PositionQuery, Scalars);

TYPED_TEST(PositionQuery, MeasuresFromTheCentreOfTheBox) {
    // The definition, in higher precision.
    Random random(0x5eed0902);
    int within = 0;
    for (int i = 0; i < 20000; ++i) {
        const double scale = random.logBetween(1e-6, 1e6);
        const auto center = Vector3<TypeParam>(random.pointIn(-scale, scale).cast<TypeParam>());
        const auto radius = static_cast<TypeParam>(scale * random.between(0, 2));
        const auto box =
            boxAround<TypeParam>(random.pointIn(-scale, scale), random.pointIn(0, scale));
        const auto low = box.min().template cast<long double>();
        const auto high = box.max().template cast<long double>();
        const long double away = ((low + high) / 2 - center.template cast<long double>()).norm();
        const TypeParam key = PositionRegion<TypeParam>(center, radius).key(box);
        const long double slack =
            16 * scale * static_cast<double>(std::numeric_limits<TypeParam>::epsilon());
        if (away <= radius - slack) {
            ASSERT_GE(key, 0);
            ++within;
        }
        if (away > radius + slack) {
            ASSERT_EQ(key, -1);
        }
        if (key >= 0) {
            ASSERT_NEAR(static_cast<double>(std::sqrt(key)), static_cast<double>(away),
                        static_cast<double>(slack));
        }
    }
    EXPECT_GT(within, 5000);
}

TYPED_TEST(PositionQuery, IsAClosedBall) {
    const auto box = makeBox<TypeParam>(2, 0, 0, 4, 0, 0);
    const auto keyFor = [&box](double x, TypeParam radius) {
        return PositionRegion<TypeParam>({static_cast<TypeParam>(x), 0, 0}, radius).key(box);
    };
    EXPECT_EQ(keyFor(3, 0), 0);
    EXPECT_EQ(keyFor(3, -TypeParam(0)), 0);
    EXPECT_EQ(keyFor(0, 3), 9);
    EXPECT_EQ(keyFor(0, std::nextafter(TypeParam(3), TypeParam(0))), -1);
    EXPECT_EQ(keyFor(0, 2), -1) << "the box is near enough, its centre is not";
    EXPECT_EQ(keyFor(3, -1), -1);
    EXPECT_EQ(keyFor(0, this->kNan), -1);
    EXPECT_EQ(keyFor(static_cast<double>(this->kNan), 9), -1);
    EXPECT_EQ(keyFor(static_cast<double>(this->kInfinity), this->kInfinity), -1);
    EXPECT_EQ(keyFor(0, TypeParam(1e30)), 9) << "the key does not depend on the radius";
    EXPECT_EQ(keyFor(0, this->kInfinity), 9);
}

TYPED_TEST(PositionQuery, OfWhoHasNoPositionFindsNobody) {
    using Limits = std::numeric_limits<TypeParam>;
    const TypeParam most = Limits::max();
    const auto positionIn = [](TypeParam low, TypeParam high) {
        return positionOf(TestFixture::boxAt(low, high));
    };
    EXPECT_EQ(positionIn(-1, 5), Vector3<TypeParam>(1, 2, 2));
    EXPECT_EQ(positionIn(most / 2, most)[1], most / 4 + most / 2);
    EXPECT_EQ(positionIn(-most, most)[1], 0);
    const TypeParam tiny = 3 * Limits::denorm_min();
    EXPECT_EQ(positionIn(tiny, tiny)[1], tiny);
    const PositionRegion<TypeParam> everywhere(Vector3<TypeParam>::Zero(), this->kInfinity);
    EXPECT_GE(everywhere.key(this->boxAt(-most, -most)), 0);
    for (const auto& [low, high] :
         {std::pair(TypeParam(5), TypeParam(4)), std::pair(-this->kInfinity, TypeParam(0)),
          std::pair(-this->kInfinity, this->kInfinity), std::pair(this->kInfinity, this->kInfinity),
          std::pair(this->kNan, TypeParam(1))}) {
        EXPECT_TRUE(positionIn(low, high).array().isNaN().all()) << low << ", " << high;
        EXPECT_EQ(everywhere.key(this->boxAt(low, high)), -1) << low << ", " << high;
    }
}

TYPED_TEST(PositionQuery, OfCellsTakesTheFirstAndTheLastOneWholly) {
    const auto boundsOf = [](double x, double radius, double size) {
        return CellsRegion<TypeParam>(Vector3<TypeParam>(static_cast<TypeParam>(x), 0, 0),
                                      static_cast<TypeParam>(radius), static_cast<TypeParam>(size))
            .bounds();
    };
    const auto expectBounds = [&](double x, double radius, double low, double high) {
        EXPECT_EQ(boundsOf(x, radius, 25).min()[0], low) << x;
        EXPECT_EQ(boundsOf(x, radius, 25).max()[0], high) << x;
    };
    expectBounds(30, 10, 0, 50);
    expectBounds(45, 30, 0, 100);  // begins just before a border
    expectBounds(-3, 1, -25, 0);   // smaller than a cell
    EXPECT_LE(boundsOf(0, 10, 0).min()[0], -10);
    EXPECT_GE(boundsOf(0, 10, 0).min()[0], -11);
    EXPECT_EQ(boundsOf(0, 1, 1e30).max()[0], TypeParam(1e30));
    EXPECT_LE(boundsOf(1e30, 1, 1e-30).min()[0], TypeParam(1e30));
    EXPECT_TRUE(hasNan(boundsOf(0, -1, 1)));
    EXPECT_TRUE(hasNan(boundsOf(static_cast<double>(this->kNan), 1, 1)));
    EXPECT_EQ(boundsOf(0, static_cast<double>(this->kInfinity), 1).max()[0], this->kInfinity);
}

// --- Boxes ---------------------------------------------------------------------------------------

template <class Scalar>
class BoxOf : public testing::Test {};

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
    const Aabb<TypeParam> box = hashphase::boxAround(center, {1, 2, TypeParam(0.5)});
    EXPECT_EQ(box.min(), Vector3<TypeParam>(9, -22, TypeParam(29.5)));
    EXPECT_EQ(box.max(), Vector3<TypeParam>(11, -18, TypeParam(30.5)));
    const Vector3<TypeParam> half(2, 2, 2);
    EXPECT_EQ(hashphase::boxAround(center, half / 2).min(), Vector3<TypeParam>(9, -21, 29));
}

TYPED_TEST(BoxOf, ABallIsTheCubeAroundIt) {
    const Vector3<TypeParam> center(1, 2, 3);
    const Aabb<TypeParam> box = hashphase::boxAround(center, 0.5);
    EXPECT_EQ(box.min(), Vector3<TypeParam>(TypeParam(0.5), TypeParam(1.5), TypeParam(2.5)));
    EXPECT_EQ(box.max(), Vector3<TypeParam>(TypeParam(1.5), TypeParam(2.5), TypeParam(3.5)));
}

}  // namespace
}  // namespace hashphase::test
