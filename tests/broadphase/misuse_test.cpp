// SPDX-License-Identifier: Zlib

// What a caller may not do is asserted, and none of it happens. What callbacks may do is in callbacks_test.cpp.

#include <broadphase/diagnostics.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <tests/support/box_scenes.hpp>
#include <tests/support/call_each.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/oracles.hpp>
#include <tests/support/query_checks.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace hashphase::test {
namespace {

#if HASHPHASE_ENABLE_ASSERTS

Aabb<float> blockAt(double x) {
    return boxAround<float>({x, 0, 0}, {1, 1, 1});
}

/// Two cubes that touch, with sweeps and pairs; broken assertions throw.
struct Misuse : testing::Test {
    static constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    static bool accept(ProxyId, ProxyId) { return true; }

    template <class Call>
    static void expectAsserted(const Call& call) {
        EXPECT_THROW(call(), BrokenAssert);
    }
    /// Calls everything that changes a grid; all of it must be asserted, and none of it happen.
    void expectThatNothingMayChange() {
        expectAsserted([&] { static_cast<void>(grid.add(blockAt(0))); });
        expectAsserted([&] { grid.move(id, blockAt(5)); });
        expectAsserted([&] { grid.remove(id); });
        expectAsserted([&] { grid.reserve(100); });
        expectAsserted([&] { sweeps.set(id, {9, 0, 0}); });
    }
    /// Calls everything that no query may do, of its own or not.
    void expectThatTheGridStays() {
        expectAsserted([&] { grid.clear(); });
        expectAsserted([&] { grid.shiftOrigin({1, 0, 0}); });
        expectAsserted([&] { pairs->clear(); });
        expectAsserted([&] { pairs->update(); });
    }
    void TearDown() override {
        EXPECT_EQ(grid.size(), 2U);
        EXPECT_TRUE(isSameBits(grid.box(id), blockAt(0)));
        EXPECT_TRUE(sweeps.motion(id).displacement.isZero(0));
        EXPECT_EQ(grid.validate() + sweeps.validate(), "");
        if (pairs != nullptr) {
            pairs->update();
            EXPECT_EQ(pairs->count(), 1U);
            EXPECT_EQ(pairs->validate(), "");
        }
    }

