// SPDX-License-Identifier: Zlib

// What pairs tell of a few cubes: from one update to the next, at once, when the filter is asked again, when
// groups are set or pairs ignored, and of what sweeps.

#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/cube_stories.hpp>
#include <tests/support/population.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::test {
namespace {

struct Story {
    const char* name;
    const char* words;  // tests/support/cube_stories.hpp
};

class Stories : public testing::TestWithParam<Story> {};

TEST_P(Stories, Hold) {
    expectStory(GetParam().words);
}

std::string nameOf(const testing::TestParamInfo<Story>& info) {
    return info.param.name;
}

constexpr Story kPairs[] = {
    {"AreBornWhenBoxesTouchAndDieWhenTheyPart",
     "| a=0 b=3 | b=1 | +ab | b=1.0000000000000002 | -ab |"},
    {"ThatPartAndMeetAgainBetweenUpdatesAreNotToldAbout", "a=0 b=0.5 | +ab z a=9 a=0.25 |"},
    {"ThatMeetOnlyBetweenUpdatesAreNotToldAbout", "a=9 b=0 | z a=0 a=5 | c=0 c- |"},
    {"OfARemovedProxyDieUnderItsOldId", "a=0 b=0.5 | +ab z b- c=0.5 | -ab +ac"},
    {"NeverMixUpTheProxiesThatFollowEachOtherInOneSlot",
     "a=0 b=0.5 | +ab b- | -ab c=5 | c- d=0.5 | +ad d- | -ad e=0.5 | +ae e- f=5 | -ae"},
    {"OfTwoProxiesRemovedTogetherDieOnce", "a=0 b=0.5 | +ab z a- b- | -ab"},
    {"OfAProxyMovedAndThenRemovedDieOnce", "a=0 b=0.5 | +ab z b=0.75 b- | -ab"},
    {"OfABoxWithNanDieAndAreBornAgainWhenItHeals", "a=0 b=0.5 | +ab b=nan | -ab z b=0.5 | +ab"},
};
INSTANTIATE_TEST_SUITE_P(Pairs, Stories, testing::ValuesIn(kPairs), nameOf);

constexpr Story kPairsNow[] = {
    {"AreToldAtOnceAndNotAgainByTheUpdate", "a=0 | z b=0.5 b! +ab |"},
    {"AreNotToldTwice", "a=0 b=0.5 a! +ab a! b! |"},
    {"AreTakenBackWhenTheBoxesHaveParted", "a=0 b=0.5 b! +ab b=7 | -ab"},
    {"AreTakenBackWhenOneWasRemoved", "a=0 b=0.5 b! +ab b- | -ab"},
    {"OfWhatCameAndWentAreToldOnce", "a=0 | b=0.5 b! +ab b- c=0.25 | -ab +ac"},
    {"AreThoseOfProxiesAtRestToo", "a:0 | z b=0.5 b! +ab | z b=10 | -ab"},
};
INSTANTIATE_TEST_SUITE_P(PairsNow, Stories, testing::ValuesIn(kPairsNow), nameOf);

constexpr Story kFilter[] = {
    {"IsAskedOnceWhileTheBoxesOverlap", "a=0 b=0.5 | +ab b=0.51 | z b=0.5 | b=0.6 |"},
    {"IsAskedAgainAboutARefusedPairOnlyWhenOneOfThemChanged",
     "a=0 b=0.5 a~1 b~1 | z b=0.51 | z a=0.1 | a~0 a=0 | +ab"},
    {"MakesNoDeathOfARefusedPairThatParts", "a=0 b=0.5 a~1 b~1 | z b=5 |"},
    {"MakesNoDeathOfARefusedPairOfWhichOneIsRemoved", "a=0 b=0.5 a~1 b~1 | z a- |"},
};
INSTANTIATE_TEST_SUITE_P(PairFilter, Stories, testing::ValuesIn(kFilter), nameOf);

constexpr Story kRefilter[] = {
    {"EndsAndBeginsPairsAtOnceAlsoOfProxiesAtRest",
     "a=0 b=0.5 | +ab z a~1 b~1 a? -ab z a~0 b? +ab z |"},
    {"ThereAndBackWithinAFrameChangesNothing", "a=0 b=0.5 | +ab z a~1 b~1 a? -ab b~0 a? +ab |"},
    {"WithTheSameFilterReportsNothing", "a=0 b=0.5 c=5 d=5.5 c~1 d~1 | +ab z a? c? ?? |"},
    {"OfANewProxyTellsItsPairsOnce", "a=0 b=0.5 | +ab c=0.25 c? +ac +bc b~1 c~1 c? -bc |"},
    {"DecidesAlsoForAPairThatIsApartForTheMoment", "a=0 b=0.5 | +ab z a=9 a~1 b~1 a? -ab a=0 |"},
    {"OfAProxyThatMovedAwayLeavesTheDeathToTheUpdate", "a=0 b=0.5 | +ab z a=9 a? | -ab"},
    {"OfAProxyWhosePartnerWasRemovedLeavesTheDeathToTheUpdate",
     "a=0 b=0.5 | +ab z b- a~1 a? | -ab"},
    {"CountsOnceWhatIsRefusedAtRestWhenOneHasWoken",
     "a=0 b=0.5 a~1 b~1 | z b=0.25 a? | a~0 a? +ab | z b=0.5 a? |"},
};
INSTANTIATE_TEST_SUITE_P(Refilter, Stories, testing::ValuesIn(kRefilter), nameOf);

constexpr Story kGroups[] = {
    {"BeginAPairWhenTheyAreSetSoThatItMayBe", "a=0 b=0.5 a#parked | z a#moving | +ab |"},
    {"KeepAPairUntilItPartsWhenTheyAreSetSoThatItMayNotBe",
     "a=0 b=0.5 | +ab z b#parked | z b=0.7 | b=9 | -ab b=0.5 |"},
    {"KeepAPairThatMayBeAgainWithoutAskingTheFilter",
     "a=0 b=0.5 | +ab z b#parked | z b#moving | z b=9 | -ab"},
    {"EndAPairByRefilter",
     "a=0 b=0.5 | +ab b#parked z a? -ab | b#moving | +ab b#parked z ?? -ab | b#moving | +ab"},
};
INSTANTIATE_TEST_SUITE_P(PairGroups, Stories, testing::ValuesIn(kGroups), nameOf);

constexpr Story kIgnored[] = {
    {"EndAtOnceAndBeginAtOnce", "a=0 b=0.5 | +ab z a^b -ab z a&b +ab z |"},
    {"DoNotBegin", "a=0 b=9 | a^b b=0.5 | z b! a? ?? | b=9 | b=0.5 a&b +ab |"},
    {"AreToldOfByNobodyWithinAFrame", "a=0 b=0.5 | +ab z a^b -ab a&b +ab a^b -ab |"},
    {"AreNoCandidatesBeforeTheFirstUpdate", "a=0 b=0.5 a^b a! | z a&b +ab |"},
    {"BeginWithTheUpdateWhereTheyAreApart", "a=0 b=0.5 | +ab a^b -ab b=9 a&b | b=0.5 | +ab"},
    {"ThatPartAndAreIgnoredDieAtOnce", "a=0 b=0.5 | +ab z b=9 a^b -ab | b=0.5 | a&b +ab |"},
    {"ThatWereFoundAtOnceEndAtOnce", "a=0 | b=0.5 b! +ab a^b -ab b! a&b +ab b=9 | -ab"},
    {"AreGoneWithAProxy", "a=0 b=0.5 | +ab a^b -ab b- c=0.5 | +ac z a^c -ac c- | d=0.5 | +ad"},
    {"AreGoneWithAProxyThatNoUpdateHasSeen", "a=0 | b=0.5 a^b b- c=0.5 | +ac"},
    {"AreNotAskedAbout", "a=0 b=0.5 a~1 b~1 | a^b a~0 ?? | z b=0.6 | a&b +ab a~1 a? -ab a^b a&b |"},
    {"AreSetApartFromGroups",
     "a=0 b=0.5 | +ab b#parked z a^b -ab | z b#moving | z b=0.7 | a&b +ab b#parked | a^b -ab a&b |"
     " b#moving | +ab"},
    {"MayBeOfSweeps",
     "w:50 a=0 a>100 | +aw z a^w -aw | a>100 | z a&w +aw | a>0 | -aw a^w a>100 | a>0 a=50 | a&w "
     "+aw"},
    {"OfAStillPairAreFiledApart", "a:0 b:0.5 | +ab z a^b -ab z c=0.75 | +ac +bc z a&b +ab |"},
};
INSTANTIATE_TEST_SUITE_P(IgnoredPairs, Stories, testing::ValuesIn(kIgnored), nameOf);

constexpr Story kSweeps[] = {
    {"FollowWhoStopsIsRemovedAndComesAgain",
     "w:50 a=0 a>100 | +aw z a>0 | -aw a>100 | +aw a- | -aw b=0 | b>100 | +bw w- | -bw"},
    {"MakePairsThatLiveOnWhenTheyOverlapLater", "b=10 a=4 a>6 | +ab a=10 | a=16 a>-6 | a>6 | -ab"},
    {"AreAnnouncedWhereTheirWaysBegin",
     "a=0 a>100 b=0.5 c=50 c! a! +ab b! | +ac a! a? z b- a? | -ab"},
};
INSTANTIATE_TEST_SUITE_P(Sweeps, Stories, testing::ValuesIn(kSweeps), nameOf);

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
    const auto cubeAt = [](double x) { return makeBox<double>(x, 0, 0, x + 1, 1, 1); };
    std::vector<ProxyId> ids;
    for (int i = 0; i < 60; ++i) {
        ids.push_back(grid.add(cubeAt(0.4 * i)));
        ASSERT_EQ(oneByOne.add(cubeAt(0.4 * i)), ids.back());
    }
    for (std::size_t frame = 0; frame < 20; ++frame) {
        for (std::size_t i = frame % 2; i < ids.size(); i += 2) {
            const auto box = cubeAt(0.4 * static_cast<double>((i * 7 + frame) % ids.size()));
            grid.move(ids[i], box);
            oneByOne.move(ids[i], box);
        }
        calls = 0;
        const PairChanges changes = pairs.update(ask);
        const PairChanges expected = oneByOne.update();
        ASSERT_TRUE(std::ranges::equal(changes.born, expected.born));
        ASSERT_TRUE(std::ranges::equal(changes.died, expected.died));
        EXPECT_EQ(calls, 1U);
        EXPECT_EQ(pairs.refusedCount(), oneByOne.pairs.refusedCount());
        ASSERT_EQ(pairs.validate(), "");
    }
    EXPECT_GT(pairs.count(), 0U);
}

