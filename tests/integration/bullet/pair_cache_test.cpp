// SPDX-License-Identifier: Zlib
#include <integration/bullet/pair_cache.hpp>

#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace hashphase {
namespace {

using IdPair = std::pair<int, int>;

struct Proxies {
    explicit Proxies(int count, int firstId = 1, int idStep = 1) {
        for (int i = 0; i < count; ++i) {
            owned.push_back(std::make_unique<btBroadphaseProxy>());
            owned.back()->m_uniqueId = firstId + idStep * i;
            owned.back()->m_collisionFilterGroup = btBroadphaseProxy::DefaultFilter;
            owned.back()->m_collisionFilterMask = btBroadphaseProxy::AllFilter;
        }
    }
    btBroadphaseProxy* operator[](std::size_t i) const { return owned[i].get(); }
    [[nodiscard]] std::size_t size() const { return owned.size(); }

    std::vector<std::unique_ptr<btBroadphaseProxy>> owned;
};

IdPair idsOf(const btBroadphasePair& pair) {
    return std::minmax({pair.m_pProxy0->m_uniqueId, pair.m_pProxy1->m_uniqueId});
}

/// As listed by the array, in its order.
std::vector<IdPair> listOf(btOverlappingPairCache& cache) {
    std::vector<IdPair> list;
    for (int i = 0; i < cache.getNumOverlappingPairs(); ++i) {
        list.push_back(idsOf(cache.getOverlappingPairArrayPtr()[i]));
    }
    return list;
}

std::vector<IdPair> sortedListOf(btOverlappingPairCache& cache) {
    std::vector<IdPair> list = listOf(cache);
    std::sort(list.begin(), list.end());
    return list;
}

struct Callback : btOverlapCallback {
    explicit Callback(std::function<bool(btBroadphasePair&)> f) : function(std::move(f)) {}
    bool processOverlap(btBroadphasePair& pair) override { return function(pair); }
    std::function<bool(btBroadphasePair&)> function;
};

/// An algorithm that does nothing but count those alive.
struct IdleAlgorithm : btCollisionAlgorithm {
    explicit IdleAlgorithm(int& count) : aliveCount(count) { ++aliveCount; }
    ~IdleAlgorithm() override { --aliveCount; }
    void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                          const btDispatcherInfo&, btManifoldResult*) override {}
    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray&) override {}
    int& aliveCount;
};

struct Dispatch {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    int aliveCount = 0;

    void giveAlgorithm(btBroadphasePair& pair) {
        void* memory = dispatcher.allocateCollisionAlgorithm(sizeof(IdleAlgorithm));
        pair.m_algorithm = new (memory) IdleAlgorithm(aliveCount);
    }
};

/// Every proxy with the next three.
void addBand(btOverlappingPairCache& cache, const Proxies& proxies) {
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        for (std::size_t j = i + 1; j < std::min(i + 4, proxies.size()); ++j) {
            cache.addOverlappingPair(proxies[i], proxies[j]);
        }
    }
}

bool isTouching(const IdPair& pair, int id) {
    return pair.first == id || pair.second == id;
}

// --- The set of pairs ----------------------------------------------------------------------------

TEST(PairCache, HoldsTheSamePairsAsBulletsCacheOverRandomOperations) {
    Proxies proxies(60, 0, 30'000'000);
    PairCache cache;
    PairCache canonical(PairOrder::canonical);
    btHashedOverlappingPairCache expected;
    int spareId = 2'147'483'647;
    std::mt19937 random(11);
    for (int i = 0; i < 100'000; ++i) {
        btBroadphaseProxy* a = proxies[random() % proxies.size()];
        btBroadphaseProxy* b = proxies[random() % proxies.size()];
        const auto action = random() % 100;
        if (action == 0) {
            // Destroyed, and another one created with an id that another one had before.
            cache.removeOverlappingPairsContainingProxy(a, nullptr);
            canonical.removeOverlappingPairsContainingProxy(a, nullptr);
            expected.removeOverlappingPairsContainingProxy(a, nullptr);
            std::swap(a->m_uniqueId, spareId);
        } else if (a == b) {
            continue;
        } else if (action < 55) {
            cache.addOverlappingPair(a, b);
            canonical.addOverlappingPair(a, b);
            expected.addOverlappingPair(a, b);
        } else if (action < 95) {
            cache.removeOverlappingPair(a, b, nullptr);
            canonical.removeOverlappingPair(a, b, nullptr);
            expected.removeOverlappingPair(a, b, nullptr);
        }
        ASSERT_EQ(cache.findPair(b, a) != nullptr, expected.findPair(b, a) != nullptr);
        if (i % 500 == 0) {
            ASSERT_EQ(cache.validate(), "") << i;
            ASSERT_EQ(listOf(cache), listOf(expected)) << "in the same order, too, " << i;
            ASSERT_EQ(listOf(canonical), sortedListOf(expected)) << i;
            ASSERT_EQ(canonical.validate(), "") << i;
        }
    }
    EXPECT_GT(cache.getNumOverlappingPairs(), 300);
}

