// SPDX-License-Identifier: Zlib

// The surface below a point: the right one of several, without gaps between triangles, and the same
// as from looking at every triangle.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/terrain_oracle.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace hashphase::test {
namespace {

template <class Scalar>
class SurfaceBelow : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(SurfaceBelow, Scalars);

TYPED_TEST(SurfaceBelow, IsThePlaneOfTheTriangle) {
    Mesh<TypeParam> slope;
    slope.vertices = {at<TypeParam>(0, 0, 0), at<TypeParam>(8, 4, 0), at<TypeParam>(0, 2, 8)};
    slope.indices = {0, 1, 2};
    const GroundWorld<TypeParam> world(slope);
    struct Case {
        double x, y, z;
        std::optional<TypeParam> height;
    };
    for (const auto& [x, y, z, height] : std::vector<Case>{{2, 9, 4, 2},
                                                           {0, 9, 0, 0},
                                                           {8, 9, 0, 4},
                                                           {0, 9, 8, 2},
                                                           {4, 9, 4, 3},
                                                           {2, 2, 4, 2},
                                                           {4.001, 9, 4, {}},
                                                           {-0.001, 9, 4, {}},
                                                           {2, 1.999, 4, {}}}) {
        const auto found = world.terrain.surfaceBelow(at<TypeParam>(x, y, z));
        ASSERT_EQ(found.has_value(), height.has_value()) << x << ' ' << y << ' ' << z;
        EXPECT_TRUE(!found || (found->height == *height && found->triangle == 0));
    }
}

TYPED_TEST(SurfaceBelow, IsChosenByThePointsHeight) {
    const GroundWorld<TypeParam> world(spiral<TypeParam>(4));
    for (int i = 0; i < 500; ++i) {
        const double turn = 0.1 + i * 0.0077;
        const double angle = 2 * std::numbers::pi * turn;
        const auto found = world.terrain.surfaceBelow(
            at<TypeParam>(3.5 * std::cos(angle), 4 * turn + 1, 3.5 * std::sin(angle)));
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->height, 4 * turn, 0.1);
    }
}

TYPED_TEST(SurfaceBelow, OfEqualOnesIsTheOneWithTheSmallestNumber) {
    Mesh<TypeParam> twice = spiral<TypeParam>(1);
    const std::vector<std::uint32_t> once = twice.indices;
    twice.indices.insert(twice.indices.end(), once.begin(), once.end());
    const GroundWorld<TypeParam> world(twice);
    Random random(0x5eed2101);
    int found = 0;
    for (int i = 0; i < 2000; ++i) {
        if (const auto ground =
                world.terrain.surfaceBelow(random.pointIn(-5, 5).template cast<TypeParam>())) {
            EXPECT_LT(ground->triangle, once.size() / 3);
            ++found;
        }
    }
    EXPECT_GT(found, 200);
}

/// Whether a vertex of 24 x 24 quads has quads on all sides.
bool isWithinGround(std::uint32_t vertex) {
    const auto isWithin = [](std::uint32_t place) { return place > 0 && place < 24; };
    return isWithin(vertex % 25) && isWithin(vertex / 25);
}

/// An edge of a triangle of 24 x 24 quads that begins within: on either side of it is a triangle.
template <class Scalar>
std::pair<std::uint32_t, std::uint32_t> innerEdge(Random& random, const Mesh<Scalar>& mesh) {
    while (true) {
        const std::uint32_t corner = random.below(static_cast<std::uint32_t>(mesh.indices.size()));
        const std::uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
        if (isWithinGround(mesh.indices[corner])) {
            return {mesh.indices[corner], mesh.indices[next]};
        }
    }
}

TYPED_TEST(SurfaceBelow, HasNoGapsWhereTrianglesMeet) {
    Random random(0x5eed2102);
    std::size_t asked = 0;
    std::size_t diagonals = 0;
    std::vector<Vector3<TypeParam>> points;
    std::vector<std::optional<Ground<TypeParam>>> found;
    for (const double offset : {0.0, 1000.0, -1e6}) {
        for (int meshNumber = 0; meshNumber < 10; ++meshNumber) {
            const double edge = random.between(0.5, 3) * (std::abs(offset) > 1e5 ? 16 : 1);
            const Mesh<TypeParam> mesh =
                roughGround<TypeParam>(random, 24, edge, 4, 0.19, {offset, 0, -offset});
            const GroundWorld<TypeParam> world(mesh);
            points.clear();
            const auto vertex = [&](std::uint32_t number) {
                return mesh.vertices[number].template cast<double>().eval();
            };
            for (int i = 0; i < 34000; ++i) {
                // Inner edges, and corners; as near as numbers get to them.
                const auto [from, to] = innerEdge(random, mesh);
                const Vector3<double> a = vertex(from);
                const Vector3<double> b = vertex(to);
                diagonals += from % 25 != to % 25 && from / 25 != to / 25 ? 1 : 0;
                // Not as far as the outer edge, beyond which there is no ground.
                const double most = isWithinGround(to) ? 1 : 0.9;
                const double share = random.chance(0.05) ? 0 : random.between(0, most);
                Vector3<TypeParam> point = (a + share * (b - a)).template cast<TypeParam>();
                point[1] = 100;
                points.push_back(point);
            }
            found.resize(points.size());
            world.terrain.surfacesBelow(points, found);
            std::size_t misses = 0;
            for (const auto& ground : found) {
                misses += ground ? 0 : 1;
                ASSERT_TRUE(!ground || std::isfinite(ground->height));
            }
            asked += points.size();
            ASSERT_EQ(misses, 0U) << "offset " << offset << ", mesh " << meshNumber;
        }
    }
    EXPECT_GE(asked, 1000000U);
    EXPECT_GT(diagonals, asked / 4);
}

