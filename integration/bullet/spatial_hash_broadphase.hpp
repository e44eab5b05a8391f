// SPDX-License-Identifier: Zlib
#pragma once

// The spatial hash as Bullet's broadphase:
//
//     hashphase::SpatialHashBroadphase broadphase;  // instead of btDbvtBroadphase
//
// Pairs are exact. calculateOverlappingPairs() changes them; createProxy() and setAabb() add pairs for eagerGroups
// and ghosts only. A ghost gets its pairs immediately: when it is created or moved, and when another object is
// created in the ghost's box, or moves there so far that the object's old and new boxes do not touch.
//
// Threads   Any number of threads may run ray queries, aabbTest(), getAabb(), proxyOf(), idOf(), and queries of
//           grid() and sweeps() at the same time, also nested. During any other call, no other thread may use the
//           broadphase, as in Bullet.
// Units     Any unit of length that the whole world uses. Comments write [m] for it.
// Clients   btCollisionObjects or NULL. For other types, set eagerGhosts to false and sweep to none, and do not use
//           closestRay() or collisionChecksChanged().
// Bad data  A box with a NaN makes no pair; a broadphase reports its first such box (diagnostics.hpp). Infinite, huge
//           and inverted boxes are compared exactly by their coordinates. The dispatcher may be NULL.
// Callbacks Callbacks of rayTest(), aabbTest(), closestRay(), the pair cache and the dispatcher may query, and
//           create, move and destroy proxies; with one of Bullet's own pair caches, they must not destroy proxies. A
//           query does not report destroyed proxies. It may report or skip a proxy that a callback creates or moves,
//           and may report a moved proxy twice. Do not remove an object that Bullet is working on. Asserted: the
//           overlap filter only queries; no callback calculates pairs, shifts the origin or releases memory.
// Memory    Throws std::bad_alloc when memory runs out. In that case, repeat the call, except createProxies(), which
//           may have created some proxies. A failed createProxy() has created nothing. A failed shiftOrigin() has
//           shifted nothing. A failed setAabb() has moved the proxy, but perhaps not set its sweep. The next
//           calculateOverlappingPairs() that does not throw completes the pairs of the cache and of ghosts.
// Misuse    Asserted: proxies are alive and of this broadphase, all spans of a call have equal lengths, rays have
//           callbacks.

#include <broadphase/core/group_kinds.hpp>
#include <broadphase/core/stable_array.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <integration/bullet/detail/cache_watch.hpp>
#include <integration/bullet/detail/living_broadphase.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_config.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

class WorldsBroadphase;

