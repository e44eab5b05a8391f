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
        for (const auto& [x, y] : {std::pair(-10.0, -10 * left), {0.0, 0.0}, {10.0, 10 * right}}) {
            mesh.vertices.push_back(at<Scalar>(x, y, -10));
            mesh.vertices.push_back(at<Scalar>(x, y, 10));
        }
        mesh.indices = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5};
        return mesh;
    }

    static double heightAt(const GroundWorld<Scalar>& world, double x, double y, double z,
                           double radius = 1) {
        const auto found =
            world.terrain.restingHeight(at<Scalar>(x, y, z), static_cast<Scalar>(radius));
        return found ? static_cast<double>(found->height) : kNone;
    }

    static constexpr double kNone = -1e30;
    static constexpr double kTolerance = sizeof(Scalar) == sizeof(float) ? 2e-6 : 1e-13;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RestingHeight, Scalars);

TYPED_TEST(RestingHeight, OnFlatGroundAndSlopesIsTheRadiusByTheNormalAboveIt) {
    for (const double slope : {0.0, 0.01, 0.5, 1.0, 3.0}) {
        const GroundWorld<TypeParam> world(this->roof(slope, slope));
        for (const double radius : {0.0, 0.25, 1.0, 7.0}) {
            const double above = radius * std::sqrt(1 + slope * slope);
            EXPECT_NEAR(this->heightAt(world, 2.5, 50, 1, radius), slope * 2.5 + above,
                        40 * this->kTolerance);
        }
    }
    const GroundWorld<TypeParam> flat(this->roof(0, 0));
    EXPECT_EQ(flat.terrain.restingHeight(at<TypeParam>(3, 2, 1), 7)->height, 7);
    EXPECT_EQ(flat.terrain.restingHeight(at<TypeParam>(3, 2, 1), 1)->triangle / 2, 1U);
}

TYPED_TEST(RestingHeight, OnARidgeAndInAValleyIsWhereTheSphereTouches) {
    // On the ridge until the face's normal leads through the centre.
    const GroundWorld<TypeParam> ridge(this->roof(1, -1));
    for (const double x : {-3.0, -0.71, -0.7, -0.3, 0.0, 0.2, 0.6, 0.7, 0.71, 0.8, 4.0}) {
        const double expected =
            std::abs(x) < std::sqrt(0.5) ? std::sqrt(1 - x * x) : std::sqrt(2.0) - std::abs(x);
        EXPECT_NEAR(this->heightAt(ridge, x, 5, 1), expected, 4 * this->kTolerance) << x;
    }
    const GroundWorld<TypeParam> valley(this->roof(-1, 1));
    EXPECT_NEAR(this->heightAt(valley, 0, 5, 1), std::sqrt(2.0), this->kTolerance);
    EXPECT_NEAR(this->heightAt(valley, 0.5, 5, 1), 0.5 + std::sqrt(2.0), this->kTolerance);
}

TYPED_TEST(RestingHeight, BesideTheGroundIsOnItsEdgesAndCorners) {
    const GroundWorld<TypeParam> world(this->roof(0, 0));
    const double half = std::sqrt(0.5);
    EXPECT_NEAR(this->heightAt(world, 10 + half, 5, 1), half, 1e-5);
    EXPECT_NEAR(this->heightAt(world, 10.5, 5, 10.5), half, 1e-6);
    EXPECT_NEAR(this->heightAt(world, 10.75, 5, 1, 1.25), 1, 1e-6);
    EXPECT_EQ(this->heightAt(world, 11, 5, 1), 0);
    EXPECT_EQ(this->heightAt(world, 11.001, 5, 1), this->kNone);
    EXPECT_EQ(this->heightAt(world, 10.8, 5, 10.8), this->kNone);
}

TYPED_TEST(RestingHeight, IsOnWallsAndNeedles) {
    Mesh<TypeParam> mesh;
    mesh.vertices = {at<TypeParam>(0, 0, 0), at<TypeParam>(4, 0, 0),  at<TypeParam>(0, 3, 0),
                     at<TypeParam>(4, 3, 0), at<TypeParam>(20, 0, 0), at<TypeParam>(20, 5, 0)};
    mesh.indices = {0, 1, 2, 1, 2, 3, 4, 5, 5};
    const GroundWorld<TypeParam> world(mesh);
    EXPECT_NEAR(this->heightAt(world, 2, 9, 0), 4, 1e-6);
    EXPECT_NEAR(this->heightAt(world, 2, 9, 0.6), 3.8, 1e-6);
    EXPECT_NEAR(this->heightAt(world, 20.6, 9, 0), 5.8, 1e-6);
    EXPECT_EQ(this->heightAt(world, 2, 9, 0, 0), 3);
}

