// SPDX-License-Identifier: Zlib
#pragma once

// Thousands of small worlds at the same place, in one Bullet world, for training or copies of a level. Objects of
// different worlds never pair. The broadphase of each world is as fast as alone (tests/benchmarks/run --only
// worlds).
//
//     hashphase::WorldsConfig config;
//     config.worldCount = 300;
//     config.worldOf = [](const btCollisionObject& object) { return object.getUserIndex(); };
//     hashphase::WorldsBroadphase broadphase(config);
//     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// Each world is a SpatialHashBroadphase with its own grid, over one shared pair cache: see world(). Use its grid()
// for culling, picking and other queries of one world.
//
// One world   Each object is in one world. A shared floor needs a body in each world.
// All worlds  Queries of this class, and Bullet's own, such as btCollisionWorld::rayTest(), search all worlds in
//             turn. Members for a proxy work on its world. rayTests(), closestRays() and createProxies() exist for
//             single worlds only. Casts of fast bodies search all worlds, but hit only their own.
// Ids         m_uniqueId counts through all worlds. ProxyIds repeat between worlds.
// Moving      An object stays in its world until its proxy is created again: change what worldOf reads, then call
//             btCollisionWorld::refreshBroadphaseProxy().
// Threads     Queries of all and of single worlds: any number at the same time. Everything else needs the
//             broadphase, with all its worlds, for itself.
// Callbacks, bad data, memory, misuse: as SpatialHashBroadphase. shiftOrigin() cannot be repeated after memory ran
//             out. What no callback may call, it may not call for another world either (asserted).

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
    /// Valid: 1 to WorldsBroadphase::kMostWorlds. A world without proxies takes about 4 KB.
    int worldCount = 1;

    /// Required. Returns the number of the object's world, from 0 on. createProxy() calls it for every object, and
    /// so do btCollisionWorld::addCollisionObject() and refreshBroadphaseProxy(). Set what it reads before: the
    /// user index of a new object is -1, an invalid number.
    std::function<int(const btCollisionObject& object)> worldOf{};

    /// Settings of each world. parallelFor runs over the worlds; each world runs on one thread.
    SpatialHashConfig each{};
};

/// Returns what is wrong, in a sentence, as configError(const SpatialHashConfig&); empty if nothing is.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string configError(const WorldsConfig& config);

/// A btBroadphaseInterface of many worlds that never meet.
class HASHPHASE_BULLET_EXPORT WorldsBroadphase final : public btBroadphaseInterface,
                                                       private detail::CacheWatcher {
public:
    static constexpr int kMostWorlds = 1 << 16;

    /// Makes all worlds, and owns a PairCache. Throws std::invalid_argument with configError(config).
    explicit WorldsBroadphase(const WorldsConfig& config) : WorldsBroadphase(nullptr, config) {}

    /// Uses `pairCache`, which must outlive the broadphase; with nullptr, as above. With PairOrder::canonical,
    /// pairs of a world have the order of a separate broadphase. Asserted: the cache has no pairs yet.
    WorldsBroadphase(PairCache* pairCache, const WorldsConfig& config);

    ~WorldsBroadphase() override;
    WorldsBroadphase(const WorldsBroadphase&) = delete;
    WorldsBroadphase& operator=(const WorldsBroadphase&) = delete;

    // --- Single worlds ---------------------------------------------------------------------------

    [[nodiscard]] int worldCount() const noexcept { return static_cast<int>(worlds_.size()); }

    /// Returns the world of this number. All calls of a SpatialHashBroadphase are allowed, and concern this world
    /// alone: createProxies() creates proxies in it whatever worldOf returns, and resetPool() restarts it while
    /// others run on. Three things differ: all worlds share unique ids and the pair cache, releaseUnusedMemory()
    /// leaves the cache as it is, and parallelFor is not set. Asserted: the number is valid.
    [[nodiscard]] SpatialHashBroadphase& world(int number);
    [[nodiscard]] const SpatialHashBroadphase& world(int number) const;

    /// Returns the number of the world that the proxy was created in. Cost: O(1).
    [[nodiscard]] int worldOf(const btBroadphaseProxy* proxy) const;

    // --- btBroadphaseInterface -------------------------------------------------------------------

    /// As SpatialHashBroadphase::createProxy(), in the world that WorldsConfig::worldOf returns for `userPtr`, a
    /// btCollisionObject. Throws std::invalid_argument, and creates nothing, if `userPtr` is NULL or the number is
    /// invalid. Then remove the object from Bullet's world; after refreshBroadphaseProxy(), first call
    /// object.setBroadphaseHandle(nullptr), as its proxy is gone.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// As SpatialHashBroadphase, for each world in turn. With stopWhenProcessReturnsFalse, a callback that ends the
    /// query of one world ends it for all. Cost: O(worlds), and the query of each.
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) override;
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;

    /// Makes the cache's pairs exact, as SpatialHashBroadphase::calculateOverlappingPairs() of each world. Order:
    /// parted pairs of all worlds go first, then new pairs come, world by world. With parallelFor, worlds are
    /// updated at the same time, unless there is an overlap filter callback; the result is equal on any number of
    /// threads. Cost: the worlds with changes, and one check for each other world. The others keep unused memory
    /// until releaseUnusedMemory(), and their lastCost().
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// Returns the box around all boxes of all worlds; zero if there are none. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// If no proxy is alive in any world: SpatialHashBroadphase::resetPool() of all, and m_uniqueId counts from 1
    /// again. Otherwise does nothing. Asserted: not within callbacks.
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet.
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// setAabb() for each proxy, of any worlds, in order, on the caller's thread. Asserted: the spans have equal
    /// lengths.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);
    /// As SpatialHashBroadphase::destroyProxies(), for proxies of any worlds.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet, as SpatialHashBroadphase -------------------------------------------------

    /// Finds the closest hit in any world. Returns the cost of all. Cost: O(worlds), and a query in each up to the
    /// nearest hit so far.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);
    void refilterAll(btDispatcher* dispatcher);

    /// Does nothing for proxies of different worlds, which are no pair anyway.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Shifts all worlds. Returns how many boxes were rounded. If memory runs out, only the first worlds are
    /// shifted: do not repeat the call, which would shift these twice.
    std::size_t shiftOrigin(const btVector3& shift);

    [[nodiscard]] const WorldsConfig& config() const noexcept { return config_; }

    /// Returns the bytes held by all worlds, and by the pair cache if the broadphase made it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// SpatialHashBroadphase::releaseUnusedMemory() of all worlds, and of the pair cache.
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant of any world, or of its own PairCache, in a sentence; empty if all hold. Also:
    /// - The cache holds as many pairs as all worlds together (its own cache, if the program took out none since).
    [[nodiscard]] std::string validate() const;

private:
    using World = SpatialHashBroadphase;

    /// A world under update, with its changes.
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
    std::unique_ptr<PairCache> ownCache_;  // if none was given
    PairCache* pairCache_;                 // null when it has ended
    int lastUniqueId_ = 0;
    std::vector<std::unique_ptr<World>> worlds_;
    std::vector<Updated> updated_;       // of the calculation under way
    std::vector<BulletProxyPair> died_;  // in all of these
    std::vector<BulletProxyPair> born_;
    std::vector<int> notedIds_;  // scratch of setAabbs()
    detail::PeakWatch peaks_;    // of the cache
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
