// SPDX-License-Identifier: Zlib
//
// When the filter is asked, and what happens when its answer changes: in words, by refilter(), or by
// groups and masks that are written without a word.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/broadphases.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace hashphase::test {
namespace {

using Proxy = btBroadphaseProxy;

constexpr int kAll = Proxy::AllFilter;

const Box kHere = boxAround({0, 0, 0}, {1, 1, 1});
const Box kBeside = boxAround({1, 0, 0}, {1, 1, 1});
const Box kThere = boxAround({9, 0, 0}, {1, 1, 1});

const ObjectPairs kNone{};
const ObjectPairs kBoth{{0, 1}};

class Filters : public testing::Test {
protected:
    explicit Filters(std::unique_ptr<btOverlappingPairCache> cache = nullptr)
        : player(hashPlayer(6, std::move(cache), eagerCharactersAndSensors())) {}
    ~Filters() override { EXPECT_EQ(hashOf(player).validate(), ""); }

    void createTwo() {
        player.create(0, kHere);
        player.create(1, kBeside);
    }
    /// Written, and told.
    void refilter(int object, int mask) {
        player.setMask(object, mask);
        hashOf(player).refilter(player.proxy(object), nullptr);
    }
    void expect(const ObjectPairs& now) { EXPECT_EQ(player.pairs(), now); }
    void expectNowAndAfterStep(const ObjectPairs& now) {
        expect(now);
        EXPECT_EQ(player.pairsAfterStep(), now);
    }

