// SPDX-License-Identifier: Zlib
//
// Many pairs at once. Single calls spend their time waiting: for the pair's place in the table, for
// the pair, for the last pair, which takes its place, and for that one's place in the table. Here
// what later pairs need is fetched while earlier ones are dealt with, and next to no pair is moved.

#include <integration/bullet/pair_cache.hpp>

#include <broadphase/core/ensure_capacity.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// How many pairs ahead the table is fetched, and then what it leads to.
constexpr std::size_t kFar = 16;
constexpr std::size_t kNear = 8;

}  // namespace

// --- Births and deaths ---------------------------------------------------------------------------

void PairCache::update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                       btDispatcher* dispatcher) {
    checkMayChange();
    checkRoomFor(born.size());
    if (isTold()) {
        updateOneByOne(died, born, dispatcher);
        return;
    }
    if (!died.empty() || !born.empty()) {
        exchange(died, born, dispatcher);
    }
    if (order_ == PairOrder::arrival) {
        freeRetiredAsListed();
    }
}

void PairCache::exchange(std::span<const BulletProxyPair> died,
                         std::span<const BulletProxyPair> born, btDispatcher* dispatcher) {
    dropChainsIfMany(died.size());
    places_.clear();
    detail::ensureCapacity(places_, died.size());
    try {
        vacateAll(died, dispatcher);
        makeRoomFor(born.size());
    } catch (...) {
        closeVacant(0);
        throw;
    }
    closeVacant(settle(born));
}

void PairCache::updateOneByOne(std::span<const BulletProxyPair> died,
                               std::span<const BulletProxyPair> born, btDispatcher* dispatcher) {
    for (std::size_t i = 0; i < died.size(); ++i) {
        prefetchAhead(died, i);
        if (kNear < ids_.size()) {
            ids_.prefetch(ids_.keys()[ids_.size() - 1 - kNear]);  // is soon to take a place
        }
        remove(died[i].ids(), dispatcher, freeingNow(), Remover::broadphase);
    }
    for (std::size_t i = 0; i < born.size(); ++i) {
        prefetchAhead(born, i);
        if (born[i].isUpToDate()) {  // a callback may have destroyed one of the two
            add(born[i]);
        }
    }
}

// What it takes to find the pair further on, and the pair.
void PairCache::prefetchAhead(std::span<const BulletProxyPair> pairs, std::size_t i) const {
    if (i + kFar < pairs.size()) {
        ids_.prefetch(pairs[i + kFar].ids());
    }
    if (i + kNear < pairs.size() && pairs_.size() > 0) {
        detail::prefetch(&pairs_[0] + ids_.prefetchKey(pairs[i + kNear].ids()));
    }
}

void PairCache::vacateAll(std::span<const BulletProxyPair> died, btDispatcher* dispatcher) {
    for (std::size_t i = 0; i < died.size(); ++i) {
        prefetchAhead(died, i);
        vacate(died[i].ids(), dispatcher, Remover::broadphase);
    }
}

// Removes the pair, if it is there, and leaves its place vacant.
void PairCache::vacate(std::uint64_t ids, btDispatcher* dispatcher, Remover remover) {
    if (dispatcher != nullptr) {
        detail::ensureCapacity(retired_, retired_.size() + 1);
    }
    const std::uint32_t index = ids_.vacate(ids);
    if (index == kNone) {
        return;
    }
    btBroadphasePair& pair = pairs_[static_cast<int>(index)];
    unchainPair(index, ids);
    if (remover == Remover::other) {
        noteTakenOut(pair);
    }
    retire(pair, ids, dispatcher);
    pair.m_pProxy0 = nullptr;
    places_.push_back(index);
    isSorted_ = false;
}

// So that settle() takes no more memory.
void PairCache::makeRoomFor(std::size_t bornCount) {
    if (bornCount > 0) {
        const std::size_t more = bornCount - std::min(bornCount, places_.size());
        ids_.reserve(ids_.size() + std::max<std::size_t>(more, 1));
    }
}

