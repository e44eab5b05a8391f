// SPDX-License-Identifier: Zlib

// Who is within a distance of whom: from position to position (RadiusSearch) and from box to box (Neighbours).
// What random operations ask of both, radii that are none among them: tests/fuzz.

#include <broadphase/neighbours.hpp>
#include <broadphase/radius_search.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/neighbour_oracle.hpp>
#include <tests/support/population.hpp>
#include <tests/support/radius_oracle.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <tuple>
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
class WhoIsNear : public testing::Test {
protected:
    static constexpr std::uint32_t kGroups = 5;

    static std::uint32_t groupOf(ProxyId id) { return id.index % 7; }  // two are not counted

    /// A point as a box without extent.
    ProxyId addPoint(double x, double y, double z) {
        return world_.add(makeBox<Scalar>(x, y, z, x, y, z));
    }
    void addPoints(std::size_t count, double low, double high) {
        world_.addMany(count, cubesIn<Scalar>(low, high, 0));
    }

    std::vector<std::uint32_t> count() {
        std::vector<std::uint32_t> counts(search_.size());
        search_.count(counts);
        return counts;
    }

    /// What the crowd lists, counts, and counts by group is what brute force finds. Returns how many
    /// neighbours there are.
    std::size_t expectLikeBruteForce(const Grid<Scalar>& grid,
                                     std::span<const Placed<Scalar>> proxies, Scalar radius) {
        SCOPED_TRACE(testing::Message() << "within " << radius);
        search_.take(grid, radius);
        const NeighbourLists expected = neighboursByBruteForce(proxies, radius);
        EXPECT_EQ(neighbourLists(search_), expected);
        if (search_.size() != expected.size()) {
            return 0;
        }
        std::vector<std::uint32_t> groups(std::size_t{search_.size()} * kGroups);
        search_.countGroups(kGroups, groupOf, groups);
        std::uint32_t visited = 0;
        std::size_t sum = 0;
        const auto visit = [&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
            EXPECT_EQ(agent, visited++) << "in order, on one thread";
            const ProxyId id = search_.id(agent);
            EXPECT_EQ(search_.position(agent), agentPosition(grid.box(id)));
            EXPECT_TRUE(std::ranges::equal(groupCounts(expected.at(id), kGroups, groupOf),
                                           std::span(groups).subspan(agent * kGroups, kGroups)));
            sum += neighbours.size();
        };
        const QueryCost cost = search_.forEach(visit);
        EXPECT_EQ(visited, search_.size());
        EXPECT_EQ(cost.hits, sum);
        EXPECT_GE(cost.boxesTested, cost.hits);
        return sum;
    }
    std::size_t expectLikeBruteForce(double radius) {
        return expectLikeBruteForce(world_.grid, world_.proxies, static_cast<Scalar>(radius));
    }

    /// How far apart some two of the proxies are: neighbours that are just near enough.
    static Scalar anyDistance(Random& random, std::span<const Placed<Scalar>> proxies) {
        const auto any = [&] {
            return agentPosition(
                proxies[random.below(static_cast<std::uint32_t>(proxies.size()))].box);
        };
        // In higher precision, which knows the squares of denormal numbers.
        const Vector3<long double> way = (any() - any()).template cast<long double>();
        return static_cast<Scalar>(way.norm());
    }

    /// All that a search tells, in its order, and what it costs.
    auto askAll(ParallelFor parallelFor) {
        std::vector<std::uint32_t> counts(search_.size());
        search_.count(counts, parallelFor);
        std::vector<std::uint32_t> groups(counts.size() * kGroups);
        search_.countGroups(kGroups, groupOf, groups, parallelFor);
        std::vector<std::vector<std::uint32_t>> lists(search_.size());
        const QueryCost cost = search_.forEach(
            [&lists](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                lists[agent].assign(neighbours.begin(), neighbours.end());
            },
            parallelFor);
        const std::vector ids(search_.ids().begin(), search_.ids().end());
        return std::tuple(ids, counts, groups, lists, cost.hits);
    }

