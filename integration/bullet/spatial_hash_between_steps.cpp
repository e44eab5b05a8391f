// SPDX-License-Identifier: Zlib

// What happens to pairs between two calculations: some are found or asked about again, of some the
// shape changes, and some are taken out by the program.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/core/caught.hpp>
#include <broadphase/core/on_failure.hpp>
#include <integration/bullet/pair_cache.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// cleanProxyFromPairs() of Bullet's caches goes on with a pair whose contacts it has ended, although who is
// told of that may have changed the array. A second pass finds what a change has moved to the front.
void endContactsOf(const btBroadphaseProxy& proxy, btOverlappingPairCache& cache,
                   btDispatcher* dispatcher) {
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    for (bool isDone = dispatcher == nullptr; !isDone;) {
        isDone = true;
        for (int i = 0; i < pairs.size(); ++i) {
            const bool isOf = pairs[i].m_pProxy0 == &proxy || pairs[i].m_pProxy1 == &proxy;
            if (isOf && pairs[i].m_algorithm != nullptr) {
                btBroadphasePair pair = pairs[i];
                pairs[i].m_algorithm = nullptr;
                cache.cleanOverlappingPair(pair, dispatcher);
                isDone = false;
            }
        }
    }
}

}  // namespace

// All births at once: should memory run out, there are none.
void SpatialHashBroadphase::findPairsNow(const Proxy& proxy, btDispatcher* dispatcher) {
    followFilter();
    const PairChanges changes = pairs_.findPairsNow(proxy.id, cacheFilter());
    apply(changes, changes.born.size(), dispatcher);
}

void SpatialHashBroadphase::findGhostPairsNow(const Proxy& proxy, btDispatcher* dispatcher) {
    const std::vector<ProxyId> met = ghostsAt(proxy);
    if (!met.empty()) {
        followFilter();
        const PairChanges changes = pairs_.findPairsNow(proxy.id, met, cacheFilter());
        apply(changes, changes.born.size(), dispatcher);
    }
}

void SpatialHashBroadphase::refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    refilter(std::span(&proxy, 1), dispatcher);
}

void SpatialHashBroadphase::refilter(std::span<btBroadphaseProxy* const> proxies,
                                     btDispatcher* dispatcher) {
    std::vector<ProxyId> ids;
    ids.reserve(proxies.size());
    for (btBroadphaseProxy* proxy : proxies) {
        ids.push_back(checkedProxy(proxy)->id);
    }
    checkMayChange();
    followFilter();
    constexpr std::size_t kLargePart = 8;
    if (proxies.size() > grid_.size() / kLargePart) {
        noteGroupsOfAll();
    } else if (groupsDecide_) {
        for (btBroadphaseProxy* proxy : proxies) {
            noteGroupsAround(*checkedProxy(proxy));
        }
    }
    const PairChanges changes = pairs_.refilter(ids, cacheFilter());
    apply(changes, changes.born.size(), dispatcher);
    std::sort(ids.begin(), ids.end());
    const auto isNamed = [&](const btBroadphaseProxy* proxy) {
        return std::binary_search(ids.begin(), ids.end(), idOf(proxy));
    };
    const auto isPair = [&](const btBroadphasePair& pair) {
        return (!isNamed(pair.m_pProxy0) && !isNamed(pair.m_pProxy1)) || isAccepted(pair);
    };
    removeDeferred(isPair, dispatcher);
}

void SpatialHashBroadphase::refilterAll(btDispatcher* dispatcher) {
    checkMayChange();
    followFilter();
    noteGroupsOfAll();
    const PairChanges changes = pairs_.refilterAll(cacheFilter());
    apply(changes, changes.born.size(), dispatcher);
    removeDeferred([this](const btBroadphasePair& pair) { return isAccepted(pair); }, dispatcher);
}

// A pair that the program has taken out of the cache is one as before, unless the filter refuses it by now.
void SpatialHashBroadphase::putBackWhatWasTakenOut(btDispatcher* dispatcher) {
    watch_.prune();
    if (watch_.takenOut == nullptr) {
        return;
    }
    const detail::OnFailure askAboutAll([&] { watch_.isMoreTakenOut = true; });
    std::vector<BulletProxyPair> bulletPairs = *watch_.takenOut;
    std::vector<ProxyPair> pairs;
    pairs.reserve(bulletPairs.size());
    for (const BulletProxyPair& pair : bulletPairs) {
        pairs.push_back(pairOf(pair.lower(), pair.upper()));
    }
    static_cast<void>(pairs_.refilter(pairs, cacheFilter()));
    std::erase_if(bulletPairs, [&](const BulletProxyPair& pair) {
        return !pairs_.isPair(pairOf(pair.lower(), pair.upper()));
    });
    watch_.takenOut = nullptr;
    applyToCache({}, bulletPairs, dispatcher);
}