    ThrowingAsserts throwing;
    Grid<float> grid;
    Sweeps<float> sweeps{grid};
    std::unique_ptr<Pairs<float>> pairs = std::make_unique<Pairs<float>>(grid, &sweeps);
    ProxyId id = grid.add(blockAt(0), Mobility::resting);
    ProxyId other = grid.add(blockAt(1));
    int calls = 0;
};

TEST_F(Misuse, OfNumbersAndCountsIsAsserted) {
    const CaughtMessages aboutNan;
    grid.move(other, {Vector3<float>(0, 0, 0), Vector3<float>(1, kNan, 1)});
    expectAsserted([&] { static_cast<void>(grid.cellsOf(other)); });
    grid.move(other, blockAt(1));
    expectAsserted([&] { static_cast<void>(grid.cellAt({kNan, 0, 0})); });
    expectAsserted([&] { static_cast<void>(grid.cellAt({0, kInfinity, 0})); });
    expectAsserted([&] { grid.shiftOrigin({0, kInfinity, 0}); });
    expectAsserted([&] { grid.shiftOrigin({kNan, 0, 0}); });
    EXPECT_THROW(grid.reserve(~std::size_t{0}), std::length_error);
    const std::vector<BoxRegion<float>> regions(2, {blockAt(0)});
    std::vector<CollectCount> counts(3);
    expectAsserted([&] { grid.visitEach(std::span(regions), std::span(counts)); });
}

TEST_F(Misuse, OfWhatBelongsToPairsIsAsserted) {
    expectAsserted([&] { grid.update(); });
    expectAsserted([&] { grid.clear(); });
    expectAsserted([&] { const Pairs<float> second(grid); });
    Grid<float> another;
    expectAsserted([&] { const Pairs<float> ofAnother(another, &sweeps); });
    std::vector<ProxyPair> list;
    expectAsserted([&] { pairs->collect(list); });
    // They leave the grid free for others when they end.
    pairs = nullptr;
    grid.update();
    pairs = std::make_unique<Pairs<float>>(grid);
}

TEST_F(Misuse, OfACollectorThatEndsFramesIsAsserted) {
    sweeps.set(other, {9, 0, 0});
    CallEach collector{[&](ProxyId, float) {
        ++calls;
        expectThatTheGridStays();
    }};
    grid.visit(BoxRegion<float>{blockAt(0)}, collector);
    sweeps.visit(BoxRegion<float>{blockAt(5)}, collector);
    EXPECT_EQ(calls, 3);
    sweeps.set(other, {0, 0, 0});
}

TEST_F(Misuse, OfACollectorThatChangesWhereManyAreDealtWithAtOnceIsAsserted) {
    CallEach collector{[&](ProxyId, float) {
        ++calls;
        expectThatNothingMayChange();
        expectThatTheGridStays();
    }};
    const BoxRegion<float> region{blockAt(0)};
    const RayRegion<float> ray({-9, 0, 0}, {9, 0, 0});
    grid.visitEach(std::span(&region, 1), std::span(&collector, 1));
    grid.visitEach(std::span(&ray, 1), std::span(&collector, 1));
    grid.visit(ConvexRegion<float>({}), collector);
    EXPECT_EQ(calls, 6);
}

TEST_F(Misuse, OfAFilterThatChangesTheGridOrAsksForPairsIsAsserted) {
    const auto filter = [&](ProxyId, ProxyId) {
        ++calls;
        expectThatNothingMayChange();
        expectThatTheGridStays();
        expectAsserted([&] { pairs->findPairsNow(id, accept); });
        expectAsserted([&] { pairs->refilter(id, accept); });
        expectAsserted([&] { pairs->ignore(makePair(id, other)); });
        expectAsserted([&] { pairs->stopIgnoring(makePair(id, other), accept); });
        EXPECT_EQ(find(grid, BoxRegion<float>{blockAt(0)}).size(), 2U) << "it may ask the grid";
        return true;
    };
    EXPECT_EQ(pairs->update(filter).born.size(), 1U);
    EXPECT_TRUE(pairs->refilter(id, filter).born.empty());
    EXPECT_EQ(calls, 2);
}

TEST_F(Misuse, OfTheCallbacksOfARadiusSearchIsAsserted) {
    RadiusSearch<float> search;
    search.take(grid, 1, [&](ProxyId) {
        ++calls;
        expectThatNothingMayChange();
        expectAsserted([&] { search.take(grid, 1); });
        return true;
    });
    std::vector<std::uint32_t> counts(2);
    const auto ask = [&] {
        ++calls;
        expectAsserted([&] { search.take(grid, 2); });
        expectAsserted([&] { search.count(counts); });
    };
    search.forEach([&](std::uint32_t, std::span<const std::uint32_t>) { ask(); });
    const auto groupOf = [&](ProxyId) {
        ask();
        return 0U;
    };
    search.countGroups(1, groupOf, counts);
    EXPECT_GE(calls, 6);
    // One count for each agent and group, no more groups than there may be, and agents that there are.
    counts.resize(3);
    expectAsserted([&] { search.count(counts); });
    expectAsserted([&] { search.countGroups(3, groupOf, counts); });
    counts.resize(66);
    expectAsserted([&] { search.countGroups(33, groupOf, counts); });
    expectAsserted([&] { static_cast<void>(search.id(2)); });
    expectAsserted([&] { static_cast<void>(search.position(2)); });
    search.take(grid, 1);  // all scopes have ended
    EXPECT_EQ(search.size(), 2U);
}

TEST(MisuseDeathTest, EndsTheProgramWithASentence) {
    Grid<float> grid;
    EXPECT_DEATH_IF_SUPPORTED(grid.remove({}),
                              "Grid::remove.*: the id is null, stale, or of another grid");
    const auto goesBeforeItsPairs = [] {
        auto gone = std::make_unique<Grid<float>>();
        const Pairs<float> pairs(*gone);
        gone.reset();
    };
    EXPECT_DEATH_IF_SUPPORTED(goesBeforeItsPairs(), "the grid was destroyed before its Pairs");
    const ProxyId id = grid.add(blockAt(0));
    Pairs<float> pairs(grid);
    EXPECT_DEATH_IF_SUPPORTED(
        pairs.ignore({id, id}),
        "Pairs::ignore.*: the pair is not of two different proxies of the grid");
    CallEach releasing{[&](ProxyId, float) { grid.releaseUnusedMemory(); }};
    EXPECT_DEATH_IF_SUPPORTED(grid.visit(BoxRegion<float>{blockAt(0)}, releasing),
                              "releaseUnusedMemory.* was called from within a query");
}

#endif

// --- Without assertions --------------------------------------------------------------------------

Aabb<double> cubeAt(double x) {
    return makeBox<double>(x, 0, 0, x + 1, 1, 1);
}

struct StaleIds : testing::Test {
    StaleIds() {
        for (int i = 0; i < 20; ++i) {
            ids.push_back(grid.add(cubeAt(0.5 * i)));
        }
        pairs.update();
        const ProxyId replaced = ids[3];
        const ProxyId vacant = ids[7];
        grid.remove(replaced);
        pairs.update();
        ids[3] = grid.add(cubeAt(1.5));
        EXPECT_EQ(ids[3].index, replaced.index);
        grid.remove(vacant);
        ids.erase(ids.begin() + 7);
        pairs.update();
        stale = {ProxyId{}, replaced, vacant, ProxyId{1'000'000, 1}};
    }

