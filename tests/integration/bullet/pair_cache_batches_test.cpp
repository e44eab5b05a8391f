// SPDX-License-Identifier: Zlib
//
// What the pair cache does in batches against what it does in single calls.

#include <integration/bullet/pair_cache.hpp>

#include <btBulletDynamicsCommon.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace hashphase {
namespace {

using IdPair = std::pair<int, int>;

IdPair idsOf(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    return std::minmax({a.m_uniqueId, b.m_uniqueId});
}

/// Writes down when it is freed, and by which dispatcher's leave.
struct NotedAlgorithm : btCollisionAlgorithm {
    NotedAlgorithm(IdPair i, std::vector<IdPair>& f) : ids(i), freed(f) {}
    ~NotedAlgorithm() override { freed.push_back(ids); }
    void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*,
                          const btDispatcherInfo&, btManifoldResult*) override {}
    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray&) override {}
    IdPair ids;
    std::vector<IdPair>& freed;
};

struct NotingGhosts : btOverlappingPairCallback {
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        told.emplace_back(true, idsOf(*a, *b));
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher*) override {
        told.emplace_back(false, idsOf(*a, *b));
        return nullptr;
    }
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy*, btDispatcher*) override {}
    std::vector<std::pair<bool, IdPair>> told;
};

constexpr std::size_t kProxies = 120;

/// A cache with its dispatcher, and what it has freed and told.
struct Side {
    explicit Side(PairOrder order) : cache(order) {}
    ~Side() {
        cache.setInternalGhostPairCallback(nullptr);
        for (btBroadphaseProxy& proxy : proxies) {
            cache.removeOverlappingPairsContainingProxy(&proxy, &dispatcher);
        }
    }

    void giveAlgorithms() {
        btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i) {
            const IdPair ids = idsOf(*pairs[i].m_pProxy0, *pairs[i].m_pProxy1);
            // Some have none yet, as in a world where pairs are dispatched once a step.
            if (pairs[i].m_algorithm == nullptr && (ids.first + ids.second) % 3 != 0) {
                void* memory = dispatcher.allocateCollisionAlgorithm(sizeof(NotedAlgorithm));
                pairs[i].m_algorithm = new (memory) NotedAlgorithm(ids, freed);
            }
        }
    }

    std::vector<BulletProxyPair> pairs(const std::vector<IdPair>& of) {
        std::vector<BulletProxyPair> list;
        for (const auto& [a, b] : of) {
            list.emplace_back(proxies[std::size_t(a)], proxies[std::size_t(b)]);
        }
        return list;
    }

    void update(const std::vector<IdPair>& died, const std::vector<IdPair>& born) {
        cache.update(pairs(died), pairs(born), &dispatcher);
    }

    void updateSingly(const std::vector<IdPair>& died, const std::vector<IdPair>& born) {
        for (const BulletProxyPair& pair : pairs(died)) {
            cache.removeOverlappingPair(pair.upper(), pair.lower(), &dispatcher);
        }
        for (const BulletProxyPair& pair : pairs(born)) {
            cache.addAcceptedPair(pair.upper(), pair.lower());
        }
    }

    std::vector<btBroadphaseProxy*> pointers(const std::vector<int>& of) {
        std::vector<btBroadphaseProxy*> list;
        for (const int each : of) {
            list.push_back(&proxies[std::size_t(each)]);
        }
        return list;
    }

    [[nodiscard]] std::vector<IdPair> list() {
        std::vector<IdPair> ids;
        const btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
        for (int i = 0; i < pairs.size(); ++i) {
            ids.push_back(idsOf(*pairs[i].m_pProxy0, *pairs[i].m_pProxy1));
        }
        return ids;
    }

    static std::vector<btBroadphaseProxy> someProxies() {
        std::vector<btBroadphaseProxy> some(kProxies);
        for (std::size_t i = 0; i < kProxies; ++i) {
            some[i].m_uniqueId = static_cast<int>(i);
        }
        return some;
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    std::vector<IdPair> freed;
    NotingGhosts ghosts;
    std::vector<btBroadphaseProxy> proxies = someProxies();
    PairCache cache;
};

