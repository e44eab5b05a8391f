// SPDX-License-Identifier: Zlib
#pragma once

// A hash table of 64-bit keys in flat arrays. It numbers its keys 0, 1, 2 ... without gaps, so that
// callers keep what belongs to a key in arrays of their own. The table is made of groups of twelve
// numbers, each a cache line: a byte of every number's hash is compared at once, and what does not
// fit into its group goes into the next one that has room. A group counts who has passed it by, so
// that most searches end where they begin, and erasing leaves nothing behind: the table is as good
// after a million frames as after the first. After Bronson and Shi, "Open-sourcing F14 for faster,
// more memory-efficient hash tables", 2019.
//
// Memory    Grows by doubling and shrinks by shrink() alone: a steady population allocates nothing. The table
//           takes 7 to 14 bytes a key, the keys themselves eight.
// Order     A function of the calls so far, and nothing that means anything.
// Threads   Everything const may run anywhere, the rest needs the container for itself.
// Keys      Every key is valid. At most 2^32 - 1 of them: whoever inserts or reserves more is thrown
//           std::length_error, and the set is as it was.

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/core/parted_blocks.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/tag_kernel.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

class FlatSet {
public:
    /// Not the number of any key.
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    /// The key's number, or kNone. Cost: O(1).
    [[nodiscard]] std::uint32_t find(std::uint64_t key) const noexcept {
        const Place place = placeOf(key, hash(key));
        // cppcheck-suppress nullPointerRedundantCheck
        return place.isNone() ? kNone : groups_[place.group].numbers[place.lane];
    }

    /// Cost: O(1); next to nothing while the set is empty.
    [[nodiscard]] bool contains(std::uint64_t key) const noexcept {
        return !keys_.empty() && find(key) != kNone;
    }

    /// Fetches into the processor's cache where a search for the key begins.
    void prefetch(std::uint64_t key) const noexcept {
        if (!groups_.empty()) {
            detail::prefetch(&groups_[home(hash(key))]);
        }
    }

    /// Fetches what comes next in the search, once that is there, and returns the number that the
    /// key has in most cases where it has one: for callers who have something to fetch themselves.
    [[nodiscard]] std::uint32_t prefetchKey(std::uint64_t key) const noexcept {
        if (groups_.empty()) {
            return 0;
        }
        const std::uint32_t keyHash = hash(key);
        const Group& group = groups_[home(keyHash)];
        constexpr std::uint32_t kLastLane = 1U << (kLanes - 1);
        const std::uint32_t number =
            group.numbers[lowest(group.withTag(tagOf(keyHash)) | kLastLane)];
        detail::prefetch(keys_.data() + number);
        return number;
    }

    /// The key's number. A key that was not there gets the next one, size() before the call.
    /// Where memory runs out, nothing has changed. Cost: O(1), amortised.
    std::uint32_t findOrInsert(std::uint64_t key) {
        return insert(key, static_cast<std::uint32_t>(keys_.size()));
    }

    /// Removes the key, gives its number to the last key, and returns it; kNone when the key was
    /// not there. Cost: O(1); next to nothing while the set is empty.
    std::uint32_t erase(std::uint64_t key) noexcept {
        return keys_.empty() ? kNone : eraseIfThere(key);
    }

    // --- Many at once ----------------------------------------------------------------------------
    //
    // Keys may leave their numbers vacant for others to take, while nothing else is done with the
    // set: then nobody else's number changes.

    /// Removes the key and returns its number, which is to be taken by insert() or fill(); kNone
    /// when the key was not there. Cost: O(1).
    std::uint32_t vacate(std::uint64_t key) noexcept {
        const std::uint32_t keyHash = hash(key);
        return vacate(placeOf(key, keyHash), keyHash);
    }

    /// The key's number. A key that was not there gets `number`, which is vacant, or size().
    /// Cost: O(1), amortised.
    std::uint32_t insert(std::uint64_t key, std::uint32_t number) {
        if (keys_.size() >= sizeLimit_) {
            checkSize(keys_.size() + 1);
            rehash(groups_.empty() ? 1 : 2 * groups_.size());
        }
        const std::uint32_t keyHash = hash(key);
        const Place place = placeOf(key, keyHash);
        if (!place.isNone()) {
            return groups_[place.group].numbers[place.lane];
        }
        enter(groupWithRoom(keyHash), keyHash, number);
        if (number == keys_.size()) {
            keys_.push_back(key);
        } else {
            keys_[number] = key;
        }
        return number;
    }

