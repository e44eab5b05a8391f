// SPDX-License-Identifier: Zlib
#pragma once

// Hash tables of 64-bit keys in flat arrays.
//
// FlatSet numbers its keys 0, 1, 2 ... without gaps, so that callers keep what belongs to a key in
// arrays of their own; FlatMap does so with one 32-bit value a key, RunMap with the values of 16
// neighbouring keys. The slots of the table hold a number and a part of the hash, eight bytes, and
// are probed linearly, at most 5/8 of them in use. An erased slot leaves no tombstone, those behind
// it move up: the table is as good after a million frames as after the first.
//
// Memory    Grows by doubling and never shrinks: a steady population allocates nothing.
// Order     A function of the calls so far, and nothing that means anything.
// Threads   Everything const may run anywhere, the rest needs the container for itself.
// Misuse    Inserting a key that is there; asserted. Every key is valid.

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::detail {

class FlatSet {
public:
    /// Not the number of any key.
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// The key's number, or kNone. Cost: O(1).
    [[nodiscard]] std::uint32_t find(std::uint64_t key) const noexcept {
        return keys_.empty() ? kNone : slots_[slotOf(key, hash(key))].number;
    }

    /// The key's number. A key that was not there gets the next one, size() before the call.
    /// Cost: O(1), amortised.
    std::uint32_t findOrInsert(std::uint64_t key) {
        if (keys_.size() >= sizeLimit_) {
            rehash(slots_.empty() ? kSmallestCapacity : 2 * slots_.size());
        }
        const std::uint32_t keyHash = hash(key);
        Slot& slot = slots_[slotOf(key, keyHash)];
        if (slot.number == kNone) {
            slot = {keyHash, static_cast<std::uint32_t>(keys_.size())};
            keys_.push_back(key);
        }
        return slot.number;
    }

    /// Removes the key, gives its number to the last key, and returns it; kNone when the key was
    /// not there. Cost: O(1).
    std::uint32_t erase(std::uint64_t key) noexcept {
        if (keys_.empty()) {
            return kNone;
        }
        const std::size_t slot = slotOf(key, hash(key));
        const std::uint32_t number = slots_[slot].number;
        if (number == kNone) {
            return kNone;
        }
        eraseSlot(slot);
        const auto last = static_cast<std::uint32_t>(keys_.size()) - 1;
        if (number != last) {
            const std::uint64_t moved = keys_[last];
            slots_[slotOfNumber(last, hash(moved))].number = number;
            keys_[number] = moved;
        }
        keys_.pop_back();
        return number;
    }

    /// By number; valid until the next insertion or erasure.
    [[nodiscard]] std::span<const std::uint64_t> keys() const noexcept { return keys_; }
    [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }

    /// Removes all keys and keeps the memory. Cost: O(capacity), nothing when there are none.
    void clear() noexcept {
        if (!keys_.empty()) {
            keys_.clear();
            std::fill(slots_.begin(), slots_.end(), Slot{});
        }
    }

    /// Makes room for `count` keys, so that no insertion allocates until there are more.
    void reserve(std::size_t count) {
        keys_.reserve(count);
        std::size_t capacity = slots_.empty() ? kSmallestCapacity : slots_.size();
        while (limitOf(capacity) < count) {
            capacity *= 2;
        }
        if (capacity != slots_.size()) {
            rehash(capacity);
        }
    }

    /// Gives the key with number i the number newNumbers[i], a permutation, which is used up.
    /// Calls swapNumbers(i, j) for every exchange on the way there, so that the caller's arrays can
    /// follow. Cost: O(capacity).
    template <class Swap>
    void renumber(std::span<std::uint32_t> newNumbers, Swap&& swapNumbers) {
        HASHPHASE_ASSERT(newNumbers.size() == keys_.size(), "There is a new number for every key.");
        for (Slot& slot : slots_) {
            slot.number = slot.number == kNone ? kNone : newNumbers[slot.number];
        }
        for (std::uint32_t i = 0; i < newNumbers.size(); ++i) {
            while (newNumbers[i] != i) {
                const std::uint32_t j = newNumbers[i];
                std::swap(keys_[i], keys_[j]);
                std::swap(newNumbers[i], newNumbers[j]);
                swapNumbers(i, j);
            }
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return slots_.capacity() * sizeof(Slot) + keys_.capacity() * sizeof(std::uint64_t);
    }

    /// How many slots the dearest find() of a present key looks at; 0 when empty.
    /// Cost: O(capacity).
    [[nodiscard]] std::size_t longestProbe() const noexcept {
        std::size_t longest = 0;
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            const std::size_t probe = ((i - home(slots_[i].hash)) & (slots_.size() - 1)) + 1;
            longest = slots_[i].number != kNone && probe > longest ? probe : longest;
        }
        return longest;
    }

    /// Says which invariant is broken, in a sentence; empty when all hold:
    /// - Every key is found under its number.
    /// - There are as many slots in use as keys.
    [[nodiscard]] std::string validate() const {
        for (std::uint32_t i = 0; i < keys_.size(); ++i) {
            if (find(keys_[i]) != i) {
                return "Every key is found under its number: broken.";
            }
        }
        std::size_t used = 0;
        for (const Slot& slot : slots_) {
            used += slot.number != kNone ? 1 : 0;
        }
        return used == keys_.size() ? "" : "There are as many slots in use as keys: broken.";
    }

private:
    struct Slot {
        std::uint32_t hash = 0;
        std::uint32_t number = kNone;
    };

    static constexpr std::size_t kSmallestCapacity = 16;

    static constexpr std::size_t limitOf(std::size_t capacity) noexcept { return capacity / 8 * 5; }

    // Keys are regular: two small numbers side by side, multiples, runs. One multiplication alone
    // sends some strides into long runs of slots; two do not.
    static std::uint32_t hash(std::uint64_t key) noexcept {
        key *= 0x9e3779b97f4a7c15U;
        key ^= key >> 32;
        key *= 0xbf58476d1ce4e5b9U;
        return static_cast<std::uint32_t>(key >> 32);
    }

    [[nodiscard]] std::size_t home(std::uint32_t keyHash) const noexcept {
        return keyHash >> shift_;
    }

    // The slot with the key, or the empty one where it would go. There is always an empty one.
    [[nodiscard]] std::size_t slotOf(std::uint64_t key, std::uint32_t keyHash) const noexcept {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = home(keyHash);
        while (slots_[i].number != kNone &&
               (slots_[i].hash != keyHash || keys_[slots_[i].number] != key)) {
            i = (i + 1) & mask;
        }
        return i;
    }

    [[nodiscard]] std::size_t slotOfNumber(std::uint32_t number,
                                           std::uint32_t keyHash) const noexcept {
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = home(keyHash);
        while (slots_[i].number != number) {
            i = (i + 1) & mask;
        }
        return i;
    }

    // A slot behind moves up into the hole unless that lies before its home.
    void eraseSlot(std::size_t hole) noexcept {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t i = (hole + 1) & mask; slots_[i].number != kNone; i = (i + 1) & mask) {
            if (((i - home(slots_[i].hash)) & mask) >= ((i - hole) & mask)) {
                slots_[hole] = slots_[i];
                hole = i;
            }
        }
        slots_[hole].number = kNone;
    }

    void rehash(std::size_t capacity) {
        const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(capacity));
        sizeLimit_ = limitOf(capacity);
        shift_ = 32 - static_cast<unsigned>(std::countr_zero(capacity));
        for (const Slot& slot : old) {
            if (slot.number != kNone) {
                slots_[slotOfNumber(kNone, slot.hash)] = slot;
            }
        }
    }

    std::vector<Slot> slots_;  // none, or a power of two
    std::vector<std::uint64_t> keys_;
    std::size_t sizeLimit_ = 0;
    unsigned shift_ = 32;  // the home of a hash is its upper bits
};

