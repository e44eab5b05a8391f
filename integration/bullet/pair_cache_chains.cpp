// SPDX-License-Identifier: Zlib
//
// The pairs of one proxy. Those that have been there for a while are chained to each of their
// proxies; the others, behind the last that is chained, are looked through.

#include <integration/bullet/pair_cache.hpp>

#include <broadphase/core/caught.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

// --- Chains --------------------------------------------------------------------------------------

std::uint64_t PairCache::idOfEnd(std::uint32_t edge) const {
    const std::uint64_t ids = ids_.keys()[edge / 2];
    return edge % 2 == 0 ? ids >> 32 : ids & kLowerHalf;
}

void PairCache::chain(std::uint32_t edge) {
    const std::uint32_t next = firstEdge_.exchange(idOfEnd(edge), edge);
    if (next != kNone) {
        links_[next].previous = edge;
    }
    links_[edge] = {next, kNone};
}

void PairCache::unchain(std::uint32_t edge, std::uint64_t uniqueId) {
    const Link link = links_[edge];
    if (link.next != kNone) {
        links_[link.next].previous = link.previous;
    }
    if (link.previous != kNone) {
        links_[link.previous].next = link.next;
    } else {
        firstEdge_.exchange(uniqueId, link.next);
    }
}

// The pair has moved, in pairs_, from one edge's to the other's.
void PairCache::rename(std::uint32_t from, std::uint32_t to) {
    const Link link = links_[from];
    links_[to] = link;
    if (link.next != kNone) {
        links_[link.next].previous = to;
    }
    if (link.previous != kNone) {
        links_[link.previous].next = to;
    } else {
        firstEdge_.exchange(idOfEnd(to), to);
    }
}

// Most pairs die before anyone asks for those of a proxy, so chaining waits until scanning the ones
// that are not chained has cost as much.
void PairCache::chainIfWorth() {
    constexpr std::size_t kScansPerChaining = 16;
    const std::size_t chained = links_.size() / 2;
    const std::size_t unchained = ids_.size() - chained;
    pairsScanned_ += unchained;
    if (pairsScanned_ <= kScansPerChaining * unchained) {
        return;
    }
    pairsScanned_ = 0;
    if (!detail::hasRoomFor([&] { links_.resize(2 * ids_.size()); })) {
        return;
    }
    for (std::size_t i = chained; i < ids_.size(); ++i) {
        chainPair(static_cast<std::uint32_t>(i));
    }
}

// Of a place that is not among the chained, nothing. Chains are a convenience: where there is no memory
// for one there are none.
void PairCache::chainPair(std::uint32_t index) noexcept {
    const auto chainBoth = [&] {
        chain(2 * index);
        chain(2 * index + 1);
    };
    if (isChained(index) && !detail::hasRoomFor(chainBoth)) {
        dropChains();
    }
}

// Where many pairs change, making the chains anew, if ever they are needed, costs less than keeping
// them.
void PairCache::dropChainsIfMany(std::size_t changeCount) {
    constexpr std::size_t kManyInAll = 16;
    if (!links_.empty() && kManyInAll * changeCount > links_.size() / 2) {
        dropChains();
    }
}

void PairCache::dropChains() noexcept {
    links_.clear();
    firstEdge_.clear();
    pairsScanned_ = 0;
}

// --- One proxy -----------------------------------------------------------------------------------

// A block at a time, most of which have no pair of the proxy's.
void PairCache::noteUnchained(std::uint32_t id, std::vector<PairSortKey>& notes) const {
    constexpr std::size_t kBlock = 16;
    const std::span<const std::uint64_t> keys = ids_.keys();
    for (std::size_t first = links_.size() / 2; first < keys.size(); first += kBlock) {
        const std::size_t end = std::min(first + kBlock, keys.size());
        bool isOfNone = false;
        if (end - first == kBlock) {
            std::array<std::uint32_t, 2 * kBlock> halves;
            std::memcpy(halves.data(), &keys[first], sizeof(halves));
            isOfNone = std::count(halves.begin(), halves.end(), id) == 0;
        }
        for (std::size_t i = first; !isOfNone && i < end; ++i) {
            if (keys[i] >> 32 == id || (keys[i] & kLowerHalf) == id) {
                notes.push_back(noteOf(static_cast<std::uint32_t>(i)));
            }
        }
    }
}

// Noted down, for callbacks may change the cache. In canonical order, or in that of the array.
std::vector<PairCache::PairSortKey> PairCache::notesOf(const btBroadphaseProxy& proxy) {
    freeLeavingOf(proxy);
    freeRetired();
    chainIfWorth();
    std::vector<PairSortKey> notes = std::move(scratch_);
    notes.clear();
    for (std::uint32_t edge = firstEdge_.find(static_cast<std::uint32_t>(proxy.m_uniqueId));
         edge != kNone; edge = links_[edge].next) {
        notes.push_back(noteOf(edge / 2));
    }
    noteUnchained(static_cast<std::uint32_t>(proxy.m_uniqueId), notes);
    pairsVisited_ += notes.size();
    const bool byKey = order_ == PairOrder::canonical;
    std::sort(notes.begin(), notes.end(), [=](const PairSortKey& a, const PairSortKey& b) {
        return byKey ? a < b : a.index < b.index;
    });
    return notes;
}

