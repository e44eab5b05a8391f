// SPDX-License-Identifier: Zlib
#pragma once

// The spatial hash as Bullet's broadphase:
//
//     hashphase::SpatialHashBroadphase broadphase;  // in place of btDbvtBroadphase
//
// What changes: pairs are exact (no fat boxes, no stale pairs), and are made and removed only in
// calculateOverlappingPairs(). Pairs of ghost objects come at once, when the ghost is created or moved, and
// when another object is created where the ghost stands, or jumps there.
//
// Batches   createProxies(), setAabbs() and destroyProxies() do what as many single calls do, at less cost.
// Threads   Rays and aabbTest() are const in all but name: any number may run at the same time
//           and inside each other. Everything else needs the broadphase for itself, as in Bullet.
// Units     the world's; nothing depends on their size
// Bad data  A box with a NaN makes no pair and is reported once (diagnostics.hpp). Infinite, huge and
//           inverted boxes are treated exactly as comparing their coordinates says. NULL clients and NULL
//           dispatchers are fine.
// Callbacks of rayTest(), aabbTest() and closestRay(), of the pair cache and of the dispatcher may create,
//           move and destroy proxies, and ask. A destroyed proxy is not reported any more; a moved or created
//           one may be reported, once more, or not. Bullet itself sets limits: do not remove an object that
//           it is working on. The overlap filter may ask but must not change anything, and no callback may
//           call calculateOverlappingPairs(), shiftOrigin(), resetPool() or releaseUnusedMemory(); asserted.
// Memory    Where it runs out, std::bad_alloc is passed on and the call may be repeated: createProxy() has
//           created nothing, shiftOrigin() has shifted nothing, setAabb() has moved the proxy. The first
//           calculateOverlappingPairs() that returns brings the cache up to date, and ghosts' pairs as well.
//           Bullet's own arrays do not report a lack of memory.
// Misuse    Proxies that are not alive or another broadphase's, spans of different lengths in a batch, and
//           rays without a callback are asserted.

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