/// A btBroadphaseInterface over a Grid.
class HASHPHASE_BULLET_EXPORT SpatialHashBroadphase : public btBroadphaseInterface,
                                                      private detail::LivingBroadphase {
public:
    /// Creates and owns a PairCache. Throws std::invalid_argument with configError(config) if `config` is invalid.
    explicit SpatialHashBroadphase(const SpatialHashConfig& config = {});

    /// Uses `pairCache`, which must outlive the broadphase. If it is nullptr, creates its own as above. Changes a
    /// PairCache in batches, and any other cache pair by pair. Here and below, a PairCache passed as a
    /// btOverlappingPairCache* counts as another cache. Asserted: the cache has no pairs yet.
    explicit SpatialHashBroadphase(PairCache* pairCache, const SpatialHashConfig& config = {});
    explicit SpatialHashBroadphase(btOverlappingPairCache* pairCache,
                                   const SpatialHashConfig& config = {});
    explicit SpatialHashBroadphase(std::nullptr_t, const SpatialHashConfig& config = {});

    ~SpatialHashBroadphase() override;
    SpatialHashBroadphase(const SpatialHashBroadphase&) = delete;
    SpatialHashBroadphase& operator=(const SpatialHashBroadphase&) = delete;

    // --- btBroadphaseInterface -------------------------------------------------------------------

    /// Returns a proxy whose address never changes. m_uniqueId counts 1, 2, 3 ...; unique ids are reused only after
    /// resetPool() or WorldSnapshot::restore(). Ignores `shapeType`. Throws std::length_error beyond 2^28 proxies,
    /// and after 2^31 - 1 unique ids until resetPool(). Cost: O(1), plus one test for each ghost; with more than
    /// 1,024 ghosts, one box query instead of these tests. Creating a ghost, or a proxy in
    /// SpatialHashConfig::eagerGroups, also costs Pairs::findPairsNow(), plus O(1) for each new pair.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;

    /// Removes the proxy's pairs through the pair cache, then the proxy. Cost: as the cache's
    /// removeOverlappingPairsContainingProxy().
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// Sets the proxy's box. If groups and masks decide (see SpatialHashConfig::filterRefusesMore), also reads the
    /// proxy's group and mask, even if the box is unchanged. Cost: O(1), or one comparison if the box is unchanged.
    /// With SpatialHashConfig::sweep, plus getAabb() of the body's shape. The cost is as for createProxy() if the
    /// proxy is a ghost or in eagerGroups, or if the new box does not touch the previous box.
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;

    /// Returns the box that was last set, without margin; a sweep does not change it.
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// Calls rayCallback.process() once for every proxy whose box, grown by the cast box (aabbMin, aabbMax), passes
    /// btRayAabb2() with the callback's own fields. Sees every setAabb() immediately, before pairs are calculated.
    /// Order: roughly from near to far; do not rely on it. A ray with NaN or infinite ends, or of length 0, finds
    /// nothing. If the square of a ray's length overflows, Bullet computes fields of the callback that are NaN or
    /// zero: the ray may miss objects, as under btDbvtBroadphase. For such rays, query grid() with a RayRegion. Cost:
    /// proportional to the boxes near the ray; at most one test for each proxy.
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) override;
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) const;

    /// Calls callback.process() once for every proxy whose box overlaps or touches the given box. Cost: at most one
    /// test for each proxy.
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) const;

    /// Updates the cache's pairs. Afterwards, the cache holds exactly the pairs of overlapping proxies that its
    /// filter accepts (exceptions: see ignorePair(), and below for changed groups and masks, and pairs that the
    /// program removed). With SpatialHashConfig::sweep, a fast body pairs instead with the proxies that it meets on
    /// its path. Persisting pairs are not touched. First removes separated pairs, then adds new pairs, both sorted by
    /// ProxyId. Changes and order depend on the boxes at the last calculation and now, not on the calls between.
    /// Finally, adds pairs again that the program removed from a PairCache, unless their proxies separated or the
    /// filter refuses them. A cache not passed as a PairCache gets such pairs back only when the proxies meet again.
    /// You may write groups and masks at any time. A newly allowed pair begins after the box of one of its proxies
    /// changes. If groups and masks decide (see SpatialHashConfig::filterRefusesMore), the box need not change: call
    /// setAabb() with the old box for the proxy whose group or mask you changed. A pair that is no longer allowed
    /// lasts until its boxes separate. Cost: as Pairs::update(), plus the cache's cost for each added or removed
    /// pair. Enters BT_PROFILE zones.
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// Returns the box around all boxes, margins and swept paths; zero if there are no proxies. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// If no proxy is alive, resets the broadphase; if one is alive, does nothing. Afterwards, equal calls give the
    /// results of a new broadphase: m_uniqueId (from 1), order of pairs, and order of freed algorithms. Frees memory,
    /// as Grid::clear(). To reset Bullet's own state, call the solver's reset(). Asserted: no callback is running.
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet; see lastCost() and memoryBytes().
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// Creates a proxy for each definition, in order, and writes it to `proxies`. If memory runs out, only the
    /// proxies written so far are created. Cost: as createProxy() for each proxy.
    void createProxies(std::span<const ProxyDefinition> definitions,
                       std::span<btBroadphaseProxy*> proxies, btDispatcher* dispatcher);

    /// Sets the box of each proxy, in order, with the result of single calls. Runs on the threads of
    /// SpatialHashConfig::parallelFor. Exceptions: if SpatialHashConfig::sweep is not none, or `proxies` has
    /// duplicates, all boxes are set on the caller's thread. If setting a box adds pairs immediately, the remaining
    /// boxes are set on the caller's thread. If memory runs out, only some boxes are set: repeat the call. Cost: as
    /// setAabb() for each proxy.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);

    /// Removes the pairs of all these proxies through the pair cache, and then the proxies. Asserted: `proxies` has
    /// no duplicates. Order and cost with a PairCache: as PairCache::removeOverlappingPairsContainingProxies(). With
    /// another cache, removes the pairs proxy by proxy; cost: as destroyProxy() for each.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet ---------------------------------------------------------------------------

    /// As btCollisionWorld::rayTest(), but tests objects from near to far, and stops when no nearer hit is possible.
    /// Skips objects whose boxes the ray enters more than 0.02 units (plus rounding errors) beyond
    /// callback.m_closestHitFraction. A ClosestRayResultCallback gets an equal result, but may keep another of
    /// several hits at an equal fraction. For soft bodies, use rayTest() of their world. Returns the query's cost.
    /// Cost: at most as this broadphase's rayTest(), plus a cast at the shape of each found proxy.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    /// rayTests() does rayTest() for each ray and its callback; closestRays() does closestRay(). Hits at nearly equal
    /// distances may come in another order than by single calls. If `parallelFor` uses several threads, callbacks run
    /// at the same time, and must not change the broadphase or shared data. Cost: as single calls, or less.
    void rayTests(std::span<const BroadphaseRay> rays, ParallelFor parallelFor = serialFor);
    void closestRays(std::span<const ClosestRay> rays, ParallelFor parallelFor = serialFor) const;

    /// Asks the filter again about every proxy that `proxy` overlaps, or met on its path in the last calculation.
    /// Immediately adds accepted pairs and removes refused pairs. Call it after a change of the proxy's group or
    /// mask, or of the filter's decisions about this proxy. Persisting pairs keep their contacts; after a change of
    /// shape, call shapeChanged(). Cost: as Pairs::refilter(), plus O(1) for each pair of the proxy.
    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// As above for many proxies, but asks the filter only once about every pair. Cost: as Pairs::refilter() for many
    /// proxies, plus O(1) for each of their pairs.
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    /// As refilter() for all proxies. Call it after a change of the filter callback or its data. Cost: as
    /// Pairs::refilterAll(), plus the cache's cost for each added or removed pair.
    void refilterAll(btDispatcher* dispatcher);

    /// Grows the proxy's box by `margin` [m] on all sides. A sweeping proxy keeps this margin on its whole path.
    /// Two proxies are a pair if their grown boxes overlap. Queries test the grown box, too. getAabb(), m_aabbMin and
    /// m_aabbMax do not include the margin. Queries see the margin immediately; pairs change as after setAabb(). A
    /// new proxy has no margin; refreshBroadphaseProxy() makes a new proxy. If only margins overlap, Bullet treats
    /// the pair like any other: two dynamic bodies fall asleep only at the same time, and the narrow phase runs while
    /// one is awake. Asserted: `margin` is finite and not negative; if not, nothing changes. Cost: as setAabb().
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;

    /// From now on, the two proxies do not pair, whatever groups, masks and the filter decide (see Pairs::ignore()).
    /// An existing pair is removed immediately. Its algorithm and contacts are freed immediately, too, except with
    /// PairOrder::canonical (see Removal in pair_cache.hpp). The pair stays ignored until stopIgnoringPair(), until
    /// collisionChecksChanged() for one of the proxies (see there), or until one of them is destroyed, also by
    /// refreshBroadphaseProxy(). Asserted: the proxies differ. Cost: O(1), plus removing a pair from the cache; if
    /// the cache defers removal, plus sorting all pairs.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    /// Ends ignorePair(). If the proxies overlap and the filter accepts them, adds their pair immediately. Cost: as
    /// ignorePair().
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;

    /// Updates the ignored pairs of this proxy. Ignores its pairs with objects in the world that the proxy's object
    /// lists by setIgnoreCollisionCheck(). Stops ignoring the proxy's other pairs, also pairs of ignorePair().
    /// Exception: a pair stays ignored if the other object lists this proxy's object. Call this function for the
    /// object with the list: when the list has changed (also by removeConstraint(), or addConstraint() with
    /// disableCollisionsBetweenLinkedBodies), and when this object or a listed object was added to the world. A list
    /// may contain destroyed objects. Cost: a pass over all proxies and ignored pairs.
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    /// As above for many proxies, in one pass.
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);

    /// Frees the algorithms and contacts of the proxy's pairs. The pairs stay. After a change of shape, scale,
    /// collision margin or other contact data, call this function and btCollisionWorld::updateSingleAabb() before the
    /// next step. If the cache has no deferred removal, calls the ghost callback as if each pair was removed and
    /// added again: ghost objects free their algorithms too. In that case, a cache not passed as a PairCache loses
    /// pairs that its filter now refuses. If the ghost callback itself removes a pair, it is called again for this
    /// removal. Cost: as PairCache::renewPairsContainingProxy(); with another cache, a pass over all pairs.
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Subtracts `shift` from every box: see Grid::shiftOrigin(). Pairs do not change. If rounding makes boxes
    /// overlap, the next calculateOverlappingPairs() adds their pairs. To shift the objects too, call
    /// shiftWorldOrigin() (origin_shift.hpp). Returns the number of rounded boxes. Cost: O(proxies), plus
    /// Grid::shiftOrigin().
    std::size_t shiftOrigin(const btVector3& shift);

    /// grid() is for queries that Bullet does not have. proxyOf(id) returns the proxy with this id; the proxy's
    /// m_clientObject is the btCollisionObject. For an index, call proxyOf(grid().idAt(index)). Asserted in
    /// proxyOf(): the proxy is alive. idOf() takes only live proxies of this class; asserted: not null.
    [[nodiscard]] const Grid<btScalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] btBroadphaseProxy* proxyOf(ProxyId id) const;
    [[nodiscard]] static ProxyId idOf(const btBroadphaseProxy* proxy);

    /// Returns the sweeping proxies with their paths, or nullptr if SpatialHashConfig::sweep is none. For a sweeping
    /// proxy, the grid stores the box around the whole path. Sweeps::visit() tests the path itself, and
    /// Sweeps::motion() returns the path.
    [[nodiscard]] const Sweeps<btScalar>* sweeps() const noexcept { return sweeps_.get(); }

    [[nodiscard]] const SpatialHashConfig& config() const noexcept { return config_; }

    [[nodiscard]] const PairCost& lastCost() const noexcept { return pairs_.lastCost(); }

    /// Returns the bytes held, including the proxies, and the pair cache if the broadphase created it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees unused memory of the grid, pairs and sweeps (see Grid::releaseUnusedMemory()), of a PairCache, and of
    /// destroyed proxies with the highest indices. Do not use pointers to destroyed proxies afterwards: assertions
    /// cannot detect this. calculateOverlappingPairs() frees memory by itself after 256 calls in a row with capacity
    /// for more than eight times the proxies or pairs. Asserted: no callback is running. Cost:
    /// O(grid().indexLimit()), plus a copy of the remaining data.
    void releaseUnusedMemory() noexcept;

    /// Returns a sentence about a broken invariant of the grid, sweeps, pairs, or a PairCache that the broadphase
    /// created; empty if all hold. Unless the program has removed pairs from this cache, the cache must have as many
    /// pairs as the broadphase. Call validate() after calculateOverlappingPairs().
    [[nodiscard]] std::string validate() const;

