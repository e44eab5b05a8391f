// SPDX-License-Identifier: Zlib

// Who stands where the ground has changed.

#include <tests/integration/terrain/changing_ground.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <memory>

namespace hashphase::test {
namespace {

template <class Scalar>
class GroundChanged : public testing::Test {
protected:
    static std::vector<Vector3<Scalar>> flat(double x, double y) {
        return {at<Scalar>(x, y, 0), at<Scalar>(x + 4, y, 0), at<Scalar>(x, y, 4)};
    }
    std::vector<ProxyId> find(const ChangedGround<Scalar>& changed, Scalar reach) const {
        std::vector<ProxyId> standing;
        changed.findStanding(bodies, reach, standing);
        return standing;
    }

    Grid<Scalar> bodies;
    Grid<Scalar> grid;
    Terrain<Scalar> terrain{grid};
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GroundChanged, Scalars);

TYPED_TEST(GroundChanged, NamesJustThoseThatTouchIt) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        ChangingGround<TypeParam> ground(0x5eed2570 + seed, static_cast<UpAxis>(seed % 3));
        Random random(seed);
        for (int round = 0; round < 60; ++round) {
            ground.forgetChanges();
            for (std::uint32_t i = random.below(6); i > 0; --i) {
                ground.step();
            }
            Grid<TypeParam> elsewhere;
            std::vector<ProxyId> ids;
            for (int i = 0; i < 40; ++i) {
                const auto middle = ground.drawPoint();
                ids.push_back(elsewhere.add(boxAround<TypeParam>(middle, TypeParam(0.2))));
            }
            const auto reach = static_cast<TypeParam>(random.chance(0.3) ? 0 : random.unit());
            ground.expectStanding(elsewhere, ids, reach);
            ground.expectStanding(ground.grid, ground.others, reach);
            ASSERT_FALSE(this->HasFailure()) << "round " << round;
        }
    }
}

TYPED_TEST(GroundChanged, NamesWhatStoodThereAndWhatIsLifted) {
    const ProxyId low = this->bodies.add({at<TypeParam>(1, 0, 1), at<TypeParam>(2, 1, 2)});
    const ProxyId high = this->bodies.add({at<TypeParam>(1, 5, 1), at<TypeParam>(2, 6, 2)});
    const ProxyId away = this->bodies.add({at<TypeParam>(7, 0, 1), at<TypeParam>(8, 6, 2)});
    this->terrain.add(this->flat(0, 0));
    ChangedGround<TypeParam> changed(this->terrain);
    EXPECT_TRUE(this->find(changed, 9).empty());
    this->terrain.replace(0, this->flat(0, 4.75));
    EXPECT_EQ(this->find(changed, 0), std::vector<ProxyId>{low});
    EXPECT_EQ(this->find(changed, TypeParam(0.25)), (std::vector<ProxyId>{low, high}));
    std::vector<ProxyId> standing;
    changed.findStanding(this->bodies, TypeParam(0.25), standing,
                         [&](ProxyId id) { return id != low; });
    EXPECT_EQ(standing, std::vector<ProxyId>{high});
    changed.clear();
    EXPECT_TRUE(this->find(changed, 9).empty());
    this->terrain.remove(0);
    EXPECT_EQ(this->find(changed, 4), (std::vector<ProxyId>{low, high, away}));
}

TYPED_TEST(GroundChanged, LeavesOutTheTerrainsOwnTriangles) {
    Terrain<TypeParam> otherTerrain(this->grid);
    ChangedGround<TypeParam> changed(this->terrain);
    this->terrain.add(this->flat(0, 1));
    otherTerrain.add(this->flat(0, 1));
    std::vector<ProxyId> standing;
    changed.findStanding(this->grid, 1, standing);
    EXPECT_EQ(standing, std::vector<ProxyId>{otherTerrain.proxy(0)});
    // In another grid, the same ids are of others.
    const ProxyId body = this->bodies.add({at<TypeParam>(1, 0, 1), at<TypeParam>(2, 1, 2)});
    ASSERT_EQ(body, this->terrain.proxy(0));
    EXPECT_EQ(this->find(changed, 0), std::vector<ProxyId>{body});
}

