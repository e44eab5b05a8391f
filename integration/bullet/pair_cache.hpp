// SPDX-License-Identifier: Zlib
#pragma once

// A pair cache for Bullet that removes a body in time proportional to its pairs; Bullet's own cache scans all
// pairs, twice. Works under any broadphase and in any world:
//
//     hashphase::PairCache pairCache;
//     btDbvtBroadphase broadphase(&pairCache);
//
// Threads   needsBroadphaseCollision() and const members run anywhere. Everything else needs the cache for itself,
//           as in Bullet.
// Pointers  A pair stays in place until a pair is added or removed, or memory is given back; in canonical order
//           also until the whole array is read next. Do not resize or reorder the array.
// Callbacks of ghosts, processAllOverlappingPairs() and freed algorithms see the cache after the change, and may
//           change it. The filter must not.
// Removal   Under a SpatialHashBroadphase, a removed pair returns in the next calculation, unless the filter
//           refuses it. In canonical order, its algorithm is freed when the whole array is read next, or pairs of a
//           proxy are removed or cleaned; otherwise at once.
// Memory    Throws std::bad_alloc when memory runs out. A single call has then changed nothing; a batch has removed
//           some or all of its pairs, and added none. Removing the pairs of one proxy takes no memory then, but
//           scans all pairs. Bullet's own arrays do not report a lack of memory.
// NULL      A NULL dispatcher frees no algorithms, as in Bullet. Clients may be NULL.
// Misuse    Asserted: a pair has two different proxies, unique ids of live proxies differ and are not negative, and
//           the filter does not change the cache.

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

/// The order of the pairs in the array.
enum class PairOrder {
    /// As pairs came and went: equal after equal calls on an empty cache, and as in Bullet's cache except after
    /// batches. Boxes that are set back to an earlier frame bring back its pairs, not their places. Cost: none.
    arrival,
    /// Ascending by the keys of both proxies, whenever the whole array is read: equal sets of pairs give an equal
    /// order, under any broadphase. For programs that set boxes back themselves; WorldSnapshot does not need it.
    /// Frees algorithms in this order too, so manifolds, and whole trajectories, are equal under all exact
    /// broadphases. Cost: a sort when the set has changed.
    canonical,
};

/// Returns the number that orders proxies; m_uniqueId decides ties. It must not change while the proxy has pairs.
using ProxyKey = int (*)(const btBroadphaseProxy&);

/// Two proxies with their unique ids, so that a batch need not read the proxies.
class BulletProxyPair {
public:
    BulletProxyPair() noexcept = default;

    BulletProxyPair(btBroadphaseProxy& a, btBroadphaseProxy& b) noexcept
        : BulletProxyPair(a, a.m_uniqueId, b, b.m_uniqueId) {}

    /// Not checked: the ids belong to the proxies.
    BulletProxyPair(btBroadphaseProxy& a, int idOfA, btBroadphaseProxy& b, int idOfB) noexcept
        : lower_(idOfA < idOfB ? &a : &b),
          upper_(idOfA < idOfB ? &b : &a),
          ids_(std::uint64_t{static_cast<std::uint32_t>(idOfA < idOfB ? idOfA : idOfB)} << 32 |
               static_cast<std::uint32_t>(idOfA < idOfB ? idOfB : idOfA)) {}

    /// Returns the proxy with the lower, or the higher, unique id.
    [[nodiscard]] btBroadphaseProxy* lower() const noexcept { return lower_; }
    [[nodiscard]] btBroadphaseProxy* upper() const noexcept { return upper_; }

    /// Returns both unique ids, the lower one in the upper 32 bits.
    [[nodiscard]] std::uint64_t ids() const noexcept { return ids_; }

    /// Returns false if one of the two has another unique id now, as after its destruction.
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

/// A btOverlappingPairCache with fast removal.
class HASHPHASE_BULLET_EXPORT PairCache final : public btOverlappingPairCache {
public:
    /// m_pProxy0 of a pair has the lower key. The default key orients pairs as Bullet does; choose another for
    /// broadphases that reuse unique ids. Asserted: `key` is not null.
    explicit PairCache(PairOrder order = PairOrder::arrival, ProxyKey key = &uniqueId)
        : order_(order), key_(key) {
        HASHPHASE_ASSERT(key != nullptr,
                         "PairCache: the key is null. Pass a function, or omit it.");
    }

    ~PairCache() override;
    PairCache(const PairCache&) = delete;
    PairCache& operator=(const PairCache&) = delete;

    /// The default key. Not inline: it is known by its address.
    static int uniqueId(const btBroadphaseProxy& proxy);

    /// The most pairs that Bullet's array can hold.
    static constexpr std::size_t kMostPairs = std::size_t{1} << 30;

    // --- One pair --------------------------------------------------------------------------------

    /// Returns the pair of the two proxies, added if missing; NULL if the filter refuses it. Calls the ghost
    /// callback for a new pair. Throws std::length_error beyond kMostPairs, and changes nothing. Cost: O(1).
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* proxy0,
                                         btBroadphaseProxy* proxy1) override;

