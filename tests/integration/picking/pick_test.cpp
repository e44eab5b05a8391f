// SPDX-License-Identifier: Zlib

#include <integration/picking/pick.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/picking_oracle.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <optional>
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

    static void expectSame(std::span<const Picked<Scalar>> found,
                           const std::vector<Picked<Scalar>>& expected) {
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            expectSame(found[i], expected[i]);
        }
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Pick, Scalars);

TYPED_TEST(Pick, FindsWhatBruteForceFindsByBoxAndByTest) {
    std::size_t picks = 0;
    std::size_t testedForNearest = 0;
    std::size_t testedForAll = 0;
    const CaughtMessages messages;  // about boxes that are NaN
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        SCOPED_TRACE(scene.name);
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0721);
        script.begin(world);
        std::vector<Picked<TypeParam>> picked;
        for (int frame = 0; frame < 12; ++frame) {
            script.playFrame(world);
            if (frame % 3 != 0) {
                world.grid.update();
            }
            const auto byBox = [&](ProxyId id, const RayRegion<TypeParam>& ray, TypeParam) {
                return std::optional(ray.key(world.grid.box(id)));
            };
            // Shapes are missed by two rays of three, and lie somewhere in their boxes.
            std::size_t tested = 0;
            const auto byShape = [&](ProxyId id, const RayRegion<TypeParam>& ray,
                                     TypeParam limit) -> std::optional<TypeParam> {
                EXPECT_LE(ray.key(world.grid.box(id)), limit);
                ++tested;
                const TypeParam key = ray.key(world.grid.box(id));
                const std::uint32_t kind = id.index % 6;
                if (kind > 2) {
                    return std::nullopt;
                }
                return key + (1 - key) * static_cast<TypeParam>(kind) / 4;
            };
            const auto filter = [](ProxyId id) { return id.index % 3 != 1; };
            RegionMaker<TypeParam> maker(script.random(), script.proxies());
            for (int i = 0; i < 40; ++i) {
                const RayRegion<TypeParam> ray = maker.ray(i % 4 == 3);
                const auto boxes =
                    pickAllByBruteForce<TypeParam>(script.proxies(), ray, byBox, acceptAll);
                const QueryCost cost = pickAll(world.grid, ray, picked);
                EXPECT_EQ(cost.hits, boxes.size());
                this->expectSame(picked, boxes);
                this->expectSame(pickNearest(world.grid, ray),
                                 boxes.empty() ? Picked<TypeParam>{} : boxes[0]);
                const auto filtered =
                    pickAllByBruteForce<TypeParam>(script.proxies(), ray, byBox, filter);
                pickAll(world.grid, ray, picked, filter);
                this->expectSame(picked, filtered);
                this->expectSame(pickNearest(world.grid, ray, filter),
                                 filtered.empty() ? Picked<TypeParam>{} : filtered[0]);
                const auto shapes =
                    pickAllByBruteForce<TypeParam>(script.proxies(), ray, byShape, filter);
                tested = 0;
                pickAll(world.grid, ray, picked, byShape, filter);
                this->expectSame(picked, shapes);
                testedForAll += tested;
                tested = 0;
                this->expectSame(pickNearest(world.grid, ray, byShape, filter),
                                 shapes.empty() ? Picked<TypeParam>{} : shapes[0]);
                testedForNearest += tested;
                picks += boxes.size();
            }
        }
    }
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
