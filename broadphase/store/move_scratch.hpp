// SPDX-License-Identifier: Zlib
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::detail {

/// What MoveBatch needs, kept from one batch to the next.
struct MoveScratch {
    static constexpr std::size_t kGrain = 1024;  // moves of a part

    struct Part {
        std::uint32_t changed = 0;         // proxies that had not changed since the last update
        std::uint32_t settledChanged = 0;  // moves of settled proxies
        std::uint32_t entryCount = 0;      // in `entries`, from the part's first place on
        bool areAllListed = true;          // no entry is to be moved in its turn
    };
    std::vector<Part> parts;
    // Proxies to be listed among what changed, and places of moves that are left for their turn.
    std::vector<std::uint32_t> entries;
    std::vector<std::atomic<std::uint32_t>>
        namedBy;  // by proxyIndex: one that names it in the batch
    // For a caller who has to look at the proxies first: their indices, and who has to wait for others.
    std::vector<std::uint32_t> indices;
    std::vector<char> isAlone;
    std::vector<int> ids;  // by which it tells them again after it has called back

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + parts.capacity() * sizeof(Part) +
               (entries.capacity() + indices.capacity() + ids.capacity()) * sizeof(std::uint32_t) +
               isAlone.capacity() + namedBy.capacity() * sizeof(namedBy[0]);
    }
};

}  // namespace hashphase::detail
