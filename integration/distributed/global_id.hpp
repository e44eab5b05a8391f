// SPDX-License-Identifier: Zlib
#pragma once

// Object ids that are valid on all ranks (processes). A ProxyId is valid only in one grid.

#include <broadphase/export.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace hashphase {

/// The id of one object on all ranks. Objects that exist at the same time must have different values.
struct GlobalId {
    std::uint64_t value = 0;

    friend constexpr auto operator<=>(const GlobalId&, const GlobalId&) = default;
};

/// The two objects of a pair, first < second. Pairs are ordered by first, then by second.
struct GlobalPair {
    GlobalId first;
    GlobalId second;

    friend constexpr auto operator<=>(const GlobalPair&, const GlobalPair&) = default;
};

/// Returns the pair of two objects, passed in any order.
[[nodiscard]] constexpr GlobalPair globalPair(GlobalId a, GlobalId b) noexcept {
    return a < b ? GlobalPair{a, b} : GlobalPair{b, a};
}

namespace detail {

/// Returns a hash of x. SplitMix64, after G. Steele, D. Lea and C. Flood, "Fast splittable pseudorandom number
/// generators", 2014.
[[nodiscard]] constexpr std::uint64_t mixedBits(std::uint64_t x) noexcept {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

}  // namespace detail

/// A checksum of a set of pairs: a count and a hash, independent of the order of pairs. Two different sets have equal
/// sums only with a probability of 2^-64. Add the sums of ranks with +=.
struct PairSum {
    std::uint64_t count = 0;
    std::uint64_t hash = 0;

    /// Adds one pair. Cost: O(1).
    constexpr void add(const GlobalPair& pair) noexcept {
        ++count;
        hash += detail::mixedBits(detail::mixedBits(pair.first.value) + pair.second.value);
    }
    constexpr PairSum& operator+=(const PairSum& other) noexcept {
        count += other.count;
        hash += other.hash;
        return *this;
    }
    friend constexpr bool operator==(const PairSum&, const PairSum&) = default;
};

}  // namespace hashphase

/// Allows GlobalId as key of std::unordered_map.
template <>
struct std::hash<hashphase::GlobalId> {
    [[nodiscard]] std::size_t operator()(const hashphase::GlobalId& id) const noexcept {
        return std::hash<std::uint64_t>{}(id.value);
    }
};
