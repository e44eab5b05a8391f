// SPDX-License-Identifier: Zlib
#pragma once

// Names for objects that mean the same on every rank, as a ProxyId means something in one grid alone.

#include <broadphase/export.hpp>

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace hashphase {

/// Names one object on all ranks. The program chooses the number: two objects that exist at the same time
/// have different ones.
struct GlobalId {
    std::uint64_t value = 0;

    friend constexpr auto operator<=>(const GlobalId&, const GlobalId&) = default;
};

/// Two objects that make a pair, first < second. Ordered by first, then by second.
struct GlobalPair {
    GlobalId first;
    GlobalId second;

    friend constexpr auto operator<=>(const GlobalPair&, const GlobalPair&) = default;
};

/// Returns the pair of the two, given in any order.
[[nodiscard]] constexpr GlobalPair globalPair(GlobalId a, GlobalId b) noexcept {
    return a < b ? GlobalPair{a, b} : GlobalPair{b, a};
}

namespace detail {

/// As many bits, all of which depend on all. SplitMix64, after G. Steele, D. Lea and C. Flood, "Fast splittable
/// pseudorandom number generators", 2014.
[[nodiscard]] constexpr std::uint64_t mixedBits(std::uint64_t x) noexcept {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

}  // namespace detail

/// The pairs of one rank, or of all, as two numbers that do not depend on the order of the pairs: two sets of
/// pairs that differ have, but for one chance in 2^64, different sums. Sums of ranks are added by +=.
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

/// For keys of std::unordered_map.
template <>
struct std::hash<hashphase::GlobalId> {
    [[nodiscard]] std::size_t operator()(const hashphase::GlobalId& id) const noexcept {
        return std::hash<std::uint64_t>{}(id.value);
    }
};
