// SPDX-License-Identifier: Zlib

// Where spheres rest: on flat ground, slopes, edges, corners, in valleys, under bridges, and in random
// meshes as by looking at every triangle, and as on each by itself.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/terrain_oracle.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>

namespace hashphase::test {
namespace {

template <class Scalar>
class RestingHeight : public testing::Test {
protected:
    /// A roof along z, from x = -10 to 10, of the given slopes left and right of its ridge at 0.
    static Mesh<Scalar> roof(double left, double right) {
        Mesh<Scalar> mesh;
        mesh.vertices = {at<Scalar>(-10, -10 * left, -10),
                         at<Scalar>(-10, -10 * left, 10),
                         at<Scalar>(0, 0, -10),
                         at<Scalar>(0, 0, 10),
                         at<Scalar>(10, 10 * right, -10),
                         at<Scalar>(10, 10 * right, 10)};
        mesh.indices = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5};
        return mesh;
    }

    static constexpr double kTolerance = sizeof(Scalar) == sizeof(float) ? 2e-6 : 1e-13;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RestingHeight, Scalars);

TYPED_TEST(RestingHeight, OnFlatGroundIsTheRadiusAboveIt) {
    const GroundWorld<TypeParam> world(this->roof(0, 0));
    for (const double radius : {0.0, 0.25, 1.0, 7.0}) {
        const auto found =
            world.terrain.restingHeight(at<TypeParam>(3, 2, 1), static_cast<TypeParam>(radius));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->height, static_cast<TypeParam>(radius));
        EXPECT_EQ(found->triangle / 2, 1U);
    }
}

TYPED_TEST(RestingHeight, OnASlopeIsTheRadiusByTheNormalAboveIt) {
    for (const double slope : {0.01, 0.5, 1.0, 3.0}) {
        const GroundWorld<TypeParam> world(this->roof(slope, slope));
        const double up = 1 / std::sqrt(1 + slope * slope);
        for (const double x : {-5.0, 0.0, 2.5}) {
            const auto found = world.terrain.restingHeight(at<TypeParam>(x, 50, 1), 1);
            ASSERT_TRUE(found);
            EXPECT_NEAR(found->height, slope * x + 1 / up, 20 * this->kTolerance);
        }
    }
}

TYPED_TEST(RestingHeight, OnARidgeIsTheRadiusAboveItWhereTheFacesFallAway) {
    const GroundWorld<TypeParam> world(this->roof(1, -1));
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(0, 5, 1), 1)->height, 1,
                this->kTolerance);
    // On the ridge until the face's normal leads through the centre.
    const double half = std::sqrt(0.5);
    for (const double x : {-0.7, -0.3, 0.2, 0.6, 0.7}) {
        EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(x, 5, 1), 1)->height,
                    std::sqrt(1 - x * x), this->kTolerance);
    }
    for (const double x : {-3.0, -0.71, 0.71, 0.8, 4.0}) {
        EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(x, 5, 1), 1)->height,
                    -std::abs(x) + 1 / half, 4 * this->kTolerance);
    }
}

TYPED_TEST(RestingHeight, InAValleyTouchesBothSides) {
    const GroundWorld<TypeParam> world(this->roof(-1, 1));
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(0, 5, 1), 1)->height, std::sqrt(2.0),
                this->kTolerance);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(0.5, 5, 1), 1)->height,
                0.5 + std::sqrt(2.0), this->kTolerance);
}

TYPED_TEST(RestingHeight, BesideTheGroundIsOnItsEdgesAndCorners) {
    const GroundWorld<TypeParam> world(this->roof(0, 0));
    const double half = std::sqrt(0.5);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(10 + half, 5, 1), 1)->height, half, 1e-5);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(10.5, 5, 10.5), 1)->height, half, 1e-6);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(10.75, 5, 1), 1.25)->height, 1, 1e-6);
    EXPECT_EQ(world.terrain.restingHeight(at<TypeParam>(11, 5, 1), 1)->height, 0);
    EXPECT_FALSE(world.terrain.restingHeight(at<TypeParam>(11.001, 5, 1), 1));
    EXPECT_FALSE(world.terrain.restingHeight(at<TypeParam>(10.8, 5, 10.8), 1));
}

