// SPDX-License-Identifier: Zlib
//
// Many proxies at once, with the result of as many single calls.

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/prefetch.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <algorithm>
#include <iterator>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

void prefetchAhead(std::span<btBroadphaseProxy* const> proxies, std::size_t i) noexcept {
    constexpr std::size_t kAhead = 8;
    if (i + kAhead < proxies.size()) {
        detail::prefetch(proxies[i + kAhead]);
    }
}

}  // namespace

void SpatialHashBroadphase::createProxies(std::span<const ProxyDefinition> definitions,
                                          std::span<btBroadphaseProxy*> proxies,
                                          btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(definitions.size() == proxies.size(),
                     "There is room for exactly one proxy a definition.");
    grid_.reserve(grid_.size() + definitions.size());
    proxies_.reserve(grid_.size() + definitions.size());
    detail::ensureCapacity(uniqueIds_, grid_.size() + definitions.size());
    for (std::size_t i = 0; i < definitions.size(); ++i) {
        const ProxyDefinition& each = definitions[i];
        proxies[i] = createProxy(each.aabbMin, each.aabbMax, INVALID_SHAPE_PROXYTYPE, each.userPtr,
                                 each.collisionFilterGroup, each.collisionFilterMask, dispatcher);
    }
}

void SpatialHashBroadphase::setAabbs(std::span<btBroadphaseProxy* const> proxies,
                                     std::span<const btVector3> aabbMins,
                                     std::span<const btVector3> aabbMaxs,
                                     btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(proxies.size() == aabbMins.size() && proxies.size() == aabbMaxs.size(),
                     "There is exactly one box a proxy.");
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        prefetchAhead(proxies, i);
        setAabb(proxies[i], aabbMins[i], aabbMaxs[i], dispatcher);
    }
}

void SpatialHashBroadphase::destroyProxies(std::span<btBroadphaseProxy* const> proxies,
                                           btDispatcher* dispatcher) {
    checkMayChange();
    const auto isDestroyed = [this](btBroadphaseProxy* proxy) {
        return checkedProxy(proxy)->id.isNull();
    };
    if (std::any_of(proxies.begin(), proxies.end(), isDestroyed)) {
        std::vector<btBroadphaseProxy*> others;
        std::remove_copy_if(proxies.begin(), proxies.end(), std::back_inserter(others),
                            isDestroyed);
        destroyProxies(others, dispatcher);
        return;
    }
    removePairsOf(proxies, dispatcher);
    // The second time that a proxy is named it is not alive any more, which is asserted.
    for (std::size_t i = 0; i < proxies.size(); ++i) {
        prefetchAhead(proxies, i);
        removeFromGrid(checkedProxy(proxies[i]));
    }
}

void SpatialHashBroadphase::removePairsOf(std::span<btBroadphaseProxy* const> proxies,
                                          btDispatcher* dispatcher) {
    if (watch_.cache == nullptr) {
        for (btBroadphaseProxy* proxy : proxies) {
            pairCache_->removeOverlappingPairsContainingProxy(proxy, dispatcher);
        }
        return;
    }
    try {
        watch_.cache->removePairsOf(proxies, dispatcher, PairCache::Remover::broadphase);
    } catch (...) {
        isCacheBehind_ = true;  // for nobody is destroyed
        throw;
    }
}

std::size_t SpatialHashBroadphase::shiftOrigin(const btVector3& shift) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "The origin is not shifted by callbacks of calculateOverlappingPairs().");
    const Vector3<btScalar> by = toEigen(shift);
    std::vector<std::uint32_t> few;  // of the proxies, where many more have gone
    if (8 * grid_.size() < uniqueIds_.size()) {
        few.reserve(grid_.size());
        grid_.forEach([&](ProxyId id, const Aabb<btScalar>&) { few.push_back(id.index); });
    }
    const std::size_t roundedCount = grid_.shiftOrigin(by);
    mustNoteGroups_ = mustNoteGroups_ || roundedCount > 0;
    const std::size_t count = few.empty() ? uniqueIds_.size() : few.size();
    for (std::size_t i = 0; i < count && by.allFinite(); ++i) {
        const std::uint32_t slot = few.empty() ? static_cast<std::uint32_t>(i) : few[i];
        if (uniqueIds_[slot] != 0) {
            Proxy& proxy = *proxyAt(slot);
            proxy.m_aabbMin -= shift;
            proxy.m_aabbMax -= shift;
        }
    }
    return roundedCount;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
