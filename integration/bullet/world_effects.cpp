// SPDX-License-Identifier: Zlib
#include <integration/bullet/world_effects.hpp>

#include <broadphase/core/query_scope.hpp>
#include <broadphase/diagnostics.hpp>
#include <integration/bullet/detail/living_broadphase.hpp>
#include <integration/bullet/pair_cache.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_cost.hpp>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <optional>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// From the first one on again if a callback of contacts that end has removed some: others are in their places.
template <class Visit>
void forEachObject(btCollisionWorld& world, const Visit& visit) {
    btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size();) {
        const int count = objects.size();
        visit(*objects[i]);
        i = objects.size() < count ? 0 : i + 1;
    }
}

bool isDynamic(const btRigidBody* body) {
    return body != nullptr && !body->isStaticOrKinematicObject();
}

/// What a body may move by in a step, if nothing but forces makes it faster [m].
btScalar longestWay(const btRigidBody& body, btScalar timeStep) {
    const btVector3 acceleration = body.getGravity() + body.getTotalForce() * body.getInvMass();
    return (body.getLinearVelocity().length() + acceleration.length() * timeStep) * timeStep;
}

// Bullet files an object that is added without the margin that it adds in updateSingleAabb(), and does
// not come back to it where boxes are not forced.
void fileResting(btCollisionWorld& world, btCollisionObject& object) {
    if (!object.isActive()) {
        world.updateSingleAabb(&object);
    }
}

// Bullet itself combines them where a point is found anew: those that merely last keep what they had.
void combineMaterials(btPersistentManifold& manifold) {
    const btCollisionObject* const a = manifold.getBody0();
    const btCollisionObject* const b = manifold.getBody1();
    constexpr int ownMaterial = btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK;
    if (((a->getCollisionFlags() | b->getCollisionFlags()) & ownMaterial) != 0) {
        return;
    }
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
        btManifoldPoint& point = manifold.getContactPoint(k);
        point.m_combinedFriction = gCalculateCombinedFrictionCallback(a, b);
        point.m_combinedRollingFriction = gCalculateCombinedRollingFrictionCallback(a, b);
        point.m_combinedSpinningFriction = gCalculateCombinedSpinningFrictionCallback(a, b);
        point.m_combinedRestitution = gCalculateCombinedRestitutionCallback(a, b);
    }
}

}  // namespace

WorldConfigurator::WorldConfigurator(btDiscreteDynamicsWorld& world) : world_(&world) {}

WorldConfigurator::~WorldConfigurator() {
    apply({});
}

void WorldConfigurator::apply(const WorldEffects& effects) {
    HASHPHASE_ASSERT(
        !detail::QueryScope::isWithin(this),
        "WorldConfigurator::apply() was called from within WorldEffects::effectsOf. Call "
        "it after that returns.");
    if (detail::QueryScope::isWithin(this)) {
        return;  // or the function would be destroyed while it runs
    }
    const bool haveMasks = effects.effectsOf || effects_.effectsOf;
    arePairsOld_ = arePairsOld_ || haveMasks || effects.pairs != effects_.pairs;
    WorldEffects copy = effects;  // takes memory
    effects_ = std::move(copy);
    ++applyCount_;
    setFilter();
    configureWorld();
    if (arePairsOld_) {
        areBodiesChanged_ = true;
        askAboutPairsAgain();
        arePairsOld_ = false;
    }
    forEachObject(*world_, [&](btCollisionObject& object) {
        if (!effects_.restingBoxes) {
            fileResting(*world_, object);
        }
        const bool isChanged = configure(object, effectsOf(object), effects_);
        areBodiesChanged_ = areBodiesChanged_ || isChanged;
    });
    for (auto& [object, kept] : kept_) {
        kept.wasAway = kept.wasAway || kept.lastSeen != applyCount_;
    }
    if (areBodiesChanged_) {
        renewContacts();
        wakeAll();
        areBodiesChanged_ = false;
    }
}

void WorldConfigurator::prepare(btCollisionObject& object) {
    HASHPHASE_ASSERT(
        object.getWorldArrayIndex() >= 0,
        "WorldConfigurator::prepare(): the object is not in the world. Add it to the world first.");
    if (!effects_.restingBoxes) {
        fileResting(*world_, object);
    }
    if (configure(object, effectsOf(object), effects_)) {
        object.activate();
    }
}

void WorldConfigurator::release(btCollisionObject& object) {
    configure(object, {}, {});
}

