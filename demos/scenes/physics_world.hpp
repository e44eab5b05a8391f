// SPDX-License-Identifier: Zlib
#pragma once

// Bullet worlds that differ in nothing but their broadphase and the order of their lists.

#include <demos/scenes/world_contents.hpp>

#include <integration/bullet/pair_cache.hpp>

#include <btBulletDynamicsCommon.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// In which order a world lists its pairs and its contacts. The solver goes through them in that
/// order, and so what comes out depends on it.
enum class ListOrder {
    asShipped,   // Bullet's: in which pairs came and went; the broadphase's own pair cache
    byUniqueId,  // the same with Bullet's m_deterministicOverlappingPairs
    canonical,   // pairs by the bodies' numbers, contacts by age: depends on the pair sets alone
    /// canonical, and contacts within an island by unique ids: contacts of bodies of one shape each
    /// come in the same order whatever pairs without contacts there are, while no body sleeps.
    canonicalByUniqueId,
};

[[nodiscard]] std::string_view titleOf(ListOrder order);

/// A broadphase as physics worlds are given it.
struct PhysicsBroadphase {
    std::string name;
    bool isOurs = false;
    bool isExact = false;  // its pairs are the overlapping boxes, neither more nor fewer, ever
    /// Over that pair cache; over one of its own where that is null.
    std::function<std::unique_ptr<btBroadphaseInterface>(PairCache* cache)> make;
};

inline constexpr std::string_view kHashName = "hashphase";
inline constexpr std::string_view kSimpleName = "btSimpleBroadphase";
inline constexpr std::string_view kDbvtName = "btDbvtBroadphase";
inline constexpr std::string_view kExactDbvtName = "btDbvtBroadphase, exact boxes";

/// Those of the four names, and bt32BitAxisSweep3.
[[nodiscard]] std::vector<PhysicsBroadphase> physicsBroadphases();

/// That of the name, which must be one of theirs.
[[nodiscard]] PhysicsBroadphase physicsBroadphase(std::string_view name);

/// A world over a broadphase, and what is in it.
class PhysicsWorld {
public:
    PhysicsWorld(const PhysicsBroadphase& broadphase, ListOrder order);

    [[nodiscard]] WorldContents& contents() noexcept { return contents_; }
    [[nodiscard]] const WorldContents& contents() const noexcept { return contents_; }
    [[nodiscard]] btDiscreteDynamicsWorld& world() noexcept { return world_; }

    /// Simulates so many steps of that length [s].
    void step(btScalar seconds, int steps = 1);

    /// Bodies that could move and sleep.
    [[nodiscard]] int sleepingCount() const;
    [[nodiscard]] int pairCount() const {
        return broadphase_->getOverlappingPairCache()->getNumOverlappingPairs();
    }

private:
    btDefaultCollisionConfiguration configuration_;
    std::unique_ptr<btCollisionDispatcher> dispatcher_;
    std::unique_ptr<PairCache> cache_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_;
    WorldContents contents_;
};

/// A number that is the same when place, velocities and activation of all bodies are the same to
/// the last bit, and else, as good as certainly, another one.
[[nodiscard]] std::uint64_t stateHash(const WorldContents& contents);

}  // namespace hashphase::demos
