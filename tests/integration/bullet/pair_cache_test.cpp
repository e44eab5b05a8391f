// SPDX-License-Identifier: Zlib
//
// The pair cache in single calls; what any of them do to the set is asked by random operations.

#include <tests/integration/bullet/cache_side.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {
namespace {

// --- The set of pairs ----------------------------------------------------------------------------

TEST(PairCache, HoldsTheSamePairsInTheSameOrderAsBulletsCache) {
    CacheSide side;
    for (std::size_t i = 0; i < CacheSide::kProxies; ++i) {
        side.proxies[i].m_uniqueId = 15'000'000 * int(i);
    }
    PairCache canonical(PairOrder::canonical);
    btHashedOverlappingPairCache expected;
    const std::array<btOverlappingPairCache*, 3> caches{&side.cache, &canonical, &expected};
    int spareId = 2'147'483'647;
    std::mt19937 random(11);
    for (int i = 0; i < 100'000; ++i) {
        btBroadphaseProxy* const a = side.proxy(int(random() % 60));
        btBroadphaseProxy* const b = side.proxy(int(random() % 60));
        const auto action = random() % 100;
        for (btOverlappingPairCache* const cache : caches) {
            if (action == 0) {
                cache->removeOverlappingPairsContainingProxy(a, nullptr);
            } else if (action < 55 && a != b) {
                cache->addOverlappingPair(a, b);
            } else if (action < 95 && a != b) {
                cache->removeOverlappingPair(a, b, nullptr);
            }
        }
        if (action == 0) {  // destroyed, and one created with an id that another had before
            std::swap(a->m_uniqueId, spareId);
        }
        if (a != b) {
            ASSERT_EQ(side.cache.findPair(b, a) != nullptr, expected.findPair(b, a) != nullptr);
        }
        if (i % 500 == 0) {
            ASSERT_EQ(side.cache.validate() + canonical.validate(), "") << i;
            ASSERT_EQ(side.list(), uidList(expected)) << "in the same order, too, " << i;
            ASSERT_EQ(uidList(canonical), inOrder(uidList(expected))) << i;
        }
    }
    EXPECT_GT(side.cache.getNumOverlappingPairs(), 300);
}

TEST(PairCache, ReturnsThePairItHasAndItsUserDataWhenRemoved) {
    CacheSide side;
    PairCache& cache = side.cache;
    int data = 0;
    EXPECT_EQ(cache.getOverlappingPairArrayPtr(), nullptr);
    EXPECT_EQ(cache.removeOverlappingPair(side.proxy(0), side.proxy(1), nullptr), nullptr);
    btBroadphasePair* const pair = side.add(1, 0);
    ASSERT_NE(pair, nullptr);
    EXPECT_EQ(pair->m_pProxy0, side.proxy(0)) << "oriented by unique id, as in Bullet";
    pair->m_internalInfo1 = &data;
    EXPECT_EQ(side.add(0, 1), pair);
    EXPECT_EQ(side.find(0, 1), pair);
    EXPECT_EQ(cache.getOverlappingPairArrayPtr(), pair);
    EXPECT_EQ(std::as_const(cache).getOverlappingPairArrayPtr(), pair);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 1);
    EXPECT_EQ(cache.removeOverlappingPair(side.proxy(1), side.proxy(0), nullptr), &data);
    EXPECT_EQ(cache.getNumOverlappingPairs(), 0);
    EXPECT_FALSE(cache.hasDeferredRemoval());
}

TEST(PairCache, LetsTheFilterCallbackDecideAndElseGroupAndMaskBothWays) {
    FilterBy oddOnly([](btBroadphaseProxy& a, btBroadphaseProxy& b) {
        return (a.m_uniqueId + b.m_uniqueId) % 2 == 1;
    });
    CacheSide side;
    side.proxies[2].m_collisionFilterGroup = btBroadphaseProxy::StaticFilter;
    side.proxies[2].m_collisionFilterMask = btBroadphaseProxy::DefaultFilter;
    EXPECT_NE(side.add(0, 2), nullptr);
    side.proxies[1].m_collisionFilterMask = btBroadphaseProxy::DefaultFilter;
    EXPECT_EQ(side.add(1, 2), nullptr) << "one way is not enough";
    EXPECT_EQ(side.add(2, 1), nullptr);

    side.cache.setOverlapFilterCallback(&oddOnly);
    EXPECT_EQ(side.cache.getOverlapFilterCallback(), &oddOnly);
    EXPECT_NE(side.add(1, 2), nullptr);
    EXPECT_NE(side.find(0, 2), nullptr) << "present pairs are not asked about";
    EXPECT_EQ(side.add(1, 3), nullptr);
    EXPECT_NE(side.cache.addAcceptedPair(side.proxy(1), side.proxy(3)), nullptr) << "does not ask";
}