    /// As addOverlappingPair(), without asking the filter.
    btBroadphasePair* addAcceptedPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1);

    /// Removes the pair, frees its algorithm and calls the ghost callback. Returns the pair's m_internalInfo1; NULL
    /// if there is no such pair. Cost: O(1).
    void* removeOverlappingPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1,
                                btDispatcher* dispatcher) override;

    /// Returns the pair, without asking the filter; NULL if there is none. Cost: O(1).
    btBroadphasePair* findPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) override;

    /// Frees the pair's algorithm and keeps the pair.
    void cleanOverlappingPair(btBroadphasePair& pair, btDispatcher* dispatcher) override;

    // --- Many pairs ------------------------------------------------------------------------------

    /// Removes the pairs `died`, then adds the pairs `born` without asking the filter. Skips died pairs that are
    /// missing, and born pairs that are present. Order of arrival: the first born pairs take the places of the
    /// first died ones; further born pairs go to the end, or pairs from the end fill places that are left. With a
    /// ghost callback, or called within processAllOverlappingPairs(), does exactly what single calls do. Uses
    /// `parallelFor` for thousands of pairs, with an equal result; callbacks run on the caller's thread. Throws
    /// std::length_error, and changes nothing, if present and born pairs exceed kMostPairs. Cost: O(1) a pair, a
    /// third of single calls.
    void update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                btDispatcher* dispatcher, ParallelFor parallelFor);
    void update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                btDispatcher* dispatcher);

    // --- The pairs of one proxy ------------------------------------------------------------------

    /// Removes the proxy's pairs one by one as removeOverlappingPair() does, in canonical order or in the order of
    /// Bullet's cache. Cost: the proxy's pairs, and O(1), amortised, for each pair added since the last such call;
    /// after a sort or a large update() for each pair.
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* proxy,
                                               btDispatcher* dispatcher) override;

    /// Frees the algorithms of the proxy's pairs and keeps the pairs. Order and cost: as for removal. Ghosts keep
    /// their own algorithms.
    void cleanProxyFromPairs(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// As cleanProxyFromPairs(), and calls the ghost callback as if each pair had been removed and added, so that
    /// ghosts free their algorithms too.
    void renewPairsContainingProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    // --- The pairs of many proxies ---------------------------------------------------------------

    /// Removes the pairs of each proxy in turn, and then frees algorithms: in canonical order as single calls do,
    /// otherwise in any order. The order of arrival differs from single calls. With a ghost callback, or called
    /// within processAllOverlappingPairs(), does exactly what single calls do. Cost: the proxies' pairs, and at
    /// most one pass over all pairs.
    void removeOverlappingPairsContainingProxies(std::span<btBroadphaseProxy* const> proxies,
                                                 btDispatcher* dispatcher);

    // --- All pairs -------------------------------------------------------------------------------

    /// Calls callback->processOverlap() for every pair, and removes the pairs for which it returns true. The
    /// callback may add pairs, which it is shown too, and remove any pair. If it removes others than the shown one,
    /// some may be skipped this time. Cost: O(pairs), with added ones: the call ends when the callback adds no
    /// more.
    void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher) override;

    /// As above. With dispatchInfo.m_deterministicOverlappingPairs, by descending unique ids, as Bullet's cache;
    /// added pairs then wait for the next call.
    void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher,
                                    const btDispatcherInfo& dispatchInfo) override;

    [[nodiscard]] int getNumOverlappingPairs() const override { return pairs_.size(); }

    /// Returns the array, in canonical order if chosen. Within processAllOverlappingPairs(), changes by its
    /// callback are sorted in afterwards.
    btBroadphasePair* getOverlappingPairArrayPtr() override;
    btBroadphasePairArray& getOverlappingPairArray() override;

    /// Returns the array as it is, with changes since the last non-const call not sorted in.
    [[nodiscard]] const btBroadphasePair* getOverlappingPairArrayPtr() const override;

    /// Brings the array into canonical order once, with either PairOrder. Unlike Bullet's caches, keeps algorithms
    /// and calls no ghost callback.
    void sortOverlappingPairs(btDispatcher* dispatcher) override;

    /// Returns false: removal is immediate.
    bool hasDeferredRemoval() override { return false; }

    // --- Callbacks -------------------------------------------------------------------------------

    /// Asks the filter callback; without one, groups and masks decide, both ways. Returns false for two proxies
    /// that the broadphase ignores, or of different worlds of a WorldsBroadphase.
    [[nodiscard]] bool needsBroadphaseCollision(btBroadphaseProxy* proxy0,
                                                btBroadphaseProxy* proxy1) const override;
    /// As needsBroadphaseCollision(), but asks neither for ignored pairs nor for worlds.
    [[nodiscard]] bool doFiltersAccept(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) const {
        if (filter_ != nullptr) {
            const detail::QueryScope scope(this);
            return filter_->needBroadphaseCollision(proxy0, proxy1);
        }
        return doGroupsAccept(*proxy0, *proxy1);
    }
    /// Returns whether groups and masks accept the two, both ways.
    [[nodiscard]] static bool doGroupsAccept(const btBroadphaseProxy& a,
                                             const btBroadphaseProxy& b) noexcept {
        return (a.m_collisionFilterGroup & b.m_collisionFilterMask) != 0 &&
               (b.m_collisionFilterGroup & a.m_collisionFilterMask) != 0;
    }
    /// Returns the filter callback. If none is set, but the broadphase may refuse pairs, returns one that asks
    /// groups and masks: Bullet's casts of fast bodies call needsBroadphaseCollision() only if there is one.
    btOverlapFilterCallback* getOverlapFilterCallback() override;
    /// Sets the callback; NULL for none.
    void setOverlapFilterCallback(btOverlapFilterCallback* callback) override;
    [[nodiscard]] bool hasFilterCallback() const noexcept { return filter_ != nullptr; }

    /// Sets the callback that is called once for each added and each removed pair; NULL for none. As in Bullet's
    /// caches, not for present pairs.
    void setInternalGhostPairCallback(btOverlappingPairCallback* callback) override {
        ghosts_ = callback;
    }
    [[nodiscard]] btOverlappingPairCallback* getInternalGhostPairCallback() const noexcept {
        return ghosts_;
    }

    // --- Beyond Bullet ---------------------------------------------------------------------------

    [[nodiscard]] std::size_t capacity() const noexcept {
        return static_cast<std::size_t>(pairs_.capacity());
    }

    /// Returns how many pairs were listed so far to remove or clean the pairs of proxies.
    [[nodiscard]] std::uint64_t pairsVisited() const noexcept { return pairsVisited_; }

    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Gives back unused memory; pairs move. A SpatialHashBroadphase calls it by itself. Asserted: not within the
    /// filter. Cost: O(pairs).
    void releaseUnusedMemory() noexcept;

    /// Returns the broken invariant in a sentence; empty if all hold:
    /// - Every pair is found by the unique ids of its proxies.
    /// - Every pair has the proxy with the lower key first.
    /// - Every chained pair is chained once to each of its proxies.
    /// - An array that counts as sorted is in canonical order.
    [[nodiscard]] std::string validate() const;

    // --- For a broadphase ------------------------------------------------------------------------

    /// Which side removes a pair: a broadphase must know which pairs others take out.
    enum class Remover { broadphase, other };

    /// removeOverlappingPairsContainingProxies(), by this remover.
    void removePairsOf(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher,
                       Remover remover);

    /// The object that hears of pairs that others take out; null for none.
    [[nodiscard]] detail::CacheWatcher* watcher() const noexcept { return watcher_; }
    void setWatcher(detail::CacheWatcher* watcher) noexcept { watcher_ = watcher; }

