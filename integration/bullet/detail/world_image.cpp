// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/world_image.hpp>

#include <broadphase/core/ensure_capacity.hpp>
#include <integration/bullet/detail/bullet_classes.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/joint_image.hpp>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include <algorithm>
#include <sstream>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

/// Writes members, of vectors no more than there is in them.
struct SaveMember {
    ByteWriter& to;

    template <PlainNumber Number>
    void operator()(const Number& number) const {
        to.write(number);
    }
    void operator()(const btVector3& vector) const {
        to.write(vector.m_floats, 3 * sizeof(btScalar));
    }
    void operator()(const btQuaternion& rotation) const {
        for (int i = 0; i < 4; ++i) {
            to.write(rotation[i]);
        }
    }
    void operator()(const btMatrix3x3& matrix) const {
        for (int row = 0; row < 3; ++row) {
            (*this)(matrix[row]);
        }
    }
    void operator()(const btTransform& place) const {
        (*this)(place.getBasis());
        (*this)(place.getOrigin());
    }
};

struct RestoreMember {
    ByteReader& from;

    template <PlainNumber Number>
    void operator()(Number& number) const {
        number = from.read<Number>();
    }
    void operator()(btVector3& vector) const { from.read(vector.m_floats, 3 * sizeof(btScalar)); }
    void operator()(btQuaternion& rotation) const {
        for (int i = 0; i < 4; ++i) {
            rotation[i] = from.read<btScalar>();
        }
    }
    void operator()(btMatrix3x3& matrix) const {
        for (int row = 0; row < 3; ++row) {
            (*this)(matrix[row]);
        }
    }
    void operator()(btTransform& place) const {
        (*this)(place.getBasis());
        (*this)(place.getOrigin());
    }
};

template <class Visit>
void forEachMember(btDiscreteDynamicsWorld& world, const Visit& visit) {
    WorldMembers::forEach(world, visit);
    btDispatcherInfo& dispatch = world.getDispatchInfo();
    visit(dispatch.m_timeStep);
    visit(dispatch.m_stepCount);
    visit(dispatch.m_dispatchFunc);
    visit(dispatch.m_timeOfImpact);
    visit(dispatch.m_useContinuous);
    visit(dispatch.m_enableSatConvex);
    visit(dispatch.m_enableSPU);
    visit(dispatch.m_useEpa);
    visit(dispatch.m_allowedCcdPenetration);
    visit(dispatch.m_useConvexConservativeDistanceUtil);
    visit(dispatch.m_convexConservativeDistanceThreshold);
    visit(dispatch.m_deterministicOverlappingPairs);
}

template <class Visit>
void forEachMember(btCollisionObject& object, const Visit& visit) {
    ObjectMembers::forEach(object, visit);
    if (btRigidBody* const body = btRigidBody::upcast(&object)) {
        BodyMembers::forEach(*body, visit);
    }
}

btCollisionDispatcher& dispatcherOf(btDiscreteDynamicsWorld& world) {
    return static_cast<btCollisionDispatcher&>(*world.getDispatcher());
}

int revisionOf(const btCollisionShape* shape) {
    if (shape == nullptr || !shape->isCompound()) {
        return 0;
    }
    const auto& compound = static_cast<const btCompoundShape&>(*shape);
    int revision = compound.getUpdateRevision();
    for (int i = 0; i < compound.getNumChildShapes(); ++i) {
        revision += revisionOf(compound.getChildShape(i));
    }
    return revision;
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

const char* nameOfType(int type) {
    switch (type) {
        case btCollisionObject::CO_SOFT_BODY:
            return "a soft body";
        case btCollisionObject::CO_FEATHERSTONE_LINK:
            return "a link of a multibody";
        default:
            return "of a type that Bullet's rigid worlds do not have";
    }
}

std::uint64_t keyOf(const void* pointer) {
    return reinterpret_cast<std::uintptr_t>(pointer);
}

}  // namespace

