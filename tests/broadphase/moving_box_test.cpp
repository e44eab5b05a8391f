// SPDX-License-Identifier: Zlib

// When moving boxes first touch, against rational numbers.

#include <broadphase/moving_box.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/motion_oracle.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace hashphase::test {
namespace {

template <class Scalar>
class MovingBoxes : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(MovingBoxes, Scalars);

/// Compares with rational numbers, and the two ways round with each other. Returns whether they touch.
template <class Scalar>
bool expectAsRationalsSay(const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) {
    const std::optional<mpq_class> expected = firstContactByRationals(a, b);
    const std::optional<double> actual = firstContact(a, b);
    // Not by get_d(), which cuts off what does not fit. A denormal number that is rounded is off by
    // half a last bit.
    const mpq_class halfLastBit = mpq_class(0x1p-1074) / 2;
    const bool isRight =
        actual.has_value() == expected.has_value() && firstContact(b, a) == actual &&
        (!actual || (abs(mpq_class(*actual) - *expected) <= 1e-15 * *expected + halfLastBit &&
                     (*actual == 0) == overlaps(a.box, b.box)));
    EXPECT_TRUE(isRight) << actual.value_or(-1) << " for " << (expected ? expected->get_d() : -1)
                         << ": " << a.box.min().transpose() << " to " << a.box.max().transpose()
                         << " by " << a.displacement.transpose() << "; " << b.box.min().transpose()
                         << " to " << b.box.max().transpose() << " by "
                         << b.displacement.transpose();
    return actual.has_value();
}

TYPED_TEST(MovingBoxes, TouchWhenRationalsSaySoWhereTiesAbound) {
    Random random(0x5eed0c01);
    const auto drawCorner = [&random](double reach) -> Vector3<double> {
        return random.pointIn(-reach, reach + 1).array().floor().matrix();
    };
    int touching = 0;
    for (int i = 0; i < 200'000 && !this->HasFailure(); ++i) {
        const auto draw = [&] {
            const Vector3<double> low = drawCorner(4);
            const Vector3<double> size = random.pointIn(0, 3).array().floor().matrix();
            const Vector3<double> high = low + size;
            const Vector3<double> way = drawCorner(6);
            return MovingBox<TypeParam>{{low.cast<TypeParam>(), high.cast<TypeParam>()},
                                        way.cast<TypeParam>()};
        };
        const MovingBox<TypeParam> a = draw();
        touching += expectAsRationalsSay(a, draw()) ? 1 : 0;
    }
    EXPECT_GT(touching, 5'000);
    EXPECT_LT(touching, 180'000);
}

/// From one box of the scene towards another one, by as much as it takes or thereabouts.
template <class Scalar>
MovingBox<Scalar> drawMoving(const BoxScene<Scalar>& scene, Random& random) {
    const Aabb<Scalar> box = scene.draw(random);
    const Aabb<Scalar> target = scene.draw(random);
    const auto share = static_cast<Scalar>(random.between(0, 2));
    return {box, (target.min() - box.max()) * share};
}

TYPED_TEST(MovingBoxes, TouchWhenRationalsSaySoInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        Random random(0x5eed0c02);
        for (int i = 0; i < 5000 && !this->HasFailure(); ++i) {
            const MovingBox<TypeParam> a = drawMoving(scene, random);
            const MovingBox<TypeParam> still{scene.draw(random)};
            expectAsRationalsSay(a, drawMoving(scene, random));
            // Which touches nothing outside of the box around the way.
            const bool touches = expectAsRationalsSay(a, still);
            ASSERT_TRUE(!touches || overlaps(sweptBounds(a), still.box));
            // Those that do not move touch when they overlap.
            expectAsRationalsSay(MovingBox<TypeParam>{a.box}, still);
        }
    }
}

TYPED_TEST(MovingBoxes, ThatGrazeTouchAtNoDistanceAndNotAtOneUlp) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed0c03);
    for (int i = 0; i < 20'000; ++i) {
        // Past the upper edge of a wall, along x and a little along z.
        const auto top = static_cast<TypeParam>(random.logBetween(1e-3, 1e6));
        MovingBox<TypeParam> wall{makeBox<TypeParam>(1, 0, -1, 2, 0, 1)};
        wall.box.max().y() = top;
        const auto passesAt = [&](TypeParam height) {
            MovingBox<TypeParam> bullet{makeBox<TypeParam>(-1, 0, 0, 0, 0, 0)};
            bullet.box.min().y() = height;
            bullet.box.max().y() = 2 * height;
            bullet.displacement = {4, 0, static_cast<TypeParam>(random.between(-0.1, 0.1))};
            return !firstContact(bullet, wall).has_value();
        };
        EXPECT_FALSE(passesAt(top));
        EXPECT_FALSE(passesAt(std::nextafter(top, -Limits::max())));
        EXPECT_TRUE(passesAt(std::nextafter(top, Limits::max())));
    }
}

