// SPDX-License-Identifier: Zlib

// After a peak: what has come and gone is given back, and what is left takes what it would take alone. That ids
// given back are never valid again is among the random operations (tests/fuzz).

#include <broadphase/neighbours.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/count_allocations.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/population.hpp>
#include <tests/support/radius_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

enum class Left { first, last, scattered };
constexpr Left kAllLeft[] = {Left::first, Left::last, Left::scattered};

// Updates after which memory is given back, and then some.
constexpr int kManyUpdates = 300;

template <class Scalar>
Aabb<Scalar> anyBox(Random& random) {
    const Vector3<Scalar> low = random.pointIn(0, 30).cast<Scalar>();
    return {low, low + Vector3<Scalar>::Ones()};
}

// Removes all but some.
template <class World>
void leave(World& world, std::size_t count, Left left) {
    const std::size_t size = world.proxies.size();
    world.keepOnly([=](std::size_t i) {
        return left == Left::first  ? i < count
               : left == Left::last ? i >= size - count
                                    : i % (size / count) == 0;
    });
}

// As a game does: moves some, updates and asks.
template <class World>
void playFrames(World& world, int count) {
    using Scalar = typename World::Box::Scalar;
    for (int frame = 0; frame < count; ++frame) {
        for (std::size_t i = 0; i < world.proxies.size(); i += 2) {
            world.moveTo(i, anyBox<Scalar>(world.random));
        }
        world.update();
        CollectCount collector;
        world.grid.visit(RayRegion<Scalar>({0, 0, 0}, {30, 30, 30}), collector);
    }
}

template <class Scalar>
class AfterAPeak : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AfterAPeak, Scalars);

/// Grid and Pairs, and nothing that watches them.
template <class Scalar>
struct PlainWorld : GridWorld<Scalar> {
    Pairs<Scalar> pairs{this->grid};

    void update() { pairs.update(); }
    [[nodiscard]] std::size_t bytes() const {
        return this->grid.memoryBytes() + pairs.memoryBytes();
    }
};

TYPED_TEST(AfterAPeak, UpdatesGiveBackWhatWasNotUsedForAWhile) {
    Population<TypeParam, PlainWorld> alone;
    alone.addMany(100, anyBox<TypeParam>, 3);
    playFrames(alone, kManyUpdates);
    Population<TypeParam, PlainWorld> world;
    world.addMany(30000, anyBox<TypeParam>, 3);
    playFrames(world, 3);
    const std::size_t atPeak = world.bytes();
    leave(world, 100, Left::first);
    playFrames(world, 100);
    EXPECT_GE(world.bytes(), atPeak) << "the peak may come again";
    playFrames(world, kManyUpdates);
    EXPECT_LT(world.bytes(), 2 * alone.bytes());
    EXPECT_LT(alone.bytes(), atPeak / 50);
    EXPECT_LE(world.grid.indexLimit(), 100U);
    EXPECT_EQ(world.grid.validate() + world.pairs.validate(), "");
}

TYPED_TEST(AfterAPeak, ACallGivesBackWhatIsNotUsedAtOnce) {
    for (const Left left : kAllLeft) {
        Population<TypeParam> world;
        world.addMany(20000, anyBox<TypeParam>, 3);
        world.update();
        const std::size_t atPeak = world.grid.memoryBytes();
        leave(world, 100, left);
        world.update();
        EXPECT_GE(world.grid.memoryBytes(), atPeak);
        world.moveTo(1, anyBox<TypeParam>(world.random));
        world.update();  // in cells for those that are left
        world.grid.releaseUnusedMemory();
        // What is left at the end keeps the records below.
        const std::size_t records = world.grid.indexLimit() * (sizeof(TypeParam) == 4 ? 64U : 128U);
        EXPECT_EQ(left == Left::first, world.grid.indexLimit() == 100U);
        EXPECT_LT(world.grid.memoryBytes(), records + 64 * 1024);
        EXPECT_EQ(world.grid.validate(), "");
        const auto all = makeBox<TypeParam>(0, 0, 0, 31, 31, 31);
        EXPECT_EQ(world.expectLikeBruteForce(BoxRegion<TypeParam>{all}), 100U);
    }
}