TEST(PairCache, ReturnsThePairItHasAndItsUserDataWhenRemoved) {
    Proxies proxies(2);
    PairCache cache;
    int data = 0;
    EXPECT_EQ(cache.getOverlappingPairArrayPtr(), nullptr);
    EXPECT_EQ(cache.removeOverlappingPair(proxies[0], proxies[1], nullptr), nullptr);
    btBroadphasePair* pair = cache.addOverlappingPair(proxies[1], proxies[0]);
    ASSERT_NE(pair, nullptr);
    EXPECT_EQ(pair->m_pProxy0, proxies[0]) << "oriented by unique id, as in Bullet";
    pair->m_internalInfo1 = &data;
    EXPECT_EQ(cache.addOverlappingPair(proxies[0], proxies[1]), pair);
    EXPECT_EQ(cache.findPair(proxies[0], proxies[1]), pair);
    EXPECT_EQ(cache.getOverlappingPairArrayPtr(), pair);
    EXPECT_EQ(std::as_const(cache).getOverlappingPairArrayPtr(), pair);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
    EXPECT_EQ(cache.removeOverlappingPair(proxies[1], proxies[0], nullptr), &data);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
    EXPECT_FALSE(cache.hasDeferredRemoval());
}

TEST(PairCache, LetsTheFilterCallbackDecideAndElseGroupAndMaskBothWays) {
    struct OddOnly : btOverlapFilterCallback {
        bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
            return (a->m_uniqueId + b->m_uniqueId) % 2 == 1;
        }
    } oddOnly;
    Proxies proxies(3);
    proxies[2]->m_collisionFilterGroup = btBroadphaseProxy::StaticFilter;
    proxies[2]->m_collisionFilterMask = btBroadphaseProxy::DefaultFilter;
    PairCache cache;
    EXPECT_NE(cache.addOverlappingPair(proxies[0], proxies[2]), nullptr);
    proxies[1]->m_collisionFilterMask = btBroadphaseProxy::DefaultFilter;
    EXPECT_EQ(cache.addOverlappingPair(proxies[1], proxies[2]), nullptr) << "one way is not enough";
    EXPECT_EQ(cache.addOverlappingPair(proxies[2], proxies[1]), nullptr);

    cache.setOverlapFilterCallback(&oddOnly);
    EXPECT_EQ(cache.getOverlapFilterCallback(), &oddOnly);
    EXPECT_NE(cache.addOverlappingPair(proxies[1], proxies[2]), nullptr);
    EXPECT_NE(cache.findPair(proxies[0], proxies[2]), nullptr) << "pairs there are are not asked";
    proxies[0]->m_uniqueId = 8;
    EXPECT_EQ(cache.addOverlappingPair(proxies[0], proxies[1]), nullptr);
    EXPECT_NE(cache.addAcceptedPair(proxies[0], proxies[1]), nullptr) << "does not ask";
}

// --- The pairs of one proxy ----------------------------------------------------------------------

