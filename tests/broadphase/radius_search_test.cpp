// SPDX-License-Identifier: Zlib

#include <broadphase/radius_search.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/radius_oracle.hpp>
#include <tests/support/script.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <vector>

namespace hashphase::test {
namespace {

template <class Scalar>
class RadiusSearchTest : public testing::Test {
protected:
    static constexpr std::uint32_t kGroups = 5;

    static std::uint32_t groupOf(ProxyId id) { return id.index % 7; }  // two are not counted

    /// A point as a box without extent.
    ProxyId addPoint(double x, double y, double z) {
        const Aabb<Scalar> box = makeBox<Scalar>(x, y, z, x, y, z);
        proxies_.push_back({grid_.add(box), box});
        return proxies_.back().id;
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
        EXPECT_EQ(search_.size(), expected.size());
        const std::vector<std::uint32_t> counts = count();
        std::vector<std::uint32_t> groups(std::size_t{search_.size()} * kGroups);
        search_.countGroups(kGroups, groupOf, groups);
        std::size_t visited = 0;
        std::size_t sum = 0;
        const auto visit = [&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
            EXPECT_EQ(agent, visited++) << "in order, on one thread";
            const auto own = expected.find(search_.id(agent));
            ASSERT_NE(own, expected.end());
            EXPECT_EQ(search_.position(agent), agentPosition(grid.box(own->first)));
            std::vector<ProxyId> ids;
            for (const std::uint32_t neighbour : neighbours) {
                ids.push_back(search_.id(neighbour));
            }
            std::sort(ids.begin(), ids.end());
            EXPECT_EQ(differences(ids, own->second), "") << "of agent " << agent;
            EXPECT_EQ(counts[agent], own->second.size());
            const auto groupsOfAgent = groups.begin() + agent * kGroups;
            const auto expectedGroups = groupCounts(own->second, kGroups, groupOf);
            EXPECT_TRUE(std::equal(expectedGroups.begin(), expectedGroups.end(), groupsOfAgent));
            sum += ids.size();
        };
        const QueryCost cost = search_.forEach(visit);
        EXPECT_EQ(visited, search_.size());
        EXPECT_EQ(cost.hits, sum);
        EXPECT_GE(cost.boxesTested, cost.hits);
        return sum;
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

    Grid<Scalar> grid_;
    std::vector<Placed<Scalar>> proxies_;
    RadiusSearch<Scalar> search_;
    CaughtMessages aboutNan_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(RadiusSearchTest, Scalars);

TYPED_TEST(RadiusSearchTest, FindsThoseOfBruteForceAtEveryMomentOfAFrameInEveryScene) {
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
            if (frame % 3 != 1) {
                world.grid.update();
            }
            ASSERT_FALSE(this->HasFailure());
            script.playFrame(world);
        }
        EXPECT_GT(found, 1000U) << scene.name;
    }
}

// The definition itself: no more than rounding away from the true distance.
TYPED_TEST(RadiusSearchTest, MeasuresWithinRounding) {
    constexpr auto slack = static_cast<long double>(4 * std::numeric_limits<TypeParam>::epsilon());
    Random random(0x5eed0e02);
    std::size_t near = 0;
    for (int i = 0; i < 20000; ++i) {
        constexpr double most = sizeof(TypeParam) == sizeof(float) ? 1e37 : 1e300;
        const auto radius = static_cast<TypeParam>(random.logBetween(1 / most, most));
        const Vector3<TypeParam> a = random.pointIn(-2, 2).template cast<TypeParam>() * radius;
        const Vector3<TypeParam> b =
            a + random.pointIn(-0.8, 0.8).template cast<TypeParam>() * radius;
        long double squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const long double way =
                (static_cast<long double>(a[axis]) - b[axis]) / static_cast<long double>(radius);
            squared += way * way;
        }
        const bool found = areNeighbours(a, b, radius);
        ASSERT_EQ(found, areNeighbours(b, a, radius));
        ASSERT_FALSE(found && squared > 1 + slack) << radius;
        ASSERT_FALSE(!found && squared < 1 - slack) << radius;
        near += found ? 1 : 0;
    }
    EXPECT_GT(near, 5000U);
}

TYPED_TEST(RadiusSearchTest, FindsThoseOfBruteForceForAnyNumberOfAgents) {
    Random random(0x5eed0e03);
    for (const std::size_t count : {0, 1, 2, 3, 15, 16, 17, 63, 64, 65, 66, 130, 1200}) {
        while (this->proxies_.size() < count) {
            const Vector3<double> at = random.pointIn(0, 20);
            this->addPoint(at[0], at[1], at[2]);
        }
        for (const double radius : {0.0, 1.5, 6.0, 50.0}) {
            SCOPED_TRACE(count);
            this->expectLikeBruteForce(this->grid_, this->proxies_, static_cast<TypeParam>(radius));
        }
    }
}

TYPED_TEST(RadiusSearchTest, FindsThoseOfBruteForceInPlanesAndLines) {
    Random random(0x5eed0e04);
    for (const std::uint32_t flatAxes : {1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies;
        for (int i = 0; i < 700; ++i) {
            Vector3<double> at = random.pointIn(0, 60);
            for (int axis = 0; axis < 3; ++axis) {
                at[axis] = ((flatAxes >> axis) & 1) != 0 ? 7 : at[axis];
            }
            const Aabb<TypeParam> box = boxAround<TypeParam>(at, {0.5, 0.5, 0.5});
            proxies.push_back({grid.add(box), box});
        }
        SCOPED_TRACE(flatAxes);
        for (const double radius : {1.0, 4.0, 13.0}) {
            const auto found =
                this->expectLikeBruteForce(grid, proxies, static_cast<TypeParam>(radius));
            EXPECT_GT(found, 10U);
        }
    }
}

// Cells are about as large as the radius, and every agent is on a border or next to it.
TYPED_TEST(RadiusSearchTest, FindsWhoIsJustNearEnoughWhereverCellsEnd) {
    Random random(0x5eed0e09);
    std::size_t found = 0;
    for (int row = 0; row < 60; ++row) {
        const double radius = random.logBetween(1e-3, 1e3);
        const double begin = radius * random.between(-300, 300);
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies;
        for (int i = 0; i < 120; ++i) {
            const Vector3<double> at(begin + i * radius, 0, 0);
            const Aabb<TypeParam> box = boxAround<TypeParam>(at, Vector3<double>::Zero());
            proxies.push_back({grid.add(box), box});
        }
        found += this->expectLikeBruteForce(grid, proxies, static_cast<TypeParam>(radius));
        ASSERT_FALSE(this->HasFailure());
    }
    EXPECT_GT(found, 60U * 60);
}

TYPED_TEST(RadiusSearchTest, MeasuresAStraightClosedBallInSpace) {
    const ProxyId corner = this->addPoint(0, 0, 0);
    const ProxyId beside = this->addPoint(2, 3, 6);  // 7 away
    this->search_.take(this->grid_, TypeParam(6.999));
    EXPECT_EQ(this->count(), (std::vector<std::uint32_t>{0, 0}));
    this->search_.take(this->grid_, 7);
    EXPECT_EQ(this->count(), (std::vector<std::uint32_t>{1, 1}));
    EXPECT_NE(this->search_.id(0), this->search_.id(1));
    for (const ProxyId id : this->search_.ids()) {
        EXPECT_TRUE(id == corner || id == beside);
    }
}

TYPED_TEST(RadiusSearchTest, FindsWithinNothingThoseAtTheSamePlace) {
    constexpr double kTiny = 1e-30;
    this->addPoint(5, 5, 5);
    this->addPoint(5, 5, 5);
    this->addPoint(0, 0, 0);
    this->addPoint(kTiny, 0, 0);  // whose squared distance would vanish
    EXPECT_EQ(this->expectLikeBruteForce(this->grid_, this->proxies_, 0), 2U);
    EXPECT_EQ(
        this->expectLikeBruteForce(this->grid_, this->proxies_, static_cast<TypeParam>(2 * kTiny)),
        4U);
}

TYPED_TEST(RadiusSearchTest, FindsNobodyWithinANegativeOrNaNRadius) {
    for (int i = 0; i < 40; ++i) {
        this->addPoint(0, 0, i % 2);
    }
    using Limits = std::numeric_limits<TypeParam>;
    for (const TypeParam radius : {TypeParam(-1), -Limits::infinity(), Limits::quiet_NaN()}) {
        EXPECT_EQ(this->expectLikeBruteForce(this->grid_, this->proxies_, radius), 0U);
        EXPECT_EQ(this->search_.size(), 40U);
    }
}

TYPED_TEST(RadiusSearchTest, FindsEverybodyWithinAHugeRadius) {
    using Limits = std::numeric_limits<TypeParam>;
    Random random(0x5eed0e05);
    for (int i = 0; i < 300; ++i) {
        const Vector3<double> at = random.pointIn(-1e6, 1e6);
        this->addPoint(at[0], at[1], at[2]);
    }
    const auto most = static_cast<double>(Limits::max());
    for (const TypeParam radius : {TypeParam(1e7), Limits::max() / 2, Limits::infinity()}) {
        EXPECT_EQ(this->expectLikeBruteForce(this->grid_, this->proxies_, radius), 300U * 299);
    }
    this->addPoint(most, most, -most);
    this->addPoint(-most, -most, most);  // farther apart than any number
    EXPECT_EQ(this->expectLikeBruteForce(this->grid_, this->proxies_, Limits::infinity()),
              302U * 301);
    EXPECT_EQ(this->expectLikeBruteForce(this->grid_, this->proxies_, TypeParam(1e7)), 300U * 299);
}

TYPED_TEST(RadiusSearchTest, LeavesOutWhoHasNoFiniteCentre) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Aabb<TypeParam> half = makeBox<TypeParam>(0, 0, 0, infinity, 1, 1);
    const Aabb<TypeParam> all =
        makeBox<TypeParam>(-infinity, -infinity, -infinity, infinity, infinity, infinity);
    const Aabb<TypeParam> bad =
        makeBox<TypeParam>(std::numeric_limits<double>::quiet_NaN(), 0, 0, 1, 1, 1);
    for (const Aabb<TypeParam>& box : {half, all, bad}) {
        static_cast<void>(this->grid_.add(box));
    }
    const ProxyId plane =
        this->grid_.add(makeBox<TypeParam>(-1e18, -1e18, -1e18, 1e18, 1e18, 1e18));
    const ProxyId stone = this->addPoint(1, 1, 1);
    this->search_.take(this->grid_, 10);
    EXPECT_EQ(this->search_.leftOutCount(), 3U);
    ASSERT_EQ(this->search_.size(), 2U);
    EXPECT_EQ(this->count(), (std::vector<std::uint32_t>{1, 1}));
    EXPECT_EQ(std::min(this->search_.id(0), this->search_.id(1)), plane);
    EXPECT_EQ(std::max(this->search_.id(0), this->search_.id(1)), stone);
}

TYPED_TEST(RadiusSearchTest, TakesWhomTheFilterAccepts) {
    Random random(0x5eed0e06);
    for (int i = 0; i < 600; ++i) {
        const Vector3<double> at = random.pointIn(0, 20);
        this->addPoint(at[0], at[1], at[2]);
    }
    for (int i = 0; i < 100; ++i) {
        this->grid_.remove(this->proxies_.back().id);
        this->proxies_.pop_back();
    }
    std::vector<Placed<TypeParam>> agents;
    const auto isAgent = [this](ProxyId id) {
        EXPECT_TRUE(this->grid_.contains(id));
        return id.index % 16 == 3;
    };
    std::copy_if(this->proxies_.begin(), this->proxies_.end(), std::back_inserter(agents),
                 [&](const auto& proxy) { return isAgent(proxy.id); });
    this->search_.take(this->grid_, 8, isAgent);
    const NeighbourLists expected = neighboursByBruteForce<TypeParam>(agents, 8);
    ASSERT_EQ(this->search_.size(), expected.size());
    EXPECT_EQ(this->search_.leftOutCount(), 0U);
    const std::vector<std::uint32_t> counts = this->count();
    for (std::uint32_t agent = 0; agent < this->search_.size(); ++agent) {
        EXPECT_EQ(counts[agent], expected.at(this->search_.id(agent)).size());
    }
    this->search_.take(this->grid_, 8, [](ProxyId) { return false; });
    EXPECT_EQ(this->search_.size(), 0U);
    EXPECT_EQ(this->count().size(), 0U);
}

TYPED_TEST(RadiusSearchTest, CountsAsManyGroupsAsThereMayBe) {
    constexpr std::uint32_t kMost = RadiusSearch<TypeParam>::kMostGroups;
    for (std::uint32_t i = 0; i < 100; ++i) {
        this->addPoint(0, 0, 0);
    }
    this->search_.take(this->grid_, 1);
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

TYPED_TEST(RadiusSearchTest, IsTheSameOnAnyNumberOfThreads) {
    Random random(0x5eed0e07);
    for (int i = 0; i < 9000; ++i) {
        const Vector3<double> at = random.pointIn(0, 60);
        this->addPoint(at[0], at[1], at[2] / 4);
    }
    using Lists = std::vector<std::vector<std::uint32_t>>;
    const auto ask = [this](ParallelFor parallelFor, std::vector<ProxyId>& ids,
                            std::vector<std::uint32_t>& counts, QueryCost& cost) {
        this->search_.take(this->grid_, 3, acceptAll, parallelFor);
        ids.assign(this->search_.ids().begin(), this->search_.ids().end());
        counts.resize(this->search_.size());
        this->search_.count(counts, parallelFor);
        std::vector<std::uint32_t> groups(counts.size() * 5);
        this->search_.countGroups(5, this->groupOf, groups, parallelFor);
        counts.insert(counts.end(), groups.begin(), groups.end());
        Lists lists(this->search_.size());
        cost = this->search_.forEach(
            [&lists](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                lists[agent].assign(neighbours.begin(), neighbours.end());
            },
            parallelFor);
        return lists;
    };
    std::vector<ProxyId> ids;
    std::vector<std::uint32_t> counts;
    QueryCost cost;
    const Lists expected = ask(serialFor, ids, counts, cost);
    EXPECT_GT(cost.hits, 100000U);
    for (const std::size_t threads : {2, 5}) {
        ThreadedFor threadedFor(threads, threads);
        std::vector<ProxyId> otherIds;
        std::vector<std::uint32_t> otherCounts;
        QueryCost otherCost;
        EXPECT_EQ(ask(threadedFor, otherIds, otherCounts, otherCost), expected);
        EXPECT_EQ(otherIds, ids);
        EXPECT_EQ(otherCounts, counts);
        EXPECT_EQ(otherCost.hits, cost.hits);
        EXPECT_GT(threadedFor.mostRanges(), 1U);
    }
    const std::size_t bytes = this->search_.memoryBytes();
    ask(serialFor, ids, counts, cost);
    EXPECT_EQ(this->search_.memoryBytes(), bytes);
}

// Cells are for where most are, whatever the others do and however small the radius is.
// Rows of few cells, which a few at a time would read as a whole.
TYPED_TEST(RadiusSearchTest, ListsNeighboursInOneOrderWhereverPartsBegin) {
    using Lists = std::vector<std::vector<std::uint32_t>>;
    for (const double width : {3.5, 4.5, 6.5, 9.5}) {
        SCOPED_TRACE(width);
        Random random(0x5eed0e0b);
        Grid<TypeParam> grid;
        for (int i = 0; i < 6000; ++i) {
            // A few strays before the others.
            const double x = i % 97 == 1 ? -random.between(0, 0.5) : random.between(0, width);
            const Vector3<TypeParam> at =
                Vector3<double>(x, random.between(0, 50), random.between(0, 50)).cast<TypeParam>();
            static_cast<void>(grid.add({at, at}));
        }
        RadiusSearch<TypeParam> search;
        search.take(grid, 1);
        const auto list = [&search](ParallelFor parallelFor) {
            Lists lists(search.size());
            search.forEach(
                [&lists](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                    lists[agent].assign(neighbours.begin(), neighbours.end());
                },
                parallelFor);
            return lists;
        };
        const Lists expected = list(serialFor);
        for (const std::size_t step : {7U, 12U, 31U}) {
            const auto inParts = [step](std::size_t count, std::size_t /*grain*/, LoopBody body) {
                for (std::size_t begin = 0; begin < count; begin += step) {
                    body(begin, std::min(count, begin + step));
                }
            };
            EXPECT_EQ(list(inParts), expected) << step;
        }
    }
}

TYPED_TEST(RadiusSearchTest, CostsNoMoreForStraysAndSmallRadii) {
    Random random(0x5eed0e08);
    constexpr std::uint32_t kCount = 4000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vector3<double> at = random.pointIn(0, 400);
        const double away = random.chance(0.01) ? random.logBetween(1e3, 1e15) : 0;
        this->addPoint(at[0] + away, at[1] - away, 1 + away);
    }
    std::vector<std::uint32_t> counts(kCount);
    for (const double radius : {0.0, 1e-20, 0.1, 2.0, 6.0}) {
        this->search_.take(this->grid_, static_cast<TypeParam>(radius));
        const QueryCost cost = this->search_.count(counts);
        EXPECT_LT(cost.boxesTested, 100U * kCount) << radius;
        EXPECT_LT(cost.rowsVisited, 20U * kCount) << radius;
        EXPECT_LT(this->search_.memoryBytes(), 400U * kCount) << radius;
    }
}

TYPED_TEST(RadiusSearchTest, WantsOneCountForEachAgentAndGroupAndNoMoreGroupsThanThereMayBe) {
    const ThrowingAsserts throwingAsserts;
    this->addPoint(0, 0, 0);
    this->search_.take(this->grid_, 1);
    std::vector<std::uint32_t> counts(2);
    EXPECT_THROW(this->search_.count(counts), BrokenAssert);
    EXPECT_THROW(this->search_.countGroups(3, this->groupOf, counts), BrokenAssert);
    counts.resize(33);
    EXPECT_THROW(this->search_.countGroups(33, this->groupOf, counts), BrokenAssert);
}

TYPED_TEST(RadiusSearchTest, OfAgentsThatThereAreNotIsAsserted) {
    const ThrowingAsserts throwingAsserts;
    this->addPoint(0, 0, 0);
    this->search_.take(this->grid_, 1);
    EXPECT_TRUE(this->search_.position(0).isZero(TypeParam(0)));
    EXPECT_THROW(static_cast<void>(this->search_.id(1)), BrokenAssert);
    EXPECT_THROW(static_cast<void>(this->search_.position(1)), BrokenAssert);
}

}  // namespace
}  // namespace hashphase::test
