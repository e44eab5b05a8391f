// SPDX-License-Identifier: Zlib
#pragma once

// A pair cache for Bullet that finds the pairs of one proxy without looking at all other pairs.
// Works under any broadphase and in any world:
//
//     hashphase::PairCache pairCache;
//     btDbvtBroadphase broadphase(&pairCache);
//
// Bullet's own cache scans every pair, twice, to remove one body. Here a proxy's pairs are chained, and the
// cost of removing a body follows the number of its pairs. The array of pairs may be kept in an order that
// depends only on the set of pairs.
//
// Threads   needsBroadphaseCollision() and the const members may run anywhere. Everything else
//           needs the cache for itself, as in Bullet.
// Pointers  A pair stays where it is until a pair is added or removed, or memory is given back, in
//           canonical order also until the next look at the whole array. Others must not resize or
//           reorder the array.
// Batches   update() and removeOverlappingPairsContainingProxies() do in a pass what single calls do
//           one by one, at a fraction of the cost.
// Callbacks of ghosts, of processAllOverlappingPairs(), and of algorithms that are freed see the cache as it
//           is after the change that they are told of, and may change it. The filter may not. Under a
//           SpatialHashBroadphase, a pair that is taken out comes back in the next calculation, unless the
//           filter refuses it.
// Memory    Where it runs out, std::bad_alloc is passed on: a single call has changed nothing, a batch has
//           removed some of its pairs or all, and added none. Removing the pairs of one proxy then takes no
//           memory, but time that follows all pairs. Bullet's own arrays do not report a lack of memory.
// NULL      A NULL dispatcher frees no algorithms, as in Bullet; NULL clients are fine.
// Misuse    Asserted are pairs of a proxy with itself, proxies alive with equal or negative unique ids, a
//           missing key, and a filter that changes the cache.

#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/key_parts.hpp>
#include <broadphase/core/query_scope.hpp>
#include <broadphase/core/run_map.hpp>
#include <broadphase/core/same_library.hpp>
#include <broadphase/parallel_for.hpp>
#include <integration/bullet/detail/proxy_ranks.hpp>
#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
class BroadphaseImage;
struct CacheWatcher;
}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// In which order the array lists the pairs.
enum class PairOrder {
    /// As pairs came and went: equal calls, from an empty cache on, give an equal order, which is that of
    /// Bullet's cache unless they are batches. The place of a pair depends on the history: boxes that are set
    /// back to an earlier frame bring back the pairs of that frame, not their places. Costs nothing.
    arrival,
    /// Ascending by the key of the first proxy, then of the second, whenever the whole array is read: equal
    /// sets of pairs give an equal order, whatever the broadphase and the history. Needed where a program
    /// sets boxes back itself; WorldSnapshot does without. Algorithms are freed in that order, too, so that
    /// the dispatcher's manifolds, and with them whole trajectories, are equal under all exact broadphases.
    /// Costs a sort when the set has changed.
    canonical,
};

/// Returns the number by which proxies are ordered; ties go by m_uniqueId. It must not change while the proxy
/// has pairs.
using ProxyKey = int (*)(const btBroadphaseProxy&);

/// Two proxies as a batch names them, with their unique ids, so that the proxies themselves need not be read.
class BulletProxyPair {
public:
    /// Names none.
    BulletProxyPair() noexcept = default;

    BulletProxyPair(btBroadphaseProxy& a, btBroadphaseProxy& b) noexcept
        : BulletProxyPair(a, a.m_uniqueId, b, b.m_uniqueId) {}

    /// The ids must be those of the proxies; this is not checked.
    BulletProxyPair(btBroadphaseProxy& a, int idOfA, btBroadphaseProxy& b, int idOfB) noexcept
        : lower_(idOfA < idOfB ? &a : &b),
          upper_(idOfA < idOfB ? &b : &a),
          ids_(std::uint64_t{static_cast<std::uint32_t>(idOfA < idOfB ? idOfA : idOfB)} << 32 |
               static_cast<std::uint32_t>(idOfA < idOfB ? idOfB : idOfA)) {}

    /// The proxies with the lower and the higher unique id.
    [[nodiscard]] btBroadphaseProxy* lower() const noexcept { return lower_; }
    [[nodiscard]] btBroadphaseProxy* upper() const noexcept { return upper_; }

    /// Both unique ids, the lower one on top.
    [[nodiscard]] std::uint64_t ids() const noexcept { return ids_; }

