// SPDX-License-Identifier: Zlib
#include <integration/bullet/parallel_aabbs.hpp>

#include <integration/bullet/detail/living_broadphase.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <LinearMath/btQuickprof.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

bool isToBeSet(const btCollisionWorld& world, const btCollisionObject& object) {
    return world.getForceUpdateAllAabbs() || object.isActive();
}

// Where an object's shape is, with Bullet's contact margin.
void marginBox(const btCollisionObject& object, const btTransform& at, btVector3& min,
               btVector3& max) {
    const btVector3 margin(gContactBreakingThreshold, gContactBreakingThreshold,
                           gContactBreakingThreshold);
    object.getCollisionShape()->getAabb(at, min, max);
    min -= margin;
    max += margin;
}

}  // namespace

bool WorldAabbs::update(btCollisionWorld& world) {
    auto* const broadphase = detail::LivingBroadphase::find(world.getBroadphase());
    if (broadphase == nullptr || !broadphase->config().parallelFor) {
        return false;
    }
    BT_PROFILE("updateAabbs");
    constexpr std::size_t kGrain = 256;
    const auto count = static_cast<std::size_t>(world.getNumCollisionObjects());
    Boxes boxes =
        std::move(boxes_);  // lent to this call: its callbacks may bring another one about
    boxes.proxies.resize(count);
    boxes.mins.resize(count);
    boxes.maxs.resize(count);
    broadphase->config().parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            compute(world, static_cast<int>(i), boxes);
        }
    });
    dropSkipped(world, boxes);
    broadphase->setAabbs(boxes.proxies, boxes.mins, boxes.maxs, world.getDispatcher());
    boxes_ = std::move(boxes);
    return true;
}

// As btCollisionWorld::updateSingleAabb(), up to where it sets the box.
void WorldAabbs::compute(btCollisionWorld& world, int number, Boxes& boxes) {
    const btCollisionObject& object = *world.getCollisionObjectArray()[number];
    const auto i = static_cast<std::size_t>(number);
    boxes.proxies[i] = nullptr;
    if (!isToBeSet(world, object)) {
        return;
    }
    marginBox(object, object.getWorldTransform(), boxes.mins[i], boxes.maxs[i]);
    if (world.getDispatchInfo().m_useContinuous &&
        object.getInternalType() == btCollisionObject::CO_RIGID_BODY &&
        !object.isStaticOrKinematicObject()) {
        btVector3 min;
        btVector3 max;
        marginBox(object, object.getInterpolationWorldTransform(), min, max);
        boxes.mins[i].setMin(min);
        boxes.maxs[i].setMax(max);
    }
    constexpr auto kTooLargeSquared = btScalar(1e12);
    if (object.isStaticObject() || (boxes.maxs[i] - boxes.mins[i]).length2() < kTooLargeSquared) {
        boxes.proxies[i] = const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle());
    }
}

// What is too large is left to Bullet, which takes it out of the simulation and warns of it.
void WorldAabbs::dropSkipped(btCollisionWorld& world, Boxes& boxes) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < boxes.proxies.size(); ++i) {
        btCollisionObject* const object = world.getCollisionObjectArray()[static_cast<int>(i)];
        if (boxes.proxies[i] != nullptr && kept == i) {
            ++kept;
        } else if (boxes.proxies[i] != nullptr) {
            boxes.proxies[kept] = boxes.proxies[i];
            boxes.mins[kept] = boxes.mins[i];
            boxes.maxs[kept] = boxes.maxs[i];
            ++kept;
        } else if (isToBeSet(world, *object)) {
            world.updateSingleAabb(object);
        }
    }
    boxes.proxies.resize(kept);
    boxes.mins.resize(kept);
    boxes.maxs.resize(kept);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
