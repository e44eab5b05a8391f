// SPDX-License-Identifier: Zlib

#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <vector>

namespace hashphase::test {
namespace {

using Box = Aabb<float>;

Box cubeAt(double x, double y = 0, double z = 0) {
    return makeBox<float>(x, y, z, x + 1, y + 1, z + 1);
}

Box nanCube() {
    Box box = cubeAt(0);
    box.max()[1] = std::numeric_limits<float>::quiet_NaN();
    return box;
}

std::vector<ProxyPair> listOf(std::span<const ProxyPair> pairs) {
    return {pairs.begin(), pairs.end()};
}

TEST(Pairs, OfAnEmptyGridAreNone) {
    PairWorld<float> world;
    const PairChanges changes = world.update();
    EXPECT_TRUE(changes.born.empty());
    EXPECT_TRUE(changes.died.empty());
    world.checkThoroughly({});
}

TEST(Pairs, AreBornWhenBoxesComeToTouchAndDieWhenTheyPart) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(3));
    EXPECT_TRUE(world.update().born.empty());

    world.move(b, cubeAt(1));  // they share a face
    EXPECT_EQ(listOf(world.update().born), std::vector{makePair(a, b)});
    EXPECT_TRUE(world.update().born.empty());

    world.move(b, makeBox<float>(std::nextafter(1.0F, 2.0F), 0, 0, 2, 1, 1));
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
    EXPECT_TRUE(world.update().died.empty());
}

TEST(Pairs, ThatPartAndMeetAgainBetweenUpdatesAreNotToldAbout) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    world.add(cubeAt(0.5));
    world.update();
    world.move(a, cubeAt(9));
    world.move(a, cubeAt(0.25));
    const PairChanges changes = world.update();
    EXPECT_TRUE(changes.born.empty());
    EXPECT_TRUE(changes.died.empty());
    EXPECT_EQ(world.pairs.count(), 1U);
}

TEST(Pairs, ThatMeetOnlyBetweenUpdatesAreNotToldAbout) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(9));
    world.add(cubeAt(0));
    world.update();
    world.move(a, cubeAt(0));
    world.move(a, cubeAt(5));
    EXPECT_TRUE(world.update().born.empty());
    const ProxyId brief = world.add(cubeAt(0));
    world.remove(brief);
    const PairChanges changes = world.update();
    EXPECT_TRUE(changes.born.empty());
    EXPECT_TRUE(changes.died.empty());
}

TEST(Pairs, OfARemovedProxyDieUnderItsOldId) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    world.update();
    world.remove(b);
    const ProxyId successor = world.add(cubeAt(0.5));
    const PairChanges changes = world.update();
    EXPECT_EQ(listOf(changes.died), std::vector{makePair(a, b)});
    EXPECT_EQ(listOf(changes.born), std::vector{makePair(a, successor)});
}

TEST(Pairs, NeverMixUpTheProxiesThatFollowEachOtherInOneSlot) {
    PairWorld<float> world;
    const ProxyId fixed = world.add(cubeAt(0));
    ProxyId guest = world.add(cubeAt(0.5));
    world.update();
    bool isSlotUsedAgain = false;
    for (int i = 0; i < 20; ++i) {
        const ProxyId previous = guest;
        world.remove(previous);
        if (i % 2 == 0) {
            world.update();  // the slot is free from here on
        }
        guest = world.add(cubeAt(i % 3 == 0 ? 5 : 0.5));
        world.update();
        isSlotUsedAgain = isSlotUsedAgain || guest.index == previous.index;
        world.checkThoroughly(std::vector<Placed<float>>{{fixed, world.grid.box(fixed)},
                                                         {guest, world.grid.box(guest)}});
        ASSERT_FALSE(HasFatalFailure());
    }
    EXPECT_TRUE(isSlotUsedAgain);
}

TEST(Pairs, OfTwoProxiesRemovedTogetherDieOnce) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    for (int i = 0; i < 30; ++i) {
        world.update();  // long at rest
    }
    world.remove(a);
    world.remove(b);
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
    EXPECT_EQ(world.pairs.count(), 0U);
}

TEST(Pairs, OfAProxyMovedAndThenRemovedDieOnce) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    world.update();
    world.move(b, cubeAt(0.75));
    world.remove(b);
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
}

TEST(Pairs, OfIdenticalBoxesAreAllOfThem) {
    PairWorld<double> world;
    constexpr std::size_t kCount = 2000;
    for (std::size_t i = 0; i < kCount; ++i) {
        world.add(makeBox<double>(1, 2, 3, 1, 2, 3));
    }
    const PairChanges changes = world.pairs.update([](ProxyId, ProxyId) { return true; });
    EXPECT_EQ(changes.born.size(), kCount * (kCount - 1) / 2);
    EXPECT_EQ(std::adjacent_find(changes.born.begin(), changes.born.end(), std::greater_equal<>()),
              changes.born.end());
}

