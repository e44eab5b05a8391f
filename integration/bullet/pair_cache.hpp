// SPDX-License-Identifier: Zlib
#pragma once

// A pair cache for Bullet. It removes a body in time proportional to the body's pairs; Bullet's cache scans all pairs
// twice. It works under any broadphase:
//
//     hashphase::PairCache pairCache;
//     btDbvtBroadphase broadphase(&pairCache);
//
// Threads   Several threads may call const members at the same time. During other calls, no other thread may use the
//           cache.
// Pointers  Pairs move in memory when a pair is added or removed, and in sortOverlappingPairs() and
//           releaseUnusedMemory(). With PairOrder::canonical, pairs also move when the whole array is read: by
//           processAllOverlappingPairs(), getOverlappingPairArray() or the non-const getOverlappingPairArrayPtr().
//           Do not resize or reorder the array.
// Callbacks The ghost callback and destructors of freed algorithms run after the change that caused them. They may
//           change the cache, and so may the callback of processAllOverlappingPairs(). The filter must not change the
//           cache.
// Removal   If your program removes a pair, the next calculateOverlappingPairs() of a SpatialHashBroadphase adds it
//           again, unless its proxies have separated or the filter refuses it. Exception: a SpatialHashBroadphase
//           that got the cache as a btOverlappingPairCache* adds it only when its proxies meet again. With
//           PairOrder::canonical, the algorithms of pairs that removeOverlappingPair() and update() remove outside
//           processAllOverlappingPairs() are freed later: when the whole array is next read, or when the pairs of
//           any proxy are next removed or cleaned. In all other cases, algorithms are freed immediately.
// Memory    Throws std::bad_alloc when memory runs out. In that case, a call for one pair has changed nothing. A call
//           for many pairs may have removed some or all of its pairs. It has added none, or some if it works like
//           single calls (see update()). Removing one proxy's pairs always works; without memory, it scans all
//           pairs. Exception: the array of pairs is a Bullet array, which crashes if it cannot grow.
// NULL      If the dispatcher is NULL, no algorithms are freed, as in Bullet. Clients may be NULL.
// Misuse    Asserted: the two proxies of a pair differ, unique ids of live proxies differ and are not negative, and
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
enum class PairOrder : std::uint8_t {
    /// New pairs are appended. The last pair moves to the place of a removed pair, as in Bullet's cache (for batches,
    /// see update()). Equal calls on an empty cache give an equal order. Setting boxes back to an earlier frame
    /// restores the pairs, but not their order. Cost: none.
    arrival,
    /// When the whole array is read, pairs are sorted ascending by the keys of both proxies. Equal sets of pairs have
    /// an equal order under any broadphase. For programs that set boxes back to an earlier frame; WorldSnapshot does
    /// not need this order. Algorithms are freed in this order too. As a result, all broadphases that find exactly
    /// the overlapping pairs give equal manifolds and trajectories. Cost: O(n log n) for n pairs, at the first read
    /// after pairs changed.
    canonical,
};

/// Returns a proxy's sort key. If keys are equal, m_uniqueId decides. The key must not change while the proxy has
/// pairs.
using ProxyKey = int (*)(const btBroadphaseProxy&);

/// Two proxies, and copies of their unique ids, so that a batch need not read the proxies.
class BulletProxyPair {
public:
    BulletProxyPair() noexcept = default;

    BulletProxyPair(btBroadphaseProxy& a, btBroadphaseProxy& b) noexcept
        : BulletProxyPair(a, a.m_uniqueId, b, b.m_uniqueId) {}

    /// `idOfA` must be a.m_uniqueId, and `idOfB` b.m_uniqueId (not checked).
    BulletProxyPair(btBroadphaseProxy& a, int idOfA, btBroadphaseProxy& b, int idOfB) noexcept
        : lower_(idOfA < idOfB ? &a : &b),
          upper_(idOfA < idOfB ? &b : &a),
          ids_(std::uint64_t{static_cast<std::uint32_t>(idOfA < idOfB ? idOfA : idOfB)} << 32 |
               static_cast<std::uint32_t>(idOfA < idOfB ? idOfB : idOfA)) {}

    /// lower() returns the proxy with the lower unique id, upper() the other proxy.
    [[nodiscard]] btBroadphaseProxy* lower() const noexcept { return lower_; }
    [[nodiscard]] btBroadphaseProxy* upper() const noexcept { return upper_; }