std::vector<IdPair> sorted(std::vector<IdPair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// BulletRandom pairs, some of them there and some not, some twice.
std::vector<IdPair> somePairs(std::mt19937& random, std::size_t most) {
    std::vector<IdPair> pairs(random() % (most + 1));
    for (IdPair& pair : pairs) {
        pair.first = static_cast<int>(random() % kProxies);
        pair.second = static_cast<int>((std::size_t(pair.first) + 1 + random() % 9) % kProxies);
    }
    return pairs;
}

class PairCacheBatches : public testing::TestWithParam<std::pair<PairOrder, bool>> {};

TEST_P(PairCacheBatches, DoWhatSingleCallsDo) {
    const auto [order, hasGhosts] = GetParam();
    Side batch(order);
    Side single(order);
    for (Side* side : {&batch, &single}) {
        side->cache.setInternalGhostPairCallback(hasGhosts ? &side->ghosts : nullptr);
    }
    std::mt19937 random(31);
    for (int round = 0; round < 1500; ++round) {
        // Few changes and many, so that chains are kept, dropped and made again.
        const std::size_t most = round % 50 < 30 ? 6 : 150;
        const std::vector<IdPair> died = somePairs(random, most);
        const std::vector<IdPair> born = somePairs(random, 2 * most);
        batch.update(died, born);
        single.updateSingly(died, born);
        if (round % 3 == 0) {
            std::set<int> chosen;
            for (std::size_t i = 0; i < random() % (round % 27 == 0 ? kProxies : 9); ++i) {
                chosen.insert(static_cast<int>(random() % kProxies));
            }
            std::vector<int> gone(chosen.begin(), chosen.end());
            std::shuffle(gone.begin(), gone.end(), random);
            batch.cache.removeOverlappingPairsContainingProxies(batch.pointers(gone),
                                                                &batch.dispatcher);
            for (btBroadphaseProxy* proxy : single.pointers(gone)) {
                single.cache.removeOverlappingPairsContainingProxy(proxy, &single.dispatcher);
            }
        }
        ASSERT_EQ(batch.cache.validate(), "") << round;
        const bool isSameToTheLastBit = hasGhosts || order == PairOrder::canonical;
        ASSERT_EQ(isSameToTheLastBit ? batch.list() : sorted(batch.list()),
                  isSameToTheLastBit ? single.list() : sorted(single.list()))
            << round;
        ASSERT_EQ(isSameToTheLastBit ? batch.freed : sorted(batch.freed),
                  isSameToTheLastBit ? single.freed : sorted(single.freed))
            << round;
        ASSERT_EQ(batch.ghosts.told, single.ghosts.told) << round;
        batch.giveAlgorithms();
        single.giveAlgorithms();
    }
    EXPECT_GT(batch.freed.size(), 10'000U);
    EXPECT_EQ(batch.ghosts.told.empty(), !hasGhosts);
}

INSTANTIATE_TEST_SUITE_P(Orders, PairCacheBatches,
                         testing::Values(std::pair{PairOrder::arrival, false},
                                         std::pair{PairOrder::arrival, true},
                                         std::pair{PairOrder::canonical, false},
                                         std::pair{PairOrder::canonical, true}));

TEST(PairCacheBatch, LetsBirthsTakeThePlacesOfDeathsAndMovesNothingElse) {
    Side side(PairOrder::arrival);
    side.update({}, {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {8, 9}});
    side.giveAlgorithms();
    const std::vector<IdPair> before = side.list();
    side.update({{6, 7}, {2, 3}, {50, 60}}, {{10, 11}, {12, 13}, {14, 15}});
    EXPECT_EQ(side.list(),
              (std::vector<IdPair>{{0, 1}, {12, 13}, {4, 5}, {10, 11}, {8, 9}, {14, 15}}));
    EXPECT_EQ(side.freed, (std::vector<IdPair>{{6, 7}, {2, 3}})) << "in the order given";
    side.update({{0, 1}, {8, 9}, {14, 15}, {12, 13}}, {{0, 2}});
    EXPECT_EQ(side.list(), (std::vector<IdPair>{{0, 2}, {10, 11}, {4, 5}}))
        << "places left are filled from the end";
    EXPECT_EQ(side.cache.validate(), "");
}

TEST(PairCacheBatch, KeepsWhatBelongsToThePairsThatStay) {
    Side side(PairOrder::arrival);
    side.update({}, {{0, 1}, {2, 3}, {4, 5}});
    int data = 0;
    side.cache.findPair(&side.proxies[4], &side.proxies[5])->m_internalInfo1 = &data;
    side.giveAlgorithms();
    side.update({{0, 1}, {2, 3}}, {{4, 5}, {6, 7}});
    const btBroadphasePair* kept = side.cache.findPair(&side.proxies[4], &side.proxies[5]);
    const btBroadphasePair* born = side.cache.findPair(&side.proxies[6], &side.proxies[7]);
    EXPECT_EQ(kept->m_internalInfo1, &data);
    EXPECT_EQ(born->m_internalInfo1, nullptr);
    EXPECT_EQ(born->m_algorithm, nullptr);
    EXPECT_EQ(side.freed, (std::vector<IdPair>{{0, 1}, {2, 3}}));
}

/// Changes the cache whenever it is told of something.
struct MeddlingGhosts : NotingGhosts {
    explicit MeddlingGhosts(Side& s) : side(s) {}
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b) override {
        NotingGhosts::addOverlappingPair(a, b);
        EXPECT_NE(side.cache.findPair(a, b), nullptr);
        EXPECT_EQ(side.cache.validate(), "");
        if (a->m_uniqueId < 20) {
            side.cache.removeOverlappingPair(&side.proxies[40], &side.proxies[41],
                                             &side.dispatcher);
            side.cache.addAcceptedPair(a, &side.proxies[99]);
        }
        return nullptr;
    }
    void* removeOverlappingPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                btDispatcher* dispatcher) override {
        NotingGhosts::removeOverlappingPair(a, b, dispatcher);
        EXPECT_EQ(side.cache.findPair(a, b), nullptr);
        EXPECT_EQ(side.cache.validate(), "");
        side.cache.removeOverlappingPair(&side.proxies[2], &side.proxies[3], dispatcher);
        return nullptr;
    }
    Side& side;
};

