// SPDX-License-Identifier: Zlib
//
// Many pairs at once. Single calls spend their time waiting: for the pair's place in the table, for
// the pair, for the last pair, which takes its place, and for that one's place in the table. Here
// what later pairs need is fetched while earlier ones are dealt with, and next to no pair is moved.

#include <integration/bullet/pair_cache.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/on_failure.hpp>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// How many pairs ahead the table is fetched, and then what it leads to.
constexpr std::size_t kFar = 16;
constexpr std::size_t kNear = 8;

// Fewer births and deaths are not worth the threads.
constexpr std::size_t kManyPairs = 4096;

}  // namespace

// --- Births and deaths ---------------------------------------------------------------------------

void PairCache::update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                       btDispatcher* dispatcher) {
    updateAny(died, born, dispatcher, nullptr);
}

void PairCache::update(std::span<const BulletProxyPair> died, std::span<const BulletProxyPair> born,
                       btDispatcher* dispatcher, ParallelFor parallelFor) {
    updateAny(died, born, dispatcher, &parallelFor);
}

void PairCache::updateAny(std::span<const BulletProxyPair> died,
                          std::span<const BulletProxyPair> born, btDispatcher* dispatcher,
                          const ParallelFor* onThreads) {
    checkMayChange();
    checkRoomFor(born.size());
    if (isTold()) {
        updateOneByOne(died, born, dispatcher);
        return;
    }
    if (!died.empty() || !born.empty()) {
        exchange(died, born, dispatcher, onThreads);
    }
    if (order_ == PairOrder::arrival) {
        freeRetiredAsListed();
    }
}

void PairCache::exchange(std::span<const BulletProxyPair> died,
                         std::span<const BulletProxyPair> born, btDispatcher* dispatcher,
                         const ParallelFor* onThreads) {
    dropChainsIfMany(died.size());
    const bool areMany = onThreads != nullptr && died.size() + born.size() >= kManyPairs &&
                         links_.empty() && ids_.isInParts() &&
                         key_ == &uniqueId;  // any other is asked on this thread
    places_.clear();
    detail::ensureCapacity(places_, std::max(died.size(), born.size()));
    if (areMany) {
        if (parts_ == nullptr) {
            parts_ = std::make_unique<detail::KeyParts>();
        }
        parts_->reserve(std::max(died.size(), born.size()));
    }
    const detail::OnFailure close([&] { closeVacant(); });
    if (areMany) {
        vacateInParts(died, dispatcher, *onThreads);
    } else {
        vacateAll(died, dispatcher);
    }
    makeRoomFor(born.size());
    isSorted_ = isSorted_ && born.empty();
    if (areMany) {
        settleInParts(born, *onThreads);
    } else {
        settle(born);
    }
    closeVacant();
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
    places_.push_back(index);
}

// Each of so many pairs gets a place: the first ones those that are vacant, the others at the end. From then on
// nothing takes memory.
void PairCache::makeRoomFor(std::size_t bornCount) {
    const std::size_t more = bornCount - std::min(bornCount, places_.size());
    if (bornCount > 0) {
        ids_.reserve(ids_.size() + more + 1);
    }
    ids_.addVacant(more);
    for (std::size_t i = 0; i < more; ++i) {
        places_.push_back(static_cast<std::uint32_t>(pairs_.size()));
        pairs_.push_back({});
    }
}

// A pair that is there already leaves its place vacant.
void PairCache::takePlace(const BulletProxyPair& born, std::uint32_t& place, std::uint32_t index) {
    btBroadphasePair& pair = pairs_[static_cast<int>(index)];
    if (index != place) {
        HASHPHASE_ASSERT(isNamedBy(born, pair),
                         "Two live proxies have the same m_uniqueId. Give each proxy of a "
                         "PairCache an id of its own.");
        return;
    }
    name(born, pair);
    chainPair(index);
    place = kNone;
}

void PairCache::settle(std::span<const BulletProxyPair> born) {
    for (std::size_t i = 0; i < born.size(); ++i) {
        if (i + kFar < born.size()) {
            ids_.prefetch(born[i + kFar].ids());
        }
        takePlace(born[i], places_[i], ids_.insert(born[i].ids(), places_[i]));
    }
}

