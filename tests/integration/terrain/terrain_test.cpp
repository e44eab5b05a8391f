// SPDX-License-Identifier: Zlib

// What becomes of triangles: how they are taken in, refused, told apart from others, and removed.

#include <tests/integration/terrain/meshes.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <memory>

namespace hashphase::test {
namespace {

template <class Scalar>
class TerrainTriangles : public testing::Test {
protected:
    static std::vector<Vector3<Scalar>> flatTriangle(double y) {
        return {at<Scalar>(0, y, 0), at<Scalar>(4, y, 0), at<Scalar>(0, y, 4)};
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TerrainTriangles, Scalars);

TYPED_TEST(TerrainTriangles, AreNumberedAsTheyAreHandedIn) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    EXPECT_EQ(terrain.size(), 0U);
    EXPECT_EQ(terrain.add(this->flatTriangle(1)).first, 0U);
    const AddedTriangles added = terrain.add(this->flatTriangle(2));
    EXPECT_EQ(added.first, 1U);
    EXPECT_EQ(added.count, 1U);
    EXPECT_TRUE(added.refused.empty());
    EXPECT_EQ(terrain.size(), 2U);
    EXPECT_EQ(grid.size(), 2U);
    EXPECT_EQ(terrain.surfaceBelow(at<TypeParam>(1, 1.5, 1))->triangle, 0U);
    EXPECT_EQ(terrain.surfaceBelow(at<TypeParam>(1, 9, 1))->triangle, 1U);
    EXPECT_GT(terrain.memoryBytes(), 2 * 9 * sizeof(TypeParam));
}

TYPED_TEST(TerrainTriangles, GoAlongWhenTheOriginIsShifted) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    terrain.add(std::vector<Vector3<TypeParam>>{at<TypeParam>(0, 1, 0), at<TypeParam>(8, 3, 0),
                                                at<TypeParam>(0, 2, 8)});
    terrain.add(this->flatTriangle(std::numeric_limits<double>::quiet_NaN()));  // refused
    terrain.add(this->flatTriangle(0.5));
    const auto shift = at<TypeParam>(1024, -512, 64);
    for (const TypeParam height : {TypeParam(9), TypeParam(0.75)}) {
        const auto point = at<TypeParam>(1, static_cast<double>(height), 2);
        const auto before = terrain.surfaceBelow(point);
        ASSERT_TRUE(before);
        grid.shiftOrigin(shift);
        terrain.shiftOrigin(shift);
        const auto after = terrain.surfaceBelow(point - shift);
        ASSERT_TRUE(after);
        EXPECT_EQ(after->triangle, before->triangle);
        EXPECT_EQ(after->height, before->height + 512);
        grid.shiftOrigin(-shift);
        terrain.shiftOrigin(-shift);
        EXPECT_EQ(terrain.surfaceBelow(point), before);
    }
    EXPECT_TRUE(hasNan(Aabb<TypeParam>(terrain.corners(1)[0], terrain.corners(1)[1])));
    EXPECT_EQ(terrain.corners(2)[1], at<TypeParam>(4, 0.5, 0));
}

TYPED_TEST(TerrainTriangles, KeepTheirCornersInOrderAndTheirNormalsUpward) {
    Grid<TypeParam> grid;
    for (const UpAxis up : {UpAxis::x, UpAxis::y, UpAxis::z}) {
        Terrain<TypeParam> terrain(grid, up);
        Random random(0x5eed2001);
        for (int i = 0; i < 200; ++i) {
            std::vector<Vector3<TypeParam>> corners;
            for (int k = 0; k < 3; ++k) {
                corners.push_back(random.pointIn(-5, 5).cast<TypeParam>());
            }
            const std::uint32_t number = terrain.add(corners).first;
            const auto kept = terrain.corners(number);
            EXPECT_TRUE(std::equal(corners.begin(), corners.end(), kept.begin()));
            const Vector3<TypeParam> normal = terrain.normal(number);
            EXPECT_NEAR(normal.norm(), 1, 1e-5);
            EXPECT_NEAR(normal.dot((corners[1] - corners[0]).normalized()), 0, 1e-4);
            EXPECT_NEAR(normal.dot((corners[2] - corners[0]).normalized()), 0, 1e-4);
            EXPECT_GT(normal[static_cast<int>(up)], 0);
        }
    }
}

TYPED_TEST(TerrainTriangles, WithABadCornerAreRefusedAndNamed) {
    using Limits = std::numeric_limits<TypeParam>;
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    std::vector<Vector3<TypeParam>> corners;
    const std::vector<TypeParam> bad{Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()};
    for (int i = 0; i < 27; ++i) {
        for (const auto& corner : this->flatTriangle(i)) {
            corners.push_back(corner);
        }
        if (i < 27 && i % 2 == 1) {
            corners[static_cast<std::size_t>(3 * i + i % 3)][i / 3 % 3] =
                bad[static_cast<std::size_t>(i / 9)];
        }
    }
    const CaughtMessages messages;
    const AddedTriangles added = terrain.add(corners);
    EXPECT_EQ(added.count, 27U);
    ASSERT_EQ(added.refused.size(), 13U);
    for (std::uint32_t i = 0; i < 13; ++i) {
        EXPECT_EQ(added.refused[i], 2 * i + 1);
        EXPECT_TRUE(terrain.proxy(2 * i + 1).isNull());
        EXPECT_TRUE(terrain.corners(2 * i + 1)[0].hasNaN());
        EXPECT_EQ(terrain.normal(2 * i + 1), Vector3<TypeParam>::Zero());
    }
    EXPECT_EQ(grid.size(), 14U);
    EXPECT_EQ(grid.nanCount(), 0U);
    EXPECT_TRUE(messages.all().empty());
    for (int i = 0; i < 27; ++i) {
        const auto found = terrain.surfaceBelow(at<TypeParam>(1, i + 0.5, 1));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->triangle, static_cast<std::uint32_t>(i / 2 * 2));
    }
}

