// SPDX-License-Identifier: Zlib
#pragma once

// What Pairs are made of: which candidates are watched, what is known of them, and the call under way. Plain
// data, like the store: the passes beside this file (*.inl) read and change it in place, step.cpp puts those
// of an update in order.

#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/peak_watch.hpp>
#include <broadphase/core/radix_sort.hpp>
#include <broadphase/export.hpp>
#include <broadphase/geometry/box_columns.hpp>
#include <broadphase/pair_filter.hpp>
#include <broadphase/pairs/known_pairs.hpp>
#include <broadphase/pairs/last_update.hpp>
#include <broadphase/pairs/pair_call.hpp>
#include <broadphase/search/contact_search.hpp>
#include <broadphase/search/pair_parts.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/store/store.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hashphase::detail {

/// The candidates of two that are settled, of which one has slack: the pairs of entries of their table whose
/// filed boxes overlap and that may pair. They stand as long as the table is not filed anew; entries may have
/// left it.
struct SettledPairs {
    PairList pairs;
    std::vector<std::uint8_t> overlapped;  // at the last update; by pair
    // The numbers of each entry's pairs, and where they begin; made when few entries change.
    std::vector<std::uint32_t> pairsOf;
    std::vector<std::uint32_t> firstOf;
    std::vector<std::uint32_t> turned;      // scratch
    std::vector<std::size_t> turnedInPart;  // the same
    std::vector<PairKey> begun;             // scratch

    void clear() noexcept {
        pairs.clear();
        overlapped.clear();
        firstOf.clear();
    }
    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(SettledPairs& to, const SettledPairs& from, const Visit& visit) {
        visit(to.pairs, from.pairs);
        visit(to.overlapped, from.overlapped);
        visit(to.pairsOf, from.pairsOf);
        visit(to.firstOf, from.firstOf);
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + pairs.memoryBytes() + overlapped.capacity() +
               begun.capacity() * sizeof(PairKey) + turnedInPart.capacity() * sizeof(std::size_t) +
               (pairsOf.capacity() + firstOf.capacity() + turned.capacity()) *
                   sizeof(std::uint32_t);
    }
};

/// The candidates that overlapped at the last update and of which one is mobile, the refused ones included.
/// `a`, and among the mobile ones `b`, is a place in Population::mobile, or, once a frame has filed anew, an
/// entry of the mobile table; both are in spatial order, so that boxes of a candidate are near in memory.
struct WatchedPairs {
    PairList amongMobile;
    PairList toResting;                     // b is a proxyIndex
    PairList carried;                       // scratch
    std::unique_ptr<SettledPairs> settled;  // made when the first ones settle

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(WatchedPairs& to, const WatchedPairs& from, const Visit& visit) {
        visit(to.amongMobile, from.amongMobile);
        visit(to.toResting, from.toResting);
        visit(to.settled, from.settled);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return amongMobile.memoryBytes() + toResting.memoryBytes() + carried.memoryBytes() +
               (settled != nullptr ? settled->memoryBytes() : 0);
    }
};

/// What searches find, and what they look for.
template <class Scalar>
struct SearchScratch {
    PairList selected;
    PairParts parts;
    // In update(), entries in the mobile table, by place in Population::mobile; between updates, proxies that
    // listStrays() has found.
    std::vector<std::uint32_t> entryOf;
    std::vector<std::uint32_t> searchedEntries;  // of a table
    std::vector<std::uint32_t> searchedIndices;  // proxies of these, or of some
    BoxColumns<Scalar> bounds;                   // of what is looked for in a table
    std::vector<char> isNamed;                   // by index

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return selected.memoryBytes() + parts.memoryBytes() + bounds.memoryBytes() +
               (entryOf.capacity() + searchedEntries.capacity() + searchedIndices.capacity()) *
                   sizeof(std::uint32_t) +
               isNamed.capacity();
    }
};

template <class Scalar>
struct HASHPHASE_BROADPHASE_TEMPLATE_EXPORT PairState {
    using Box = Aabb<Scalar>;

    Store<Scalar>& store;
    Population<Scalar>& proxies = store.proxies;
    Tables<Scalar>& tables = store.tables;
    Sweeping<Scalar>* sweeping;  // null for none

    WatchedPairs watched;
    KnownPairs known;
    LastUpdate<Scalar> lastUpdate{store};
    PairCall call;
    PairChangeLists updateChanges;
    PairChangeLists immediateChanges;
    PairCost cost;
    PeakWatch peaks;
    // Until more candidates are immediate, those of removed proxies stay.
    std::uint32_t fewImmediate = kFewImmediate;
    SearchScratch<Scalar> scratch;

    static constexpr std::uint32_t kFewImmediate = 64;
    /// Candidates that are asked about at once, some twice.
    static constexpr std::size_t kPart = 8192;

