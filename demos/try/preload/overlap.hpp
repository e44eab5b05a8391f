// SPDX-License-Identifier: Zlib
#pragma once

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

namespace hashphase::tryout {

/// Whether the boxes of two proxies overlap: closed, and never with NaN. It shares no code with the
/// library, whose judge it is.
[[nodiscard]] inline bool overlaps(const btBroadphaseProxy& a,
                                   const btBroadphaseProxy& b) noexcept {
    return a.m_aabbMin.x() <= b.m_aabbMax.x() && b.m_aabbMin.x() <= a.m_aabbMax.x() &&
           a.m_aabbMin.y() <= b.m_aabbMax.y() && b.m_aabbMin.y() <= a.m_aabbMax.y() &&
           a.m_aabbMin.z() <= b.m_aabbMax.z() && b.m_aabbMin.z() <= a.m_aabbMax.z();
}

}  // namespace hashphase::tryout