// Past the edge between two faces: whether it is touched depends on the order of two times that may
// differ by less than a double tells.
TYPED_TEST(MovingBoxes, ThatPassAnEdgeAreToldApartByLessThanRounding) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed0c04);
    int atOnce = 0;
    int oneUlpOff = 0;
    for (int i = 0; i < 20'000 && !this->HasFailure(); ++i) {
        const auto x = static_cast<TypeParam>(random.between(1, 2));
        const auto y = static_cast<TypeParam>(random.between(1, 2));
        // The corner of b goes exactly through the edge of a: leaves along y as it arrives along x.
        const MovingBox<TypeParam> a{makeBox<TypeParam>(0, 0, 0, 1, 1, 1)};
        MovingBox<TypeParam> b{
            {Vector3<TypeParam>(1 + x, 1 - y, 0), Vector3<TypeParam>(2 + x, 1 - y / 2, 1)},
            {-2 * x, 2 * y, 0}};
        const TypeParam through = b.box.min().y();
        for (const TypeParam nudged : {through, std::nextafter(through, Limits::max()),
                                       std::nextafter(through, -Limits::max())}) {
            b.box.min().y() = nudged;
            (expectAsRationalsSay(a, b) ? atOnce : oneUlpOff) += 1;
        }
    }
    EXPECT_GT(atOnce, 10'000);
    EXPECT_GT(oneUlpOff, 10'000);
}

TYPED_TEST(MovingBoxes, TouchAtTheFirstAndAtTheLastMoment) {
    const MovingBox<TypeParam> wall{makeBox<TypeParam>(3, -1, -1, 4, 1, 1)};
    const auto contact = [&wall](TypeParam front, TypeParam way) {
        const MovingBox<TypeParam> bullet{makeBox<TypeParam>(front - 1, 0, 0, front, 0, 0),
                                          Vector3<TypeParam>(way, 0, 0)};
        return firstContact(bullet, wall);
    };
    EXPECT_EQ(contact(3, -5), 0.0);  // and away
    EXPECT_EQ(contact(1, 2), 1.0);   // and no further
    EXPECT_EQ(contact(2, 2), 0.5);
    EXPECT_EQ(contact(2, 200), 1.0 / 200);
    EXPECT_FALSE(contact(1, std::nextafter(TypeParam(2), TypeParam(0))));
    EXPECT_FALSE(contact(std::nextafter(TypeParam(3), TypeParam(0)), -5));
}

TYPED_TEST(MovingBoxes, WithoutAFinitePlaceTouchNothing) {
    using Limits = std::numeric_limits<TypeParam>;
    const MovingBox<TypeParam> good{makeBox<TypeParam>(0, 0, 0, 1, 1, 1)};
    for (const TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
        MovingBox<TypeParam> moving = good;
        moving.displacement.y() = bad;
        EXPECT_FALSE(firstContact(moving, good)) << bad;
        EXPECT_FALSE(firstContact(good, moving)) << bad;
    }
    MovingBox<TypeParam> nowhere = good;
    nowhere.box.min().x() = Limits::quiet_NaN();
    nowhere.displacement.x() = 1;
    EXPECT_FALSE(firstContact(nowhere, good));
}

}  // namespace
}  // namespace hashphase::test