    /// Adds so many numbers behind the others, vacant. Takes no memory after reserve() of more than there
    /// are then.
    void addVacant(std::size_t count) { keys_.resize(keys_.size() + count); }

    /// Gives a vacant number to the last key, or drops it when it is the last itself.
    void fill(std::uint32_t number) noexcept {
        const auto last = static_cast<std::uint32_t>(keys_.size()) - 1;
        if (number != last) {
            const Place moved = placeOf(keys_[last], hash(keys_[last]));
            groups_[moved.group].numbers[moved.lane] = number;
            keys_[number] = keys_[last];
        }
        keys_.pop_back();
    }

    // Threads may vacate and insert at the same time, each of them keys of one part: see KeyParts. A search that
    // leaves the part is not made, and nullopt returned.

    static constexpr std::uint32_t kParts = PartedBlocks::kParts;

    /// The part of the table where the search for the key begins.
    [[nodiscard]] static std::uint32_t partOf(std::uint64_t key) noexcept {
        return hash(key) >> kPartShift;
    }
    [[nodiscard]] bool isInParts() const noexcept { return groups_.size() >= kParts; }

    std::optional<std::uint32_t> vacateInPart(std::uint64_t key) noexcept {
        const std::uint32_t keyHash = hash(key);
        const Place place = placeOf(key, keyHash, endOfPart(keyHash));
        return place.isBeyond() ? std::nullopt : std::optional(vacate(place, keyHash));
    }

    /// The number is vacant, and below size().
    std::optional<std::uint32_t> insertInPart(std::uint64_t key, std::uint32_t number) noexcept {
        const std::uint32_t keyHash = hash(key);
        const std::size_t end = endOfPart(keyHash);
        const Place place = placeOf(key, keyHash, end);
        if (!place.isNone() && !place.isBeyond()) {
            return groups_[place.group].numbers[place.lane];
        }
        const std::size_t group = place.isBeyond() ? end : groupWithRoom(keyHash, end);
        if (group == end) {
            return std::nullopt;
        }
        enter(group, keyHash, number);
        keys_[number] = key;
        return number;
    }

    // --- All keys --------------------------------------------------------------------------------

    /// By number; valid until the next insertion or erasure.
    [[nodiscard]] std::span<const std::uint64_t> keys() const noexcept { return keys_; }
    [[nodiscard]] std::size_t size() const noexcept { return keys_.size(); }

    /// Removes all keys and keeps the memory. Cost: O(capacity), nothing when there are none.
    void clear() noexcept {
        if (!keys_.empty()) {
            keys_.clear();
            std::fill(groups_.begin(), groups_.end(), Group{});
        }
    }

    /// Makes room for `count` keys, so that no insertion allocates until there are more.
    void reserve(std::size_t count) {
        checkSize(count);
        const std::size_t needed = count / kFullGroup + (count % kFullGroup == 0 ? 0 : 1);
        const std::size_t groupCount =
            std::bit_ceil(std::max<std::size_t>({1, groups_.size(), needed}));
        if (groupCount != groups_.size()) {
            rehash(groupCount);
        }
    }

    [[nodiscard]] std::size_t capacity() const noexcept { return sizeLimit_; }

    /// Gives back room for more keys than there are. Where memory runs out, nothing has changed.
    void shrink() {
        if (keys_.empty()) {
            *this = FlatSet();
            return;
        }
        std::size_t groupCount = groups_.size();
        while (groupCount > 1 && groupCount / 2 * kFullGroup >= keys_.size()) {
            groupCount /= 2;
        }
        if (groupCount != groups_.size()) {
            std::vector<std::uint64_t> keys;
            keys.reserve(groupCount * kFullGroup);
            keys.assign(keys_.begin(), keys_.end());
            rehash(groupCount);
            keys_.swap(keys);
        }
    }

