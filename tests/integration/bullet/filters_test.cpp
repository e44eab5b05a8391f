// SPDX-License-Identifier: Zlib
//
// When the filter is asked, and what happens when its answer changes.

#include <tests/integration/bullet/broadphases.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace hashphase::test {
namespace {

using Proxy = btBroadphaseProxy;

const Box kHere = boxAround({0, 0, 0}, {1, 1, 1});
const Box kBeside = boxAround({1, 0, 0}, {1, 1, 1});
const Box kThere = boxAround({9, 0, 0}, {1, 1, 1});

/// Says what it was told to say, and counts how often it was asked.
struct CountingFilter : btOverlapFilterCallback {
    bool needBroadphaseCollision(Proxy* a, Proxy* b) const override {
        ++asked[std::minmax({objectOf(a), objectOf(b)})];
        return answer;
    }
    bool answer = true;
    mutable std::map<std::pair<int, int>, int> asked;
};

class Filters : public testing::Test {
protected:
    explicit Filters(std::unique_ptr<btOverlappingPairCache> cache = nullptr)
        : player(hashPlayer(6, std::move(cache), eagerCharactersAndSensors())) {}

    void create(int object, const Box& box) {
        player.play({Action::create, object, box, Proxy::DefaultFilter, Proxy::AllFilter});
    }
    void set(int object, const Box& box) { player.play({Action::set, object, box, 0, 0}); }
    void refilter(int object) { broadphase().refilter(player.proxy(object), nullptr); }
    SpatialHashBroadphase& broadphase() { return hashOf(player); }
    ObjectPairs pairs() const { return player.pairs(); }