private:
    /// What the broadphase knows about a client.
    enum class Client : std::uint8_t { unknown, ghost, other };

    struct Proxy : btBroadphaseProxy {
        ProxyId id;
        Client client = Client::unknown;
        std::uint8_t kind = 0;    // index in groupKinds_ of the groups that the grid has for it
        std::uint16_t world = 0;  // index of its world in a WorldsBroadphase
        btScalar margin = 0;      // added to each side of its box in the grid [m]
    };
    struct PairLists;
    class Applying;
    class AabbBatch;
    template <class Callback>
    struct ProcessCollector;

    // For the worlds of a WorldsBroadphase: see spatial_hash_world.cpp.
    SpatialHashBroadphase(const SpatialHashConfig& config, PairCache& sharedCache,
                          int& sharedUniqueId, std::uint16_t worldNumber);
    [[nodiscard]] bool isUpToDate() const noexcept;
    void listChanges(const PairChanges& changes, std::vector<BulletProxyPair>& died,
                     std::vector<BulletProxyPair>& born) const;
    void listAll(std::vector<BulletProxyPair>& bulletPairs) const;
    [[nodiscard]] Aabb<btScalar> bounds() const;  // the box around all boxes
    [[nodiscard]] bool isWorld() const noexcept { return idCounter_ != &lastUniqueId_; }
    [[nodiscard]] bool isOfThisWorld(const btBroadphaseProxy& proxy) const noexcept {
        return static_cast<const Proxy&>(proxy).world == worldNumber_;
    }

    // Returns whether the callback has ended the query.
    [[nodiscard]] bool endsRayTest(const btVector3& from, const btVector3& to,
                                   btBroadphaseRayCallback& callback, const btVector3& castMin,
                                   const btVector3& castMax) const;
    [[nodiscard]] bool endsAabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                    btBroadphaseAabbCallback& callback) const;

    // Returns a non-const proxy, because Bullet's functions take no const proxies.
    [[nodiscard]] Proxy* proxyAt(std::uint32_t slot) const { return proxies_.at(slot); }
    void askFilter(std::span<const ProxyPair> asked, std::span<char> accepted) const;
    [[nodiscard]] auto cacheFilter() const {
        return [this](std::span<const ProxyPair> asked, std::span<char> accepted) {
            askFilter(asked, accepted);
        };
    }
    [[nodiscard]] ProxyGroups groupsOf(const btBroadphaseProxy& proxy) const noexcept {
        return groupsDecide_ ? ProxyGroups{static_cast<std::uint32_t>(proxy.m_collisionFilterGroup),
                                           static_cast<std::uint32_t>(proxy.m_collisionFilterMask)}
                             : ProxyGroups{};
    }
    [[nodiscard]] bool doGroupsDecide() const;
    void followFilter();
    bool noteGroups(Proxy& proxy);
    void noteGroupsOfAll();
    void noteGroupsIfTheyMatter();
    void noteSeen(const Proxy& proxy, bool isSeen) noexcept;
    void noteGroupsAround(const Proxy& proxy);
    [[nodiscard]] Proxy& place(const btBroadphaseProxy& made);
    [[nodiscard]] static ProxyPair pairOf(const btBroadphaseProxy* a, const btBroadphaseProxy* b) {
        const ProxyId idOfA = idOf(a);
        const ProxyId idOfB = idOf(b);
        return idOfA < idOfB ? ProxyPair{idOfA, idOfB} : ProxyPair{idOfB, idOfA};
    }
    using ProxyPairs = std::vector<ProxyPair>;
    void listPairsToIgnore(std::span<btBroadphaseProxy* const> proxies, ProxyPairs& pairs) const;
    void listPairsToIgnoreNoMore(std::span<btBroadphaseProxy* const> proxies,
                                 ProxyPairs& pairs) const;
    void ignore(std::span<const ProxyPair> pairs, btDispatcher* dispatcher);
    void stopIgnoring(std::span<const ProxyPair> pairs, btDispatcher* dispatcher);
    void renewPairsOfOtherCache(btBroadphaseProxy& proxy, btDispatcher* dispatcher);
    void removePairsOf(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);
    void endProxy(Proxy& proxy, int uniqueId, std::uint64_t changeCount, btDispatcher* dispatcher);
    // Copies the proxies' unique ids, to detect later which proxies were destroyed by callbacks.
    static void noteIds(std::span<btBroadphaseProxy* const> proxies, std::vector<int>& ids);
    static void checkNamedOnce(std::span<const int> ids);
    // Returns whether this broadphase, or another world of its WorldsBroadphase, is calculating on this thread.
    [[nodiscard]] bool isCalculating() const noexcept {
        return detail::QueryScope::isWithin(idCounter_);
    }
    void dropLastProxies() noexcept;
    void releaseAfterPeak() noexcept;
    void forPairs(bool isOnThreads, std::size_t count, LoopBody body) const;
    void findBulletPairs(std::span<const ProxyPair> pairs,
                         std::vector<BulletProxyPair>& bulletPairs, std::size_t first = 0) const;
    [[nodiscard]] PairChanges updatePairs();
    void endCalculation(btDispatcher* dispatcher);
    void apply(const PairChanges& changes, std::size_t birthsAtOnce, btDispatcher* dispatcher);
    void applyToCache(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                      btDispatcher* dispatcher);
    void catchUp(btDispatcher* dispatcher);
    void putBackWhatWasTakenOut(btDispatcher* dispatcher);
    void askIfMoreWasTakenOut(btDispatcher* dispatcher);
    [[nodiscard]] bool areGroupsKnown(const Proxy& proxy) const noexcept;
    [[nodiscard]] bool isEager(Proxy& proxy, const btDispatcher* dispatcher);
    [[nodiscard]] bool mayBeEager(const Proxy& proxy, const btDispatcher* dispatcher) const;
    [[nodiscard]] static bool canClientBeLookedAt(const Proxy& proxy,
                                                  const btDispatcher* dispatcher) noexcept;
    [[nodiscard]] bool mayHaveGhosts() const noexcept {
        return config_.eagerGhosts &&
               (watch_.cache == nullptr || watch_.cache->getInternalGhostPairCallback() != nullptr);
    }
    [[nodiscard]] bool isGhost(Proxy& proxy, const btDispatcher* dispatcher);
    [[nodiscard]] std::vector<ProxyId> ghostsAt(const Proxy& proxy) const;
    void findPairsNow(const Proxy& proxy, btDispatcher* dispatcher);
    void findGhostPairsNow(const Proxy& proxy, btDispatcher* dispatcher);
    // Implements setMargin(), and setAabb() in the general case.
    void setAnyAabb(Proxy& proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                    btScalar margin, btDispatcher* dispatcher);
    // Returns true if setting this box adds no pairs immediately. See detail/lone_moves.inl.
    [[nodiscard]] bool movesAlone(const Proxy& proxy, const btVector3& aabbMin,
                                  const btVector3& aabbMax, const btDispatcher* dispatcher) const;
    [[nodiscard]] static Aabb<btScalar> grown(const Aabb<btScalar>& box, btScalar margin);
    [[nodiscard]] std::size_t ghostCount() const noexcept;
    void move(const Proxy& proxy, const Aabb<btScalar>& box);
    void moveOnItsWay(const Proxy& proxy, const Aabb<btScalar>& box);
    [[nodiscard]] bool doMeet(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const;
    using IsPair = FunctionRef<bool(const btBroadphasePair& pair)>;
    void removeDeferred(IsPair isPair, btDispatcher* dispatcher);
    void freeCut(const btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    [[nodiscard]] bool isAccepted(const btBroadphasePair& pair) const {
        return pairCache_->needsBroadphaseCollision(pair.m_pProxy0, pair.m_pProxy1);
    }
    // Call it before any change, because an assertion handler may throw.
    void checkMayChange() const {
        HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), detail::kMustNotChange);
    }
    [[nodiscard]] Proxy* checkedProxy(btBroadphaseProxy* proxy) const {
        HASHPHASE_ASSERT(
            proxy != nullptr && grid_.contains(idOf(proxy)) && proxyAt(idOf(proxy).index) == proxy,
            "A proxy is null, destroyed or of another broadphase. Pass a live proxy of this one.");
        return static_cast<Proxy*>(proxy);
    }

    friend class WorldsBroadphase;
    friend class detail::LivingBroadphase;
    friend class detail::BroadphaseImage;
    friend struct detail::CacheWatch;
    SpatialHashConfig config_;
    Grid<btScalar> grid_;
    std::unique_ptr<Sweeps<btScalar>> sweeps_;  // null if no proxy may sweep
    Pairs<btScalar> pairs_;

    detail::StableArray<Proxy> proxies_;  // indexed by ProxyId::index
    std::vector<int> uniqueIds_;          // indexed by ProxyId::index; 0 if no proxy is alive
    int* idCounter_ = &lastUniqueId_;     // counts unique ids; all worlds share one counter
    int lastUniqueId_ = 0;
    detail::PeakWatch peaks_;  // capacity of the cache over time
    std::uint16_t worldNumber_ = 0;
    bool groupsDecide_ = false;            // groups and masks decide, not a callback
    bool mustNoteGroups_ = false;          // must read the groups of all proxies
    bool isCacheBehind_ = false;           // some changes did not reach the cache
    bool isApplying_ = false;              // this broadphase is changing the cache
    bool mayGrow_ = sweeps_ != nullptr;    // some boxes may sweep or have a margin
    std::unique_ptr<PairCache> ownCache_;  // null if a cache was given
    detail::CacheWatch watch_{*this};      // watches the cache if it is known to be a PairCache
    btOverlappingPairCache* pairCache_ = nullptr;
    btBroadphasePairArray* cut_ = nullptr;  // of a cache that defers removal: pairs yet to be freed
    detail::GroupKinds groupKinds_;
    detail::GroupKinds::Set changedKinds_ = 0;  // kinds of proxies that changed since the update
    std::vector<std::uint64_t> seen_;           // one bit per index: groups read since the update
    std::size_t seenCount_ = 0;
    std::unique_ptr<detail::FlatSet> ghosts_;  // indices of ghosts; null before the first ghost
    std::vector<BulletProxyPair> died_;        // scratch for PairLists
    std::vector<BulletProxyPair> born_;
    std::uint64_t cacheChangeCount_ = 0;  // number of changes of the cache by this broadphase
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
