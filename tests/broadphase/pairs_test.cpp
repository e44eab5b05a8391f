// SPDX-License-Identifier: Zlib

// What pairs tell of a few cubes: from one update to the next, at once, when the filter is asked again, when
// groups are set, and of what sweeps.

#include <tests/support/cube_stories.hpp>

#include <gtest/gtest.h>

#include <algorithm>
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

constexpr Story kSweeps[] = {
    {"FollowWhoStopsIsRemovedAndComesAgain",
     "w:50 a=0 a>100 | +aw z a>0 | -aw a>100 | +aw a- | -aw b=0 | b>100 | +bw w- | -bw"},
    {"MakePairsThatLiveOnWhenTheyOverlapLater", "b=10 a=4 a>6 | +ab a=10 | a=16 a>-6 | a>6 | -ab"},
    {"AreAnnouncedWhereTheirWaysBegin",
     "a=0 a>100 b=0.5 c=50 c! a! +ab b! | +ac a! a? z b- a? | -ab"},
};
INSTANTIATE_TEST_SUITE_P(Sweeps, Stories, testing::ValuesIn(kSweeps), nameOf);

// --- Many ----------------------------------------------------------------------------------------

TEST(Pairs, OfIdenticalBoxesAreAllOfThem) {
    Grid<double> grid;
    Pairs<double> pairs(grid);
    constexpr std::size_t kCount = 2000;
    for (std::size_t i = 0; i < kCount; ++i) {
        static_cast<void>(grid.add(makeBox<double>(1, 2, 3, 1, 2, 3)));
    }
    const PairChanges changes = pairs.update();
    EXPECT_EQ(changes.born.size(), kCount * (kCount - 1) / 2);
    EXPECT_EQ(std::adjacent_find(changes.born.begin(), changes.born.end(), std::greater_equal<>()),
              changes.born.end());
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

}  // namespace
}  // namespace hashphase::test
