// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/broadphases.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <ostream>
#include <utility>

namespace hashphase::test {
namespace {

template <class Cache, auto... arguments>
std::unique_ptr<btOverlappingPairCache> makeCache() {
    return std::make_unique<Cache>(arguments...);
}

}  // namespace

void PrintTo(const CacheKind& kind, std::ostream* out) {
    *out << kind.name;
}

const std::vector<CacheKind>& cacheKinds() {
    static const std::vector<CacheKind> kKinds{
        {"own", [] { return std::unique_ptr<btOverlappingPairCache>(); }},
        {"arrival", makeCache<PairCache>},
        {"canonical", makeCache<PairCache, PairOrder::canonical>},
        {"hashed", makeCache<btHashedOverlappingPairCache>},
        {"deferred", makeCache<btSortedOverlappingPairCache>}};
    return kKinds;
}

std::unique_ptr<SpatialHashBroadphase> hashOver(btOverlappingPairCache* cache,
                                                const SpatialHashConfig& config) {
    if (auto* const ours = dynamic_cast<PairCache*>(cache)) {
        return std::make_unique<SpatialHashBroadphase>(ours, config);
    }
    return std::make_unique<SpatialHashBroadphase>(cache, config);
}

Player hashPlayer(int objectCount, std::unique_ptr<btOverlappingPairCache> cache,
                  const SpatialHashConfig& config) {
    auto broadphase = std::make_unique<SpatialHashBroadphase>(cache.get(), config);
    return Player(objectCount, std::move(broadphase), std::move(cache));
}

SpatialHashConfig eagerCharactersAndSensors() {
    SpatialHashConfig config;
    config.eagerGroups = btBroadphaseProxy::CharacterFilter | btBroadphaseProxy::SensorTrigger;
    return config;
}

SpatialHashBroadphase& hashOf(const Player& player) {
    return dynamic_cast<SpatialHashBroadphase&>(player.broadphase());
}

void askFilterAgain(btBroadphaseInterface& broadphase, btBroadphaseProxy* proxy) {
    if (auto* hash = dynamic_cast<SpatialHashBroadphase*>(&broadphase)) {
        hash->refilter(proxy, nullptr);
        return;
    }
    broadphase.getOverlappingPairCache()->cleanProxyFromPairs(proxy, nullptr);
    broadphase.getOverlappingPairCache()->removeOverlappingPairsContainingProxy(proxy, nullptr);
    if (auto* dbvt = dynamic_cast<btDbvtBroadphase*>(&broadphase)) {
        // The tree is asked only about boxes that change.
        dbvt->setAabbForceUpdate(proxy, proxy->m_aabbMin, proxy->m_aabbMax, nullptr);
    }
}

}  // namespace hashphase::test