private:
    // A pair has two edges, chained by proxy: 2 * its index for the lower unique id, and that + 1.
    struct Link {
        std::uint32_t next;
        std::uint32_t previous;
    };

    // The sort keys of a pair.
    struct PairSortKey {
        std::uint64_t keys;  // of first and second proxy, ascending as unsigned
        std::uint64_t uniqueIds;
        std::uint32_t index;
        std::uint32_t rank = 0;  // of its first proxy within a batch

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
    std::vector<Link> links_;       // by edge
    detail::RunMap firstEdge_;      // unique id -> first edge of the proxy's chain
    std::size_t pairsScanned_ = 0;  // instead of chaining, since the last chaining
    std::uint64_t pairsVisited_ = 0;
    bool isSorted_ = true;
    int processDepth_ = 0;  // processAllOverlappingPairs() calls under way

    std::vector<Retired> retired_;

    detail::CacheWatcher* watcher_ = nullptr;

    std::vector<std::uint32_t> places_;        // scratch: vacant in batches, new in sort()
    std::unique_ptr<detail::KeyParts> parts_;  // scratch of batches on threads
    detail::ProxyRanks ranks_;                 // scratch of removals
    std::vector<PairSortKey> scratch_;
};

// Bullet's constructor for two proxies orients by unique id.
inline void PairCache::name(const BulletProxyPair& proxies, btBroadphasePair& pair) const {
    HASHPHASE_ASSERT(proxies.ids() >> 32 != (proxies.ids() & kLowerHalf),
                     "PairCache: both proxies of a pair have one m_uniqueId. Use different ids.");
    HASHPHASE_ASSERT((proxies.ids() & 0x8000000080000000U) == 0,
                     "PairCache: the m_uniqueId of a proxy is negative. Use 0 or more.");
    const bool isSwapped = key_ != &uniqueId && isLower(*proxies.upper(), *proxies.lower());
    pair.m_pProxy0 = isSwapped ? proxies.upper() : proxies.lower();
    pair.m_pProxy1 = isSwapped ? proxies.lower() : proxies.upper();
    pair.m_algorithm = nullptr;
    pair.m_internalInfo1 = nullptr;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
