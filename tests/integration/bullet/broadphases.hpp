// SPDX-License-Identifier: Zlib
#pragma once

// The broadphases that are played against each other.

#include <tests/integration/bullet/player.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <iosfwd>
#include <memory>
#include <vector>

namespace hashphase::test {

/// btDbvtBroadphase driven so that its pair set is exact: no fat boxes, and every pair is checked
/// whenever a box has changed.
struct ExactDbvt : btDbvtBroadphase {
    explicit ExactDbvt(btOverlappingPairCache* cache = nullptr) : btDbvtBroadphase(cache) {
        m_cupdates = 100;
    }
    void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
                 btDispatcher* dispatcher) override {
        setAabbForceUpdate(proxy, min, max, dispatcher);
    }
};

template <class Broadphase>
std::unique_ptr<btBroadphaseInterface> makeBroadphase() {
    return std::make_unique<Broadphase>();
}

/// What our broadphase may put its pairs into.
struct CacheKind {
    const char* name;
    std::unique_ptr<btOverlappingPairCache> (*make)();  ///< null: the broadphase has its own
};

void PrintTo(const CacheKind& kind, std::ostream* out);

/// own, arrival, canonical, hashed, deferred; the last two are Bullet's.
const std::vector<CacheKind>& cacheKinds();

/// A broadphase over a cache; over a PairCache as one, so that it hears of what is taken out.
[[nodiscard]] std::unique_ptr<SpatialHashBroadphase> hashOver(btOverlappingPairCache* cache,
                                                              const SpatialHashConfig& config = {});

/// Our broadphase over a cache, or over its own.
Player hashPlayer(int objectCount, std::unique_ptr<btOverlappingPairCache> cache = nullptr,
                  const SpatialHashConfig& config = {});

/// Characters and sensors, told by their groups, have their pairs at once.
[[nodiscard]] SpatialHashConfig eagerCharactersAndSensors();

/// The broadphase of a player made by hashPlayer().
SpatialHashBroadphase& hashOf(const Player& player);

/// Makes a broadphase ask the filter about all that the proxy overlaps: by refilter() where there
/// is one, else as Bullet's documentation says, by dropping the proxy's pairs.
void askFilterAgain(btBroadphaseInterface& broadphase, btBroadphaseProxy* proxy);

}  // namespace hashphase::test
