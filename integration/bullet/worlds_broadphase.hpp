// SPDX-License-Identifier: Zlib
#pragma once

// Thousands of small worlds at the same place, in one Bullet world, for training or copies of a level. Objects of
// different worlds never pair. The broadphase of each world is as fast as a separate broadphase (tests/benchmarks/run
// --only worlds).
//
//     hashphase::WorldsConfig config;
//     config.worldCount = 300;
//     config.worldOf = [](const btCollisionObject& object) { return object.getUserIndex(); };
//     hashphase::WorldsBroadphase broadphase(config);
//     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// Each world is a SpatialHashBroadphase with its own grid. All worlds share one pair cache. Use world(number).grid()
// for culling, picking and other queries of one world.
//
// One world   Each object is in one world. A shared floor needs a body in each world.
// All worlds  Queries of this class search all worlds in turn, and so do Bullet's queries, such as
//             btCollisionWorld::rayTest(). Members that take a proxy work on the proxy's world. rayTests(),
//             closestRays() and createProxies() exist only for single worlds. Casts of fast bodies search all worlds,
//             but hit only bodies of the same world.
// Ids         m_uniqueId is unique over all worlds, ProxyId only within a world.
// Moving      To move an object to another world, first change the value that worldOf reads. Afterwards, call
//             btCollisionWorld::refreshBroadphaseProxy(), which creates the proxy again.
// Threads     Any number of threads may query all worlds and single worlds at the same time. During any other call,
//             no other thread may use the broadphase or one of its worlds.
// Callbacks, bad data, memory, misuse: as SpatialHashBroadphase. Exception: do not repeat shiftOrigin() after memory
//             ran out. Calls that are forbidden in a callback are forbidden for all worlds, not only for the world
//             of the callback (asserted).

#include <broadphase/core/peak_watch.hpp>
#include <broadphase/query_cost.hpp>
#include <integration/bullet/detail/cache_watch.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Settings of the worlds.
struct WorldsConfig {
    /// Number of worlds. Valid: 1 to WorldsBroadphase::kMostWorlds. A world without proxies takes about 4 KB.
    int worldCount = 1;

    /// Required. Returns the number of the object's world, from 0 to worldCount - 1. createProxy() calls this
    /// function for its object, and so do btCollisionWorld::addCollisionObject() and refreshBroadphaseProxy().
    /// Before these calls, set the value that worldOf reads: the user index of a new object is -1, an invalid number.
    std::function<int(const btCollisionObject& object)> worldOf{};

    /// The settings that every world gets. each.parallelFor updates several worlds at the same time, and each world
    /// on one thread.
    SpatialHashConfig each{};
};

/// Returns a sentence about an invalid setting; empty if all settings are valid. Also checks WorldsConfig::each.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string configError(const WorldsConfig& config);

