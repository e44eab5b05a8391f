// SPDX-License-Identifier: Zlib
//
// Worlds that go back in time, and take the same steps again.

#include <demos/stability/bullet_subject.hpp>

#include <demos/stability/physics_cases.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/bullet/world_snapshot.hpp>

#include <btBulletDynamicsCommon.h>

#include <array>
#include <string>
#include <string_view>

namespace hashphase::demos {
namespace {

using Run = CaseRun<btScalar>;

/// A hard world over ours; lists are in Bullet's own order.
struct RolledWorld {
    explicit RolledWorld(const HardWorld& hard)
        : physics(hardBroadphases(hard).front(), ListOrder::asShipped) {
        const auto offset = static_cast<btScalar>(hard.offset);
        hard.fill(physics.contents(), btVector3(offset, offset, offset), hard.size);
    }

    /// Returns the state after it.
    std::uint64_t step() {
        physics.step(btScalar(1) / 60);
        return stateHash(physics.contents());
    }
    void save(WorldSnapshot& snapshot, Run& run) {
        const std::string fault = snapshot.save(physics.world(), broadphase());
        run.expect(fault.empty(), "the world can be saved (" + fault + ")");
    }
    void restore(const WorldSnapshot& snapshot, const Returned& returned, Run& run) {
        const std::string fault = snapshot.restore(physics.world(), broadphase(), returned);
        run.expect(fault.empty(), "the world can be restored (" + fault + ")");
    }
    [[nodiscard]] SpatialHashBroadphase& broadphase() {
        return static_cast<SpatialHashBroadphase&>(*physics.world().getBroadphase());
    }

    PhysicsWorld physics;
};

/// Steps that were the same as the first time, as answers.
struct StepTally {
    void add(std::uint64_t state, std::uint64_t first) {
        const auto step = static_cast<std::uint32_t>(all.size());
        all.push_back(step);
        if (state == first) {
            equal.push_back(step);
        }
    }

    Objects all;
    Objects equal;
};

template <class Work>
void forEachWorld(const Run& run, std::initializer_list<std::string_view> names, int quickSize,
                  const Work& work) {
    for (HardWorld world : hardWorlds()) {
        if (std::find(names.begin(), names.end(), world.name) != names.end()) {
            world.size = run.isQuick ? std::min(world.size, quickSize) : world.size;
            work(world);
        }
    }
}

// --- Netcode --------------------------------------------------------------------------------------

void eightStepsBack(Run& run) {
    if (!run.isOurs) {
        return;
    }
    constexpr std::size_t kBack = 8;
    forEachWorld(run, {"tower", "ragdolls", "bullets-stop", "bullets-pass"}, 8,
                 [&](const HardWorld& hard) {
                     const int steps = run.quickOrFull(60, 200);
                     RolledWorld straight(hard);
                     RolledWorld rolled(hard);
                     std::array<WorldSnapshot, kBack> ring;
                     StepTally tally;
                     for (std::size_t step = 0; step < static_cast<std::size_t>(steps); ++step) {
                         if (step >= kBack) {
                             rolled.restore(ring[step % kBack], {}, run);
                             for (std::size_t again = step - kBack; again < step; ++again) {
                                 rolled.save(ring[again % kBack], run);
                                 rolled.step();
                             }
                         }
                         rolled.save(ring[step % kBack], run);
                         tally.add(rolled.step(), straight.step());
                     }
                     run.compare(tally.equal, tally.all);
                 });
}

// --- Disturbed, and put back ----------------------------------------------------------------------

/// Throws bodies about, wakes some and stops others, changes friction and gravity; takes some out of the world, of
/// which every second one is put back, at the end of the list.
struct Disturbance {
    Disturbance(RolledWorld& rolled, Random& random) : world(rolled.physics.world()) {
        for (const auto& body : rolled.physics.contents().bodies()) {
            const float kind = random.unit();
            const btVector3 way(random.between(-5, 5), random.between(-5, 5),
                                random.between(-5, 5));
            if (kind < 0.3F) {
                body->activate(true);
                body->setLinearVelocity(way);
            } else if (kind < 0.5F) {
                body->forceActivationState(ISLAND_SLEEPING);
            } else if (kind < 0.6F) {
                body->setCenterOfMassTransform(
                    btTransform(btQuaternion(way, 1), body->getWorldTransform().getOrigin() + way));
            } else if (kind < 0.7F) {
                body->setFriction(random.unit());
            } else if (body->getNumConstraintRefs() == 0) {
                world.removeRigidBody(body.get());
                removed.push_back(body.get());
            }
        }
        for (std::size_t i = 0; i < removed.size(); i += 2) {
            world.addRigidBody(btRigidBody::upcast(removed[i]));
        }
        if (world.getNumConstraints() > 0) {
            joints.push_back(world.getConstraint(world.getNumConstraints() / 2));
            world.removeConstraint(joints.back());
        }
        world.setGravity(btVector3(random.between(-9, 9), 0, 0));
    }
    [[nodiscard]] Returned returned() const { return {.objects = removed, .joints = joints}; }

    btDiscreteDynamicsWorld& world;
    std::vector<btCollisionObject*> removed;
    std::vector<btTypedConstraint*> joints;
};

void disturbedWorlds(Run& run) {
    if (!run.isOurs) {
        return;
    }
    constexpr int kBefore = 100;
    constexpr int kBetween = 30;
    const int again = run.quickOrFull(30, 60);
    const int rounds = run.quickOrFull(3, 10);
    forEachWorld(run, {"pyramid", "cards", "chain", "ragdolls", "heavy-1000"}, 4,
                 [&](const HardWorld& hard) {
                     for (const double offset : {kHardOffsets.front(), kHardOffsets.back()}) {
                         RolledWorld world(movedTo(offset, hard));
                         world.physics.step(btScalar(1) / 60, kBefore);
                         WorldSnapshot snapshot;
                         world.save(snapshot, run);
                         std::vector<std::uint64_t> first;
                         for (int step = 0; step < again; ++step) {
                             first.push_back(world.step());
                         }
                         Random random(run.seed);
                         StepTally tally;
                         for (int round = 0; round < rounds; ++round) {
                             const Disturbance disturbance(world, random);
                             world.physics.step(btScalar(1) / 60, kBetween);
                             world.restore(snapshot, disturbance.returned(), run);
                             for (const std::uint64_t state : first) {
                                 tally.add(world.step(), state);
                             }
                         }
                         run.compare(tally.equal, tally.all);
                     }
                 });
}

constexpr HardCase kWorldRollbackCases[] = {
    {"H47", "eight steps back before each step",
     "a tower, ragdolls on each other, bullets at walls that stop them, bullets that fly through "
     "walls and touch them; 200 steps (--quick: small worlds, 60 steps). From the ninth step on, "
     "the world goes back by eight steps before each step, takes them again and saves them again",
     "after every step, the state of a world that never goes back, bit for bit", eightStepsBack},
    {"H48", "disturbed worlds, restored",
     "a pyramid, a house of cards, a chain, ragdolls, mass ratios of 1,000; at the origin, and 16 "
     "km away along each axis; saved after 100 steps. Ten times (--quick: 3 times), bodies are "
     "thrown, stopped, moved and removed, a joint is removed, and gravity changes; after 30 steps, "
     "the world is restored",
     "the next 60 steps (--quick: 30) have the same states as the first time, bit for bit",
     disturbedWorlds},
};

}  // namespace

std::span<const HardCase> worldRollbackCases() {
    return kWorldRollbackCases;
}

}  // namespace hashphase::demos