TYPED_TEST(AfterAPeak, NewProxiesTakeTheLowestIndices) {
    Population<TypeParam> world;
    world.addMany(1000, anyBox<TypeParam>, 3);
    world.update();
    leave(world, 10, Left::last);
    world.update();
    world.grid.releaseUnusedMemory();
    EXPECT_EQ(world.grid.indexLimit(), 1000U);
    world.addMany(20, anyBox<TypeParam>);
    for (std::uint32_t i = 0; i < 20; ++i) {
        EXPECT_EQ(world.proxies[10 + i].id.index, i);
    }
    leave(world, 20, Left::last);
    world.update();
    world.grid.releaseUnusedMemory();
    EXPECT_EQ(world.grid.indexLimit(), 20U);
}

TYPED_TEST(AfterAPeak, WhatIsReservedStaysUntilItIsGivenBackByACall) {
    Population<TypeParam> world;
    world.grid.reserve(20000);
    world.addMany(10, anyBox<TypeParam>, 3);
    const std::size_t reserved = world.grid.memoryBytes();
    playFrames(world, kManyUpdates);
    EXPECT_GE(world.grid.memoryBytes(), reserved);
    world.grid.releaseUnusedMemory();
    EXPECT_LT(world.grid.memoryBytes(), 32U * 1024U);
    playFrames(world, 2);
    EXPECT_EQ(world.grid.validate(), "");
    // There is room though as many have just been removed.
    leave(world, 5, Left::first);
    world.grid.reserve(100);
    const std::size_t room = world.grid.memoryBytes();
    world.addMany(95, anyBox<TypeParam>);
    EXPECT_EQ(world.grid.memoryBytes(), room);
}

// Few of many slots have proxies: what looks at all of them reads lists.
TYPED_TEST(AfterAPeak, AnswersAreThoseOfBruteForce) {
    for (const Left left : kAllLeft) {
        for (const bool gives : {false, true}) {
            Population<TypeParam, PairWorld> world;
            world.addMany(1000, anyBox<TypeParam>, 3);
            world.updateAndCheck();
            leave(world, 50, left);
            world.updateAndCheck();
            for (const bool withUpdateBetween : {false, true}) {
                world.renewPairs(withUpdateBetween);
                world.updateAndCheck();
            }
            for (int frame = 0; frame < 12; ++frame) {
                if (gives && frame % 3 == 0) {
                    world.grid.releaseUnusedMemory();
                    world.pairs.releaseUnusedMemory();
                    world.sweeps.releaseUnusedMemory();
                }
                for (std::size_t i = 0; i < world.proxies.size(); i += 7) {
                    world.moveTo(i, anyBox<TypeParam>(world.random));
                }
                if (frame % 4 == 1) {
                    world.sweep(world.proxies[3].id, Vector3<TypeParam>(9, 1, 0), Sweep::automatic);
                }
                const auto far = static_cast<TypeParam>(frame % 2 == 0 ? 64 : 1e6 / 3);
                world.shift(Vector3<TypeParam>(far, -far, 0));
                world.findPairsNow(world.proxies[5].id);
                world.refilter(world.proxies[6].id);
                world.updateAndCheck();
                std::size_t seen = 0;
                std::uint32_t next = 0;
                world.grid.forEach([&](ProxyId id, const Aabb<TypeParam>& box) {
                    EXPECT_GE(id.index, next) << "in the order of indices";
                    EXPECT_TRUE(isSameBits(world.grid.box(id), box));
                    next = id.index + 1;
                    ++seen;
                });
                EXPECT_EQ(seen, world.proxies.size());
                world.expectLikeBruteForce(BoxRegion<TypeParam>{world.proxies[1].box});
                ASSERT_FALSE(this->HasFailure());
            }
        }
    }
}

TYPED_TEST(AfterAPeak, ForEachMayChangeTheGrid) {
    Population<TypeParam> world;
    world.addMany(2000, anyBox<TypeParam>, 3);
    world.update();
    leave(world, 40, Left::scattered);
    world.update();
    std::size_t seen = 0;
    world.grid.forEach([&](ProxyId id, const Aabb<TypeParam>& box) {
        ++seen;
        const Aabb<TypeParam> moved = box.translated(Vector3<TypeParam>::Ones());
        world.grid.move(id, moved);
        if (seen % 2 == 0) {
            world.grid.remove(id);
        }
        static_cast<void>(world.grid.add(moved));
    });
    EXPECT_GE(seen, 40U);
    EXPECT_LE(seen, 80U) << "what is added takes the place of a lower index, or is not seen";
    EXPECT_EQ(world.grid.size(), 40 - seen / 2 + seen);
    world.update();
    EXPECT_EQ(world.grid.validate(), "");
}

