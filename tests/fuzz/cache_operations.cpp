// SPDX-License-Identifier: Zlib

// PairCache by itself against a set of pairs.

#include <tests/fuzz/life.hpp>
#include <tests/fuzz/palette.hpp>
#include <tests/integration/bullet/callbacks.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <algorithm>
#include <set>
#include <utility>

namespace hashphase::test {
namespace {

/// Removes every pair of which the sum of the ids is a multiple of the divisor.
struct RemoveSome : btOverlapCallback {
    bool processOverlap(btBroadphasePair& pair) override {
        shown.push_back(uidsOf(pair));
        return isRemoved(shown.back());
    }
    [[nodiscard]] bool isRemoved(const Uids& ids) const {
        return divisor != 0 && (ids.first + ids.second) % divisor == 0;
    }
    int divisor = 0;
    std::vector<Uids> shown;
};

class CachePlay {
public:
    CachePlay(const Operation& first, OperationLog& story)
        : story_(story),
          cache_(first.arguments[0] % 2 == 0 ? PairOrder::arrival : PairOrder::canonical,
                 first.arguments[1] % 2 == 0 ? &PairCache::uniqueId : &backwards) {
        for (int i = 0; i < kProxies; ++i) {
            proxies_[static_cast<std::size_t>(i)].m_uniqueId = i + 1;
            proxies_[static_cast<std::size_t>(i)].m_collisionFilterGroup = 1 << (i % 4);
            proxies_[static_cast<std::size_t>(i)].m_collisionFilterMask = i % 5 == 0 ? 3 : -1;
        }
        if (first.arguments[2] % 2 == 1) {
            cache_.setInternalGhostPairCallback(&ghosts_);
        }
        hasGhosts_ = first.arguments[2] % 2 == 1;
    }

    void play(const Operation& operation) {
        Arguments arguments(operation);
        (this->*kOwn[operation.kind % kOwn.size()])(arguments);
        EXPECT_EQ(cache_.validate(), "");
        EXPECT_EQ(static_cast<std::size_t>(cache_.getNumOverlappingPairs()), expected_.size());
        std::set<Uids> pairs;
        for (int i = 0; i < cache_.getNumOverlappingPairs(); ++i) {
            pairs.insert(uidsOf(std::as_const(cache_).getOverlappingPairArrayPtr()[i]));
        }
        EXPECT_EQ(pairs, expected_);
        EXPECT_TRUE(!hasGhosts_ || ghosts_.alive == expected_);
        EXPECT_TRUE(ghosts_.errors.empty()) << ghosts_.errors[0];
    }

private:
    static constexpr int kProxies = 24;

    static int backwards(const btBroadphaseProxy& proxy) { return -proxy.m_uniqueId; }

    [[nodiscard]] btBroadphaseProxy& any(Arguments& arguments) {
        return proxies_[arguments.below(kProxies)];
    }
    /// Two different ones.
    std::pair<btBroadphaseProxy*, btBroadphaseProxy*> proxiesOf(Arguments& arguments) {
        const std::uint32_t low = arguments.byte();
        return proxiesOf(low + 256U * arguments.byte());
    }
    std::pair<btBroadphaseProxy*, btBroadphaseProxy*> proxiesOf(std::uint32_t number) {
        const std::uint32_t first = number % kProxies;
        const std::uint32_t second = (first + 1 + number / kProxies % (kProxies - 1)) % kProxies;
        return {&proxies_[first], &proxies_[second]};
    }
    static Uids uniqueIds(const std::pair<btBroadphaseProxy*, btBroadphaseProxy*>& proxies) {
        return std::minmax({proxies.first->m_uniqueId, proxies.second->m_uniqueId});
    }
    static bool groupsPair(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
        return (a.m_collisionFilterGroup & b.m_collisionFilterMask) != 0 &&
               (b.m_collisionFilterGroup & a.m_collisionFilterMask) != 0;
    }

    void add(Arguments& arguments) {
        const auto [a, b] = proxiesOf(arguments);
        const bool asks = arguments.flag();
        story_.tell(asks ? "add " : "add accepted ", a->m_uniqueId, '-', b->m_uniqueId);
        const bool isIn = !asks || groupsPair(*a, *b) || expected_.contains(uniqueIds({a, b}));
        btBroadphasePair* const pair =
            asks ? cache_.addOverlappingPair(a, b) : cache_.addAcceptedPair(a, b);
        // A pair that is there already, but which the filter refuses, is not returned.
        EXPECT_TRUE(pair == nullptr || uidsOf(*pair) == uniqueIds({a, b}));
        EXPECT_TRUE(pair != nullptr || (asks && !groupsPair(*a, *b)));
        if (isIn) {
            expected_.insert(uniqueIds({a, b}));
        }
    }

