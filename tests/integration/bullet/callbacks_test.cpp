// SPDX-License-Identifier: Zlib

// Callbacks that create, move and destroy, which is where other broadphases crash.

#include <tests/integration/bullet/boxes.hpp>
#include <tests/integration/bullet/queries.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <stdexcept>

namespace hashphase::test {
namespace {

constexpr int kEager = btBroadphaseProxy::CharacterFilter;
constexpr int kStatic = btBroadphaseProxy::StaticFilter;
constexpr int kMoving = btBroadphaseProxy::DefaultFilter;

using ReportRay = ReportTo<btBroadphaseRayCallback>;
using ReportBox = ReportTo<btBroadphaseAabbCallback>;

/// Boxes in a small room, so that each query finds many.
struct Room : Boxes {
    explicit Room(int count) : Boxes(eagerCharactersAndSensors()) {
        for (int i = 0; i < count; ++i) {
            createAnywhere(i % 3 == 0 ? kStatic : kMoving);
        }
    }

    Box anywhere() {
        const btVector3 low = random.vector(-4, 4);
        return {low, low + btVector3(2, 2, 2)};
    }
    void createAnywhere(int group) {
        create(anywhere(), group, btBroadphaseProxy::AllFilter, this);
    }
    void remove(btBroadphaseProxy* proxy) {
        destroy(proxy);
        touched.insert(proxy);
    }
    void move(btBroadphaseProxy* proxy) {
        set(proxy, anywhere());
        touched.insert(proxy);
    }
    [[nodiscard]] bool isAlive(const btBroadphaseProxy* proxy) const {
        return std::find(proxies.begin(), proxies.end(), proxy) != proxies.end();
    }
    btBroadphaseProxy* any() {
        return proxies[std::size_t(random.below(static_cast<int>(proxies.size())))];
    }

    /// Both expect that whatever is there is found once, unless the callback moves or destroys it, and
    /// return how many others are.
    std::size_t castRay(ReportRay& callback) {
        const Box way{{0, 0, -10}, {0, 0, 10}};
        setFields(callback, {way.min, way.max});
        return expectTheOthersOnce(way, callback.found,
                                   [&] { broadphase.rayTest(way.min, way.max, callback); });
    }
    std::size_t lookAround(ReportBox& callback) {
        const Box place{{-3, -3, -3}, {3, 3, 3}};
        return expectTheOthersOnce(place, callback.found,
                                   [&] { broadphase.aabbTest(place.min, place.max, callback); });
    }

    /// Anything that a game may do.
    void change(btBroadphaseProxy* found) {
        EXPECT_TRUE(isAlive(found)) << "a destroyed proxy is reported";
        const btScalar choice = random.uniform(0, 1);
        if (choice < btScalar(0.4)) {
            remove(found);
        } else if (choice < btScalar(0.6) && proxies.size() > 1) {
            remove(any());
        } else if (choice < btScalar(0.8) && !proxies.empty()) {
            move(any());
        } else {
            createAnywhere(random.chance(0.5) ? kEager : kMoving);
        }
    }

