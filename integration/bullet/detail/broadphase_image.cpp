// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/broadphase_image.hpp>

#include <broadphase/core/copy_parts.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <integration/bullet/detail/contact_image.hpp>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <algorithm>
#include <utility>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

template <class Visit>
void BroadphaseImage::forEachKept(auto& broadphase, auto& image, const Visit& visit) {
    visit(broadphase.uniqueIds_, image.uniqueIds_);
    visit(broadphase.lastUniqueId_, image.lastUniqueId_);
    visit(broadphase.groupsDecide_, image.groupsDecide_);
    visit(broadphase.mustNoteGroups_, image.mustNoteGroups_);
    visit(broadphase.isCacheBehind_, image.isCacheBehind_);
    visit(broadphase.groupKinds_, image.groupKinds_);
    visit(broadphase.changedKinds_, image.changedKinds_);
    visit(broadphase.seen_, image.seen_);
    visit(broadphase.seenCount_, image.seenCount_);
    visit(broadphase.ghosts_, image.ghosts_);
    visit(broadphase.mayGrow_, image.mayGrow_);
    visit(broadphase.watch_.isMoreTakenOut, image.isMoreTakenOut_);
}

std::string BroadphaseImage::faultOf(const SpatialHashBroadphase& broadphase) {
    const PairCache* const cache = broadphase.watch_.cache;
    if (cache == nullptr) {
        return "The broadphase's pair cache is not a hashphase::PairCache, which a snapshot needs. "
               "Make the broadphase with one.";
    }
    if (broadphase.isWorld()) {
        return "The broadphase is a world of a WorldsBroadphase, which snapshots do not support. "
               "Use a SpatialHashBroadphase for the world.";
    }
    const bool isWithin = cache->processDepth_ > 0 || broadphase.isApplying_ ||
                          QueryScope::isWithin(cache) || broadphase.isCalculating() ||
                          QueryScope::isWithin(&broadphase.grid_.store());
    return isWithin ? "The snapshot was used from a callback of the broadphase or of its pair "
                      "cache. Use it between steps."
                    : std::string();
}

void BroadphaseImage::save(const SpatialHashBroadphase& broadphase) {
    grid_.save(broadphase.pairs_);
    proxies_.clear();
    for (std::uint32_t slot = 0; slot < broadphase.uniqueIds_.size(); ++slot) {
        proxies_.push_back(*broadphase.proxyAt(slot));
    }
    forEachKept(broadphase, *this, [](const auto& member, auto& copy) {
        MakeRoomForParts{}(copy, member);
        CopyParts{}(copy, member);
    });
    const PairCache& cache = *broadphase.watch_.cache;
    const auto indexOf = [](const btBroadphaseProxy* proxy) {
        return SpatialHashBroadphase::idOf(proxy).index;
    };
    pairs_.clear();
    for (const btBroadphasePair& pair : pairsOf(broadphase)) {
        pairs_.push_back({indexOf(pair.m_pProxy0), indexOf(pair.m_pProxy1), pair.m_internalInfo1});
    }
    retired_.clear();
    for (const PairCache::Retired& retired : cache.retired_) {
        retired_.push_back(retired.note);
    }
    isSorted_ = cache.isSorted_;
    takenOut_.clear();
    if (broadphase.watch_.takenOut != nullptr) {
        for (const BulletProxyPair& pair : *broadphase.watch_.takenOut) {
            if (pair.isUpToDate()) {
                takenOut_.push_back({indexOf(pair.lower()), indexOf(pair.upper()), nullptr});
            }
        }
    }
}

void BroadphaseImage::makeRoom(SpatialHashBroadphase& broadphase) const {
    grid_.makeRoom(broadphase.pairs_);
    broadphase.proxies_.reserve(proxies_.size());
    forEachKept(broadphase, *this,
                [](auto& member, const auto& copy) { MakeRoomForParts{}(member, copy); });
    PairCache& cache = *broadphase.watch_.cache;
    cache.ids_.reserve(pairs_.size());
    cache.pairs_.reserve(static_cast<int>(pairs_.size()));
    ensureCapacity(cache.retired_, retired_.size());
    ensureCapacity(algorithms_, pairs_.size());
    takenOutAgain_ = nullptr;
    if (!takenOut_.empty()) {
        takenOutAgain_ = std::make_unique<std::vector<BulletProxyPair>>();
        takenOutAgain_->reserve(takenOut_.size());
    }
}

