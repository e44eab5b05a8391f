// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that stand still in Bullet's default broadphase, its trees as good as Bullet can make them.

#include <broadphase/aabb.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class DbvtBoxes {
public:
    /// Objects are the boxes' numbers.
    explicit DbvtBoxes(std::span<const Aabb<float>> boxes);
    DbvtBoxes(const DbvtBoxes&) = delete;
    DbvtBoxes& operator=(const DbvtBoxes&) = delete;
    ~DbvtBoxes();

    [[nodiscard]] btDbvtBroadphase& broadphase() noexcept { return broadphase_; }
    [[nodiscard]] static std::uint32_t objectOf(const btBroadphaseProxy& proxy) {
        return *static_cast<const std::uint32_t*>(proxy.m_clientObject);
    }

private:
    std::vector<std::uint32_t> objects_;  // what the proxies' clients point at
    std::vector<btBroadphaseProxy*> proxies_;
    btDbvtBroadphase broadphase_;
};

}  // namespace hashphase::demos