/// A btBroadphaseInterface over a Grid, in place of btDbvtBroadphase.
class HASHPHASE_BULLET_EXPORT SpatialHashBroadphase : public btBroadphaseInterface,
                                                      private detail::LivingBroadphase {
public:
    /// Makes and owns a PairCache. Throws std::invalid_argument with configError(config).
    explicit SpatialHashBroadphase(const SpatialHashConfig& config = {});

    /// Uses `pairCache`, which must outlive the broadphase and have no pairs yet (asserted); with
    /// nullptr, as above. A cache that is given as a PairCache is changed in batches, any other pair
    /// by pair.
    explicit SpatialHashBroadphase(PairCache* pairCache, const SpatialHashConfig& config = {});
    explicit SpatialHashBroadphase(btOverlappingPairCache* pairCache,
                                   const SpatialHashConfig& config = {});
    explicit SpatialHashBroadphase(std::nullptr_t, const SpatialHashConfig& config = {});

    ~SpatialHashBroadphase() override;
    SpatialHashBroadphase(const SpatialHashBroadphase&) = delete;
    SpatialHashBroadphase& operator=(const SpatialHashBroadphase&) = delete;

    // --- btBroadphaseInterface -------------------------------------------------------------------

    /// Returns a proxy with an address that is fixed for its life. m_uniqueId counts 1, 2, 3 ...; a number is
    /// used again only after resetPool(), or where a WorldSnapshot goes back. `shapeType` is ignored. Throws
    /// std::length_error beyond 2^28 proxies, and after 2^31 - 1 unique ids until resetPool(). Cost: O(1), and a
    /// look at up to 1,024 ghosts, or a box query where there are more; for ghosts and
    /// SpatialHashConfig::eagerGroups also that of Pairs::findPairsNow() and of the pairs.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;

    /// Removes the proxy's pairs through the pair cache, then the proxy. Cost: that of the cache;
    /// with PairCache the number of the proxy's pairs.
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// Sets the proxy's box. Where groups and masks decide (see SpatialHashConfig::filterRefusesMore), also
    /// notices that they have been written, even when the box has not changed. Cost: O(1), or a comparison
    /// when the box has not changed, and with SpatialHashConfig::sweep a look at the body; for ghosts and
    /// eagerGroups, and where the new box does not touch the last one, as createProxy().
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;

    /// Returns the box last set, whether the proxy sweeps or not, without its margin.
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// Calls rayCallback.process() once for every proxy whose box, grown by the cast box (aabbMin, aabbMax),
    /// passes btRayAabb2() with the callback's own fields. Sees every box as it was last set. The order is
    /// roughly from near to far; do not rely on it.
    /// For a ray without a length, or one too long to be squared, Bullet computes a direction of NaN or zero:
    /// the ray finds what these fields say, as under btDbvtBroadphase; without a length nothing. Ask grid()
    /// with a RayRegion there. A ray with NaN or infinite ends finds nothing.
    /// Cost: the boxes near the ray; however long it is, at most one test for each proxy.
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) override;
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) const;

    /// Calls callback.process() once for every proxy whose box overlaps the given one (closed). Cost:
    /// at most one test for each proxy.
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) const;

    /// Makes the cache's pairs exact: afterwards it holds precisely the pairs of overlapping proxies that its
    /// filter accepts, and with SpatialHashConfig::sweep those that meet on their ways. Pairs that persist
    /// are not touched.
    /// Order: pairs that have parted go first, then pairs that have met come, each in the order of their
    /// proxies. Changes and their order follow from the boxes before and now, not from the calls between.
    /// Last, pairs that the program has taken out of the cache come back, unless the filter refuses them by
    /// now; in a cache that was not given as a PairCache they stay out until the two meet again. Groups and
    /// masks may be written at any time: a new pair begins where one of the two was moved since, or
    /// setAabb() called; a present pair lasts until its boxes part.
    /// Cost: that of Pairs::update(), and of the cache for each pair that comes or goes.
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// The box around all boxes and their margins; zero when there is none. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// When no proxy is alive, forgets all that came before: m_uniqueId counts from 1 again, and the next
    /// calls lead to pairs, orders and frees of algorithms as with a new broadphase. Reset Bullet's own
    /// memory yourself, by the solver's reset(). Frees memory, as Grid::clear(). Does nothing while a proxy
    /// is alive. Not called by callbacks (asserted).
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet; ask lastCost() and memoryBytes().
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// Creates a proxy for each definition, in their order, and writes it to `proxies`, which is as long
    /// (asserted). Where memory runs out, the proxies written so far are created, and no others. Cost: as
    /// createProxy() for each proxy.
    void createProxies(std::span<const ProxyDefinition> definitions,
                       std::span<btBroadphaseProxy*> proxies, btDispatcher* dispatcher);

    /// Sets the box of each proxy, in their order; all three spans have the same length (asserted). With
    /// SpatialHashConfig::parallelFor on several threads, unless boxes sweep, a proxy is named twice, or the
    /// cache has changed; with the result of as many single calls. Where memory runs out, some boxes are set:
    /// the call may be repeated. Cost: as setAabb() for each proxy.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);

    /// Removes the pairs of all the proxies through the pair cache, then the proxies, each named once. Pairs
    /// and their algorithms are removed in the order of proxies; for a PairCache see
    /// PairCache::removeOverlappingPairsContainingProxies(). Cost: that of the cache; with a cache given as a
    /// PairCache, at most a pass over all pairs.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet ---------------------------------------------------------------------------

    /// As btCollisionWorld::rayTest(), but goes from near to far, and only as far as a nearer hit is
    /// possible: reports to `callback` the hits of rayTest(), without those more than 2 cm behind
    /// callback.m_closestHitFraction. A ClosestRayResultCallback has an equal result, but may keep another
    /// one of several hits at one fraction. For worlds whose clients are btCollisionObjects; soft bodies
    /// need their world's own rayTest(). Any number of threads. Returns the cost. Cost: at most that of
    /// rayTest(), and a cast at the shape of each proxy that it finds.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    /// rayTest() and closestRay() for many rays: each callback gets what single calls report of its own ray, but
    /// hits that are about as near may come in another order. Each ray has a callback of its own (a missing one is
    /// asserted). Where `parallelFor` is parallel, callbacks run at the same time and must change nothing. Cost:
    /// that of the single rays, or less.
    void rayTests(std::span<const BroadphaseRay> rays, ParallelFor parallelFor = serialFor);
    void closestRays(std::span<const ClosestRay> rays, ParallelFor parallelFor = serialFor) const;

    /// Asks the filter again about every proxy that this one overlaps, or met on its way, and adds and
    /// removes its pairs accordingly, at once. Call it after a change of its group or mask, or of the
    /// filter. Pairs that stay keep their contacts: after a change of shape call shapeChanged(). Cost: that
    /// of Pairs::refilter(), and of the proxy's pairs.
    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// refilter() for many proxies in one pass: the filter is asked once about each two of them. Cost: that
    /// of Pairs::refilter() for many proxies, and of their pairs.
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    /// refilter() for all proxies. Call it after a change of the filter callback, or of the data it reads.
    /// Cost: that of Pairs::refilterAll(), and of the pairs that come and go.
    void refilterAll(btDispatcher* dispatcher);

    /// From now on takes the proxy's box grown by `margin` [m] on all sides, also on its way where it sweeps: two
    /// are a pair when their boxes overlap, each grown by its own margin, and queries find the proxy by the grown
    /// box. proxy->m_aabbMin and m_aabbMax, and getAabb(), stay the box that the program has set. Counts from
    /// this call on, as setAabb() with the present box does: queries see it at once, and a ghost, or one of
    /// eagerGroups, has its pairs at once. A margin that is negative, infinite or NaN is asserted, and changes
    /// nothing. A new proxy has none, also after refreshBroadphaseProxy(). To Bullet, a pair within margins is a
    /// pair: two dynamic bodies sleep only together, and have a narrow phase while awake. Cost: as setAabb().
    void setMargin(btBroadphaseProxy* proxy, btScalar margin, btDispatcher* dispatcher);
    [[nodiscard]] btScalar margin(const btBroadphaseProxy* proxy) const;

    /// From now on the two are no pair, whatever groups, masks and the filter say: see Pairs::ignore(). A present
    /// pair goes at once, and ghosts are told; with its algorithm, under PairOrder::canonical when the cache is next
    /// read. Ends with stopIgnoringPair(), or when one proxy is destroyed, also by refreshBroadphaseProxy(). The two
    /// differ (asserted). Cost: O(1), and that of the cache; of one with deferred removal a pass over its pairs.
    void ignorePair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    /// Where the two overlap, and the filter accepts it, they are a pair at once. Cost: as ignorePair().
    void stopIgnoringPair(btBroadphaseProxy* a, btBroadphaseProxy* b, btDispatcher* dispatcher);
    [[nodiscard]] bool isIgnoredPair(const btBroadphaseProxy* a, const btBroadphaseProxy* b) const;

    /// Makes the ignored pairs of this proxy those that Bullet's dispatcher refuses: with the objects that its
    /// btCollisionObject lists by setIgnoreCollisionCheck(), and that are in the world. Others that it had, those
    /// of ignorePair() too, are ignored no more, unless the other object lists this one. Call it for the one that
    /// lists, when the list has changed, also by addConstraint() with disableCollisionsBetweenLinkedBodies or
    /// removeConstraint(), and when it, or one listed, was added. Clients of it and of whom it ignores are
    /// btCollisionObjects; a list may name some that are gone. Cost: a pass over all proxies and ignored pairs.
    void collisionChecksChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);
    /// The same for many proxies, in one pass.
    void collisionChecksChanged(std::span<btBroadphaseProxy* const> proxies,
                                btDispatcher* dispatcher);

    /// Frees the algorithms and contacts that the proxy's pairs have made from its shape, here and in the
    /// ghosts that list it; the pairs stay. Call it after a change of shape, scale, margin or other data by
    /// which contacts are made, beside btCollisionWorld::updateSingleAabb(), before the next step. A ghost callback
    /// is told that each pair has ended and begun (of an end that it brings about itself twice); a cache with
    /// deferred removal tells nothing. Cost: that of PairCache::renewPairsContainingProxy(), or of a pass over pairs.
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Moves the origin of all coordinates to `shift`: subtracts it from the box of every proxy: see
    /// Grid::shiftOrigin(). Pairs stay as they are; should rounding have brought boxes together, the next
    /// calculateOverlappingPairs() makes them pairs. The objects are not moved: shiftWorldOrigin()
    /// (origin_shift.hpp) shifts a whole world. Returns how many boxes were rounded. Cost: a pass over the
    /// proxies, and that of Grid::shiftOrigin().
    std::size_t shiftOrigin(const btVector3& shift);

    /// The grid, for queries that Bullet does not have. proxyOf() leads from an id back to the proxy, which
    /// is alive (asserted); its m_clientObject is the btCollisionObject. idOf() takes proxies of this class.
    /// For an index: proxyOf(grid().idAt(index)).
    [[nodiscard]] const Grid<btScalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] btBroadphaseProxy* proxyOf(ProxyId id) const;
    [[nodiscard]] static ProxyId idOf(const btBroadphaseProxy* proxy);

    /// Which proxies sweep, and how far; nullptr unless SpatialHashConfig::sweep is set. The grid has the box
    /// around the way; Sweeps::visit() searches the way itself, and Sweeps::motion() returns it.
    [[nodiscard]] const Sweeps<btScalar>* sweeps() const noexcept { return sweeps_.get(); }

    /// The configuration it was made with.
    [[nodiscard]] const SpatialHashConfig& config() const noexcept { return config_; }

    /// What the last calculateOverlappingPairs() cost.
    [[nodiscard]] const PairCost& lastCost() const noexcept { return pairs_.lastCost(); }

    /// Bytes held, including Bullet's own proxies, and the pair cache if the broadphase made it.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back unused memory, after a level was left, say: of the grid, its pairs and sweeps (see
    /// Grid::releaseUnusedMemory()), of a PairCache, and of destroyed proxies at the end. Their addresses
    /// must not be used any more, not even where an assertion would have told of it.
    /// calculateOverlappingPairs() does it by itself when there has been room for more than eight times as
    /// many proxies, or pairs, in 256 calls in a row. Not within a callback (asserted). Cost:
    /// O(grid().indexLimit()), and moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Grid::validate(), Sweeps::validate(), Pairs::validate() and PairCache::validate(), and:
    /// - The cache holds as many pairs as the set of pairs (for a cache that the broadphase made, if the
    ///   program has taken out no pair since pairs were calculated).
    [[nodiscard]] std::string validate() const;