TYPED_TEST(RestingHeight, IsOnWallsAndNeedles) {
    Mesh<TypeParam> mesh;
    mesh.vertices = {at<TypeParam>(0, 0, 0), at<TypeParam>(4, 0, 0),  at<TypeParam>(0, 3, 0),
                     at<TypeParam>(4, 3, 0), at<TypeParam>(20, 0, 0), at<TypeParam>(20, 5, 0)};
    mesh.indices = {0, 1, 2, 1, 2, 3, 4, 5, 5};
    const GroundWorld<TypeParam> world(mesh);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(2, 9, 0), 1)->height, 4, 1e-6);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(2, 9, 0.6), 1)->height, 3.8, 1e-6);
    EXPECT_NEAR(world.terrain.restingHeight(at<TypeParam>(20.6, 9, 0), 1)->height, 5.8, 1e-6);
    EXPECT_EQ(world.terrain.restingHeight(at<TypeParam>(2, 9, 0), 0)->height, 3);
}

TYPED_TEST(RestingHeight, LeavesOutWhatIsTouchedAboveTheCentre) {
    Mesh<TypeParam> mesh = this->roof(0, 0);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, z] : {std::pair{-1, -9}, {1, -9}, {-1, 9}, {1, 9}}) {  // a bridge
        mesh.vertices.push_back(at<TypeParam>(x, 4, z));
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 1U, 2U, 3U}) {
        mesh.indices.push_back(first + corner);
    }
    const GroundWorld<TypeParam> world(mesh);
    const auto heightFrom = [&](double x, double y) {
        return world.terrain.restingHeight(at<TypeParam>(x, y, 0), 1)->height;
    };
    EXPECT_EQ(heightFrom(0, 9), 5);
    EXPECT_EQ(heightFrom(0, 4), 5);  // sunk in until its centre
    EXPECT_EQ(heightFrom(0, 3.9), 1);
    EXPECT_EQ(heightFrom(0, 0), 1);
    EXPECT_NEAR(heightFrom(1.6, 4.5), 4.8, 1e-6);  // beside the bridge, on its edge
    EXPECT_EQ(heightFrom(1.6, 3.9), 1);
    EXPECT_FALSE(world.terrain.restingHeight(at<TypeParam>(0, -0.1, 0), 1));
}

TYPED_TEST(RestingHeight, LiftsWhatIsSunkIntoAHill) {
    const GroundWorld<TypeParam> world(this->roof(0.5, -0.5));
    for (const double x : {-4.0, 1.0, 6.0}) {
        const auto above = world.terrain.restingHeight(at<TypeParam>(x, 50, 0), 1);
        const double surface = -0.5 * std::abs(x);
        // The face is touched beside the line, up the hill.
        const auto sunk = world.terrain.restingHeight(at<TypeParam>(x, surface + 0.45, 0), 1);
        ASSERT_TRUE(above && sunk);
        EXPECT_EQ(sunk->height, above->height);
    }
}

TYPED_TEST(RestingHeight, OfBadRadiiIsNone) {
    using Limits = std::numeric_limits<TypeParam>;
    const GroundWorld<TypeParam> world(this->roof(0, 0));
    const Vector3<TypeParam> center = at<TypeParam>(1, 5, 1);
    for (const TypeParam bad :
         {TypeParam(-1), -Limits::denorm_min(), Limits::quiet_NaN(), Limits::infinity()}) {
        EXPECT_FALSE(world.terrain.restingHeight(center, bad)) << bad;
    }
    EXPECT_EQ(world.terrain.restingHeight(center, -TypeParam(0))->height, 0);
    EXPECT_EQ(world.terrain.restingHeight(center, TypeParam(1e30))->height, TypeParam(1e30));
    EXPECT_EQ(world.terrain.restingHeight(center, Limits::denorm_min())->height,
              Limits::denorm_min());
    EXPECT_EQ(world.terrain.restingHeight(center, Limits::max()).has_value(),
              sizeof(TypeParam) == sizeof(float));
}

TYPED_TEST(RestingHeight, OfAPointIsTheSurfaceBelow) {
    Random random(0x5eed2201);
    const GroundWorld<TypeParam> world(roughGround<TypeParam>(random, 20, 1, 3, 0.15));
    for (int i = 0; i < 5000; ++i) {
        const Vector3<TypeParam> point =
            random.pointIn({-1, 0, -1}, {21, 4, 21}).template cast<TypeParam>();
        const auto surface = world.terrain.surfaceBelow(point);
        const auto rest = world.terrain.restingHeight(point, 0);
        ASSERT_EQ(surface.has_value(), rest.has_value());
        if (surface) {
            ASSERT_EQ(surface->height, rest->height);
        }
    }
}

