// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Who is told by a pair cache of pairs that others take out of it, and of its end.
struct CacheWatcher {
    virtual void note(const btBroadphasePair& pair) noexcept = 0;

    /// Forgets what was taken out.
    virtual void forget() noexcept = 0;

    virtual void endCache() noexcept = 0;

protected:
    ~CacheWatcher() = default;
};

/// What a broadphase knows of its pair cache: whether it is still there, and which pairs others have taken
/// out of it. The cache writes here; either may end first.
struct CacheWatch final : CacheWatcher {
    CacheWatch() = default;
    ~CacheWatch();
    CacheWatch(const CacheWatch&) = delete;
    CacheWatch& operator=(const CacheWatch&) = delete;

    /// Watches the cache, in place of any other watch of it.
    void begin(PairCache& watched) noexcept;

    void note(const btBroadphasePair& pair) noexcept override;
    void forget() noexcept override;
    void endCache() noexcept override;

    /// Where nobody asks, those of which a proxy is gone do not gather, nor those that are back.
    void prune() noexcept {
        if (takenOut != nullptr) {
            pruneTakenOut();
        }
    }

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