std::string WorldImage::faultOf(btDiscreteDynamicsWorld& world,
                                const SpatialHashBroadphase& broadphase) {
    if (world.getBroadphase() != &broadphase) {
        return "The broadphase is not that of the world.";
    }
    std::string fault = BroadphaseImage::faultOf(broadphase);
    if (!fault.empty()) {
        return fault;
    }
    if (asSequentialImpulseSolver(world.getConstraintSolver()) == nullptr) {
        return "The world's solver is not a btSequentialImpulseConstraintSolver.";
    }
    if (hasMultiBodies(world)) {
        return "The world has multibodies.";
    }
    std::ostringstream sentence;
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        constexpr int known = btCollisionObject::CO_COLLISION_OBJECT |
                              btCollisionObject::CO_RIGID_BODY | btCollisionObject::CO_GHOST_OBJECT;
        if ((objects[i]->getInternalType() & ~known) != 0) {
            sentence << "Object " << i << " of the world is "
                     << nameOfType(objects[i]->getInternalType()) << ".";
            return sentence.str();
        }
    }
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        if (!isKnown(*world.getConstraint(i))) {
            sentence << "Joint " << i << " of the world is of type "
                     << world.getConstraint(i)->getConstraintType() << ", which is not known.";
            return sentence.str();
        }
    }
    const auto& actions = WorldMembers::actions(world);
    for (int i = 0; i < actions.size(); ++i) {
        if (asCharacter(actions[i]) == nullptr) {
            sentence << "Action " << i
                     << " of the world is not a btKinematicCharacterController; vehicles are such "
                        "actions.";
            return sentence.str();
        }
    }
    return {};
}

// --- Saving --------------------------------------------------------------------------------------

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
    const SaveMember saveMember{fields};
    forEachMember(world, saveMember);
    fields.write(&world.getSolverInfo(), sizeof(btContactSolverInfo));
    fields.write(asSequentialImpulseSolver(world.getConstraintSolver())->getRandSeed());

    // Contacts first of pairs: in this order they are restored.
    for (const btBroadphasePair& pair : BroadphaseImage::pairsOf(ofBroadphase)) {
        contacts.save(pair);
    }
    for (std::size_t i = 0; i < BroadphaseImage::retiredCount(ofBroadphase); ++i) {
        contacts.saveRetired(*BroadphaseImage::retired(ofBroadphase, i));
    }
    btCollisionObjectArray& all = world.getCollisionObjectArray();
    for (int i = 0; i < all.size(); ++i) {
        btCollisionObject& object = *all[i];
        const btBroadphaseProxy* const proxy = object.getBroadphaseHandle();
        SavedObject saved{&object,
                          object.getCollisionShape(),
                          ObjectMembers::rootShape(object),
                          proxy->m_uniqueId,
                          SpatialHashBroadphase::idOf(proxy).index,
                          object.getInternalType(),
                          revisionOf(object.getCollisionShape()),
                          savePointers(ObjectMembers::ignored(object), pointers),
                          0,
                          0,
                          0};
        if (btRigidBody* const body = btRigidBody::upcast(&object)) {
            saved.jointCount = savePointers(BodyMembers::joints(*body), pointers);
        }
        if (btGhostObject* const ghost = btGhostObject::upcast(&object)) {
            saved.overlappingCount = savePointers(GhostMembers::overlapping(*ghost), pointers);
            if (btPairCachingGhostObject* const caching = asPairCachingGhost(ghost)) {
                saved.ghostPairCount = ghosts.save(*caching, contacts);
            }
        }
        forEachMember(object, saveMember);
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
    const auto& all_actions = WorldMembers::actions(world);
    for (int i = 0; i < all_actions.size(); ++i) {
        actions.push_back(all_actions[i]);
        CharacterMembers::forEach(*asCharacter(all_actions[i]), saveMember);
    }
    return contacts.end(dispatcherOf(world));
}

// --- Restoring -----------------------------------------------------------------------------------

