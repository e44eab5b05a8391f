// SPDX-License-Identifier: Zlib

#include <integration/picking/pick.hpp>
#include <tests/integration/scene_lives.hpp>
#include <tests/support/picking_oracle.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class Pick : public testing::Test {
protected:
    static void expectSame(const Picked<Scalar>& found, const Picked<Scalar>& expected) {
        EXPECT_EQ(found.id, expected.id);
        EXPECT_EQ(found.fraction, expected.fraction);
        EXPECT_EQ(found.point, expected.point);
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Pick, Scalars);

TYPED_TEST(Pick, FindsWhatBruteForceFindsByBoxAndByTest) {
    std::size_t picks = 0;
    std::size_t testedForNearest = 0;
    std::size_t testedForAll = 0;
    playAllScenes<TypeParam>(0x5eed0721, 12, [&](const auto& grid, auto& script, int) {
        const auto byBox = [&](ProxyId id, const RayRegion<TypeParam>& ray, TypeParam) {
            return std::optional(ray.key(grid.box(id)));
        };
        // Shapes are missed by two rays of three, and lie somewhere in their boxes.
        std::size_t tested = 0;
        const auto byShape = [&](ProxyId id, const RayRegion<TypeParam>& ray,
                                 TypeParam limit) -> std::optional<TypeParam> {
            const TypeParam key = ray.key(grid.box(id));
            EXPECT_LE(key, limit);
            ++tested;
            const std::uint32_t kind = id.index % 6;
            return kind > 2 ? std::nullopt
                            : std::optional(key + (1 - key) * static_cast<TypeParam>(kind) / 4);
        };
        const auto filter = [](ProxyId id) { return id.index % 3 != 1; };
        std::vector<Picked<TypeParam>> picked;
        const auto expect = [&](const auto& expected, const Picked<TypeParam>& nearest) {
            ASSERT_EQ(picked.size(), expected.size());
            for (std::size_t i = 0; i < picked.size(); ++i) {
                this->expectSame(picked[i], expected[i]);
            }
            this->expectSame(nearest, expected.empty() ? Picked<TypeParam>{} : expected[0]);
        };
        RegionMaker<TypeParam> maker(script.random(), script.proxies());
        for (int i = 0; i < 40; ++i) {
            const RayRegion<TypeParam> ray = maker.ray(i % 4 == 3);
            const auto expected = [&](const auto& test, ProxyFilter accept) {
                return pickAllByBruteForce<TypeParam>(script.proxies(), ray, test, accept);
            };
            const QueryCost cost = pickAll(grid, ray, picked);
            EXPECT_EQ(cost.hits, picked.size());
            expect(expected(byBox, acceptAll), pickNearest(grid, ray));
            picks += picked.size();
            pickAll(grid, ray, picked, filter);
            expect(expected(byBox, filter), pickNearest(grid, ray, filter));
            const auto shapes = expected(byShape, filter);
            tested = 0;
            pickAll(grid, ray, picked, byShape, filter);
            testedForAll += std::exchange(tested, 0);
            const Picked<TypeParam> nearest = pickNearest(grid, ray, byShape, filter);
            testedForNearest += tested;
            expect(shapes, nearest);
        }
    });
    EXPECT_GT(picks, 20000U);
    EXPECT_LT(testedForNearest * 4, testedForAll * 3);
}

TYPED_TEST(Pick, SeesChangesAtOnce) {
    Grid<TypeParam> grid;
    const ProxyId near = grid.add(makeBox<TypeParam>(2, -1, -1, 3, 1, 1));
    const ProxyId far = grid.add(makeBox<TypeParam>(5, -1, -1, 6, 1, 1));
    const RayRegion<TypeParam> ray(Vector3<TypeParam>::Zero(), Vector3<TypeParam>(10, 0, 0));
    EXPECT_EQ(pickNearest(grid, ray).id, near);
    grid.move(near, makeBox<TypeParam>(2, 3, -1, 3, 4, 1));
    const Picked<TypeParam> picked = pickNearest(grid, ray);
    EXPECT_EQ(picked.id, far);
    EXPECT_EQ(picked.fraction, TypeParam(0.5));
    EXPECT_EQ(picked.point, Vector3<TypeParam>(5, 0, 0));
    grid.remove(far);
    EXPECT_TRUE(pickNearest(grid, ray).id.isNull());
}

TYPED_TEST(Pick, TakesNoAnswerOfATestThatIsNaNNegativeOrTooFar) {
    Grid<TypeParam> grid;
    const ProxyId id = grid.add(makeBox<TypeParam>(2, -1, -1, 3, 1, 1));
    const RayRegion<TypeParam> ray(Vector3<TypeParam>::Zero(), Vector3<TypeParam>(10, 0, 0));
    std::vector<Picked<TypeParam>> picked;
    constexpr auto nan = std::numeric_limits<TypeParam>::quiet_NaN();
    for (const TypeParam answer : {nan, TypeParam(-0.5), TypeParam(1.01)}) {
        const auto test = [answer](ProxyId, const RayRegion<TypeParam>&, TypeParam) {
            return std::optional(answer);
        };
        EXPECT_TRUE(pickNearest(grid, ray, test).id.isNull());
        pickAll(grid, ray, picked, test);
        EXPECT_TRUE(picked.empty());
    }
    const auto atEnd = [](ProxyId, const RayRegion<TypeParam>&, TypeParam limit) {
        return std::optional(limit);
    };
    EXPECT_EQ(pickNearest(grid, ray, atEnd).id, id);
}

TYPED_TEST(Pick, FindsNothingAlongAnEmptyRayOrInAnEmptyGrid) {
    const Vector3<TypeParam> zero = Vector3<TypeParam>::Zero();
    const Vector3<TypeParam> nan =
        Vector3<TypeParam>::Constant(std::numeric_limits<TypeParam>::quiet_NaN());
    Grid<TypeParam> grid;
    std::vector<Picked<TypeParam>> picked(3);
    EXPECT_TRUE(pickNearest(grid, RayRegion<TypeParam>(zero, zero)).id.isNull());
    pickAll(grid, RayRegion<TypeParam>(zero, zero), picked);
    EXPECT_TRUE(picked.empty());
    const ProxyId id = grid.add(makeBox<TypeParam>(-1, -1, -1, 1, 1, 1));
    EXPECT_TRUE(pickNearest(grid, RayRegion<TypeParam>(nan, nan)).id.isNull());
    EXPECT_EQ(pickNearest(grid, RayRegion<TypeParam>(zero, zero)).id, id);
}

}  // namespace
}  // namespace hashphase::test
