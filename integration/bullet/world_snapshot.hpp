// SPDX-License-Identifier: Zlib
#pragma once

// A Bullet world over a SpatialHashBroadphase as it was after some step, to go back to: for rollback, replays,
// training and editors. The steps that follow give the same bits as they did.
//
//     WorldSnapshot snapshot;
//     std::string fault = snapshot.save(world, broadphase);     // empty: all is well
//     ...                                                       // steps, bodies that come and go
//     fault = snapshot.restore(world, broadphase);
//
// What is saved  Of objects all that a step depends on: places, velocities, forces, mass, damping, friction, flags,
//           activation, whom they ignore. Contacts with their impulses, and the order of pairs and contacts.
//           Joints with their motors, limits and impulses. Ghosts and characters. Gravity, the solver's settings
//           and its seed, the time that is left of a step. The broadphase, its grid, pairs and sweeps.
// What is not  What is the program's: user pointers and indices, joint feedback, debug colours, fields of classes
//           derived from Bullet's. Motion states of dynamic bodies are told where these are; those of kinematic
//           bodies tell it to Bullet, and are the program's to put back. Of shapes: only which one an object has.
// Refused   by a sentence that names it: soft bodies, multibodies, actions other than btKinematicCharacterController
//           (btRaycastVehicle is one), pair caches other than PairCache, contact points with user data, contact
//           manifolds of the program's own, collision algorithms other than those of Bullet's default configuration
//           (btGImpactCollisionAlgorithm is one), dispatchers other than btCollisionDispatcher and those derived from
//           it, solvers other than btSequentialImpulseConstraintSolver and those derived from it, joints of unknown
//           types, worlds of a WorldsBroadphase, compound shapes that have changed since the last step.
// RTTI      Without it, in Bullet or here, each action is refused, characters too; multibodies are refused only by
//           their colliders; pairs of a btPairCachingGhostObject, and the angle that a
//           btHingeAccumulatedAngleConstraint counts, are not saved.
// Who came  Objects, joints and characters that were added after save(): restore() takes them out of the world. They
//           are the caller's, to delete or to add again.
// Who went  Those that were removed after save(): the caller hands them over (Returned) and they are in the world
//           again; or restore() says which one is missing, and has changed nothing. What was removed and added
//           again is in the world, and need not be handed over, unless it came back with another shape: it might
//           be another object at the same address.
// Ids       m_uniqueId and ProxyId of a proxy are what they were. Those given after save() are given again.
// Pointers  A proxy that lives from save() to restore() keeps its address. Ask other objects again, by
//           getBroadphaseHandle(); after read() all of them. Pointers to pairs, algorithms, contact manifolds and
//           contact points are void after restore().
// One world A snapshot belongs to the world that it was saved from, or read for. As bytes it reaches another one.
// Lifetime  Shapes must live as long as a snapshot in which an object has them. Compound shapes must be as they were.
// Callbacks Contact callbacks are not told of contacts that come back or go, nor ghost callbacks of pairs, except
//           of pairs of objects that restore() takes out: these are told to both, as by removeCollisionObject().
// Order     Call save() and restore() between steps. Callbacks of the broadphase and of its cache are refused. Calls
//           from tick callbacks and motion states cannot be detected: never save or restore there. The forces of
//           the step are not cleared yet, and would count twice.
// Memory    Keeps its own: to save again takes none in a frame like the last one. Where it runs out, std::bad_alloc
//           is passed on: save() leaves the snapshot empty, restore() has changed nothing.
// Threads   Needs the world and this object for itself.

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

/// What was removed from a world, and is handed over to go back into it.
struct Returned {
    std::span<btCollisionObject* const> objects{};
    std::span<btTypedConstraint* const> joints{};
    std::span<btActionInterface* const> actions{};
};

/// Keeps a world, and puts it back.
class HASHPHASE_BULLET_EXPORT WorldSnapshot {
public:
    /// An empty one.
    WorldSnapshot() noexcept;
    ~WorldSnapshot();
    WorldSnapshot(WorldSnapshot&& other) noexcept;
    WorldSnapshot& operator=(WorldSnapshot&& other) noexcept;

    /// Saves the world, whose broadphase this is. Returns an empty string on success. Otherwise a sentence, and
    /// leaves the snapshot empty. Cost: a pass over objects, pairs and contacts.
    [[nodiscard]] std::string save(btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase);

    /// Puts the world back to what was saved of it. Returns an empty string on success. Otherwise a sentence, and
    /// changes nothing. Any number of times, and to any of several snapshots. Cost: as save(), and that of removing
    /// what was added and of making algorithms for pairs that were not there.
    [[nodiscard]] std::string restore(btDiscreteDynamicsWorld& world,
                                      SpatialHashBroadphase& broadphase,
                                      const Returned& returned = {}) const;

    /// Replaces what `bytes` held by the snapshot, to send or to keep. They begin with a version and a checksum.
    /// Returns an empty string on success. Otherwise a sentence, and leaves `bytes` empty: where something is not in
    /// the world that an object ignores, that a joint or a character links, or that a proxy stands for; and where
    /// algorithms of removed pairs wait to be freed, until the next step. Numbers are as this processor, this Bullet
    /// and this compiler have them. Settings of the solver and of collision detection are not written: both sides
    /// must have equal ones, and an equal SpatialHashConfig, but for parallelFor. A world restored from bytes writes
    /// the same bytes again. Two worlds in equal states may write different ones: the bytes of joints hold their
    /// padding.
    /// Cost: O(what is saved). In a world in contact most bytes are contact points.
    [[nodiscard]] std::string write(std::vector<std::byte>& bytes) const;

    /// Takes what write() made of a world with the same objects, such as one that another computer built by the same
    /// calls. Its objects are told by their proxies' unique ids, joints by their type and bodies, characters by their
    /// ghosts. Objects that are not in this world are handed over in the order in which the sentence names their ids.
    /// Shapes are those that objects have now; compound shapes were built by as many calls as the writer's. An id
    /// that matches by chance takes a wrong object, unless its type or the changes of its compound shape differ.
    /// Returns an empty string on success. Otherwise a sentence, and changes nothing. After success, restore() with
    /// the same `returned` puts the world to what was read. With equal inputs, the steps that follow give the same
    /// bits as the writer's. Damaged bytes are refused. Forged ones may be read: then objects may be anywhere, and
    /// nothing worse comes of it. Authenticate the sender.
    /// Cost: O(what is saved), and finding all pairs from scratch. Joints that the world lists in another order, and
    /// characters, are each looked for among all.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes, btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase,
                                   const Returned& returned = {});

    /// Whether there is nothing to restore.
    [[nodiscard]] bool isEmpty() const noexcept;

    /// Bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    struct Image;
    std::unique_ptr<Image> image_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
