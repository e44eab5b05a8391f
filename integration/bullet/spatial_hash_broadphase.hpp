// SPDX-License-Identifier: Zlib
#pragma once

// The spatial hash as Bullet's broadphase. In place of
//
//     btDbvtBroadphase broadphase;
//
// write
//
//     hashphase::SpatialHashBroadphase broadphase;
//
// What changes: pairs are exact (no fat boxes, no stale pairs) and are made and removed in
// calculateOverlappingPairs() only, but for those of ghost objects: theirs come at once, when they are
// created or moved, and when something else is created where they stand, or jumps there.
//
// Batches   createProxies(), setAabbs() and destroyProxies() do what as many single calls do, at less
//           cost.
// Threads   Rays and aabbTest() are const in all but name: any number may run at the same time
//           and inside each other. Everything else needs the broadphase for itself, as in Bullet.
// Units     the world's; nothing depends on their size.
// Bad data  A box with NaN pairs with nothing and is reported once (diagnostics.hpp). Infinite, huge
//           and inverted boxes are treated exactly as comparing their coordinates says. NULL
//           clients and NULL dispatchers are fine.
// Callbacks Those of rayTest(), aabbTest() and closestRay(), of the pair cache and of the dispatcher
//           may create, move and destroy proxies, and ask. What is destroyed is not reported any
//           more; what is moved or created may be reported, once more, or not. Bullet itself must be
//           able to bear it: it cannot where an object is removed that it is at work on. The overlap
//           filter may ask but not change anything, and calculateOverlappingPairs(), shiftOrigin() and
//           resetPool() are not called from within any of them; asserted.
// Memory    Where it runs out, std::bad_alloc is passed on and the call may be repeated:
//           createProxy() has created nothing, shiftOrigin() has shifted nothing, setAabb() has moved
//           the proxy, and the first calculateOverlappingPairs() that returns brings the cache up to
//           date, with the pairs that eager ones lack. Bullet's own arrays do not tell.
// Misuse    Proxies that are not alive, proxies of other broadphases, spans of different lengths in a
//           batch, and rays without a callback are asserted.

#include <broadphase/core/group_kinds.hpp>
#include <broadphase/core/stable_array.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/sweeps.hpp>
#include <integration/bullet/detail/cache_watch.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Settings of the broadphase; the defaults work for any world.
struct SpatialHashConfig {
    GridConfig grid{};

    /// Ghost objects get their pairs at once, in createProxy() and setAabb(), as Bullet's character
    /// controller expects, wherever the pair cache has an internal ghost pair callback, through which
    /// ghosts hear of pairs. (A cache that is not given as a PairCache counts as having one.) What is
    /// created where a ghost stands, or jumps there, out of the box that it had, is a pair with it at once
    /// as well. To find ghosts, a client that may have pairs is taken for a btCollisionObject then, in
    /// calls that hand in a dispatcher, as a btCollisionWorld's do. False is for programs whose clients
    /// are something else.
    bool eagerGhosts = true;

    /// Proxies of these groups get theirs at once as well; none by default, for what a bit means is up
    /// to the program. For code that reads pairs between moves and steps, and is no ghost object.
    int eagerGroups = 0;

    /// On what threads calculateOverlappingPairs() runs its loops; empty for the caller's. The
    /// result is the same on any number. See bullet_parallel_for.hpp and
    /// integration/tbb/tbb_parallel_for.hpp. Called with count, grain and body, see ParallelFor.
    std::function<void(std::size_t count, std::size_t grain, LoopBody body)> parallelFor{};

    /// How to find what a fast rigid body passes in a step; by default not at all. The box that Bullet
    /// hands in covers such a body at start and end, with m_useContinuous, and all that lies between
    /// its corners. It makes no pairs any more: the body sweeps along the way that Bullet has predicted,
    /// and its pairs are exactly what it touches at some time of the step. Queries see it by its box, as
    /// without a sweep, wherever on its way they ask; without m_useContinuous the box is extended to
    /// the end for that. For worlds whose clients are btCollisionObjects. What sweeps does so until its
    /// next setAabb(): after moving a body by hand between steps, set its interpolation transform too.
    /// Costs a look at the shape of each body that moves.
    Sweep sweep = Sweep::none;