int WorldConfigurator::beforeStep(btScalar timeStep) {
    configureWorld();
    bool& useContinuous = world_->getDispatchInfo().m_useContinuous;
    if (!useContinuous) {
        return 0;
    }
    int sweptCount = 0;
    forEachObject(*world_, [&](const btCollisionObject& object) {
        const btRigidBody* const body = btRigidBody::upcast(&object);
        if (body != nullptr && body->getCcdMotionThreshold() != 0) {
            sweptCount += isSwept(*body, longestWay(*body, timeStep));
        }
    });
    if (effects_.fastFrom && sweptCount == 0) {
        useContinuous = useContinuous_.next(useContinuous, false);
    }
    return sweptCount;
}

void WorldConfigurator::step(btScalar timeStep) {
    if (effects_.motion) {
        if (effects_.fastFrom) {
            beforeStep(timeStep);
        }
        world_->stepSimulation(timeStep, 0);
    } else if (effects_.pairs) {
        world_->performDiscreteCollisionDetection();
    }
}

BodyEffects WorldConfigurator::effectsOf(const btCollisionObject& object) const {
    BodyEffects effects{effects_.pairs,    effects_.response, effects_.sweep,
                        effects_.sleeping, effects_.rotation, effects_.friction};
    if (effects_.effectsOf) {
        const detail::QueryScope scope(this);
        const BodyEffects own = effects_.effectsOf(object);
        effects.pairs = effects.pairs && own.pairs;
        effects.response = effects.response && own.response;
        effects.sweep = effects.sweep && own.sweep;
        effects.sleeping = effects.sleeping && own.sleeping;
        effects.rotation = effects.rotation && own.rotation;
        effects.friction = effects.friction && own.friction;
    }
    effects.response = effects.response && effects.pairs;
    effects.sweep = effects.sweep && effects.response;
    effects.friction = effects.friction && effects.response;
    return effects;
}

bool WorldConfigurator::Filter::needBroadphaseCollision(btBroadphaseProxy* a,
                                                        btBroadphaseProxy* b) const {
    const auto isAccepted = [&](const btBroadphaseProxy& proxy) {
        const auto* const object = static_cast<const btCollisionObject*>(proxy.m_clientObject);
        return object == nullptr || owner_->effectsOf(*object).pairs;
    };
    if (!owner_->effects_.pairs ||
        (owner_->effects_.effectsOf && !(isAccepted(*a) && isAccepted(*b)))) {
        return false;
    }
    if (former != nullptr) {
        return former->needBroadphaseCollision(a, b);
    }
    return PairCache::doGroupsAccept(*a, *b);
}

void WorldConfigurator::setFilter() {
    btOverlappingPairCache& cache = *world_->getPairCache();
    const bool isOurs = cache.getOverlapFilterCallback() == &filter_;
    const bool isNeeded = !effects_.pairs || effects_.effectsOf;
    if (isNeeded && !isOurs) {
        filter_.former = cache.getOverlapFilterCallback();
        cache.setOverlapFilterCallback(&filter_);
    } else if (isOurs && !isNeeded) {
        cache.setOverlapFilterCallback(filter_.former);
    }
}

void WorldConfigurator::askAboutPairsAgain() {
    if (auto* const hash = detail::LivingBroadphase::find(world_->getBroadphase())) {
        hash->refilterAll(world_->getDispatcher());
        return;
    }
    forEachObject(*world_,
                  [&](btCollisionObject& object) { world_->refreshBroadphaseProxy(&object); });
}

void WorldConfigurator::configureWorld() {
    btDispatcherInfo& info = world_->getDispatchInfo();
    const bool isWithoutSweep = !effects_.sweep || !effects_.pairs || !effects_.response;
    std::optional<bool> useContinuous;
    if (isWithoutSweep || effects_.fastFrom) {
        useContinuous = !isWithoutSweep;
    }
    info.m_useContinuous = useContinuous_.next(info.m_useContinuous, useContinuous);
    world_->setForceUpdateAllAabbs(
        forcesBoxes_.next(world_->getForceUpdateAllAabbs(),
                          effects_.restingBoxes ? std::nullopt : std::optional(false)));

    const bool isWithoutFriction = !effects_.friction || !effects_.response || !effects_.pairs;
    int& mode = world_->getSolverInfo().m_solverMode;
    constexpr int second = SOLVER_USE_2_FRICTION_DIRECTIONS;
    mode =
        (mode & ~second) | frictionDirections_.next(
                               mode & second, isWithoutFriction ? std::optional(0) : std::nullopt);
}

void WorldConfigurator::renewContacts() {
    btDispatcher& dispatcher = *world_->getDispatcher();
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
        combineMaterials(*dispatcher.getManifoldByIndexInternal(i));
    }
}

void WorldConfigurator::wakeAll() {
    forEachObject(*world_, [](btCollisionObject& object) {
        if (isDynamic(btRigidBody::upcast(&object))) {
            object.activate();
        }
    });
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