    /// False when one of the two has another unique id by now, as after it was destroyed.
    [[nodiscard]] bool isUpToDate() const noexcept {
        return static_cast<std::uint32_t>(lower_->m_uniqueId) == ids_ >> 32 &&
               static_cast<std::uint32_t>(upper_->m_uniqueId) == (ids_ & 0xffffffffU);
    }

private:
    btBroadphaseProxy* lower_ = nullptr;
    btBroadphaseProxy* upper_ = nullptr;
    std::uint64_t ids_ = 0;
};

using ProxyCouple [[deprecated("BulletProxyPair")]] = BulletProxyPair;

/// A btOverlappingPairCache in which the cost of removing a proxy follows the number of its pairs.
class HASHPHASE_BULLET_EXPORT PairCache final : public btOverlappingPairCache {
public:
    /// In both orders, m_pProxy0 of a pair has the lower key. The default key orients pairs as Bullet does;
    /// another key is for broadphases that re-use unique ids.
    explicit PairCache(PairOrder order = PairOrder::arrival, ProxyKey key = &uniqueId)
        : order_(order), key_(key) {
        HASHPHASE_ASSERT(key != nullptr, "There is a key to order proxies by.");
    }

    ~PairCache() override;
    PairCache(const PairCache&) = delete;
    PairCache& operator=(const PairCache&) = delete;

    /// The default key. Not inline: it is known by its address, which is the same in every library.
    static int uniqueId(const btBroadphaseProxy& proxy);

    /// The most pairs that Bullet's array can hold.
    static constexpr std::size_t kMostPairs = std::size_t{1} << 30;

    // --- One pair --------------------------------------------------------------------------------