TEST(PairCacheBatch, ShowsGhostsACacheInOrderThatTheyMayChange) {
    Side side(PairOrder::arrival);
    side.update({}, {{0, 1}, {2, 3}, {4, 5}, {40, 41}});
    side.giveAlgorithms();
    MeddlingGhosts ghosts(side);
    side.cache.setInternalGhostPairCallback(&ghosts);
    side.update({{0, 1}, {2, 3}}, {{10, 11}, {30, 31}});
    EXPECT_EQ(sorted(side.list()), (std::vector<IdPair>{{4, 5}, {10, 11}, {10, 99}, {30, 31}}));
    EXPECT_EQ(side.cache.validate(), "");
    EXPECT_EQ(ghosts.told.size(), 6U);
    side.cache.setInternalGhostPairCallback(nullptr);
}

/// Calls update(), or the single calls, when it is shown the first pair.
struct Updating : btOverlapCallback {
    Updating(Side& s, bool byBatch) : side(s), isBatch(byBatch) {}
    bool processOverlap(btBroadphasePair& pair) override {
        shown.push_back(idsOf(*pair.m_pProxy0, *pair.m_pProxy1));
        if (shown.size() == 1) {
            const std::vector<IdPair> died{{0, 1}, {4, 5}};
            const std::vector<IdPair> born{{8, 9}, {10, 11}, {12, 13}};
            isBatch ? side.update(died, born) : side.updateSingly(died, born);
        }
        return shown.size() % 4 == 0;
    }
    Side& side;
    bool isBatch;
    std::vector<IdPair> shown;
};