/// Few that are left after a peak, and whose changes a query will have filed when their Pairs begin.
template <class Scalar>
struct FewLeft : Population<Scalar> {
    static constexpr std::size_t kCount = 200;

    FewLeft() : Population<Scalar>(GridConfig{.slack = 0.1}) {
        this->addMany(2000, boxesIn<Scalar>(0, 10, 0.5, 1));
        this->update();
        leave(*this, kCount, Left::first);
        this->update();
    }
    [[nodiscard]] bool isFresh() const { return this->grid.store().tables.isFresh.load(); }
    /// The first update of the Pairs begins those of brute force.
    void expectAllBegin(Pairs<Scalar>& pairs) const {
        const PairChanges changes = pairs.update();
        const std::vector<ProxyPair> born(changes.born.begin(), changes.born.end());
        EXPECT_GT(born.size(), 100U);
        EXPECT_EQ(differences(born, pairsByBruteForce<Scalar>(this->proxies)), "");
        EXPECT_EQ(pairs.validate(), "");
    }
};

TYPED_TEST(AfterAPeak, PairsBeginOfAllThatMoveWithinTheirSlack) {
    FewLeft<TypeParam> world;
    UpdateCost cost;
    for (int update = 0; update < 40; ++update) {
        world.tremble();
        cost = world.grid.update();
    }
    ASSERT_EQ(cost.resting, world.proxies.size());
    world.tremble();
    world.grid.expectQueries(1000);
    ASSERT_TRUE(world.grid.store().isSparse());
    ASSERT_TRUE(world.isFresh());
    Pairs<TypeParam> pairs(world.grid);
    EXPECT_FALSE(world.isFresh());
    world.expectAllBegin(pairs);
}

TYPED_TEST(AfterAPeak, PairsBeginOfThoseThatGetTheIndicesOfRemovedOnes) {
    FewLeft<TypeParam> world;
    const std::vector<Placed<TypeParam>> before = world.proxies;
    leave(world, world.kCount / 2, Left::last);
    world.tremble();
    world.grid.expectQueries(1000);
    ASSERT_TRUE(world.grid.store().isSparse());
    ASSERT_TRUE(world.isFresh());
    Pairs<TypeParam> pairs(world.grid);
    for (std::size_t i = 0; i < world.kCount / 2; ++i) {
        const ProxyId id = world.add(before[i].box);
        ASSERT_LT(id.index, world.kCount);
    }
    world.expectAllBegin(pairs);
}

// Those that rested, and were removed before the first update, may have no record any more.
TYPED_TEST(AfterAPeak, PairsBeginWhereThoseThatRestedWereRemovedAndTheirMemoryGivenBack) {
    constexpr std::uint32_t kCount = 100;
    const auto placed = [](std::uint32_t i, double y = 0) {
        return boxAround<TypeParam>({2.0 * i, y, 0}, {1, 1, 1});
    };
    for (const bool isRemovedBefore : {true, false}) {
        Grid<TypeParam> grid;
        std::vector<ProxyId> ids;
        for (std::uint32_t i = 0; i < kCount; ++i) {
            ids.push_back(grid.add(placed(i), Mobility::resting));
        }
        const ProxyId mobile = grid.add(placed(0));
        const ProxyId last = grid.add(placed(kCount), Mobility::resting);
        UpdateCost cost;
        for (int i = 0; i < 9; ++i) {
            grid.move(mobile, placed(0, 9 + i));
            cost = grid.update();
        }
        ASSERT_EQ(cost.resting, kCount + 1);
        const auto removeLast = [&] {
            for (const ProxyId id : ids) {
                grid.move(id, placed(id.index, 1));
            }
            grid.remove(last);
            grid.expectQueries(1'000'000);
            grid.releaseUnusedMemory();
            ASSERT_EQ(grid.indexLimit(), kCount + 1);
        };
        if (isRemovedBefore) {
            removeLast();
        }
        Pairs<TypeParam> pairs(grid);
        if (!isRemovedBefore) {
            removeLast();
        }
        EXPECT_EQ(pairs.update().born.size(), kCount - 1);
        EXPECT_EQ(pairs.validate(), "");
        EXPECT_EQ(grid.validate(), "");
    }
}