    FilterBy filter{true};  // to be set
    Player player;
};

// --- Whom the filter is asked about --------------------------------------------------------------

TEST_F(Filters, AreAskedOnceForAPairThatLasts) {
    player.cache().setOverlapFilterCallback(&filter);
    createTwo();
    player.create(2, kThere);
    for (int frame = 0; frame < 30; ++frame) {
        player.set(0, boxAround({btScalar(frame) / 100, 0, 0}, {1, 1, 1}));
        ASSERT_EQ(player.pairsAfterStep(), kBoth);
    }
    EXPECT_EQ(filter.asked, 1U);
}

TEST_F(Filters, AreAskedAgainForARefusedPairOnlyWhenEitherMoves) {
    filter.answer = false;
    player.cache().setOverlapFilterCallback(&filter);
    createTwo();
    player.calculate();
    EXPECT_EQ(filter.asked, 1U);
    player.calculate(30);  // long enough to come to rest
    EXPECT_EQ(filter.asked, 1U);
    player.set(1, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kNone);
    EXPECT_EQ(filter.asked, 2U);
    filter.answer = true;
    player.set(0, kBeside);
    EXPECT_EQ(player.pairsAfterStep(), kBoth);
    EXPECT_EQ(filter.asked, 3U);
}

TEST_F(Filters, LeaveAPairAloneUntilItSeparatesUnlessRefiltered) {
    createTwo();
    player.calculate();
    player.setMask(0, 0);
    player.set(0, kBeside);
    EXPECT_EQ(player.pairsAfterStep(), kBoth) << "As in all of Bullet's broadphases.";
    player.set(0, kThere);
    player.calculate();
    player.set(0, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kNone);
}

// --- refilter() ----------------------------------------------------------------------------------

TEST_F(Filters, AreAskedAtOnceByRefilter) {
    createTwo();
    player.calculate();
    refilter(0, 0);
    expectNowAndAfterStep(kNone);
    player.setMask(0, kAll);
    refilter(1, kAll);
    expectNowAndAfterStep(kBoth);  // Either of the two may be named.
}

TEST_F(Filters, AreAskedByRefilterAboutProxiesAtRestToo) {
    createTwo();
    player.setMask(1, 0);
    player.calculate(40);
    expect(kNone);
    player.setMask(1, kAll);
    refilter(0, kAll);
    expect(kBoth);
    player.calculate(40);
    refilter(1, 0);
    expectNowAndAfterStep(kNone);
}

TEST_F(Filters, AreAskedByRefilterAboutWhatBeganInThisStep) {
    createTwo();
    refilter(0, kAll);
    expect(kBoth);
    refilter(1, 0);
    expectNowAndAfterStep(kNone);
}

// What separates and comes back within a step was together at both ends of it.
TEST_F(Filters, AreAskedByRefilterAboutPairsThatAreApartForTheMoment) {
    createTwo();
    player.calculate();
    player.set(0, kThere);
    refilter(0, 0);
    player.set(0, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kNone);
}

TEST_F(Filters, AreAskedByRefilterAboutEagerPairsThatAreApartForTheMoment) {
    player.create(0, kHere);
    player.create(1, kThere, Proxy::SensorTrigger);
    player.calculate();
    player.set(1, kHere);
    expect(kBoth);  // Sensors have their pairs at once.
    player.set(1, kThere);
    refilter(1, 0);
    player.set(1, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kNone);
}

TEST_F(Filters, AskedByRefilterNeverNameADestroyedProxy) {
    createTwo();
    player.create(2, kHere);
    player.calculate();
    player.destroy(1);
    refilter(0, kAll);
    expectNowAndAfterStep({{0, 2}});
}

TEST_F(Filters, OfManyProxiesAreAskedOnceAboutEachTwo) {
    Boxes boxes;
    boxes.cache.setOverlapFilterCallback(&filter);
    for (int i = 0; i < 1000; ++i) {
        boxes.create(boxAround({btScalar(1.5) * btScalar(i), 0, 0}, {1, 1, 1}));
    }
    boxes.check();
    ASSERT_EQ(boxes.pairCount(), 999);
    for (const bool areAll : {true, false}) {
        filter.answer = !filter.answer;
        filter.asked = 0;
        if (areAll) {
            boxes.broadphase.refilterAll(nullptr);
        } else {
            boxes.broadphase.refilter(boxes.proxies, nullptr);
        }
        EXPECT_EQ(filter.asked, 999U);
        EXPECT_EQ(boxes.pairCount(), filter.answer ? 999 : 0);
        EXPECT_EQ(boxes.broadphase.validate(), "");
    }
}

class FiltersOverDeferredRemoval : public Filters {
protected:
    FiltersOverDeferredRemoval() : Filters(std::make_unique<btSortedOverlappingPairCache>()) {
        createTwo();
        player.create(2, kHere);
        EXPECT_EQ(player.pairsAfterStep(), kThree);
    }
    const ObjectPairs kThree{{0, 1}, {0, 2}, {1, 2}};
};

TEST_F(FiltersOverDeferredRemoval, AreObeyedAfterTheStep) {
    refilter(2, 0);
    EXPECT_EQ(player.pairsAfterStep(), kBoth);
    refilter(2, kAll);
    EXPECT_EQ(player.pairsAfterStep(), kThree);
}

TEST_F(FiltersOverDeferredRemoval, LeavePairsAloneThatAreApartForTheMoment) {
    player.set(0, kThere);
    refilter(2, kAll);
    player.set(0, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kThree);
}

// --- Written without a word ----------------------------------------------------------------------

TEST_F(Filters, ThatAreWrittenCountWhenEitherOfTheTwoMovesAsUnderDbvt) {
    for (const bool isOurs : {false, true}) {
        for (const int moved : {0, 1}) {
            for (const int stepsBefore : {1, 40}) {
                SCOPED_TRACE(testing::Message() << isOurs << moved << stepsBefore);
                Player two = isOurs ? hashPlayer(6) : Player(6, makeBroadphase<ExactDbvt>());
                two.create(0, kHere, 1, 0);
                two.create(1, kThere, 1, kAll);
                two.calculate(stepsBefore);
                two.setMask(0, kAll);
                EXPECT_EQ(two.pairsAfterStep(), kNone);
                two.set(moved, moved == 0 ? kThere : kHere);
                EXPECT_EQ(two.pairsAfterStep(), kBoth);
            }
        }
    }
}

TEST_F(Filters, ThatAreWrittenCountWhenTheBoxIsSetToWhatItWas) {
    player.create(0, kHere, 1, 0);
    player.create(1, kBeside, 1, kAll);
    player.calculate(20);
    player.setMask(0, kAll);
    player.set(0, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kBoth);
    player.setMask(0, 0);
    player.set(0, kHere);
    EXPECT_EQ(player.pairsAfterStep(), kBoth) << "A pair stays one until its boxes part.";
    player.set(0, kThere);
    EXPECT_EQ(player.pairsAfterStep(), kNone);
}

TEST_F(Filters, ThatAreWrittenBringEagerPairsAtOnce) {
    player.create(0, kHere, Proxy::SensorTrigger, 0);
    player.create(1, kBeside, 1, kAll);
    EXPECT_EQ(player.pairsAfterStep(), kNone);
    player.setMask(0, kAll);
    player.set(0, kHere);
    expectNowAndAfterStep(kBoth);
}

// --- Callbacks that come and go ------------------------------------------------------------------

TEST_F(Filters, DecideInPlaceOfGroupsAndMasksWhileTheyAreSet) {
    for (const CacheKind& kind : {cacheKinds()[0], cacheKinds()[3]}) {
        SCOPED_TRACE(kind.name);
        Player three = hashPlayer(6, kind.make());
        three.create(0, kHere, 1, 0);
        three.create(1, kBeside);
        three.create(2, kHere);
        EXPECT_EQ(three.pairsAfterStep(), (ObjectPairs{{1, 2}}));
        three.cache().setOverlapFilterCallback(&filter);
        hashOf(three).refilterAll(nullptr);
        EXPECT_EQ(three.pairs(), (ObjectPairs{{0, 1}, {0, 2}, {1, 2}}));
        FilterBy refuse(false);
        three.cache().setOverlapFilterCallback(&refuse);
        hashOf(three).refilterAll(nullptr);
        EXPECT_EQ(three.pairs(), kNone);
        three.cache().setOverlapFilterCallback(nullptr);
        three.calculate();
        hashOf(three).refilterAll(nullptr);
        EXPECT_EQ(three.pairs(), (ObjectPairs{{1, 2}}));
        EXPECT_EQ(three.pairsAfterStep(), (ObjectPairs{{1, 2}}));
        EXPECT_EQ(hashOf(three).validate(), "");
    }
}

/// Of a kind that Bullet does not know, and takes the two whatever their masks.
struct OwnCache : btHashedOverlappingPairCache {
    bool needsBroadphaseCollision(Proxy* /*a*/, Proxy* /*b*/) const { return true; }
};

TEST_F(Filters, AreNotNeededByACacheThatDecidesItself) {
    Player two = hashPlayer(6, std::make_unique<OwnCache>());
    two.create(0, kHere, 1, 0);
    two.create(1, kBeside, 1, 0);
    two.calculate();
    EXPECT_EQ(hashOf(two).validate(), "");
    EXPECT_EQ(hashOf(two).lastCost().pairsWatched, 0U);
    two.set(0, kBeside);
    two.calculate();
    EXPECT_EQ(hashOf(two).lastCost().pairsWatched, 1U) << "the cache was asked";
}

}  // namespace
}  // namespace hashphase::test
