// SPDX-License-Identifier: Zlib
#pragma once

// The spatial hash as Bullet's broadphase:
//
//     hashphase::SpatialHashBroadphase broadphase;  // instead of btDbvtBroadphase
//
// Pairs are exact. createProxy() and setAabb() leave pairs to calculateOverlappingPairs(). Exceptions: eagerGroups,
// and ghosts. A ghost gets its pairs at once when it is created or moved, and when another object is created in its
// box or jumps into it.
//
// Threads   Ray queries and aabbTest() may run on any number of threads at the same time, also nested. During any
//           other call, no other thread may use the broadphase, as in Bullet.
// Units     those of the world, whatever they are
// Clients   btCollisionObjects or NULL. With other types, set eagerGhosts to false, and do not use sweeps,
//           closestRay() or collisionChecksChanged().
// Bad data  A box with a NaN makes no pair; the first such box is reported (diagnostics.hpp). Infinite, huge and
//           inverted boxes are compared exactly by their coordinates. The dispatcher may be NULL.
// Callbacks Callbacks of rayTest(), aabbTest(), closestRay(), the pair cache and the dispatcher may query, and
//           create, move and destroy proxies. A query does not report destroyed proxies. It may report or skip a
//           created or moved proxy, and may report a moved proxy twice. Do not remove an object that Bullet is
//           working on. The overlap filter may only query. No callback may call calculateOverlappingPairs(),
//           shiftOrigin(), resetPool() or releaseUnusedMemory(). The last two rules are asserted.
// Memory    Throws std::bad_alloc when memory runs out; repeat the call. A failed createProxy() has created nothing.
//           A failed shiftOrigin() has shifted nothing. A failed setAabb() has moved the proxy. The next
//           calculateOverlappingPairs() that returns completes the pairs of the cache and of ghosts.
// Misuse    Asserted: proxies are alive and of this broadphase, spans of a batch have equal lengths, rays have
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
    /// Makes and owns a PairCache. Throws std::invalid_argument with configError(config).
    explicit SpatialHashBroadphase(const SpatialHashConfig& config = {});

    /// Uses `pairCache`, which must outlive the broadphase; with nullptr, makes its own as above. Changes a PairCache
    /// in batches, and any other cache pair by pair. Asserted: the cache has no pairs yet.
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
    /// and after 2^31 - 1 unique ids until resetPool(). Cost: O(1), and one test for each ghost, or one box query for
    /// more than 1,024 ghosts. For a ghost, or with SpatialHashConfig::eagerGroups, also Pairs::findPairsNow() and
    /// O(1) for each new pair.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;

    /// Removes the proxy's pairs through the pair cache, then the proxy. Cost: as the cache; with a PairCache,
    /// O(proxy's pairs).
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// Sets the proxy's box. If groups and masks decide (see SpatialHashConfig::filterRefusesMore), also reads the
    /// proxy's group and mask, even if the box is unchanged. Cost: O(1); one comparison for an unchanged box; with
    /// SpatialHashConfig::sweep, also the box of the body's shape. For ghosts, eagerGroups, and a box that does not
    /// touch the previous box: as createProxy().
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;

    /// Returns the box as last set, without margin; a sweep does not change it.
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// Calls rayCallback.process() once for every proxy whose box, grown by the cast box (aabbMin, aabbMax), passes
    /// btRayAabb2() with the callback's own fields. Sees every box as last set. Order: roughly from near to far; do
    /// not rely on it. A ray with NaN or infinite ends, or of length 0, finds nothing. If the square of a ray's
    /// length overflows, Bullet's fields are NaN or zero, as under btDbvtBroadphase. For such rays, query grid() with
    /// a RayRegion. Cost: the boxes near the ray; at most one test for each proxy.
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
    /// filter accepts. With SpatialHashConfig::sweep, also pairs of proxies that meet on their paths. Pairs that
    /// persist are not touched. Order: first removes the separated pairs, then adds the new pairs, both sorted by
    /// their proxies. Changes and order depend on the boxes before and now, not on the calls between. Finally adds
    /// the pairs that the program removed from the cache, unless the filter now refuses them. A cache not given as a
    /// PairCache gets such pairs back only when the proxies meet again.
    /// You may write groups and masks at any time. A newly allowed pair begins after a move or setAabb() of one of
    /// its proxies. A present pair lasts until its boxes separate.
    /// Cost: as Pairs::update(), and the cache for each added or removed pair. Enters BT_PROFILE zones.
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// Returns the box around all boxes with margins; zero without proxies. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// If no proxy is alive, resets the broadphase. Afterwards, equal calls give the results of a new broadphase,
    /// also m_uniqueId (from 1), the order of pairs, and the order of freed algorithms. Frees memory, as
    /// Grid::clear(). Does nothing while a proxy is alive. To reset Bullet's own state, call the solver's reset().
    /// Asserted: not within callbacks.
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet; see lastCost() and memoryBytes().
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// Creates a proxy for each definition, in order, and writes it to `proxies`. If memory runs out, only the
    /// proxies written so far are created. Cost: as createProxy() for each.
    void createProxies(std::span<const ProxyDefinition> definitions,
                       std::span<btBroadphaseProxy*> proxies, btDispatcher* dispatcher);

    /// Sets the box of each proxy, in order. The result equals single calls. Runs on the threads of
    /// SpatialHashConfig::parallelFor, but on the caller's thread with sweeps, with duplicates in `proxies`, and
    /// after a callback has changed pairs. If memory runs out, some boxes are set: repeat the call. Cost: as
    /// setAabb() for each.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);

    /// Removes the pairs of all these proxies through the pair cache, proxy by proxy, and then the proxies. For the
    /// order in a PairCache see PairCache::removeOverlappingPairsContainingProxies(). Asserted: `proxies` has no
    /// duplicates. Cost: as the cache; with a PairCache at most one pass over all pairs.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet ---------------------------------------------------------------------------

    /// As btCollisionWorld::rayTest(), but tests objects from near to far, and stops when no nearer hit is possible.
    /// Reports no hit more than 2 cm behind callback.m_closestHitFraction. A ClosestRayResultCallback gets an equal
    /// result, but may keep another of several hits at an equal fraction. For soft bodies, use rayTest() of their
    /// world. Returns the cost. Cost: at most rayTest(), and a cast at the shape of each found proxy.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    /// rayTest() and closestRay() for many rays, each with its own callback. Hits at nearly equal distance may come
    /// in another order than by single calls. With a parallel `parallelFor`, callbacks run at the same time, and must
    /// not change the broadphase or shared data. Cost: as the single rays, or less.
    void rayTests(std::span<const BroadphaseRay> rays, ParallelFor parallelFor = serialFor);
    void closestRays(std::span<const ClosestRay> rays, ParallelFor parallelFor = serialFor) const;

    /// Asks the filter again about every proxy that `proxy` overlaps, or met on its path in the last calculation.
    /// Adds and removes pairs at once. Call it after a change of the proxy's group or mask, or of the filter.
    /// Persisting pairs keep their contacts; after a change of shape, call shapeChanged(). Cost: as
    /// Pairs::refilter(), and the proxy's pairs.
    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// As above for many proxies, but asks the filter only once about every pair. Cost: as Pairs::refilter() for
    /// many, and the proxies' pairs.
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    /// refilter() for all proxies, after a change of the filter callback or its data. Cost: as Pairs::refilterAll(),
    /// and the cache for each added or removed pair.
    void refilterAll(btDispatcher* dispatcher);

    /// Grows the proxy's box by `margin` [m] on all sides, also along the path of a sweep. Two proxies are a pair if
    /// their grown boxes overlap. Queries find the proxy by the grown box; getAabb(), m_aabbMin and m_aabbMax keep
    /// the set box. Takes effect at once, as setAabb() with the present box. A new proxy has no margin;
    /// refreshBroadphaseProxy() makes a new proxy. Bullet treats a pair within margins like any other: two dynamic
    /// bodies fall asleep only together, and have a narrow phase while awake. Asserted: `margin` is finite and not
    /// negative; otherwise nothing changes. Cost: as setAabb().
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;

    /// From now on, the two proxies do not pair, whatever groups, masks and the filter decide (see Pairs::ignore()).
    /// An existing pair is removed at once. Its algorithm and contacts are freed at once, or with
    /// PairOrder::canonical when the cache is next read. Lasts until stopIgnoringPair(), or until one proxy is
    /// destroyed, also by refreshBroadphaseProxy(). Asserted: the proxies differ. Cost: O(1), and the cache; with
    /// deferred removal, a pass over its pairs.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    /// If the proxies overlap and the filter accepts them, adds their pair at once. Cost: as ignorePair().
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;

    /// Updates the ignored pairs of this proxy to the pairs that Bullet's dispatcher refuses. Ignores its pairs with
    /// objects in the world that its client lists by setIgnoreCollisionCheck(). Stops ignoring its other pairs, also
    /// pairs of ignorePair(). Exception: pairs whose other object lists this proxy's client. Call it for the object
    /// with the list: when the list has changed (also by removeConstraint(), or addConstraint() with
    /// disableCollisionsBetweenLinkedBodies), and when this object or a listed object was added to the world. A list
    /// may contain destroyed objects. Cost: a pass over all proxies and ignored pairs.
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    /// As above for many proxies, in one pass.
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);

    /// Frees the algorithms and contacts of the proxy's pairs, also in ghosts; the pairs stay. After a change of
    /// shape, scale, collision margin or other contact data, call it and btCollisionWorld::updateSingleAabb() before
    /// the next step. Calls the ghost callback as if each pair was removed and added again, except with deferred
    /// removal. If the callback itself removes the pair, it is called again for this removal. Cost: as
    /// PairCache::renewPairsContainingProxy(); with another cache, a pass over all pairs.
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Subtracts `shift` from every box: see Grid::shiftOrigin(). Pairs stay. If rounding makes boxes overlap, the
    /// next calculateOverlappingPairs() adds their pairs. To shift the objects too, call shiftWorldOrigin()
    /// (origin_shift.hpp). Returns how many boxes were rounded. Cost: O(proxies), and Grid::shiftOrigin().
    std::size_t shiftOrigin(const btVector3& shift);

    /// The grid, for queries that Bullet does not have. proxyOf(id) returns the proxy with this id; its
    /// m_clientObject is the btCollisionObject. For an index, call proxyOf(grid().idAt(index)). idOf() takes only
    /// proxies of this class. Asserted: the proxy is alive.
    [[nodiscard]] const Grid<btScalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] btBroadphaseProxy* proxyOf(ProxyId id) const;
    [[nodiscard]] static ProxyId idOf(const btBroadphaseProxy* proxy);

    /// With SpatialHashConfig::sweep, returns which proxies sweep, and how far; otherwise nullptr. The grid has the
    /// box around the whole path. Sweeps::visit() searches along the path, and Sweeps::motion() returns it.
    [[nodiscard]] const Sweeps<btScalar>* sweeps() const noexcept { return sweeps_.get(); }

    [[nodiscard]] const SpatialHashConfig& config() const noexcept { return config_; }

    [[nodiscard]] const PairCost& lastCost() const noexcept { return pairs_.lastCost(); }

    /// Returns the bytes held, including the proxies, and the pair cache if the broadphase made it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees unused memory of the grid, pairs and sweeps (see Grid::releaseUnusedMemory()), of a PairCache, and of
    /// destroyed proxies with the highest indices. Do not use pointers to destroyed proxies afterwards: assertions
    /// cannot detect this. calculateOverlappingPairs() frees memory by itself after 256 calls in a row with capacity
    /// for more than eight times the proxies or pairs. Asserted: not within a callback. Cost: O(grid().indexLimit()),
    /// and moving the rest.
    void releaseUnusedMemory() noexcept;

    /// Returns a sentence about the broken invariant of the grid, sweeps, pairs or own PairCache; empty if all hold.
    /// Also:
    /// - The own cache holds as many pairs as the set of pairs, if the program has not removed any since.
    [[nodiscard]] std::string validate() const;

