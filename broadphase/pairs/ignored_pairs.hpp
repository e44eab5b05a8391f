// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/pair_key.hpp>
#include <broadphase/pair_filter.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::detail {

/// The pairs that are ignored, by their ids: those of a proxy that was removed mean none that comes after it.
/// They stay until there are twice as many pairs as were left the last time, so that each is looked at about
/// twice.
class IgnoredPairs {
public:
    /// Of two ids, the one with the lower index first, as everywhere here.
    [[nodiscard]] bool contains(const ProxyPair& pair) const noexcept {
        const std::uint32_t number = pairs_.empty() ? FlatSet::kNone : keys_.find(keyOf(pair));
        return number != FlatSet::kNone && pairs_[number] == pair;
    }
    [[nodiscard]] std::size_t size() const noexcept { return pairs_.size(); }

    /// In no order, some of proxies that were removed.
    [[nodiscard]] std::span<const ProxyPair> pairs() const noexcept { return pairs_; }

    /// Makes room for `count` more, in place of those that isGone(pair) says may go. Cost: O(count) amortised.
    template <class IsGone>
    void reserve(std::size_t count, const IsGone& isGone) {
        if (pairs_.size() + count > mostUnchecked_) {
            eraseIf(isGone);
            mostUnchecked_ = kFew + 2 * (pairs_.size() + count);
        }
        keys_.reserve(pairs_.size() + count);
        ensureCapacity(pairs_, pairs_.size() + count);
    }
    /// There is room for it. It takes the place of a pair with the same indices.
    void insert(const ProxyPair& pair) noexcept {  // NOLINT(bugprone-exception-escape)
        const std::uint32_t number = keys_.findOrInsert(keyOf(pair));
        if (number == pairs_.size()) {
            pairs_.push_back(pair);
        } else {
            pairs_[number] = pair;
        }
    }
    /// Of a pair that is not there nothing. Leaves room for it.
    void erase(const ProxyPair& pair) noexcept {
        if (contains(pair)) {
            pairs_[keys_.erase(keyOf(pair))] = pairs_.back();
            pairs_.pop_back();
        }
    }

    /// Gives back what isGone(pair) says may go, and unused room. Where memory runs out, nothing is lost.
    template <class IsGone>
    void shrink(const IsGone& isGone) {
        eraseIf(isGone);
        keys_.shrink();
        pairs_.shrink_to_fit();
        mostUnchecked_ = kFew + 2 * pairs_.size();
    }
    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(IgnoredPairs& to, const IgnoredPairs& from, const Visit& visit) {
        visit(to.keys_, from.keys_);
        visit(to.pairs_, from.pairs_);
        visit(to.mostUnchecked_, from.mostUnchecked_);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + keys_.memoryBytes() + pairs_.capacity() * sizeof(ProxyPair);
    }

private:
    static constexpr std::size_t kFew = 64;

    [[nodiscard]] static PairKey keyOf(const ProxyPair& pair) noexcept {
        return pairKey(pair.first.index, pair.second.index);
    }
    template <class IsGone>
    void eraseIf(const IsGone& isGone) noexcept {
        for (std::size_t i = pairs_.size(); i > 0;) {
            --i;
            const ProxyPair pair = pairs_[i];
            if (isGone(pair)) {
                erase(pair);
            }
        }
    }

    FlatSet keys_;
    std::vector<ProxyPair> pairs_;  // by the number of their key
    std::size_t mostUnchecked_ = kFew;
};

}  // namespace hashphase::detail
