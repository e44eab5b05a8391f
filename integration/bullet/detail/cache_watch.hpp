// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/precision.hpp>

#include <cstddef>
#include <memory>
#include <vector>

namespace hashphase {
inline namespace HASHPHASE_BULLET_NAMESPACE {
class SpatialHashBroadphase;
}

namespace detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Who is told by a pair cache of pairs that others take out of it, and of its end.
struct CacheWatcher {
    virtual void note(const btBroadphasePair& pair) noexcept = 0;

    /// Forgets what was taken out.
    virtual void forget() noexcept = 0;

    virtual void endCache() noexcept = 0;

    /// Whether it may know of two that are no pair whatever their groups and the filter say, and whether these
    /// are such two.
    [[nodiscard]] virtual bool mayRefuse() const noexcept = 0;
    [[nodiscard]] virtual bool refuses(const btBroadphaseProxy& a,
                                       const btBroadphaseProxy& b) const noexcept = 0;

protected:
    ~CacheWatcher() = default;
};

/// What a broadphase knows of its pair cache: whether it is still there, and which pairs others have taken
/// out of it. The cache writes here; either may end first.
struct CacheWatch final : CacheWatcher {
    explicit CacheWatch(const SpatialHashBroadphase& itsOwner) noexcept : owner(itsOwner) {}
    ~CacheWatch();
    CacheWatch(const CacheWatch&) = delete;
    CacheWatch& operator=(const CacheWatch&) = delete;

    /// Watches the cache, in place of any other watch of it.
    void begin(PairCache& watched) noexcept;

    void note(const btBroadphasePair& pair) noexcept override;
    void forget() noexcept override;
    void endCache() noexcept override;
    [[nodiscard]] bool mayRefuse() const noexcept override;
    [[nodiscard]] bool refuses(const btBroadphaseProxy& a,
                               const btBroadphaseProxy& b) const noexcept override;

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
        return takenOut == nullptr ? 0
                                   : sizeof(std::vector<BulletProxyPair>) +
                                         takenOut->capacity() * sizeof(BulletProxyPair);
    }

    void pruneTakenOut() noexcept;

    const SpatialHashBroadphase& owner;
    PairCache* cache = nullptr;  // null when there is none, or it has ended
    std::unique_ptr<std::vector<BulletProxyPair>> takenOut;  // null for none
    bool isMoreTakenOut = false;  // than is noted, as there was no memory
};

}  // namespace detail::inline HASHPHASE_BULLET_NAMESPACE
}  // namespace hashphase