TEST(PairCacheBatch, IsSingleCallsWhenCalledByACallbackThatIsShownAllPairs) {
    for (const PairOrder order : {PairOrder::arrival, PairOrder::canonical}) {
        Side batch(order);
        Side single(order);
        Updating byBatch(batch, true);
        Updating bySingleCalls(single, false);
        for (Updating* updating : {&byBatch, &bySingleCalls}) {
            Side& side = updating->side;
            side.update({}, {{0, 1}, {2, 3}, {4, 5}, {6, 7}});
            side.giveAlgorithms();
            side.cache.processAllOverlappingPairs(updating, &side.dispatcher);
        }
        EXPECT_EQ(byBatch.shown, bySingleCalls.shown);
        EXPECT_EQ(batch.freed, single.freed);
        EXPECT_EQ(batch.list(), single.list());
        EXPECT_EQ(batch.cache.validate(), "");
    }
}

TEST(PairCacheBatch, AllocatesNothingForPairsThatComeAndGo) {
    Side side(PairOrder::arrival);
    std::mt19937 random(32);
    std::size_t before = 0;
    for (int round = 0; round < 600; ++round) {
        side.update(side.list(), somePairs(random, 300));
        side.giveAlgorithms();
        const std::size_t now = side.cache.memoryBytes();
        ASSERT_TRUE(round < 300 || now == before);
        before = now;
    }
}

#if HASHPHASE_ENABLE_ASSERTS
// They are counted before any is read: there is but one.
TEST(PairCacheBatch, OfMoreThanThereMayBeIsRefusedAndChangesNothing) {
    for (const bool hasGhosts : {false, true}) {
        Side side(PairOrder::arrival);
        side.cache.setInternalGhostPairCallback(hasGhosts ? &side.ghosts : nullptr);
        side.cache.update({}, side.pairs({{0, 1}}), &side.dispatcher);
        side.ghosts.told.clear();
        const std::vector<BulletProxyPair> present = side.pairs({{0, 1}});
        const std::vector<BulletProxyPair> another = side.pairs({{2, 3}});
        for (const std::size_t count : {PairCache::kMostPairs, PairCache::kMostPairs + 1}) {
            const std::span<const BulletProxyPair> tooMany(another.data(), count);
            EXPECT_THROW(side.cache.update({}, tooMany, nullptr), std::length_error);
            EXPECT_THROW(side.cache.update(present, tooMany, nullptr), std::length_error);
        }
        EXPECT_EQ(side.cache.getNumOverlappingPairs(), 1);
        EXPECT_NE(side.cache.findPair(present[0].lower(), present[0].upper()), nullptr);
        EXPECT_EQ(side.cache.findPair(another[0].lower(), another[0].upper()), nullptr);
        EXPECT_EQ(side.cache.validate(), "");
        EXPECT_TRUE(side.ghosts.told.empty());
        side.cache.update(present, another, &side.dispatcher);  // and goes on
        EXPECT_EQ(side.cache.getNumOverlappingPairs(), 1);
        EXPECT_EQ(side.cache.validate(), "");
    }
}

TEST(PairCacheBatchDeathTest, AssertsThatAPairIsOfTwoProxies) {
    Side side(PairOrder::arrival);
    EXPECT_DEATH(side.update({}, {{4, 4}}), "two proxies with different unique ids");
    side.proxies[5].m_uniqueId = -5;
    EXPECT_DEATH(side.update({}, {{4, 5}}), "not negative");
}
#endif

}  // namespace
}  // namespace hashphase