// Pairs from the end take the places that are still vacant.
void PairCache::closeVacant() noexcept {
    std::erase(places_, kNone);
    for (const std::uint32_t place : places_) {
        pairs_[static_cast<int>(place)].m_pProxy0 = nullptr;
    }
    for (const std::uint32_t place : places_) {
        while (pairs_.size() > 0 && pairs_[pairs_.size() - 1].m_pProxy0 == nullptr) {
            fill(static_cast<std::uint32_t>(pairs_.size()) - 1);
        }
        if (place < static_cast<std::uint32_t>(pairs_.size())) {
            fill(place);
        }
    }
}

// --- On threads ----------------------------------------------------------------------------------

// As vacate(). Where there is no memory to retire pairs, they stay.
void PairCache::vacateInParts(std::span<const BulletProxyPair> died, btDispatcher* dispatcher,
                              ParallelFor parallelFor) {
    ids_.reserve(ids_.size() + 1);  // so that what is put back takes no memory
    std::atomic<bool> mustRetire{false};
    const auto noteIfToRetire = [&](std::uint32_t index) {
        if (dispatcher != nullptr && index != kNone &&
            pairs_[static_cast<int>(index)].m_algorithm != nullptr &&
            !mustRetire.load(std::memory_order_relaxed)) {
            mustRetire.store(true, std::memory_order_relaxed);
        }
        return index;
    };
    const std::span<std::uint32_t> found = parts_->search(
        died.size(), parallelFor, [&](std::size_t i) { return died[i].ids(); },
        [&](std::size_t i) { detail::prefetch(&pairs_[0] + ids_.prefetchKey(died[i].ids())); },
        [&](std::size_t i) {
            std::optional<std::uint32_t> index = ids_.vacateInPart(died[i].ids());
            noteIfToRetire(index.value_or(kNone));
            return index;
        });
    for (std::size_t i = 0; i < died.size(); ++i) {
        if (found[i] == detail::KeyParts::kNotSearched) {
            found[i] = noteIfToRetire(ids_.vacate(died[i].ids()));
        }
    }
    if (mustRetire.load(std::memory_order_relaxed)) {
        {
            const detail::OnFailure putBack([&] {
                for (std::size_t i = 0; i < died.size(); ++i) {
                    if (found[i] != kNone) {
                        ids_.insert(died[i].ids(), found[i]);
                    }
                }
            });
            detail::ensureCapacity(retired_, retired_.size() + died.size());
        }
        for (std::size_t i = 0; i < died.size(); ++i) {
            if (found[i] != kNone) {
                retire(pairs_[static_cast<int>(found[i])], died[i].ids(), dispatcher);
            }
        }
    }
    std::ranges::copy_if(found, std::back_inserter(places_),
                         [](std::uint32_t index) { return index != kNone; });
}

// As settle().
void PairCache::settleInParts(std::span<const BulletProxyPair> born, ParallelFor parallelFor) {
    const std::span<const std::uint32_t> found = parts_->search(
        born.size(), parallelFor, [&](std::size_t i) { return born[i].ids(); },
        [&](std::size_t i) { detail::prefetch(&pairs_[0] + places_[i]); },
        [&](std::size_t i) {
            std::optional<std::uint32_t> index = ids_.insertInPart(born[i].ids(), places_[i]);
            if (index) {
                takePlace(born[i], places_[i], *index);
            }
            return index;
        });
    for (std::size_t i = 0; i < born.size(); ++i) {
        if (found[i] == detail::KeyParts::kNotSearched) {
            takePlace(born[i], places_[i], ids_.insert(born[i].ids(), places_[i]));
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
    for (const btBroadphaseProxy* const proxy : proxies) {
        freeLeavingOf(*proxy);
    }
    freeRetired();
    dropChainsIfMany(proxies.size());
    chainIfWorth();
    std::vector<PairSortKey> notes = notesOfAll(proxies);
    places_.clear();
    detail::ensureCapacity(places_, notes.size());
    {
        const detail::OnFailure close([&] { closeVacant(); });
        vacateAll(notes, dispatcher, remover);
    }
    closeVacant();
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