TYPED_TEST(RestingHeight, LeavesOutWhatIsTouchedAboveTheCentreAndLiftsWhatIsSunk) {
    Mesh<TypeParam> mesh = this->roof(0, 0);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, z] : {std::pair{-1, -9}, {1, -9}, {-1, 9}, {1, 9}}) {  // a bridge
        mesh.vertices.push_back(at<TypeParam>(x, 4, z));
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 1U, 2U, 3U}) {
        mesh.indices.push_back(first + corner);
    }
    const GroundWorld<TypeParam> world(mesh);
    EXPECT_EQ(this->heightAt(world, 0, 9, 0), 5);
    EXPECT_EQ(this->heightAt(world, 0, 4, 0), 5);  // sunk in until its centre
    EXPECT_EQ(this->heightAt(world, 0, 3.9, 0), 1);
    EXPECT_EQ(this->heightAt(world, 0, 0, 0), 1);
    EXPECT_NEAR(this->heightAt(world, 1.6, 4.5, 0), 4.8, 1e-6);  // beside the bridge, on its edge
    EXPECT_EQ(this->heightAt(world, 1.6, 3.9, 0), 1);
    EXPECT_EQ(this->heightAt(world, 0, -0.1, 0), this->kNone);
    const GroundWorld<TypeParam> hill(this->roof(0.5, -0.5));
    for (const double x : {-4.0, 1.0, 6.0}) {  // The face is touched beside the line, up the hill.
        EXPECT_EQ(this->heightAt(hill, x, 0.45 - 0.5 * std::abs(x), 0),
                  this->heightAt(hill, x, 50, 0));
    }
}

TYPED_TEST(RestingHeight, OfBadRadiiIsNone) {
    using Limits = std::numeric_limits<TypeParam>;
    const GroundWorld<TypeParam> world(this->roof(0, 0));
    const auto rest = [&](TypeParam radius) {
        return world.terrain.restingHeight(at<TypeParam>(1, 5, 1), radius);
    };
    for (const TypeParam bad :
         {TypeParam(-1), -Limits::denorm_min(), Limits::quiet_NaN(), Limits::infinity()}) {
        EXPECT_FALSE(rest(bad)) << bad;
    }
    for (const TypeParam good : {-TypeParam(0), Limits::denorm_min(), TypeParam(1e30)}) {
        EXPECT_EQ(rest(good)->height, good);
    }
    EXPECT_EQ(rest(Limits::max()).has_value(), sizeof(TypeParam) == sizeof(float));
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
            one.indices.assign({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
            worlds_.push_back(std::make_unique<GroundWorld<Scalar>>(one));
        }
    }
    [[nodiscard]] Found on(std::uint32_t triangle, const Vector3<Scalar>& center,
                           Scalar radius) const {
        return worlds_[triangle]->terrain.restingHeight(center, radius);
    }
    /// The highest of all; of several the one with the smallest number.
    [[nodiscard]] Found highest(const Vector3<Scalar>& center, Scalar radius) const {
        Found best;
        for (std::uint32_t i = 0; i < worlds_.size(); ++i) {
            const Found found = on(i, center, radius);
            if (found && (!best || found->height > best->height)) {
                best = Ground<Scalar>{i, found->height};
            }
        }
        return best;
    }

private:
    std::vector<std::unique_ptr<GroundWorld<Scalar>>> worlds_;
};

TYPED_TEST(RestingHeight, IsThatOfBruteForceAndOfTheTriangleThatCarriesHighestByItself) {
    Random random(0x5eed2202);
    std::size_t found = 0;
    std::size_t foundApart = 0;
    for (int meshNumber = 0; meshNumber < 360; ++meshNumber) {
        SCOPED_TRACE(testing::Message() << "mesh " << meshNumber);
        const UpAxis up = static_cast<UpAxis>(meshNumber % 3);
        const double roughness = random.chance(0.2) ? 0 : random.logBetween(1e-6, 4);
        const Mesh<TypeParam> mesh = random.chance(up == UpAxis::y ? 0.7 : 0.4)
                                         ? roughGround<TypeParam>(random, 5, 1, roughness, 0.15)
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
        if (up != UpAxis::y) {
            continue;
        }
        const TrianglesApart<TypeParam> apart(mesh);
        for (int i = 0; i < 100; ++i) {
            Vector3<TypeParam> center =
                random.pointIn({-1, 0, -1}, {6, 7, 6}).template cast<TypeParam>();
            if (random.chance(0.2)) {  // above an edge, or a corner
                center = {std::round(center[0]), center[1], std::round(center[2])};
            }
            const auto radius = static_cast<TypeParam>(random.logBetween(1e-7, 10));
            const auto ground = world.terrain.restingHeight(center, radius);
            const auto highest = apart.highest(center, radius);
            ASSERT_EQ(ground.has_value(), highest.has_value()) << "radius " << radius;
            if (ground) {
                ++foundApart;
                ASSERT_EQ(ground->height, highest->height) << "radius " << radius;
                const auto itsOwn = apart.on(ground->triangle, center, radius);
                ASSERT_TRUE(itsOwn && itsOwn->height == highest->height) << "radius " << radius;
                // Heights that differ in double precision only are no ties.
                if constexpr (std::is_same_v<TypeParam, double>) {
                    ASSERT_EQ(ground->triangle, highest->triangle) << "radius " << radius;
                }
            }
            if (const auto surface = world.terrain.surfaceBelow(center)) {
                ASSERT_EQ(world.terrain.restingHeight(center, 0)->height, surface->height);
            }
        }
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(foundApart, 5000U);
}

}  // namespace
}  // namespace hashphase::test
