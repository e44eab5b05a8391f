// SPDX-License-Identifier: Zlib

// After a peak: what has come and gone is given back, and what is left takes what it would take alone.

#include <broadphase/neighbours.hpp>
#include <broadphase/radius_search.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>
#include <tests/support/query_checks.hpp>
#include <tests/support/radius_oracle.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

namespace hashphase::test {
namespace {

enum class Left { first, last, scattered };
constexpr Left kAllLeft[] = {Left::first, Left::last, Left::scattered};

// Updates after which memory is given back, and then some.
constexpr int kManyUpdates = 300;

template <class Scalar>
class AfterAPeak : public testing::Test {
protected:
    using Box = Aabb<Scalar>;

    Box anyBox() {
        const Vector3<Scalar> low = random_.pointIn(0, 30).cast<Scalar>();
        return {low, low + Vector3<Scalar>::Ones()};
    }

    template <class World>
    std::vector<Placed<Scalar>> addMany(World& world, int count) {
        std::vector<Placed<Scalar>> proxies;
        for (int i = 0; i < count; ++i) {
            const Box box = anyBox();
            proxies.push_back(
                {world.add(box, i % 3 == 0 ? Mobility::resting : Mobility::mobile), box});
        }
        return proxies;
    }

    // Removes all but some.
    template <class World>
    void leave(World& world, std::vector<Placed<Scalar>>& proxies, std::size_t count, Left left) {
        const std::size_t size = proxies.size();
        std::vector<Placed<Scalar>> kept;
        for (std::size_t i = 0; i < size; ++i) {
            const bool isKept = left == Left::first  ? i < count
                                : left == Left::last ? i >= size - count
                                                     : i % (size / count) == 0;
            if (isKept) {
                kept.push_back(proxies[i]);
            } else {
                gone_.push_back(proxies[i].id);
                world.remove(proxies[i].id);
            }
        }
        proxies.swap(kept);
    }

    // As a game does: moves some, updates and asks.
    template <class World>
    void playFrames(World& world, const Grid<Scalar>& grid, std::vector<Placed<Scalar>>& proxies,
                    int count) {
        for (int frame = 0; frame < count; ++frame) {
            for (std::size_t i = 0; i < proxies.size(); i += 2) {
                proxies[i].box = anyBox();
                world.move(proxies[i].id, proxies[i].box);
            }
            world.update();
            CollectCount collector;
            grid.visit(RayRegion<Scalar>({0, 0, 0}, {30, 30, 30}), collector);
        }
    }

    Random random_{0x5eed2101};
    std::vector<ProxyId> gone_;
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AfterAPeak, Scalars);

/// Grid and Pairs, and nothing that watches them.
template <class Scalar>
struct PlainWorld {
    Grid<Scalar> grid;
    Pairs<Scalar> pairs{grid};

