// SPDX-License-Identifier: Zlib
#pragma once

// What a WorldSnapshot keeps of a world besides the broadphase and the contacts: its objects, joints and actions,
// and the world's own settings.

#include <broadphase/core/byte_stream.hpp>
#include <broadphase/core/flat_set.hpp>
#include <integration/bullet/detail/broadphase_image.hpp>
#include <integration/bullet/detail/contact_image.hpp>
#include <integration/bullet/detail/ghost_image.hpp>
#include <integration/bullet/world_snapshot.hpp>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

struct SavedObject {
    btCollisionObject* object;
    btCollisionShape* shape;
    btCollisionShape* rootShape;
    int uniqueId;  // of its proxy
    std::uint32_t proxyIndex;
    int type;           // btCollisionObject::CollisionObjectTypes
    int shapeRevision;  // of a compound shape
    int ignoredCount;   // in WorldImage::pointers, one behind the other
    int jointCount;
    int overlappingCount;
    int ghostPairCount;
};

/// A number that is another one after a change of a compound shape; 0 of any other shape, or of none.
[[nodiscard]] int shapeRevisionOf(const btCollisionShape* shape);

struct SavedJoint {
    btTypedConstraint* joint;
    int type;
    const btRigidBody* a;
    const btRigidBody* b;
};

struct WorldImage {
    BroadphaseImage broadphase;
    ContactImage contacts;
    GhostImage ghosts;
    std::vector<SavedObject> objects;  // in the world's order
    std::vector<btRigidBody*> bodies;  // the same, of those that are not static
    std::vector<SavedJoint> joints;
    std::vector<btActionInterface*> actions;
    std::vector<const void*> pointers;
    ByteWriter fields;    // of the world, the objects, the joints and the actions
    ByteWriter settings;  // of the world and its solver
    bool isSaved = false;

    /// What is not covered; empty where all is.
    [[nodiscard]] static std::string faultOf(btDiscreteDynamicsWorld& world,
                                             const SpatialHashBroadphase& broadphase);

    /// All but the broadphase. Returns what is wrong with the contacts.
    [[nodiscard]] std::string save(btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase);

    /// Replaces what `bytes` held by all. Returns what cannot be written.
    [[nodiscard]] std::string write(std::vector<std::byte>& bytes) const;
    /// Takes what was written of such a world. Returns what is wrong; then it is of no use.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes, btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase,
                                   const Returned& returned);

    /// What is missing, or not as it was; empty where all is there. Lists what has been added.
    [[nodiscard]] std::string find(btDiscreteDynamicsWorld& world, const Returned& returned) const;
    /// Takes memory beforehand, for what follows.
    void makeRoom(btDiscreteDynamicsWorld& world, SpatialHashBroadphase& broadphase) const;
    void takeOutAdded(btDiscreteDynamicsWorld& world) const;
    void restore(btDiscreteDynamicsWorld& world, SpatialHashBroadphase& broadphase) const;

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return sizeof(*this) + broadphase.memoryBytes() + contacts.memoryBytes() +
               ghosts.memoryBytes() + objects.capacity() * sizeof(objects[0]) +
               joints.capacity() * sizeof(joints[0]) + fields.memoryBytes() +
               settings.memoryBytes() +
               (bodies.capacity() + actions.capacity() + pointers.capacity() +
                addedObjects_.capacity() + addedJoints_.capacity() + addedActions_.capacity()) *
                   sizeof(void*) +
               present_.memoryBytes() + brought_.memoryBytes() + reshaped_.memoryBytes();
    }

private:
    template <class Saved, class Item, class AddressOf>
    void compare(const std::vector<Saved>& saved, const btAlignedObjectArray<Item*>& all,
                 std::span<Item* const> returned, const AddressOf& addressOf,
                 std::vector<Item*>& added) const;
    [[nodiscard]] bool isPresent(const void* pointer) const {
        return areAllPresent_ || present_.contains(reinterpret_cast<std::uintptr_t>(pointer));
    }
    [[nodiscard]] bool isHandedOver(const void* pointer) const {
        return brought_.contains(reinterpret_cast<std::uintptr_t>(pointer));
    }
    void saveSettings(btDiscreteDynamicsWorld& world);
    [[nodiscard]] std::string readObjects(ByteReader& from, btDiscreteDynamicsWorld& world,
                                          const Returned& returned);
    [[nodiscard]] std::string takeNumbers(ByteReader& from, std::span<const std::uint32_t> numbers);
    [[nodiscard]] std::string readJoints(ByteReader& from, btDiscreteDynamicsWorld& world,
                                         const Returned& returned);
    [[nodiscard]] std::string readActions(ByteReader& from, btDiscreteDynamicsWorld& world,
                                          const Returned& returned);
    [[nodiscard]] bool areDistinct() const;
    [[nodiscard]] bool areProxiesRight() const;
    [[nodiscard]] bool areGhostsRight() const;
    [[nodiscard]] std::vector<ObjectPair> objectsOfPairs() const;
    [[nodiscard]] std::size_t countFieldBytes(btDiscreteDynamicsWorld& world) const;
    [[nodiscard]] std::string findObjects(btDiscreteDynamicsWorld& world,
                                          const Returned& returned) const;
    [[nodiscard]] std::string findJoints(btDiscreteDynamicsWorld& world,
                                         const Returned& returned) const;
    [[nodiscard]] std::string findActions(btDiscreteDynamicsWorld& world,
                                          const Returned& returned) const;

    /// Where in `pointers` the joint with that number belongs.
    struct JointPlace {
        std::size_t place;
        std::uint32_t number;
    };
    std::vector<JointPlace> jointPlaces_;  // scratch of read()

    // Scratch of find(): the addresses of what is there and of what is handed over; and what is to be taken out.
    mutable FlatSet present_;
    mutable FlatSet brought_;
    mutable ObjectNumbers reshaped_;  // scratch of restore(): those that have other shapes now
    mutable bool areAllPresent_ = false;
    mutable std::vector<btCollisionObject*> addedObjects_;
    mutable std::vector<btTypedConstraint*> addedJoints_;
    mutable std::vector<btActionInterface*> addedActions_;
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
