// SPDX-License-Identifier: Zlib
#pragma once

// The spatial hash as Bullet's broadphase:
//
//     hashphase::SpatialHashBroadphase broadphase;  // instead of btDbvtBroadphase
//
// Pairs are exact. Only calculateOverlappingPairs() makes and removes them. Exception: a ghost gets its pairs at once
// when it is created or moved, and when another object is created at its place or jumps there.
//
// Threads   Rays and aabbTest(): any number at the same time, also nested. Everything else needs the broadphase for
//           itself, as in Bullet.
// Units     the world's, of any size
// Clients   btCollisionObjects or NULL. Other types need eagerGhosts off, and no sweeps, closestRay() or
//           collisionChecksChanged().
// Bad data  A box with a NaN makes no pair and is reported once (diagnostics.hpp). Infinite, huge and inverted
//           boxes are compared exactly by their coordinates. A NULL dispatcher is fine.
// Callbacks of rayTest(), aabbTest(), closestRay(), the pair cache and the dispatcher may query, and create, move
//           and destroy proxies. A destroyed proxy is not reported any more; a moved or created one may be
//           reported, once more, or not. Do not remove an object that Bullet is working on. The overlap filter may
//           only query. No callback may call calculateOverlappingPairs(), shiftOrigin(), resetPool() or
//           releaseUnusedMemory(). Asserted.
// Memory    Throws std::bad_alloc when memory runs out; repeat the call. A failed createProxy() has created
//           nothing, a failed shiftOrigin() has shifted nothing, a failed setAabb() has moved the proxy. The next
//           calculateOverlappingPairs() that returns completes the cache and ghosts' pairs.
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

    /// Uses `pairCache`, which must outlive the broadphase; with nullptr, as above. A PairCache is changed in
    /// batches, any other cache pair by pair. Asserted: the cache has no pairs yet.
    explicit SpatialHashBroadphase(PairCache* pairCache, const SpatialHashConfig& config = {});
    explicit SpatialHashBroadphase(btOverlappingPairCache* pairCache,
                                   const SpatialHashConfig& config = {});
    explicit SpatialHashBroadphase(std::nullptr_t, const SpatialHashConfig& config = {});

    ~SpatialHashBroadphase() override;
    SpatialHashBroadphase(const SpatialHashBroadphase&) = delete;
    SpatialHashBroadphase& operator=(const SpatialHashBroadphase&) = delete;

    // --- btBroadphaseInterface -------------------------------------------------------------------

    /// Returns a proxy with a fixed address. m_uniqueId counts 1, 2, 3 ...; a number is reused only after
    /// resetPool(), or when a WorldSnapshot goes back. Ignores `shapeType`. Throws std::length_error beyond 2^28
    /// proxies, and after 2^31 - 1 unique ids until resetPool(). Cost: O(1), and a look at up to 1,024 ghosts, or a
    /// box query if there are more. For ghosts and SpatialHashConfig::eagerGroups also Pairs::findPairsNow() and
    /// the pairs.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;

    /// Removes the proxy's pairs through the pair cache, then the proxy. Cost: as the cache; with PairCache the
    /// proxy's pairs.
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// Sets the proxy's box. If groups and masks decide (see SpatialHashConfig::filterRefusesMore), also notices
    /// that they have changed, even if the box has not. Cost: O(1), or a comparison for an unchanged box; with
    /// SpatialHashConfig::sweep a look at the body. For ghosts, eagerGroups, and a box that does not touch the last
    /// one: as createProxy().
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;

    /// Returns the box last set, without its margin, also for a sweeping proxy.
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// Calls rayCallback.process() once for every proxy whose box, grown by the cast box (aabbMin, aabbMax), passes
    /// btRayAabb2() with the callback's own fields. Sees every box as last set. Order: roughly from near to far; do
    /// not rely on it. A ray with NaN or infinite ends, or without length, finds nothing. For a ray too long to be
    /// squared, Bullet's fields are NaN or zero, as under btDbvtBroadphase: use grid() with a RayRegion. Cost: the
    /// boxes near the ray; at most one test for each proxy.
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

    /// Makes the cache's pairs exact: it then holds precisely the pairs of overlapping proxies that its filter
    /// accepts, and with SpatialHashConfig::sweep those that meet on their ways. Persisting pairs are not touched.
    /// Order: parted pairs go first, then new pairs come, each in the order of their proxies. Changes and order
    /// depend on the boxes before and now, not on the calls between. Last, pairs that the program took out of the
    /// cache return, unless the filter refuses them now. In a cache not given as a PairCache, they stay out until
    /// the two meet again.
    /// Groups and masks may be written at any time. A new pair then begins after a move or setAabb() of one of the
    /// two; a present pair lasts until its boxes part.
    /// Cost: as Pairs::update(), and the cache for each pair that comes or goes. Enters BT_PROFILE zones.
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// Returns the box around all boxes with margins; zero if there are none. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// If no proxy is alive, makes the broadphase as new: m_uniqueId counts from 1, and the next calls give pairs,
    /// orders and frees of algorithms as at first. Frees memory, as Grid::clear(). Does nothing while a proxy is
    /// alive. Reset Bullet's own memory by the solver's reset(). Asserted: not within callbacks.
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet; see lastCost() and memoryBytes().
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// Creates a proxy for each definition, in order, into `proxies`. If memory runs out, only the proxies written
    /// so far are created. Cost: as createProxy() for each.
    void createProxies(std::span<const ProxyDefinition> definitions,
                       std::span<btBroadphaseProxy*> proxies, btDispatcher* dispatcher);

    /// Sets the box of each proxy, in order, with the result of single calls. Uses the threads of
    /// SpatialHashConfig::parallelFor, unless boxes sweep, a proxy is named twice, or a callback has changed pairs.
    /// If memory runs out, some boxes are set: repeat the call. Cost: as setAabb() for each.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);

    /// Removes the pairs of all the proxies through the pair cache, then the proxies. Pairs go in the order of
    /// proxies; for a PairCache see PairCache::removeOverlappingPairsContainingProxies(). Asserted: each proxy is
    /// named once. Cost: as the cache; with a PairCache at most one pass over all pairs.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet ---------------------------------------------------------------------------

    /// As btCollisionWorld::rayTest(), but goes from near to far, and only as far as a nearer hit is possible.
    /// Reports no hit more than 2 cm behind callback.m_closestHitFraction. A ClosestRayResultCallback gets an equal
    /// result, but may keep another of several hits at one fraction. Soft bodies need rayTest() of their world.
    /// Returns the cost. Cost: at most rayTest(), and a cast at the shape of each found proxy.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    /// rayTest() and closestRay() for many rays, each with its own callback. Hits about equally near may come in
    /// another order than by single calls. If `parallelFor` is parallel, callbacks run at the same time and must
    /// change nothing. Cost: as the single rays, or less.
    void rayTests(std::span<const BroadphaseRay> rays, ParallelFor parallelFor = serialFor);
    void closestRays(std::span<const ClosestRay> rays, ParallelFor parallelFor = serialFor) const;

    /// Asks the filter again about every proxy that this one overlaps, or met on its way; adds and removes pairs at
    /// once. Call it after a change of its group or mask, or of the filter. Persisting pairs keep their contacts:
    /// for changes of shape see shapeChanged(). Cost: as Pairs::refilter(), and the proxy's pairs.
    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// For many proxies, in one pass: asks the filter once about each two. Cost: as Pairs::refilter() for many, and
    /// their pairs.
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    /// refilter() for all proxies, after a change of the filter callback or its data. Cost: as
    /// Pairs::refilterAll(), and the pairs that come and go.
    void refilterAll(btDispatcher* dispatcher);

    /// Grows the proxy's box by `margin` [m] on all sides, also on its way if it sweeps. Two proxies are a pair if
    /// their boxes overlap, each grown by its own margin. Queries find the proxy by the grown box; getAabb(),
    /// m_aabbMin and m_aabbMax keep the set box. Takes effect at once, as setAabb() with the present box. A new
    /// proxy has no margin, also after refreshBroadphaseProxy(). To Bullet, a pair within margins is a pair: two
    /// dynamic bodies sleep only together, and have a narrow phase while awake. Asserted: `margin` is finite, and 0
    /// or more; otherwise nothing changes. Cost: as setAabb().
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;

    /// From now on the two are no pair, whatever groups, masks and the filter say: see Pairs::ignore(). A present
    /// pair and its contacts end at once; with PairOrder::canonical, the algorithm ends when the cache is read
    /// next. Lasts until stopIgnoringPair(), or until one proxy is destroyed, also by refreshBroadphaseProxy().
    /// Asserted: the two differ. Cost: O(1), and the cache; one with deferred removal: a pass over its pairs.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    /// If the two overlap and the filter accepts them, they are a pair at once. Cost: as ignorePair().
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;

    /// Makes the ignored pairs of this proxy those that Bullet's dispatcher refuses: with objects in the world that
    /// its client lists by setIgnoreCollisionCheck(). Its other ignored pairs end, also from ignorePair(), unless
    /// the other object lists this one. Call it for the object with the list: when the list has changed (also by
    /// removeConstraint(), or addConstraint() with disableCollisionsBetweenLinkedBodies), and when it or a listed
    /// object was added. A list may name objects that are gone. Cost: a pass over all proxies and ignored pairs.
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    /// For many proxies, in one pass.
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);

    /// Frees the algorithms and contacts of the proxy's pairs, also in ghosts; the pairs stay. Call it after a
    /// change of shape, scale, margin or other contact data, with btCollisionWorld::updateSingleAabb(), before the
    /// next step. Calls the ghost callback for the end and the beginning of each pair (twice for an end that it
    /// causes itself), unless the cache has deferred removal. Cost: as PairCache::renewPairsContainingProxy(), or a
    /// pass over pairs.
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Subtracts `shift` from every box: see Grid::shiftOrigin(). Pairs stay; if rounding brings boxes together,
    /// the next calculateOverlappingPairs() makes them pairs. To move the objects as well, call shiftWorldOrigin()
    /// (origin_shift.hpp). Returns how many boxes were rounded. Cost: a pass over the proxies, and
    /// Grid::shiftOrigin().
    std::size_t shiftOrigin(const btVector3& shift);

    /// The grid, for queries that Bullet does not have. proxyOf() returns the proxy of an id, whose m_clientObject
    /// is the btCollisionObject; for an index: proxyOf(grid().idAt(index)). idOf() takes proxies of this class.
    /// Asserted: the proxy is alive.
    [[nodiscard]] const Grid<btScalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] btBroadphaseProxy* proxyOf(ProxyId id) const;
    [[nodiscard]] static ProxyId idOf(const btBroadphaseProxy* proxy);

    /// Returns which proxies sweep, and how far; nullptr unless SpatialHashConfig::sweep is set. The grid has the
    /// box around the way; Sweeps::visit() searches the way, and Sweeps::motion() returns it.
    [[nodiscard]] const Sweeps<btScalar>* sweeps() const noexcept { return sweeps_.get(); }

    [[nodiscard]] const SpatialHashConfig& config() const noexcept { return config_; }

    [[nodiscard]] const PairCost& lastCost() const noexcept { return pairs_.lastCost(); }

    /// Returns the bytes held, with Bullet's proxies, and with the pair cache if the broadphase made it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back unused memory: of the grid, pairs and sweeps (see Grid::releaseUnusedMemory()), of a PairCache,
    /// and of the last destroyed proxies. Do not use their addresses any more; assertions do not catch this.
    /// calculateOverlappingPairs() does it by itself after 256 calls in a row with room for more than eight times
    /// the proxies or pairs. Asserted: not within a callback. Cost: O(grid().indexLimit()), and moving the rest.
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant of grid, sweeps, pairs or its own PairCache in a sentence; empty if all hold.
    /// Also:
    /// - The cache holds as many pairs as the set of pairs (its own cache, if the program took out none since).
    [[nodiscard]] std::string validate() const;

