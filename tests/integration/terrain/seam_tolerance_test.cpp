// SPDX-License-Identifier: Zlib

// How wide a seam may be: as the triangles that are there need, or as the caller says.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <limits>

namespace hashphase::test {
namespace {

template <class Scalar>
class SeamTolerance : public testing::Test {
protected:
    using Point = Vector3<Scalar>;

    /// A right triangle with two legs of this length [m].
    static std::vector<Point> corner(double length, double x = 0) {
        return {at<Scalar>(x, 0, 0), at<Scalar>(x + length, 0, 0), at<Scalar>(x, 0, length)};
    }
    /// As the documentation says it, `sum` [m] being that of the coordinate and the extent.
    static Scalar of(double sum) {
        return 8 * std::numeric_limits<Scalar>::epsilon() * static_cast<Scalar>(sum);
    }

    Grid<Scalar> grid;
    Terrain<Scalar> terrain{grid};
    const Point origin = Point::Zero();
    const Point far = at<Scalar>(-3, 0, 100);
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SeamTolerance, Scalars);

TYPED_TEST(SeamTolerance, IsForgottenWhenTheGroundIsCleared) {
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), 0);
    const std::vector<Vector3<TypeParam>> corners{at<TypeParam>(0, 0, 0), at<TypeParam>(8, 4, 0),
                                                  at<TypeParam>(0, 2, 8)};
    this->terrain.add(corners);
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(16));
    this->terrain.clear();
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), 0);
}

TYPED_TEST(SeamTolerance, FollowsTheTrianglesThatAreLeft) {
    this->terrain.add(this->corner(8));
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(8));
    EXPECT_EQ(this->terrain.seamTolerance(this->far), this->of(108));
    auto two = this->corner(1000);
    const auto near = this->corner(1);
    two.insert(two.end(), near.begin(), near.end());
    const std::uint32_t large = this->terrain.add(two).first;
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(1024));
    this->terrain.remove(large);
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(1024)) << "one is left";
    this->terrain.replace(large + 1, this->corner(16));
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(16));
    this->terrain.remove(large + 1);
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(8));
    this->terrain.add(this->corner(1e9));
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(16384));
}

// A world that is streamed for long is shifted far, and nothing that came before is left.
TYPED_TEST(SeamTolerance, FollowsTheShiftsSinceTheTrianglesCame) {
    std::uint32_t last = this->terrain.add(this->corner(8)).first;
    for (int i = 0; i < 2000; ++i) {
        const auto by = at<TypeParam>(4096, 0, 0);
        this->grid.shiftOrigin(by);
        this->terrain.shiftOrigin(by);
        ASSERT_EQ(this->terrain.seamTolerance(this->origin), this->of(4096 + 8));
        const std::uint32_t next = this->terrain.add(this->corner(8)).first;
        this->terrain.remove(last);
        ASSERT_EQ(this->terrain.seamTolerance(this->origin), this->of(8));
        last = next;
    }
    EXPECT_EQ(this->terrain.size(), 2U);
}

TYPED_TEST(SeamTolerance, RemembersEachOriginSinceTheTrianglesCame) {
    this->terrain.add(this->corner(8));
    for (const double x : {4096.0, -1024.0, -3072.0}) {
        this->terrain.shiftOrigin(at<TypeParam>(x, 0, 0));
    }
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(4096 + 8));
    EXPECT_EQ(this->terrain.seamTolerance(at<TypeParam>(1024, 0, 0)), this->of(3072 + 8));
    this->terrain.shiftOrigin(at<TypeParam>(-8192, 0, 0));
    EXPECT_EQ(this->terrain.seamTolerance(this->origin), this->of(12288 + 8));
    EXPECT_EQ(this->terrain.seamTolerance(at<TypeParam>(10240, 0, 0)), this->of(10240 + 8));
}

TYPED_TEST(SeamTolerance, IsWhatTheCallerSets) {
    std::vector<Vector3<TypeParam>> strips;  // 4 mm apart
    for (const double x : {-20.0, 0.004}) {
        for (const auto& [i, k] :
             {std::pair(0.0, -20.0), std::pair(20.0, -20.0), std::pair(0.0, 20.0),
              std::pair(20.0, -20.0), std::pair(0.0, 20.0), std::pair(20.0, 20.0)}) {
            strips.push_back(at<TypeParam>(x + i, 0, k));
        }
    }
    this->terrain.add(strips);
    const auto inGap = at<TypeParam>(0.002, 5, 3);
    const auto beside = at<TypeParam>(-20.004, 5, 3);
    EXPECT_FALSE(this->terrain.surfaceBelow(inGap));
    this->terrain.setSeamTolerance(TypeParam(0.003));
    EXPECT_EQ(this->terrain.seamTolerance(this->far), TypeParam(0.003));
    EXPECT_TRUE(this->terrain.surfaceBelow(inGap));
    EXPECT_TRUE(this->terrain.restingHeight(inGap, 0));
    EXPECT_FALSE(this->terrain.surfaceBelow(beside));
    this->terrain.clear();
    this->terrain.add(strips);
    EXPECT_TRUE(this->terrain.surfaceBelow(inGap));
    this->terrain.setSeamTolerance(std::nullopt);
    EXPECT_FALSE(this->terrain.surfaceBelow(inGap));
}

TYPED_TEST(SeamTolerance, OfZeroLeavesWhatIsBetweenOpen) {
    const TypeParam edge = 1 + std::numeric_limits<TypeParam>::epsilon();
    std::vector<Vector3<TypeParam>> two = this->corner(-1, 1);
    const std::vector<Vector3<TypeParam>> right = this->corner(1);
    for (const Vector3<TypeParam>& corner : right) {
        two.emplace_back(corner[0] + edge + std::numeric_limits<TypeParam>::epsilon(), 0,
                         corner[2]);
    }
    this->terrain.add(two);
    const Vector3<TypeParam> between(edge, 1, 0);
    EXPECT_TRUE(this->terrain.surfaceBelow(between));
    this->terrain.setSeamTolerance(TypeParam(0));
    EXPECT_FALSE(this->terrain.surfaceBelow(between));
    EXPECT_EQ(this->terrain.surfaceBelow(at<TypeParam>(1, 1, 0))->triangle, 0U);
    EXPECT_EQ(this->terrain.restingHeight(at<TypeParam>(1, 1, 0), 0)->triangle, 0U);
}

TYPED_TEST(SeamTolerance, IsZeroOrMore) {
    using Limits = std::numeric_limits<TypeParam>;
    this->terrain.setSeamTolerance(TypeParam(0.25));
    std::vector<TypeParam> bad{Limits::quiet_NaN(), -TypeParam(0.5), Limits::infinity()};
    if (sizeof(TypeParam) == 8) {
        bad.push_back(TypeParam(1e30) * TypeParam(1e30) * TypeParam(1e30));
    }
    for (const TypeParam tolerance : bad) {
        if (HASHPHASE_ENABLE_ASSERTS) {
            const ThrowingAsserts asserts;
            EXPECT_THROW(this->terrain.setSeamTolerance(tolerance), BrokenAssert);
        }
        const CaughtAsserts caught;
        this->terrain.setSeamTolerance(tolerance);
        EXPECT_EQ(this->terrain.seamTolerance(this->origin), TypeParam(0.25));
    }
}

}  // namespace
}  // namespace hashphase::test