    /// Returns both unique ids; the lower id is in the upper 32 bits.
    [[nodiscard]] std::uint64_t ids() const noexcept { return ids_; }

    /// Returns false if the unique id of either proxy has changed, for example because a SpatialHashBroadphase
    /// destroyed the proxy. Reads both proxies, so do not call it after a proxy was freed: btDbvtBroadphase frees
    /// destroyed proxies immediately, SpatialHashBroadphase only with unused memory (see its releaseUnusedMemory()).
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
    /// In each pair, m_pProxy0 is the proxy with the lower key: by default the lower unique id, as in Bullet. If the
    /// broadphase reuses unique ids, the cache works, but equal sets of objects may get different orders. To prevent
    /// this, pass another key. Asserted: `key` is not null.
    explicit PairCache(PairOrder order = PairOrder::arrival, ProxyKey key = &uniqueId)
        : key_(key), order_(order) {
        HASHPHASE_ASSERT(key != nullptr,
                         "PairCache: the key is null. Pass a function, or omit it.");
    }

    ~PairCache() override;
    PairCache(const PairCache&) = delete;
    PairCache& operator=(const PairCache&) = delete;

    /// The default key function. Not inline, because the cache compares its address.
    static int uniqueId(const btBroadphaseProxy& proxy);

    /// Maximum number of pairs in Bullet's array.
    static constexpr std::size_t kMostPairs = std::size_t{1} << 30;

    // --- One pair --------------------------------------------------------------------------------

    /// Returns the pair, and adds it if it is missing. Returns NULL if the filter refuses it. Calls the ghost
    /// callback for a new pair. If the cache has kMostPairs pairs, throws std::length_error, even for a pair that
    /// exists, and changes nothing. Cost: O(1).
    btBroadphasePair* addOverlappingPair(btBroadphaseProxy* proxy0,
                                         btBroadphaseProxy* proxy1) override;