TEST(PairFilter, MayTakeItsArgumentsAsAuto) {
    Grid<double> grid;
    Pairs<double> pairs(grid);
    static_cast<void>(grid.add(makeBox<double>(0, 0, 0, 1, 1, 1)));
    static_cast<void>(grid.add(makeBox<double>(0, 0, 0, 1, 1, 1)));
    const auto accept = [](auto a, auto b) { return a != b; };
    PairFilter filter = accept;
    PairFilter copy = filter;
    EXPECT_EQ(pairs.update(copy).born.size(), 1U);
}

// --- Whether there is anything to find -------------------------------------------------------------

TEST(PairsUpToDate, AreSoFromAnUpdateToTheNextChange) {
    const Aabb<float> here = boxAround<float>({0, 0, 0}, {1, 1, 1});
    const Aabb<float> there = boxAround<float>({0.25, 0, 0}, {1, 1, 1});
    Grid<float> grid;
    Sweeps<float> sweeps(grid);
    Pairs<float> pairs(grid, &sweeps);
    const ProxyId a = grid.add(here);
    ProxyId b = grid.add(here, Mobility::resting);
    const std::function<void()> changes[] = {
        [] {},  // those before
        [&] { grid.move(a, there); },
        [&] { grid.move(b, there); },
        [&] {
            grid.setGroups(a, {1, 1});
        },
        [&] { grid.remove(b); },
        [&] { b = grid.add(here); },
        [&] {
            grid.move(b, there);
            static_cast<void>(pairs.findPairsNow(b, acceptAllPairs));
        },
        [&] {
            grid.shiftOrigin({0.1F, 0, 0});
        }};
    for (const auto& change : changes) {
        change();
        EXPECT_FALSE(pairs.isUpToDate());
        pairs.update();
        EXPECT_TRUE(pairs.isUpToDate());
        grid.move(a, Aabb<float>(grid.box(a)));
        EXPECT_TRUE(pairs.isUpToDate());
    }
    sweeps.set(a, Vector3<float>(5, 0, 0));
    pairs.update();
    EXPECT_FALSE(pairs.isUpToDate()) << "what sweeps is looked at in each update";
}