void BroadphaseImage::restore(SpatialHashBroadphase& broadphase,
                              btDispatcher* dispatcher) const noexcept {
    // By the clients of then and of now, before these are put back.
    PairCache& cache = *broadphase.watch_.cache;
    algorithms_.assign(pairs_.size(), nullptr);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const Broadphase::Proxy& first = proxies_[pairs_[i].first];
        const Broadphase::Proxy& second = proxies_[pairs_[i].second];
        const bool areThere = pairs_[i].first < broadphase.uniqueIds_.size() &&
                              pairs_[i].second < broadphase.uniqueIds_.size();
        if (!areThere) {
            continue;
        }
        btBroadphaseProxy& firstNow = *broadphase.proxyAt(pairs_[i].first);
        btBroadphaseProxy& secondNow = *broadphase.proxyAt(pairs_[i].second);
        if (firstNow.m_clientObject == first.m_clientObject &&
            secondNow.m_clientObject == second.m_clientObject) {
            btBroadphasePair* const pair = cache.findPair(&firstNow, &secondNow);
            algorithms_[i] = pair != nullptr && pair->m_pProxy0 == &firstNow
                                 ? std::exchange(pair->m_algorithm, nullptr)
                                 : nullptr;
        }
    }
    for (btBroadphasePair& pair : pairsOf(broadphase)) {
        freeQuietly(pair.m_algorithm, dispatcher);
    }
    for (const PairCache::Retired& retired : cache.retired_) {
        freeQuietly(retired.pair.m_algorithm, dispatcher);
    }
    grid_.restore(broadphase.pairs_);
    restoreProxies(broadphase);
    restoreCache(broadphase, dispatcher);
    restoreTakenOut(broadphase);
}

void BroadphaseImage::restoreProxies(SpatialHashBroadphase& broadphase) const noexcept {
    for (auto slot = static_cast<std::uint32_t>(proxies_.size());
         slot < broadphase.uniqueIds_.size(); ++slot) {
        *broadphase.proxyAt(slot) = {};
    }
    for (std::uint32_t slot = 0; slot < proxies_.size(); ++slot) {
        *broadphase.proxyAt(slot) = proxies_[slot];
    }
    forEachKept(broadphase, *this,
                [](auto& member, const auto& copy) { CopyParts{}(member, copy); });
}

void BroadphaseImage::restoreCache(SpatialHashBroadphase& broadphase,
                                   btDispatcher* dispatcher) const noexcept {
    PairCache& cache = *broadphase.watch_.cache;
    cache.pairs_.resizeNoInitialize(0);
    cache.ids_.clear();
    cache.dropChains();
    cache.retired_.clear();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        btBroadphasePair pair;
        pair.m_pProxy0 = broadphase.proxyAt(pairs_[i].first);
        pair.m_pProxy1 = broadphase.proxyAt(pairs_[i].second);
        pair.m_algorithm = algorithms_[i];
        pair.m_internalInfo1 = pairs_[i].info;
        cache.pairs_.push_back(pair);
        cache.ids_.findOrInsert(BulletProxyPair(*pair.m_pProxy0, *pair.m_pProxy1).ids());
    }
    for (const PairCache::PairSortKey& note : retired_) {
        cache.retired_.push_back({note, {}, dispatcher});
        cache.retired_.back().pair.m_algorithm = nullptr;
    }
    cache.isSorted_ = isSorted_;
}

void BroadphaseImage::restoreTakenOut(SpatialHashBroadphase& broadphase) const noexcept {
    for (const Pair& pair : takenOut_) {
        takenOutAgain_->emplace_back(*broadphase.proxyAt(pair.first),
                                     *broadphase.proxyAt(pair.second));
    }
    broadphase.watch_.takenOut = std::move(takenOutAgain_);
}

std::span<btBroadphasePair> BroadphaseImage::pairsOf(
    const SpatialHashBroadphase& broadphase) noexcept {
    btBroadphasePairArray& pairs = broadphase.watch_.cache->pairs_;
    return pairs.size() == 0 ? std::span<btBroadphasePair>()
                             : std::span(&pairs[0], static_cast<std::size_t>(pairs.size()));
}

void BroadphaseImage::freeAlgorithmsOf(const SpatialHashBroadphase& broadphase,
                                       const ObjectNumbers& clients, btDispatcher& dispatcher) {
    for (btBroadphasePair& pair : pairsOf(broadphase)) {
        if (clients.has(pair.m_pProxy0->m_clientObject) ||
            clients.has(pair.m_pProxy1->m_clientObject)) {
            freeQuietly(std::exchange(pair.m_algorithm, nullptr), &dispatcher);
        }
    }
}

std::size_t BroadphaseImage::retiredCount(const SpatialHashBroadphase& broadphase) noexcept {
    return broadphase.watch_.cache->retired_.size();
}

btCollisionAlgorithm*& BroadphaseImage::retired(const SpatialHashBroadphase& broadphase,
                                                std::size_t i) noexcept {
    return broadphase.watch_.cache->retired_[i].pair.m_algorithm;
}

btBroadphaseProxy* BroadphaseImage::proxyAt(const SpatialHashBroadphase& broadphase,
                                            std::uint32_t index) noexcept {
    return broadphase.proxyAt(index);
}

std::size_t BroadphaseImage::memoryBytes() const noexcept {
    return sizeof(*this) + grid_.memoryBytes() + proxies_.capacity() * sizeof(proxies_[0]) +
           uniqueIds_.capacity() * sizeof(int) + seen_.capacity() * sizeof(seen_[0]) +
           (ghosts_ != nullptr ? sizeof(*ghosts_) + ghosts_->memoryBytes() : 0) +
           (pairs_.capacity() + takenOut_.capacity()) * sizeof(Pair) +
           retired_.capacity() * sizeof(retired_[0]) + algorithms_.capacity() * sizeof(void*);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