TEST(PairCache, RemovesOnlyThePairsOfTheProxy) {
    Proxies proxies(100);
    PairCache cache;
    addBand(cache, proxies);
    std::vector<IdPair> expected = sortedListOf(cache);
    for (int id : {50, 51, 1, 100, 50}) {
        cache.removeOverlappingPairsContainingProxy(proxies[std::size_t(id) - 1], nullptr);
        std::erase_if(expected, [=](const IdPair& pair) { return isTouching(pair, id); });
        EXPECT_EQ(sortedListOf(cache), expected);
        EXPECT_EQ(cache.validate(), "");
    }
    // Pairs made later are found as well.
    cache.addOverlappingPair(proxies[49], proxies[10]);
    cache.addOverlappingPair(proxies[10], proxies[90]);
    cache.removeOverlappingPair(proxies[2], proxies[3], nullptr);
    cache.removeOverlappingPairsContainingProxy(proxies[10], nullptr);
    std::erase_if(expected, [](const IdPair& pair) {
        return isTouching(pair, 11) || pair == IdPair{3, 4};
    });
    EXPECT_EQ(sortedListOf(cache), expected);
}

TEST(PairCache, RemovesAProxyInWorkProportionalToItsPairs) {
    Proxies proxies(50'000);
    PairCache cache;
    addBand(cache, proxies);
    for (std::size_t i = 0; i < 1000; ++i) {
        btBroadphaseProxy* proxy = proxies[7 + 37 * i];
        const int before = cache.getNumOverlappingPairs();
        const std::uint64_t visitedBefore = cache.pairsVisited();
        cache.cleanProxyFromPairs(proxy, nullptr);
        cache.removeOverlappingPairsContainingProxy(proxy, nullptr);
        ASSERT_EQ(before - cache.getNumOverlappingPairs(), 6);
        ASSERT_EQ(cache.pairsVisited() - visitedBefore, 2 * 6U);
    }
    EXPECT_EQ(cache.validate(), "");
}

TEST(PairCache, FreesTheAlgorithmsOfThatProxyOnly) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        Dispatch dispatch;
        Proxies proxies(30);
        PairCache cache(order);
        addBand(cache, proxies);
        const int count = cache.getNumOverlappingPairs();
        for (int i = 0; i < count; ++i) {
            dispatch.giveAlgorithm(cache.getOverlappingPairArray()[i]);
        }
        cache.cleanProxyFromPairs(proxies[15], nullptr);
        EXPECT_EQ(dispatch.aliveCount, count) << "without a dispatcher nothing is freed";

        cache.cleanProxyFromPairs(proxies[15], &dispatch.dispatcher);
        EXPECT_EQ(dispatch.aliveCount, count - 6);
        EXPECT_EQ(cache.getNumOverlappingPairs(), count) << "the pairs stay";
        for (int i = 0; i < count; ++i) {
            const btBroadphasePair& pair = cache.getOverlappingPairArray()[i];
            EXPECT_EQ(pair.m_algorithm == nullptr, isTouching(idsOf(pair), 16));
        }

        cache.removeOverlappingPair(proxies[0], proxies[1], &dispatch.dispatcher);
        cache.getOverlappingPairArray();
        EXPECT_EQ(dispatch.aliveCount, count - 7);
        cache.removeOverlappingPair(proxies[0], proxies[2], &dispatch.dispatcher);
        cache.cleanProxyFromPairs(proxies[0], &dispatch.dispatcher);
        EXPECT_EQ(dispatch.aliveCount, count - 9) << "before the proxy can go";
        for (std::size_t i = 0; i < proxies.size(); ++i) {
            cache.removeOverlappingPairsContainingProxy(proxies[i], &dispatch.dispatcher);
        }
        EXPECT_EQ(dispatch.aliveCount, 0);
        EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
    }
}

// --- Looking at all pairs ------------------------------------------------------------------------

TEST(PairCache, ShowsEveryPairOnceAndRemovesThoseTheCallbackSays) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        for (const bool isDeterministic : {false, true}) {
            Proxies proxies(200);
            PairCache cache(order);
            addBand(cache, proxies);
            std::vector<IdPair> before = sortedListOf(cache);
            std::vector<IdPair> shown;
            Callback removeSome([&](btBroadphasePair& pair) {
                shown.push_back(idsOf(pair));
                return (pair.m_pProxy0->m_uniqueId + pair.m_pProxy1->m_uniqueId) % 3 != 0;
            });
            btDispatcherInfo info;
            info.m_deterministicOverlappingPairs = isDeterministic;
            cache.processAllOverlappingPairs(&removeSome, nullptr, info);
            std::sort(shown.begin(), shown.end());
            EXPECT_EQ(shown, before);
            std::erase_if(before, [](const IdPair& p) { return (p.first + p.second) % 3 != 0; });
            EXPECT_EQ(sortedListOf(cache), before);
            EXPECT_FALSE(before.empty());
            EXPECT_EQ(cache.validate(), "");
        }
    }
}

