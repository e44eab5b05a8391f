// SPDX-License-Identifier: Zlib
#pragma once

// A hash table of 64-bit keys in flat arrays. It numbers its keys 0, 1, 2 ... without gaps, so that
// callers keep what belongs to a key in arrays of their own. The slots of the table hold a number
// and a part of the hash, eight bytes, and are probed linearly, at most 5/8 of them in use. An
// erased slot leaves no tombstone, those behind it move up: the table is as good after a million
// frames as after the first.
//
// Memory    Grows by doubling and never shrinks: a steady population allocates nothing.
// Order     A function of the calls so far, and nothing that means anything.
// Threads   Everything const may run anywhere, the rest needs the container for itself.
// Keys      Every key is valid.

#include <broadphase/detail/prefetch.hpp>
#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
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

    /// Fetches into the processor's cache where a search for the key begins.
    void prefetch(std::uint64_t key) const noexcept {
        if (!keys_.empty()) {
            detail::prefetch(&slots_[home(hash(key))]);
        }
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

}  // namespace hashphase::detail