    BulletRandom random{3};
    std::set<btBroadphaseProxy*> touched;  // moved or destroyed since a query began

private:
    template <class Query>
    std::size_t expectTheOthersOnce(const Box& place, const std::vector<btBroadphaseProxy*>& found,
                                    const Query& query) {
        std::vector<std::pair<btBroadphaseProxy*, bool>> expected;
        for (btBroadphaseProxy* proxy : proxies) {
            expected.emplace_back(proxy, overlap(boxOf(*proxy), place));
        }
        const std::set<btBroadphaseProxy*> touchedBefore = std::exchange(touched, {});
        query();
        std::size_t others = 0;
        for (const auto& [proxy, isThere] : expected) {
            if (!touched.contains(proxy)) {
                EXPECT_EQ(std::count(found.begin(), found.end(), proxy), isThere ? 1 : 0);
                others += isThere ? 1 : 0;
            }
        }
        touched.insert(touchedBefore.begin(), touchedBefore.end());
        return others;
    }
};

TEST(Callbacks, OfQueriesMayDestroyMoveAndCreate) {
    for (const int settled : {0, 1, 12}) {
        std::size_t othersOnRays = 0;
        std::size_t othersAround = 0;
        Room room(400);
        room.step(settled);
        for (int round = 0; round < 12; ++round) {
            ReportRay ray([&](btBroadphaseProxy* found) { room.change(found); });
            othersOnRays += room.castRay(ray);
            ReportBox box([&](btBroadphaseProxy* found) { room.change(found); });
            othersAround += room.lookAround(box);
            EXPECT_GT(ray.found.size(), 2U);
            EXPECT_GT(box.found.size(), 2U);
            if (round % 3 == 0) {
                room.check();
            }
            while (room.proxies.size() < 300) {
                room.createAnywhere(kMoving);
            }
        }
        room.check();
        EXPECT_GT(othersOnRays, 20U);
        EXPECT_GT(othersAround, 60U);
    }
}

// Destroys so much that it is not listed any more, which must not make the second query file.
TEST(Callbacks, OfQueriesMayAskAfterManyChanges) {
    for (const bool isRayOutside : {false, true}) {
        Room room(400);
        room.check();
        // Some stay where they are throughout.
        std::set<btBroadphaseProxy*> spared;
        for (std::size_t i = 0; i < 60; i += 2) {
            spared.insert(room.proxies[i]);
        }
        const auto lookAgain = [&](btBroadphaseProxy* found) {
            ASSERT_TRUE(room.isAlive(found)) << "a destroyed proxy is reported";
            for (int i = 0; i < 40 && room.proxies.size() > 60; ++i) {
                if (btBroadphaseProxy* const proxy = room.any(); !spared.contains(proxy)) {
                    room.remove(proxy);
                }
            }
            for (int i = 0; i < 20; ++i) {
                room.createAnywhere(kMoving);
            }
            ReportBox inner;
            const std::size_t all = room.lookAround(inner);
            EXPECT_EQ(inner.found.size(), all);
        };
        ReportRay ray(lookAgain);
        ReportBox box(lookAgain);
        const std::size_t others = isRayOutside ? room.castRay(ray) : room.lookAround(box);
        EXPECT_GT(others, isRayOutside ? 0U : 5U);
        EXPECT_GT(isRayOutside ? ray.found.size() : box.found.size(), 2U);
        room.check();
    }
}

// Now and then one of two that have begun to overlap goes, or another comes.
TEST(Callbacks, OfGhostsMayDestroyAndCreate) {
    Room room(200);
    PairJournal ghosts;
    ghosts.onBirth = [&](btBroadphaseProxy* a, btBroadphaseProxy* b) {
        EXPECT_TRUE(a->m_clientObject == &room && b->m_clientObject == &room);
        if (!room.isAlive(a) || !room.isAlive(b)) {
            return;  // it is being created, and the room does not know it yet
        }
        const std::size_t calls = ghosts.all.size();
        if (calls % 5 == 0) {
            room.remove(calls % 2 == 0 ? a : b);
        } else if (calls % 17 == 0) {
            room.createAnywhere(kEager);
        }
    };
    room.cache.setInternalGhostPairCallback(&ghosts);
    for (int step = 0; step < 5; ++step) {
        room.step();
        for (int i = 0; i < 30; ++i) {
            room.move(room.any());
            room.createAnywhere(kMoving);
        }
    }
    EXPECT_GT(ghosts.all.size(), 100U);
    room.cache.setInternalGhostPairCallback(nullptr);
    room.check();
}

TEST(Callbacks, OfProcessAllOverlappingPairsMayDestroyEitherProxy) {
    Room room(150);
    room.check();
    ProcessBy destroying([&](btBroadphasePair& pair) {
        EXPECT_TRUE(room.isAlive(pair.m_pProxy0) && room.isAlive(pair.m_pProxy1));
        if (room.random.chance(0.2)) {
            room.remove(room.random.chance(0.5) ? pair.m_pProxy0 : pair.m_pProxy1);
            return false;
        }
        return room.random.chance(0.1);
    });
    room.cache.processAllOverlappingPairs(&destroying, nullptr);
    EXPECT_GT(destroying.shown.size(), 20U);
    EXPECT_EQ(room.broadphase.grid().validate(), "");
    room.destroyAll();
    room.check();
}

TEST(Callbacks, OfProcessAllOverlappingPairsMayThrow) {
    ProcessBy throwing([](btBroadphasePair&) -> bool { throw std::runtime_error("no"); });
    PairCache cache(PairOrder::canonical);
    std::vector<btBroadphaseProxy> proxies(3,
                                           btBroadphaseProxy({0, 0, 0}, {1, 1, 1}, nullptr, 1, 1));
    for (int i = 0; i < 3; ++i) {
        proxies[std::size_t(i)].m_uniqueId = i;
    }
    cache.addAcceptedPair(&proxies[1], &proxies[2]);
    btDispatcherInfo info;
    for (const bool isDeterministic : {false, true}) {
        info.m_deterministicOverlappingPairs = isDeterministic;
        EXPECT_THROW(cache.processAllOverlappingPairs(&throwing, nullptr, info),
                     std::runtime_error);
    }
    // Were a call still counted as under way, the array would not be sorted.
    cache.addAcceptedPair(&proxies[1], &proxies[0]);
    EXPECT_EQ(cache.getOverlappingPairArrayPtr()->m_pProxy0, &proxies[0]);
}

TEST(Callbacks, ThatFailAgainWhileACreationIsUndoneGiveWayToTheFirstFailure) {
    Room room(150);
    room.check();
    PairJournal ghosts;
    ghosts.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) {
        if (ghosts.alive.size() == 2) {
            throw std::runtime_error("first");
        }
    };
    ghosts.onDeath = [](btBroadphaseProxy*, btBroadphaseProxy*) {
        throw std::runtime_error("second");
    };
    room.cache.setInternalGhostPairCallback(&ghosts);
    const Box box = room.anywhere();
    try {
        room.broadphase.createProxy(box.min, box.max, 0, nullptr, kEager,
                                    btBroadphaseProxy::AllFilter, nullptr);
        ADD_FAILURE() << "should have thrown";
    } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "first");
    }
    room.cache.setInternalGhostPairCallback(nullptr);
}