TEST(PairCache, DispatchesInTheOrderOfBulletsCacheWhenAskedToBeDeterministic) {
    Proxies proxies(300);
    PairCache cache;
    btHashedOverlappingPairCache bullet;
    const std::vector<btOverlappingPairCache*> caches{&cache, &bullet};
    for (std::size_t i = 0; i < 1000; ++i) {
        for (std::size_t c = 0; c < 2; ++c) {
            const std::size_t turn = c == 0 ? i : 999 - i;
            btBroadphaseProxy* a = proxies[turn * 7 % 300];
            btBroadphaseProxy* b = proxies[turn * 31 / 7 % 300];
            if (a != b) {
                caches[c]->addOverlappingPair(a, b);
            }
        }
    }
    btDispatcherInfo info;
    info.m_deterministicOverlappingPairs = true;
    std::vector<std::vector<IdPair>> shown(2);
    for (std::size_t i = 0; i < 2; ++i) {
        Callback note([&](btBroadphasePair& pair) {
            shown[i].emplace_back(pair.m_pProxy0->m_uniqueId, pair.m_pProxy1->m_uniqueId);
            return false;
        });
        caches[i]->processAllOverlappingPairs(&note, nullptr, info);
    }
    EXPECT_EQ(shown[0], shown[1]);
    EXPECT_GT(shown[0].size(), 500U);
}

TEST(PairCache, ToleratesChangesByTheCallback) {
    Proxies proxies(400);
    PairCache cache;
    for (std::size_t i = 0; i < 10; ++i) {
        cache.addOverlappingPair(proxies[i], proxies[i + 1]);
    }
    // Every pair of the first hundred brings another one, far beyond the array's first capacity.
    std::vector<IdPair> shown;
    Callback addAnother([&](btBroadphasePair& pair) {
        const auto next = static_cast<std::size_t>(pair.m_pProxy1->m_uniqueId);
        shown.push_back(idsOf(pair));
        if (shown.size() <= 300) {
            cache.addOverlappingPair(proxies[next], proxies[next + 1]);
        }
        return shown.size() % 2 == 0;
    });
    cache.processAllOverlappingPairs(&addAnother, nullptr);
    EXPECT_EQ(std::set<IdPair>(shown.begin(), shown.end()).size(), shown.size());
    EXPECT_GT(shown.size(), 290U) << "what the callback adds is shown";
    EXPECT_EQ(cache.validate(), "");

    // Takes every pair out and puts it back, and says that it is to stay; or only takes it out.
    for (const bool isPutBack : {true, false}) {
        const auto count = static_cast<std::size_t>(cache.getNumOverlappingPairs());
        shown.clear();
        Callback takeOut([&](btBroadphasePair& pair) {
            btBroadphaseProxy* const a = pair.m_pProxy0;
            btBroadphaseProxy* const b = pair.m_pProxy1;
            shown.push_back(idsOf(pair));
            cache.removeOverlappingPair(a, b, nullptr);
            return isPutBack && cache.addOverlappingPair(a, b) == nullptr;
        });
        cache.processAllOverlappingPairs(&takeOut, nullptr);
        EXPECT_EQ(shown.size(), count);
        EXPECT_EQ(cache.getNumOverlappingPairs(), isPutBack ? static_cast<int>(count) : 0);
    }
}

// --- Order ---------------------------------------------------------------------------------------

int clientKey(const btBroadphaseProxy& proxy) {
    return *static_cast<int*>(proxy.m_clientObject);
}