private:
    /// What is known about a client.
    enum class Client : std::uint8_t { unknown, ghost, other };

    struct Proxy : btBroadphaseProxy {
        ProxyId id;
        Client client = Client::unknown;
        std::uint8_t kind = 0;    // index in groupKinds_ of the groups that the grid has
        std::uint16_t world = 0;  // index of its world in a WorldsBroadphase
        btScalar margin = 0;      // the grid's box is larger by this on each side [m]
    };
    struct PairLists;
    class Applying;
    class AabbBatch;
    template <class Callback>
    struct ProcessCollector;

    // For a WorldsBroadphase, which has many: spatial_hash_world.cpp.
    SpatialHashBroadphase(const SpatialHashConfig& config, PairCache& sharedCache,
                          int& sharedUniqueId, std::uint16_t worldNumber);
    [[nodiscard]] bool isUpToDate() const noexcept;
    void listChanges(const PairChanges& changes, std::vector<BulletProxyPair>& died,
                     std::vector<BulletProxyPair>& born) const;
    void listAll(std::vector<BulletProxyPair>& bulletPairs) const;
    [[nodiscard]] Aabb<btScalar> bounds() const;  // of all proxies
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

    // Returns a non-const proxy, because Bullet takes no const proxies.
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
    // Copies the ids, to see which proxies callbacks destroy.
    static void noteIds(std::span<btBroadphaseProxy* const> proxies, std::vector<int>& ids);
    static void checkNamedOnce(std::span<const int> ids);
    // Whether this broadphase, or another world of its WorldsBroadphase, is calculating on this thread.
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
    // The general case of setAabb(), and setMargin().
    void setAnyAabb(Proxy& proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                    btScalar margin, btDispatcher* dispatcher);
    // Whether setting this box finds no pairs at once: detail/lone_moves.inl.
    [[nodiscard]] bool movesAlone(const Proxy& proxy, const btVector3& aabbMin,
                                  const btVector3& aabbMax, const btDispatcher* dispatcher) const;
    [[nodiscard]] static Aabb<btScalar> grown(const Aabb<btScalar>& box, btScalar margin);
    [[nodiscard]] std::size_t ghostCount() const noexcept;
    void move(const Proxy& proxy, const Aabb<btScalar>& box);
    void moveOnItsWay(const Proxy& proxy, const Aabb<btScalar>& box);
    [[nodiscard]] bool doMeet(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const;
    using IsPair = FunctionRef<bool(const btBroadphasePair& pair)>;
    void removeDeferred(IsPair isPair, btDispatcher* dispatcher);
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
    std::unique_ptr<Sweeps<btScalar>> sweeps_;  // null without sweeps
    Pairs<btScalar> pairs_;

    detail::StableArray<Proxy> proxies_;  // by ProxyId::index
    std::vector<int> uniqueIds_;          // by ProxyId::index; 0 without a live proxy
    int* idCounter_ = &lastUniqueId_;     // or the counter that all worlds share
    int lastUniqueId_ = 0;
    detail::PeakWatch peaks_;  // capacity of the cache over time
    std::uint16_t worldNumber_ = 0;
    bool groupsDecide_ = false;            // groups and masks decide, not a callback
    bool mustNoteGroups_ = false;          // must read the groups of all proxies
    bool isCacheBehind_ = false;           // some changes did not reach the cache
    bool isApplying_ = false;              // is changing the cache
    bool mayGrow_ = sweeps_ != nullptr;    // some boxes may sweep or have a margin
    std::unique_ptr<PairCache> ownCache_;  // null if a cache was given
    detail::CacheWatch watch_{*this};      // watches a cache that is known as a PairCache
    btOverlappingPairCache* pairCache_ = nullptr;
    detail::GroupKinds groupKinds_;
    detail::GroupKinds::Set changedKinds_ = 0;  // kinds of proxies changed since the last update
    std::vector<std::uint64_t> seen_;           // bits by index: groups read since the update
    std::size_t seenCount_ = 0;
    std::unique_ptr<detail::FlatSet> ghosts_;  // indices of ghosts; null before the first ghost
    std::vector<BulletProxyPair> died_;        // scratch of PairLists
    std::vector<BulletProxyPair> born_;
    std::uint64_t cacheChangeCount_ = 0;  // changes of the cache by this broadphase
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
