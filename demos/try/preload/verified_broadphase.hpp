// SPDX-License-Identifier: Zlib
#pragma once

// Our broadphase at work, with Bullet's beside it that is told the same; after each
// calculateOverlappingPairs() the pairs of both are compared with the exact ones, and what is wrong is
// counted in the record.
//
// Exact    The pairs whose boxes overlap (overlap.hpp), by a sweep along x that shares no code with the
//          library, and that the pair cache accepts: two proxies that are no pair are missing if it is
//          accepted when it is asked about, now, and a pair that the calculation has made is extra if it
//          is not. A pair that was none before, is accepted now, and whose boxes are as they were in
//          the last calculation, was refused then: it is counted apart, as it waits for a move under
//          any broadphase of Bullet's.
// Removed  A pair that the program itself took out of the cache between two calculations is counted apart
//          as well, until its boxes part: with ours it comes back when they meet again, or by refilter().
// Late     What a callback has moved or made while pairs were calculated is judged after the next
//          calculation, which takes notice of it.
// Filter   Asked for both broadphases, and by the comparison; always about the program's own proxies.
// Threads  As the broadphase.

#include <demos/try/preload/stock_dbvt.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

namespace hashphase::tryout {

class VerifiedBroadphase : public btBroadphaseInterface {
public:
    /// `settings` is the program's object, whose fields steer Bullet's broadphase; it outlives this one.
    /// `cache` as for SpatialHashBroadphase.
    VerifiedBroadphase(const btDbvtBroadphase& settings, btOverlappingPairCache* cache);
    ~VerifiedBroadphase() override;

    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback, const btVector3& aabbMin,
                 const btVector3& aabbMax) override;
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;
    btOverlappingPairCache* getOverlappingPairCache() override;
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override;
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;
    void resetPool(btDispatcher* dispatcher) override;
    void printStats() override {}

private:
    /// Bullet's broadphase, in room of its own; its proxies' clients are the program's proxies.
    class Stock;

    struct Twin {
        btBroadphaseProxy* stock;
        std::uint64_t changed;  // the number of the calculation that takes notice of it
    };

    /// Two proxies of the program's, the one with the lower address first.
    using RawPair = std::pair<btBroadphaseProxy*, btBroadphaseProxy*>;

    [[nodiscard]] std::vector<RawPair> findOverlapping() const;
    void lookAtCache();
    void forget(const btBroadphaseProxy* proxy);
    void compare();
    [[nodiscard]] std::uint64_t changeOf(const RawPair& pair) const;

    const btDbvtBroadphase& settings_;
    SpatialHashBroadphase ours_;
    std::unique_ptr<Stock> stock_;
    std::unordered_map<btBroadphaseProxy*, Twin> twins_;
    std::vector<RawPair> last_;      // pairs of ours after the last calculation
    std::vector<RawPair> before_;    // and when the next one began
    std::vector<RawPair> removed_;   // by the program since, or before, and overlapping ever since
    std::vector<RawPair> missing_;   // after the last calculation
    std::uint64_t calculation_ = 0;  // the last one that has begun
};

}  // namespace hashphase::tryout
