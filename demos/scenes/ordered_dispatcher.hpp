// SPDX-License-Identifier: Zlib
#pragma once

// Contact manifolds in an order that depends on nothing but the pair sets.

#include <btBulletCollisionCommon.h>

#include <algorithm>

namespace hashphase::demos {

/// Lists contact manifolds in the order of their creation. Bullet's own dispatcher fills the gap
/// that a manifold leaves with the last one, so that results depend on the order in which the pairs
/// of one step are removed; a pair set has no such order. Together with a canonical PairCache, all
/// broadphases with the same pair sets give the same trajectories.
class OrderedDispatcher : public btCollisionDispatcher {
public:
    using btCollisionDispatcher::btCollisionDispatcher;

    btPersistentManifold* getNewManifold(const btCollisionObject* a,
                                         const btCollisionObject* b) override {
        btPersistentManifold* const manifold = btCollisionDispatcher::getNewManifold(a, b);
        manifold->m_companionIdA = ++createdCount_;  // Bullet itself has no use for it
        return manifold;
    }

    void dispatchAllCollisionPairs(btOverlappingPairCache* pairCache,
                                   const btDispatcherInfo& dispatchInfo,
                                   btDispatcher* dispatcher) override {
        btCollisionDispatcher::dispatchAllCollisionPairs(pairCache, dispatchInfo, dispatcher);
        if (m_manifoldsPtr.size() == 0) {
            return;
        }
        const auto isOlder = [](const btPersistentManifold* a, const btPersistentManifold* b) {
            return a->m_companionIdA < b->m_companionIdA;
        };
        std::sort(&m_manifoldsPtr[0], &m_manifoldsPtr[0] + m_manifoldsPtr.size(), isOlder);
        for (int i = 0; i < m_manifoldsPtr.size(); ++i) {
            m_manifoldsPtr[i]->m_index1a = i;
        }
    }

private:
    int createdCount_ = 0;
};

}  // namespace hashphase::demos