// --- The pairs of one proxy ----------------------------------------------------------------------

TEST(PairCache, CleansAndRemovesAProxyInWorkProportionalToItsPairs) {
    CacheSide side;
    side.addBand();
    for (int i = 3; i < 110; i += 7) {
        const int before = side.cache.getNumOverlappingPairs();
        const std::uint64_t visitedBefore = side.cache.pairsVisited();
        side.cache.cleanProxyFromPairs(side.proxy(i), nullptr);
        side.cache.removeOverlappingPairsContainingProxy(side.proxy(i), nullptr);
        EXPECT_EQ(before - side.cache.getNumOverlappingPairs(), 6);
        EXPECT_EQ(side.cache.pairsVisited() - visitedBefore, 2 * 6U);
    }
    EXPECT_EQ(side.cache.validate(), "");
}

TEST(PairCache, FreesTheAlgorithmsOfThatProxyOnly) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        CacheSide side(order);
        side.addBand();
        side.giveAlgorithms();
        const int count = side.cache.getNumOverlappingPairs();
        side.cache.cleanProxyFromPairs(side.proxy(15), nullptr);
        EXPECT_EQ(side.freed.size(), 0U) << "without a dispatcher nothing is freed";
        side.cache.cleanProxyFromPairs(side.proxy(15), &side.dispatcher);
        EXPECT_EQ(side.freed.size(), 6U);
        EXPECT_EQ(side.cache.getNumOverlappingPairs(), count) << "the pairs stay";
        for (int i = 0; i < count; ++i) {
            const btBroadphasePair& pair = side.cache.getOverlappingPairArray()[i];
            const auto [a, b] = uidsOf(pair);
            EXPECT_EQ(pair.m_algorithm == nullptr, a == 15 || b == 15);
        }
        side.remove(0, 1);
        side.cache.getOverlappingPairArray();
        EXPECT_EQ(side.freed.size(), 7U);
        side.remove(0, 2);
        side.cache.cleanProxyFromPairs(side.proxy(0), &side.dispatcher);
        EXPECT_EQ(side.freed.size(), 9U) << "before the proxy can go";
        for (btBroadphaseProxy& proxy : side.proxies) {
            side.cache.removeOverlappingPairsContainingProxy(&proxy, &side.dispatcher);
        }
        EXPECT_EQ(side.freed.size(), std::size_t(count));
        EXPECT_EQ(side.cache.getNumOverlappingPairs(), 0);
    }
}

TEST(PairCache, ForgetsAProxyInCanonicalOrder) {
    CacheSide side(PairOrder::canonical);
    for (const int i : {7, 2, 9, 1, 8, 4}) {
        side.add(5, i);
    }
    side.cache.setInternalGhostPairCallback(&side.ghosts);
    side.cache.removeOverlappingPairsContainingProxy(side.proxy(5), nullptr);
    EXPECT_EQ(side.ghosts.all, (std::vector<PairJournal::Told>{{false, 1, 5},
                                                               {false, 2, 5},
                                                               {false, 4, 5},
                                                               {false, 5, 7},
                                                               {false, 5, 8},
                                                               {false, 5, 9}}));
}

TEST(PairCache, FreesAlgorithmsInCanonicalOrderInWhateverOrderPairsDie) {
    CacheSide side(PairOrder::canonical);
    side.addBand();
    side.giveAlgorithms();
    for (const int i : {7, 2, 9, 1, 8, 4}) {
        side.remove(i, i + 1);
    }
    side.cache.getOverlappingPairArray();
    EXPECT_EQ(side.freed.size(), 6U);
    EXPECT_EQ(side.freed, inOrder(side.freed));
}

// --- Looking at all pairs ------------------------------------------------------------------------

TEST(PairCache, DispatchesInTheOrderOfBulletsCacheWhenAskedToBeDeterministic) {
    CacheSide side;
    btHashedOverlappingPairCache bullet;
    for (int i = 0; i < 1000; ++i) {
        for (const bool isOurs : {true, false}) {
            const int turn = isOurs ? i : 999 - i;
            const int a = turn * 7 % 120;
            const int b = turn * 31 / 7 % 120;
            if (a != b) {
                (isOurs ? static_cast<btOverlappingPairCache&>(side.cache) : bullet)
                    .addOverlappingPair(side.proxy(a), side.proxy(b));
            }
        }
    }
    btDispatcherInfo info;
    info.m_deterministicOverlappingPairs = true;
    std::vector<Uids> first;
    for (btOverlappingPairCache* const cache : {static_cast<btOverlappingPairCache*>(&side.cache),
                                                static_cast<btOverlappingPairCache*>(&bullet)}) {
        ProcessBy keep([](btBroadphasePair&) { return false; });
        cache->processAllOverlappingPairs(&keep, nullptr, info);
        EXPECT_TRUE(first.empty() || first == keep.shown);
        first = keep.shown;
    }
    EXPECT_GT(first.size(), 500U);
}