// Adds the pairs in vacant places, as long as there are some, and returns how many it took.
std::size_t PairCache::settle(std::span<const BulletProxyPair> born) {
    std::size_t taken = 0;
    for (std::size_t i = 0; i < born.size(); ++i) {
        if (i + kFar < born.size()) {
            ids_.prefetch(born[i + kFar].ids());
        }
        const auto end = static_cast<std::uint32_t>(pairs_.size());
        const std::uint32_t index = taken < places_.size() ? places_[taken] : end;
        if (const std::uint32_t known = ids_.insert(born[i].ids(), index); known != index) {
            HASHPHASE_ASSERT(isNamedBy(born[i], pairs_[static_cast<int>(known)]),
                             "Proxies that are alive have different unique ids.");
            continue;
        }
        if (index == end) {
            pairs_.push_back({});
        } else {
            chainPair(index);
            ++taken;
        }
        name(born[i], pairs_[static_cast<int>(index)]);
        isSorted_ = false;
    }
    return taken;
}

// Pairs from the end take the places that are still vacant.
void PairCache::closeVacant(std::size_t firstVacant) noexcept {
    for (std::size_t i = firstVacant; i < places_.size(); ++i) {
        while (pairs_.size() > 0 && pairs_[pairs_.size() - 1].m_pProxy0 == nullptr) {
            fill(static_cast<std::uint32_t>(pairs_.size()) - 1);
        }
        if (places_[i] < static_cast<std::uint32_t>(pairs_.size())) {
            fill(places_[i]);
        }
    }
}

// --- The pairs of many proxies -------------------------------------------------------------------

void PairCache::removeOverlappingPairsContainingProxies(std::span<btBroadphaseProxy* const> proxies,
                                                        btDispatcher* dispatcher) {
    removePairsOf(proxies, dispatcher, Remover::other);
}

void PairCache::removePairsOf(std::span<btBroadphaseProxy* const> proxies, btDispatcher* dispatcher,
                              Remover remover) {
    checkMayChange();
    constexpr std::size_t kFew = 4;  // so many single scans cost what one for many does
    if (isTold() || proxies.size() < kFew) {
        for (btBroadphaseProxy* proxy : proxies) {
            removePairsOfOne(*proxy, dispatcher, remover);
        }
        return;
    }
    freeRetired();
    dropChainsIfMany(proxies.size());
    chainIfWorth();
    std::vector<PairSortKey> notes = notesOfAll(proxies);
    places_.clear();
    detail::ensureCapacity(places_, notes.size());
    try {
        vacateAll(notes, dispatcher, remover);
    } catch (...) {
        closeVacant(0);
        throw;
    }
    closeVacant(0);
    scratch_ = std::move(notes);
    freeRetiredAsListed();
}

void PairCache::vacateAll(std::span<const PairSortKey> notes, btDispatcher* dispatcher,
                          Remover remover) {
    for (std::size_t i = 0; i < notes.size(); ++i) {
        if (i + kFar < notes.size()) {
            ids_.prefetch(notes[i + kFar].uniqueIds);
        }
        vacate(notes[i].uniqueIds, dispatcher, remover);
    }
}

// In the order in which their algorithms are to be freed; some may be listed twice. Of the chained
// pairs each proxy's are followed, the others are all looked at.
std::vector<PairCache::PairSortKey> PairCache::notesOfAll(
    std::span<btBroadphaseProxy* const> proxies) {
    std::vector<PairSortKey> notes = std::move(scratch_);
    notes.clear();
    const auto add = [&](std::uint32_t index, std::uint32_t rank) {
        notes.push_back(noteOf(index));
        notes.back().rank = rank;
    };
    for (std::uint32_t rank = 0; rank < proxies.size() && !links_.empty(); ++rank) {
        std::uint32_t edge = firstEdge_.find(static_cast<std::uint32_t>(proxies[rank]->m_uniqueId));
        for (; edge != kNone; edge = links_[edge].next) {
            add(edge / 2, rank);
        }
    }
    ranks_.assign(proxies);
    for (auto i = static_cast<std::uint32_t>(links_.size() / 2); i < ids_.size(); ++i) {
        const std::uint64_t ids = ids_.keys()[i];
        const std::uint32_t rank = ranks_.lowestRank(static_cast<std::uint32_t>(ids >> 32),
                                                     static_cast<std::uint32_t>(ids));
        if (rank != detail::ProxyRanks::kNone) {
            add(i, rank);
        }
    }
    pairsVisited_ += notes.size();
    if (order_ == PairOrder::canonical) {
        std::sort(notes.begin(), notes.end(), [](const PairSortKey& a, const PairSortKey& b) {
            return a.rank != b.rank ? a.rank < b.rank : a < b;
        });
    }
    return notes;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
