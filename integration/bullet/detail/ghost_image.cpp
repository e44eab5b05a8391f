// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/ghost_image.hpp>

#include <broadphase/core/ensure_capacity.hpp>

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

void GhostImage::detach(btPairCachingGhostObject& ghost) const {
    btHashedOverlappingPairCache& cache = *ghost.getOverlappingPairCache();
    btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    while (pairs.size() > 0) {
        btBroadphasePair& pair = pairs[pairs.size() - 1];
        detached_.push_back({placeOf(ghost, *pair.m_pProxy0, *pair.m_pProxy1),
                             std::exchange(pair.m_algorithm, nullptr)});
        cache.removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, nullptr);
    }
}

void GhostImage::endDetach() const {
    std::ranges::sort(detached_, {}, &Detached::place);
}

std::array<std::uintptr_t, 3> GhostImage::placeOf(const btPairCachingGhostObject& ghost,
                                                  const btBroadphaseProxy& a,
                                                  const btBroadphaseProxy& b) noexcept {
    return {reinterpret_cast<std::uintptr_t>(&ghost),
            reinterpret_cast<std::uintptr_t>(a.m_clientObject),
            reinterpret_cast<std::uintptr_t>(b.m_clientObject)};
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
        const auto place = placeOf(ghost, *first, *second);
        const auto found = std::ranges::lower_bound(detached_, place, {}, &Detached::place);
        const bool isThere = found != detached_.end() && found->place == place;
        btCollisionAlgorithm* const algorithm =
            isThere ? std::exchange(found->algorithm, nullptr) : nullptr;
        btBroadphasePair& pair = *cache.addOverlappingPair(first, second);
        pair.m_internalInfo1 = saved.info;
        pair.m_algorithm = contacts.restore(algorithm, pair, dispatcher);
    }
    cache.setOverlapFilterCallback(filter);
}

void GhostImage::freeAlgorithmsOf(const void* client, btCollisionDispatcher& dispatcher) const {
    const auto address = reinterpret_cast<std::uintptr_t>(client);
    for (Detached& detached : detached_) {
        if (detached.place[1] == address || detached.place[2] == address) {
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
