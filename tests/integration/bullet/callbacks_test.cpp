// SPDX-License-Identifier: Zlib

// Callbacks that create, move and destroy, which is where other broadphases crash.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/integration/bullet/broadphases.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/random.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

constexpr int kEager = btBroadphaseProxy::CharacterFilter;
constexpr int kStatic = btBroadphaseProxy::StaticFilter;
constexpr int kMoving = btBroadphaseProxy::DefaultFilter;

using Change = std::function<void(btBroadphaseProxy*)>;

/// Calls the change for whatever a query finds, and notes it.
template <class Callback>
struct Changing : Callback {
    explicit Changing(Change calledWith) : change(std::move(calledWith)) {}
    bool process(const btBroadphaseProxy* proxy) override {
        found.push_back(const_cast<btBroadphaseProxy*>(proxy));
        change(found.back());
        return true;
    }
    Change change;
    std::vector<btBroadphaseProxy*> found;
};
using ChangingRay = Changing<btBroadphaseRayCallback>;
using ChangingBox = Changing<btBroadphaseAabbCallback>;

/// Boxes in a small room, so that each query finds many, and what is known of those alive.
class Room {
public:
    explicit Room(int count) {
        for (int i = 0; i < count; ++i) {
            create(i % 3 == 0 ? kStatic : kMoving);
        }
    }
    ~Room() {
        broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
        while (!alive.empty()) {
            destroy(alive.back());
        }
    }
    Room(const Room&) = delete;
    Room& operator=(const Room&) = delete;

    btBroadphaseProxy* create(int group) {
        const auto [low, high] = box();
        btBroadphaseProxy* proxy = broadphase.createProxy(low, high, 0, this, group,
                                                          btBroadphaseProxy::AllFilter, nullptr);
        alive.push_back(proxy);
        return proxy;
    }
    void destroy(btBroadphaseProxy* proxy) {
        broadphase.destroyProxy(proxy, nullptr);
        std::erase(alive, proxy);
        touched.insert(proxy);
    }
    void move(btBroadphaseProxy* proxy) {
        const auto [low, high] = box();
        broadphase.setAabb(proxy, low, high, nullptr);
        touched.insert(proxy);
    }
    [[nodiscard]] bool isAlive(const btBroadphaseProxy* proxy) const {
        return std::find(alive.begin(), alive.end(), proxy) != alive.end();
    }
    btBroadphaseProxy* any() {
        return alive[random.below(static_cast<std::uint32_t>(alive.size()))];
    }
    std::pair<btVector3, btVector3> box() {
        const Vector3<double> low = random.pointIn(-4, 4);
        const btVector3 from(btScalar(low.x()), btScalar(low.y()), btScalar(low.z()));
        return {from, from + btVector3(2, 2, 2)};
    }

    /// Both expect that whoever is there is found once, unless the callback moves or destroys it,
    /// and return how many others are.
    std::size_t castRay(ChangingRay& callback) {
        callback.m_rayDirectionInverse = btVector3(BT_LARGE_FLOAT, BT_LARGE_FLOAT, 1);
        callback.m_signs[0] = callback.m_signs[1] = callback.m_signs[2] = 0;
        callback.m_lambda_max = 20;
        const btVector3 from(0, 0, -10);
        const btVector3 to(0, 0, 10);
        return expectTheOthersOnce(toAabb(from, to), callback,
                                   [&] { broadphase.rayTest(from, to, callback); });
    }
    std::size_t lookAround(ChangingBox& callback) {
        const btVector3 low(-3, -3, -3);
        const btVector3 high(3, 3, 3);
        return expectTheOthersOnce(toAabb(low, high), callback,
                                   [&] { broadphase.aabbTest(low, high, callback); });
    }

    /// Anything that a game may do.
    void change(btBroadphaseProxy* found) {
        EXPECT_TRUE(isAlive(found)) << "who was destroyed is reported";
        const double choice = random.unit();
        if (choice < 0.4) {
            destroy(found);
        } else if (choice < 0.6 && alive.size() > 1) {
            destroy(any());
        } else if (choice < 0.8 && !alive.empty()) {
            move(any());
        } else {
            create(random.chance(0.5) ? kEager : kMoving);
        }
    }

    /// After a step, the cache has the pairs that brute force finds, and all is in order.
    void check() {
        broadphase.calculateOverlappingPairs(nullptr);
        EXPECT_EQ(broadphase.validate(), "");
        std::set<std::pair<btBroadphaseProxy*, btBroadphaseProxy*>> expected;
        for (btBroadphaseProxy* a : alive) {
            for (btBroadphaseProxy* b : alive) {
                if (a->m_uniqueId < b->m_uniqueId && overlaps(toAabb(a->m_aabbMin, a->m_aabbMax),
                                                              toAabb(b->m_aabbMin, b->m_aabbMax))) {
                    expected.emplace(a, b);
                }
            }
        }
        const btBroadphasePairArray& pairs =
            broadphase.getOverlappingPairCache()->getOverlappingPairArray();
        EXPECT_EQ(static_cast<std::size_t>(pairs.size()), expected.size());
        for (int i = 0; i < pairs.size(); ++i) {
            EXPECT_EQ(expected.count({pairs[i].m_pProxy0, pairs[i].m_pProxy1}), 1U);
        }
    }