    /// Of a store that has no other one. All that rests wakes.
    PairState(Store<Scalar>& itsStore, Sweeping<Scalar>* itsSweeping);
    ~PairState();
    PairState(const PairState&) = delete;
    PairState& operator=(const PairState&) = delete;

    /// From now on follows these ways, or with null none.
    void setSweeping(Sweeping<Scalar>* next);

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(PairState& to, const PairState& from, const Visit& visit) {
        visit(to.watched, from.watched);
        visit(to.known, from.known);
        visit(to.lastUpdate, from.lastUpdate);
        visit(to.cost, from.cost);
        visit(to.peaks, from.peaks);
        visit(to.fewImmediate, from.fewImmediate);
    }

    // --- A candidate -----------------------------------------------------------------------------

    [[nodiscard]] ProxyPair pairOf(PairKey key) const noexcept {
        return {proxies.idOf(firstIndex(key)), proxies.idOf(secondIndex(key))};
    }
    [[nodiscard]] bool overlapNow(PairKey key) const noexcept {
        return overlaps(proxies.standingBox(proxies.records[firstIndex(key)]),
                        proxies.standingBox(proxies.records[secondIndex(key)]));
    }
    [[nodiscard]] bool areAlive(PairKey key) const noexcept {
        return proxies.isAlive(firstIndex(key)) && proxies.isAlive(secondIndex(key));
    }
    [[nodiscard]] bool areAlive(const ProxyPair& pair) const noexcept {
        return proxies.contains(pair.first) && proxies.contains(pair.second);
    }
    [[nodiscard]] bool areAtRest(PairKey key) const noexcept {
        return proxies.rests(firstIndex(key)) && proxies.rests(secondIndex(key));
    }
    /// At rest, and not to move without waking.
    [[nodiscard]] bool areStill(PairKey key) const noexcept {
        return areAtRest(key) && !proxies.records[firstIndex(key)].hasSlack &&
               !proxies.records[secondIndex(key)].hasSlack;
    }
    [[nodiscard]] bool mayPairNow(PairKey key) const noexcept {
        return proxies.mayPairNow(firstIndex(key), secondIndex(key));
    }
    /// Whether the filter decides.
    [[nodiscard]] bool mayAsk(PairKey key) const noexcept {
        return mayPairNow(key) && (known.ignored == nullptr || !known.isIgnored(pairOf(key)));
    }
    /// At the last update.
    [[nodiscard]] bool couldPair(PairKey key) const noexcept {
        return proxies.couldPair(firstIndex(key), secondIndex(key));
    }
    /// Whether the two were a candidate by their boxes at the last update.
    [[nodiscard]] bool wasCandidate(PairKey key) const noexcept {
        return store.overlappedAtUpdate(firstIndex(key), secondIndex(key)) &&
               (couldPair(key) || known.kept.contains(key) || known.isRemembered(key));
    }
    /// The same, or by their ways, or found since.
    [[nodiscard]] bool isKnown(PairKey key) const noexcept {
        return wasCandidate(key) || known.immediate.contains(key) || known.swept.contains(key);
    }
    /// Where a proxy alive is now; of what sweeps, where its way begins.
    [[nodiscard]] Box boxAtStart(std::uint32_t proxyIndex) const {
        return sweeping != nullptr ? sweeping->motions.boxAtStart(proxyIndex)
                                   : proxies.records[proxyIndex].box;
    }
    [[nodiscard]] bool touchAtStart(PairKey key) const {
        return overlaps(boxAtStart(firstIndex(key)), boxAtStart(secondIndex(key)));
    }

    // --- What passes share -----------------------------------------------------------------------

    void sort(std::vector<PairKey>& keys, ParallelFor parallelFor = serialFor) {
        radixSort(keys, static_cast<std::uint32_t>(proxies.records.size()), call.sorted,
                  parallelFor);
    }
    void sortAndUnite(std::vector<PairKey>& keys) {
        sort(keys);
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    }
    void listToAsk(PairKey key) { call.asked.push_back(key); }
    void endIfSeparated(PairKey key) {
        if (!overlapNow(key)) {
            call.ended.push_back(key);
        }
    }
    /// A pair whose groups do not let it pair any more is kept as long as it overlaps.
    void keepIfPair(PairKey key) {
        if (!mayPairNow(key) && overlapNow(key) && !known.isRefused(key)) {
            call.keptNow.push_back(key);
        }
    }
    void endPair(PairKey key) noexcept {
        if (known.endPair(key)) {
            call.died.push_back(key);
        }
    }
    /// The grid keeps the indices of those that are removed apart, until their candidates are ended.
    void markImmediate(std::span<const PairKey> keys, bool are) noexcept {
        for (const PairKey key : keys) {
            proxies.records[firstIndex(key)].isImmediate = are;
            proxies.records[secondIndex(key)].isImmediate = are;
        }
    }
};

extern template struct PairState<float>;
extern template struct PairState<double>;

}  // namespace hashphase::detail
