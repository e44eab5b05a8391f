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
    proxies_.resize(count);
    mins_.resize(count);
    maxs_.resize(count);
    broadphase->config().parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            compute(world, static_cast<int>(i));
        }
    });
    dropSkipped(world);
    broadphase->setAabbs(proxies_, mins_, maxs_, world.getDispatcher());
    return true;
}

// As btCollisionWorld::updateSingleAabb(), up to where it sets the box.
void WorldAabbs::compute(btCollisionWorld& world, int number) {
    const btCollisionObject& object = *world.getCollisionObjectArray()[number];
    const auto i = static_cast<std::size_t>(number);
    proxies_[i] = nullptr;
    if (!isToBeSet(world, object)) {
        return;
    }
    marginBox(object, object.getWorldTransform(), mins_[i], maxs_[i]);
    if (world.getDispatchInfo().m_useContinuous &&
        object.getInternalType() == btCollisionObject::CO_RIGID_BODY &&
        !object.isStaticOrKinematicObject()) {
        btVector3 min;
        btVector3 max;
        marginBox(object, object.getInterpolationWorldTransform(), min, max);
        mins_[i].setMin(min);
        maxs_[i].setMax(max);
    }
    constexpr auto kTooLargeSquared = btScalar(1e12);
    if (object.isStaticObject() || (maxs_[i] - mins_[i]).length2() < kTooLargeSquared) {
        proxies_[i] = const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle());
    }
}

// What is too large is left to Bullet, which takes it out of the simulation and warns of it.
void WorldAabbs::dropSkipped(btCollisionWorld& world) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        btCollisionObject* const object = world.getCollisionObjectArray()[static_cast<int>(i)];
        if (proxies_[i] != nullptr && kept == i) {
            ++kept;
        } else if (proxies_[i] != nullptr) {
            proxies_[kept] = proxies_[i];
            mins_[kept] = mins_[i];
            maxs_[kept] = maxs_[i];
            ++kept;
        } else if (isToBeSet(world, *object)) {
            world.updateSingleAabb(object);
        }
    }
    proxies_.resize(kept);
    mins_.resize(kept);
    maxs_.resize(kept);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
