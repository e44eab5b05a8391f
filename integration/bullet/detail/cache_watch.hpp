// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// What a broadphase knows of its pair cache: whether it is still there, and which pairs others have taken
/// out of it. The cache writes here; either may end first.
struct CacheWatch {
    CacheWatch() = default;
    ~CacheWatch();
    CacheWatch(const CacheWatch&) = delete;
    CacheWatch& operator=(const CacheWatch&) = delete;

    /// Watches the cache, in place of any other watch of it.
    void begin(PairCache& watched) noexcept;

    /// Notes a pair that is taken out.
    void note(const btBroadphasePair& pair) noexcept;

    /// Where nobody asks, those of which a proxy is gone do not gather, nor those that are back.
    void prune() noexcept {
        if (takenOut != nullptr) {
            pruneTakenOut();
        }
    }

    /// Forgets what was taken out.
    void forget() noexcept;

    [[nodiscard]] bool isAnythingTakenOut() const noexcept {
        return isMoreTakenOut || takenOut != nullptr;
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return takenOut == nullptr
                   ? 0
                   : sizeof(*takenOut) + takenOut->capacity() * sizeof(BulletProxyPair);
    }

    void pruneTakenOut() noexcept;

    PairCache* cache = nullptr;  // null when there is none, or it has ended
    std::unique_ptr<std::vector<BulletProxyPair>> takenOut;  // null for none
    bool isMoreTakenOut = false;  // than is noted, as there was no memory
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
