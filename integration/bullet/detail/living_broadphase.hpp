// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/bullet/precision.hpp>

class btBroadphaseInterface;

namespace hashphase {
inline namespace HASHPHASE_BULLET_NAMESPACE {
class SpatialHashBroadphase;
}

namespace detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Lists the SpatialHashBroadphase that derives from it while it lives, so that one can be told from others
/// without RTTI.
class LivingBroadphase {
public:
    LivingBroadphase() noexcept;
    ~LivingBroadphase();
    LivingBroadphase(const LivingBroadphase&) = delete;
    LivingBroadphase& operator=(const LivingBroadphase&) = delete;

    /// The broadphase as a SpatialHashBroadphase; null when it is another one. Any thread may call it. Cost: a
    /// look at each of the program's, under a lock.
    [[nodiscard]] static SpatialHashBroadphase* find(
        const btBroadphaseInterface* broadphase) noexcept;

protected:
    /// For one that no world of Bullet's has for its own: find() does not look at it. Twice does no harm.
    void unlist() noexcept;

private:
    LivingBroadphase* next_ = nullptr;
};

}  // namespace detail::inline HASHPHASE_BULLET_NAMESPACE
}  // namespace hashphase
