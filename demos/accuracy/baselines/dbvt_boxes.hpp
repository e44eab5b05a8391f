// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that stand still in Bullet's default broadphase, its trees as good as Bullet can make them;
// and rays cast at a broadphase of Bullet's.

#include <demos/scenes/box_scene.hpp>
#include <integration/bullet/conversions.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <cstdint>
#include <span>
#include <vector>

namespace hashphase::demos {

class DbvtBoxes {
public:
    /// Objects are the boxes' numbers. Static geometry pairs with nothing, and pairs are not asked
    /// for.
    explicit DbvtBoxes(std::span<const Aabb<float>> boxes) {
        for (const Aabb<float>& box : boxes) {
            proxies_.push_back(broadphase_.createProxy(
                toBullet(box.min()), toBullet(box.max()), BOX_SHAPE_PROXYTYPE, this,
                kStaticFilter.group, kStaticFilter.mask, nullptr));
        }
        broadphase_.optimize();
    }
    DbvtBoxes(const DbvtBoxes&) = delete;
    DbvtBoxes& operator=(const DbvtBoxes&) = delete;
    ~DbvtBoxes() {
        for (btBroadphaseProxy* proxy : proxies_) {
            broadphase_.destroyProxy(proxy, nullptr);
        }
    }

    [[nodiscard]] btDbvtBroadphase& broadphase() noexcept { return broadphase_; }

    /// Unique ids count up from 1.
    [[nodiscard]] static std::uint32_t objectOf(const btBroadphaseProxy& proxy) {
        return static_cast<std::uint32_t>(proxy.m_uniqueId - 1);
    }

private:
    std::vector<btBroadphaseProxy*> proxies_;
    btDbvtBroadphase broadphase_;
};

/// Calls visit(proxy) of all whose boxes the ray meets, with what btCollisionWorld::rayTest() tells
/// the broadphase beforehand.
template <class Visit>
void castRay(btBroadphaseInterface& broadphase, const btVector3& from, const btVector3& to,
             const Visit& visit) {
    struct Callback final : btBroadphaseRayCallback {
        explicit Callback(const Visit& toCall) : visit(toCall) {}
        bool process(const btBroadphaseProxy* proxy) override {
            visit(*proxy);
            return true;
        }
        const Visit& visit;
    };
    Callback callback(visit);
    const btVector3 direction = (to - from).normalized();
    for (int axis = 0; axis < 3; ++axis) {
        callback.m_rayDirectionInverse[axis] =
            direction[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / direction[axis];
        callback.m_signs[axis] = callback.m_rayDirectionInverse[axis] < 0 ? 1U : 0U;
    }
    callback.m_lambda_max = direction.dot(to - from);
    broadphase.rayTest(from, to, callback);
}

}  // namespace hashphase::demos