// --- Cost ----------------------------------------------------------------------------------------

/// Boxes of 1 to 2 m with some overlap, spread over a cube, and their pairs.
struct PairCosts : testing::Test {
    void addMany(std::uint32_t count) {
        boxes.addMany(count, boxesIn<float>(0., 2.5 * std::cbrt(count), 0.5, 1));
    }
    void nudge(std::size_t i, double step) {
        boxes.moveTo(i, shifted(boxes.random, boxes.proxies[i].box, step));
    }
    const PairCost& update() {
        changes = pairs.update();
        return pairs.lastCost();
    }

    Population<float> boxes;
    Pairs<float> pairs{boxes.grid};
    PairChanges changes;
};

TEST_F(PairCosts, OfAnUpdateAfterWhichNothingChangedIsZero) {
    addMany(3000);
    update();
    for (int i = 0; i < 20; ++i) {
        for (std::size_t k = 0; k < boxes.proxies.size(); ++k) {
            nudge(k, 0);
        }
        update();
        EXPECT_TRUE(changes.born.empty() && changes.died.empty());
        EXPECT_EQ(pairs.lastCost().grid.changed, 0U);
        EXPECT_EQ(pairs.lastCost().grid.filed, 0U);
        EXPECT_EQ(pairs.lastCost().boxesTested, 0U);
    }
    EXPECT_EQ(pairs.lastCost().pairsWatched, 0U);
}