/// A btBroadphaseInterface with many worlds. Objects of different worlds never pair.
class HASHPHASE_BULLET_EXPORT WorldsBroadphase final : public btBroadphaseInterface,
                                                       private detail::CacheWatcher {
public:
    static constexpr int kMostWorlds = 1 << 16;

    /// Creates all worlds, and owns a new PairCache. If the configuration is invalid, throws std::invalid_argument
    /// with configError(config).
    explicit WorldsBroadphase(const WorldsConfig& config) : WorldsBroadphase(nullptr, config) {}

    /// Uses `pairCache`, which must outlive the broadphase. If it is nullptr, owns a new PairCache. With
    /// PairOrder::canonical, the pairs of each world have the same order as in a separate broadphase. Asserted: the
    /// cache has no pairs yet.
    WorldsBroadphase(PairCache* pairCache, const WorldsConfig& config);

    ~WorldsBroadphase() override;
    WorldsBroadphase(const WorldsBroadphase&) = delete;
    WorldsBroadphase& operator=(const WorldsBroadphase&) = delete;

    // --- Single worlds ---------------------------------------------------------------------------

    [[nodiscard]] int worldCount() const noexcept { return static_cast<int>(worlds_.size()); }

    /// Returns the world with this number. All its members may be called, and affect only this world: createProxies()
    /// ignores worldOf, and resetPool() resets no other world. Differences from a separate SpatialHashBroadphase: one
    /// counter of unique ids and one pair cache serve all worlds, releaseUnusedMemory() does not affect the cache,
    /// and parallelFor is not set. Asserted: the number is valid.
    [[nodiscard]] SpatialHashBroadphase& world(int number);
    [[nodiscard]] const SpatialHashBroadphase& world(int number) const;

    /// Returns the number of the world in which the proxy was created. Cost: O(1).
    [[nodiscard]] int worldOf(const btBroadphaseProxy* proxy) const;

    // --- btBroadphaseInterface -------------------------------------------------------------------

    /// As SpatialHashBroadphase::createProxy(), in the world that WorldsConfig::worldOf returns for `userPtr`, a
    /// btCollisionObject. If `userPtr` is NULL or worldOf returns an invalid number, throws std::invalid_argument and
    /// creates nothing. After this exception, remove the object from Bullet's world. If refreshBroadphaseProxy()
    /// threw, first call object.setBroadphaseHandle(nullptr), because the old proxy is destroyed.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// As rayTest() and aabbTest() of SpatialHashBroadphase, in one world after another. If
    /// stopWhenProcessReturnsFalse is set, a callback that returns false ends the query for all worlds. Cost:
    /// O(worlds), plus a query in each world.
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) override;
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;

    /// Makes the cache's pairs exact, as SpatialHashBroadphase::calculateOverlappingPairs() for each world. First
    /// removes separated pairs of all worlds. Afterwards, adds new pairs world by world. If parallelFor is set and
    /// there is no overlap filter callback, updates several worlds at the same time. The result does not depend on
    /// the number of threads. Cost: an update of each changed world, plus one check for each unchanged world. An
    /// unchanged world keeps its lastCost(), and its unused memory until releaseUnusedMemory().
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// Returns the box around all boxes of all worlds; zero if there are no boxes. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// If no world has a proxy, calls SpatialHashBroadphase::resetPool() on all worlds, and m_uniqueId counts from 1
    /// again. If a world has a proxy, does nothing. Asserted: no callback is running.
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet.
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// Calls setAabb() for each proxy, in order, on the caller's thread. Proxies may be in different worlds.
    /// Asserted: the spans have equal lengths.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);
    /// As SpatialHashBroadphase::destroyProxies(). Proxies may be in different worlds.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet, as SpatialHashBroadphase -------------------------------------------------

    /// Finds the closest hit in all worlds. Returns the sum of the queries' costs. Cost: O(worlds), plus a query in
    /// each world. Each of these queries stops at the nearest hit found so far.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);
    void refilterAll(btDispatcher* dispatcher);

    /// Does nothing if the proxies are in different worlds, because such proxies never pair.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Shifts all worlds. Returns the number of boxes that had to be rounded: see Grid::shiftOrigin(). If memory runs
    /// out, only the first worlds are shifted. Do not repeat the call: it would shift these worlds twice.
    std::size_t shiftOrigin(const btVector3& shift);

    [[nodiscard]] const WorldsConfig& config() const noexcept { return config_; }

    /// Returns the bytes held by all worlds, and by the pair cache if the broadphase created it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Calls releaseUnusedMemory() of all worlds and of the pair cache.
    void releaseUnusedMemory() noexcept;

    /// Returns a sentence about a broken invariant of a world or of the owned PairCache; empty if all hold. Also
    /// checked:
    /// - The owned cache has as many pairs as all worlds together, unless the program has removed pairs.
    [[nodiscard]] std::string validate() const;

private:
    using World = SpatialHashBroadphase;

    /// A world that is being updated, and the changes of its pairs.
    struct Updated {
        World* world;
        PairChanges changes{};
        bool isWithinApply = false;  // see SpatialHashBroadphase::Applying
    };

    void note(const btBroadphasePair& pair) noexcept override;
    void forget() noexcept override;
    void endCache() noexcept override;
    [[nodiscard]] bool mayRefuse() const noexcept override;
    [[nodiscard]] bool refuses(const btBroadphaseProxy& a,
                               const btBroadphaseProxy& b) const noexcept override;

    class Applying;

    [[nodiscard]] World& worldFor(const btBroadphaseProxy* proxy) const;
    [[nodiscard]] World& worldForClient(const void* client);
    template <class Call>
    void forEachWorldOf(std::span<btBroadphaseProxy* const> proxies, const Call& call) const;
    void listUpdated(btDispatcher* dispatcher);
    void updateWorlds();
    void listChanges();
    void applyChanges(btDispatcher* dispatcher);
    [[nodiscard]] bool areAnyBehind() const noexcept;
    void setBehind() noexcept;

    WorldsConfig config_;
    std::unique_ptr<PairCache> ownCache_;  // null if the program passed a cache
    PairCache* pairCache_;                 // null after the cache was destroyed
    int lastUniqueId_ = 0;
    std::vector<std::unique_ptr<World>> worlds_;
    std::vector<Updated> updated_;       // worlds in the present update
    std::vector<BulletProxyPair> died_;  // died pairs of all updated worlds
    std::vector<BulletProxyPair> born_;
    std::vector<int> notedIds_;  // scratch for setAabbs()
    detail::PeakWatch peaks_;    // capacity of the pair cache
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
