// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/other_cache.hpp>

#include <broadphase/core/query_scope.hpp>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

/// Lives while the cache calls others, as within a PairCache.
class CacheScope : QueryScope {
public:
    explicit CacheScope(const btOverlappingPairCache& cache) noexcept
        : QueryScope(&cache, Changes::allowed) {}
};

bool endContacts(btBroadphasePair& pair, btOverlappingPairCache& cache, btDispatcher* dispatcher) {
    if (pair.m_algorithm == nullptr || dispatcher == nullptr) {
        return false;
    }
    btBroadphasePair ended = pair;
    pair.m_algorithm = nullptr;
    cache.cleanOverlappingPair(ended, dispatcher);
    return true;
}

}  // namespace

void endContactsOf(const btBroadphaseProxy& proxy, btOverlappingPairCache& cache,
                   btDispatcher* dispatcher) {
    const CacheScope scope(cache);
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    // A pass more after one that ended some: callbacks may have moved pairs to where it had been.
    for (bool isDone = dispatcher == nullptr; !isDone;) {
        isDone = true;
        for (int i = 0; i < pairs.size(); ++i) {
            if ((pairs[i].m_pProxy0 == &proxy || pairs[i].m_pProxy1 == &proxy) &&
                endContacts(pairs[i], cache, dispatcher)) {
                isDone = false;
            }
        }
    }
}

void removePair(const BulletProxyPair& pair, btOverlappingPairCache& cache,
                btDispatcher* dispatcher) {
    if (!pair.isUpToDate()) {
        return;
    }
    const CacheScope scope(cache);
    if (!cache.hasDeferredRemoval()) {
        if (btBroadphasePair* const kept = cache.findPair(pair.lower(), pair.upper())) {
            static_cast<void>(endContacts(*kept, cache, dispatcher));
        }
    }
    if (pair.isUpToDate()) {
        cache.removeOverlappingPair(pair.lower(), pair.upper(), dispatcher);
    }
}

void removePairsOf(btBroadphaseProxy& proxy, btOverlappingPairCache& cache,
                   btDispatcher* dispatcher) {
    endContactsOf(proxy, cache, dispatcher);
    const CacheScope scope(cache);
    cache.removeOverlappingPairsContainingProxy(&proxy, dispatcher);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