TEST_F(PairCosts, FollowsWhatMovesNotWhatExists) {
    constexpr std::uint32_t kCount = 20000;
    constexpr std::uint32_t kMovingCount = 50;
    addMany(kCount);
    for (int frame = 0; frame < 40; ++frame) {
        for (std::uint32_t i = 0; i < kMovingCount; ++i) {
            nudge(i * 397, 0.1);
        }
        const auto& cost = update();
        if (frame < 20) {
            continue;
        }
        EXPECT_EQ(cost.grid.changed, kMovingCount);
        EXPECT_LE(cost.grid.filed, 2 * kMovingCount);
        EXPECT_GE(cost.grid.resting, kCount - 2 * kMovingCount);
        // Some dozen neighbours each, where a search through all would be a million tests.
        EXPECT_LT(cost.boxesTested, 200 * kMovingCount);
        EXPECT_LT(cost.pairsWatched, 20 * kMovingCount);
    }
}

TEST_F(PairCosts, OfStaticProxiesEndsAfterTheSecondUpdate) {
    boxes.addMany(5000, cubesIn<float>(0, 50, 1), 1);
    boxes.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    update();
    for (int frame = 0; frame < 5; ++frame) {
        nudge(5000, 1);
        const auto& cost = update();
        EXPECT_EQ(cost.grid.changed, 1U);
        EXPECT_EQ(cost.grid.resting, 5000U);
        if (frame > 0) {
            EXPECT_EQ(cost.grid.filed, 1U);
            EXPECT_LT(cost.boxesTested, 500U);
        }
    }
}

TEST_F(PairCosts, CountsTheSearchOnBehalfOfProxiesThatWake) {
    boxes.add(makeBox<float>(0, 0, 0, 1, 1, 1));
    boxes.addMany(500, [](Random&) { return makeBox<float>(0.5, 0, 0, 1, 1, 1); });
    boxes.add(makeBox<float>(-100, 0, 0, -99, 1, 1));
    for (int i = 0; i < 30; ++i) {
        boxes.moveTo(501, makeBox<float>(-100 - i, 0, 0, -99, 1, 1));
        update();
    }
    EXPECT_EQ(pairs.lastCost().pairsWatched, 0U);
    boxes.moveTo(0, makeBox<float>(900, 0, 0, 901, 1, 1));  // to where nothing is
    EXPECT_GE(update().boxesTested, 500U);
    EXPECT_EQ(changes.died.size(), 500U);
}

// --- Threads -------------------------------------------------------------------------------------

template <class Scalar>
class PairsOnThreads : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PairsOnThreads, Scalars);