TYPED_TEST(AfterAPeak, RadiusSearchesReadAndHoldWhatIsLeft) {
    Population<TypeParam> world;
    world.addMany(20000, anyBox<TypeParam>, 3);
    world.update();
    RadiusSearch<TypeParam> search;
    Neighbours<TypeParam> neighbours;
    search.take(world.grid, TypeParam(1));
    static_cast<void>(neighbours.find(world.grid, TypeParam(0.01)));
    const std::size_t atPeak = search.memoryBytes();
    const std::size_t ofNeighbours = neighbours.memoryBytes();
    leave(world, 100, Left::last);
    world.update();
    RadiusSearch<TypeParam> fresh;
    const auto radius = TypeParam(6);
    fresh.take(world.grid, radius);
    EXPECT_EQ(fresh.size(), 100U);
    EXPECT_LT(fresh.memoryBytes(), 32U * 1024U) << "no list by index";
    for (int take = 0; take < kManyUpdates; ++take) {
        search.take(world.grid, radius);
        static_cast<void>(neighbours.find(world.grid, radius));
    }
    EXPECT_LT(search.memoryBytes(), atPeak / 20);
    EXPECT_LT(neighbours.memoryBytes(), ofNeighbours / 20);
    NeighbourLists found = neighbourLists(search);
    EXPECT_EQ(found, neighboursByBruteForce<TypeParam>(world.proxies, radius));
    EXPECT_TRUE(std::ranges::any_of(found, [](const auto& list) { return !list.second.empty(); }));
}

// --- Small worlds: what is not used yet is not there yet -----------------------------------------

template <class Scalar>
class SmallWorlds : public testing::Test {};

TYPED_TEST_SUITE(SmallWorlds, Scalars);

TYPED_TEST(SmallWorlds, TakeLittleMemoryWhileTheyAreEmpty) {
    const std::size_t before = bytesHeld();
    Grid<TypeParam> grid;
    Sweeps<TypeParam> sweeps(grid);
    Pairs<TypeParam> pairs(grid, &sweeps);
    const Neighbours<TypeParam> neighbours;
    const RadiusSearch<TypeParam> search;
    EXPECT_EQ(bytesHeld(), before) << "nothing is allocated";
    EXPECT_LT(grid.memoryBytes(), 3584U);
    EXPECT_LT(pairs.memoryBytes(), 2048U);
    EXPECT_LT(sweeps.memoryBytes(), 2048U);
    EXPECT_LT(neighbours.memoryBytes(), 1024U);
    EXPECT_LT(search.memoryBytes(), 1024U);
    // Nor by a frame of nothing.
    pairs.update();
    EXPECT_LT(bytesHeld(), before + 1024);
}

// Told in full: what is held beside the objects is what was allocated.
TYPED_TEST(SmallWorlds, TakeAFewKilobytesForTenBoxes) {
    const std::size_t before = bytesHeld();
    Grid<TypeParam> grid;
    Pairs<TypeParam> pairs(grid);
    for (int i = 0; i < 10; ++i) {
        const Vector3<TypeParam> low(static_cast<TypeParam>(i) * TypeParam(0.9), 0, 0);
        const auto mobility = i == 0 ? Mobility::resting : Mobility::mobile;
        static_cast<void>(grid.add({low, low + Vector3<TypeParam>::Ones()}, mobility));
    }
    EXPECT_EQ(pairs.update().born.size(), 9U);
    CollectCount count;
    grid.visit(RayRegion<TypeParam>({-1, 0, 0}, {99, 0, 0}), count);
    EXPECT_EQ(count.count(), 10U);
    const std::size_t told = grid.memoryBytes() + pairs.memoryBytes();
    EXPECT_LT(told, (sizeof(TypeParam) == sizeof(float) ? 16U : 20U) * 1024U);
    EXPECT_LE(bytesHeld() - before + sizeof(grid) + sizeof(pairs), told);
}

}  // namespace
}  // namespace hashphase::test
