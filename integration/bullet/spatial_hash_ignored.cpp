// SPDX-License-Identifier: Zlib

// Pairs that are ignored: named by the program, or by Bullet's lists of objects without collision checks.

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <broadphase/core/flat_set.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

const btCollisionObject* objectOf(const btBroadphaseProxy& proxy) {
    return static_cast<const btCollisionObject*>(proxy.m_clientObject);
}

// As btCollisionDispatcher::needsCollision() asks: either may refuse.
bool doesDispatcherRefuse(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    const btCollisionObject* const first = objectOf(a);
    const btCollisionObject* const second = objectOf(b);
    return first != nullptr && second != nullptr &&
           (!first->checkCollideWith(second) || !second->checkCollideWith(first));
}

std::uint64_t addressOf(const void* object) {
    return static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(object));
}

// Bullet's object returns its list only where it is not constant.
template <class Visit>
void forEachListed(const btBroadphaseProxy& proxy, const Visit& visit) {
    auto* const object = static_cast<btCollisionObject*>(proxy.m_clientObject);
    const int count = object != nullptr ? object->getNumObjectsWithoutCollision() : 0;
    for (int i = 0; i < count; ++i) {
        visit(addressOf(object->getObjectWithoutCollision(i)));
    }
}

}  // namespace

void SpatialHashBroadphase::ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                       btDispatcher* dispatcher) {
    HASHPHASE_ASSERT(a != b,
                     "ignorePair(): both proxies are the same. Pass two different proxies.");
    const ProxyPair pair = pairOf(checkedProxy(a), checkedProxy(b));
    ignore(std::span(&pair, 1), dispatcher);
}

void SpatialHashBroadphase::stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b,
                                             btDispatcher* dispatcher) {
    const ProxyPair pair = pairOf(checkedProxy(a), checkedProxy(b));
    stopIgnoring(std::span(&pair, 1), dispatcher);
}

bool SpatialHashBroadphase::isIgnoredPair(const btBroadphaseProxy* a,
                                          const btBroadphaseProxy* b) const {
    return pairs_.isIgnored(pairOf(a, b));
}

void SpatialHashBroadphase::collisionChecksChanged(btBroadphaseProxy* proxy,
                                                   btDispatcher* dispatcher) {
    collisionChecksChanged(std::span(&proxy, 1), dispatcher);
}

// All that is to be done is known before the first callback may change anything.
void SpatialHashBroadphase::collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                                   btDispatcher* dispatcher) {
    ProxyPairs refused;
    ProxyPairs accepted;
    listPairsToIgnore(proxies, refused);
    listPairsToIgnoreNoMore(proxies, accepted);
    ignore(refused, dispatcher);
    stopIgnoring(accepted, dispatcher);
}

// A list may name what is in no world, or not alive: its objects are looked up among the clients.
void SpatialHashBroadphase::listPairsToIgnore(std::span<btBroadphaseProxy* const> proxies,
                                              ProxyPairs& pairs) const {
    detail::FlatSet listed;
    for (btBroadphaseProxy* const proxy : proxies) {
        forEachListed(*checkedProxy(proxy),
                      [&](std::uint64_t address) { listed.findOrInsert(address); });
    }
    if (listed.size() == 0) {
        return;
    }
    std::vector<const Proxy*> found(listed.size(), nullptr);
    for (std::uint32_t slot = 0; slot < uniqueIds_.size(); ++slot) {
        if (uniqueIds_[slot] != 0) {
            const Proxy& proxy = *proxyAt(slot);
            const std::uint32_t number = listed.find(addressOf(proxy.m_clientObject));
            if (number != detail::FlatSet::kNone) {
                found[number] = &proxy;
            }
        }
    }
    for (btBroadphaseProxy* const proxy : proxies) {
        forEachListed(*proxy, [&](std::uint64_t address) {
            const Proxy* const other = found[listed.find(address)];
            if (other != nullptr && other != proxy && doesDispatcherRefuse(*proxy, *other)) {
                pairs.push_back(pairOf(proxy, other));
            }
        });
    }
}

void SpatialHashBroadphase::listPairsToIgnoreNoMore(std::span<btBroadphaseProxy* const> proxies,
                                                    ProxyPairs& pairs) const {
    std::vector<ProxyId> ids;
    ids.reserve(proxies.size());
    for (const btBroadphaseProxy* const proxy : proxies) {
        ids.push_back(idOf(proxy));
    }
    std::sort(ids.begin(), ids.end());
    pairs_.collectIgnored(pairs);
    std::erase_if(pairs, [&](const ProxyPair& pair) {
        const bool isNamed = std::binary_search(ids.begin(), ids.end(), pair.first) ||
                             std::binary_search(ids.begin(), ids.end(), pair.second);
        return !isNamed ||
               doesDispatcherRefuse(*proxyAt(pair.first.index), *proxyAt(pair.second.index));
    });
}

void SpatialHashBroadphase::ignore(std::span<const ProxyPair> pairs, btDispatcher* dispatcher) {
    checkMayChange();
    const PairChanges changes = pairs_.ignore(pairs);
    apply(changes, changes.born.size(), dispatcher);
    const auto isLeft = [this](const btBroadphasePair& pair) {
        return !isIgnoredPair(pair.m_pProxy0, pair.m_pProxy1);
    };
    removeDeferred(isLeft, dispatcher);
}

void SpatialHashBroadphase::stopIgnoring(std::span<const ProxyPair> pairs,
                                         btDispatcher* dispatcher) {
    checkMayChange();
    followFilter();
    for (const auto& [first, second] : pairs) {
        for (const ProxyId id : {first, second}) {
            if (groupsDecide_ && grid_.contains(id)) {
                noteGroups(*proxyAt(id.index));
            }
        }
    }
    const PairChanges changes = pairs_.stopIgnoring(pairs, cacheFilter());
    apply(changes, changes.born.size(), dispatcher);
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
