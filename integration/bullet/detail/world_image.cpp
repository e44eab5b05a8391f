// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/world_image.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/core/ensure_capacity.hpp>
#include <integration/bullet/detail/bullet_classes.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/joint_image.hpp>
#include <integration/bullet/detail/member_bytes.hpp>

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <algorithm>
#include <cstring>
#include <sstream>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// Fetched while others are copied, or looked at: whole objects, and lines of the cache.
constexpr std::size_t kObjectsAhead = 2;
constexpr std::size_t kLinesAhead = 8;
// Where most algorithms have their manifold [bytes], or just behind: that may be another line.
constexpr std::size_t kManifoldOffset = 32;

// Most objects are bodies.
void prefetchBody(const btCollisionObject& object) {
    prefetchAll(reinterpret_cast<const btRigidBody&>(object));
}

// What is looked at of a pair: its algorithm, and the shapes of its clients.
void prefetchAhead(std::span<const btBroadphasePair> pairs, std::size_t i) {
    const btBroadphasePair& far = pairs[std::min(i + 2 * kLinesAhead, pairs.size() - 1)];
    if (const void* const algorithm = far.m_algorithm) {
        prefetch(algorithm);
        prefetch(static_cast<const char*>(algorithm) + kManifoldOffset);
    }
    prefetch(far.m_pProxy0);
    prefetch(far.m_pProxy1);
    const btBroadphasePair& near = pairs[std::min(i + kLinesAhead, pairs.size() - 1)];
    for (const btBroadphaseProxy* const proxy : {near.m_pProxy0, near.m_pProxy1}) {
        auto* const client = static_cast<btCollisionObject*>(proxy->m_clientObject);
        if (client != nullptr) {
            prefetch(&ObjectMembers::shape(*client));
        }
    }
}

btCollisionDispatcher& dispatcherOf(btDiscreteDynamicsWorld& world) {
    return static_cast<btCollisionDispatcher&>(*world.getDispatcher());
}

btSequentialImpulseConstraintSolver& solverOf(btDiscreteDynamicsWorld& world) {
    return *asSequentialImpulseSolver(world.getConstraintSolver());
}

// Bullet tells those of bodies that sleep nothing. Those of kinematic bodies tell where these are.
void placeMotionState(btDiscreteDynamicsWorld& world, btRigidBody& body) {
    if (body.getMotionState() == nullptr || body.isKinematicObject()) {
        return;
    }
    if (body.isActive()) {
        world.synchronizeSingleMotionState(&body);
    } else {
        body.getMotionState()->setWorldTransform(body.getWorldTransform());
    }
}

template <class Item>
int savePointers(const btAlignedObjectArray<Item>& from, std::vector<const void*>& to) {
    for (int i = 0; i < from.size(); ++i) {
        to.push_back(from[i]);
    }
    return from.size();
}

template <class Item>
void restorePointers(btAlignedObjectArray<Item*>& to, int count, const void* const*& from) {
    to.resizeNoInitialize(0);
    for (int i = 0; i < count; ++i) {
        to.push_back(static_cast<Item*>(const_cast<void*>(*from++)));
    }
}

/// Null where the object is no ghost that keeps pairs.
btPairCachingGhostObject* cachingGhost(btCollisionObject* object) {
    btGhostObject* const ghost = btGhostObject::upcast(object);
    return ghost != nullptr ? asPairCachingGhost(ghost) : nullptr;
}

}  // namespace

// --- Saving --------------------------------------------------------------------------------------

void WorldImage::saveSettings(btDiscreteDynamicsWorld& world) {
    settings.clear();
    const WorldSettings ofWorld{world};
    saveMembers(ofWorld, settings);
    settings.write(&world.getSolverInfo(), sizeof(btContactSolverInfo));
}

