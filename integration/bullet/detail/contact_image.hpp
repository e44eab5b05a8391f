// SPDX-License-Identifier: Zlib
#pragma once

// The contacts of a world as they were at some time: which manifolds the algorithms of its pairs own, how the
// dispatcher lists them, and what they hold. For WorldSnapshot.
//
// Algorithms cannot be copied. Where one is gone, Bullet's dispatcher makes another one, which is given the
// manifolds that the former had. Those of Bullet keep nothing else, but for those of compound shapes, which keep
// one for each child, or each pair of children, that is near.

#include <broadphase/core/byte_stream.hpp>
#include <broadphase/core/roomy_list.hpp>
#include <integration/bullet/detail/bullet_classes.hpp>
#include <integration/bullet/detail/object_numbers.hpp>
#include <integration/bullet/precision.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>
#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

struct btCollisionObjectWrapper;

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {

/// Frees the algorithm, if there is one. Nobody is told that its contacts have ended.
void freeQuietly(btCollisionAlgorithm* algorithm, btDispatcher* dispatcher);

[[nodiscard]] inline const btCollisionObject& clientOf(const btBroadphaseProxy* proxy) {
    return *static_cast<const btCollisionObject*>(proxy->m_clientObject);
}

/// The two objects of a pair.
struct ObjectPair {
    const btCollisionObject* a;
    const btCollisionObject* b;
};

class ContactImage {
public:
    /// Begins to save.
    void begin();
    /// Adds an algorithm between two clients, or none.
    void save(const btBroadphasePair& pair);
    /// Adds one that only waits to be freed.
    void saveRetired(btCollisionAlgorithm& algorithm);
    /// Adds manifolds that no algorithm owns.
    void save(const btAlignedObjectArray<btPersistentManifold*>& manifolds);
    /// All algorithms have been added. Says what is left over; empty when nothing is.
    [[nodiscard]] std::string end(const btCollisionDispatcher& dispatcher);

    /// So that beginRestore() takes no memory.
    void makeRoom() const;
    /// Begins to restore: where the dispatcher has one for each that was added, in their order.
    void beginRestore() const;
    /// The algorithm that was added, in its order, from the one that is there now, or null.
    [[nodiscard]] btCollisionAlgorithm* restore(btCollisionAlgorithm* present,
                                                const btBroadphasePair& pair,
                                                btCollisionDispatcher& dispatcher) const;
    [[nodiscard]] btCollisionAlgorithm* restoreRetired(btCollisionDispatcher& dispatcher) const;
    void restore(btAlignedObjectArray<btPersistentManifold*>& manifolds,
                 btCollisionDispatcher& dispatcher) const;
    void endRestore(btCollisionDispatcher& dispatcher) const;

    /// Writes it; bodies by their numbers among these.
    void write(ByteWriter& to, const ObjectNumbers& numbers) const;
    /// Reads what was written of such pairs, and one list of manifolds behind them. Returns whether that can be:
    /// algorithms of compound shapes have their children, and each manifold has one owner, whose objects it has.
    [[nodiscard]] bool read(ByteReader& from, std::span<btCollisionObject* const> objects,
                            std::span<const ObjectPair> pairs);

    [[nodiscard]] std::size_t memoryBytes() const noexcept;

private:
    /// A manifold but for its points.
    struct Head {
        const btCollisionObject* bodies[2];
        btScalar breakingThreshold;
        btScalar processingThreshold;
        int companions[2];
        int place;  // in the dispatcher's list
        int pointCount;
    };
    class Writer;
    class Builder;
    class Checker;

    [[nodiscard]] bool isOfKind(const btCollisionAlgorithm& algorithm, AlgorithmKind kind);
    static void fill(btPersistentManifold& manifold, const Head& head,
                     const btManifoldPoint* points);

    // Fetched while others are copied: more would be more than processors fetch at a time.
    static constexpr std::size_t kManifoldsAhead = 2;

    // How many manifolds algorithms own; of a compound's, first how many children it has, then for each whether it
    // has one, and that.
    std::vector<int> owned_;
    std::vector<Head> heads_;  // in the order of their owners
    RoomyList<btManifoldPoint> points_;

    // Scratch.
    std::string fault_;
    std::array<std::vector<const void*>, 3> knownTables_;   // of algorithms of each kind: few
    mutable std::size_t at_ = 0;                            // in owned_
    mutable std::vector<btPersistentManifold*> manifolds_;  // as heads_; null where none was made
};

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
