// SPDX-License-Identifier: Zlib
//
// Many pairs at once. Single calls spend their time waiting: for the pair's place in the table, for
// the pair, for the last pair, which takes its place, and for that one's place in the table. Here
// what later pairs need is fetched while earlier ones are dealt with, and next to no pair is moved.

#include <integration/bullet/pair_cache.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// How many pairs ahead the table is fetched, and then what it leads to.
constexpr std::size_t kFar = 16;
constexpr std::size_t kNear = 8;

}  // namespace

// --- Births and deaths ---------------------------------------------------------------------------

void PairCache::update(std::span<const ProxyCouple> died, std::span<const ProxyCouple> born,
                       btDispatcher* dispatcher) {
    if (isTold()) {
        updateOneByOne(died, born, dispatcher);
        return;
    }
    // Where many pairs die, making the chains anew, if ever they are needed, costs less.
    constexpr std::size_t kManyInAll = 16;
    if (!links_.empty() && kManyInAll * died.size() > links_.size() / 2) {
        dropChains();
    }
    vacant_.clear();
    vacateAll(died, dispatcher);
    closeVacant(settle(born));
    if (order_ == PairOrder::arrival) {
        freeRetiredAsListed();
    }
}

void PairCache::updateOneByOne(std::span<const ProxyCouple> died, std::span<const ProxyCouple> born,
                               btDispatcher* dispatcher) {
    for (std::size_t i = 0; i < died.size(); ++i) {
        if (i + kFar < died.size()) {
            ids_.prefetch(died[i + kFar].ids());
        }
        remove(died[i].ids(), dispatcher, freeingNow());
    }
    for (std::size_t i = 0; i < born.size(); ++i) {
        if (i + kFar < born.size()) {
            ids_.prefetch(born[i + kFar].ids());
        }
        add(born[i]);
    }
}

void PairCache::vacateAll(std::span<const ProxyCouple> died, btDispatcher* dispatcher) {
    if (pairs_.size() == 0) {
        return;
    }
    const btBroadphasePair* firstPair = &pairs_[0];
    for (std::size_t i = 0; i < died.size(); ++i) {
        if (i + kFar < died.size()) {
            ids_.prefetch(died[i + kFar].ids());
        }
        if (i + kNear < died.size()) {
            detail::prefetch(firstPair + ids_.prefetchKey(died[i + kNear].ids()));
        }
        vacate(died[i].ids(), dispatcher);
    }
}

// Removes the pair, if it is there, and leaves its place vacant.
void PairCache::vacate(std::uint64_t ids, btDispatcher* dispatcher) {
    const std::uint32_t index = ids_.vacate(ids);
    if (index == kNone) {
        return;
    }
    btBroadphasePair& pair = pairs_[static_cast<int>(index)];
    unchainPair(index, ids);
    retire(pair, ids, dispatcher);
    pair.m_pProxy0 = nullptr;
    vacant_.push_back(index);
    isSorted_ = false;
}

// Adds the pairs in vacant places, as long as there are some, and returns how many it took.
std::size_t PairCache::settle(std::span<const ProxyCouple> born) {
    std::size_t taken = 0;
    for (std::size_t i = 0; i < born.size(); ++i) {
        if (i + kFar < born.size()) {
            ids_.prefetch(born[i + kFar].ids());
        }
        const auto end = static_cast<std::uint32_t>(pairs_.size());
        const std::uint32_t index = taken < vacant_.size() ? vacant_[taken] : end;
        if (ids_.insert(born[i].ids(), index) != index) {
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
void PairCache::closeVacant(std::size_t firstVacant) {
    for (std::size_t i = firstVacant; i < vacant_.size(); ++i) {
        while (pairs_.size() > 0 && pairs_[pairs_.size() - 1].m_pProxy0 == nullptr) {
            fill(static_cast<std::uint32_t>(pairs_.size()) - 1);
        }
        if (vacant_[i] < static_cast<std::uint32_t>(pairs_.size())) {
            fill(vacant_[i]);
        }
    }
}

// --- The pairs of many proxies -------------------------------------------------------------------

void PairCache::removeOverlappingPairsContainingProxies(std::span<btBroadphaseProxy* const> proxies,
                                                        btDispatcher* dispatcher) {
    // A proxy by itself costs as much as a pass does for so many pairs, chaining included.
    constexpr std::size_t kPairsOfPass = 128;
    if (isTold() || proxies.size() * kPairsOfPass < ids_.size()) {
        for (btBroadphaseProxy* proxy : proxies) {
            removeOverlappingPairsContainingProxy(proxy, dispatcher);
        }
        return;
    }
    freeRetired();
    dropChains();
    std::vector<Note> notes = notesOfAll(proxies);
    vacant_.clear();
    for (const Note& note : notes) {
        vacate(note.uniqueIds, dispatcher);
    }
    closeVacant(0);
    scratch_ = std::move(notes);
    freeRetiredAsListed();
}

// Grouped by the first proxy that they are of; within, in canonical order or in that of the array.
std::vector<PairCache::Note> PairCache::notesOfAll(std::span<btBroadphaseProxy* const> proxies) {
    ranks_.clear();
    for (const btBroadphaseProxy* proxy : proxies) {
        ranks_.findOrInsert(static_cast<std::uint32_t>(proxy->m_uniqueId));
    }
    std::vector<Note> notes = std::move(scratch_);
    notes.clear();
    for (std::uint32_t i = 0; i < ids_.size(); ++i) {
        const std::uint64_t ids = ids_.keys()[i];
        const std::uint32_t rank = std::min(ranks_.find(ids >> 32), ranks_.find(ids & kLowerHalf));
        if (rank != kNone) {
            notes.push_back(noteOf(i));
            notes.back().rank = rank;
        }
    }
    pairsVisited_ += notes.size();
    const bool byKey = order_ == PairOrder::canonical;
    std::sort(notes.begin(), notes.end(), [=](const Note& a, const Note& b) {
        return a.rank != b.rank ? a.rank < b.rank : byKey ? a < b : a.index < b.index;
    });
    return notes;
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
