// SPDX-License-Identifier: Zlib

#include <broadphase/neighbours.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
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
    using ProxyPairs = std::vector<ProxyPair>;

    static ProxyPairs sorted(std::span<const ProxyPair> pairs) {
        ProxyPairs result(pairs.begin(), pairs.end());
        std::sort(result.begin(), result.end());
        return result;
    }

    /// The definition, in higher precision than that of the boxes: what is surely near, and what
    /// may be, by rounding.
    struct Expected {
        ProxyPairs near;
        ProxyPairs perhaps;
    };
    static Expected byBruteForce(std::span<const Placed<Scalar>> proxies, Scalar distance) {
        constexpr auto slack = static_cast<long double>(8 * std::numeric_limits<Scalar>::epsilon());
        Expected expected;
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            for (std::size_t j = i + 1; j < proxies.size(); ++j) {
                const Aabb<Scalar>& a = proxies[i].box;
                const Aabb<Scalar>& b = proxies[j].box;
                if (hasNan(a) || hasNan(b)) {
                    continue;
                }
                long double squared = 0;
                for (int axis = 0; axis < 3; ++axis) {
                    const long double before =
                        static_cast<long double>(a.min()[axis]) - b.max()[axis];
                    const long double behind =
                        static_cast<long double>(b.min()[axis]) - a.max()[axis];
                    const long double gap = std::max({0.0L, before, behind});
                    squared += gap * gap;
                }
                const ProxyId first = std::min(proxies[i].id, proxies[j].id);
                const ProxyId second = std::max(proxies[i].id, proxies[j].id);
                const long double apart = std::sqrt(squared);
                if (apart <= distance * (1 - slack)) {
                    expected.near.push_back({first, second});
                }
                if (apart <= distance * (1 + slack)) {
                    expected.perhaps.push_back({first, second});
                }
            }
        }
        std::sort(expected.near.begin(), expected.near.end());
        std::sort(expected.perhaps.begin(), expected.perhaps.end());
        return expected;
    }

    std::size_t expectLikeBruteForce(const Grid<Scalar>& grid,
                                     std::span<const Placed<Scalar>> proxies, Scalar distance) {
        const ProxyPairs found = sorted(neighbours_.find(grid, distance));
        const Expected expected = byBruteForce(proxies, distance);
        EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "each once";
        EXPECT_TRUE(
            std::includes(found.begin(), found.end(), expected.near.begin(), expected.near.end()))
            << "all that are near, within " << distance;
        EXPECT_TRUE(std::includes(expected.perhaps.begin(), expected.perhaps.end(), found.begin(),
                                  found.end()))
            << "none that are not, within " << distance;
        EXPECT_EQ(neighbours_.lastCost().hits, found.size());
        return found.size();
    }

    Neighbours<Scalar> neighbours_;
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NeighboursTest, Scalars);

TYPED_TEST(NeighboursTest, AreThoseOfBruteForceAtEveryMomentOfAFrame) {
    std::size_t found = 0;
    for (const auto& scene :
         {spreadScene<TypeParam>("small", 1, 0), spreadScene<TypeParam>("large, away", 100, 5e4)}) {
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0d01);
        script.begin(world);
        const double scale = scene.name == "small" ? 1 : 100;
        for (int frame = 0; frame < 24; ++frame) {
            SCOPED_TRACE(testing::Message() << scene.name << ", frame " << frame);
            for (const double distance : {0.0, 0.3, 1.0, 4.0}) {
                found += this->expectLikeBruteForce(world.grid, script.proxies(),
                                                    static_cast<TypeParam>(distance * scale));
            }
            if (frame % 3 != 1) {
                world.grid.update();
            }
            ASSERT_FALSE(this->HasFailure());
            script.playFrame(world);
        }
    }
    EXPECT_GT(found, 10000U);
}