TEST(Pairs, AreReportedOnceThoughBoxesTouchInTheCornerOfEightCells) {
    GridConfig config;
    config.cellSize = 1;
    PairWorld<float> world(config);
    std::vector<Placed<float>> proxies;
    // Enough around the corner that no level is thin, eight of them touching in it.
    for (int x = -2; x < 2; ++x) {
        for (int y = -2; y < 2; ++y) {
            for (int z = -2; z < 2; ++z) {
                const Box box = cubeAt(x, y, z);
                proxies.push_back({world.add(box), box});
            }
        }
    }
    world.update();
    world.checkThoroughly(proxies);
}

TEST(Pairs, OfABoxWithNanDieAndAreBornAgainWhenItHeals) {
    const CaughtMessages messages;
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    world.update();
    world.move(b, nanCube());
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
    EXPECT_EQ(world.grid.nanCount(), 1U);
    world.move(b, cubeAt(0.5));
    EXPECT_EQ(listOf(world.update().born), std::vector{makePair(a, b)});
    EXPECT_EQ(world.grid.nanCount(), 0U);
}

// --- Announcing ----------------------------------------------------------------------------------

TEST(FindPairsNow, TellsThePairsOfANewProxyAtOnceAndUpdateDoesNotRepeatThem) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    world.update();
    const ProxyId b = world.add(cubeAt(0.5));
    world.findPairsNow(b);
    EXPECT_TRUE(world.set().contains(makePair(a, b)));
    EXPECT_EQ(world.pairs.count(), 1U);
    EXPECT_TRUE(world.update().born.empty());
    EXPECT_EQ(world.set().size(), 1U);
}

TEST(FindPairsNow, TellsNothingTwice) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    world.findPairsNow(a);
    world.findPairsNow(a);
    EXPECT_TRUE(world.asked().empty());
    world.findPairsNow(b);
    EXPECT_TRUE(world.asked().empty());
    EXPECT_EQ(world.pairs.count(), 1U);
}

TEST(FindPairsNow, IsTakenBackByTheUpdateWhenTheBoxesHaveParted) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    world.findPairsNow(b);
    world.move(b, cubeAt(7));
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
    EXPECT_EQ(world.pairs.count(), 0U);
}

TEST(FindPairsNow, IsTakenBackByTheUpdateWhenOneWasRemoved) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0));
    const ProxyId b = world.add(cubeAt(0.5));
    world.findPairsNow(b);
    world.remove(b);
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
}

TEST(FindPairsNow, FindsProxiesAtRest) {
    PairWorld<float> world;
    const ProxyId a = world.add(cubeAt(0), Mobility::resting);
    std::vector<Placed<float>> proxies{{a, cubeAt(0)}};
    for (int i = 0; i < 200; ++i) {
        const Box box = cubeAt(3 * i + 20);
        proxies.push_back({world.add(box, Mobility::resting), box});
    }
    for (int i = 0; i < 30; ++i) {
        world.move(proxies.back().id, cubeAt(5000 + i));
        world.update();
        world.checkThoroughly(proxies);
    }
    const ProxyId b = world.add(cubeAt(0.5));
    world.findPairsNow(b);
    EXPECT_EQ(world.set().count(makePair(a, b)), 1U);
    EXPECT_TRUE(world.update().born.empty());
    for (int i = 0; i < 30; ++i) {
        EXPECT_TRUE(world.update().died.empty());
    }
    world.move(b, cubeAt(10));
    EXPECT_EQ(listOf(world.update().died), std::vector{makePair(a, b)});
}

// --- Misuse --------------------------------------------------------------------------------------

#if HASHPHASE_ENABLE_ASSERTS

TEST(PairsDeathTest, TheirGridThatGoesBeforeThemIsAsserted) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto goesFirst = [] {
        auto grid = std::make_unique<Grid<float>>();
        const Pairs<float> pairs(*grid);
        grid.reset();
    };
    EXPECT_DEATH(goesFirst(), "A grid outlives its Pairs");
}

TEST(Pairs, MisuseIsAsserted) {
    const ThrowingAsserts throwing;
    PairWorld<float> world;
    EXPECT_THROW(Pairs<float> second(world.grid), BrokenAssert);
    const ProxyId id = world.add(cubeAt(0));
    std::vector<ProxyPair> pairs;
    EXPECT_THROW(world.pairs.collect(pairs), BrokenAssert);
    world.update();
    world.remove(id);
    const auto all = [](ProxyId, ProxyId) { return true; };
    EXPECT_THROW(world.pairs.findPairsNow(id, all), BrokenAssert);
    EXPECT_THROW(world.pairs.refilter(id, all), BrokenAssert);
    EXPECT_THROW(world.pairs.findPairsNow({}, all), BrokenAssert);
}
#endif

TEST(Pairs, LeaveTheGridFreeForOthersWhenTheyEnd) {
    Grid<float> grid;
    { const Pairs<float> pairs(grid); }
    Pairs<float> pairs(grid);
    static_cast<void>(grid.add(cubeAt(0)));
    static_cast<void>(grid.add(cubeAt(0)));
    EXPECT_EQ(pairs.update([](ProxyId, ProxyId) { return true; }).born.size(), 1U);
}

}  // namespace
}  // namespace hashphase::test
