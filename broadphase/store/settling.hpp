// SPDX-License-Identifier: Zlib
#pragma once

// What is known of proxies that stay near where they are: by it they settle, filed by boxes that are larger
// than their own, within which they move and stay filed.

#include <broadphase/geometry/padded_box.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::detail {

/// One update in 4 looks how mobile proxies move, and stands for the others; where it is in vain, one in 8, 16, and
/// at last in 64. Binary logarithms.
inline constexpr std::uint8_t kOftenObserved = 2;
inline constexpr std::uint8_t kSeldomObserved = 6;

/// How a proxy trembles. By it the slack is chosen with which it is filed when it settles.
template <class Scalar>
struct Tremor {
    Scalar reach = 0;              // about the longest move of a coordinate in the last updates [m]
    std::uint16_t calmCount = 0;   // updates in which it was calm, one after another
    std::uint8_t slackFactor = 6;  // slack by reach
    std::uint8_t patience = 1;     // how many times as long it has to be calm before it settles
};

/// Made when the first proxy is calm.
template <class Scalar>
struct Settling {
    std::vector<Tremor<Scalar>> tremors;  // by index, of those that were there at the last update

    std::size_t slackCount = 0;  // of those that had slack when they were filed

    // Of the update under way.
    std::uint32_t calmCount = 0;                // of those that may settle with slack
    std::vector<std::uint32_t> changedEntries;  // of the resting table, unless they are many
    bool areManyChanged = false;
    std::uint32_t stayedCount = 0;  // Table::order() of what rested before, below this

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(Settling& to, const Settling& from, const Visit& visit) {
        visit(to.tremors, from.tremors);
        visit(to.slackCount, from.slackCount);
        visit(to.calmCount, from.calmCount);
        visit(to.changedEntries, from.changedEntries);
        visit(to.areManyChanged, from.areManyChanged);
        visit(to.stayedCount, from.stayedCount);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + tremors.capacity() * sizeof(tremors[0]) +
               changedEntries.capacity() * sizeof(changedEntries[0]);
    }
};

}  // namespace hashphase::detail