class FlatMap {
public:
    /// The key's value, or nullptr; valid until the next insertion or erasure. Cost: O(1).
    [[nodiscard]] std::uint32_t* find(std::uint64_t key) noexcept {
        const std::uint32_t number = keys_.find(key);
        return number == FlatSet::kNone ? nullptr : &values_[number];
    }
    [[nodiscard]] const std::uint32_t* find(std::uint64_t key) const noexcept {
        const std::uint32_t number = keys_.find(key);
        return number == FlatSet::kNone ? nullptr : &values_[number];
    }

    /// Adds a key that is not there yet. Cost: O(1), amortised.
    void insert(std::uint64_t key, std::uint32_t value) {
        [[maybe_unused]] const std::size_t sizeBefore = size();
        findOrInsert(key, value);
        HASHPHASE_ASSERT(size() > sizeBefore, "A key is inserted only when it is not there yet.");
    }

    /// The key's value, which becomes `valueIfNew` when the key was not there; valid until the next
    /// insertion or erasure. Cost: O(1), amortised.
    std::uint32_t& findOrInsert(std::uint64_t key, std::uint32_t valueIfNew) {
        const std::uint32_t number = keys_.findOrInsert(key);
        if (number == values_.size()) {
            values_.push_back(valueIfNew);
        }
        return values_[number];
    }

    /// Removes the key and returns its value; nothing when it was not there. Cost: O(1).
    std::optional<std::uint32_t> erase(std::uint64_t key) noexcept {
        const std::uint32_t number = keys_.erase(key);
        if (number == FlatSet::kNone) {
            return std::nullopt;
        }
        const std::uint32_t value = std::exchange(values_[number], values_.back());
        values_.pop_back();
        return value;
    }

    [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }

    /// Removes all keys and keeps the memory. Cost: O(capacity), nothing when there are none.
    void clear() noexcept {
        keys_.clear();
        values_.clear();
    }

    /// Makes room for `count` keys, so that no insertion allocates until there are more.
    void reserve(std::size_t count) {
        keys_.reserve(count);
        values_.reserve(count);
    }

    /// Calls visit(key, value) for every key. Cost: O(size).
    template <class Visit>
    void forEach(Visit&& visit) const {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            visit(keys_.keys()[i], values_[i]);
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return keys_.memoryBytes() + values_.capacity() * sizeof(std::uint32_t);
    }

    /// As FlatSet::validate(), and:
    /// - There is a value for every key.
    [[nodiscard]] std::string validate() const {
        return values_.size() == keys_.size() ? keys_.validate()
                                              : "There is a value for every key: broken.";
    }

private:
    FlatSet keys_;
    std::vector<std::uint32_t> values_;  // by the key's number
};

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

    /// Gives the key a value and returns the last one. Cost: O(1), amortised.
    std::uint32_t exchange(std::uint64_t key, std::uint32_t value) {
        const std::uint32_t number = blocks_.findOrInsert(key / kBlockSize);
        if (number == values_.size()) {
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
