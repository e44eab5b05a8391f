// SPDX-License-Identifier: Zlib
#include <demos/stability/physics_cases.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <BulletCollision/BroadphaseCollision/btAxisSweep3.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <algorithm>
#include <memory>
#include <string_view>

namespace hashphase::demos {
namespace {

constexpr unsigned short kMostProxies = 1024;
constexpr double kReach = 128;  // of a world, from its middle [m]

PhysicsBroadphase sweepingHash() {
    PhysicsBroadphase broadphase = physicsBroadphase(kHashName);
    broadphase.make = [](PairCache* cache) {
        SpatialHashConfig config;
        config.sweep = Sweep::automatic;
        return std::make_unique<SpatialHashBroadphase>(cache, config);
    };
    return broadphase;
}

std::unique_ptr<btBroadphaseInterface> makeDeferredDbvt(PairCache* cache) {
    auto broadphase = std::make_unique<btDbvtBroadphase>(cache);
    broadphase->m_deferedcollide = true;
    return broadphase;
}

template <class AxisSweep>
std::unique_ptr<btBroadphaseInterface> makeSweepWithin(PairCache* cache, double halfSide) {
    const auto side = static_cast<btScalar>(halfSide);
    const btVector3 corner(side, side, side);
    return std::make_unique<AxisSweep>(-corner, corner, kMostProxies, cache, true);
}

/// Whether a step is later than another; -1 is never.
bool isLater(int step, int than) {
    return than >= 0 && (step < 0 || step > than);
}

const PhysicsOutcome* find(std::span<const PhysicsOutcome> all, std::string_view broadphase) {
    const auto at = std::find_if(all.begin(), all.end(), [broadphase](const PhysicsOutcome& each) {
        return each.broadphase == broadphase;
    });
    return at == all.end() ? nullptr : &*at;
}

}  // namespace

std::vector<PhysicsBroadphase> hardBroadphases(const HardWorld& world) {
    const double halfSide = world.offset + kReach;
    return {
        world.bullets == Bullets::pass ? sweepingHash() : physicsBroadphase(kHashName),
        physicsBroadphase(kSimpleName),
        physicsBroadphase(kDbvtName),
        {std::string(kDbvtName) + ", deferred", false, false, makeDeferredDbvt},
        {"btAxisSweep3", false, false,
         [halfSide](PairCache* cache) { return makeSweepWithin<btAxisSweep3>(cache, halfSide); }},
        {"bt32BitAxisSweep3", false, false,
         [halfSide](PairCache* cache) {
             return makeSweepWithin<bt32BitAxisSweep3>(cache, halfSide);
         }},
    };
}

std::vector<PhysicsOutcome> runPhysicsCase(const HardWorld& world, int steps,
                                           std::span<const PhysicsBroadphase> broadphases) {
    std::vector<PhysicsOutcome> outcomes;
    for (const PhysicsBroadphase& broadphase : broadphases) {
        HardRun run(world, broadphase, ListOrder::canonicalByUniqueId);
        for (int i = 0; i < steps; ++i) {
            run.step();
        }
        outcomes.push_back(run.outcome());
    }
    return outcomes;
}

std::vector<PhysicsOutcome> runPhysicsCase(const HardWorld& world, int steps) {
    return runPhysicsCase(world, steps, hardBroadphases(world));
}

std::vector<std::string> faultsOf(const PhysicsOutcome& ours, std::span<const PhysicsOutcome> all) {
    std::vector<std::string> faults;
    const auto check = [&](bool holds, const char* fault) {
        if (!holds) {
            faults.emplace_back(fault);
        }
    };
    if (const PhysicsOutcome* const exact = find(all, kSimpleName)) {
        check(ours.trajectoryHash == exact->trajectoryHash,
              "Bodies move differently than under btSimpleBroadphase.");
    }
    if (const PhysicsOutcome* const dbvt = find(all, kDbvtName)) {
        check(!isLater(ours.settleStep, dbvt->settleStep) &&
                  ours.sleepingBodySteps >= dbvt->sleepingBodySteps,
              "Bodies fall asleep later than under btDbvtBroadphase.");
    }
    const bool isFewest = std::all_of(all.begin(), all.end(), [&](const PhysicsOutcome& each) {
        return ours.tunnelled <= each.tunnelled;
    });
    check(isFewest, "More bullets pass through walls than under another broadphase.");
    return faults;
}

}  // namespace hashphase::demos
