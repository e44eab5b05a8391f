// SPDX-License-Identifier: Zlib
#pragma once

// A SpatialHashBroadphase and its PairCache as they were at some time: for WorldSnapshot.

#include <broadphase/core/byte_stream.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/group_kinds.hpp>
#include <broadphase/grid_snapshot.hpp>
#include <integration/bullet/detail/object_numbers.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

class BroadphaseImage {
public:
    /// Two proxies by their indices, in the order of the pair.
    struct Pair {
        std::uint32_t first;
        std::uint32_t second;
        void* info;  // btBroadphasePair::m_internalInfo1
    };

    /// Says why the broadphase cannot be saved now; empty when it can.
    [[nodiscard]] static std::string faultOf(const SpatialHashBroadphase& broadphase);

    /// Where memory runs out, the image is of no use.
    void save(const SpatialHashBroadphase& broadphase);

    /// So that restore() takes no memory. Where it runs out, nothing has changed.
    void makeRoom(SpatialHashBroadphase& broadphase) const;

    /// Puts all back. Pairs have the algorithms that they have now, where they are between the same clients, and
    /// else none: what else there is of algorithms is freed, and tells nobody.
    void restore(SpatialHashBroadphase& broadphase, btDispatcher* dispatcher) const noexcept;

    /// The pairs of the cache as it lists them; for these algorithms are to be made after restore().
    [[nodiscard]] static std::span<btBroadphasePair> pairsOf(
        const SpatialHashBroadphase& broadphase) noexcept;
    /// Algorithms of pairs that are gone, which wait to be freed, in their order.
    [[nodiscard]] static std::size_t retiredCount(const SpatialHashBroadphase& broadphase) noexcept;
    [[nodiscard]] static btCollisionAlgorithm*& retired(const SpatialHashBroadphase& broadphase,
                                                        std::size_t i) noexcept;

    /// Frees the algorithms of the pairs of these clients.
    static void freeAlgorithmsOf(const SpatialHashBroadphase& broadphase,
                                 const ObjectNumbers& clients, btDispatcher& dispatcher);

    /// The proxy of that index.
    [[nodiscard]] static btBroadphaseProxy* proxyAt(const SpatialHashBroadphase& broadphase,
                                                    std::uint32_t index) noexcept;

    /// Whether all clients have such numbers.
    [[nodiscard]] bool areClientsAmong(const ObjectNumbers& numbers) const;
    /// Writes it; clients by their numbers among these.
    void write(ByteWriter& to, const ObjectNumbers& numbers) const;
    /// Reads what was written; `objects` are the clients by their numbers. Returns what is wrong.
    [[nodiscard]] std::string read(ByteReader& from, std::span<btCollisionObject* const> objects,
                                   const SpatialHashBroadphase& broadphase);
    /// Pairs as bytes, and back. Of what is read, whether they are of two different proxies, each once.
    static void writePairs(std::span<const Pair> pairs, ByteWriter& to);
    [[nodiscard]] bool readPairs(ByteReader& from, std::vector<Pair>& pairs) const;

    /// The client of the proxy of that index; null where there is none.
    [[nodiscard]] const btCollisionObject* clientOf(std::uint32_t index) const noexcept;
    [[nodiscard]] std::span<const Pair> pairs() const noexcept { return pairs_; }
    [[nodiscard]] std::size_t retiredCount() const noexcept { return retired_.size(); }

    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    using Broadphase = SpatialHashBroadphase;

    /// Calls visit(member, copy) for what is copied as it is.
    template <class Visit>
    static void forEachKept(auto& broadphase, auto& image, const Visit& visit);
    [[nodiscard]] bool readProxies(ByteReader& from, std::span<btCollisionObject* const> objects);
    void restoreCache(Broadphase& broadphase, btDispatcher* dispatcher) const noexcept;
    void restoreProxies(Broadphase& broadphase) const noexcept;
    void restoreTakenOut(Broadphase& broadphase) const noexcept;

    GridSnapshot<btScalar> grid_;
    std::vector<Broadphase::Proxy> proxies_;  // by index
    std::vector<int> uniqueIds_;
    int lastUniqueId_ = 0;
    bool groupsDecide_ = false;
    bool mustNoteGroups_ = false;
    bool isCacheBehind_ = false;
    bool mayGrow_ = false;
    GroupKinds groupKinds_;
    GroupKinds::Set changedKinds_ = 0;
    std::vector<std::uint64_t> seen_;
    std::size_t seenCount_ = 0;
    std::unique_ptr<FlatSet> ghosts_;

    // Of the cache.
    std::vector<Pair> pairs_;
    std::vector<Pair> takenOut_;
    std::vector<PairCache::PairSortKey> retired_;
    bool isSorted_ = true;
    bool isMoreTakenOut_ = false;
    // Scratch of restore(): what the cache's watch gets; and by the place of a saved pair.
    mutable std::unique_ptr<std::vector<BulletProxyPair>> takenOutAgain_;
    mutable std::vector<btCollisionAlgorithm*> algorithms_;
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
