// SPDX-License-Identifier: Zlib

// When moving boxes first touch, against rational numbers.

#include <broadphase/grid.hpp>
#include <broadphase/moving_box.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/motion_oracle.hpp>
#include <tests/support/oracles.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class MovingBoxes : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(MovingBoxes, Scalars);

template <class Scalar>
Vector3<Scalar> toVector(const Vector3<double>& vector) {
    return vector.cast<Scalar>();
}

/// Compares with rational numbers, and the two ways round with each other.
template <class Scalar>
void expectAsRationalsSay(const MovingBox<Scalar>& a, const MovingBox<Scalar>& b) {
    const std::optional<mpq_class> expected = firstContactByRationals(a, b);
    const std::optional<double> actual = firstContact(a, b);
    const auto describe = [&] {
        return testing::Message() << a.box.min().transpose() << " to " << a.box.max().transpose()
                                  << " by " << a.displacement.transpose() << "; "
                                  << b.box.min().transpose() << " to " << b.box.max().transpose()
                                  << " by " << b.displacement.transpose();
    };
    ASSERT_EQ(actual.has_value(), expected.has_value()) << describe();
    ASSERT_EQ(firstContact(b, a), actual) << describe();
    if (expected) {
        // Not by get_d(), which cuts off what does not fit. A denormal number that is rounded is off by
        // half a last bit.
        const mpq_class error = abs(mpq_class(*actual) - *expected);
        const mpq_class halfLastBit = mpq_class(0x1p-1074) / 2;
        ASSERT_TRUE(error <= 1e-15 * *expected + halfLastBit)
            << *actual << " for " << expected->get_d() << ": " << describe();
        ASSERT_EQ(*actual == 0, overlaps(a.box, b.box)) << describe();
    }
}

TYPED_TEST(MovingBoxes, TouchWhenRationalsSaySoWhereTiesAbound) {
    Random random(0x5eed0c01);
    const auto drawCorner = [&random](double reach) -> Vector3<double> {
        return random.pointIn(-reach, reach + 1).array().floor().matrix();
    };
    int touching = 0;
    for (int i = 0; i < 200'000; ++i) {
        const auto draw = [&] {
            const Vector3<double> low = drawCorner(4);
            const Vector3<double> size = random.pointIn(0, 3).array().floor().matrix();
            return MovingBox<TypeParam>{{toVector<TypeParam>(low), toVector<TypeParam>(low + size)},
                                        toVector<TypeParam>(drawCorner(6))};
        };
        const MovingBox<TypeParam> a = draw();
        const MovingBox<TypeParam> b = draw();
        ASSERT_NO_FATAL_FAILURE(expectAsRationalsSay(a, b));
        touching += firstContact(a, b) ? 1 : 0;
    }
    EXPECT_GT(touching, 5'000);
    EXPECT_LT(touching, 180'000);
}

TYPED_TEST(MovingBoxes, TouchWhenRationalsSaySoInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        Random random(0x5eed0c02);
        for (int i = 0; i < 5000; ++i) {
            // From one box of the scene towards another one, by as much as it takes or thereabouts.
            const auto draw = [&] {
                const Aabb<TypeParam> box = scene.draw(random);
                const Aabb<TypeParam> target = scene.draw(random);
                const auto share = static_cast<TypeParam>(random.between(0, 2));
                return MovingBox<TypeParam>{box, (target.min() - box.max()) * share};
            };
            const MovingBox<TypeParam> a = draw();
            const MovingBox<TypeParam> b = draw();
            ASSERT_NO_FATAL_FAILURE(expectAsRationalsSay(a, b));
            ASSERT_NO_FATAL_FAILURE(
                expectAsRationalsSay(a, MovingBox<TypeParam>{scene.draw(random)}));
        }
    }
}

TYPED_TEST(MovingBoxes, ThatGrazeTouchAtNoDistanceAndNotAtOneUlp) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed0c03);
    for (int i = 0; i < 20'000; ++i) {
        // Past the upper edge of a wall, along x and a little along z.
        const auto top = static_cast<TypeParam>(random.logBetween(1e-3, 1e6));
        const MovingBox<TypeParam> wall{makeBox<TypeParam>(1, 0, -1, 2, 0, 1)};
        const auto passAt = [&](TypeParam height) {
            MovingBox<TypeParam> bullet{makeBox<TypeParam>(-1, 0, 0, 0, 0, 0)};
            bullet.box.min().y() = height;
            bullet.box.max().y() = 2 * height;
            bullet.displacement = {4, 0, static_cast<TypeParam>(random.between(-0.1, 0.1))};
            return bullet;
        };
        MovingBox<TypeParam> asHigh = wall;
        asHigh.box.max().y() = top;
        EXPECT_TRUE(firstContact(passAt(top), asHigh));
        EXPECT_TRUE(firstContact(passAt(std::nextafter(top, -Limits::max())), asHigh));
        EXPECT_FALSE(firstContact(passAt(std::nextafter(top, Limits::max())), asHigh));
    }
}