private:
    /// What is known of a client.
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

    // As one of many worlds: spatial_hash_world.cpp.
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

    // Whether the callback has ended the query.
    [[nodiscard]] bool endsRayTest(const btVector3& from, const btVector3& to,
                                   btBroadphaseRayCallback& callback, const btVector3& castMin,
                                   const btVector3& castMax) const;
    [[nodiscard]] bool endsAabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                                    btBroadphaseAabbCallback& callback) const;

    // A proxy may be given to Bullet, which takes no const ones, by const members.
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
    // By which it is told what callbacks have destroyed.
    static void noteIds(std::span<btBroadphaseProxy* const> proxies, std::vector<int>& ids);
    static void checkNamedOnce(std::span<const int> ids);
    // Whether it, or a world beside it, calculates on this thread, and calls back.
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
    // setAabb() where it may do more, and setMargin().
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
    // Before anything is changed: who breaks it may be stopped by an exception.
    void checkMayChange() const {
        HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(&grid_), detail::kMustNotChange);
    }
    [[nodiscard]] Proxy* checkedProxy(btBroadphaseProxy* proxy) const {
        HASHPHASE_ASSERT(
            proxy != nullptr && grid_.contains(idOf(proxy)) && proxyAt(idOf(proxy).index) == proxy,
            "Only a proxy that this broadphase created and did not destroy can be used.");
        return static_cast<Proxy*>(proxy);
    }

    friend class WorldsBroadphase;
    friend class detail::LivingBroadphase;
    friend class detail::BroadphaseImage;
    friend struct detail::CacheWatch;
    SpatialHashConfig config_;
    Grid<btScalar> grid_;
    std::unique_ptr<Sweeps<btScalar>> sweeps_;  // if the configuration asks for it
    Pairs<btScalar> pairs_;

    detail::StableArray<Proxy> proxies_;  // by ProxyId::index
    std::vector<int> uniqueIds_;          // by ProxyId::index; 0 where no proxy is alive
    int* idCounter_ = &lastUniqueId_;     // or that of all worlds
    int lastUniqueId_ = 0;
    detail::PeakWatch peaks_;  // of the cache
    std::uint16_t worldNumber_ = 0;
    bool groupsDecide_ = false;            // who may pair, and no callback
    bool mustNoteGroups_ = false;          // of all
    bool isCacheBehind_ = false;           // of changes that did not all reach it
    bool isApplying_ = false;              // changes to the cache
    bool mayGrow_ = sweeps_ != nullptr;    // the boxes of some, which sweep or have a margin
    std::unique_ptr<PairCache> ownCache_;  // if none was given
    detail::CacheWatch watch_{*this};      // of the cache, if it is known to be a PairCache
    btOverlappingPairCache* pairCache_ = nullptr;
    detail::GroupKinds groupKinds_;
    detail::GroupKinds::Set changedKinds_ = 0;  // of what has changed since the last update
    std::vector<std::uint64_t> seen_;           // slots whose groups are known since then; or empty
    std::size_t seenCount_ = 0;
    std::unique_ptr<detail::FlatSet> ghosts_;  // their slots; made with the first
    std::vector<BulletProxyPair> died_;        // scratch of PairLists
    std::vector<BulletProxyPair> born_;
    std::uint64_t cacheChangeCount_ = 0;  // calls that have changed it, and called back
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