    /// Returns the pair of the two proxies; makes it when there is none. NULL when the filter refuses it. The
    /// ghost callback is told of a new pair. Throws std::length_error, and changes nothing, beyond
    /// kMostPairs. Cost: O(1).
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* proxy0,
                                         btBroadphaseProxy* proxy1) override;

    /// addOverlappingPair() without asking the filter, for callers who have asked it.
    btBroadphasePair* addAcceptedPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1);

    /// Frees the pair's algorithm, tells the ghost callback and returns the pair's m_internalInfo1;
    /// NULL when there is no such pair. In canonical order the algorithm is freed when the whole array is
    /// read next, or the pairs of a proxy are removed or cleaned. Cost: O(1).
    void* removeOverlappingPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1,
                                btDispatcher* dispatcher) override;

    /// NULL when there is no such pair; does not ask the filter. Cost: O(1).
    btBroadphasePair* findPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) override;

    /// Frees the pair's algorithm and keeps the pair.
    void cleanOverlappingPair(btBroadphasePair& pair, btDispatcher* dispatcher) override;

    // --- Many pairs ------------------------------------------------------------------------------

    /// Removes the pairs of `died` as removeOverlappingPair() does, then adds those of `born` as
    /// addAcceptedPair() does. Passes over died pairs that are missing, and born pairs that are present. The
    /// order of arrival depends only on the calls: the first born pairs take the places of the first died
    /// ones, so that no other pair moves; further born pairs go to the end, places that none takes are filled
    /// from the end. Algorithms are freed when the array is in order again. With a ghost callback, or called
    /// by a callback of processAllOverlappingPairs(), it does exactly what single calls do. Thousands of pairs
    /// are looked up on the threads of `parallelFor`, with the same result; callbacks come on the caller's.
    /// Throws std::length_error, and changes nothing, when the born pairs would make more than kMostPairs.
    /// Cost: O(1) a pair, a third of that of single calls.
    void update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                btDispatcher* dispatcher, ParallelFor parallelFor);
    void update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                btDispatcher* dispatcher);

    // --- The pairs of one proxy ------------------------------------------------------------------

    /// Removes the proxy's pairs one by one as removeOverlappingPair() does, in canonical order or in that
    /// of Bullet's cache. Cost: the number of the proxy's pairs, and O(1), amortised, for every pair added or
    /// sorted since the last such call, and for every pair from before an update() that changed many pairs.
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* proxy,
                                               btDispatcher* dispatcher) override;

    /// Frees the algorithms of the proxy's pairs and keeps the pairs, in the order and at the cost of
    /// removing them. Ghosts that keep algorithms of their own are told nothing.
    void cleanProxyFromPairs(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// As cleanProxyFromPairs(), and tells the ghost callback that each pair has ended and begun, as if it
    /// had been removed and added: this frees what ghosts keep of the pair, too.
    void renewPairsContainingProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    // --- The pairs of many proxies ---------------------------------------------------------------

    /// Removes the pairs of each proxy in turn. The order of arrival differs from that of single calls.
    /// Algorithms are freed when all pairs are gone: in canonical order as by single calls, else in an
    /// unspecified order. With a ghost callback, or called by a callback of processAllOverlappingPairs(), it
    /// does exactly what single calls do. Cost: the number of the proxies' pairs, and at most one pass over
    /// all pairs.
    void removeOverlappingPairsContainingProxies(std::span<btBroadphaseProxy* const> proxies,
                                                 btDispatcher* dispatcher);

    // --- All pairs -------------------------------------------------------------------------------

    /// Calls callback->processOverlap() for every pair, and removes the pairs for which it returns true. The
    /// callback may add pairs, which it will be shown too, and remove any pair; where it removes others than
    /// the one it is shown, some may not be shown this time. Cost: O(pairs), including pairs that the
    /// callback adds: the call ends when the callback adds no more.
    void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher) override;

    /// As above, but with dispatchInfo.m_deterministicOverlappingPairs in the order of unique ids, the
    /// highest first, as Bullet's cache; pairs added meanwhile wait for the next call.
    void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher,
                                    const btDispatcherInfo& dispatchInfo) override;

    [[nodiscard]] int getNumOverlappingPairs() const override { return pairs_.size(); }

    /// The array, with PairOrder::canonical in that order, but not during processAllOverlappingPairs():
    /// changes made by its callback are sorted in afterwards.
    btBroadphasePair* getOverlappingPairArrayPtr() override;
    btBroadphasePairArray& getOverlappingPairArray() override;

    /// The array as it stands: changes since the last call of the non-const ones are not sorted in.
    [[nodiscard]] const btBroadphasePair* getOverlappingPairArrayPtr() const override;

    /// Brings the array into canonical order, once, with either PairOrder. Bullet's caches remove and add all
    /// pairs for that, which destroys every algorithm; here algorithms stay and ghosts are told nothing.
    void sortOverlappingPairs(btDispatcher* dispatcher) override;

    /// False: removal is immediate.
    bool hasDeferredRemoval() override { return false; }

    // --- Callbacks -------------------------------------------------------------------------------

    /// Asks the filter callback; without one, groups and masks decide, both ways. False of two that the
    /// broadphase ignores, or that are in different worlds of a WorldsBroadphase.
    [[nodiscard]] bool needsBroadphaseCollision(btBroadphaseProxy* proxy0,
                                                btBroadphaseProxy* proxy1) const override;
    /// The same, whatever the broadphase says of the two.
    [[nodiscard]] bool doFiltersAccept(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) const {
        if (filter_ != nullptr) {
            const detail::QueryScope scope(this);
            return filter_->needBroadphaseCollision(proxy0, proxy1);
        }
        return doGroupsAccept(*proxy0, *proxy1);
    }
    /// Whether the two may pair by their groups and masks, both ways.
    [[nodiscard]] static bool doGroupsAccept(const btBroadphaseProxy& a,
                                             const btBroadphaseProxy& b) noexcept {
        return (a.m_collisionFilterGroup & b.m_collisionFilterMask) != 0 &&
               (b.m_collisionFilterGroup & a.m_collisionFilterMask) != 0;
    }
    /// The callback that was set. Where the broadphase may say that two are no pair, and none was set, one that
    /// asks groups and masks: Bullet's casts of fast bodies call needsBroadphaseCollision() only if there is one.
    btOverlapFilterCallback* getOverlapFilterCallback() override;
    /// NULL for none.
    void setOverlapFilterCallback(btOverlapFilterCallback* callback) override;
    /// Whether one was set.
    [[nodiscard]] bool hasFilterCallback() const noexcept { return filter_ != nullptr; }

    /// Sets the callback that is told of each pair added and each pair removed, once; NULL for none. As in
    /// Bullet's caches, it is not told of the present pairs.
    void setInternalGhostPairCallback(btOverlappingPairCallback* callback) override {
        ghosts_ = callback;
    }
    [[nodiscard]] btOverlappingPairCallback* getInternalGhostPairCallback() const noexcept {
        return ghosts_;
    }

    // --- Beyond Bullet ---------------------------------------------------------------------------

    /// Number of pairs for which there is room.
    [[nodiscard]] std::size_t capacity() const noexcept {
        return static_cast<std::size_t>(pairs_.capacity());
    }

    /// Number of pairs read so far to serve single proxies: the work of
    /// removeOverlappingPairsContainingProxy() and cleanProxyFromPairs().
    [[nodiscard]] std::uint64_t pairsVisited() const noexcept { return pairsVisited_; }

    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back room for more pairs than there are. Pairs move, as where one is added. A
    /// SpatialHashBroadphase calls it by itself. Not within the filter (asserted). Cost: O(pairs).
    void releaseUnusedMemory() noexcept;

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every pair is found by the unique ids of its proxies.
    /// - Every pair has the proxy with the lower key first.
    /// - Every chained pair is chained once to each of its proxies.
    /// - An array that counts as sorted is in canonical order.
    [[nodiscard]] std::string validate() const;

    // --- For a broadphase ------------------------------------------------------------------------

    /// Which side removes a pair: a broadphase needs to know which pairs others take out.
    enum class Remover { broadphase, other };

    /// removeOverlappingPairsContainingProxies(), by that remover.
    void removePairsOf(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher,
                       Remover remover);

    /// Who is told of pairs that others take out; null for nobody.
    [[nodiscard]] detail::CacheWatcher* watcher() const noexcept { return watcher_; }
    void setWatcher(detail::CacheWatcher* watcher) noexcept { watcher_ = watcher; }

