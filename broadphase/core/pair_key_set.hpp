// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/flat_set.hpp>
#include <broadphase/core/pair_key.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::detail {

/// A set of pairs of indices, in which those of one index are chained. Keeps its
/// memory.
class PairKeySet {
public:
    [[nodiscard]] bool contains(PairKey key) const noexcept { return keys_.contains(key); }
    [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }
    [[nodiscard]] std::span<const PairKey> keys() const noexcept { return keys_.keys(); }

    /// Makes room for `count` pairs of indices below `indexCount`, so that insert() does not allocate.
    void reserve(std::size_t count, std::size_t indexCount) {
        keys_.reserve(count);
        ensureCapacity(next_, 2 * count);
        if (firstOf_.size() < indexCount) {
            firstOf_.resize(indexCount, kNone);
        }
    }

    /// There is room for it. Cost: O(1).
    void insert(PairKey key) noexcept {
        if (keys_.findOrInsert(key) == next_.size() / 2) {
            chain(firstIndex(key));
            chain(secondIndex(key));
        }
    }

    /// Calls visit(key) for those of the index. Cost: their number.
    template <class Visit>
    void forEachOf(std::uint32_t proxyIndex, const Visit& visit) const {
        for (std::uint32_t at = proxyIndex < firstOf_.size() ? firstOf_[proxyIndex] : kNone;
             at != kNone; at = next_[at]) {
            visit(keys_.keys()[at / 2]);
        }
    }

    /// Cost: O(capacity), nothing when it is empty.
    void clear() noexcept {
        for (const PairKey key : keys_.keys()) {
            firstOf_[firstIndex(key)] = kNone;
            firstOf_[secondIndex(key)] = kNone;
        }
        keys_.clear();
        next_.clear();
    }

    [[nodiscard]] std::size_t capacity() const noexcept { return keys_.capacity(); }

    /// Gives its memory back when it is empty.
    void shrink() {
        if (keys_.size() == 0) {
            *this = PairKeySet();
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return keys_.memoryBytes() +
               (next_.capacity() + firstOf_.capacity()) * sizeof(std::uint32_t);
    }

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(PairKeySet& to, const PairKeySet& from, const Visit& visit) {
        visit(to.keys_, from.keys_);
        visit(to.next_, from.next_);
        visit(to.firstOf_, from.firstOf_);
    }

private:
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    void chain(std::uint32_t proxyIndex) noexcept {
        const auto at = static_cast<std::uint32_t>(next_.size());
        next_.push_back(firstOf_[proxyIndex]);
        firstOf_[proxyIndex] = at;
    }

    FlatSet keys_;
    std::vector<std::uint32_t> next_;     // two for each key: the next one of either index
    std::vector<std::uint32_t> firstOf_;  // by index
};

}  // namespace hashphase::detail