    /// As addOverlappingPair(), but accepts every pair: does not call needsBroadphaseCollision().
    btBroadphasePair* addAcceptedPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1);

    /// Removes the pair, calls the ghost callback, then frees the algorithm (see Removal). Returns the pair's
    /// m_internalInfo1, or NULL if the pair is missing. Cost: O(1).
    void* removeOverlappingPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1,
                                btDispatcher* dispatcher) override;

    /// Returns the pair, or NULL if it is missing. Does not ask the filter. Cost: O(1).
    btBroadphasePair* findPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) override;

    /// Frees the pair's algorithm and keeps the pair.
    void cleanOverlappingPair(btBroadphasePair& pair, btDispatcher* dispatcher) override;

    // --- Many pairs ------------------------------------------------------------------------------

    /// Removes the pairs of `died`, then adds the pairs of `born` without asking the filter. Skips pairs of `died`
    /// that are missing, and pairs of `born` that are present. With PairOrder::arrival, the first added pairs take
    /// the places of the first removed pairs. Further added pairs go to the end; if fewer are added, pairs from the
    /// end fill the gaps. If a ghost callback is set, or within processAllOverlappingPairs(), works exactly like
    /// single calls. For thousands of pairs, runs on the threads of `parallelFor`. The result does not depend on the
    /// number of threads. Callbacks run on the caller's thread. If the number of present pairs plus born.size()
    /// exceeds kMostPairs, throws std::length_error and changes nothing. Cost: O(1) for each pair; single calls cost
    /// three times as much.
    void update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                btDispatcher* dispatcher, ParallelFor parallelFor);
    void update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                btDispatcher* dispatcher);

    // --- The pairs of one proxy ------------------------------------------------------------------

    /// Removes the proxy's pairs one by one: with PairOrder::canonical in canonical order, otherwise in the order of
    /// Bullet's cache. Frees each pair's algorithm immediately. Cost: proportional to the proxy's pairs, plus
    /// amortised O(1) for each pair added since the last such call. After a sort or a large update(), all pairs count
    /// as added.
    void removeOverlappingPairsContainingProxy(btBroadphaseProxy* proxy,
                                               btDispatcher* dispatcher) override;

    /// Frees the algorithms of the proxy's pairs and keeps the pairs. Order and cost: as
    /// removeOverlappingPairsContainingProxy(). Ghost objects keep their own algorithms.
    void cleanProxyFromPairs(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

    /// As cleanProxyFromPairs(). Also calls the ghost callback as if each pair was removed and added again: ghost
    /// objects free their algorithms too.
    void renewPairsContainingProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher);

    // --- The pairs of many proxies ---------------------------------------------------------------

    /// Removes the pairs of all these proxies, then frees their algorithms. With PairOrder::canonical, frees them in
    /// the order of single calls. With PairOrder::arrival, frees them in any order, and may order pairs differently
    /// than single calls. If a ghost callback is set, or within processAllOverlappingPairs(), works exactly like
    /// single calls. Cost: proportional to the proxies' pairs, plus at most one pass over all pairs.
    void removeOverlappingPairsContainingProxies(std::span<btBroadphaseProxy* const> proxies,
                                                 btDispatcher* dispatcher);

    // --- All pairs -------------------------------------------------------------------------------

    /// Calls callback->processOverlap() for every pair, and removes the pair if the callback returns true. The
    /// callback may add pairs, and is called for them, too. It may remove any pair. If it removes a pair other than
    /// its argument, some pairs may be skipped. Cost: O(pairs), including added pairs. Does not return while the
    /// callback keeps adding pairs.
    void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher) override;

    /// As above. If dispatchInfo.m_deterministicOverlappingPairs is true, calls the callback in descending order of
    /// unique ids, as Bullet's cache does. In that case, skips pairs that the callback adds.
    void processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher,
                                    const btDispatcherInfo& dispatchInfo) override;

    [[nodiscard]] int getNumOverlappingPairs() const override { return pairs_.size(); }

    /// Returns the array. With PairOrder::canonical, sorts it first, except within processAllOverlappingPairs().
    btBroadphasePair* getOverlappingPairArrayPtr() override;
    btBroadphasePairArray& getOverlappingPairArray() override;

    /// Returns the array without sorting it. With PairOrder::canonical, it may be unsorted after a change of pairs.
    [[nodiscard]] const btBroadphasePair* getOverlappingPairArrayPtr() const override;

    /// Sorts the array into canonical order now, with either PairOrder, except within processAllOverlappingPairs().
    /// Unlike Bullet's caches, keeps algorithms and calls no ghost callback.
    void sortOverlappingPairs(btDispatcher* dispatcher) override;

    /// Returns false: pairs are removed immediately.
    bool hasDeferredRemoval() override { return false; }

    // --- Callbacks -------------------------------------------------------------------------------

    /// Returns false if the broadphase ignores the pair, or if the proxies are in different worlds of a
    /// WorldsBroadphase. Otherwise asks the filter callback. If no callback is set, returns doGroupsAccept().
    [[nodiscard]] bool needsBroadphaseCollision(btBroadphaseProxy* proxy0,
                                                btBroadphaseProxy* proxy1) const override;
    /// Asks the filter callback, or, if none is set, checks groups and masks. May accept ignored pairs, and proxies
    /// of different worlds.
    [[nodiscard]] bool doFiltersAccept(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) const {
        if (filter_ != nullptr) {
            const detail::QueryScope scope(this);
            return filter_->needBroadphaseCollision(proxy0, proxy1);
        }
        return doGroupsAccept(*proxy0, *proxy1);
    }
    /// Returns whether the group of each proxy is in the mask of the other.
    [[nodiscard]] static bool doGroupsAccept(const btBroadphaseProxy& a,
                                             const btBroadphaseProxy& b) noexcept {
        return (a.m_collisionFilterGroup & b.m_collisionFilterMask) != 0 &&
               (b.m_collisionFilterGroup & a.m_collisionFilterMask) != 0;
    }
    /// Returns the filter callback. If none is set, but the broadphase ignores pairs or is a WorldsBroadphase,
    /// returns a callback that checks groups and masks. Reason: Bullet's casts of fast bodies call
    /// needsBroadphaseCollision() only if there is a callback.
    btOverlapFilterCallback* getOverlapFilterCallback() override;
    /// Sets the filter callback. NULL removes it.
    void setOverlapFilterCallback(btOverlapFilterCallback* callback) override;
    [[nodiscard]] bool hasFilterCallback() const noexcept { return filter_ != nullptr; }

    /// Sets the ghost callback, which is called once for each added and each removed pair. As in Bullet's caches,
    /// this function does not call it for existing pairs. NULL removes it.
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

    /// Returns the number of pairs visited so far by calls that remove or clean the pairs of proxies.
    [[nodiscard]] std::uint64_t pairsVisited() const noexcept { return pairsVisited_; }

    [[nodiscard]] std::size_t memoryBytes() const noexcept;

    /// Frees unused memory; pairs move. A SpatialHashBroadphase calls this function automatically, unless it got the
    /// cache as a btOverlappingPairCache*. Asserted: the filter is not running. Cost: O(pairs).
    void releaseUnusedMemory() noexcept;

    /// Returns a sentence about a broken invariant; empty if all of these hold:
    /// - Every pair can be found by the unique ids of its proxies.
    /// - Every pair has the proxy with the lower key first.
    /// - Every pair is exactly once in the internal pair list of each of its proxies, or in no such list.
    /// - An array that is marked as sorted is in canonical order.
    [[nodiscard]] std::string validate() const;

    // --- For a broadphase ------------------------------------------------------------------------

    /// Who removes a pair. The cache notifies the broadphase of removals by others.
    enum class Remover { broadphase, other };

    /// As removeOverlappingPairsContainingProxies(). Notifies the broadphase if the remover is not the broadphase.
    void removePairsOf(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher,
                       Remover remover);

    /// The object that is notified when others remove pairs; null if there is none.
    [[nodiscard]] detail::CacheWatcher* watcher() const noexcept { return watcher_; }
    void setWatcher(detail::CacheWatcher* watcher) noexcept { watcher_ = watcher; }

