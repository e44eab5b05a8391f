// SPDX-License-Identifier: Zlib
#pragma once

// Thousands of small worlds at the same place, in one world of Bullet's: what is in different worlds never
// pairs, and the broadphase of each world is as fast as alone (tests/benchmarks/run --only worlds). For training, and
// for copies of a level with players of their own.
//
//     hashphase::WorldsConfig config;
//     config.worldCount = 300;
//     config.worldOf = [](const btCollisionObject& object) { return object.getUserIndex(); };
//     hashphase::WorldsBroadphase broadphase(config);
//     btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
//
// Each world is a SpatialHashBroadphase, with a grid of its own, over the pair cache of all. world() leads to
// it: its queries find what is in that world alone, and clients of grids take its grid().
//
// One world   Each object is in one world. What all worlds share, as a floor, is needed once in each: a body a world.
// All worlds  The members of this class ask all worlds, one after the other, and so do Bullet's own queries,
//             as btCollisionWorld::rayTest(). Members for a proxy go to its world. rayTests(), closestRays()
//             and createProxies() are those of single worlds alone. Casts of fast bodies look through all worlds,
//             and meet nobody of another one.
// Ids         m_uniqueId counts through all worlds. A ProxyId is of one world: others have equal ones.
// Moving      An object stays in its world until its proxy is created again: change what worldOf reads, then
//             call btCollisionWorld::refreshBroadphaseProxy().
// Threads     Queries of all and of single worlds are const in all but name: any number may run at the same
//             time. Everything else needs the broadphase, with all its worlds, for itself.
// Callbacks, bad data, memory, misuse: as SpatialHashBroadphase, but shiftOrigin() cannot be repeated where memory
//             ran out. What no callback may call, none may call of another world either (asserted).

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

    /// Returns the number of the object's world, from 0 on. Asked by createProxy(), and so by
    /// btCollisionWorld::addCollisionObject() and refreshBroadphaseProxy(), about every object. Required. Set what
    /// it reads before: the user index of a new object is -1, which is no world.
    std::function<int(const btCollisionObject& object)> worldOf{};

    /// Settings of each world. Its parallelFor is used over worlds, each of which runs on one thread.
    SpatialHashConfig each{};
};

/// Says what is wrong with the settings, as configError(const SpatialHashConfig&); empty when all is well.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string configError(const WorldsConfig& config);

/// A btBroadphaseInterface of many worlds that never meet.
class HASHPHASE_BULLET_EXPORT WorldsBroadphase final : public btBroadphaseInterface,
                                                       private detail::CacheWatcher {
public:
    static constexpr int kMostWorlds = 1 << 16;

    /// Makes all worlds, and owns a PairCache. Throws std::invalid_argument with configError(config).
    explicit WorldsBroadphase(const WorldsConfig& config) : WorldsBroadphase(nullptr, config) {}

    /// Uses `pairCache`, which must outlive the broadphase and have no pairs yet (asserted); with nullptr, as
    /// above. With PairOrder::canonical, pairs of a world are in the order of a broadphase of its own.
    WorldsBroadphase(PairCache* pairCache, const WorldsConfig& config);

    ~WorldsBroadphase() override;
    WorldsBroadphase(const WorldsBroadphase&) = delete;
    WorldsBroadphase& operator=(const WorldsBroadphase&) = delete;

    // --- Single worlds ---------------------------------------------------------------------------

    [[nodiscard]] int worldCount() const noexcept { return static_cast<int>(worlds_.size()); }

    /// The world of that number, which must be one (asserted). All calls of a SpatialHashBroadphase are
    /// allowed, and concern this world alone: calculateOverlappingPairs() brings its pairs up to date,
    /// shiftOrigin() shifts it, createProxies() creates proxies in it, whatever worldOf says, and resetPool()
    /// lets it begin anew while others go on. Three differ: unique ids and the pair cache are those of all
    /// worlds, releaseUnusedMemory() leaves the cache as it is, and parallelFor is not set.
    [[nodiscard]] SpatialHashBroadphase& world(int number);
    [[nodiscard]] const SpatialHashBroadphase& world(int number) const;

    /// The number of the world that the proxy was created in. Cost: O(1).
    [[nodiscard]] int worldOf(const btBroadphaseProxy* proxy) const;

    // --- btBroadphaseInterface -------------------------------------------------------------------

    /// As SpatialHashBroadphase::createProxy(), in the world that WorldsConfig::worldOf names for `userPtr`,
    /// which is a btCollisionObject. Throws std::invalid_argument, and creates nothing, where it is NULL, or
    /// its world is none of them. Then remove the object from Bullet's world. After a refreshBroadphaseProxy()
    /// that threw, first call object.setBroadphaseHandle(nullptr): its proxy is gone. m_uniqueId counts through
    /// all worlds.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// As those of SpatialHashBroadphase, of each world in turn. With stopWhenProcessReturnsFalse, a callback
    /// that ends the query of one ends it of all. Cost: O(worlds), and that of each.
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) override;
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;

    /// Makes the cache's pairs exact, as SpatialHashBroadphase::calculateOverlappingPairs() of each world.
    /// Order: of all worlds, pairs that have parted go first, then pairs that have met come, world by world.
    /// With parallelFor, worlds are updated at the same time, unless there is an overlap filter callback; the
    /// result is equal on any number of threads.
    /// Cost: that of the worlds in which something has changed, and one check for each unchanged world. These
    /// keep unused memory until releaseUnusedMemory(), and their lastCost().
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// The box around all boxes of all worlds; zero when there is none. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// When no proxy is alive in any world, SpatialHashBroadphase::resetPool() of all, and m_uniqueId counts
    /// from 1 again. Does nothing while a proxy is alive. Not called by callbacks (asserted).
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet.
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// setAabb() for each proxy, in their order, on the caller's thread; proxies may be of any worlds. All three
    /// spans have the same length (asserted).
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);
    /// As SpatialHashBroadphase::destroyProxies(); proxies may be of any worlds.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet, as SpatialHashBroadphase -------------------------------------------------

    /// The closest hit in any world. Cost: O(worlds), and that of each, up to the hits before.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);
    void refilterAll(btDispatcher* dispatcher);

    /// Two proxies of different worlds are no pair anyway: nothing is done, nor remembered.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Shifts all worlds. Where memory runs out, the first worlds are shifted, and the others are not: the call
    /// cannot be repeated, which would shift the first ones twice.
    std::size_t shiftOrigin(const btVector3& shift);

    /// The configuration it was made with.
    [[nodiscard]] const WorldsConfig& config() const noexcept { return config_; }

    /// Bytes held by all worlds, and by the pair cache if the broadphase made it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// SpatialHashBroadphase::releaseUnusedMemory() of all worlds, and of the pair cache.
    void releaseUnusedMemory() noexcept;

    /// SpatialHashBroadphase::validate() of each world, and PairCache::validate(), and:
    /// - The cache holds as many pairs as all worlds together (if the broadphase made it, and the program has
    ///   taken out no pair since pairs were calculated).
    [[nodiscard]] std::string validate() const;

private:
    using World = SpatialHashBroadphase;

    /// A world that is updated, and what has changed in it.
    struct Updated {
        World* world;
        PairChanges changes{};
        bool isWithinApply = false;  // of changes in the world: see SpatialHashBroadphase::Applying
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