    Random random{3};
    SpatialHashBroadphase broadphase{eagerCharactersAndSensors()};
    std::vector<btBroadphaseProxy*> alive;  // in the order of creation
    std::set<btBroadphaseProxy*> touched;   // moved or destroyed since a query began

private:
    template <class Callback, class Query>
    std::size_t expectTheOthersOnce(const Aabb<btScalar>& place, const Callback& callback,
                                    const Query& query) {
        std::vector<std::pair<btBroadphaseProxy*, bool>> expected;
        for (btBroadphaseProxy* proxy : alive) {
            expected.emplace_back(proxy,
                                  overlaps(toAabb(proxy->m_aabbMin, proxy->m_aabbMax), place));
        }
        const std::set<btBroadphaseProxy*> touchedBefore = std::exchange(touched, {});
        query();
        std::size_t others = 0;
        for (const auto& [proxy, isThere] : expected) {
            if (!touched.contains(proxy)) {
                EXPECT_EQ(std::count(callback.found.begin(), callback.found.end(), proxy),
                          isThere ? 1 : 0);
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
        for (int step = 0; step < settled; ++step) {
            room.broadphase.calculateOverlappingPairs(nullptr);
        }
        for (int round = 0; round < 12; ++round) {
            ChangingRay ray([&](btBroadphaseProxy* found) { room.change(found); });
            othersOnRays += room.castRay(ray);
            ChangingBox box([&](btBroadphaseProxy* found) { room.change(found); });
            othersAround += room.lookAround(box);
            EXPECT_GT(ray.found.size(), 2U);
            EXPECT_GT(box.found.size(), 2U);
            if (round % 3 == 0) {
                room.check();
            }
            while (room.alive.size() < 300) {
                room.create(kMoving);
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
            spared.insert(room.alive[i]);
        }
        const auto lookAgain = [&](btBroadphaseProxy* found) {
            ASSERT_TRUE(room.isAlive(found)) << "who was destroyed is reported";
            for (int i = 0; i < 40 && room.alive.size() > 60; ++i) {
                btBroadphaseProxy* const proxy = room.any();
                if (!spared.contains(proxy)) {
                    room.destroy(proxy);
                }
            }
            for (int i = 0; i < 20; ++i) {
                room.create(kMoving);
            }
            ChangingBox inner([](btBroadphaseProxy*) {});
            const std::size_t all = room.lookAround(inner);
            EXPECT_EQ(inner.found.size(), all);
        };
        ChangingRay ray(lookAgain);
        ChangingBox box(lookAgain);
        const std::size_t others = isRayOutside ? room.castRay(ray) : room.lookAround(box);
        EXPECT_GT(others, isRayOutside ? 0U : 5U);
        EXPECT_GT(isRayOutside ? ray.found.size() : box.found.size(), 2U);
        room.check();
    }
}

/// A ghost callback that destroys one of two that have begun to overlap, now and then, or creates.
struct ChangingGhosts : btOverlappingPairCallback {
    explicit ChangingGhosts(Room& changed) : room(changed) {}
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        EXPECT_TRUE(a->m_clientObject == &room && b->m_clientObject == &room);
        if (!room.isAlive(a) || !room.isAlive(b)) {
            return nullptr;  // it is being created, and nobody knows it yet
        }
        if (++calls % 5 == 0) {
            room.destroy(calls % 2 == 0 ? a : b);
        } else if (calls % 17 == 0) {
            room.create(kEager);
        }
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*, btDispatcher*) override {
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}
    Room& room;
    int calls = 0;
};

TEST(Callbacks, OfGhostsMayDestroyAndCreate) {
    Room room(200);
    ChangingGhosts ghosts(room);
    room.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&ghosts);
    for (int step = 0; step < 5; ++step) {
        room.broadphase.calculateOverlappingPairs(nullptr);
        for (int i = 0; i < 30; ++i) {
            room.move(room.any());
            room.create(kMoving);
        }
    }
    EXPECT_GT(ghosts.calls, 100);
    room.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
    room.check();
}

TEST(Callbacks, OfProcessAllOverlappingPairsMayDestroyEitherProxy) {
    struct Destroying : btOverlapCallback {
        explicit Destroying(Room& changed) : room(changed) {}
        bool processOverlap(btBroadphasePair& pair) override {
            EXPECT_TRUE(room.isAlive(pair.m_pProxy0) && room.isAlive(pair.m_pProxy1));
            ++calls;
            if (room.random.chance(0.2)) {
                room.destroy(room.random.chance(0.5) ? pair.m_pProxy0 : pair.m_pProxy1);
                return false;
            }
            return room.random.chance(0.1);
        }
        Room& room;
        int calls = 0;
    };
    Room room(150);
    room.check();
    Destroying destroying(room);
    room.broadphase.getOverlappingPairCache()->processAllOverlappingPairs(&destroying, nullptr);
    EXPECT_GT(destroying.calls, 20);
    std::string fault = room.broadphase.grid().validate();
    EXPECT_EQ(fault, "");
    while (!room.alive.empty()) {
        room.destroy(room.alive.back());
    }
    room.broadphase.calculateOverlappingPairs(nullptr);
    EXPECT_EQ(room.broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), 0);
}