    /// A body is fast in a step in which it moves by more than this share of the smallest edge of its
    /// box. The others keep the box that Bullet hands in. Valid: 0 or more.
    btScalar fastFrom = 1;

    /// An overlap filter callback decides in place of groups and masks, and so may a pair cache other than
    /// PairCache: either is asked about each two that overlap, and again about those that it refuses when
    /// one of them has changed. Where it refuses whatever groups and masks refuse, as Bullet's own caches
    /// do, set this: it is asked about the others only, and what is parked with a mask of 0, or otherwise
    /// filtered out, costs nothing.
    bool filterRefusesMore = false;

    /// Ends a query when process() of its callback returns false. Off by default: Bullet's own
    /// broadphases ignore the result, and programs return false for other reasons.
    bool stopWhenProcessReturnsFalse = false;
};

/// As that of GridConfig, for the grid's settings and fastFrom.
[[nodiscard]] HASHPHASE_BULLET_EXPORT std::string configError(const SpatialHashConfig& config);

/// What createProxies() makes a proxy of: the arguments of createProxy().
struct ProxyDefinition {
    btVector3 aabbMin{0, 0, 0};
    btVector3 aabbMax{0, 0, 0};
    void* userPtr = nullptr;
    int collisionFilterGroup = btBroadphaseProxy::DefaultFilter;
    int collisionFilterMask = btBroadphaseProxy::AllFilter;
};

/// A ray of SpatialHashBroadphase::rayTests(), with the arguments of rayTest().
struct BroadphaseRay {
    btVector3 from;
    btVector3 to;
    btBroadphaseRayCallback* callback = nullptr;
    btVector3 castMin{0, 0, 0};
    btVector3 castMax{0, 0, 0};
};

/// A ray of SpatialHashBroadphase::closestRays(), with the arguments of closestRay().
struct ClosestRay {
    btVector3 from;
    btVector3 to;
    btCollisionWorld::RayResultCallback* callback = nullptr;
};

/// A btBroadphaseInterface over a Grid, in place of btDbvtBroadphase.
class HASHPHASE_BULLET_EXPORT SpatialHashBroadphase : public btBroadphaseInterface {
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

    /// The proxy's address is fixed for its life, m_uniqueId counts 1, 2, 3 ... and is never used
    /// again: after 2^31 - 1 of them std::length_error is thrown until resetPool(); likewise where there
    /// are 2^28 proxies. `shapeType` is ignored. Cost: O(1), and a look at up to 1,024 ghosts, or a box
    /// query where there are more; of ghosts and SpatialHashConfig::eagerGroups that of Pairs::findPairsNow()
    /// and of its pairs, too.
    btBroadphaseProxy* createProxy(const btVector3& aabbMin, const btVector3& aabbMax,
                                   int shapeType, void* userPtr, int collisionFilterGroup,
                                   int collisionFilterMask, btDispatcher* dispatcher) override;

    /// Removes the proxy's pairs through the pair cache, then the proxy. Cost: that of the cache;
    /// with PairCache the number of the proxy's pairs.
    void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// Notices, also when the box is the same, that the proxy's group or mask has been written.
    /// Cost: O(1), or a comparison when the box is the same, and with SpatialHashConfig::sweep a look at
    /// the body; for ghosts and eagerGroups, and where the box is another one that does not touch the last
    /// one, as in createProxy().
    void setAabb(btBroadphaseProxy* proxy, const btVector3& aabbMin, const btVector3& aabbMax,
                 btDispatcher* dispatcher) override;

    /// As last set, whether the proxy sweeps or not.
    void getAabb(btBroadphaseProxy* proxy, btVector3& aabbMin, btVector3& aabbMax) const override;