TYPED_TEST(TerrainTriangles, ThatNameNoVertexAreRefused) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    const auto vertices = this->flatTriangle(1);
    const std::vector<std::uint32_t> indices{0, 1, 3, 0, 1, 2, ~0U, 1, 2};
    const AddedTriangles added = terrain.add(vertices, indices);
    EXPECT_EQ(added.refused, (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(terrain.surfaceBelow(at<TypeParam>(1, 5, 1))->triangle, 1U);
}

TYPED_TEST(TerrainTriangles, FartherThanSquaresReachAreRefused) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    const bool isSingle = sizeof(TypeParam) == sizeof(float);
    const auto far = std::numeric_limits<TypeParam>::max();
    const std::vector<Vector3<TypeParam>> corners{{-far, 0, -far}, {far, 0, -far}, {0, 2, far}};
    EXPECT_EQ(terrain.add(corners).refused.size(), isSingle ? 0U : 1U);
    const auto found = terrain.surfaceBelow(at<TypeParam>(0, 5, 0));
    EXPECT_EQ(found.has_value(), isSingle);
    if (found) {
        EXPECT_NEAR(found->height, 1, 1e-6);
    }
}

TYPED_TEST(TerrainTriangles, AreToldFromOtherProxiesOfTheGrid) {
    Grid<TypeParam> grid;
    Random random(0x5eed2002);
    std::vector<ProxyId> others;
    for (int i = 0; i < 300; ++i) {
        const Vector3<TypeParam> low = random.pointIn(-3, 3).template cast<TypeParam>();
        others.push_back(grid.add({low, low + Vector3<TypeParam>::Ones()}));
    }
    auto upper = std::make_unique<Terrain<TypeParam>>(grid);
    Terrain<TypeParam> lower(grid);
    upper->add(this->flatTriangle(3));
    lower.add(this->flatTriangle(1));
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_EQ(upper->surfaceBelow(at<TypeParam>(1, 5, 1))->height, 3);
        EXPECT_EQ(lower.surfaceBelow(at<TypeParam>(1, 5, 1))->height, 1);
        EXPECT_EQ(lower.restingHeight(at<TypeParam>(1, 5, 1), 1)->height, 2);
        for (const ProxyId id : others) {
            const Aabb<TypeParam> box = grid.box(id);
            grid.move(id, {box.min(), box.max() + Vector3<TypeParam>::Constant(TypeParam(0.1))});
        }
        grid.update();
    }
    upper.reset();
    EXPECT_EQ(grid.size(), others.size() + 1);
    EXPECT_EQ(lower.surfaceBelow(at<TypeParam>(1, 5, 1))->height, 1);
    grid.update();
    EXPECT_EQ(grid.validate(), "");
}

TYPED_TEST(TerrainTriangles, LeaveTheGridWhenTheyAreCleared) {
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    terrain.add(this->flatTriangle(1));
    grid.update();
    terrain.clear();
    EXPECT_EQ(grid.size(), 0U);
    EXPECT_EQ(terrain.size(), 0U);
    EXPECT_FALSE(terrain.surfaceBelow(at<TypeParam>(1, 5, 1)));
    // What takes their places in the grid is not the ground's.
    for (int i = 0; i < 10; ++i) {
        static_cast<void>(grid.add({at<TypeParam>(0, 0, 0), at<TypeParam>(4, 4, 4)}));
        grid.update();
    }
    EXPECT_FALSE(terrain.surfaceBelow(at<TypeParam>(1, 5, 1)));
    EXPECT_EQ(terrain.add(this->flatTriangle(2)).first, 0U);
    EXPECT_EQ(terrain.surfaceBelow(at<TypeParam>(1, 5, 1))->height, 2);
}

TYPED_TEST(TerrainTriangles, ComeInThrees) {
    const ThrowingAsserts asserts;
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    const std::vector<Vector3<TypeParam>> two(2, Vector3<TypeParam>::Zero());
    const std::vector<std::uint32_t> one{0};
    if (HASHPHASE_ENABLE_ASSERTS) {
        EXPECT_THROW(terrain.add(two), BrokenAssert);
        EXPECT_THROW(terrain.add(two, one), BrokenAssert);
        EXPECT_THROW(static_cast<void>(terrain.corners(0)), BrokenAssert);
        EXPECT_THROW(static_cast<void>(terrain.normal(0)), BrokenAssert);
        EXPECT_THROW(static_cast<void>(terrain.proxy(0)), BrokenAssert);
    }
}

TYPED_TEST(TerrainTriangles, StayWhereTheyAreWhenTheShiftIsNotFinite) {
    CaughtAsserts caught;
    Grid<TypeParam> grid;
    Terrain<TypeParam> terrain(grid);
    terrain.add(this->flatTriangle(2));
    const TypeParam nan = std::numeric_limits<TypeParam>::quiet_NaN();
    terrain.shiftOrigin(at<TypeParam>(nan, 0, 0));
    EXPECT_EQ(caught.count(), HASHPHASE_ENABLE_ASSERTS);
    EXPECT_EQ(terrain.surfaceBelow(at<TypeParam>(1, 5, 1))->height, 2);
}

}  // namespace
}  // namespace hashphase::test