std::string WorldImage::find(btDiscreteDynamicsWorld& world, const Returned& returned) const {
    std::ostringstream sentence;
    addedObjects.clear();
    addedJoints.clear();
    addedActions.clear();
    const auto isReturned = [](const auto& list, const void* item) {
        return std::find(list.begin(), list.end(), item) != list.end();
    };
    // Objects: those of now by their addresses.
    present.clear();
    const btCollisionObjectArray& all = world.getCollisionObjectArray();
    for (int i = 0; i < all.size(); ++i) {
        present.findOrInsert(keyOf(all[i]));
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const SavedObject& saved = objects[i];
        const bool isThere = present.contains(keyOf(saved.object));
        if (!isThere && !isReturned(returned.objects, saved.object)) {
            sentence << "Object " << i << " (unique id " << saved.uniqueId
                     << ") was removed from the world since. Hand it over as Returned::objects.";
            return sentence.str();
        }
        if (!isThere && saved.object->getBroadphaseHandle() != nullptr) {
            sentence << "Object " << i << " (unique id " << saved.uniqueId
                     << "), which is handed over, is in another world.";
            return sentence.str();
        }
        const bool isSame =
            saved.object->getInternalType() == saved.type &&
            (!isThere || saved.object->getBroadphaseHandle()->m_uniqueId == saved.uniqueId ||
             saved.object->getCollisionShape() == saved.shape);
        if (!isSame) {
            sentence << "Object " << i << " (unique id " << saved.uniqueId
                     << ") was removed from the world since, and another one is at its address.";
            return sentence.str();
        }
        if (revisionOf(saved.shape) != saved.shapeRevision) {
            sentence << "The compound shape of object " << i << " (unique id " << saved.uniqueId
                     << ") has changed since.";
            return sentence.str();
        }
    }
    present.clear();
    for (const SavedObject& saved : objects) {
        present.findOrInsert(keyOf(saved.object));
    }
    for (int i = 0; i < all.size(); ++i) {
        if (!present.contains(keyOf(all[i]))) {
            addedObjects.push_back(all[i]);
        }
    }
    // Joints.
    const auto& allJoints = WorldMembers::joints(world);
    present.clear();
    for (int i = 0; i < allJoints.size(); ++i) {
        present.findOrInsert(keyOf(allJoints[i]));
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const SavedJoint& saved = joints[i];
        if (!present.contains(keyOf(saved.joint)) && !isReturned(returned.joints, saved.joint)) {
            sentence << "Joint " << i
                     << " was removed from the world since. Hand it over as Returned::joints.";
            return sentence.str();
        }
        if (saved.joint->getConstraintType() != saved.type ||
            &saved.joint->getRigidBodyA() != saved.a || &saved.joint->getRigidBodyB() != saved.b) {
            sentence << "Joint " << i
                     << " was removed from the world since, and another one is at its address.";
            return sentence.str();
        }
    }
    present.clear();
    for (const SavedJoint& saved : joints) {
        present.findOrInsert(keyOf(saved.joint));
    }
    for (int i = 0; i < allJoints.size(); ++i) {
        if (!present.contains(keyOf(allJoints[i]))) {
            addedJoints.push_back(allJoints[i]);
        }
    }
    // Actions.
    const auto& allActions = WorldMembers::actions(world);
    for (std::size_t i = 0; i < actions.size(); ++i) {
        const bool isThere = allActions.findLinearSearch(actions[i]) < allActions.size() ||
                             isReturned(returned.actions, actions[i]);
        if (!isThere || asCharacter(actions[i]) == nullptr) {
            sentence << "Action " << i
                     << " was removed from the world since. Hand it over as Returned::actions.";
            return sentence.str();
        }
    }
    for (int i = 0; i < allActions.size(); ++i) {
        if (std::find(actions.begin(), actions.end(), allActions[i]) == actions.end()) {
            addedActions.push_back(allActions[i]);
        }
    }
    return {};
}

void WorldImage::makeRoom(btDiscreteDynamicsWorld& world,
                          SpatialHashBroadphase& ofBroadphase) const {
    broadphase.makeRoom(ofBroadphase);
    contacts.makeRoom();
    std::size_t ghostPairs = 0;
    const btCollisionObjectArray& all = world.getCollisionObjectArray();
    for (int i = 0; i < all.size(); ++i) {
        btGhostObject* const ghost = btGhostObject::upcast(all[i]);
        btPairCachingGhostObject* const caching =
            ghost != nullptr ? asPairCachingGhost(ghost) : nullptr;
        ghostPairs += caching != nullptr
                          ? static_cast<std::size_t>(
                                caching->getOverlappingPairCache()->getNumOverlappingPairs())
                          : 0;
    }
    ghosts.makeRoom(ghostPairs);
}