private:
    /// The known kind of a client.
    enum class Client : std::uint8_t { unknown, ghost, other };

    struct Proxy : btBroadphaseProxy {
        ProxyId id;
        Client client = Client::unknown;
        std::uint8_t kind = 0;    // of its groups, as the grid knows them, in groupKinds_
        std::uint16_t world = 0;  // of a WorldsBroadphase
        btScalar margin = 0;      // by which the grid's box is larger on each side [m]
    };
    struct PairLists;
    class Applying;
    class AabbBatch;
    template <class Callback>
    struct ProcessCollector;

    // One of many worlds: spatial_hash_world.cpp.
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

    // Not const, as Bullet takes no const proxies.
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
    // To see which proxies callbacks have destroyed.
    static void noteIds(std::span<btBroadphaseProxy* const> proxies, std::vector<int>& ids);
    static void checkNamedOnce(std::span<const int> ids);
    // Whether it, or another world of its WorldsBroadphase, calculates on this thread.
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
    // setAabb() with all its effects, and setMargin().
    void setAnyAabb(Proxy& proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                    btScalar margin, btDispatcher* dispatcher);
    // Whether a move finds no pairs at once: detail/lone_moves.inl.
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
    // Before any change, as an assertion handler may throw.
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
    std::unique_ptr<Sweeps<btScalar>> sweeps_;  // if configured
    Pairs<btScalar> pairs_;

    detail::StableArray<Proxy> proxies_;  // by ProxyId::index
    std::vector<int> uniqueIds_;          // by ProxyId::index; 0 if no proxy is alive
    int* idCounter_ = &lastUniqueId_;     // or the counter of all worlds
    int lastUniqueId_ = 0;
    detail::PeakWatch peaks_;  // of the cache
    std::uint16_t worldNumber_ = 0;
    bool groupsDecide_ = false;            // which proxies may pair, not a callback
    bool mustNoteGroups_ = false;          // of all
    bool isCacheBehind_ = false;           // some changes did not reach it
    bool isApplying_ = false;              // changes to the cache
    bool mayGrow_ = sweeps_ != nullptr;    // some boxes, which sweep or have a margin
    std::unique_ptr<PairCache> ownCache_;  // if none was given
    detail::CacheWatch watch_{*this};      // of the cache, if it is known to be a PairCache
    btOverlappingPairCache* pairCache_ = nullptr;
    detail::GroupKinds groupKinds_;
    detail::GroupKinds::Set changedKinds_ = 0;  // of proxies changed since the last update
    std::vector<std::uint64_t> seen_;           // slots whose groups are known since then; or empty
    std::size_t seenCount_ = 0;
    std::unique_ptr<detail::FlatSet> ghosts_;  // their slots; made with the first
    std::vector<BulletProxyPair> died_;        // scratch of PairLists
    std::vector<BulletProxyPair> born_;
    std::uint64_t cacheChangeCount_ = 0;  // calls that changed it, and called back
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
