// SPDX-License-Identifier: Zlib

#include <broadphase/neighbours.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/neighbour_oracle.hpp>
#include <tests/support/population.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

template <class Found>
concept CanBeAskedInPassing = requires(Found found, const Grid<float>& grid) {
    std::move(found).find(grid, 1.0F);
};
static_assert(!CanBeAskedInPassing<Neighbours<float>>, "pairs would outlive what holds them");

template <class Scalar>
class NeighboursTest : public testing::Test {
protected:
    std::size_t expectLikeBruteForce(const Grid<Scalar>& grid,
                                     std::span<const Placed<Scalar>> proxies, Scalar distance) {
        const auto found = neighbours_.find(grid, distance);
        expectNeighboursLikeBruteForce(found, proxies, distance);
        EXPECT_EQ(neighbours_.lastCost().hits, found.size());
        return found.size();
    }

    Population<Scalar> world_;
    Neighbours<Scalar> neighbours_;
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NeighboursTest, Scalars);

TYPED_TEST(NeighboursTest, AreThoseOfBruteForceAtEveryMomentOfAFrameInEveryScene) {
    std::size_t found = 0;
    for (BoxScene<TypeParam> scene : allBoxScenes<TypeParam>()) {
        scene.count = scene.count / 2;
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0d01);
        script.begin(world);
        for (int frame = 0; frame < 12; ++frame) {
            SCOPED_TRACE(testing::Message() << scene.name << ", frame " << frame);
            const auto proxies = script.proxies();
            const auto any = [&] {
                return proxies[script.random().below(static_cast<std::uint32_t>(proxies.size()))];
            };
            const TypeParam size = any().box.sizes().maxCoeff();
            for (const double distance : {0.0, 0.3, 1.0, 4.0}) {
                const TypeParam within = distance == 0 ? TypeParam(0) : size * TypeParam(distance);
                found += this->expectLikeBruteForce(world.grid, proxies, within);
            }
            if (frame % 3 != 1) {
                world.grid.update();
            }
            ASSERT_FALSE(this->HasFailure());
            script.playFrame(world);
        }
    }
    EXPECT_GT(found, 100'000U);
}

TYPED_TEST(NeighboursTest, AreClosedAndMeasuredStraight) {
    using Limits = std::numeric_limits<TypeParam>;
    this->world_.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    this->world_.add(makeBox<TypeParam>(4, 5, 0, 5, 6, 1));  // 3, 4, 0 away
    const auto countWithin = [this](TypeParam distance) {
        return this->neighbours_.find(this->world_.grid, distance).size();
    };
    EXPECT_EQ(countWithin(TypeParam(4.999F)), 0U);
    EXPECT_EQ(countWithin(5), 1U);
    EXPECT_EQ(countWithin(-1), 0U);
    EXPECT_EQ(countWithin(Limits::quiet_NaN()), 0U);
    // Within infinity are all, even those at infinity.
    const auto infinity = static_cast<double>(Limits::infinity());
    this->world_.add(makeBox<TypeParam>(-infinity, 0, 0, -infinity, 1, 1));
    this->world_.add(makeBox<TypeParam>(infinity, 0, 0, infinity, 1, 1));
    EXPECT_EQ(countWithin(Limits::infinity()), 6U);
    EXPECT_EQ(countWithin(100), 1U);
}

// Cells that fit one distance are far too small for another.
TYPED_TEST(NeighboursTest, CostNoMoreAfterAnotherDistance) {
    constexpr std::uint32_t kCount = 3000;
    this->world_.addMany(kCount, cubesIn<TypeParam>(0, 60, 0.25));
    this->world_.update();
    for (const double distance : {0.1, 2.0, 0.1, 4.0, 0.5}) {
        static_cast<void>(
            this->neighbours_.find(this->world_.grid, static_cast<TypeParam>(distance)));
        EXPECT_LT(this->neighbours_.lastCost().boxesTested, 200U * kCount) << distance;
    }
}

TYPED_TEST(NeighboursTest, AreTheSameOnAnyNumberOfThreads) {
    const Grid<TypeParam>& grid = this->world_.grid;
    this->world_.addMany(9000, cubesIn<TypeParam>(0, 60, 0.5));
    this->world_.update();
    const auto alone = this->neighbours_.find(grid, 2);
    const std::vector<ProxyPair> expected(alone.begin(), alone.end());
    EXPECT_GT(expected.size(), 5000U);
    for (const std::size_t threads : {2, 5}) {
        ThreadedFor threadedFor(threads, threads);
        ASSERT_TRUE(std::ranges::equal(this->neighbours_.find(grid, 2, threadedFor), expected));
        EXPECT_GT(threadedFor.mostRanges(), 1U);
    }
    const std::size_t bytes = this->neighbours_.memoryBytes();
    static_cast<void>(this->neighbours_.find(grid, 2));
    EXPECT_EQ(this->neighbours_.memoryBytes(), bytes);
}

}  // namespace
}  // namespace hashphase::test