// Without memory to note pairs down: from the end, for the last pair takes the place of one that goes.
template <class Visit>
void PairCache::forEachUnnoted(const btBroadphaseProxy& proxy, const Visit& visit) {
    for (int i = pairs_.size() - 1; i >= 0; i = std::min(i, pairs_.size()) - 1) {
        if (pairs_[i].m_pProxy0 == &proxy || pairs_[i].m_pProxy1 == &proxy) {
            visit(ids_.keys()[static_cast<std::size_t>(i)], pairs_[i]);
        }
    }
}

void PairCache::removeOverlappingPairsContainingProxy(btBroadphaseProxy* proxy,
                                                      btDispatcher* dispatcher) {
    removePairsOfOne(*proxy, dispatcher, Remover::other);
}

void PairCache::removePairsOfOne(btBroadphaseProxy& proxy, btDispatcher* dispatcher,
                                 Remover remover) {
    std::vector<PairSortKey> notes;
    if (!detail::hasRoomFor([&] { notes = notesOf(proxy); })) {
        forEachUnnoted(proxy, [&](std::uint64_t ids, const btBroadphasePair& /*pair*/) {
            remove(ids, dispatcher, Freeing::now, remover);
        });
        return;
    }
    std::size_t first = 0;
    std::size_t last = notes.size();
    auto count = static_cast<std::uint32_t>(pairs_.size());
    while (first < last) {
        remove(notes[first++].uniqueIds, dispatcher, Freeing::now, remover);
        --count;
        // As in a scan of the whole array, which is Bullet's way: the pair at the end has moved to
        // where the scan is, and if it is one of the proxy's it is the next to go.
        while (order_ == PairOrder::arrival && first < last && notes[last - 1].index == count) {
            remove(notes[--last].uniqueIds, dispatcher, Freeing::now, remover);
            --count;
        }
    }
    scratch_ = std::move(notes);
}

// Calls visit(ids, pair) for each; pairs may go meanwhile. Never for want of memory does it fail: Bullet cleans
// the pairs of what it removes.
template <class Visit>
void PairCache::forEachPairOf(const btBroadphaseProxy& proxy, const Visit& visit) {
    std::vector<PairSortKey> notes;
    if (!detail::hasRoomFor([&] { notes = notesOf(proxy); })) {
        forEachUnnoted(proxy, visit);
        return;
    }
    for (const PairSortKey& note : notes) {
        if (const std::uint32_t index = indexOf(note); index != kNone) {
            visit(note.uniqueIds, pairs_[static_cast<int>(index)]);
        }
    }
    scratch_ = std::move(notes);
}

void PairCache::cleanProxyFromPairs(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    forEachPairOf(*proxy, [&](std::uint64_t /*ids*/, btBroadphasePair& pair) {
        cleanOverlappingPair(pair, dispatcher);
    });
}

void PairCache::renewPairsContainingProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) {
    checkMayChange();
    forEachPairOf(*proxy, [&](std::uint64_t ids, btBroadphasePair& pair) {
        cleanOverlappingPair(pair, dispatcher);
        tellGhostsAgain(ids, dispatcher);
    });
}

// Freeing the algorithm may have moved the pair, or removed it: then ghosts know. The callback may remove the
// pair, or itself.
void PairCache::tellGhostsAgain(std::uint64_t ids, btDispatcher* dispatcher) {
    const std::uint32_t index = ids_.find(ids);
    if (ghosts_ == nullptr || index == kNone) {
        return;
    }
    btBroadphaseProxy* const proxy0 = pairs_[static_cast<int>(index)].m_pProxy0;
    btBroadphaseProxy* const proxy1 = pairs_[static_cast<int>(index)].m_pProxy1;
    const detail::QueryScope scope(this, detail::QueryScope::Changes::allowed);
    ghosts_->removeOverlappingPair(proxy0, proxy1, dispatcher);
    if (ghosts_ != nullptr && ids_.find(ids) != kNone) {
        ghosts_->addOverlappingPair(proxy0, proxy1);
    }
}

bool PairCache::areChainsSound() const {
    std::size_t edgeCount = 0;
    bool isSound = links_.size() <= 2 * ids_.size();
    firstEdge_.forEach([&](std::uint64_t uniqueId, std::uint32_t first) {
        std::uint32_t previous = kNone;
        for (std::uint32_t edge = first; isSound && edge != kNone; edge = links_[edge].next) {
            isSound = edge < links_.size() && links_[edge].previous == previous &&
                      idOfEnd(edge) == uniqueId && ++edgeCount <= links_.size();
            previous = edge;
        }
    });
    return isSound && edgeCount == links_.size();
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