TYPED_TEST(SurfaceBelow, IsThatOfBruteForceInRandomMeshesAndTheSameFromItsOwnHeight) {
    Random random(0x5eed2104);
    std::size_t found = 0;
    for (int meshNumber = 0; meshNumber < 1000; ++meshNumber) {
        SCOPED_TRACE(testing::Message() << "mesh " << meshNumber);
        const UpAxis up = static_cast<UpAxis>(meshNumber % 3);
        const Mesh<TypeParam> mesh = random.chance(0.3)
                                         ? roughGround<TypeParam>(random, 6, 1, 3, 0.15)
                                         : splinters<TypeParam>(random, 1 + random.below(60));
        const GroundWorld<TypeParam> world(mesh, up);
        const TerrainOracle<TypeParam> oracle(world.terrain, up);
        for (int i = 0; i < 40; ++i) {
            Vector3<TypeParam> point = turned(
                random.pointIn({-5, -2, -5}, {6, 7, 6}).template cast<TypeParam>().eval(), up);
            const auto ground = world.terrain.surfaceBelow(point);
            ASSERT_EQ(oracle.checkSurface(point, ground), "");
            if (ground) {
                ++found;
                ASSERT_LE(ground->height, point[static_cast<int>(up)]);
                point[static_cast<int>(up)] = ground->height;
                ASSERT_EQ(world.terrain.surfaceBelow(point), ground);
            }
        }
    }
    EXPECT_GT(found, 4000U);
}

TYPED_TEST(SurfaceBelow, IsAsExactFarFromTheOrigin) {
    // Whole metres, and so exact in both precisions: a slope of one in four, 1e6 m away.
    Random random(0x5eed2105);
    const Mesh<TypeParam> mesh = quads<TypeParam>(random, 20, [](std::uint32_t i, std::uint32_t k) {
        return at<TypeParam>(1e6 + 4 * i, 1.0 * i, -1e6 + 4 * k);
    });
    const GroundWorld<TypeParam> world(mesh);
    for (int i = 0; i < 1000; ++i) {
        const double x = random.below(80);
        const double z = random.below(80);
        const auto ground = world.terrain.surfaceBelow(at<TypeParam>(1e6 + x, 1e4, -1e6 + z));
        ASSERT_TRUE(ground);
        ASSERT_EQ(ground->height, static_cast<TypeParam>(x / 4));
    }
}

TYPED_TEST(SurfaceBelow, IsNoneOnVerticalTrianglesAndThoseWithoutAnArea) {
    Mesh<TypeParam> mesh;
    mesh.vertices = {at<TypeParam>(0, 0, 0), at<TypeParam>(4, 0, 0), at<TypeParam>(4, 4, 0),
                     at<TypeParam>(2, 2, 0)};
    mesh.indices = {0, 1, 2, 0, 2, 3, 0, 0, 1, 1, 1, 1};
    const GroundWorld<TypeParam> world(mesh);
    EXPECT_EQ(world.grid.size(), 4U);
    for (const double x : {0.0, 1.0, 2.0, 4.0}) {
        EXPECT_FALSE(world.terrain.surfaceBelow(at<TypeParam>(x, 9, 0)));
    }
}

TYPED_TEST(SurfaceBelow, OfBadPointsIsNone) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed2106);
    const GroundWorld<TypeParam> world(roughGround<TypeParam>(random, 8, 1, 1, 0.1));
    const Vector3<TypeParam> good = at<TypeParam>(4, 5, 4);
    ASSERT_TRUE(world.terrain.surfaceBelow(good));
    for (const TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            Vector3<TypeParam> point = good;
            point[axis] = bad;
            const bool isAbove = axis == 1 && bad > 0;
            EXPECT_EQ(world.terrain.surfaceBelow(point).has_value(), isAbove);
            EXPECT_EQ(world.terrain.restingHeight(point, 1).has_value(), isAbove);
        }
    }
    EXPECT_FALSE(GroundWorld<TypeParam>({}).terrain.surfaceBelow(good));
}

}  // namespace
}  // namespace hashphase::test