    /// Gives the key with number i the number newNumbers[i], a permutation, which is used up.
    /// Calls swapNumbers(i, j) for every exchange on the way there, so that the caller's arrays can
    /// follow. Cost: O(capacity).
    template <class Swap>
    void renumber(std::span<std::uint32_t> newNumbers, Swap&& swapNumbers) {
        HASHPHASE_ASSERT(newNumbers.size() == keys_.size(), "There is a new number for every key.");
        for (Group& group : groups_) {
            for (std::uint32_t lanes = group.used(); lanes != 0; lanes &= lanes - 1) {
                std::uint32_t& number = group.numbers[lowest(lanes)];
                number = newNumbers[number];
            }
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
        return groups_.capacity() * sizeof(Group) + keys_.capacity() * sizeof(std::uint64_t);
    }

    /// How many groups the dearest find() of a present key looks at; 0 when empty.
    /// Cost: O(capacity).
    [[nodiscard]] std::size_t longestProbe() const noexcept {
        std::size_t longest = 0;
        for (const std::uint64_t key : keys_) {
            const std::uint32_t keyHash = hash(key);
            const std::size_t steps = placeOf(key, keyHash).group - home(keyHash);
            longest = std::max(longest, (steps & (groups_.size() - 1)) + 1);
        }
        return longest;
    }

    /// Says which invariant is broken, in a sentence; empty when all hold (while no number is
    /// vacant):
    /// - Every key is found under its number.
    /// - There are as many numbers in the table as keys.
    /// - A group counts the keys that have passed it by.
    [[nodiscard]] std::string validate() const {
        std::vector<std::uint32_t> passedBy(groups_.size(), 0);
        for (std::uint32_t i = 0; i < keys_.size(); ++i) {
            if (find(keys_[i]) != i) {
                return "Every key is found under its number: broken.";
            }
            const std::uint32_t keyHash = hash(keys_[i]);
            const std::size_t end = placeOf(keys_[i], keyHash).group;
            for (std::size_t g = home(keyHash); g != end; g = next(g)) {
                ++passedBy[g];
            }
        }
        int used = 0;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            used += std::popcount(groups_[g].used());
            if (groups_[g].passedBy != passedBy[g]) {
                return "A group counts the keys that have passed it by: broken.";
            }
        }
        return static_cast<std::size_t>(used) == keys_.size()
                   ? ""
                   : "There are as many numbers in the table as keys: broken.";
    }

    /// See core/copy_parts.hpp.
    void makeRoomFor(const FlatSet& from) {
        ensureCapacity(groups_, from.groups_.size());
        ensureCapacity(keys_, from.sizeLimit_);
    }

private:
    std::uint32_t eraseIfThere(std::uint64_t key) noexcept {
        const std::uint32_t number = vacate(key);
        if (number != kNone) {
            fill(number);
        }
        return number;
    }

    static constexpr unsigned kPartShift = 32 - std::countr_zero(kParts);
    static constexpr std::size_t kNoEnd = std::numeric_limits<std::size_t>::max();

    static constexpr std::uint32_t kLanes = 12;
    static constexpr std::size_t kFullGroup = 9;  // on average, before the table grows

    struct alignas(64) Group {
        std::array<unsigned char, kLanes> tags{};  // a byte of the hash, 0 where there is no number
        std::uint32_t passedBy = 0;  // how many keys of this or earlier groups went to later ones
        std::array<std::uint32_t, kLanes> numbers{};

        [[nodiscard]] std::uint32_t withTag(unsigned char tag) const noexcept {
            // Four bytes more than there are tags are compared, and not looked at.
            return tagMask(reinterpret_cast<const unsigned char*>(this), tag) & kAllLanes;
        }
        [[nodiscard]] std::uint32_t used() const noexcept { return ~withTag(0) & kAllLanes; }
    };
    static constexpr std::uint32_t kAllLanes = (1U << kLanes) - 1;

    struct Place {
        std::size_t group = 0;
        std::uint32_t lane = kLanes;

        [[nodiscard]] bool isNone() const noexcept { return lane == kLanes; }
        [[nodiscard]] bool isBeyond() const noexcept { return lane == kLanes + 1; }
    };

    // kNone is no key's number.
    static void checkSize(std::size_t count) {
        checkCount(count, kNone, "A set holds at most 4,294,967,295 pairs or ids. Use fewer.");
    }

    static std::uint32_t lowest(std::uint32_t lanes) noexcept {
        return static_cast<std::uint32_t>(std::countr_zero(lanes));
    }