TEST(Callbacks, OfProcessAllOverlappingPairsMayThrow) {
    struct Throwing : btOverlapCallback {
        bool processOverlap(btBroadphasePair&) override { throw std::runtime_error("no"); }
    };
    Room room(60);
    room.check();
    PairCache cache(PairOrder::canonical);
    btBroadphaseProxy a({0, 0, 0}, {1, 1, 1}, nullptr, 1, 1);
    btBroadphaseProxy b = a;
    a.m_uniqueId = 1;
    b.m_uniqueId = 2;
    cache.addAcceptedPair(&a, &b);
    Throwing throwing;
    btDispatcherInfo info;
    for (const bool isDeterministic : {false, true}) {
        info.m_deterministicOverlappingPairs = isDeterministic;
        EXPECT_THROW(cache.processAllOverlappingPairs(&throwing, nullptr, info),
                     std::runtime_error);
    }
    // Were a call still counted as under way, the array would not be sorted.
    btBroadphaseProxy c = a;
    c.m_uniqueId = 0;
    cache.addAcceptedPair(&a, &c);
    EXPECT_EQ(cache.getOverlappingPairArrayPtr()->m_pProxy0, &c);
}

#if HASHPHASE_ENABLE_ASSERTS
TEST(Callbacks, OfTheFilterMustChangeNothing) {
    struct Filter : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy*) const override {
            change(a);
            return true;
        }
        Change change;
    };
    Room room(50);
    room.check();
    Filter filter;
    room.broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&filter);
    for (int i = 0; i < 10; ++i) {
        room.create(kMoving);  // of whose pairs the filter is to be asked
    }
    const ThrowingAsserts throwing;
    const int pairCount = room.broadphase.getOverlappingPairCache()->getNumOverlappingPairs();
    ASSERT_GT(pairCount, 5);
    const std::vector<Change> changes{
        [&](btBroadphaseProxy* proxy) { room.broadphase.destroyProxy(proxy, nullptr); },
        [&](btBroadphaseProxy* proxy) {
            room.broadphase.destroyProxies({&proxy, 1}, nullptr);
        },
        [&](btBroadphaseProxy* proxy) {
            room.broadphase.setAabb(proxy, {90, 90, 90}, {91, 91, 91}, nullptr);
        },
        [&](btBroadphaseProxy*) { room.create(kMoving); },
        [&](btBroadphaseProxy* proxy) { room.broadphase.refilter(proxy, nullptr); },
        [&](btBroadphaseProxy*) { room.broadphase.calculateOverlappingPairs(nullptr); },
    };
    for (const Change& change : changes) {
        filter.change = change;
        EXPECT_THROW(room.broadphase.calculateOverlappingPairs(nullptr), BrokenAssert);
        EXPECT_EQ(room.broadphase.getOverlappingPairCache()->getNumOverlappingPairs(), pairCount);
    }
    filter.change = [&](btBroadphaseProxy*) {
        ChangingBox box([](btBroadphaseProxy*) {});
        room.lookAround(box);
        EXPECT_GT(box.found.size(), 5U) << "but may ask";
    };
    room.check();
    room.broadphase.getOverlappingPairCache()->setOverlapFilterCallback(nullptr);
    room.check();
}

TEST(Callbacks, MustNotCalculateOverlappingPairs) {
    struct Calculating : ChangingGhosts {
        using ChangingGhosts::ChangingGhosts;
        btBroadphasePair* addOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*) override {
            room.broadphase.calculateOverlappingPairs(nullptr);
            return nullptr;
        }
    };
    Room room(50);
    const ThrowingAsserts throwing;
    Calculating ghosts(room);
    ChangingBox box(
        [&](btBroadphaseProxy*) { room.broadphase.calculateOverlappingPairs(nullptr); });
    EXPECT_THROW(room.lookAround(box), BrokenAssert);
    room.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(&ghosts);
    EXPECT_THROW(room.broadphase.calculateOverlappingPairs(nullptr), BrokenAssert);
    room.broadphase.getOverlappingPairCache()->setInternalGhostPairCallback(nullptr);
    room.check();
}
#endif

}  // namespace
}  // namespace hashphase::test