TYPED_TEST(GroundChanged, IsToldToAllThatAsk) {
    const ProxyId body = this->bodies.add({at<TypeParam>(1, 0, 1), at<TypeParam>(2, 1, 2)});
    auto first = std::make_unique<ChangedGround<TypeParam>>(this->terrain);
    this->terrain.add(this->flat(0, 1));
    this->terrain.add(this->flat(20, 1));
    const ChangedGround<TypeParam> second(this->terrain);
    this->terrain.replace(0, this->flat(8, 1));
    EXPECT_EQ(first->boxes().size(), 4U);
    EXPECT_EQ(second.boxes().size(), 2U);
    first.reset();
    this->terrain.remove(0);
    EXPECT_EQ(second.boxes().size(), 2U) << "the same place again";
    EXPECT_EQ(this->find(second, 0), std::vector<ProxyId>{body});
}

TYPED_TEST(GroundChanged, JoinsBoxesThatAreOneTogether) {
    ChangedGround<TypeParam> changed(this->terrain);
    const auto quad = quads<TypeParam>(
        *std::make_unique<Random>(1), 1,
        [](std::uint32_t i, std::uint32_t k) { return at<TypeParam>(i, i == k ? 1 : 0, k); });
    addTo(this->terrain, quad);
    EXPECT_EQ(changed.boxes().size(), 1U);
    this->terrain.remove(0, 2);
    EXPECT_EQ(changed.boxes().size(), 1U);
}

TYPED_TEST(GroundChanged, TakesNoMoreMemoryThanItHasAndMissesNobody) {
    constexpr std::size_t kMost = 64;
    ChangedGround<TypeParam> changed(this->terrain, kMost);
    const std::size_t bytes = changed.memoryBytes();
    EXPECT_EQ(bytes, kMost * sizeof(Aabb<TypeParam>));
    std::vector<ProxyId> ids;
    for (int i = 0; i < 1000; ++i) {
        ids.push_back(this->bodies.add(boxAround<TypeParam>(at<TypeParam>(9 * i, 1, 0), 1)));
        this->terrain.add(this->flat(9 * i, 0));
        ASSERT_LE(changed.boxes().size(), kMost);
        ASSERT_EQ(this->find(changed, 0).size(), ids.size());
    }
    EXPECT_EQ(changed.memoryBytes(), bytes);
    ChangedGround<TypeParam> least(this->terrain, 0);
    this->terrain.remove(0, 1000);
    EXPECT_LE(least.boxes().size(), 2U);
    EXPECT_EQ(this->find(least, 0).size(), ids.size());
}

TYPED_TEST(GroundChanged, IsFoundWithinAReach) {
    ChangedGround<TypeParam> changed(this->terrain);
    this->terrain.add(this->flat(0, 0));
    static_cast<void>(this->bodies.add(boxAround<TypeParam>({1, 0, 1}, 1)));
    for (const TypeParam reach : {TypeParam(-1), std::numeric_limits<TypeParam>::quiet_NaN()}) {
        if (HASHPHASE_ENABLE_ASSERTS) {
            const ThrowingAsserts asserts;
            EXPECT_THROW(this->find(changed, reach), BrokenAssert);
        }
        const CaughtAsserts caught;
        EXPECT_TRUE(this->find(changed, reach).empty());
    }
    EXPECT_EQ(this->find(changed, std::numeric_limits<TypeParam>::infinity()).size(), 1U);
}

TYPED_TEST(GroundChanged, IsDestroyedBeforeItsTerrain) {
    auto own = std::make_unique<Terrain<TypeParam>>(this->grid);
    const ChangedGround<TypeParam> changed(*own);
    const CaughtAsserts caught;
    own.reset();
    EXPECT_EQ(caught.count(), HASHPHASE_ENABLE_ASSERTS);
    EXPECT_TRUE(this->find(changed, 1).empty());
}

}  // namespace
}  // namespace hashphase::test
