// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/ghost_image.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <integration/bullet/detail/bullet_members.hpp>

#include <algorithm>
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

// Not pair by pair: of those whose other proxy is gone, the cache would find none.
void GhostImage::detach(btPairCachingGhostObject& ghost) const {
    btHashedOverlappingPairCache& cache = *ghost.getOverlappingPairCache();
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
        detached_.push_back(
            {{&ghost, pairs[i].m_pProxy0->m_clientObject, pairs[i].m_pProxy1->m_clientObject},
             std::exchange(pairs[i].m_algorithm, nullptr)});
    }
    PairCacheMembers::clear(cache);
}

void GhostImage::endDetach() const {
    std::ranges::sort(detached_,
                      [](const Detached& a, const Detached& b) { return a.isBefore(b.place); });
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
        const std::array<const void*, 3> place{&ghost, first->m_clientObject,
                                               second->m_clientObject};
        const auto found = std::lower_bound(
            detached_.begin(), detached_.end(), place,
            [](const Detached& detached, const auto& at) { return detached.isBefore(at); });
        const bool isThere = found != detached_.end() && found->place == place;
        btCollisionAlgorithm* const algorithm =
            isThere ? std::exchange(found->algorithm, nullptr) : nullptr;
        btBroadphasePair& pair = *cache.addOverlappingPair(first, second);
        pair.m_internalInfo1 = saved.info;
        pair.m_algorithm = contacts.restore(algorithm, pair, dispatcher);
    }
    cache.setOverlapFilterCallback(filter);
}

void GhostImage::freeAlgorithmsOf(const ObjectNumbers& clients,
                                  btCollisionDispatcher& dispatcher) const {
    for (Detached& detached : detached_) {
        if (clients.has(detached.place[1]) || clients.has(detached.place[2])) {
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