std::string WorldImage::save(btDiscreteDynamicsWorld& world,
                             const SpatialHashBroadphase& ofBroadphase) {
    objects.clear();
    bodies.clear();
    joints.clear();
    actions.clear();
    pointers.clear();
    fields.clear();
    ghosts.begin();
    contacts.begin();
    saveSettings(world);
    saveMembers(world, fields);
    fields.write(std::uint64_t{solverOf(world).getRandSeed()});

    // Contacts first of pairs: in this order they are restored.
    const std::span<const btBroadphasePair> pairs = BroadphaseImage::pairsOf(ofBroadphase);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        prefetchAhead(pairs, i);
        contacts.save(pairs[i]);
    }
    for (std::size_t i = 0; i < BroadphaseImage::retiredCount(ofBroadphase); ++i) {
        contacts.saveRetired(*BroadphaseImage::retired(ofBroadphase, i));
    }
    btCollisionObjectArray& all = world.getCollisionObjectArray();
    for (int i = 0; i < all.size(); ++i) {
        prefetchBody(*all[std::min(i + static_cast<int>(kObjectsAhead), all.size() - 1)]);
        btCollisionObject& object = *all[i];
        const btBroadphaseProxy* const proxy = object.getBroadphaseHandle();
        SavedObject saved{&object,
                          object.getCollisionShape(),
                          ObjectMembers::rootShape(object),
                          proxy->m_uniqueId,
                          SpatialHashBroadphase::idOf(proxy).index,
                          object.getInternalType(),
                          shapeRevisionOf(object.getCollisionShape()),
                          savePointers(ObjectMembers::ignored(object), pointers),
                          0,
                          0,
                          0};
        if (btRigidBody* const body = btRigidBody::upcast(&object)) {
            saved.jointCount = savePointers(BodyMembers::joints(*body), pointers);
        }
        if (btGhostObject* const ghost = btGhostObject::upcast(&object)) {
            saved.overlappingCount = savePointers(GhostMembers::overlapping(*ghost), pointers);
            if (btPairCachingGhostObject* const caching = cachingGhost(ghost)) {
                saved.ghostPairCount = ghosts.save(*caching, contacts);
            }
        }
        saveMembers(object, fields);
        objects.push_back(saved);
    }
    contacts.save(WorldMembers::predicted(world));
    const auto& nonStatic = WorldMembers::bodies(world);
    for (int i = 0; i < nonStatic.size(); ++i) {
        bodies.push_back(nonStatic[i]);
    }
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        btTypedConstraint& joint = *world.getConstraint(i);
        joints.push_back(
            {&joint, joint.getConstraintType(), &joint.getRigidBodyA(), &joint.getRigidBodyB()});
        saveJoint(joint, fields);
    }
    const auto& allActions = WorldMembers::actions(world);
    for (int i = 0; i < allActions.size(); ++i) {
        actions.push_back(allActions[i]);
        saveMembers(*asCharacter(allActions[i]), fields);
    }
    return contacts.end(dispatcherOf(world));
}

// --- Restoring -----------------------------------------------------------------------------------

void WorldImage::makeRoom(btDiscreteDynamicsWorld& world,
                          SpatialHashBroadphase& ofBroadphase) const {
    broadphase.makeRoom(ofBroadphase);
    contacts.makeRoom();
    const auto isReshaped = [](const SavedObject& saved) {
        return saved.object->getCollisionShape() != saved.shape;
    };
    reshaped_.reserve(static_cast<std::size_t>(std::ranges::count_if(objects, isReshaped)));
    std::size_t ghostPairs = 0;
    const btCollisionObjectArray& all = world.getCollisionObjectArray();
    for (int i = 0; i < all.size(); ++i) {
        btPairCachingGhostObject* const caching = cachingGhost(all[i]);
        const int count =
            caching != nullptr ? caching->getOverlappingPairCache()->getNumOverlappingPairs() : 0;
        ghostPairs += static_cast<std::size_t>(count);
    }
    ghosts.makeRoom(ghostPairs);
}

void WorldImage::takeOutAdded(btDiscreteDynamicsWorld& world) const {
    for (btTypedConstraint* joint : addedJoints_) {
        world.removeConstraint(joint);
    }
    for (btActionInterface* action : addedActions_) {
        world.removeAction(action);
    }
    // Callbacks of contacts that end may remove others of them: those that are there still, from the last one on.
    std::ranges::sort(addedObjects_);
    btCollisionObjectArray& all = world.getCollisionObjectArray();
    for (int i = addedObjects_.empty() ? -1 : all.size() - 1; i >= 0; --i) {
        if (i < all.size() && std::ranges::binary_search(addedObjects_, all[i])) {
            world.removeCollisionObject(all[i]);
        }
    }
}