    std::vector<ProxyId> ids;
    std::array<ProxyId, 4> stale;
    Grid<double> grid;
    Sweeps<double> sweeps{grid};
    Pairs<double> pairs{grid, &sweeps};
};

TEST_F(StaleIds, AreAssertedAndChangeNobodyWithoutAssertions) {
    const CaughtAsserts caught;
    const std::size_t pairCount = pairs.count();
    const auto refuse = [](ProxyId, ProxyId) { return false; };
    for (const ProxyId id : stale) {
        const std::function<void()> calls[] = {
            [&] { grid.move(id, cubeAt(-99)); },
            [&] { grid.remove(id); },
            [&] {
                grid.setGroups(id, {2, 4});
            },
            [&] { sweeps.set(id, Vector3<double>(9, 0, 0)); },
            [&] { EXPECT_TRUE(grid.groups(id) == ProxyGroups{}); },
            [&] { EXPECT_TRUE(hasNan(grid.box(id))); },
            [&] { static_cast<void>(grid.cellsOf(id)); },
            [&] { EXPECT_TRUE(hasNan(sweeps.motion(id).box)); },
            [&] { EXPECT_TRUE(pairs.findPairsNow(id, acceptAllPairs).born.empty()); },
            [&] { EXPECT_TRUE(pairs.refilter(id, refuse).died.empty()); },
            [&] {
                EXPECT_TRUE(pairs.ignore({ids[0], id}).died.empty());
            }};
        for (const auto& call : calls) {
            const int before = caught.count();
            call();
            EXPECT_EQ(caught.count() > before, HASHPHASE_ENABLE_ASSERTS != 0) << &call - calls;
        }
    }
    EXPECT_TRUE(pairs.refilter(stale, refuse).died.empty());
    const PairChanges changes = pairs.update();
    EXPECT_TRUE(changes.born.empty() && changes.died.empty());
    EXPECT_EQ(pairs.count(), pairCount);
    EXPECT_EQ(grid.size(), ids.size());
    EXPECT_EQ(sweeps.size(), 0U);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_EQ(grid.box(ids[i]).min().x(), 0.5 * static_cast<double>(i < 7 ? i : i + 1));
    }
    EXPECT_EQ(grid.validate() + pairs.validate(), "");
}

TEST_F(StaleIds, AmongOthersAreLeftOut) {
    const CaughtAsserts caught;
    std::vector<ProxyId> mixed(ids);
    mixed.insert(mixed.end(), stale.begin(), stale.end());
    const std::size_t pairCount = pairs.count();
    EXPECT_EQ(pairs.refilter(mixed, [](ProxyId, ProxyId) { return false; }).died.size(), pairCount);
    EXPECT_EQ(pairs.count(), 0U);
}

// What belongs to the pairs' own calls.
TEST_F(StaleIds, LoseNoPairWhereTheGridIsUpdatedOrClearedBesideItsPairs) {
    const CaughtAsserts caught;
    const std::size_t pairCount = pairs.count();
    const ProxyId fresh = grid.add(cubeAt(0));
    EXPECT_EQ(grid.update().changed, 0U);
    grid.clear();
    EXPECT_TRUE(grid.contains(fresh));
    EXPECT_EQ(pairs.update().born.size(), 3U);
    EXPECT_EQ(pairs.count(), pairCount + 3);
    EXPECT_EQ(pairs.validate(), "");
    EXPECT_EQ(caught.count(), 2);
}

// --- Handlers ------------------------------------------------------------------------------------

void ignoreMessage(const char* /*message*/) {}
void ignoreAssert(const char* /*condition*/, const char* /*sentence*/, const char* /*file*/,
                  int /*line*/) {}

TEST(Diagnostics, ReplacingAHandlerReturnsThePreviousOne) {
    const MessageHandler messageDefault = setMessageHandler(&ignoreMessage);
    EXPECT_NE(messageDefault, nullptr);
    EXPECT_EQ(setMessageHandler(nullptr), &ignoreMessage);
    EXPECT_EQ(setMessageHandler(nullptr), messageDefault);

    const AssertHandler assertDefault = setAssertHandler(&ignoreAssert);
    EXPECT_NE(assertDefault, nullptr);
    EXPECT_EQ(setAssertHandler(nullptr), &ignoreAssert);
    EXPECT_EQ(setAssertHandler(nullptr), assertDefault);
}

#if GTEST_HAS_STREAM_REDIRECTION
TEST(Diagnostics, TheDefaultMessageHandlerWritesToStderr) {
    testing::internal::CaptureStderr();
    detail::reportMessage("A sentence.");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "hashphase: A sentence.\n");
}
#endif

TEST(Diagnostics, AHandlerReceivesTheMessage) {
    const CaughtMessages messages;
    detail::reportMessage("A sentence.");
    EXPECT_EQ(messages.all(), std::vector<std::string>{"A sentence."});
}

TEST(Diagnostics, ABrokenAssertReachesTheHandlerWithItsSentence) {
    const ThrowingAsserts throwing;
    try {
        detail::reportBrokenAssert("a < b", "What would be right.", "file.cpp", 7);
        FAIL();
    } catch (const BrokenAssert& broken) {
        EXPECT_STREQ(broken.what(), "What would be right.");
    }
}

TEST(DiagnosticsDeathTest, TheDefaultAssertHandlerNamesTheFaultAndAborts) {
    EXPECT_DEATH_IF_SUPPORTED(
        detail::reportBrokenAssert("a < b", "What would be right.", "file.cpp", 7),
        "What would be right.*file.cpp:7.*a < b");
}

}  // namespace
}  // namespace hashphase::test