    void removeOne(Arguments& arguments) {
        const auto [a, b] = proxiesOf(arguments);
        story_.tell("remove ", a->m_uniqueId, '-', b->m_uniqueId);
        cache_.removeOverlappingPair(a, b, nullptr);
        expected_.erase(uniqueIds({a, b}));
        EXPECT_EQ(cache_.findPair(a, b), nullptr);
    }

    // Died and born may name what is not there, or there already; never the same pair in both.
    void update(Arguments& arguments) {
        const std::uint32_t diedCount = arguments.byte();
        const std::uint32_t bornCount = arguments.byte();
        story_.tell("update with ", diedCount, " that die and ", bornCount, " that are born");
        Random random = arguments.random();
        std::set<Uids> named;
        std::vector<BulletProxyPair> died;
        std::vector<BulletProxyPair> born;
        for (std::uint32_t i = 0; i < diedCount + bornCount; ++i) {
            const auto drawn = proxiesOf(random.below(kProxies * (kProxies - 1)));
            if (!named.insert(uniqueIds(drawn)).second) {
                continue;
            }
            (i < diedCount ? died : born).emplace_back(*drawn.first, *drawn.second);
            if (i < diedCount) {
                expected_.erase(uniqueIds(drawn));
            } else {
                expected_.insert(uniqueIds(drawn));
            }
        }
        cache_.update(died, born, nullptr);
    }

    void removeAllOf(Arguments& arguments) {
        btBroadphaseProxy& proxy = any(arguments);
        story_.tell("remove all of ", proxy.m_uniqueId);
        cache_.removeOverlappingPairsContainingProxy(&proxy, nullptr);
        forget(proxy);
    }

    void removeAllOfMany(Arguments& arguments) {
        const std::uint32_t count = arguments.below(5);
        std::set<btBroadphaseProxy*> drawn;
        story_.tell("remove all of");
        for (std::uint32_t i = 0; i < count; ++i) {
            drawn.insert(&any(arguments));
        }
        std::vector<btBroadphaseProxy*> proxies(drawn.begin(), drawn.end());
        for (btBroadphaseProxy* const proxy : proxies) {
            story_.tell(' ', proxy->m_uniqueId);
            forget(*proxy);
        }
        cache_.removeOverlappingPairsContainingProxies(proxies, nullptr);
    }
    void forget(const btBroadphaseProxy& proxy) {
        std::erase_if(expected_, [&proxy](const Uids& ids) {
            return ids.first == proxy.m_uniqueId || ids.second == proxy.m_uniqueId;
        });
    }

    void process(Arguments& arguments) {
        RemoveSome callback;
        callback.divisor = static_cast<int>(arguments.below(6));
        btDispatcherInfo info;
        info.m_deterministicOverlappingPairs = arguments.flag();
        story_.tell("process all, of which go multiples of ", callback.divisor);
        cache_.processAllOverlappingPairs(&callback, nullptr, info);
        std::sort(callback.shown.begin(), callback.shown.end());
        EXPECT_EQ(callback.shown, std::vector<Uids>(expected_.begin(), expected_.end()));
        std::erase_if(expected_, [&callback](const Uids& ids) { return callback.isRemoved(ids); });
    }

    void sortAndLook(Arguments& arguments) { look(true, arguments); }
    void cleanAndLook(Arguments& arguments) { look(false, arguments); }
    void look(bool sorts, Arguments& arguments) {
        const auto [a, b] = proxiesOf(arguments);
        story_.tell(sorts ? "sort, and find " : "look, and find ", a->m_uniqueId, '-',
                    b->m_uniqueId);
        if (sorts) {
            cache_.sortOverlappingPairs(nullptr);
            cache_.releaseUnusedMemory();
        } else {
            cache_.cleanProxyFromPairs(a, nullptr);
        }
        EXPECT_EQ(static_cast<std::size_t>(cache_.getOverlappingPairArray().size()),
                  expected_.size());
        const btBroadphasePair* const pair = cache_.findPair(a, b);
        EXPECT_EQ(pair != nullptr, expected_.contains(uniqueIds({a, b})));
    }

    static constexpr std::array<void (CachePlay::*)(Arguments&), 10> kOwn{
        &CachePlay::add,
        &CachePlay::add,
        &CachePlay::removeOne,
        &CachePlay::update,
        &CachePlay::update,
        &CachePlay::removeAllOf,
        &CachePlay::removeAllOfMany,
        &CachePlay::process,
        &CachePlay::sortAndLook,
        &CachePlay::cleanAndLook};

    OperationLog& story_;
    std::array<btBroadphaseProxy, kProxies> proxies_;
    PairJournal ghosts_;
    bool hasGhosts_ = false;
    PairCache cache_;
    std::set<Uids> expected_;
};

}  // namespace

Verdict playCache(std::span<const Operation> operations, bool tellsStory) {
    return playLife<CachePlay>(operations, tellsStory);
}

}  // namespace hashphase::test
