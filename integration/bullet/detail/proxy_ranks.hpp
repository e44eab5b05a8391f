// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/flat_set.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Tells which proxies are among some, and at what place, by their unique ids. Made to be asked
/// about many that are not: a few bits answer most of the time. Keeps its memory.
class ProxyRanks {
public:
    static constexpr std::uint32_t kNone = FlatSet::kNone;

    void assign(std::span<btBroadphaseProxy* const> proxies) {
        constexpr std::size_t kBitsPerProxy = 16;
        bits_.assign(std::bit_ceil(proxies.size() * kBitsPerProxy / 64 + 1), 0);
        ids_.clear();
        ids_.reserve(proxies.size());
        for (const btBroadphaseProxy* proxy : proxies) {
            const auto id = static_cast<std::uint32_t>(proxy->m_uniqueId);
            bits_[wordOf(id)] |= bitOf(id);
            ids_.findOrInsert(id);
        }
    }

    /// The lower rank of the two, where one of them has none the other's; kNone when neither has.
    [[nodiscard]] std::uint32_t lowestRank(std::uint32_t idA, std::uint32_t idB) const noexcept {
        const bool isLikely =
            ((bits_[wordOf(idA)] & bitOf(idA)) | (bits_[wordOf(idB)] & bitOf(idB))) != 0;
        return isLikely ? std::min(ids_.find(idA), ids_.find(idB)) : kNone;
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return ids_.memoryBytes() + bits_.capacity() * sizeof(bits_[0]);
    }

private:
    [[nodiscard]] std::size_t wordOf(std::uint32_t id) const noexcept {
        return id / 64 & (bits_.size() - 1);
    }
    static std::uint64_t bitOf(std::uint32_t id) noexcept { return std::uint64_t{1} << id % 64; }

    std::vector<std::uint64_t> bits_{0};  // a power of two of words
    FlatSet ids_;                         // numbered by rank
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE

#include <broadphase/core/restore_macros.hpp>