    /// Calls rayCallback.process() once for every proxy whose box, grown by the cast box
    /// (aabbMin, aabbMax), passes btRayAabb2() with the callback's own fields. Sees every box as it
    /// was last set. Order roughly from near to far, but not to be relied on. A ray of no length, or
    /// one too long to be squared, for which Bullet makes NaN or nothing of the direction, finds what
    /// these fields say, as under btDbvtBroadphase: of no length nothing. Ask grid() with a RayRegion
    /// for what is at a point, or on the longest ways. One with NaN or infinite ends finds nothing.
    /// Cost: what lies near the ray; however long it is, at most one test for each proxy.
    void rayTest(const btVector3& rayFrom, const btVector3& rayTo,
                 btBroadphaseRayCallback& rayCallback,
                 const btVector3& aabbMin = btVector3(0, 0, 0),
                 const btVector3& aabbMax = btVector3(0, 0, 0)) override;

    /// Calls callback.process() once for every proxy whose box overlaps the given one (closed). Cost:
    /// at most one test for each proxy.
    void aabbTest(const btVector3& aabbMin, const btVector3& aabbMax,
                  btBroadphaseAabbCallback& callback) override;

    /// Makes the cache's pairs exact: afterwards it holds precisely the overlapping proxies that
    /// its filter accepts, and with SpatialHashConfig::sweep those that meet on their ways. Pairs that
    /// did so before are not touched. Groups and masks may be written at any time: what may pair begins to
    /// where one of the two was moved, or its setAabb() called, since; a pair stays one until its boxes
    /// part. First those that have parted go, then those that have met come, each in the order of their
    /// proxies: what changes, and in which order, follows from the boxes before and now, not from
    /// how they came there. At last pairs that the program itself has taken out of the cache come back,
    /// unless the filter refuses them by now; out of a cache that was not given as a PairCache they stay
    /// out until the two meet again. Cost: that of Pairs::update(), and of the cache for each pair that
    /// comes or goes.
    void calculateOverlappingPairs(btDispatcher* dispatcher) override;

    btOverlappingPairCache* getOverlappingPairCache() override { return pairCache_; }
    [[nodiscard]] const btOverlappingPairCache* getOverlappingPairCache() const override {
        return pairCache_;
    }

    /// The box around all boxes; zero when there is none. Cost: O(proxies).
    void getBroadphaseAabb(btVector3& aabbMin, btVector3& aabbMax) const override;

    /// When no proxy is alive, forgets all that came before: m_uniqueId counts from 1 again, and the same
    /// calls lead to the same pairs in the same order, and the same frees of algorithms, as with a new
    /// broadphase. What Bullet itself remembers is for its user: the solver's reset(). Frees memory, as
    /// Grid::clear(). Does nothing while a proxy is alive. Not called by callbacks (asserted).
    void resetPool(btDispatcher* dispatcher) override;

    /// Does nothing, as in Bullet; ask lastCost() and memoryBytes().
    void printStats() override {}

    // --- Many at once ----------------------------------------------------------------------------

    /// Creates a proxy for each definition, in their order, and writes them to `proxies`, which is
    /// as long. Where memory runs out, those that were written are created, and no others. Cost: that
    /// of createProxy(), each.
    void createProxies(std::span<const ProxyDefinition> definitions,
                       std::span<btBroadphaseProxy*> proxies, btDispatcher* dispatcher);

    /// Sets the box of each proxy, in their order; all three are of the same length.
    /// Cost: that of setAabb(), each.
    void setAabbs(std::span<btBroadphaseProxy* const> proxies, std::span<const btVector3> aabbMins,
                  std::span<const btVector3> aabbMaxs, btDispatcher* dispatcher);

