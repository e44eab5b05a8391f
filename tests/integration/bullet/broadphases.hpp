// SPDX-License-Identifier: Zlib
#pragma once

// The broadphases that are played against each other.

#include <tests/integration/bullet/player.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

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
