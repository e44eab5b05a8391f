// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/ghost_image.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <utility>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

/// A pair that was there is there again, whatever groups and masks have become.
struct AcceptAll final : btOverlapFilterCallback {
    bool needBroadphaseCollision(btBroadphaseProxy* /*a*/,
                                 btBroadphaseProxy* /*b*/) const override {
        return true;
    }
};

}  // namespace

int GhostImage::save(btPairCachingGhostObject& ghost, ContactImage& contacts) {
    btHashedOverlappingPairCache& cache = *ghost.getOverlappingPairCache();
    const btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        pairs_.push_back({SpatialHashBroadphase::idOf(pairs[i].m_pProxy0).index,
                          SpatialHashBroadphase::idOf(pairs[i].m_pProxy1).index,
                          pairs[i].m_internalInfo1});
        contacts.save(pairs[i]);
    }
    return pairs.size();
}

void GhostImage::makeRoom(std::size_t pairCount) const {
    ensureCapacity(detached_, pairCount);
}

void GhostImage::detach(btPairCachingGhostObject& ghost) const {
    btHashedOverlappingPairCache& cache = *ghost.getOverlappingPairCache();
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    while (pairs.size() > 0) {
        btBroadphasePair& pair = pairs[pairs.size() - 1];
        detached_.push_back({&ghost,
                             {pair.m_pProxy0->m_clientObject, pair.m_pProxy1->m_clientObject},
                             std::exchange(pair.m_algorithm, nullptr)});
        cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, nullptr);
    }
}

void GhostImage::restore(btPairCachingGhostObject& ghost, int pairCount,
                         const SpatialHashBroadphase& broadphase, const ContactImage& contacts,
                         btCollisionDispatcher& dispatcher) const {
    btHashedOverlappingPairCache& cache = *ghost.getOverlappingPairCache();
    btOverlapFilterCallback* const filter = cache.getOverlapFilterCallback();
    AcceptAll acceptAll;
    cache.setOverlapFilterCallback(&acceptAll);
    for (int i = 0; i < pairCount; ++i) {
        const Pair& saved = pairs_[at_++];
        btBroadphaseProxy* const first = BroadphaseImage::proxyAt(broadphase, saved.first);
        btBroadphaseProxy* const second = BroadphaseImage::proxyAt(broadphase, saved.second);
        btCollisionAlgorithm* algorithm = nullptr;
        for (Detached& detached : detached_) {
            if (detached.ghost == &ghost && detached.clients[0] == first->m_clientObject &&
                detached.clients[1] == second->m_clientObject) {
                algorithm = std::exchange(detached.algorithm, nullptr);
            }
        }
        btBroadphasePair& pair = *cache.addOverlappingPair(first, second);
        pair.m_internalInfo1 = saved.info;
        pair.m_algorithm = contacts.restore(algorithm, pair, dispatcher);
    }
    cache.setOverlapFilterCallback(filter);
}

void GhostImage::freeAlgorithmsOf(const void* client, btCollisionDispatcher& dispatcher) const {
    for (Detached& detached : detached_) {
        if (detached.clients[0] == client || detached.clients[1] == client) {
            freeQuietly(std::exchange(detached.algorithm, nullptr), &dispatcher);
        }
    }
}

void GhostImage::endRestore(btCollisionDispatcher& dispatcher) const {
    for (const Detached& detached : detached_) {
        freeQuietly(detached.algorithm, &dispatcher);
    }
    detached_.clear();
}

// Two ghosts may list the same pair.
void GhostImage::write(ByteWriter& to) const {
    to.write(static_cast<std::uint32_t>(pairs_.size()));
    for (const Pair& pair : pairs_) {
        BroadphaseImage::writePairs({&pair, 1}, to);
    }
}

bool GhostImage::read(ByteReader& from, const BroadphaseImage& broadphase) {
    const auto count = from.read<std::uint32_t>();
    pairs_.clear();
    std::vector<Pair> one;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (!broadphase.readPairs(from, one) || one.size() != 1) {
            return false;
        }
        pairs_.push_back(one.front());
    }
    return true;
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