    Player player;
    const ObjectPairs none{};
    const ObjectPairs both{{0, 1}};
};

TEST_F(Filters, AreAskedOnceForAPairThatLasts) {
    CountingFilter filter;
    player.cache().setOverlapFilterCallback(&filter);
    create(0, kHere);
    create(1, kBeside);
    create(2, kThere);
    for (int frame = 0; frame < 30; ++frame) {
        set(0, boxAround({btScalar(frame) / 100, 0, 0}, {1, 1, 1}));
        player.calculate();
        ASSERT_EQ(pairs(), both);
    }
    EXPECT_EQ(filter.asked, (std::map<std::pair<int, int>, int>{{{0, 1}, 1}}));
}

TEST_F(Filters, AreAskedAgainForARefusedPairOnlyWhenEitherMoves) {
    CountingFilter filter;
    filter.answer = false;
    player.cache().setOverlapFilterCallback(&filter);
    create(0, kHere);
    create(1, kBeside);
    player.calculate();
    EXPECT_EQ(filter.asked.at({0, 1}), 1);
    for (int frame = 0; frame < 30; ++frame) {  // long enough to come to rest
        player.calculate();
    }
    EXPECT_EQ(filter.asked.at({0, 1}), 1);
    set(1, kHere);
    player.calculate();
    EXPECT_EQ(filter.asked.at({0, 1}), 2);
    EXPECT_EQ(pairs(), none);
    filter.answer = true;
    set(0, kBeside);
    player.calculate();
    EXPECT_EQ(filter.asked.at({0, 1}), 3);
    EXPECT_EQ(pairs(), both);
}

TEST_F(Filters, LeaveAPairAloneUntilItSeparatesUnlessRefiltered) {
    create(0, kHere);
    create(1, kBeside);
    player.calculate();
    player.proxy(0)->m_collisionFilterMask = 0;
    set(0, kBeside);
    player.calculate();
    EXPECT_EQ(pairs(), both) << "As in all of Bullet's broadphases.";
    set(0, kThere);
    player.calculate();
    set(0, kHere);
    player.calculate();
    EXPECT_EQ(pairs(), none);
}

TEST_F(Filters, AreAskedAtOnceByRefilter) {
    create(0, kHere);
    create(1, kBeside);
    player.calculate();
    player.proxy(0)->m_collisionFilterMask = 0;
    refilter(0);
    EXPECT_EQ(pairs(), none);
    player.calculate();
    EXPECT_EQ(pairs(), none);
    player.proxy(0)->m_collisionFilterMask = Proxy::AllFilter;
    refilter(1);
    EXPECT_EQ(pairs(), both) << "Either of the two may be named.";
    player.calculate();
    EXPECT_EQ(pairs(), both);
    EXPECT_EQ(broadphase().validate(), "");
}

TEST_F(Filters, AreAskedByRefilterAboutProxiesAtRestToo) {
    create(0, kHere);
    create(1, kBeside);
    player.proxy(1)->m_collisionFilterMask = 0;
    for (int frame = 0; frame < 40; ++frame) {
        player.calculate();
    }
    EXPECT_EQ(pairs(), none);
    player.proxy(1)->m_collisionFilterMask = Proxy::AllFilter;
    refilter(0);
    EXPECT_EQ(pairs(), both);
    for (int frame = 0; frame < 40; ++frame) {
        player.calculate();
    }
    player.proxy(1)->m_collisionFilterMask = 0;
    refilter(1);
    EXPECT_EQ(pairs(), none);
    player.calculate();
    EXPECT_EQ(pairs(), none);
    EXPECT_EQ(broadphase().validate(), "");
}

TEST_F(Filters, AreAskedByRefilterAboutWhatBeganInThisStep) {
    create(0, kHere);
    create(1, kBeside);
    refilter(0);
    EXPECT_EQ(pairs(), both);
    player.proxy(1)->m_collisionFilterMask = 0;
    refilter(1);
    EXPECT_EQ(pairs(), none);
    player.calculate();
    EXPECT_EQ(pairs(), none);
}

// What separates and comes back within a step was together at both ends of it.
TEST_F(Filters, AreAskedByRefilterAboutPairsThatAreApartForTheMoment) {
    create(0, kHere);
    create(1, kBeside);
    player.calculate();
    set(0, kThere);
    player.proxy(0)->m_collisionFilterMask = 0;
    refilter(0);
    set(0, kHere);
    player.calculate();
    EXPECT_EQ(pairs(), none);
    EXPECT_EQ(broadphase().validate(), "");
}

TEST_F(Filters, AreAskedByRefilterAboutEagerPairsThatAreApartForTheMoment) {
    create(0, kHere);
    player.play({Action::create, 1, kThere, Proxy::SensorTrigger, Proxy::AllFilter});
    player.calculate();
    set(1, kHere);
    ASSERT_EQ(pairs(), both) << "Sensors have their pairs at once.";
    set(1, kThere);
    player.proxy(1)->m_collisionFilterMask = 0;
    refilter(1);
    set(1, kHere);
    player.calculate();
    EXPECT_EQ(pairs(), none);
    EXPECT_EQ(broadphase().validate(), "");
}

TEST_F(Filters, AskedByRefilterNeverNameADestroyedProxy) {
    create(0, kHere);
    create(1, kBeside);
    create(2, kHere);
    player.calculate();
    player.play({Action::destroy, 1, {}, 0, 0});
    refilter(0);
    EXPECT_EQ(pairs(), (ObjectPairs{{0, 2}}));
    player.calculate();
    EXPECT_EQ(pairs(), (ObjectPairs{{0, 2}}));
    EXPECT_EQ(broadphase().validate(), "");
}

class FiltersOverDeferredRemoval : public Filters {
protected:
    FiltersOverDeferredRemoval() : Filters(std::make_unique<btSortedOverlappingPairCache>()) {
        create(0, kHere);
        create(1, kBeside);
        create(2, kHere);
        player.calculate();
    }
    const ObjectPairs all{{0, 1}, {0, 2}, {1, 2}};
};

TEST_F(FiltersOverDeferredRemoval, AreObeyedAfterTheStep) {
    ASSERT_EQ(pairs(), all);
    player.proxy(2)->m_collisionFilterMask = 0;
    refilter(2);
    player.calculate();
    EXPECT_EQ(pairs(), both);
    player.proxy(2)->m_collisionFilterMask = Proxy::AllFilter;
    refilter(2);
    player.calculate();
    EXPECT_EQ(pairs(), all);
}

TEST_F(FiltersOverDeferredRemoval, LeavePairsAloneThatAreApartForTheMoment) {
    ASSERT_EQ(pairs(), all);
    set(0, kThere);
    refilter(2);
    set(0, kHere);
    player.calculate();
    EXPECT_EQ(pairs(), all);
}

}  // namespace
}  // namespace hashphase::test