TEST(PairCache, ToleratesChangesByTheCallback) {
    CacheSide side;
    for (int i = 0; i < 10; ++i) {
        side.add(i, i + 1);
    }
    // Every pair of the first ones brings another, far beyond the array's first capacity.
    ProcessBy addAnother([&](btBroadphasePair& pair) {
        const int next = pair.m_pProxy1->m_uniqueId;
        if (next + 1 < int(CacheSide::kProxies)) {
            side.add(next, next + 1);
        }
        return addAnother.shown.size() % 2 == 0;
    });
    side.cache.processAllOverlappingPairs(&addAnother, nullptr);
    EXPECT_EQ(std::set<Uids>(addAnother.shown.begin(), addAnother.shown.end()).size(),
              addAnother.shown.size());
    EXPECT_GT(addAnother.shown.size(), 110U) << "what the callback adds is shown";
    EXPECT_EQ(side.cache.validate(), "");

    // Takes every pair out and puts it back, and says that it is to stay; or only takes it out.
    for (const bool isPutBack : {true, false}) {
        const int count = side.cache.getNumOverlappingPairs();
        ProcessBy takeOut([&](btBroadphasePair& pair) {
            btBroadphaseProxy* const a = pair.m_pProxy0;
            btBroadphaseProxy* const b = pair.m_pProxy1;
            side.cache.removeOverlappingPair(a, b, nullptr);
            return isPutBack && side.cache.addOverlappingPair(a, b) == nullptr;
        });
        side.cache.processAllOverlappingPairs(&takeOut, nullptr);
        EXPECT_EQ(takeOut.shown.size(), std::size_t(count));
        EXPECT_EQ(side.cache.getNumOverlappingPairs(), isPutBack ? count : 0);
    }
}

TEST(PairCache, ShowsThePairThatTakesThePlaceOfOneThatTheCallbackReplacedByAnother) {
    CacheSide side;
    for (int i = 0; i < 3; ++i) {
        side.add(10 * i, 10 * i + 1);
    }
    ProcessBy replaceFirst([&](btBroadphasePair&) {
        if (replaceFirst.shown.size() == 1) {
            side.remove(0, 1);
            side.add(50, 51);
        }
        return false;
    });
    side.cache.processAllOverlappingPairs(&replaceFirst, nullptr);
    EXPECT_EQ(inOrder(replaceFirst.shown),
              (std::vector<Uids>{{0, 1}, {10, 11}, {20, 21}, {50, 51}}));
}

// As a contact-ended callback does that makes or destroys a proxy.
TEST(PairCache, RenewsPairsThoughFreeingAnAlgorithmChangesTheCache) {
    struct Change {
        Uids when;  // the algorithm of this pair is freed
        void (*make)(CacheSide&);
    };
    const std::array<Change, 3> changes{
        Change{{1, 2}, [](CacheSide& side) { side.remove(1, 2); }},
        Change{{1, 2},
               [](CacheSide& side) {
                   side.cache.removeOverlappingPairsContainingProxy(side.proxy(1),
                                                                    &side.dispatcher);
               }},
        // The place of one goes to the last pair, whose own goes to a new one; then the array moves.
        Change{{1, 8}, [](CacheSide& side) {
                   side.remove(3, 4);
                   side.addBand();
               }}};
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        for (const Change& change : changes) {
            CacheSide side(order);
            side.cache.setInternalGhostPairCallback(&side.ghosts);
            for (const auto& [a, b] :
                 {Uids(1, 2), Uids(3, 4), Uids(1, 5), Uids(6, 7), Uids(1, 8)}) {
                side.add(a, b);
            }
            side.giveAlgorithms();
            side.onFreed = [&](const Uids& uids) {
                if (uids == change.when) {
                    change.make(side);
                }
            };
            side.cache.renewPairsContainingProxy(side.proxy(1), &side.dispatcher);
            const std::vector<PairJournal::Told>& told = side.ghosts.all;
            for (const int other : {2, 5, 8}) {
                const PairJournal::Told end{false, 1, other};
                EXPECT_EQ(std::count(told.begin(), told.end(), end), 1);
            }
            EXPECT_EQ(side.ghosts.errors, std::vector<std::string>{});
            EXPECT_EQ(side.ghosts.alive, uidPairs(side.cache));
            EXPECT_EQ(side.cache.validate(), "");
        }
    }
}