private:
    // A pair has two edges: 2 * its index for the proxy with the lower unique id, and that + 1. The
    // edges of a proxy are chained, those of the first so many pairs, that is.
    struct Link {
        std::uint32_t next;
        std::uint32_t previous;
    };

    // A pair as it was noted down, with what it is to be sorted by.
    struct PairSortKey {
        std::uint64_t keys;  // of first and second proxy, ascending as unsigned
        std::uint64_t uniqueIds;
        std::uint32_t index;
        std::uint32_t rank = 0;  // of the first of its proxies among those of a batch

        friend bool operator<(const PairSortKey& a, const PairSortKey& b) noexcept {
            return a.keys != b.keys ? a.keys < b.keys : a.uniqueIds < b.uniqueIds;
        }
    };

    enum class Freeing { now, inTurn };

    class Processing;

    static constexpr std::uint32_t kNone = detail::FlatSet::kNone;
    static constexpr std::uint64_t kLowerHalf = 0xffffffffU;  // of two unique ids

    // A removed pair whose algorithm waits to be freed in its turn.
    struct Retired {
        PairSortKey note;
        btBroadphasePair pair;
        btDispatcher* dispatcher;
    };

    void checkMayChange() const;
    void checkRoomFor(std::size_t bornCount) const;
    [[nodiscard]] bool isLower(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const;
    [[nodiscard]] std::uint64_t keysOf(const btBroadphasePair& pair, std::uint64_t ids) const;
    [[nodiscard]] PairSortKey noteOf(std::uint32_t index) const;
    void noteAll(std::vector<PairSortKey>& notes) const;
    [[nodiscard]] std::uint32_t indexOf(const PairSortKey& note) const;
    static bool isNamedBy(const BulletProxyPair& proxies, const btBroadphasePair& pair) noexcept {
        return pair.m_pProxy0 == proxies.lower() || pair.m_pProxy0 == proxies.upper();
    }
    void name(const BulletProxyPair& proxies, btBroadphasePair& pair) const;
    btBroadphasePair* add(const BulletProxyPair& proxies);
    void* remove(std::uint64_t ids, btDispatcher* dispatcher, Freeing freeing, Remover remover);
    void noteTakenOut(const btBroadphasePair& pair) const noexcept;
    void removePairsOfOne(btBroadphaseProxy& proxy, btDispatcher* dispatcher, Remover remover);
    void retire(const btBroadphasePair& pair, std::uint64_t ids, btDispatcher* dispatcher) {
        if (pair.m_algorithm != nullptr && dispatcher != nullptr) {
            retired_.push_back({{keysOf(pair, ids), ids, kNone}, pair, dispatcher});
        }
    }
    [[nodiscard]] Freeing freeingNow() const noexcept;

    [[nodiscard]] bool isTold() const noexcept { return ghosts_ != nullptr || processDepth_ > 0; }
    void exchange(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                  btDispatcher* dispatcher, const ParallelFor* onThreads);
    void updateAny(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                   btDispatcher* dispatcher, const ParallelFor* onThreads);
    void updateOneByOne(std::span<const BulletProxyPair> died,
                        std::span<const BulletProxyPair> born, btDispatcher* dispatcher);
    void prefetchAhead(std::span<const BulletProxyPair> pairs, std::size_t i) const;
    void vacate(std::uint64_t ids, btDispatcher* dispatcher, Remover remover);
    void vacateAll(std::span<const BulletProxyPair> died, btDispatcher* dispatcher);
    void makeRoomFor(std::size_t bornCount);
    void vacateAll(std::span<const PairSortKey> notes, btDispatcher* dispatcher, Remover remover);
    void takePlace(const BulletProxyPair& born, std::uint32_t& place, std::uint32_t index);
    void settle(std::span<const BulletProxyPair> born);
    void closeVacant() noexcept;
    void vacateInParts(std::span<const BulletProxyPair> died, btDispatcher* dispatcher,
                       ParallelFor parallelFor);
    void settleInParts(std::span<const BulletProxyPair> born, ParallelFor parallelFor);
    void fill(std::uint32_t index) noexcept;
    [[nodiscard]] std::vector<PairSortKey> notesOfAll(std::span<btBroadphaseProxy* const> proxies);

    [[nodiscard]] bool isChained(std::uint32_t index) const noexcept {
        return 2 * std::size_t{index} < links_.size();
    }
    [[nodiscard]] std::uint64_t idOfEnd(std::uint32_t edge) const;
    void chainIfWorth();
    void dropChainsIfMany(std::size_t changeCount);
    void dropChains() noexcept;
    void chainPair(std::uint32_t index) noexcept;
    void unchainPair(std::uint32_t index, std::uint64_t ids) {
        if (isChained(index)) {
            unchain(2 * index, ids >> 32);
            unchain(2 * index + 1, ids & kLowerHalf);
        }
    }
    void chain(std::uint32_t edge);
    void unchain(std::uint32_t edge, std::uint64_t uniqueId);
    void rename(std::uint32_t from, std::uint32_t to);
    void noteUnchained(std::uint32_t id, std::vector<PairSortKey>& notes) const;
    [[nodiscard]] std::vector<PairSortKey> notesOf(const btBroadphaseProxy& proxy);
    template <class Visit>
    void forEachPairOf(const btBroadphaseProxy& proxy, const Visit& visit);
    void tellGhostsAgain(std::uint64_t ids, const btBroadphasePair& pair, btDispatcher* dispatcher);
    template <class Visit>
    void forEachUnnoted(const btBroadphaseProxy& proxy, const Visit& visit);
    void processByUniqueId(btOverlapCallback& callback, btDispatcher* dispatcher);
    void prepareWholeArray();
    void sort();
    void freeRetired();
    void freeRetiredAsListed();
    [[nodiscard]] bool areChainsSound() const;

    friend class detail::BroadphaseImage;
    PairOrder order_;
    ProxyKey key_;
    btOverlapFilterCallback* filter_ = nullptr;
    btOverlappingPairCallback* ghosts_ = nullptr;

    btBroadphasePairArray pairs_;
    detail::FlatSet ids_;           // of each pair, by its index: both unique ids, lower one on top
    std::vector<Link> links_;       // by edge; the pairs behind its end are not chained yet
    detail::RunMap firstEdge_;      // unique id -> first edge of the proxy's chain
    std::size_t pairsScanned_ = 0;  // in place of chaining them, since some were last chained
    std::uint64_t pairsVisited_ = 0;
    bool isSorted_ = true;
    int processDepth_ = 0;  // processAllOverlappingPairs() calls under way

    std::vector<Retired> retired_;

    detail::CacheWatcher* watcher_ = nullptr;

    std::vector<std::uint32_t> places_;  // scratch of batches, vacant ones; and of sort(), new ones
    std::unique_ptr<detail::KeyParts> parts_;  // scratch of batches on threads
    detail::ProxyRanks ranks_;                 // scratch of removals
    std::vector<PairSortKey> scratch_;
};

// Not by Bullet's constructor for two proxies: that one orients by unique id.
inline void PairCache::name(const BulletProxyPair& proxies, btBroadphasePair& pair) const {
    HASHPHASE_ASSERT(proxies.ids() >> 32 != (proxies.ids() & kLowerHalf),
                     "A pair is made of two proxies with different unique ids.");
    HASHPHASE_ASSERT((proxies.ids() & 0x8000000080000000U) == 0,
                     "The unique id of a proxy is not negative.");
    const bool isSwapped = key_ != &uniqueId && isLower(*proxies.upper(), *proxies.lower());
    pair.m_pProxy0 = isSwapped ? proxies.upper() : proxies.lower();
    pair.m_pProxy1 = isSwapped ? proxies.lower() : proxies.upper();
    pair.m_algorithm = nullptr;
    pair.m_internalInfo1 = nullptr;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
