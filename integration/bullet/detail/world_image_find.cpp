// SPDX-License-Identifier: Zlib

// What of a world cannot be saved, and what of a saved one is missing.

#include <integration/bullet/detail/world_image.hpp>

#include <integration/bullet/detail/bullet_classes.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/joint_image.hpp>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cstddef>
#include <cstdint>
#include <sstream>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

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

int shapeRevisionOf(const btCollisionShape* shape) {
    if (shape == nullptr || !shape->isCompound()) {
        return 0;
    }
    const auto& compound = static_cast<const btCompoundShape&>(*shape);
    int revision = compound.getUpdateRevision();
    for (int i = 0; i < compound.getNumChildShapes(); ++i) {
        revision += shapeRevisionOf(compound.getChildShape(i));
    }
    return revision;
}

std::string WorldImage::faultOf(btDiscreteDynamicsWorld& world,
                                const SpatialHashBroadphase& broadphase) {
    if (world.getBroadphase() != &broadphase) {
        return "The world has another broadphase. Pass the broadphase of the world.";
    }
    std::string fault = BroadphaseImage::faultOf(broadphase);
    if (!fault.empty()) {
        return fault;
    }
    if (asCollisionDispatcher(world.getDispatcher()) == nullptr) {
        return "The world's dispatcher is not a btCollisionDispatcher, which a snapshot needs. "
               "Make the world with one.";
    }
    if (asSequentialImpulseSolver(world.getConstraintSolver()) == nullptr) {
        return "The world's solver is not a btSequentialImpulseConstraintSolver, which a snapshot "
               "needs. Make the world with one.";
    }
    if (hasMultiBodies(world)) {
        return "The world has multibodies, which a snapshot cannot keep. Remove them first.";
    }
    std::ostringstream sentence;
    const btCollisionObjectArray& objects = world.getCollisionObjectArray();
    for (int i = 0; i < objects.size(); ++i) {
        constexpr int known = btCollisionObject::CO_COLLISION_OBJECT |
                              btCollisionObject::CO_RIGID_BODY | btCollisionObject::CO_GHOST_OBJECT;
        if ((objects[i]->getInternalType() & ~known) != 0) {
            sentence << "Object " << i << " of the world is "
                     << nameOfType(objects[i]->getInternalType())
                     << ", which a snapshot cannot keep. Remove it first.";
            return sentence.str();
        }
    }
    for (int i = 0; i < world.getNumConstraints(); ++i) {
        if (!isKnown(*world.getConstraint(i))) {
            sentence << "Joint " << i << " of the world is of type "
                     << world.getConstraint(i)->getConstraintType()
                     << ", which a snapshot cannot keep. Remove it first.";
            return sentence.str();
        }
    }
    const auto& actions = WorldMembers::actions(world);
    for (int i = 0; i < actions.size(); ++i) {
        if (asCharacter(actions[i]) == nullptr) {
            sentence << "Action " << i
                     << " of the world is not a btKinematicCharacterController, but a vehicle or "
                        "another action, which a snapshot cannot keep. Remove it first.";
            return sentence.str();
        }
    }
    return {};
}

// Those of the world whose addresses are not among the saved ones are listed as added; of the saved ones,
// `present_` has those that are there, and `brought_` what is returned.
template <class Saved, class Item, class AddressOf>
void WorldImage::compare(const std::vector<Saved>& saved, const btAlignedObjectArray<Item*>& all,
                         std::span<Item* const> returned, const AddressOf& addressOf,
                         std::vector<Item*>& added) const {
    added.clear();
    present_.clear();
    brought_.clear();
    for (Item* const item : returned) {
        brought_.findOrInsert(keyOf(item));
    }
    bool areSame = saved.size() == static_cast<std::size_t>(all.size());
    for (int i = 0; areSame && i < all.size(); ++i) {
        areSame = addressOf(saved[static_cast<std::size_t>(i)]) == all[i];
    }
    areAllPresent_ = areSame;
    if (areSame) {
        return;
    }
    for (const Saved& each : saved) {
        present_.findOrInsert(keyOf(addressOf(each)));
    }
    for (int i = 0; i < all.size(); ++i) {
        if (!present_.contains(keyOf(all[i]))) {
            added.push_back(all[i]);
        }
    }
    present_.clear();
    for (int i = 0; i < all.size(); ++i) {
        present_.findOrInsert(keyOf(all[i]));
    }
}