    /// Removes the pairs of all the proxies through the pair cache, then the proxies, of which each
    /// is named once. Pairs and their algorithms are removed in the order of proxies, but for what
    /// PairCache::removeOverlappingPairsContainingProxies() says. Cost: that of the cache; with
    /// PairCache, given as one, at most a pass over all pairs.
    void destroyProxies(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    // --- Beyond Bullet ---------------------------------------------------------------------------

    /// btCollisionWorld::rayTest(), but from near to far, and no farther than a nearer hit is
    /// possible: reports to `callback` what it would report, less what lies more than 2 cm behind
    /// callback.m_closestHitFraction. That makes no difference for a ClosestRayResultCallback, but
    /// for which of several hits at the same fraction is kept. For worlds whose clients are
    /// btCollisionObjects; soft bodies need their world's own rayTest(). Any number of threads. Cost:
    /// at most that of rayTest(), and a cast at the shape of each proxy that it finds.
    QueryCost closestRay(const btVector3& from, const btVector3& to,
                         btCollisionWorld::RayResultCallback& callback) const;

    /// rayTest() and closestRay() for many rays: each callback hears what it would hear from a ray
    /// alone, in the same order; callbacks are called at the same time where `parallelFor` is
    /// parallel, and change nothing then. Each ray has a callback (asserted), of its own. Cost: that of
    /// the rays alone, or less.
    void rayTests(std::span<const BroadphaseRay> rays, ParallelFor parallelFor = serialFor);
    void closestRays(std::span<const ClosestRay> rays, ParallelFor parallelFor = serialFor) const;

    /// Asks the filter again about everything that the proxy overlaps, or met on its way, and adds and
    /// removes its pairs accordingly, at once. For use after a change of its group, mask, or of the
    /// filter. Pairs that stay keep their contacts: after a change of shape call shapeChanged(). Cost:
    /// that of Pairs::refilter(), and of the proxy's pairs.
    void refilter(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// The same for many proxies in one pass: the filter is asked once about each two of them. Cost: that
    /// of Pairs::refilter() for many, and of their pairs.
    void refilter(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);

    /// The same for all: for use after a change of the filter callback, or of what it goes by. Cost: that
    /// of Pairs::refilterAll(), and of the pairs that come and go.
    void refilterAll(btDispatcher* dispatcher);

    /// Frees what the proxy's pairs have kept of its shape, algorithms and contacts, here and in the ghosts
    /// that list it; the pairs stay. For use after a change of shape, scale, margin or of anything else
    /// by which contacts were made, beside btCollisionWorld::updateSingleAabb(), before the next step. Where
    /// a ghost callback is set, it is told that each pair has ended and begun; a cache with deferred
    /// removal tells ghosts nothing. Cost: that of PairCache::renewPairsContainingProxy(); a pass over all
    /// pairs of any other cache.
    void shapeChanged(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    /// Moves the origin of all coordinates to `shift`: subtracts it from the box of every proxy, in one
    /// call, with what Grid::shiftOrigin() says. Pairs stay as they are; should rounding have brought
    /// boxes together, the next calculateOverlappingPairs() makes them pairs. The objects are not
    /// moved: shiftWorldOrigin() (origin_shift.hpp) does all of a world. Returns how many boxes
    /// were rounded. Cost: a pass over the proxies, and that of Grid::shiftOrigin().
    std::size_t shiftOrigin(const btVector3& shift);

    /// The grid, for queries that Bullet has none for. proxyOf() leads back to Bullet, of what is
    /// alive (asserted), whose m_clientObject is the btCollisionObject; idOf() is for proxies of this
    /// class. Of an index: proxyOf(grid().idAt(index)).
    [[nodiscard]] const Grid<btScalar>& grid() const noexcept { return grid_; }
    [[nodiscard]] btBroadphaseProxy* proxyOf(ProxyId id) const;
    [[nodiscard]] static ProxyId idOf(const btBroadphaseProxy* proxy);

    /// What sweeps, and how far; nullptr unless SpatialHashConfig::sweep is set. The grid has the box
    /// around the way; Sweeps::visit() asks for the way itself, and Sweeps::motion() tells it.
    [[nodiscard]] const Sweeps<btScalar>* sweeps() const noexcept { return sweeps_.get(); }

    /// What the last calculateOverlappingPairs() cost.
    [[nodiscard]] const PairCost& lastCost() const noexcept { return pairs_.lastCost(); }

    /// Bytes held, Bullet's own proxies included, the pair cache excluded unless it is our own.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back what is not used, after a level was left, say: that of the grid, its pairs and sweeps, see
    /// Grid::releaseUnusedMemory(), of a PairCache, and of the proxies at the end that are destroyed, whose
    /// addresses must not be used any more, not even for an assertion to tell of it.
    /// calculateOverlappingPairs() does it by itself when there has been room for more than eight times as
    /// many proxies, or pairs, in 256 calls in a row. Not within a callback (asserted). Cost:
    /// O(grid().indexLimit()), and moving what is left.
    void releaseUnusedMemory() noexcept;

    /// Grid::validate(), Sweeps::validate(), Pairs::validate() and PairCache::validate(), and:
    /// - The cache holds as many pairs as the set of pairs (for a cache of our own, out of which the
    ///   program has taken none since pairs were calculated).
    [[nodiscard]] std::string validate() const;

private:
    /// What is known of a client.
    enum class Client : std::uint8_t { unknown, ghost, other };

    struct Proxy : btBroadphaseProxy {
        ProxyId id;
        Client client = Client::unknown;
        std::uint8_t kind = 0;      // of its groups, as the grid knows them, in groupKinds_
        std::uint32_t ghostAt = 0;  // a ghost's place in ghosts_
    };
    struct PairLists;
    class Applying;
    template <class Callback>
    struct ProcessCollector;

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
    void renewPairsOfOtherCache(btBroadphaseProxy& proxy, btDispatcher* dispatcher);
    void removePairsOf(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher);
    void removeFromGrid(Proxy* proxy);
    void dropLastProxies() noexcept;
    void releaseAfterPeak() noexcept;
    void findBulletPairs(std::span<const ProxyPair> pairs,
                         std::vector<BulletProxyPair>& bulletPairs) const;
    void apply(const PairChanges& changes, std::size_t birthsAtOnce, btDispatcher* dispatcher);
    void applyToCache(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                      btDispatcher* dispatcher);
    void catchUp(btDispatcher* dispatcher);
    void putBackWhatWasTakenOut(btDispatcher* dispatcher);
    void askIfMoreWasTakenOut(btDispatcher* dispatcher);
    [[nodiscard]] bool isEager(Proxy& proxy, const btDispatcher* dispatcher) {
        return (proxy.m_collisionFilterGroup & config_.eagerGroups) != 0 ||
               (proxy.client != Client::other && mayHaveGhosts() && isGhost(proxy, dispatcher));
    }
    [[nodiscard]] bool mayHaveGhosts() const noexcept {
        return config_.eagerGhosts &&
               (watch_.cache == nullptr || watch_.cache->getInternalGhostPairCallback() != nullptr);
    }
    [[nodiscard]] bool isGhost(Proxy& proxy, const btDispatcher* dispatcher);
    [[nodiscard]] std::vector<ProxyId> ghostsAt(const Proxy& proxy) const;
    void forgetGhost(Proxy& proxy) noexcept;
    void findPairsNow(const Proxy& proxy, btDispatcher* dispatcher);
    void findGhostPairsNow(const Proxy& proxy, btDispatcher* dispatcher);
    void move(const Proxy& proxy);
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

    SpatialHashConfig config_;
    Grid<btScalar> grid_;
    std::unique_ptr<Sweeps<btScalar>> sweeps_;  // if the configuration asks for it
    Pairs<btScalar> pairs_;

    detail::StableArray<Proxy> proxies_;  // by ProxyId::index
    std::vector<int> uniqueIds_;          // by ProxyId::index; 0 where no proxy is alive
    int lastUniqueId_ = 0;

    bool groupsDecide_ = false;    // who may pair, and no callback
    bool mustNoteGroups_ = false;  // of all
    bool isCacheBehind_ = false;   // of changes that did not all reach it
    bool isApplying_ = false;      // changes to the cache

    std::unique_ptr<PairCache> ownCache_;  // if none was given
    detail::CacheWatch watch_;             // of the cache, if it is known to be a PairCache
    btOverlappingPairCache* pairCache_ = nullptr;
    detail::GroupKinds groupKinds_;
    // Of what was created or moved since pairs were calculated.
    detail::GroupKinds::Set changedKinds_ = 0;
    // Whose groups have been looked at since then, a bit for each slot; empty while nobody needs to know.
    std::vector<std::uint64_t> seen_;
    std::size_t seenCount_ = 0;
    std::vector<std::uint32_t> ghosts_;  // their slots
    detail::PeakWatch peaks_;            // of the cache
    std::vector<BulletProxyPair> died_;  // scratch of PairLists
    std::vector<BulletProxyPair> born_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