TYPED_TEST(RestingHeight, IsThatOfBruteForceInRandomMeshes) {
    Random random(0x5eed2202);
    std::size_t found = 0;
    for (int meshNumber = 0; meshNumber < 300; ++meshNumber) {
        SCOPED_TRACE(testing::Message() << "mesh " << meshNumber);
        const UpAxis up = static_cast<UpAxis>(meshNumber % 3);
        const Mesh<TypeParam> mesh = random.chance(0.4)
                                         ? roughGround<TypeParam>(random, 5, 1, 2, 0.15)
                                         : splinters<TypeParam>(random, 1 + random.below(25));
        const GroundWorld<TypeParam> world(mesh, up);
        const TerrainOracle<TypeParam> oracle(world.terrain, up);
        for (int i = 0; i < 16; ++i) {
            const Vector3<TypeParam> center = turned(
                random.pointIn({-5, -2, -5}, {6, 7, 6}).template cast<TypeParam>().eval(), up);
            const auto radius = static_cast<TypeParam>(random.logBetween(0.05, 3));
            const auto ground = world.terrain.restingHeight(center, radius);
            found += ground ? 1 : 0;
            ASSERT_EQ(oracle.checkRest(center, radius, ground), "") << "radius " << radius;
        }
    }
    EXPECT_GT(found, 1000U);
}

/// Each triangle of a mesh in a world of its own, where nothing is left out because another one carries
/// the sphere higher.
template <class Scalar>
class TrianglesApart {
public:
    using Found = std::optional<Ground<Scalar>>;

    explicit TrianglesApart(const Mesh<Scalar>& mesh) {
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            Mesh<Scalar> one{mesh.vertices, {}};
            one.indices.assign(mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                               mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
            worlds_.push_back(std::make_unique<GroundWorld<Scalar>>(one));
        }
    }

    /// The highest of all; of several the one with the smallest number.
    [[nodiscard]] Found highest(const Vector3<Scalar>& center, Scalar radius) const {
        Found best;
        for (std::uint32_t i = 0; i < worlds_.size(); ++i) {
            const Found found = worlds_[i]->terrain.restingHeight(center, radius);
            if (found && (!best || found->height > best->height)) {
                best = Ground<Scalar>{i, found->height};
            }
        }
        return best;
    }

    [[nodiscard]] Found on(std::uint32_t triangle, const Vector3<Scalar>& center,
                           Scalar radius) const {
        return worlds_[triangle]->terrain.restingHeight(center, radius);
    }

private:
    std::vector<std::unique_ptr<GroundWorld<Scalar>>> worlds_;
};

TYPED_TEST(RestingHeight, IsThatOfTheTriangleThatCarriesHighestByItself) {
    Random random(0x5eed2203);
    std::size_t found = 0;
    for (int meshNumber = 0; meshNumber < 120; ++meshNumber) {
        SCOPED_TRACE(testing::Message() << "mesh " << meshNumber);
        const double roughness = random.chance(0.2) ? 0 : random.logBetween(1e-6, 4);
        const Mesh<TypeParam> mesh = random.chance(0.7)
                                         ? roughGround<TypeParam>(random, 5, 1, roughness, 0.15)
                                         : splinters<TypeParam>(random, 1 + random.below(25));
        const GroundWorld<TypeParam> world(mesh);
        const TrianglesApart<TypeParam> apart(mesh);
        for (int i = 0; i < 100; ++i) {
            Vector3<TypeParam> center =
                random.pointIn({-1, 0, -1}, {6, 7, 6}).template cast<TypeParam>();
            if (random.chance(0.2)) {  // above an edge, or a corner
                center[0] = std::round(center[0]);
                center[2] = std::round(center[2]);
            }
            const auto radius = static_cast<TypeParam>(random.logBetween(1e-7, 10));
            const auto ground = world.terrain.restingHeight(center, radius);
            const auto highest = apart.highest(center, radius);
            ASSERT_EQ(ground.has_value(), highest.has_value()) << "radius " << radius;
            if (ground) {
                ++found;
                ASSERT_EQ(ground->height, highest->height) << "radius " << radius;
                const auto itsOwn = apart.on(ground->triangle, center, radius);
                ASSERT_TRUE(itsOwn && itsOwn->height == highest->height) << "radius " << radius;
                // Heights that differ in double precision only are no ties.
                if constexpr (std::is_same_v<TypeParam, double>) {
                    ASSERT_EQ(ground->triangle, highest->triangle) << "radius " << radius;
                }
            }
        }
    }
    EXPECT_GT(found, 5000U);
}

}  // namespace
}  // namespace hashphase::test