TEST(PairCache, HasACanonicalOrderThatDependsOnlyOnTheSet) {
    Proxies proxies(80);
    std::vector<int> keys(proxies.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        keys[i] = static_cast<int>(i * 29 % 80 / 2) - 20;  // two of each, and negative ones
        proxies[i]->m_clientObject = &keys[i];
    }
    for (const ProxyKey key : {&PairCache::uniqueId, &clientKey}) {
        Dispatch dispatch;
        PairCache straight(PairOrder::canonical, key);
        PairCache winding(PairOrder::canonical, key);
        addBand(straight, proxies);
        std::mt19937 random(15);
        for (int i = 0; i < 5000; ++i) {
            btBroadphaseProxy* a = proxies[random() % proxies.size()];
            btBroadphaseProxy* b = proxies[random() % proxies.size()];
            if (a != b && random() % 2 == 0) {
                dispatch.giveAlgorithm(*winding.addOverlappingPair(a, b));
            } else if (a != b) {
                winding.removeOverlappingPair(a, b, &dispatch.dispatcher);
            }
            if (i % 100 == 0) {
                winding.removeOverlappingPairsContainingProxy(a, &dispatch.dispatcher);
                winding.getOverlappingPairArray();
            }
        }
        Callback removeFar([&](btBroadphasePair& pair) {
            return straight.findPair(pair.m_pProxy0, pair.m_pProxy1) == nullptr;
        });
        winding.processAllOverlappingPairs(&removeFar, &dispatch.dispatcher);
        addBand(winding, proxies);

        ASSERT_EQ(winding.getNumOverlappingPairs(), straight.getNumOverlappingPairs());
        const btBroadphasePairArray& a = straight.getOverlappingPairArray();
        const btBroadphasePairArray& b = winding.getOverlappingPairArray();
        for (int i = 0; i < a.size(); ++i) {
            EXPECT_EQ(a[i].m_pProxy0, b[i].m_pProxy0) << i;
            EXPECT_EQ(a[i].m_pProxy1, b[i].m_pProxy1) << i;
            EXPECT_LE(key(*a[i].m_pProxy0), key(*a[i].m_pProxy1));
            EXPECT_LE(key(*a[std::max(0, i - 1)].m_pProxy0), key(*a[i].m_pProxy0));
        }
        EXPECT_EQ(winding.validate(), "");
        Callback removeAll([](btBroadphasePair&) { return true; });
        winding.processAllOverlappingPairs(&removeAll, &dispatch.dispatcher);
    }
}

TEST(PairCache, KeepsAlgorithmsAndTellsNoGhostWhenSorting) {
    struct Counter : btOverlappingPairCallback {
        btBroadphasePair* addOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*) override {
            ++calls;
            return nullptr;
        }
        void* removeOverlappingPair(btBroadphaseProxy*, btBroadphaseProxy*,
                                    btDispatcher*) override {
            ++calls;
            return nullptr;
        }
        void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}
        int calls = 0;
    } ghosts;
    Proxies proxies(50);
    Dispatch dispatch;
    PairCache cache;
    std::vector<std::pair<IdPair, btCollisionAlgorithm*>> given;
    for (std::size_t i = 0; i < 49; ++i) {
        btBroadphasePair* pair = cache.addOverlappingPair(proxies[48 - i], proxies[49 - i]);
        dispatch.giveAlgorithm(*pair);
        given.emplace_back(idsOf(*pair), pair->m_algorithm);
    }
    EXPECT_EQ(listOf(cache).front(), IdPair(49, 50)) << "in the order of arrival";
    cache.setInternalGhostPairCallback(&ghosts);
    cache.sortOverlappingPairs(&dispatch.dispatcher);
    EXPECT_EQ(ghosts.calls, 0);
    EXPECT_EQ(listOf(cache), sortedListOf(cache));
    for (const auto& [ids, algorithm] : given) {
        const auto first = static_cast<std::size_t>(ids.first);
        EXPECT_EQ(cache.findPair(proxies[first - 1], proxies[first])->m_algorithm, algorithm);
    }
    Callback removeAll([](btBroadphasePair&) { return true; });
    cache.processAllOverlappingPairs(&removeAll, &dispatch.dispatcher);
    EXPECT_EQ(dispatch.aliveCount, 0);
    EXPECT_EQ(ghosts.calls, 49);
}

}  // namespace
}  // namespace hashphase