    ProxyId add(const Aabb<Scalar>& box, Mobility mobility) { return grid.add(box, mobility); }
    void move(ProxyId id, const Aabb<Scalar>& box) { grid.move(id, box); }
    void remove(ProxyId id) { grid.remove(id); }
    void update() { pairs.update(); }
    [[nodiscard]] std::size_t bytes() const { return grid.memoryBytes() + pairs.memoryBytes(); }
};

TYPED_TEST(AfterAPeak, UpdatesGiveBackWhatWasNotUsedForAWhile) {
    PlainWorld<TypeParam> alone;
    auto few = this->addMany(alone, 100);
    this->playFrames(alone, alone.grid, few, kManyUpdates);
    PlainWorld<TypeParam> world;
    auto proxies = this->addMany(world, 30000);
    this->playFrames(world, world.grid, proxies, 3);
    const std::size_t atPeak = world.bytes();
    this->leave(world, proxies, 100, Left::first);
    this->playFrames(world, world.grid, proxies, 100);
    EXPECT_GE(world.bytes(), atPeak) << "the peak may come again";
    this->playFrames(world, world.grid, proxies, kManyUpdates);
    EXPECT_LT(world.bytes(), 2 * alone.bytes());
    EXPECT_LT(alone.bytes(), atPeak / 50);
    EXPECT_LE(world.grid.indexLimit(), 100U);
    EXPECT_EQ(world.grid.validate(), "");
    EXPECT_EQ(world.pairs.validate(), "");
}

TYPED_TEST(AfterAPeak, ACallGivesBackWhatIsNotUsedAtOnce) {
    for (const Left left : kAllLeft) {
        Grid<TypeParam> grid;
        std::vector<Placed<TypeParam>> proxies = this->addMany(grid, 20000);
        grid.update();
        const std::size_t atPeak = grid.memoryBytes();
        this->leave(grid, proxies, 100, left);
        grid.update();
        EXPECT_GE(grid.memoryBytes(), atPeak);
        grid.move(proxies[1].id, proxies[1].box = this->anyBox());
        grid.update();  // in cells for those that are left
        grid.releaseUnusedMemory();
        // What is left at the end keeps the records below.
        const std::size_t records = grid.indexLimit() * (sizeof(TypeParam) == 4 ? 64U : 128U);
        EXPECT_EQ(left == Left::first, grid.indexLimit() == 100U);
        EXPECT_LT(grid.memoryBytes(), records + 64 * 1024);
        EXPECT_EQ(grid.validate(), "");
        CollectCount count;
        grid.visit(BoxRegion<TypeParam>{makeBox<TypeParam>(0, 0, 0, 31, 31, 31)}, count);
        EXPECT_EQ(count.count(), 100U);
    }
}

TYPED_TEST(AfterAPeak, IdsGivenBackAreNeverValidAgain) {
    Grid<TypeParam> grid;
    std::set<ProxyId> ever;
    for (int round = 0; round < 6; ++round) {
        auto proxies = this->addMany(grid, 200);
        for (const Placed<TypeParam>& proxy : proxies) {
            ASSERT_TRUE(ever.insert(proxy.id).second) << "an id names one proxy for ever";
        }
        grid.update();
        this->leave(grid, proxies, round % 2 == 0 ? 5 : 1, kAllLeft[round % 3]);
        grid.releaseUnusedMemory();  // with proxies removed since the last update
        grid.update();
        grid.releaseUnusedMemory();
        for (const ProxyId id : this->gone_) {
            ASSERT_FALSE(grid.contains(id));
        }
        ASSERT_EQ(grid.validate(), "");
    }
}

TYPED_TEST(AfterAPeak, NewProxiesTakeTheLowestIndices) {
    Grid<TypeParam> grid;
    auto proxies = this->addMany(grid, 1000);
    grid.update();
    this->leave(grid, proxies, 10, Left::last);
    grid.update();
    grid.releaseUnusedMemory();
    EXPECT_EQ(grid.indexLimit(), 1000U);
    const auto fresh = this->addMany(grid, 20);
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        EXPECT_EQ(fresh[i].id.index, i);
    }
    for (const Placed<TypeParam>& proxy : proxies) {
        grid.remove(proxy.id);
    }
    grid.update();
    grid.releaseUnusedMemory();
    EXPECT_EQ(grid.indexLimit(), 20U);
}

TYPED_TEST(AfterAPeak, WhatIsReservedStaysUntilItIsGivenBackByACall) {
    Grid<TypeParam> grid;
    grid.reserve(20000);
    auto proxies = this->addMany(grid, 10);
    const std::size_t reserved = grid.memoryBytes();
    this->playFrames(grid, grid, proxies, kManyUpdates);
    EXPECT_GE(grid.memoryBytes(), reserved);
    grid.releaseUnusedMemory();
    EXPECT_LT(grid.memoryBytes(), 32U * 1024U);
    this->playFrames(grid, grid, proxies, 2);
    EXPECT_EQ(grid.validate(), "");
}

// Few of many slots have proxies: what looks at all of them reads lists.
TYPED_TEST(AfterAPeak, AnswersAreThoseOfBruteForce) {
    for (const Left left : kAllLeft) {
        for (const bool gives : {false, true}) {
            PairWorld<TypeParam> world;
            auto proxies = this->addMany(world, 1000);
            world.update();
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
            this->leave(world, proxies, 50, left);
            world.update();
            ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
            for (int frame = 0; frame < 12; ++frame) {
                if (gives && frame % 3 == 0) {
                    world.grid.releaseUnusedMemory();
                    world.pairs.releaseUnusedMemory();
                    world.sweeps.releaseUnusedMemory();
                }
                for (std::size_t i = 0; i < proxies.size(); i += 7) {
                    proxies[i].box = this->anyBox();
                    world.move(proxies[i].id, proxies[i].box);
                }
                if (frame % 4 == 1) {
                    world.sweep(proxies[3].id, Vector3<TypeParam>(9, 1, 0), Sweep::automatic);
                }
                const auto far = static_cast<TypeParam>(frame % 2 == 0 ? 64 : 1e6 / 3);
                const Vector3<TypeParam> by(far, -far, 0);
                world.shiftOrigin(by);
                for (Placed<TypeParam>& proxy : proxies) {
                    proxy.box = {proxy.box.min() - by, proxy.box.max() - by};
                }
                world.findPairsNow(proxies[5].id);
                world.refilter(proxies[6].id);
                world.update();
                ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
                std::size_t seen = 0;
                std::uint32_t next = 0;
                world.grid.forEach([&](ProxyId id, const Aabb<TypeParam>& box) {
                    EXPECT_GE(id.index, next) << "in the order of indices";
                    EXPECT_TRUE(isSameBits(world.grid.box(id), box));
                    next = id.index + 1;
                    ++seen;
                });
                EXPECT_EQ(seen, proxies.size());
                expectLikeBruteForce<TypeParam>(world.grid, proxies,
                                                BoxRegion<TypeParam>{proxies[1].box});
            }
        }
    }
}

TYPED_TEST(AfterAPeak, PairsMayBeRenewedWhereFewAreLeft) {
    PairWorld<TypeParam> world;
    auto proxies = this->addMany(world, 1000);
    world.update();
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    this->leave(world, proxies, 50, Left::last);
    world.update();
    ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    for (const bool withUpdateBetween : {false, true}) {
        world.renewPairs(withUpdateBetween);
        world.update();
        ASSERT_NO_FATAL_FAILURE(world.checkThoroughly(proxies));
    }
}

TYPED_TEST(AfterAPeak, ForEachMayChangeTheGrid) {
    Grid<TypeParam> grid;
    auto proxies = this->addMany(grid, 2000);
    grid.update();
    this->leave(grid, proxies, 40, Left::scattered);
    grid.update();
    std::size_t seen = 0;
    grid.forEach([&](ProxyId id, const Aabb<TypeParam>& box) {
        ++seen;
        const Aabb<TypeParam> moved = box.translated(Vector3<TypeParam>::Ones());
        grid.move(id, moved);
        if (seen % 2 == 0) {
            grid.remove(id);
        }
        static_cast<void>(grid.add(moved));
    });
    EXPECT_GE(seen, 40U);
    EXPECT_LE(seen, 80U) << "what is added takes the place of a lower index, or is not seen";
    EXPECT_EQ(grid.size(), 40 - seen / 2 + seen);
    grid.update();
    EXPECT_EQ(grid.validate(), "");
}

TYPED_TEST(AfterAPeak, RadiusSearchesReadAndHoldWhatIsLeft) {
    Grid<TypeParam> grid;
    auto proxies = this->addMany(grid, 20000);
    grid.update();
    RadiusSearch<TypeParam> search;
    Neighbours<TypeParam> neighbours;
    search.take(grid, TypeParam(1));
    static_cast<void>(neighbours.find(grid, TypeParam(0.01)));
    const std::size_t atPeak = search.memoryBytes();
    const std::size_t ofNeighbours = neighbours.memoryBytes();
    this->leave(grid, proxies, 100, Left::last);
    grid.update();
    RadiusSearch<TypeParam> fresh;
    const auto radius = TypeParam(6);
    fresh.take(grid, radius);
    EXPECT_EQ(fresh.size(), 100U);
    EXPECT_LT(fresh.memoryBytes(), 32U * 1024U) << "no list by index";
    for (int take = 0; take < kManyUpdates; ++take) {
        search.take(grid, radius);
        static_cast<void>(neighbours.find(grid, radius));
    }
    EXPECT_LT(search.memoryBytes(), atPeak / 20);
    EXPECT_LT(neighbours.memoryBytes(), ofNeighbours / 20);
    const NeighbourLists expected = neighboursByBruteForce<TypeParam>(proxies, radius);
    std::size_t pairs = 0;
    search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> found) {
        std::vector<ProxyId> ids;
        for (const std::uint32_t other : found) {
            ids.push_back(search.id(other));
        }
        std::sort(ids.begin(), ids.end());
        std::vector<ProxyId> wanted = expected.at(search.id(agent));
        std::sort(wanted.begin(), wanted.end());
        EXPECT_EQ(ids, wanted);
        pairs += ids.size();
    });
    EXPECT_GT(pairs, 0U);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(AfterAPeakOfAGrid, GivingBackWithinAQueryIsAsserted) {
    struct Release {
        Grid<float>& grid;
        int count = 0;
        void add(ProxyId /*id*/, float /*key*/) {
            ++count;
            EXPECT_DEATH(grid.releaseUnusedMemory(), "within a query");
        }
        static float limit() { return 1; }
    };
    Grid<float> grid;
    static_cast<void>(grid.add(makeBox<float>(0, 0, 0, 1, 1, 1)));
    Release release{grid};
    grid.visit(BoxRegion<float>{makeBox<float>(0, 0, 0, 1, 1, 1)}, release);
    EXPECT_EQ(release.count, 1);
}
#endif

}  // namespace
}  // namespace hashphase::test