std::string WorldImage::find(btDiscreteDynamicsWorld& world, const Returned& returned) const {
    std::string fault = findObjects(world, returned);
    if (fault.empty()) {
        fault = findJoints(world, returned);
    }
    return fault.empty() ? findActions(world, returned) : fault;
}

std::string WorldImage::findObjects(btDiscreteDynamicsWorld& world,
                                    const Returned& returned) const {
    compare(
        objects, world.getCollisionObjectArray(), returned.objects,
        [](const SavedObject& saved) { return saved.object; }, addedObjects_);
    for (std::size_t i = 0; i < objects.size(); ++i) {
        const SavedObject& saved = objects[i];
        const bool isThere = isPresent(saved.object);
        const auto sentence = [&](const char* what) {
            return "Object " + std::to_string(i) + " (unique id " + std::to_string(saved.uniqueId) +
                   ") " + what;
        };
        if (!isThere && !isHandedOver(saved.object)) {
            return sentence(
                "was removed from the world after it was saved. Hand it over as "
                "Returned::objects.");
        }
        const btBroadphaseProxy* const proxy = saved.object->getBroadphaseHandle();
        if (!isThere && proxy != nullptr) {
            return sentence(
                "is handed over, but it is in another world. Remove it from that world first.");
        }
        if (saved.object->getInternalType() != saved.type) {
            return sentence(
                "was deleted after it was saved, and another object has its address. Keep objects "
                "while a snapshot has them.");
        }
        if (isThere && proxy->m_uniqueId != saved.uniqueId &&
            saved.object->getCollisionShape() != saved.shape && !isHandedOver(saved.object)) {
            return sentence(
                "was removed after it was saved, and an object with another shape was added at its "
                "address. If it is the same object, hand it over as Returned::objects.");
        }
        if (shapeRevisionOf(saved.shape) != saved.shapeRevision) {
            return sentence(
                "has a compound shape that changed after it was saved. Save again after such a "
                "change.");
        }
    }
    return {};
}

std::string WorldImage::findJoints(btDiscreteDynamicsWorld& world, const Returned& returned) const {
    compare(
        joints, WorldMembers::joints(world), returned.joints,
        [](const SavedJoint& saved) { return saved.joint; }, addedJoints_);
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const SavedJoint& saved = joints[i];
        const auto sentence = [&](const char* what) {
            return "Joint " + std::to_string(i) + " was removed from the world after it was saved" +
                   what;
        };
        if (!isPresent(saved.joint) && !isHandedOver(saved.joint)) {
            return sentence(". Hand it over as Returned::joints.");
        }
        if (saved.joint->getConstraintType() != saved.type ||
            &saved.joint->getRigidBodyA() != saved.a || &saved.joint->getRigidBodyB() != saved.b) {
            return sentence(
                ", and another joint has its address. Keep joints while a snapshot has them.");
        }
    }
    return {};
}

std::string WorldImage::findActions(btDiscreteDynamicsWorld& world,
                                    const Returned& returned) const {
    compare(
        actions, WorldMembers::actions(world), returned.actions,
        [](btActionInterface* action) { return action; }, addedActions_);
    for (std::size_t i = 0; i < actions.size(); ++i) {
        if (!isPresent(actions[i]) && !isHandedOver(actions[i])) {
            return "Action " + std::to_string(i) +
                   " was removed from the world after it was saved. Hand it over as "
                   "Returned::actions.";
        }
        if (asCharacter(actions[i]) == nullptr) {
            return "Action " + std::to_string(i) +
                   " was deleted after it was saved, and another action has its address. Keep "
                   "actions while a snapshot has them.";
        }
    }
    return {};
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
