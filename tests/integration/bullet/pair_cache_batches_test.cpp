// SPDX-License-Identifier: Zlib
//
// What the pair cache does in batches against what it does in single calls.

#include <tests/integration/bullet/cache_side.hpp>
#include <tests/support/threaded_for.hpp>

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

namespace hashphase::test {
namespace {

// Some have none yet, as in a world where pairs are dispatched once a step.
bool hasNoAlgorithm(const Uids& uids) {
    return (uids.first + uids.second) % 3 == 0;
}

/// Pairs of neighbours, some of them there and some not, some twice.
std::vector<Uids> somePairs(std::mt19937& random, std::size_t most) {
    std::vector<Uids> pairs(random() % (most + 1));
    for (Uids& pair : pairs) {
        pair.first = static_cast<int>(random() % CacheSide::kProxies);
        pair.second =
            static_cast<int>((std::size_t(pair.first) + 1 + random() % 9) % CacheSide::kProxies);
    }
    return pairs;
}

/// So many pairs of any two, some of them there and some not, some twice.
std::vector<Uids> anyPairs(std::mt19937& random, std::size_t count) {
    std::vector<Uids> pairs(count);
    for (Uids& pair : pairs) {
        pair.first = static_cast<int>(random() % CacheSide::kProxies);
        pair.second =
            static_cast<int>((std::size_t(pair.first) + 1 + random() % (CacheSide::kProxies - 1)) %
                             CacheSide::kProxies);
    }
    return pairs;
}

std::vector<btBroadphaseProxy*> someProxies(std::mt19937& random, CacheSide& side,
                                            std::size_t most) {
    std::set<int> chosen;
    for (std::size_t i = 0; i < random() % most; ++i) {
        chosen.insert(static_cast<int>(random() % CacheSide::kProxies));
    }
    std::vector<btBroadphaseProxy*> list;
    for (const int each : chosen) {
        list.push_back(side.proxy(each));
    }
    std::shuffle(list.begin(), list.end(), random);
    return list;
}

class PairCacheBatches : public testing::TestWithParam<std::pair<PairOrder, bool>> {};

TEST_P(PairCacheBatches, DoWhatSingleCallsDo) {
    const auto [order, hasGhosts] = GetParam();
    const bool isSameToTheLastBit = hasGhosts || order == PairOrder::canonical;
    const auto comparable = [&](const std::vector<Uids>& list) {
        return isSameToTheLastBit ? list : inOrder(list);
    };
    CacheSide batch(order);
    CacheSide single(order);
    for (CacheSide* side : {&batch, &single}) {
        side->cache.setInternalGhostPairCallback(hasGhosts ? &side->ghosts : nullptr);
    }
    std::mt19937 random(31);
    for (int round = 0; round < 1500; ++round) {
        SCOPED_TRACE(round);
        // Few changes and many, so that chains are kept, dropped and made again.
        const std::size_t most = round % 50 < 30 ? 6 : 150;
        const std::vector<Uids> died = somePairs(random, most);
        const std::vector<Uids> born = somePairs(random, 2 * most);
        batch.update(died, born);
        single.updateSingly(died, born);
        if (round % 3 == 0) {
            const std::size_t mostGone = round % 27 == 0 ? CacheSide::kProxies : 9;
            std::mt19937 again = random;
            batch.cache.removeOverlappingPairsContainingProxies(
                someProxies(random, batch, mostGone), &batch.dispatcher);
            for (btBroadphaseProxy* proxy : someProxies(again, single, mostGone)) {
                single.cache.removeOverlappingPairsContainingProxy(proxy, &single.dispatcher);
            }
        }
        ASSERT_EQ(batch.cache.validate(), "");
        ASSERT_EQ(comparable(batch.list()), comparable(single.list()));
        ASSERT_EQ(comparable(batch.freed), comparable(single.freed));
        ASSERT_EQ(batch.ghosts.all, single.ghosts.all);
        batch.giveAlgorithms(hasNoAlgorithm);
        single.giveAlgorithms(hasNoAlgorithm);
    }
    EXPECT_GT(batch.freed.size(), 10'000U);
    EXPECT_EQ(batch.ghosts.all.empty(), !hasGhosts);
}

INSTANTIATE_TEST_SUITE_P(Orders, PairCacheBatches,
                         testing::Values(std::pair{PairOrder::arrival, false},
                                         std::pair{PairOrder::arrival, true},
                                         std::pair{PairOrder::canonical, false},
                                         std::pair{PairOrder::canonical, true}));

// Thousands of pairs of two sides of which one is on threads: the arrays are the same, to the last bit.
TEST(PairCacheBatch, IsTheSameOnAnyNumberOfThreads) {
    std::mt19937 random(33);
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        CacheSide alone(order);
        CacheSide onThreads(order);
        for (int round = 0; round < 40; ++round) {
            SCOPED_TRACE(round);
            const std::vector<Uids> died = anyPairs(random, 4000);
            const std::vector<Uids> born = anyPairs(random, 5000);
            ThreadedFor threadedFor(1 + std::size_t(round) % 4, random());
            alone.update(died, born);
            onThreads.cache.update(onThreads.pairs(died), onThreads.pairs(born),
                                   &onThreads.dispatcher, threadedFor);
            EXPECT_TRUE(round == 0 || threadedFor.mostRanges() > 1) << "it is worth the threads";
            ASSERT_EQ(onThreads.cache.validate(), "");
            ASSERT_EQ(onThreads.list(), alone.list());
            ASSERT_EQ(onThreads.freed, alone.freed);
            alone.giveAlgorithms(hasNoAlgorithm);
            onThreads.giveAlgorithms(hasNoAlgorithm);
        }
        EXPECT_GT(alone.freed.size(), 10'000U);
    }
}

TEST(PairCacheBatch, LetsBirthsTakeThePlacesOfDeathsAndMovesNothingElse) {
    CacheSide side;
    side.update({}, {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {8, 9}});
    side.giveAlgorithms(hasNoAlgorithm);
    side.update({{6, 7}, {2, 3}, {50, 60}}, {{10, 11}, {12, 13}, {14, 15}});
    EXPECT_EQ(side.list(),
              (std::vector<Uids>{{0, 1}, {12, 13}, {4, 5}, {10, 11}, {8, 9}, {14, 15}}));
    EXPECT_EQ(side.freed, (std::vector<Uids>{{6, 7}, {2, 3}})) << "in the order given";
    side.update({{0, 1}, {8, 9}, {14, 15}, {12, 13}}, {{0, 2}});
    EXPECT_EQ(side.list(), (std::vector<Uids>{{0, 2}, {10, 11}, {4, 5}}))
        << "places left are filled from the end";
    EXPECT_EQ(side.cache.validate(), "");
}

TEST(PairCacheBatch, IsWholeWhereTheDispatcherThrows) {
    CacheSide side;
    side.addBand();
    side.giveAlgorithms();
    const std::size_t count = side.list().size();
    ThrowingDispatcher throwing(&side.configuration);
    const std::array gone{side.proxy(3), side.proxy(4), side.proxy(5), side.proxy(6),
                          side.proxy(90)};
    EXPECT_THROW(side.cache.removeOverlappingPairsContainingProxies(gone, &throwing),
                 std::runtime_error);
    EXPECT_EQ(side.cache.validate(), "");
    const std::vector<Uids> left = side.list();
    EXPECT_GT(left.size(), 300U);
    EXPECT_EQ(side.freed.size(), count - left.size()) << "no algorithm is lost";
    for (const auto& [a, b] : left) {
        EXPECT_FALSE((a >= 3 && a <= 6) || (b >= 3 && b <= 6) || a == 90 || b == 90)
            << a << ", " << b;
    }
    side.update({{0, 1}}, {{0, 100}});
    EXPECT_EQ(side.cache.validate(), "");
}

TEST(PairCacheBatch, KeepsWhatBelongsToThePairsThatStay) {
    CacheSide side;
    side.update({}, {{0, 1}, {2, 3}, {4, 5}});
    int data = 0;
    side.find(4, 5)->m_internalInfo1 = &data;
    side.giveAlgorithms();
    side.update({{0, 1}, {2, 3}}, {{4, 5}, {6, 7}});
    EXPECT_EQ(side.find(4, 5)->m_internalInfo1, &data);
    EXPECT_EQ(side.find(6, 7)->m_internalInfo1, nullptr);
    EXPECT_EQ(side.find(6, 7)->m_algorithm, nullptr);
    EXPECT_EQ(side.freed, (std::vector<Uids>{{0, 1}, {2, 3}}));
}

TEST(PairCacheBatch, ShowsGhostsACacheInOrderThatTheyMayChange) {
    CacheSide side;
    side.update({}, {{0, 1}, {2, 3}, {4, 5}, {40, 41}});
    side.giveAlgorithms();
    side.ghosts.onBirth = [&](btBroadphaseProxy* a, btBroadphaseProxy* b) {
        EXPECT_NE(side.cache.findPair(a, b), nullptr);
        EXPECT_EQ(side.cache.validate(), "");
        if (a->m_uniqueId < 20) {
            side.remove(40, 41);
            side.cache.addAcceptedPair(a, side.proxy(99));
        }
    };
    side.ghosts.onDeath = [&](btBroadphaseProxy* a, btBroadphaseProxy* b) {
        EXPECT_EQ(side.cache.findPair(a, b), nullptr);
        EXPECT_EQ(side.cache.validate(), "");
        side.remove(2, 3);
    };
    side.cache.setInternalGhostPairCallback(&side.ghosts);
    side.update({{0, 1}, {2, 3}}, {{10, 11}, {30, 31}});
    EXPECT_EQ(inOrder(side.list()), (std::vector<Uids>{{4, 5}, {10, 11}, {10, 99}, {30, 31}}));
    EXPECT_EQ(side.cache.validate(), "");
    EXPECT_EQ(side.ghosts.all.size(), 6U);
}

TEST(PairCacheBatch, IsSingleCallsWhenCalledByACallbackThatIsShownAllPairs) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        CacheSide batch(order);
        CacheSide single(order);
        std::vector<std::vector<Uids>> shown;
        for (CacheSide* side : {&batch, &single}) {
            side->update({}, {{0, 1}, {2, 3}, {4, 5}, {6, 7}});
            side->giveAlgorithms();
            ProcessBy updating([&](btBroadphasePair&) {
                if (updating.shown.size() == 1) {
                    const std::vector<Uids> died{{0, 1}, {4, 5}};
                    const std::vector<Uids> born{{8, 9}, {10, 11}, {12, 13}};
                    side == &batch ? side->update(died, born) : side->updateSingly(died, born);
                }
                return updating.shown.size() % 4 == 0;
            });
            side->cache.processAllOverlappingPairs(&updating, &side->dispatcher);
            shown.push_back(updating.shown);
        }
        EXPECT_EQ(shown[0], shown[1]);
        EXPECT_EQ(batch.freed, single.freed);
        EXPECT_EQ(batch.list(), single.list());
        EXPECT_EQ(batch.cache.validate(), "");
    }
}

TEST(PairCacheBatch, AllocatesNothingForPairsThatComeAndGo) {
    CacheSide side;
    std::mt19937 random(32);
    std::size_t before = 0;
    for (int round = 0; round < 600; ++round) {
        side.update(side.list(), somePairs(random, 300));
        side.giveAlgorithms(hasNoAlgorithm);
        const std::size_t now = side.cache.memoryBytes();
        ASSERT_TRUE(round < 300 || now == before);
        before = now;
    }
}

#if HASHPHASE_ENABLE_ASSERTS
// They are counted before any is read: there is but one.
TEST(PairCacheBatch, OfMoreThanThereMayBeIsRefusedAndChangesNothing) {
    for (const bool hasGhosts : {false, true}) {
        CacheSide side;
        side.update({}, {{0, 1}});
        side.cache.setInternalGhostPairCallback(hasGhosts ? &side.ghosts : nullptr);
        const std::vector<BulletProxyPair> present = side.pairs({{0, 1}});
        const std::vector<BulletProxyPair> another = side.pairs({{2, 3}});
        for (const std::size_t count : {PairCache::kMostPairs, PairCache::kMostPairs + 1}) {
            const std::span<const BulletProxyPair> tooMany(another.data(), count);
            EXPECT_THROW(side.cache.update({}, tooMany, nullptr), std::length_error);
            EXPECT_THROW(side.cache.update(present, tooMany, nullptr), std::length_error);
        }
        EXPECT_EQ(side.list(), (std::vector<Uids>{{0, 1}}));
        EXPECT_EQ(side.find(2, 3), nullptr);
        EXPECT_EQ(side.cache.validate(), "");
        EXPECT_TRUE(side.ghosts.all.empty());
        side.update({{0, 1}}, {{2, 3}});  // and goes on
        EXPECT_EQ(side.list(), (std::vector<Uids>{{2, 3}}));
        EXPECT_EQ(side.cache.validate(), "");
    }
}

TEST(PairCacheBatchDeathTest, AssertsThatAPairIsOfTwoProxies) {
    CacheSide side;
    EXPECT_DEATH_IF_SUPPORTED(side.update({}, {{4, 4}}),
                              "both proxies of a pair have one m_uniqueId");
    side.proxies[5].m_uniqueId = -5;
    EXPECT_DEATH_IF_SUPPORTED(side.update({}, {{4, 5}}), "the m_uniqueId of a proxy is negative");
}
#endif

}  // namespace
}  // namespace hashphase::test