/// Notes which proxies a class that derives from the broadphase hears of.
struct DerivedBroadphase : SpatialHashBroadphase {
    using SpatialHashBroadphase::SpatialHashBroadphase;
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override {
        ++destroyed;
        SpatialHashBroadphase::destroyProxy(proxy, dispatcher);
    }
    int destroyed = 0;
};

TEST(Callbacks, ThatMakeACreationFailAreNotToldToADerivedClassAsAnEnd) {
    SpatialHashConfig config;
    config.eagerGroups = kEager;
    DerivedBroadphase broadphase(config);
    PairJournal ghosts;
    ghosts.onBirth = [](btBroadphaseProxy*, btBroadphaseProxy*) {
        throw std::runtime_error("birth");
    };
    broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&ghosts);
    const auto create = [&](int group) {
        return broadphase.createProxy({0, 0, 0}, {1, 1, 1}, 0, nullptr, group,
                                      btBroadphaseProxy::AllFilter, nullptr);
    };
    btBroadphaseProxy* const proxy = create(btBroadphaseProxy::DefaultFilter);
    EXPECT_THROW(create(kEager), std::runtime_error);
    EXPECT_EQ(broadphase.destroyed, 0);
    EXPECT_EQ(broadphase.grid().size(), 1U);
    broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
    broadphase.destroyProxy(proxy, nullptr);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(Callbacks, OfTheFilterMustChangeNothing) {
    std::function<void(btBroadphaseProxy&)> change;
    FilterBy filter([&](btBroadphaseProxy& a, btBroadphaseProxy&) {
        change(a);
        return true;
    });
    Room room(50);
    room.check();
    SpatialHashBroadphase& broadphase = room.broadphase;
    room.cache.setOverlapFilterCallback(&filter);
    for (int i = 0; i < 10; ++i) {
        room.createAnywhere(kMoving);  // of whose pairs the filter is to be asked
    }
    const ThrowingAsserts throwing;
    const int pairCount = room.pairCount();
    ASSERT_GT(pairCount, 5);
    for (const std::function<void(btBroadphaseProxy&)>& forbidden :
         std::vector<std::function<void(btBroadphaseProxy&)>>{
             [&](btBroadphaseProxy& proxy) { broadphase.destroyProxy(&proxy, nullptr); },
             [&](btBroadphaseProxy& proxy) {
                 btBroadphaseProxy* const one = &proxy;
                 broadphase.destroyProxies({&one, 1}, nullptr);
             },
             [&](btBroadphaseProxy& proxy) {
                 room.set(&proxy, {{90, 90, 90}, {91, 91, 91}});
             },
             [&](btBroadphaseProxy&) { room.createAnywhere(kMoving); },
             [&](btBroadphaseProxy& proxy) { broadphase.refilter(&proxy, nullptr); },
             [&](btBroadphaseProxy&) { room.step(); }}) {
        change = forbidden;
        EXPECT_THROW(room.step(), BrokenAssert);
        EXPECT_EQ(room.pairCount(), pairCount);
    }
    change = [&](btBroadphaseProxy&) {
        ReportBox box;
        room.lookAround(box);
        EXPECT_GT(box.found.size(), 5U) << "but may ask";
    };
    room.check();
    room.cache.setOverlapFilterCallback(nullptr);
    room.check();
}

TEST(Callbacks, MustNotCalculateOverlappingPairs) {
    Room room(50);
    const ThrowingAsserts throwing;
    PairJournal ghosts;
    ghosts.onBirth = [&](btBroadphaseProxy*, btBroadphaseProxy*) { room.step(); };
    ReportBox box([&](btBroadphaseProxy*) { room.step(); });
    EXPECT_THROW(room.lookAround(box), BrokenAssert);
    room.cache.setInternalGhostPairCallback(&ghosts);
    EXPECT_THROW(room.step(), BrokenAssert);
    room.cache.setInternalGhostPairCallback(nullptr);
    room.check();
}
#endif

}  // namespace
}  // namespace hashphase::test
