// SPDX-License-Identifier: Zlib
#pragma once

// What pairs remember of candidates from one call to the next.
//
// Two proxies that overlap, or touch on their ways, and may pair by their groups are a candidate, which the
// filter accepts or refuses. A pair is a candidate that was accepted. Which candidates there are follows
// from the boxes, so that it is enough to know which of them the filter refused; where those are too many,
// the pairs are remembered in their place.

#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/pair_key.hpp>
#include <broadphase/core/pair_key_set.hpp>
#include <broadphase/pairs/ignored_pairs.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace hashphase::detail {

/// What is known where many share a cell, or too many are refused.
struct Pile {
    // In place of the candidates that are watched, refused or kept, where those would be too many.
    FlatSet pairs;
    bool hasPairs = false;
    std::uint32_t updatesUntilLook = 0;  // whether they still would
    std::uint32_t lookInterval = 0;

    // Of what this call has asked in parts, whose answer makes or ends a pair.
    std::vector<PairKey> turned;
    // What this call has asked as a sample, and the answers by their numbers.
    FlatSet sampled;
    std::vector<char> sampledAccepted;

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(Pile& to, const Pile& from, const Visit& visit) {
        visit(to.pairs, from.pairs);
        visit(to.hasPairs, from.hasPairs);
        visit(to.updatesUntilLook, from.updatesUntilLook);
        visit(to.lookInterval, from.lookInterval);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + pairs.memoryBytes() + sampled.memoryBytes() +
               turned.capacity() * sizeof(PairKey) + sampledAccepted.capacity();
    }
};

/// Candidates of which one swept at the last update, and that touched on their ways; sorted. All the others
/// follow from boxes: what sweeps has none there, see Population::standingBox().
struct SweptPairs {
    std::vector<PairKey> atUpdate;
    std::vector<PairKey> now;  // the same of the update under way
    std::vector<PairKey>
        bySecond;  // atUpdate with the halves exchanged, sorted, when it is asked for

    [[nodiscard]] bool contains(PairKey key) const noexcept {
        return std::binary_search(atUpdate.begin(), atUpdate.end(), key);
    }
    [[nodiscard]] bool touchNow(PairKey key) const noexcept {
        return std::binary_search(now.begin(), now.end(), key);
    }
    /// Ends the update under way.
    void advance() noexcept {
        atUpdate.swap(now);
        bySecond.clear();
    }
    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(SweptPairs& to, const SweptPairs& from, const Visit& visit) {
        visit(to.atUpdate, from.atUpdate);
        visit(to.now, from.now);
        visit(to.bySecond, from.bySecond);
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return (atUpdate.capacity() + now.capacity() + bySecond.capacity()) * sizeof(PairKey);
    }
};

struct KnownPairs {
    FlatSet refused;             // candidates that the filter refused, unless they are ...
    FlatSet refusedAtRest;       // ... both at rest
    std::unique_ptr<Pile> pile;  // made when it is first needed

    // Pairs whose groups have been set since, so that they may not pair any more: they overlap. Those
    // that were filtered again count as refused until the next update.
    FlatSet kept;
    PairKeySet immediate;  // candidates decided since the last update
    // Made with the first one. Candidates among them count as refused.
    std::unique_ptr<IgnoredPairs> ignored;
    SweptPairs swept;
    std::size_t count = 0;  // of pairs

    /// Whether the pairs are remembered in place of what was refused.
    [[nodiscard]] bool arePairs() const noexcept { return pile != nullptr && pile->hasPairs; }
    /// Whether it is one of the pairs that are remembered.
    [[nodiscard]] bool isRemembered(PairKey key) const noexcept {
        return arePairs() && pile->pairs.contains(key);
    }
    /// Of two ids, the one with the lower index first.
    [[nodiscard]] bool isIgnored(const ProxyPair& pair) const noexcept {
        return ignored != nullptr && ignored->contains(pair);
    }
    [[nodiscard]] bool isRefused(PairKey key) const noexcept {
        return arePairs() ? !pile->pairs.contains(key)
                          : refused.contains(key) || refusedAtRest.contains(key);
    }
    /// Whether all candidates are pairs, and nothing is remembered of any.
    [[nodiscard]] bool areAllPairs() const noexcept {
        return !arePairs() && refusedCount() + kept.size() == 0;
    }
    [[nodiscard]] std::size_t refusedCount() const noexcept {
        return refused.size() + refusedAtRest.size();
    }

    /// How many candidates are remembered, and for how many there is room.
    [[nodiscard]] std::size_t size() const noexcept {
        return refusedCount() + immediate.size() + (pile != nullptr ? pile->pairs.size() : 0);
    }
    [[nodiscard]] std::size_t capacity() const noexcept {
        return refused.capacity() + refusedAtRest.capacity() + immediate.capacity() +
               (pile != nullptr ? pile->pairs.capacity() : 0);
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return refused.memoryBytes() + refusedAtRest.memoryBytes() + kept.memoryBytes() +
               immediate.memoryBytes() + swept.memoryBytes() +
               (pile != nullptr ? pile->memoryBytes() : 0) +
               (ignored != nullptr ? ignored->memoryBytes() : 0);
    }

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(KnownPairs& to, const KnownPairs& from, const Visit& visit) {
        visit(to.refused, from.refused);
        visit(to.refusedAtRest, from.refusedAtRest);
        visit(to.pile, from.pile);
        visit(to.kept, from.kept);
        visit(to.ignored, from.ignored);
        visit(to.immediate, from.immediate);
        visit(to.swept, from.swept);
        visit(to.count, from.count);
    }

    /// Returns whether the candidate was refused.
    bool forgetRefused(PairKey key) noexcept {
        return refused.erase(key) != FlatSet::kNone || refusedAtRest.erase(key) != FlatSet::kNone;
    }
    /// Forgets a candidate that has ended, or a pair that is refused now. Returns whether it was a pair.
    [[nodiscard]] bool endPair(PairKey key) noexcept {
        const bool wasPair =
            arePairs() ? pile->pairs.erase(key) != FlatSet::kNone : !forgetRefused(key);
        count -= wasPair ? 1 : 0;
        return wasPair;
    }
    /// A candidate becomes a pair. There is room for it.
    void accept(PairKey key) noexcept {
        if (arePairs()) {
            pile->pairs.findOrInsert(key);
        } else {
            forgetRefused(key);
        }
        ++count;
    }
    /// One of two that rested, and were refused, has woken. There is room for it, or it throws.
    void wake(PairKey key) {
        if (refusedAtRest.contains(key)) {
            refused.findOrInsert(key);
            refusedAtRest.erase(key);
        }
    }
};

}  // namespace hashphase::detail
