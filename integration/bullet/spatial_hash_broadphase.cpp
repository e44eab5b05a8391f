// SPDX-License-Identifier: Zlib
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/detail/prefetch.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/pair_cache.hpp>

#include <LinearMath/btGeometryUtil.h>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// Bullet's own interfaces have the same symbols in both precisions. This one has not: a program that
// links a Bullet of the other precision fails to link, with this name in the message.
extern bool (*const bulletOfTheSamePrecision)(const btAlignedObjectArray<btVector3>&,
                                              const btVector3&, btScalar);
bool (*const bulletOfTheSamePrecision)(const btAlignedObjectArray<btVector3>&, const btVector3&,
                                       btScalar) = &btGeometryUtil::isPointInsidePlanes;

SpatialHashBroadphase::SpatialHashBroadphase(btOverlappingPairCache* pairCache,
                                             const SpatialHashConfig& config)
    : config_(config), grid_(config.grid), pairCache_(pairCache) {
    if (pairCache_ == nullptr) {
        ownCache_ = new PairCache;
        pairCache_ = ownCache_;
    }
}

SpatialHashBroadphase::SpatialHashBroadphase(const SpatialHashConfig& config)
    : SpatialHashBroadphase(nullptr, config) {}

SpatialHashBroadphase::~SpatialHashBroadphase() {
    delete ownCache_;
}

btBroadphaseProxy* SpatialHashBroadphase::createProxy(const btVector3& aabbMin,
                                                      const btVector3& aabbMax, int /*shapeType*/,
                                                      void* userPtr, int collisionFilterGroup,
                                                      int collisionFilterMask,
                                                      btDispatcher* dispatcher) {
    if (freeProxies_.empty()) {
        freeProxies_.push_back(&proxies_.emplace_back());
    }
    Proxy& proxy = *freeProxies_.back();
    freeProxies_.pop_back();
    static_cast<btBroadphaseProxy&>(proxy) =
        btBroadphaseProxy(aabbMin, aabbMax, userPtr, collisionFilterGroup, collisionFilterMask);
    proxy.m_uniqueId = ++lastUniqueId_;

    const bool isStatic = (collisionFilterGroup & btBroadphaseProxy::StaticFilter) != 0;
    proxy.id = grid_.add(toAabb(aabbMin, aabbMax), isStatic ? Mobility::resting : Mobility::mobile);
    if (proxy.id.index >= bySlot_.size()) {
        bySlot_.resize(proxy.id.index + 1, nullptr);
    }
    bySlot_[proxy.id.index] = &proxy;
    announceIfEager(proxy, dispatcher);
    return &proxy;
}

void SpatialHashBroadphase::destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    Proxy* own = checkedProxy(proxy);
    pairCache_->removeOverlappingPairsContainingProxy(own, dispatcher);
    grid_.remove(own->id);
    bySlot_[own->id.index] = nullptr;
    own->id = {};
    own->m_clientObject = nullptr;
    freeProxies_.push_back(own);
}

void SpatialHashBroadphase::setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin,
                                    const btVector3& aabbMax, btDispatcher* dispatcher) {
    Proxy* own = checkedProxy(proxy);
    const Aabb<btScalar> box = toAabb(aabbMin, aabbMax);
    if (isSameBits(toAabb(own->m_aabbMin, own->m_aabbMax), box)) {
        return;
    }
    own->m_aabbMin = aabbMin;
    own->m_aabbMax = aabbMax;
    grid_.move(own->id, box);
    announceIfEager(*own, dispatcher);
}

void SpatialHashBroadphase::getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin,
                                    btVector3& aabbMax) const {
    aabbMin = proxy->m_aabbMin;
    aabbMax = proxy->m_aabbMax;
}

// Pairs name proxies all over the memory. What a later one will read is fetched while earlier ones
// are dealt with: its proxies first, then, by their unique ids, its place in the cache.
void SpatialHashBroadphase::prefetchProxies(std::span<const ProxyPair> pairs, std::size_t i) const {
    constexpr std::size_t kAhead = 16;
    if (i + kAhead < pairs.size()) {
        detail::prefetch(bySlot_[pairs[i + kAhead].first.index]);
        detail::prefetch(bySlot_[pairs[i + kAhead].second.index]);
    }
}

void SpatialHashBroadphase::prefetchPairs(std::span<const ProxyPair> pairs, std::size_t i) const {
    prefetchProxies(pairs, i);
    constexpr std::size_t kAhead = 8;
    if (ownCache_ == nullptr || i + kAhead >= pairs.size()) {
        return;
    }
    const Proxy* first = bySlot_[pairs[i + kAhead].first.index];
    const Proxy* second = bySlot_[pairs[i + kAhead].second.index];
    if (first != nullptr && second != nullptr) {
        ownCache_->prefetch(*first, *second);
    }
}

void SpatialHashBroadphase::askFilter(std::span<const ProxyPair> asked,
                                      std::span<char> accepted) const {
    for (std::size_t i = 0; i < asked.size(); ++i) {
        prefetchProxies(asked, i);
        accepted[i] = pairCache_->needsBroadphaseCollision(bySlot_[asked[i].first.index],
                                                           bySlot_[asked[i].second.index])
                          ? 1
                          : 0;
    }
}

void SpatialHashBroadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
    apply(pairs_.update(cacheFilter()), dispatcher);
    removeDeferred(nullptr, dispatcher);
}