    // Keys are regular: two small numbers side by side, multiples, runs. One multiplication alone
    // sends some strides into few groups; two do not.
    static std::uint32_t hash(std::uint64_t key) noexcept {
        key *= 0x9e3779b97f4a7c15U;
        key ^= key >> 32;
        key *= 0xbf58476d1ce4e5b9U;
        return static_cast<std::uint32_t>(key >> 32);
    }

    static unsigned char tagOf(std::uint32_t keyHash) noexcept {
        const auto tag = static_cast<unsigned char>(keyHash);
        return tag == 0 ? 1 : tag;
    }

    [[nodiscard]] std::size_t home(std::uint32_t keyHash) const noexcept {
        // One group: by 32, which an std::size_t may not have.
        return static_cast<std::uint32_t>(std::uint64_t{keyHash} >> shift_);
    }
    [[nodiscard]] std::size_t next(std::size_t group) const noexcept {
        return (group + 1) & (groups_.size() - 1);
    }

    // The group behind those of the part.
    [[nodiscard]] std::size_t endOfPart(std::uint32_t keyHash) const noexcept {
        constexpr std::uint32_t kLastOfPart = (std::uint32_t{1} << kPartShift) - 1;
        return next(home(keyHash | kLastOfPart));
    }

    // Where the key's number is; beyond, where it is looked for as far as `end`.
    [[nodiscard]] Place placeOf(std::uint64_t key, std::uint32_t keyHash,
                                std::size_t end = kNoEnd) const noexcept {
        if (groups_.empty()) {
            return {};
        }
        for (std::size_t g = home(keyHash);;) {
            const Group& group = groups_[g];
            for (std::uint32_t lanes = group.withTag(tagOf(keyHash)); lanes != 0;
                 lanes &= lanes - 1) {
                const std::uint32_t lane = lowest(lanes);
                if (keys_[group.numbers[lane]] == key) {
                    return {g, lane};
                }
            }
            if (group.passedBy == 0) {
                return {};
            }
            g = next(g);
            if (g == end) {
                return {g, kLanes + 1};
            }
        }
    }

    // The first one, or `end`. There always is one.
    [[nodiscard]] std::size_t groupWithRoom(std::uint32_t keyHash,
                                            std::size_t end = kNoEnd) const noexcept {
        std::size_t g = home(keyHash);
        while (groups_[g].used() == kAllLanes) {
            g = next(g);
            if (g == end) {
                break;
            }
        }
        return g;
    }

    void enter(std::size_t group, std::uint32_t keyHash, std::uint32_t number) noexcept {
        for (std::size_t g = home(keyHash); g != group; g = next(g)) {
            ++groups_[g].passedBy;
        }
        const std::uint32_t lane = lowest(groups_[group].withTag(0));
        groups_[group].tags[lane] = tagOf(keyHash);
        groups_[group].numbers[lane] = number;
    }

    std::uint32_t vacate(const Place& place, std::uint32_t keyHash) noexcept {
        if (place.isNone()) {
            return kNone;
        }
        for (std::size_t g = home(keyHash); g != place.group; g = next(g)) {
            --groups_[g].passedBy;
        }
        groups_[place.group].tags[place.lane] = 0;
        return groups_[place.group].numbers[place.lane];
    }

    // Allocates first, for the keys as well: where that fails, nothing has changed.
    void rehash(std::size_t groupCount) {
        const std::size_t limit = std::min<std::size_t>(groupCount * kFullGroup, kNone);
        std::vector<Group> fresh(groupCount);
        keys_.reserve(limit);
        const std::vector<Group> old = std::exchange(groups_, std::move(fresh));
        sizeLimit_ = limit;
        shift_ = 32 - static_cast<unsigned>(std::countr_zero(groupCount));
        for (const Group& group : old) {
            for (std::uint32_t lanes = group.used(); lanes != 0; lanes &= lanes - 1) {
                const std::uint32_t number = group.numbers[lowest(lanes)];
                const std::uint32_t keyHash = hash(keys_[number]);
                enter(groupWithRoom(keyHash), keyHash, number);
            }
        }
    }

    std::vector<Group> groups_;  // none, or a power of two
    std::vector<std::uint64_t> keys_;
    std::size_t sizeLimit_ = 0;
    unsigned shift_ = 32;  // the home of a hash is its upper bits
};

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