// A program may delete what it has taken out, so contacts that name it are freed before.
TEST(PairCache, FreesAProxysAlgorithmsBeforeItIsGoneThoughACallbackTakesItOut) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        for (const bool isOnFreed : {false, true}) {
            CacheSide side(order);
            for (const int other : {1, 2, 3}) {
                side.add(0, other);
            }
            side.giveAlgorithms();
            const auto takeOut = [&, isDone = false](auto&&... /*pair*/) mutable {
                if (!std::exchange(isDone, true)) {
                    side.cache.removeOverlappingPairsContainingProxy(side.proxy(0),
                                                                     &side.dispatcher);
                    EXPECT_EQ(side.freed.size(), 3U);
                }
            };
            if (isOnFreed) {
                side.onFreed = takeOut;
            } else {
                side.cache.setInternalGhostPairCallback(&side.ghosts);
                side.ghosts.onDeath = takeOut;
            }
            side.update({{0, 1}, {0, 2}}, {});
            EXPECT_EQ(side.list(), std::vector<Uids>{});
            EXPECT_EQ(inOrder(side.freed), (std::vector<Uids>{{0, 1}, {0, 2}, {0, 3}}));
        }
    }
}

TEST(PairCache, FreesAnAlgorithmOfWhoseEndAGhostCallbackThrows) {
    CacheSide side;
    side.add(0, 1);
    side.giveAlgorithms();
    side.cache.setInternalGhostPairCallback(&side.ghosts);
    side.ghosts.onDeath = [](auto*, auto*) { throw std::runtime_error("A ghost fails."); };
    EXPECT_THROW(side.remove(0, 1), std::runtime_error);
    EXPECT_EQ(side.freed.size(), 1U);
    EXPECT_EQ(side.cache.validate(), "");
}

// --- Order ---------------------------------------------------------------------------------------

// Two of each, and negative ones.
int twoOfEach(const btBroadphaseProxy& proxy) {
    return proxy.m_uniqueId * 29 % 80 / 2 - 20;
}

TEST(PairCache, HasACanonicalOrderThatDependsOnlyOnTheSet) {
    for (const ProxyKey key : {&PairCache::uniqueId, &twoOfEach}) {
        CacheSide winding(PairOrder::canonical, key);
        PairCache straight(PairOrder::canonical, key);
        std::mt19937 random(15);
        for (int i = 0; i < 5000; ++i) {
            const int a = int(random() % CacheSide::kProxies);
            const int b = int(random() % CacheSide::kProxies);
            if (a != b && random() % 2 == 0) {
                winding.add(a, b);
            } else if (a != b) {
                winding.remove(a, b);
            }
            if (i % 100 == 0) {
                winding.giveAlgorithms();
                winding.cache.removeOverlappingPairsContainingProxy(winding.proxy(a),
                                                                    &winding.dispatcher);
            }
        }
        winding.addBand();
        const std::vector<Uids> all = winding.list();
        for (const auto& [a, b] : inOrder(all)) {
            straight.addOverlappingPair(winding.proxy(b), winding.proxy(a));
        }
        EXPECT_EQ(uidList(straight), all);
        EXPECT_EQ(winding.cache.validate(), "");
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto keyOf = [&](int uid) { return key(*winding.proxy(uid)); };
            EXPECT_LE(keyOf(all[i].first), keyOf(all[i].second));
            EXPECT_LE(keyOf(all[i == 0 ? 0 : i - 1].first), keyOf(all[i].first));
        }
    }
}

TEST(PairCache, KeepsAlgorithmsAndTellsNoGhostWhenSorting) {
    CacheSide side;
    for (int i = 0; i < 49; ++i) {
        side.add(48 - i, 49 - i);
    }
    side.giveAlgorithms();
    EXPECT_EQ(side.list().front(), Uids(48, 49)) << "in the order of arrival";
    side.cache.setInternalGhostPairCallback(&side.ghosts);
    side.cache.sortOverlappingPairs(&side.dispatcher);
    EXPECT_EQ(side.ghosts.all.size(), 0U);
    EXPECT_EQ(side.list(), inOrder(side.list()));
    for (int i = 0; i < 49; ++i) {
        const auto* kept = static_cast<NotedAlgorithm*>(side.find(i, i + 1)->m_algorithm);
        EXPECT_EQ(kept->uids, Uids(i, i + 1));
    }
    ProcessBy removeAll([](btBroadphasePair&) { return true; });
    side.cache.processAllOverlappingPairs(&removeAll, &side.dispatcher);
    EXPECT_EQ(side.freed.size(), 49U);
    EXPECT_EQ(side.ghosts.all.size(), 49U);
}

}  // namespace
}  // namespace hashphase::test