/// Two sizes, so that there are two levels, large enough for several ranges each.
template <class Scalar>
void addTwoSizes(Population<Scalar>& boxes, std::size_t count) {
    const double side = 2.2 * std::cbrt(static_cast<double>(count));
    boxes.addMany(count / 10, cubesIn<Scalar>(0., side, 2));
    boxes.addMany(count - count / 10, cubesIn<Scalar>(0., side, 0.5));
}

TYPED_TEST(PairsOnThreads, AreTheSameOnAnyNumberOfThreads) {
    const auto accepts = [](ProxyId a, ProxyId b) { return (a.index + b.index) % 7 != 0; };
    for (const std::size_t threadCount : {2U, 5U}) {
        SCOPED_TRACE(testing::Message() << threadCount << " threads");
        ThreadedFor threadedFor(threadCount, 0x5eed0702);
        Population<TypeParam> serial;
        Population<TypeParam> parallel;
        Pairs<TypeParam> serialPairs(serial.grid);
        Pairs<TypeParam> parallelPairs(parallel.grid);
        addTwoSizes(serial, 20000);
        addTwoSizes(parallel, 20000);
        std::size_t changes = 0;
        for (int frame = 0; frame < 14; ++frame) {
            const PairChanges expected = serialPairs.update(accepts);
            const PairChanges actual = parallelPairs.update(accepts, threadedFor);
            ASSERT_TRUE(std::ranges::equal(expected.born, actual.born)) << "frame " << frame;
            ASSERT_TRUE(std::ranges::equal(expected.died, actual.died)) << "frame " << frame;
            ASSERT_EQ(serialPairs.lastCost().boxesTested, parallelPairs.lastCost().boxesTested);
            ASSERT_EQ(serialPairs.lastCost().grid.resting, parallelPairs.lastCost().grid.resting);
            changes += expected.born.size() + expected.died.size();
            // Half of them come to rest after a while.
            for (std::size_t i = 0; i < 20000; i += frame < 2 ? 1 : 2) {
                const auto box = shifted(serial.random, serial.proxies[i].box, 0.3);
                serial.moveTo(i, box);
                parallel.moveTo(i, box);
            }
        }
        EXPECT_GT(changes, 10000U);
        EXPECT_GT(parallelPairs.lastCost().grid.resting, 5000U);
        EXPECT_GT(threadedFor.mostRanges(), 4U);
        EXPECT_EQ(parallel.grid.validate(), "");
        EXPECT_EQ(parallelPairs.validate(), "");
    }
}

TYPED_TEST(PairsOnThreads, OfAGridAloneAreFiledTheSame) {
    ThreadedFor threadedFor(4, 0x5eed0704);
    Population<TypeParam> boxes;
    addTwoSizes(boxes, 20000);
    EXPECT_EQ(boxes.grid.update(threadedFor).filed, 20000U);
    EXPECT_EQ(boxes.grid.validate(), "");
}

// Marks of who is in the list of changes are numbers that come round, after 255 lists.
TEST(Pairs, FindWhoMovesAgainAfterAnyNumberOfUpdates) {
    for (int pause = 250; pause <= 260; ++pause) {
        SCOPED_TRACE(pause);
        const Aabb<float> here(Vector3<float>(0, 0, 0), Vector3<float>(1, 1, 1));
        const auto placed = [&](float x, float y) {
            return here.translated(Vector3<float>(x, y, 0));
        };
        Grid<float> grid;
        Pairs<float> pairs(grid);
        std::vector<ProxyId> ids;
        for (int i = 0; i < 200; ++i) {
            ids.push_back(grid.add(placed(1.02F * static_cast<float>(i), 0)));
        }
        const ProxyId busy = grid.add(placed(0, 90));
        for (int update = 0; update < 120 + pause; ++update) {
            const float aside = update % 2 == 0 ? 0.005F : 0;
            grid.move(busy, placed(20 * aside, 90));
            for (int i = 0; i < 200 && update < 120; ++i) {  // they tremble, and then stay
                grid.move(ids[std::size_t(i)], placed(1.02F * static_cast<float>(i), aside));
            }
            pairs.update();
        }
        grid.move(ids[0], placed(0.03F, 0));
        const PairChanges changes = pairs.update();
        ASSERT_EQ(changes.born.size(), 1U);
        EXPECT_TRUE(changes.born[0] == makePair(ids[0], ids[1]));
    }
}

}  // namespace
}  // namespace hashphase::test
