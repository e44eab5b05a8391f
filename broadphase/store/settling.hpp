// SPDX-License-Identifier: Zlib
#pragma once

// What is known of proxies that stay near where they are: by it they settle, filed by boxes that are larger
// than their own, within which they move and stay filed.

#include <broadphase/geometry/padded_box.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::detail {

/// How a proxy trembles. By it the slack is chosen with which it is filed when it settles.
template <class Scalar>
struct Tremor {
    Scalar reach = 0;              // about the longest move of a coordinate in the last updates [m]
    std::uint16_t calmCount = 0;   // updates in which it was calm, one after another
    std::uint8_t slackFactor = 2;  // slack by reach
    std::uint8_t patience = 1;     // how many times as long it has to be calm before it settles
};

/// Made when the first proxy is calm.
template <class Scalar>
struct Settling {
    std::vector<Tremor<Scalar>> tremors;  // by index, of those that were there at the last update

    // Of the update under way.
    std::vector<std::uint32_t> changedEntries;  // of the resting table, unless they are many
    bool areManyChanged = false;
    std::uint32_t stayedCount = 0;         // Table::order() of what rested before, below this
    std::vector<PaddedBox<Scalar>> grown;  // scratch: by which the resting ones are filed

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + tremors.capacity() * sizeof(tremors[0]) +
               changedEntries.capacity() * sizeof(changedEntries[0]) +
               grown.capacity() * sizeof(grown[0]);
    }
};

}  // namespace hashphase::detail
