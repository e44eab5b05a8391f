// SPDX-License-Identifier: Zlib
#pragma once

// Saves a Bullet world over a SpatialHashBroadphase between two steps, and restores it: for rollback, replays,
// training and editors. The steps that follow give the same bits as before.
//
//     WorldSnapshot snapshot;
//     std::string fault = snapshot.save(world, broadphase);     // empty: all is well
//     ...                                                       // steps, bodies that come and go
//     fault = snapshot.restore(world, broadphase);
//
// Saved     All of Bullet's state that a step depends on: objects and their ignored objects, contacts with
//           impulses, joints with motors and limits, ghosts, characters, gravity, solver settings and seed, the
//           remaining time of a step, the order of pairs and contacts, and the broadphase with grid, pairs and
//           sweeps.
// Not saved User pointers and indices, joint feedback, debug colours, fields of derived classes. Of shapes, only
//           which one an object has. Motion states: restore() sets those of dynamic bodies; put back those of
//           kinematic bodies.
// Refused   Soft bodies, multibodies, worlds of a WorldsBroadphase, pair caches other than PairCache, actions other
//           than btKinematicCharacterController (as btRaycastVehicle), contact points with user data, contact
//           manifolds of the program's own, joints of unknown types, compound shapes changed since the last step,
//           collision algorithms outside Bullet's default configuration (as btGImpactCollisionAlgorithm),
//           dispatchers not derived from btCollisionDispatcher, solvers not derived from
//           btSequentialImpulseConstraintSolver. The returned sentence names the fault.
// RTTI      Without it, in Bullet or here: all actions are refused; multibodies are refused only by their
//           colliders; pairs of a btPairCachingGhostObject, and the angle that a btHingeAccumulatedAngleConstraint
//           counts, are not saved.
// Added     restore() takes objects, joints and characters out of the world that were added after save(). They
//           remain the caller's.
// Removed   Hand over objects, joints and characters that were removed after save() (Returned): they are in the
//           world again. Otherwise restore() names a missing one, and changes nothing. One that was added again
//           need not be handed over, unless it has another shape now: it might be another object at the same
//           address.
// Ids       m_uniqueId and ProxyId are as saved. Ids given after save() are given again.
// Pointers  A proxy that lives from save() to restore() keeps its address. Otherwise, and after read(), call
//           getBroadphaseHandle() again. Pointers to pairs, algorithms, manifolds and contact points are void after
//           restore().
// One world A snapshot belongs to the world that it was saved from, or read for. Its bytes reach other worlds.
// Lifetime  Shapes must live as long as a snapshot in which an object has them. Compound shapes must be as saved.
// Callbacks restore() calls contact and ghost callbacks only for objects that it takes out, as
//           removeCollisionObject() does.
// Calls     Call save() and restore() between steps. They refuse calls within callbacks of the broadphase or its
//           cache. Never call them in tick callbacks or motion states: this is not detected, and forces of the step
//           count twice.
// Memory    Saving again takes none in a frame like the last one. Throws std::bad_alloc when memory runs out:
//           save() leaves the snapshot empty, restore() has changed nothing.
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

/// Removed objects, joints and actions that are handed over, to go back into the world.
struct Returned {
    std::span<btCollisionObject* const> objects{};
    std::span<btTypedConstraint* const> joints{};
    std::span<btActionInterface* const> actions{};
};

/// Saves a world, and puts it back.
class HASHPHASE_BULLET_EXPORT WorldSnapshot {
public:
    WorldSnapshot() noexcept;
    ~WorldSnapshot();
    WorldSnapshot(WorldSnapshot&& other) noexcept;
    WorldSnapshot& operator=(WorldSnapshot&& other) noexcept;

    /// Saves the world, which has this broadphase. Returns an empty string, or the fault; the snapshot is then
    /// empty. Cost: a pass over objects, pairs and contacts.
    [[nodiscard]] std::string save(btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase);

    /// Puts the world back to the saved state, any number of times, from any of several snapshots. Returns an empty
    /// string, or the fault; then nothing has changed. Cost: as save(), and removing added objects and making
    /// algorithms for pairs that were not there.
    [[nodiscard]] std::string restore(btDiscreteDynamicsWorld& world,
                                      SpatialHashBroadphase& broadphase,
                                      const Returned& returned = {}) const;

    /// Replaces `bytes` by the snapshot, to send or to keep, with a version and a checksum. Returns an empty
    /// string, or the fault; `bytes` is then empty. Faults: an ignored object, a joint of a body, a body of a
    /// joint, the ghost of a character, or the object of a proxy is not in the world; or algorithms of removed
    /// pairs wait to be freed: then save after the next step.
    /// Numbers have the format of this processor, Bullet and compiler. Both sides must have an equal
    /// SpatialHashConfig (except parallelFor), and equal settings of the solver and of collision detection, which
    /// are not written. A world restored from bytes writes the same bytes again. Two equal worlds may write
    /// different bytes, because joints contain padding.
    /// Cost: O(saved state). In a world in contact, most bytes are contact points.
    [[nodiscard]] std::string write(std::vector<std::byte>& bytes) const;

    /// Takes the bytes that write() made of a world with the same objects, such as one that another computer built
    /// by the same calls. Finds objects by unique ids of proxies, joints by type and bodies, characters by ghosts.
    /// Hand over objects that are not in this world, in the order in which the fault names their ids. Objects keep
    /// their present shapes; build compound shapes by equally many calls. An id that matches by chance takes a
    /// wrong object, unless its type or the changes of its compound shape differ.
    /// Returns an empty string, or the fault; then nothing has changed. After success, call restore() with the same
    /// `returned`. With equal inputs, the steps that follow give the same bits as the writer's. Damaged bytes are
    /// refused. Forged bytes may put objects anywhere, but do no other harm: authenticate the sender.
    /// Cost: O(saved state), and finding all pairs from scratch. Each joint in another order, and each character,
    /// is searched for among all.
    [[nodiscard]] std::string read(std::span<const std::byte> bytes, btDiscreteDynamicsWorld& world,
                                   const SpatialHashBroadphase& broadphase,
                                   const Returned& returned = {});

    [[nodiscard]] bool isEmpty() const noexcept;

    /// Returns the bytes held, capacity included.
    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    struct Image;
    std::unique_ptr<Image> image_;
};

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