void SpatialHashBroadphase::apply(const PairChanges& changes, btDispatcher* dispatcher) {
    for (std::size_t i = 0; i < changes.died.size(); ++i) {
        prefetchPairs(changes.died, i);
        Proxy* first = bySlot_[changes.died[i].first.index];
        Proxy* second = bySlot_[changes.died[i].second.index];
        // A destroyed proxy has taken its pairs with it.
        if (first != nullptr && second != nullptr) {
            pairCache_->removeOverlappingPair(first, second, dispatcher);
        }
    }
    for (std::size_t i = 0; i < changes.born.size(); ++i) {
        prefetchPairs(changes.born, i);
        Proxy* first = bySlot_[changes.born[i].first.index];
        Proxy* second = bySlot_[changes.born[i].second.index];
        if (ownCache_ != nullptr) {
            ownCache_->addAcceptedPair(first, second);
        } else {
            pairCache_->addOverlappingPair(first, second);
        }
    }
}

void SpatialHashBroadphase::announceIfEager(const Proxy& proxy, btDispatcher* dispatcher) {
    if ((proxy.m_collisionFilterGroup & config_.eagerGroups) != 0) {
        apply(pairs_.announce(proxy.id, cacheFilter()), dispatcher);
    }
}

void SpatialHashBroadphase::refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    const Proxy* own = checkedProxy(proxy);
    apply(pairs_.refilter(own->id, cacheFilter()), dispatcher);
    removeDeferred(own, dispatcher);
}

// Caches with deferred removal ignore removeOverlappingPair() and keep duplicates; their user is to
// sort the array, free what is doubled or no pair any more, and cut it off: at the end of a step what
// is apart, after recacheFilter() what the filter refuses of that proxy.
void SpatialHashBroadphase::removeDeferred(const btBroadphaseProxy* refiltered,
                                           btDispatcher* dispatcher) {
    if (!pairCache_->hasDeferredRemoval()) {
        return;
    }
    const auto isPair = [&](const btBroadphasePair& pair) {
        const btBroadphaseProxy& a = *pair.m_pProxy0;
        const btBroadphaseProxy& b = *pair.m_pProxy1;
        if (refiltered == nullptr) {
            return overlaps(toAabb(a.m_aabbMin, a.m_aabbMax), toAabb(b.m_aabbMin, b.m_aabbMax));
        }
        return (&a != refiltered && &b != refiltered) ||
               pairCache_->needsBroadphaseCollision(pair.m_pProxy0, pair.m_pProxy1);
    };
    btBroadphasePairArray& pairs = pairCache_->getOverlappingPairArray();
    pairs.quickSort(btBroadphasePairSortPredicate());
    int kept = 0;
    for (int i = 0; i < pairs.size(); ++i) {
        const bool isDouble = kept > 0 && pairs[i] == pairs[kept - 1];
        if (!isDouble && isPair(pairs[i])) {
            pairs.swap(kept++, i);
        } else {
            pairCache_->cleanOverlappingPair(pairs[i], dispatcher);
        }
    }
    pairs.resize(kept);
}

void SpatialHashBroadphase::getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const {
    Aabb<btScalar> all;
    grid_.forEach([&all](ProxyId, const Aabb<btScalar>& box) {
        if (!hasNan(box)) {
            all.extend(box);
        }
    });
    aabbMin = all.isEmpty() ? btVector3(0, 0, 0) : toBullet(all.min());
    aabbMax = all.isEmpty() ? btVector3(0, 0, 0) : toBullet(all.max());
}

void SpatialHashBroadphase::resetPool(btDispatcher* /*dispatcher*/) {
    if (grid_.size() == 0) {
        lastUniqueId_ = 0;
    }
}

btBroadphaseProxy* SpatialHashBroadphase::proxyOf(ProxyId id) const {
    HASHPHASE_ASSERT(grid_.contains(id), "Only an id of a proxy alive leads to a proxy.");
    return bySlot_[id.index];
}

ProxyId SpatialHashBroadphase::idOf(const btBroadphaseProxy* proxy) {
    return static_cast<const Proxy*>(proxy)->id;
}

SpatialHashBroadphase::Proxy* SpatialHashBroadphase::checkedProxy(btBroadphaseProxy* proxy) const {
    HASHPHASE_ASSERT(
        proxy != nullptr && grid_.contains(idOf(proxy)) && bySlot_[idOf(proxy).index] == proxy,
        "Only a proxy that this broadphase created and did not destroy can be used.");
    return static_cast<Proxy*>(proxy);
}

std::size_t SpatialHashBroadphase::memoryBytes() const noexcept {
    return grid_.memoryBytes() + pairs_.memoryBytes() + proxies_.size() * sizeof(Proxy) +
           (freeProxies_.capacity() + bySlot_.capacity()) * sizeof(Proxy*) +
           (ownCache_ != nullptr ? ownCache_->memoryBytes() : 0);
}

std::string SpatialHashBroadphase::validate() const {
    for (std::string error : {grid_.validate(), pairs_.validate()}) {
        if (!error.empty()) {
            return error;
        }
    }
    if (ownCache_ == nullptr) {
        return {};
    }
    if (static_cast<std::size_t>(ownCache_->getNumOverlappingPairs()) != pairs_.count()) {
        return "The cache holds as many pairs as the set of pairs: broken.";
    }
    return ownCache_->validate();
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
