// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that stand still in Bullet's default broadphase, and rays cast at a broadphase of Bullet's.

#include <demos/compare/filled_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

namespace hashphase::demos {

[[nodiscard]] inline btDbvtBroadphase& dbvtOf(const FilledBroadphase& filled) {
    return dynamic_cast<btDbvtBroadphase&>(filled.broadphase());
}

/// Objects are the boxes' numbers; its trees are as good as Bullet can make them. Static geometry pairs
/// with nothing, and pairs are not asked for.
[[nodiscard]] inline std::shared_ptr<FilledBroadphase> filedInDbvt(
    std::span<const Aabb<float>> boxes) {
    const auto filled = std::make_shared<FilledBroadphase>(
        broadphaseKind("dbvt"), BroadphaseNeeds{Aabb<float>(), boxes.size()});
    std::vector<BulletBox> converted;
    toBulletBoxes(boxes, converted);
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        filled->create(i, converted[i], kStaticFilter);
    }
    dbvtOf(*filled).optimize();
    return filled;
}

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
