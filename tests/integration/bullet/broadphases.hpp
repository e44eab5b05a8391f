// SPDX-License-Identifier: Zlib
#pragma once

// The broadphases that are compared, and the boxes that they are asked about.

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <tests/support/random.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <memory>
#include <ostream>
#include <vector>

namespace hashphase::test {

// --- Boxes ---------------------------------------------------------------------------------------

struct Box {
    btVector3 min;
    btVector3 max;
};

[[nodiscard]] inline Box boxAround(const btVector3& center, const btVector3& halfExtents) {
    return {center - halfExtents, center + halfExtents};
}
/// Of 1 m, along x.
[[nodiscard]] inline Box cubeAt(btScalar x) {
    return {{x, 0, 0}, {x + 1, 1, 1}};
}
[[nodiscard]] inline Box boxOf(const btBroadphaseProxy& proxy) {
    return {proxy.m_aabbMin, proxy.m_aabbMax};
}
[[nodiscard]] inline Box boxOf(const Aabb<btScalar>& box) {
    return {toBullet(box.min()), toBullet(box.max())};
}

/// With a margin on all sides.
[[nodiscard]] inline Box grownBy(const Box& box, btScalar margin) {
    const btVector3 by(margin, margin, margin);
    return {box.min - by, box.max + by};
}

/// The predicate that decides every pair: closed, and false for NaN.
[[nodiscard]] inline bool overlap(const Box& a, const Box& b) {
    const auto isBelow = [](const btVector3& low, const btVector3& high) {
        return low.x() <= high.x() && low.y() <= high.y() && low.z() <= high.z();
    };
    return isBelow(a.min, b.max) && isBelow(b.min, a.max);
}
/// Equal, bit by bit but for the sign of zero.
[[nodiscard]] inline bool isSame(const Box& a, const Box& b) {
    return toEigen(a.min) == toEigen(b.min) && toEigen(a.max) == toEigen(b.max);
}

/// The filter of a broadphase that has no callback: group and mask, both ways.
[[nodiscard]] inline bool groupsCollide(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
    return (a.m_collisionFilterGroup & b.m_collisionFilterMask) != 0 &&
           (b.m_collisionFilterGroup & a.m_collisionFilterMask) != 0;
}

class BulletRandom : public Random {
public:
    using Random::Random;

    btScalar uniform(double low, double high) { return static_cast<btScalar>(between(low, high)); }
    int below(int count) {
        return static_cast<int>(Random::below(static_cast<std::uint32_t>(count)));
    }
    btVector3 vector(double low, double high) {
        return toBullet(pointIn(low, high).cast<btScalar>());
    }
    btVector3 direction() {
        for (;;) {
            const btVector3 inCube = vector(-1, 1);
            if (inCube.length2() > btScalar(0.01) && inCube.length2() <= 1) {
                return inCube.normalized();
            }
        }
    }
};

/// What a proxy stands for that has a number. A collision object, for those queries that read one.
struct Client : btCollisionObject {
    explicit Client(int number = 0) : object(number) {}

    int object;
    bool isAlive = true;
};

[[nodiscard]] inline int objectOf(const btBroadphaseProxy* proxy) {
    return static_cast<const Client*>(proxy->m_clientObject)->object;
}
[[nodiscard]] inline bool hasLivingClient(const btBroadphaseProxy& proxy) {
    const auto* const client = static_cast<const Client*>(proxy.m_clientObject);
    return client != nullptr && client->isAlive;
}

// --- Broadphases ---------------------------------------------------------------------------------

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

inline void PrintTo(const CacheKind& kind, std::ostream* out) {
    *out << kind.name;
}

template <class Cache, auto... arguments>
std::unique_ptr<btOverlappingPairCache> makeCache() {
    return std::make_unique<Cache>(arguments...);
}

inline constexpr CacheKind kCacheKinds[] = {
    {"own", [] { return std::unique_ptr<btOverlappingPairCache>(); }},
    {"arrival", makeCache<PairCache>},
    {"canonical", makeCache<PairCache, PairOrder::canonical>},
    {"hashed", makeCache<btHashedOverlappingPairCache>},
    {"deferred", makeCache<btSortedOverlappingPairCache>}};

/// A broadphase over a cache; over a PairCache as one, so that it hears of what is taken out.
[[nodiscard]] inline std::unique_ptr<SpatialHashBroadphase> hashOver(
    btOverlappingPairCache* cache, const SpatialHashConfig& config = {}) {
    if (auto* const ours = dynamic_cast<PairCache*>(cache)) {
        return std::make_unique<SpatialHashBroadphase>(ours, config);
    }
    return std::make_unique<SpatialHashBroadphase>(cache, config);
}

/// Characters and sensors, told by their groups, have their pairs at once.
[[nodiscard]] inline SpatialHashConfig eagerCharactersAndSensors() {
    SpatialHashConfig config;
    config.eagerGroups = btBroadphaseProxy::CharacterFilter | btBroadphaseProxy::SensorTrigger;
    return config;
}

/// Makes a broadphase ask the filter about all that the proxy overlaps: by refilter() where there
/// is one, else as Bullet's documentation says, by dropping the proxy's pairs.
inline void askFilterAgain(btBroadphaseInterface& broadphase, btBroadphaseProxy* proxy) {
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
