// SPDX-License-Identifier: Zlib
#pragma once

// Saves a Bullet world that has a SpatialHashBroadphase, and restores it, between two steps: for rollback, replays,
// training and editors. Steps after restore() give the same bits as the same steps after save().
//
//     WorldSnapshot snapshot;
//     std::string fault = snapshot.save(world, broadphase);     // empty: no fault
//     ...                                                       // steps, added and removed bodies
//     fault = snapshot.restore(world, broadphase);
//
// Saved     All of Bullet's state that a step depends on: objects and their ignored objects, contacts with
//           impulses, joints with motors and limits, ghosts, characters, gravity, solver settings and random seed,
//           the time left over by stepSimulation(), the order of pairs and contacts, and the broadphase with grid,
//           pairs and sweeps.
// Not saved User pointers and indices, joint feedback, debug colours, members of derived classes. Of a shape, only
//           the pointer is saved. restore() sets motion states of dynamic bodies. Restore motion states of kinematic
//           bodies yourself.
// Refused   Soft bodies, multibodies, worlds of a WorldsBroadphase, pair caches other than PairCache, actions other
//           than btKinematicCharacterController (such as btRaycastVehicle), contact points with user data, contact
//           manifolds that the program made, joints of unknown types, compound shapes that were changed since the
//           last step, collision algorithms outside Bullet's default configuration (such as
//           btGImpactCollisionAlgorithm), dispatchers not derived from btCollisionDispatcher, solvers not derived
//           from btSequentialImpulseConstraintSolver. The returned sentence describes the fault.
// RTTI      If Bullet or this library is built without RTTI, all actions are refused. In such a build, multibodies
//           are refused only if the world has their colliders. In such a build, pairs of a btPairCachingGhostObject,
//           and the angle counted by a btHingeAccumulatedAngleConstraint, are not saved.
// Added     restore() removes objects, joints and characters that were added after save(). It does not delete them.
// Removed   If objects, joints or characters were removed after save(), pass them to restore(): it adds them again.
//           If one is missing, restore() returns a fault that names it, and changes nothing. If you have added a
//           removed object again yourself, you need to pass it only if its shape pointer has changed. If you do not
//           pass it in that case, restore() takes it for another object at the same address, and returns a fault.
// Ids       m_uniqueId and ProxyId are restored. Proxies added after restore() get the same ids as the proxies that
//           were added after save().
// Pointers  A proxy that exists from save() to restore() keeps its address. For other proxies, and after restoring a
//           snapshot that read() made, call getBroadphaseHandle() again. Pointers to pairs, algorithms, manifolds and
//           contact points are invalid after restore().
// One world Restore a snapshot only in the world that you passed to save() or read(). For another world, use write()
//           and read().
// Lifetime  Keep a shape alive while a snapshot contains an object with this shape. Do not change compound shapes
//           after save().
// Callbacks restore() calls contact and ghost callbacks only for objects that it removes, as removeCollisionObject()
//           does. These callbacks may remove other objects that were added after save(), but must add none.
// Calls     Call save() and restore() between steps. Within callbacks of the broadphase or its cache, they return a
//           fault. Never call them in tick callbacks or motion states: such calls are not detected, and apply the
//           forces of the step twice.
// Memory    Another save() into the same snapshot allocates no memory, unless the world has grown. Throws
//           std::bad_alloc when memory runs out. In that case, save() leaves the snapshot empty, and restore()
//           changes nothing.
// Threads   During a call, no other thread may use the world or the snapshot.

#include <integration/bullet/export.hpp>
#include <integration/bullet/precision.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

class btActionInterface;
class btDiscreteDynamicsWorld;
class btTypedConstraint;

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

/// Removed objects, joints and actions that restore() puts back into the world.
struct Returned {
    std::span<btCollisionObject* const> objects{};
    std::span<btTypedConstraint* const> joints{};
    std::span<btActionInterface* const> actions{};
};

/// Saves a world, and restores it.
class HASHPHASE_BULLET_EXPORT WorldSnapshot {
public:
    WorldSnapshot() noexcept;
    ~WorldSnapshot();
    WorldSnapshot(WorldSnapshot&& other) noexcept;
    WorldSnapshot& operator=(WorldSnapshot&& other) noexcept;

    /// Saves the world, which must use `broadphase`. Returns an empty string, or a sentence about the fault. After a
    /// fault, the snapshot is empty. Cost: one pass over objects, pairs and contacts.
    [[nodiscard]] std::string save(btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase);

    /// Restores the saved state. You may call it any number of times, on several snapshots in any order. Returns an
    /// empty string, or a sentence about the fault. After a fault, nothing has changed. Cost: as save(), plus
    /// removing added objects, and creating algorithms for saved pairs that no longer exist.
    [[nodiscard]] std::string restore(btDiscreteDynamicsWorld& world,
                                      SpatialHashBroadphase& broadphase,
                                      const Returned& returned = {}) const;

    /// Replaces the content of `bytes` by the snapshot, a version and a checksum, to send or to keep. Returns an
    /// empty string, or a sentence about the fault. After a fault, `bytes` is empty. Faults:
    /// - The snapshot is empty.
    /// - An ignored object, a joint of a body, a body of a joint, the ghost of a character, or the object of a proxy
    ///   is not in the world.
    /// - Algorithms of removed pairs are not freed yet. In that case, save again after the next step.
    ///
    /// Numbers have the format of this processor, Bullet and compiler. Writer and reader must have an equal
    /// SpatialHashConfig (except parallelFor). Their worlds' getSolverInfo(), getDispatchInfo() and flags, such as
    /// setForceUpdateAllAabbs(), must be equal too: save() saves them, but write() does not write them. A world
    /// restored from bytes writes the same bytes again. Two equal worlds may write different bytes, because joints
    /// contain padding.
    /// Cost: O(saved state). If many objects touch, most bytes are contact points.
    [[nodiscard]] std::string write(std::vector<std::byte>& bytes) const;

    /// Reads bytes that write() made of a world with the same objects, such as a world built by the same calls. Finds
    /// objects by unique ids of proxies, joints by type and bodies, characters by ghosts. If some are not in this
    /// world, pass them as `returned`: objects and joints in the order of the writer's world at save(), characters in
    /// any order. If you pass too few objects, the fault lists the unique ids of all objects that are not in this
    /// world, in the writer's order. Objects keep their present shapes. A compound shape and its child compounds must
    /// have the same getUpdateRevision() as in the writer at save(). If another object has a saved id by chance,
    /// read() takes this wrong object, unless its type or the getUpdateRevision() of its compound shape differs.
    /// Returns an empty string, or a sentence about the fault. After a fault, nothing has changed. After success,
    /// call restore() with the same `returned`. With equal inputs, later steps give the same bits as the writer's
    /// steps. Damaged bytes are refused. Forged bytes may put objects anywhere, but do no other harm: authenticate
    /// the sender.
    /// Cost: O(saved state), plus finding all pairs from scratch, plus a pass over all joints for each joint in
    /// another order, plus a pass over all actions for each character.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes, btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase,
                                   const Returned& returned = {});

    [[nodiscard]] bool isEmpty() const noexcept;

    /// Returns the bytes held, including unused capacity.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    struct Image;
    std::unique_ptr<Image> image_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
