// SPDX-License-Identifier: Zlib
#pragma once

// What a broadphase takes out of a pair cache that is not a PairCache.
//
// Contacts end first, each on a copy of its pair: Bullet's caches go on with a pair after those who are told
// of its end, and who may have destroyed other proxies, so that another pair is in its place.

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Frees the algorithms of all pairs of the proxy. Cost: two passes over all pairs. Without a dispatcher, nothing
/// happens, as in Bullet.
void endContactsOf(const btBroadphaseProxy& proxy, btOverlappingPairCache& cache,
                   btDispatcher* dispatcher);

/// Does nothing if one of the two has been destroyed.
void removePair(const BulletProxyPair& pair, btOverlappingPairCache& cache,
                btDispatcher* dispatcher);

void removePairsOf(btBroadphaseProxy& proxy, btOverlappingPairCache& cache,
                   btDispatcher* dispatcher);

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