// Where not all are noted, for want of memory: all are asked about, and then compared.
void SpatialHashBroadphase::askIfMoreWasTakenOut(btDispatcher* dispatcher) {
    if (watch_.isMoreTakenOut) {
        refilterAll(dispatcher);
        isCacheBehind_ = true;
        watch_.forget();
    }
}

void SpatialHashBroadphase::shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    checkMayChange();
    Proxy* own = checkedProxy(proxy);
    if (watch_.cache != nullptr) {
        watch_.cache->renewPairsContainingProxy(own, dispatcher);
    } else if (pairCache_->hasDeferredRemoval()) {
        endContactsOf(*own, *pairCache_, dispatcher);
    } else {
        renewPairsOfOtherCache(*own, dispatcher);
    }
}

void SpatialHashBroadphase::renewPairsOfOtherCache(btBroadphaseProxy& proxy,
                                                   btDispatcher* dispatcher) {
    std::vector<BulletProxyPair> bulletPairs;
    const btBroadphasePairArray& pairs = pairCache_->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        const btBroadphasePair& pair = pairs[i];
        if (pair.m_pProxy0 == &proxy || pair.m_pProxy1 == &proxy) {
            bulletPairs.emplace_back(*pair.m_pProxy0, *pair.m_pProxy1);
        }
    }
    for (const BulletProxyPair& pair : bulletPairs) {
        if (pair.isUpToDate()) {  // a callback may have destroyed one of the two
            pairCache_->removeOverlappingPair(pair.lower(), pair.upper(), dispatcher);
        }
        if (pair.isUpToDate()) {
            pairCache_->addOverlappingPair(pair.lower(), pair.upper());
        }
    }
}

// Caches with deferred removal ignore removeOverlappingPair() and keep duplicates; their user is to
// sort the array, free what is doubled or no pair any more, and cut it off: at the end of a step what
// is apart, after recacheFilter() what the filter refuses. The array is cut before anything is freed,
// for callbacks may change it, and destroy proxies of pairs that are yet to be freed.
void SpatialHashBroadphase::removeDeferred(IsPair isPair, btDispatcher* dispatcher) {
    if (!pairCache_->hasDeferredRemoval()) {
        return;
    }
    btBroadphasePairArray& pairs = pairCache_->getOverlappingPairArray();
    pairs.quickSort(btBroadphasePairSortPredicate());
    btBroadphasePairArray cut;
    int kept = 0;
    for (int i = 0; i < pairs.size(); ++i) {
        const bool isDouble = kept > 0 && pairs[i] == pairs[kept - 1];
        if (!isDouble && isPair(pairs[i])) {
            pairs.swap(kept++, i);
        } else {
            cut.push_back(pairs[i]);
        }
    }
    pairs.resize(kept);
    if (cut_ != nullptr) {  // within a callback of a pair that leaves
        for (int i = 0; i < cut.size(); ++i) {
            cut_->push_back(cut[i]);
        }
        return;
    }
    cut_ = &cut;
    const detail::QueryScope scope(pairCache_, detail::QueryScope::Changes::allowed);
    const detail::OnFailure freeOthers([&] {  // the cache holds them no more
        while (cut.size() > 0) {
            static_cast<void>(detail::exceptionOf([&] { freeCut(nullptr, dispatcher); }));
        }
        cut_ = nullptr;
    });
    freeCut(nullptr, dispatcher);
    cut_ = nullptr;
}

// Of one proxy, or of all.
void SpatialHashBroadphase::freeCut(const btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    for (int i = 0; cut_ != nullptr && i < cut_->size();) {
        btBroadphasePair pair = cut_->at(i);
        if (proxy == nullptr || pair.m_pProxy0 == proxy || pair.m_pProxy1 == proxy) {
            cut_->swap(i, cut_->size() - 1);
            cut_->pop_back();
            pairCache_->cleanOverlappingPair(pair, dispatcher);
            i = 0;  // a callback may have freed others
        } else {
            ++i;
        }
    }
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