    Population<Scalar> world_;
    RadiusSearch<Scalar> search_;
    Neighbours<Scalar> neighbours_;
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(WhoIsNear, Scalars);

TYPED_TEST(WhoIsNear, IsWhomBruteForceFindsAtEveryMomentOfAFrameInEveryScene) {
    for (const BoxScene<TypeParam>& scene : allBoxScenes<TypeParam>()) {
        GridWorld<TypeParam> world;
        Script<TypeParam> script(scene, 0x5eed0e01);
        script.begin(world);
        std::size_t found = 0;
        for (int frame = 0; frame < 16; ++frame) {
            SCOPED_TRACE(testing::Message() << scene.name << ", frame " << frame);
            const auto proxies = script.proxies();
            const TypeParam distance = this->anyDistance(script.random(), proxies);
            for (const TypeParam radius : {distance, distance / 8}) {
                found += this->expectLikeBruteForce(world.grid, proxies, radius);
            }
            const std::size_t any =
                script.random().below(static_cast<std::uint32_t>(proxies.size()));
            const TypeParam size = proxies[any].box.sizes().maxCoeff();
            for (const TypeParam within :
                 {TypeParam(0), size * TypeParam(0.3), size * TypeParam(4)}) {
                const auto pairs = this->neighbours_.find(world.grid, within);
                expectNeighboursLikeBruteForce(pairs, proxies, within);
                EXPECT_EQ(this->neighbours_.lastCost().hits, pairs.size());
            }
            if (frame % 3 != 1) {
                world.grid.update();
            }
            ASSERT_FALSE(this->HasFailure());
            script.playFrame(world);
        }
        EXPECT_GT(found, 1000U) << scene.name;
    }
}

// --- From position to position -------------------------------------------------------------------

TYPED_TEST(WhoIsNear, FindsThoseOfBruteForceForAnyNumberOfAgents) {
    for (const std::size_t count :
         {0U, 1U, 2U, 3U, 15U, 16U, 17U, 63U, 64U, 65U, 66U, 130U, 1200U}) {
        SCOPED_TRACE(count);
        this->addPoints(count - this->world_.proxies.size(), 0, 20);
        for (const double radius : {0.0, 1.5, 6.0, 50.0}) {
            this->expectLikeBruteForce(radius);
        }
    }
}

TYPED_TEST(WhoIsNear, FindsThoseOfBruteForceInPlanesAndLines) {
    for (const std::uint32_t flatAxes : {1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
        SCOPED_TRACE(flatAxes);
        Population<TypeParam> world;
        world.addMany(700, [&](Random& random) {
            Vector3<double> at = random.pointIn(0, 60);
            for (int axis = 0; axis < 3; ++axis) {
                at[axis] = ((flatAxes >> axis) & 1) != 0 ? 7 : at[axis];
            }
            return boxAround<TypeParam>(at, {0.5, 0.5, 0.5});
        });
        for (const double radius : {1.0, 4.0, 13.0}) {
            const auto within = static_cast<TypeParam>(radius);
            EXPECT_GT(this->expectLikeBruteForce(world.grid, world.proxies, within), 10U);
        }
    }
}

// Cells are about as large as the radius, and every agent is on a border or next to it.
TYPED_TEST(WhoIsNear, FindsWhoIsJustNearEnoughWhereverCellsEnd) {
    Random random(0x5eed0e09);
    std::size_t found = 0;
    for (int row = 0; row < 60; ++row) {
        const double radius = random.logBetween(1e-3, 1e3);
        const double begin = radius * random.between(-300, 300);
        Population<TypeParam> world;
        for (int i = 0; i < 120; ++i) {
            world.add(boxAround<TypeParam>({begin + i * radius, 0, 0}, Vector3<double>::Zero()));
        }
        const auto within = static_cast<TypeParam>(radius);
        found += this->expectLikeBruteForce(world.grid, world.proxies, within);
        ASSERT_FALSE(this->HasFailure());
    }
    EXPECT_GT(found, 60U * 60);
}

TYPED_TEST(WhoIsNear, MeasuresAStraightClosedBallInSpace) {
    this->addPoint(0, 0, 0);
    this->addPoint(2, 3, 6);  // 7 away
    EXPECT_EQ(this->expectLikeBruteForce(6.999), 0U);
    EXPECT_EQ(this->expectLikeBruteForce(7), 2U);
    EXPECT_NE(this->search_.id(0), this->search_.id(1));
}

TYPED_TEST(WhoIsNear, TakesWhomTheFilterAccepts) {
    this->addPoints(600, 0, 20);
    this->world_.keepOnly([](std::size_t i) { return i < 500; });
    const auto isAgent = [this](ProxyId id) {
        EXPECT_TRUE(this->world_.grid.contains(id));
        return id.index % 16 == 3;
    };
    std::vector<Placed<TypeParam>> agents = this->world_.proxies;
    std::erase_if(agents, [&](const auto& proxy) { return !isAgent(proxy.id); });
    this->search_.take(this->world_.grid, 8, isAgent);
    EXPECT_EQ(neighbourLists(this->search_), neighboursByBruteForce<TypeParam>(agents, 8));
    EXPECT_EQ(this->search_.leftOutCount(), 0U);
    this->search_.take(this->world_.grid, 8, [](ProxyId) { return false; });
    EXPECT_EQ(this->search_.size(), 0U);
    EXPECT_EQ(this->count().size(), 0U);
}

TYPED_TEST(WhoIsNear, CountsAsManyGroupsAsThereMayBe) {
    constexpr std::uint32_t kMost = RadiusSearch<TypeParam>::kMostGroups;
    for (std::uint32_t i = 0; i < 100; ++i) {
        this->addPoint(0, 0, 0);
    }
    this->search_.take(this->world_.grid, 1);
    std::vector<std::uint32_t> counts(100 * kMost, 77);
    const auto groupOf = [](ProxyId id) { return id.index < kMost ? id.index : id.index * 1000; };
    EXPECT_EQ(this->search_.countGroups(kMost, groupOf, counts).hits, 99 * kMost);
    for (std::uint32_t agent = 0; agent < 100; ++agent) {
        for (std::uint32_t group = 0; group < kMost; ++group) {
            const bool isOwn = groupOf(this->search_.id(agent)) == group;
            ASSERT_EQ(counts[agent * kMost + group], isOwn ? 0U : 1U);
        }
    }
    EXPECT_EQ(this->search_.countGroups(0, groupOf, {}).hits, 0U);
}

TYPED_TEST(WhoIsNear, IsTheSameOnAnyNumberOfThreads) {
    using Corner = Vector3<double>;
    this->world_.addMany(9000, cubesIn<TypeParam>(Corner(0, 0, 0), Corner(60, 60, 15), 0));
    this->search_.take(this->world_.grid, 3);
    const auto expected = this->askAll(serialFor);
    EXPECT_GT(std::get<4>(expected), 100000U);
    for (const std::size_t threads : {2U, 5U}) {
        ThreadedFor threadedFor(threads, threads);
        this->search_.take(this->world_.grid, 3, acceptAll, threadedFor);
        EXPECT_EQ(this->askAll(threadedFor), expected);
        EXPECT_GT(threadedFor.mostRanges(), 1U);
    }
    const std::size_t bytes = this->search_.memoryBytes();
    this->search_.take(this->world_.grid, 3);
    this->askAll(serialFor);
    EXPECT_EQ(this->search_.memoryBytes(), bytes);
}

// Rows of few cells, which a few at a time would read as a whole.
TYPED_TEST(WhoIsNear, ListsNeighboursInOneOrderWhereverPartsBegin) {
    for (const double width : {3.5, 4.5, 6.5, 9.5}) {
        SCOPED_TRACE(width);
        Population<TypeParam> world;
        world.addMany(6000, [&, i = 0](Random& random) mutable {
            // A few strays before the others.
            const double x = ++i % 97 == 1 ? -random.between(0, 0.5) : random.between(0, width);
            const double y = random.between(0, 50);
            return boxAround<TypeParam>({x, y, random.between(0, 50)}, Vector3<double>::Zero());
        });
        this->search_.take(world.grid, 1);
        const auto expected = this->askAll(serialFor);
        for (const std::size_t step : {7U, 12U, 31U}) {
            const auto inParts = [step](std::size_t count, std::size_t /*grain*/, LoopBody body) {
                for (std::size_t begin = 0; begin < count; begin += step) {
                    body(begin, std::min(count, begin + step));
                }
            };
            EXPECT_EQ(this->askAll(inParts), expected) << step;
        }
    }
}

// Cells are for where most are, whatever the others do and however small the radius is.
TYPED_TEST(WhoIsNear, CostsNoMoreForStraysAndSmallRadii) {
    Random random(0x5eed0e08);
    constexpr std::uint32_t kCount = 4000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vector3<double> at = random.pointIn(0, 400);
        const double away = random.chance(0.01) ? random.logBetween(1e3, 1e15) : 0;
        this->addPoint(at[0] + away, at[1] - away, 1 + away);
    }
    std::vector<std::uint32_t> counts(kCount);
    for (const double radius : {0.0, 1e-20, 0.1, 2.0, 6.0}) {
        this->search_.take(this->world_.grid, static_cast<TypeParam>(radius));
        const QueryCost cost = this->search_.count(counts);
        EXPECT_LT(cost.boxesTested, 100U * kCount) << radius;
        EXPECT_LT(cost.rowsVisited, 20U * kCount) << radius;
        EXPECT_LT(this->search_.memoryBytes(), 400U * kCount) << radius;
    }
}

// --- From box to box -----------------------------------------------------------------------------

// Even those at infinity.
TYPED_TEST(WhoIsNear, FromBoxToBoxAreAllWithinInfinity) {
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, 4.0, -kNoLimit, kNoLimit}) {
        this->world_.add(makeBox<TypeParam>(x, 0, 0, x, 1, 1));
    }
    const auto infinity = static_cast<TypeParam>(kNoLimit);
    EXPECT_EQ(this->neighbours_.find(this->world_.grid, infinity).size(), 6U);
    EXPECT_EQ(this->neighbours_.find(this->world_.grid, 100).size(), 1U);
}

// Cells that fit one distance are far too small for another.
TYPED_TEST(WhoIsNear, FromBoxToBoxCostsNoMoreAfterAnotherDistance) {
    constexpr std::uint32_t kCount = 3000;
    this->world_.addMany(kCount, cubesIn<TypeParam>(0, 60, 0.25));
    this->world_.update();
    for (const double distance : {0.1, 2.0, 0.1, 4.0, 0.5}) {
        static_cast<void>(
            this->neighbours_.find(this->world_.grid, static_cast<TypeParam>(distance)));
        EXPECT_LT(this->neighbours_.lastCost().boxesTested, 200U * kCount) << distance;
    }
}

TYPED_TEST(WhoIsNear, FromBoxToBoxIsTheSameOnAnyNumberOfThreads) {
    const Grid<TypeParam>& grid = this->world_.grid;
    this->world_.addMany(9000, cubesIn<TypeParam>(0, 60, 0.5));
    this->world_.update();
    const auto alone = this->neighbours_.find(grid, 2);
    const std::vector<ProxyPair> expected(alone.begin(), alone.end());
    EXPECT_GT(expected.size(), 5000U);
    for (const std::size_t threads : {2U, 5U}) {
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
