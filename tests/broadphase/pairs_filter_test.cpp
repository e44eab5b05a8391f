// SPDX-License-Identifier: Zlib

#include <tests/support/box_scenes.hpp>
#include <tests/support/out_of_memory.hpp>
#include <tests/support/pair_world.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace hashphase::test {
namespace {

Aabb<double> unitCubeAt(double x) {
    return makeBox<double>(x, 0, 0, x + 1, 1, 1);
}

/// Two boxes that overlap, and a filter that is a switch.
struct TwoProxies {
    bool accept;
    PairWorld<double> world;
    ProxyId a;
    ProxyId b;
    ProxyPair pair;

    explicit TwoProxies(bool acceptAtFirst)
        : accept(acceptAtFirst),
          world({}, [this](ProxyId, ProxyId) { return accept; }),
          a(world.add(unitCubeAt(0))),
          b(world.add(unitCubeAt(0.5))),
          pair(makePair(a, b)) {
        world.update();
    }

    void rest(int updates = 40) {
        for (int i = 0; i < updates; ++i) {
            world.update();
            EXPECT_EQ(world.pairs.validate(), "");
        }
    }

    [[nodiscard]] bool isPair() const { return world.set().contains(pair); }
};

TEST(PairFilter, IsAskedOnceWhileTheBoxesOverlap) {
    TwoProxies two(true);
    EXPECT_EQ(two.world.asked(), std::vector{two.pair});
    for (int i = 0; i < 30; ++i) {
        two.world.move(two.b, unitCubeAt(0.5 + 0.01 * (i % 2)));
        two.world.update();
        EXPECT_TRUE(two.world.asked().empty());
    }
}

TEST(PairFilter, IsAskedInAscendingOrderWhateverTheOrderOfChanges) {
    PairWorld<double> world;
    std::vector<ProxyId> ids;
    for (int i = 0; i < 100; ++i) {
        ids.push_back(world.add(unitCubeAt(10 * i)));
    }
    world.update();
    for (int i = 99; i >= 0; --i) {
        world.move(ids[static_cast<std::size_t>(i)], unitCubeAt(0.3 * (i * 37 % 100)));
    }
    world.update();  // checks the order
    EXPECT_GT(world.asked().size(), 100U);
}

TEST(PairFilter, IsAskedAgainAboutARefusedPairOnlyWhenOneOfThemChanged) {
    TwoProxies two(false);
    EXPECT_FALSE(two.isPair());
    EXPECT_EQ(two.world.pairs.refusedCount(), 1U);
    for (int i = 0; i < 30; ++i) {
        two.world.update();
        EXPECT_TRUE(two.world.asked().empty());
        if (i % 13 == 12) {
            two.world.move(two.b, unitCubeAt(0.5 + 0.01 * i));
            two.world.update();
            EXPECT_EQ(two.world.asked(), std::vector{two.pair});
        }
    }
    two.accept = true;
    two.world.move(two.a, unitCubeAt(0.1));
    two.world.update();
    EXPECT_TRUE(two.isPair());
    EXPECT_EQ(two.world.pairs.refusedCount(), 0U);
}

TEST(PairFilter, RefusedPairsThatPartMakeNoDeath) {
    for (const int updatesBetween : {0, 40}) {
        TwoProxies two(false);
        two.rest(updatesBetween);
        two.world.move(two.b, unitCubeAt(5));
        EXPECT_TRUE(two.world.update().died.empty());
        EXPECT_EQ(two.world.pairs.refusedCount(), 0U);
    }
}

TEST(PairFilter, RefusedPairsOfWhichOneIsRemovedMakeNoDeath) {
    for (const int updatesBetween : {0, 40}) {
        TwoProxies two(false);
        two.rest(updatesBetween);
        two.world.remove(two.a);
        EXPECT_TRUE(two.world.update().died.empty());
        EXPECT_EQ(two.world.pairs.refusedCount(), 0U);
        EXPECT_EQ(two.world.pairs.validate(), "");
    }
}

TEST(PairFilter, IsNotAskedAgainBecauseARestingProxyWakes) {
    TwoProxies two(true);
    two.rest();
    two.world.move(two.b, unitCubeAt(0.6));
    two.world.update();
    EXPECT_TRUE(two.world.asked().empty());
    EXPECT_TRUE(two.isPair());
}

TEST(PairFilter, OfManyAtOnceDecidesAsOneByOneDoes) {
    const auto isAccepted = [](ProxyId a, ProxyId b) { return (a.index ^ b.index) % 3 != 0; };
    PairWorld<double> oneByOne({}, isAccepted);
    Grid<double> grid;
    Pairs<double> pairs(grid);
    std::size_t calls = 0;
    const auto ask = [&](std::span<const ProxyPair> asked, std::span<char> accepted) {
        ++calls;
        ASSERT_EQ(asked.size(), accepted.size());
        for (std::size_t i = 0; i < asked.size(); ++i) {
            EXPECT_EQ(accepted[i], 0);
            accepted[i] = isAccepted(asked[i].first, asked[i].second) ? 1 : 0;
        }
    };
    std::vector<ProxyId> ids;
    for (int i = 0; i < 60; ++i) {
        ids.push_back(grid.add(unitCubeAt(0.4 * i)));
        ASSERT_EQ(oneByOne.add(unitCubeAt(0.4 * i)), ids.back());
    }
    for (std::size_t frame = 0; frame < 20; ++frame) {
        for (std::size_t i = frame % 2; i < ids.size(); i += 2) {
            const Aabb<double> box =
                unitCubeAt(0.4 * static_cast<double>((i * 7 + frame) % ids.size()));
            grid.move(ids[i], box);
            oneByOne.move(ids[i], box);
        }
        calls = 0;
        const PairChanges changes = pairs.update(ask);
        const PairChanges expected = oneByOne.update();
        ASSERT_TRUE(std::ranges::equal(changes.born, expected.born));
        ASSERT_TRUE(std::ranges::equal(changes.died, expected.died));
        EXPECT_EQ(calls, 1U);
        EXPECT_GT(pairs.count(), 0U);
        EXPECT_EQ(pairs.refusedCount(), oneByOne.pairs.refusedCount());
        ASSERT_EQ(pairs.validate(), "");
    }
}

TEST(PairFilter, RefusesNothingWhereNoneIsGiven) {
    Grid<double> grid;
    Pairs<double> pairs(grid);
    const ProxyPair two = makePair(grid.add(unitCubeAt(0)), grid.add(unitCubeAt(0.5)));
    const PairChanges changes = pairs.update();
    EXPECT_EQ(std::vector(changes.born.begin(), changes.born.end()), std::vector{two});
}

TEST(PairFilter, MayTakeItsArgumentsAsAuto) {
    Grid<double> grid;
    Pairs<double> pairs(grid);
    const ProxyPair pair = makePair(grid.add(unitCubeAt(0)), grid.add(unitCubeAt(0.5)));
    const auto accept = [](auto a, auto b) { return a != b; };
    PairFilter filter = accept;
    PairFilter copy = filter;
    EXPECT_TRUE(std::ranges::equal(pairs.update(copy).born, std::vector{pair}));
}

// --- Filtering again -----------------------------------------------------------------------------

TEST(Refilter, EndsAndBeginsPairsAtOnceAlsoOfProxiesAtRest) {
    for (const int updatesBetween : {0, 1, 40}) {
        SCOPED_TRACE(testing::Message() << updatesBetween << " updates in between");
        TwoProxies two(true);
        two.rest(updatesBetween);
        two.accept = false;
        two.world.refilter(two.a);
        EXPECT_FALSE(two.isPair());
        EXPECT_EQ(two.world.pairs.count(), 0U);
        two.rest(updatesBetween);
        two.accept = true;
        two.world.refilter(two.b);
        EXPECT_TRUE(two.isPair());
        EXPECT_EQ(two.world.pairs.count(), 1U);
        two.rest(updatesBetween);
        EXPECT_TRUE(two.isPair());
    }
}

TEST(Refilter, ThereAndBackWithinAFrameChangesNothing) {
    TwoProxies two(true);
    two.rest();
    two.accept = false;
    two.world.refilter(two.a);
    two.accept = true;
    two.world.refilter(two.a);
    two.rest(1);
    EXPECT_TRUE(two.isPair());
}

TEST(Refilter, WithTheSameFilterReportsNothing) {
    for (const bool accept : {true, false}) {
        TwoProxies two(accept);
        two.rest();
        const PairChanges changes =
            two.world.pairs.refilter(two.a, [accept](ProxyId, ProxyId) { return accept; });
        EXPECT_TRUE(changes.born.empty());
        EXPECT_TRUE(changes.died.empty());
    }
}

TEST(Refilter, OfANewProxyTellsItsPairsOnce) {
    TwoProxies two(true);
    const ProxyId c = two.world.add(unitCubeAt(0.25));
    two.world.refilter(c);
    EXPECT_EQ(two.world.pairs.count(), 3U);
    two.accept = false;
    two.world.refilter(c);
    EXPECT_EQ(two.world.pairs.count(), 1U);
    two.world.update();
    EXPECT_EQ(two.world.set().size(), 1U);
}

TEST(Refilter, DecidesAlsoForAPairThatIsApartForTheMoment) {
    // Known from the last update, apart when filtered again, and together at the next update.
    TwoProxies two(true);
    two.world.move(two.a, unitCubeAt(9));
    two.accept = false;
    two.world.refilter(two.a);
    two.world.move(two.a, unitCubeAt(0));
    two.world.update();
    EXPECT_FALSE(two.isPair());
}

TEST(Refilter, OfAProxyThatMovedAwayLeavesTheDeathToTheUpdate) {
    TwoProxies two(true);
    two.world.move(two.a, unitCubeAt(9));
    two.world.refilter(two.a);
    two.world.update();
    EXPECT_FALSE(two.isPair());
    EXPECT_EQ(two.world.pairs.count(), 0U);
}

TEST(Refilter, OfAProxyWhosePartnerWasRemovedLeavesTheDeathToTheUpdate) {
    for (const int updatesBetween : {0, 40}) {
        TwoProxies two(true);
        two.rest(updatesBetween);
        two.world.remove(two.b);
        two.accept = false;
        two.world.refilter(two.a);
        EXPECT_TRUE(two.isPair());
        two.world.update();
        EXPECT_FALSE(two.isPair());
        EXPECT_EQ(two.world.pairs.count() + two.world.pairs.refusedCount(), 0U);
    }
}

// Such a pair is still noted down among those at rest, and must not be noted down twice.
TEST(Refilter, CountsOnceWhatIsRefusedAtRestAndAgainWhenOneHasWoken) {
    TwoProxies two(false);
    // Proxies are put to rest when there are many, by an update in which something moves.
    const ProxyId mover = two.world.add(unitCubeAt(-9));
    for (int i = 0; i < 200; ++i) {
        two.world.add(unitCubeAt(10 + 2 * i));
    }
    for (int i = 0; i < 40; ++i) {
        two.world.move(mover, unitCubeAt(-9 - i));
        two.world.update();
    }
    EXPECT_GT(two.world.pairs.lastCost().grid.resting, 200U);
    two.world.move(two.b, unitCubeAt(0.25));
    two.world.refilter(two.a);
    EXPECT_EQ(two.world.pairs.refusedCount(), 1U);
    two.accept = true;
    two.world.refilter(two.a);
    EXPECT_TRUE(two.isPair());
    EXPECT_EQ(two.world.pairs.refusedCount(), 0U);
    two.world.update();
    EXPECT_TRUE(two.isPair());
    EXPECT_EQ(two.world.pairs.refusedCount(), 0U);
    EXPECT_EQ(two.world.pairs.validate(), "");
}

TEST(PairFilterOutOfMemory, LeavesWhatIsRefusedAsItWasWhenAFailedUpdateIsRepairedInVain) {
    if (!kCountsAllocations) {
        GTEST_SKIP() << "this program has another `new`";
    }
    struct Refusing {
        Refusing() {
            for (int i = 0; i < 100; ++i) {
                ids.push_back(grid.add(boxAt(0.9 * i), Mobility::resting));
            }
            for (int i = 0; i < 4; ++i) {
                pairs.update(refuse);
                grid.move(ids[0], boxAt(0.001 * (i + 1)));
            }
            EXPECT_THROW(pairs.update([](ProxyId, ProxyId) -> bool { throw 1; }), int);
        }
        static Aabb<float> boxAt(double x) { return boxAround<float>({x, 0, 0}, {0.5, 0.5, 0.5}); }
        static bool refuse(ProxyId, ProxyId) { return false; }
        Grid<float> grid;
        Pairs<float> pairs{grid};
        std::vector<ProxyId> ids;
    };
    const std::size_t failures = runOutOfMemory(
        [] { return std::make_unique<Refusing>(); },
        [](Refusing& world) { world.pairs.refilter(world.ids[50], Refusing::refuse); },
        [](Refusing& world, std::size_t) { EXPECT_EQ(world.pairs.refusedCount(), 99U); });
    EXPECT_GE(failures, 1U);
}

}  // namespace
}  // namespace hashphase::test