void WorldImage::takeOutAdded(btDiscreteDynamicsWorld& world) const {
    for (btTypedConstraint* joint : addedJoints) {
        world.removeConstraint(joint);
    }
    for (btActionInterface* action : addedActions) {
        world.removeAction(action);
    }
    for (btCollisionObject* object : addedObjects) {
        world.removeCollisionObject(object);
    }
}

void WorldImage::restore(btDiscreteDynamicsWorld& world,
                         SpatialHashBroadphase& ofBroadphase) const {
    btCollisionDispatcher& dispatcher = dispatcherOf(world);
    btCollisionObjectArray& all = world.getCollisionObjectArray();
    // Algorithms follow shapes: those of shapes that have changed are of no use.
    ghosts.beginRestore();
    for (int i = 0; i < all.size(); ++i) {
        btGhostObject* const ghost = btGhostObject::upcast(all[i]);
        btPairCachingGhostObject* const caching =
            ghost != nullptr ? asPairCachingGhost(ghost) : nullptr;
        if (caching != nullptr) {
            ghosts.detach(*caching);
        }
    }
    broadphase.restore(ofBroadphase, &dispatcher);
    all.resizeNoInitialize(0);
    for (const SavedObject& saved : objects) {
        btCollisionObject& object = *saved.object;
        const bool isOtherShape = object.getCollisionShape() != saved.shape;
        ObjectMembers::shape(object) = saved.shape;
        ObjectMembers::rootShape(object) = saved.rootShape;
        object.setBroadphaseHandle(BroadphaseImage::proxyAt(ofBroadphase, saved.proxyIndex));
        object.setWorldArrayIndex(all.size());
        all.push_back(&object);
        if (isOtherShape) {
            BroadphaseImage::freeAlgorithmsOf(ofBroadphase, &object, dispatcher);
            ghosts.freeAlgorithmsOf(&object, dispatcher);
        }
    }

    contacts.beginRestore();
    for (btBroadphasePair& pair : BroadphaseImage::pairsOf(ofBroadphase)) {
        pair.m_algorithm = contacts.restore(pair.m_algorithm, pair, dispatcher);
    }
    for (std::size_t i = 0; i < BroadphaseImage::retiredCount(ofBroadphase); ++i) {
        BroadphaseImage::retired(ofBroadphase, i) = contacts.restoreRetired(dispatcher);
    }
    for (const SavedObject& saved : objects) {
        btGhostObject* const ghost = btGhostObject::upcast(saved.object);
        btPairCachingGhostObject* const caching =
            ghost != nullptr ? asPairCachingGhost(ghost) : nullptr;
        if (caching != nullptr) {
            ghosts.restore(*caching, saved.ghostPairCount, ofBroadphase, contacts, dispatcher);
        }
    }
    ghosts.endRestore(dispatcher);
    contacts.restore(WorldMembers::predicted(world), dispatcher);
    contacts.endRestore(dispatcher);

    ByteReader reader(fields.bytes());
    const RestoreMember restoreMember{reader};
    forEachMember(world, restoreMember);
    reader.read(&world.getSolverInfo(), sizeof(btContactSolverInfo));
    asSequentialImpulseSolver(world.getConstraintSolver())
        ->setRandSeed(reader.read<unsigned long>());
    const void* const* pointer = pointers.data();
    for (const SavedObject& saved : objects) {
        btCollisionObject& object = *saved.object;
        forEachMember(object, restoreMember);
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
    auto& allActions = WorldMembers::actions(world);
    allActions.resizeNoInitialize(0);
    for (btActionInterface* action : actions) {
        allActions.push_back(action);
        CharacterMembers::forEach(*asCharacter(action), restoreMember);
    }
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
