// SPDX-License-Identifier: Zlib
#pragma once

#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// The contact manifolds that an algorithm owns. Of the usual few, the list takes no memory.
class OwnedManifolds {
public:
    explicit OwnedManifolds(btCollisionAlgorithm& algorithm) {
        list_.initializeFromBuffer(usual_, 0, kUsual);
        algorithm.getAllContactManifolds(list_);
    }
    OwnedManifolds(const OwnedManifolds&) = delete;
    OwnedManifolds& operator=(const OwnedManifolds&) = delete;

    [[nodiscard]] const btManifoldArray& list() const noexcept { return list_; }

private:
    static constexpr int kUsual = 4;

    btPersistentManifold* usual_[kUsual];
    btManifoldArray list_;
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