private:
    // An edge in the chain of a proxy. Each chained pair has two: edge 2 * index is in the chain of the proxy with
    // the lower unique id, edge 2 * index + 1 in the chain of the other proxy.
    struct Link {
        std::uint32_t next;
        std::uint32_t previous;
    };

    // The sort keys of a pair, and its index in pairs_.
    struct PairSortKey {
        std::uint64_t keys;  // keys of both proxies, as unsigned numbers that sort like the keys
        std::uint64_t uniqueIds;
        std::uint32_t index;
        std::uint32_t rank = 0;  // in a batch of proxies: index of one of the pair's proxies

        friend bool operator<(const PairSortKey& a, const PairSortKey& b) noexcept {
            return a.keys != b.keys ? a.keys < b.keys : a.uniqueIds < b.uniqueIds;
        }
    };

    enum class Freeing { now, inTurn };
    class Processing;
    class Leaving;

    static constexpr std::uint32_t kNone = detail::FlatSet::kNone;
    static constexpr std::uint64_t kLowerHalf = 0xffffffffU;  // mask for the higher unique id

    // A removed pair whose algorithm is not freed yet.
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
    void tellGhostsAgain(std::uint64_t ids, btDispatcher* dispatcher);
    template <class Visit>
    void forEachUnnoted(const btBroadphaseProxy& proxy, const Visit& visit);
    void processByUniqueId(btOverlapCallback& callback, btDispatcher* dispatcher);
    void prepareWholeArray();
    void sort();
    void freeRetired();
    void freeRetiredAsListed();
    void freeLeavingOf(const btBroadphaseProxy& proxy);
    [[nodiscard]] bool areChainsSound() const;

    friend class detail::BroadphaseImage;
    ProxyKey key_;
    btOverlapFilterCallback* filter_ = nullptr;
    btOverlappingPairCallback* ghosts_ = nullptr;

    btBroadphasePairArray pairs_;
    detail::FlatSet ids_;           // BulletProxyPair::ids() of each pair in pairs_
    std::vector<Link> links_;       // indexed by edge
    detail::RunMap firstEdge_;      // unique id -> first edge of the proxy's chain
    std::size_t pairsScanned_ = 0;  // unchained pairs scanned since the last chaining
    std::uint64_t pairsVisited_ = 0;
    PairOrder order_;
    bool isSorted_ = true;
    int processDepth_ = 0;  // number of nested processAllOverlappingPairs() calls

    std::vector<Retired> retired_;
    Leaving* leaving_ = nullptr;  // pairs that are being freed

    detail::CacheWatcher* watcher_ = nullptr;

    std::vector<std::uint32_t> places_;        // scratch: vacant or new indices of pairs_
    std::unique_ptr<detail::KeyParts> parts_;  // scratch for batches on several threads
    detail::ProxyRanks ranks_;                 // scratch for removals
    std::vector<PairSortKey> scratch_;
};

// Bullet's constructor for two proxies would order them by unique id.
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