void WorldImage::restore(btDiscreteDynamicsWorld& world,
                         SpatialHashBroadphase& ofBroadphase) const {
    btCollisionDispatcher& dispatcher = dispatcherOf(world);
    btCollisionObjectArray& all = world.getCollisionObjectArray();
    // Algorithms follow shapes: those of shapes that have changed are of no use.
    ghosts.beginRestore();
    for (int i = 0; i < all.size(); ++i) {
        btPairCachingGhostObject* const caching = cachingGhost(all[i]);
        if (caching != nullptr) {
            ghosts.detach(*caching);
        }
    }
    ghosts.endDetach();
    broadphase.restore(ofBroadphase, &dispatcher);
    all.resizeNoInitialize(0);
    reshaped_.clear();
    for (std::size_t i = 0; i < objects.size(); ++i) {
        prefetch(
            &ObjectMembers::shape(*objects[std::min(i + kLinesAhead, objects.size() - 1)].object));
        const SavedObject& saved = objects[i];
        btCollisionObject& object = *saved.object;
        const bool isOtherShape = object.getCollisionShape() != saved.shape;
        ObjectMembers::shape(object) = saved.shape;
        ObjectMembers::rootShape(object) = saved.rootShape;
        object.setBroadphaseHandle(BroadphaseImage::proxyAt(ofBroadphase, saved.proxyIndex));
        object.setWorldArrayIndex(all.size());
        all.push_back(&object);
        if (isOtherShape) {
            reshaped_.add(&object);
        }
    }
    if (reshaped_.size() > 0) {
        BroadphaseImage::freeAlgorithmsOf(ofBroadphase, reshaped_, dispatcher);
        ghosts.freeAlgorithmsOf(reshaped_, dispatcher);
    }

    contacts.beginRestore();
    const std::span<btBroadphasePair> pairs = BroadphaseImage::pairsOf(ofBroadphase);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        prefetchAhead(pairs, i);
        pairs[i].m_algorithm = contacts.restore(pairs[i].m_algorithm, pairs[i], dispatcher);
    }
    for (std::size_t i = 0; i < BroadphaseImage::retiredCount(ofBroadphase); ++i) {
        BroadphaseImage::retired(ofBroadphase, i) = contacts.restoreRetired(dispatcher);
    }
    for (const SavedObject& saved : objects) {
        btPairCachingGhostObject* const caching = cachingGhost(saved.object);
        if (caching != nullptr) {
            ghosts.restore(*caching, saved.ghostPairCount, ofBroadphase, contacts, dispatcher);
        }
    }
    ghosts.endRestore(dispatcher);
    contacts.restore(WorldMembers::predicted(world), dispatcher);
    contacts.endRestore(dispatcher);

    ByteReader settingsReader(settings.bytes());
    const WorldSettings ofWorld{world};
    restoreMembers(ofWorld, settingsReader);
    settingsReader.read(&world.getSolverInfo(), sizeof(btContactSolverInfo));
    ByteReader reader(fields.bytes());
    restoreMembers(world, reader);
    solverOf(world).setRandSeed(static_cast<unsigned long>(reader.read<std::uint64_t>()));
    const void* const* pointer = pointers.data();
    for (std::size_t i = 0; i < objects.size(); ++i) {
        prefetchBody(*objects[std::min(i + kObjectsAhead, objects.size() - 1)].object);
        const SavedObject& saved = objects[i];
        btCollisionObject& object = *saved.object;
        restoreMembers(object, reader);
        restorePointers(ObjectMembers::ignored(object), saved.ignoredCount, pointer);
        if (btRigidBody* const body = btRigidBody::upcast(&object)) {
            restorePointers(BodyMembers::joints(*body), saved.jointCount, pointer);
        }
        if (btGhostObject* const ghost = btGhostObject::upcast(&object)) {
            restorePointers(GhostMembers::overlapping(*ghost), saved.overlappingCount, pointer);
        }
    }
    auto& nonStatic = WorldMembers::bodies(world);
    nonStatic.resizeNoInitialize(0);
    for (btRigidBody* body : bodies) {
        nonStatic.push_back(body);
    }
    auto& allJoints = WorldMembers::joints(world);
    allJoints.resizeNoInitialize(0);
    for (const SavedJoint& saved : joints) {
        allJoints.push_back(saved.joint);
        restoreJoint(*saved.joint, reader);
    }
    for (btRigidBody* body : bodies) {
        placeMotionState(world, *body);
    }
    auto& allActions = WorldMembers::actions(world);
    allActions.resizeNoInitialize(0);
    for (btActionInterface* action : actions) {
        allActions.push_back(action);
        restoreMembers(*asCharacter(action), reader);
    }
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