// Past the edge between two faces: whether it is touched depends on the order of two times that may
// differ by less than a double tells.
TYPED_TEST(MovingBoxes, ThatPassAnEdgeAreToldApartByLessThanRounding) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed0c04);
    int atOnce = 0;
    int oneUlpOff = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto x = static_cast<TypeParam>(random.between(1, 2));
        const auto y = static_cast<TypeParam>(random.between(1, 2));
        // The corner of b goes exactly through the edge of a: leaves along y as it arrives along x.
        MovingBox<TypeParam> a{makeBox<TypeParam>(0, 0, 0, 1, 1, 1)};
        MovingBox<TypeParam> b{makeBox<TypeParam>(0, 0, 0, 0, 0, 1)};
        b.box.min().x() = 1 + x;
        b.box.max().x() = 2 + x;
        b.box.min().y() = 1 - y;
        b.box.max().y() = 1 - y / 2;
        b.displacement = {-2 * x, 2 * y, 0};
        for (const TypeParam nudged :
             {b.box.min().y(), std::nextafter(b.box.min().y(), Limits::max()),
              std::nextafter(b.box.min().y(), -Limits::max())}) {
            b.box.min().y() = nudged;
            ASSERT_NO_FATAL_FAILURE(expectAsRationalsSay(a, b));
            (firstContact(a, b) ? atOnce : oneUlpOff) += 1;
        }
    }
    EXPECT_GT(atOnce, 10'000);
    EXPECT_GT(oneUlpOff, 10'000);
}

TYPED_TEST(MovingBoxes, TouchAtTheFirstAndAtTheLastMoment) {
    const MovingBox<TypeParam> wall{makeBox<TypeParam>(3, -1, -1, 4, 1, 1)};
    const auto bullet = [](TypeParam front, TypeParam way) {
        return MovingBox<TypeParam>{makeBox<TypeParam>(front - 1, 0, 0, front, 0, 0),
                                    Vector3<TypeParam>(way, 0, 0)};
    };
    EXPECT_EQ(firstContact(bullet(3, -5), wall), 0.0);  // and away
    EXPECT_EQ(firstContact(bullet(1, 2), wall), 1.0);   // and no further
    EXPECT_EQ(firstContact(bullet(2, 2), wall), 0.5);
    EXPECT_EQ(firstContact(bullet(2, 200), wall), 1.0 / 200);
    EXPECT_FALSE(firstContact(bullet(1, std::nextafter(TypeParam(2), TypeParam(0))), wall));
    EXPECT_FALSE(firstContact(bullet(std::nextafter(TypeParam(3), TypeParam(0)), -5), wall));
}

TYPED_TEST(MovingBoxes, ThatCrossTouchThoughNeitherIsThereBeforeOrAfter) {
    const MovingBox<TypeParam> a{makeBox<TypeParam>(-10, 0, 0, -9, 1, 1), {20, 0, 0}};
    const MovingBox<TypeParam> b{makeBox<TypeParam>(9, 0, 0, 10, 1, 1), {-20, 0, 0}};
    EXPECT_EQ(firstContact(a, b), 18.0 / 40);
    // The same way, at the same speed: never nearer.
    const MovingBox<TypeParam> c{b.box, a.displacement};
    EXPECT_FALSE(firstContact(a, c));
    // Through the same place, at different times.
    const MovingBox<TypeParam> d{makeBox<TypeParam>(-1, -20, 0, 0, -19, 1), {0, 40, 0}};
    const MovingBox<TypeParam> late{makeBox<TypeParam>(-20, 0, 0, -19, 1, 1), {20, 0, 0}};
    EXPECT_TRUE(firstContact(a, d));
    EXPECT_FALSE(firstContact(late, d));
}

TYPED_TEST(MovingBoxes, ThatDoNotMoveTouchWhenTheyOverlap) {
    Random random(0x5eed0c05);
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (int i = 0; i < 1000; ++i) {
            const Aabb<TypeParam> a = scene.draw(random);
            const Aabb<TypeParam> b = scene.draw(random);
            const auto contact = firstContact(MovingBox<TypeParam>{a}, MovingBox<TypeParam>{b});
            ASSERT_EQ(contact.has_value(), overlaps(a, b)) << scene.name;
        }
    }
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

TYPED_TEST(MovingBoxes, HaveTheirWayWithinItsBounds) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        Random random(0x5eed0c06);
        for (int i = 0; i < 2000; ++i) {
            const Aabb<TypeParam> box = scene.draw(random);
            const Vector3<TypeParam> way = scene.draw(random).min() - box.max();
            const Aabb<TypeParam> bounds = sweptBounds(MovingBox<TypeParam>{box, way});
            if (hasNan(box) || !way.allFinite()) {
                continue;
            }
            const Aabb<TypeParam> other = scene.draw(random);
            if (firstContactByRationals(MovingBox<TypeParam>{box, way},
                                        MovingBox<TypeParam>{other})) {
                ASSERT_TRUE(overlaps(bounds, other)) << scene.name;
            }
        }
    }
}

// Through a grid as well, which looks along the ray that is the region's segment.
TYPED_TEST(MovingBoxes, FindInAGridWhatBruteForceFinds) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        Random random(0x5eed0c07);
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies;
        for (std::uint32_t i = 0; i < scene.count; ++i) {
            const Aabb<TypeParam> box = scene.draw(random);
            proxies.push_back({grid.add(box), box});
        }
        grid.update();
        for (int i = 0; i < 200; ++i) {
            const Aabb<TypeParam> box = scene.draw(random);
            const auto share = static_cast<TypeParam>(random.between(0, 2));
            const MovingBoxRegion<TypeParam> region(
                MovingBox<TypeParam>{box, (scene.draw(random).min() - box.max()) * share});
            CollectKeys<TypeParam> found;
            grid.visit(region, found);
            CollectKeys<TypeParam> expected;
            visitByBruteForce<TypeParam>(proxies, region, expected);
            ASSERT_EQ(differences(found.sorted(), expected.sorted()), "") << i;
        }
    }
}

}  // namespace
}  // namespace hashphase::test