TYPED_TEST(NeighboursTest, AtNoDistanceAreTheOverlappingPairs) {
    Random random(0x5eed0d02);
    Grid<TypeParam> grid;
    std::vector<Placed<TypeParam>> proxies;
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        for (int i = 0; i < 60; ++i) {
            const Aabb<TypeParam> box = scene.draw(random);
            proxies.push_back({grid.add(box), box});
        }
    }
    grid.update();
    std::vector<ProxyPair> expected;
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t j = i + 1; j < proxies.size(); ++j) {
            // An inverted box is apart from one that it does not contain, however near.
            const bool areOrdered = !proxies[i].box.isEmpty() && !proxies[j].box.isEmpty();
            if (areOrdered && overlaps(proxies[i].box, proxies[j].box)) {
                expected.push_back({proxies[i].id, proxies[j].id});
            }
        }
    }
    std::sort(expected.begin(), expected.end());
    const auto found = this->sorted(this->neighbours_.find(grid, 0));
    EXPECT_GT(expected.size(), 300U);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
    for (const ProxyPair& pair : found) {
        const Aabb<TypeParam>& a = grid.box(pair.first);
        const Aabb<TypeParam>& b = grid.box(pair.second);
        ASSERT_TRUE(a.isEmpty() || b.isEmpty() || overlaps(a, b));
    }
}

TYPED_TEST(NeighboursTest, WithinNegativeOrNaNDistanceAreNone) {
    Grid<TypeParam> grid;
    const Aabb<TypeParam> box = makeBox<TypeParam>(0, 0, 0, 1, 1, 1);
    const ProxyId one = grid.add(box);
    const ProxyId other = grid.add(box);
    EXPECT_EQ(this->neighbours_.find(grid, -1).size(), 0U);
    EXPECT_EQ(this->neighbours_.find(grid, std::numeric_limits<TypeParam>::quiet_NaN()).size(), 0U);
    const auto all = this->neighbours_.find(grid, std::numeric_limits<TypeParam>::infinity());
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0], (ProxyPair{one, other}));
}

TYPED_TEST(NeighboursTest, WithinInfinityAreAllEvenThoseAtInfinity) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Grid<TypeParam> grid;
    for (const double x : {-infinity, 0.0, infinity}) {
        static_cast<void>(grid.add(makeBox<TypeParam>(x, 0, 0, x, 1, 1)));
    }
    const auto all = std::numeric_limits<TypeParam>::infinity();
    EXPECT_EQ(this->neighbours_.find(grid, all).size(), 3U);
    EXPECT_EQ(this->neighbours_.find(grid, 100).size(), 0U);
}

// Cells that fit one distance are far too small for another.
TYPED_TEST(NeighboursTest, CostNoMoreAfterAnotherDistance) {
    Random random(0x5eed0d04);
    Grid<TypeParam> grid;
    constexpr std::uint32_t kCount = 3000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto half = Vector3<double>::Constant(0.25);
        static_cast<void>(grid.add(boxAround<TypeParam>(random.pointIn(0, 60), half)));
    }
    grid.update();
    for (const double distance : {0.1, 2.0, 0.1, 4.0, 0.5}) {
        static_cast<void>(this->neighbours_.find(grid, static_cast<TypeParam>(distance)));
        EXPECT_LT(this->neighbours_.lastCost().boxesTested, 200U * kCount) << distance;
    }
}

TYPED_TEST(NeighboursTest, AreClosedAndMeasuredStraight) {
    Grid<TypeParam> grid;
    const ProxyId corner = grid.add(makeBox<TypeParam>(0, 0, 0, 1, 1, 1));
    const ProxyId beside = grid.add(makeBox<TypeParam>(4, 5, 0, 5, 6, 1));  // 3, 4, 0 away
    EXPECT_EQ(this->neighbours_.find(grid, 4.999F).size(), 0U);
    const auto found = this->neighbours_.find(grid, 5);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0], (ProxyPair{corner, beside}));
}

TYPED_TEST(NeighboursTest, AreTheSameOnAnyNumberOfThreads) {
    Random random(0x5eed0d03);
    Grid<TypeParam> grid;
    for (int i = 0; i < 9000; ++i) {
        static_cast<void>(grid.add(boxAround<TypeParam>(random.pointIn(0, 60), {0.5, 0.5, 0.5})));
    }
    grid.update();
    const auto alone = this->neighbours_.find(grid, 2);
    const std::vector<ProxyPair> expected(alone.begin(), alone.end());
    EXPECT_GT(expected.size(), 5000U);
    for (const std::size_t threads : {2, 5}) {
        ThreadedFor threadedFor(threads, threads);
        const auto found = this->neighbours_.find(grid, 2, threadedFor);
        ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end()));
        EXPECT_GT(threadedFor.mostRanges(), 1U);
    }
    const std::size_t bytes = this->neighbours_.memoryBytes();
    static_cast<void>(this->neighbours_.find(grid, 2));
    EXPECT_EQ(this->neighbours_.memoryBytes(), bytes);
}

}  // namespace
}  // namespace hashphase::test
