// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/flat_set.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::detail {

/// A map for keys that come in runs: the values of neighbours share a cache line. Sparse keys cost
/// memory, 64 bytes each, but are as valid.
class RunMap {
public:
    /// Is every key's value at first, and not to be told from no value.
    static constexpr std::uint32_t kNone = FlatSet::kNone;

    [[nodiscard]] std::uint32_t find(std::uint64_t key) const noexcept {
        const std::uint32_t number = blocks_.find(key / kBlockSize);
        return number == kNone ? kNone : values_[number].of[key % kBlockSize];
    }

    /// Gives the key a value and returns the last one. Where memory runs out, nothing has changed;
    /// that cannot be where the key has a value. Cost: O(1), amortised.
    std::uint32_t exchange(std::uint64_t key, std::uint32_t value) {
        std::uint32_t number = blocks_.find(key / kBlockSize);
        if (number == kNone) {
            ensureCapacity(values_, values_.size() + 1);
            number = blocks_.findOrInsert(key / kBlockSize);
            values_.emplace_back().of.fill(kNone);
        }
        Block& block = values_[number];
        const std::uint32_t before = std::exchange(block.of[key % kBlockSize], value);
        if (value == kNone && isEmpty(block)) {
            blocks_.erase(key / kBlockSize);
            block = values_.back();
            values_.pop_back();
        }
        return before;
    }

    /// Removes all values and keeps the memory. Cost: O(capacity), nothing when there are none.
    void clear() noexcept {
        blocks_.clear();
        values_.clear();
    }

    /// Gives back room for more values than there are. Where memory runs out, all values are as they were.
    void shrink() {
        blocks_.shrink();
        values_.shrink_to_fit();
    }

    /// Calls visit(key, value) for every key that has a value.
    template <class Visit>
    void forEach(Visit&& visit) const {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            for (std::size_t j = 0; j < kBlockSize; ++j) {
                if (values_[i].of[j] != kNone) {
                    visit(blocks_.keys()[i] * kBlockSize + j, values_[i].of[j]);
                }
            }
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return blocks_.memoryBytes() + values_.capacity() * sizeof(Block);
    }

    /// As FlatSet::validate(), and:
    /// - There is a block of values for every run, and a value in it.
    [[nodiscard]] std::string validate() const {
        if (values_.size() != blocks_.size() ||
            std::any_of(values_.begin(), values_.end(), isEmpty)) {
            return "There is a block of values for every run, and a value in it: broken.";
        }
        return blocks_.validate();
    }

private:
    static constexpr std::size_t kBlockSize = 16;

    struct alignas(64) Block {
        std::array<std::uint32_t, kBlockSize> of;
    };

    static bool isEmpty(const Block& block) noexcept {
        return std::all_of(block.of.begin(), block.of.end(),
                           [](std::uint32_t value) { return value == kNone; });
    }

    FlatSet blocks_;  // by key / kBlockSize
    std::vector<Block> values_;
};

}  // namespace hashphase::detail
