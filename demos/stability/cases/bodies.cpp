// SPDX-License-Identifier: Zlib
//
// Bodies in a world: that the pairs are right shows in what becomes of them.

#include <demos/stability/bullet_subject.hpp>

#include <demos/stability/physics_cases.hpp>
#include <integration/bullet/conversions.hpp>

#include <btBulletDynamicsCommon.h>

#include <array>
#include <string_view>

namespace hashphase::demos {
namespace {

using Run = CaseRun<btScalar>;

// --- A body that is too large for Bullet ----------------------------------------------------------

struct SmallWorld {
    explicit SmallWorld(const Run& run)
        : subject(run.make({makeBox<btScalar>(-1000, -1000, -1000, 1000, 1000, 1000), 16})),
          world(&dispatcher, &broadphaseOf(*subject), &solver, &configuration) {
        world.setGravity({0, 0, 0});
    }

    ~SmallWorld() {
        for (const std::unique_ptr<btRigidBody>& body : bodies) {
            world.removeRigidBody(body.get());
        }
    }
    SmallWorld(const SmallWorld&) = delete;
    SmallWorld& operator=(const SmallWorld&) = delete;

    btRigidBody& add(btScalar mass, btScalar halfExtent, const btVector3& at) {
        shapes.push_back(
            std::make_unique<btBoxShape>(btVector3(halfExtent, halfExtent, halfExtent)));
        btVector3 inertia(0, 0, 0);
        if (mass > 0) {
            shapes.back()->calculateLocalInertia(mass, inertia);
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes.back().get(), inertia);
        info.m_startWorldTransform.setOrigin(at);
        bodies.push_back(std::make_unique<btRigidBody>(info));
        bodies.back()->setUserIndex(static_cast<int>(bodies.size()) - 1);
        world.addRigidBody(bodies.back().get());
        return *bodies.back();
    }

    void step() {
        world.stepSimulation(btScalar(1 / 60.0F), 0);
        world.performDiscreteCollisionDetection();
    }

    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher{&configuration};
    btSequentialImpulseConstraintSolver solver;
    std::unique_ptr<Subject<btScalar>> subject;
    btDiscreteDynamicsWorld world;
    std::vector<std::unique_ptr<btBoxShape>> shapes;
    std::vector<std::unique_ptr<btRigidBody>> bodies;
};

// The pairs in the cache against those of the boxes that the proxies have, of which one at least moves.
void judgeWorld(const SmallWorld& world, Run& run) {
    btBroadphaseInterface& broadphase = broadphaseOf(*world.subject);
    Boxes<btScalar> boxes;
    for (const std::unique_ptr<btRigidBody>& body : world.bodies) {
        btVector3 low, high;
        broadphase.getAabb(body->getBroadphaseHandle(), low, high);
        boxes.push_back(toAabb(low, high));
    }
    Keys exact = touchingPairs(boxes);
    std::erase_if(exact, [&](PairKey pair) {
        return world.bodies[firstOf(pair)]->isStaticObject() &&
               world.bodies[secondOf(pair)]->isStaticObject();
    });
    run.compare(pairsIn(*broadphase.getOverlappingPairCache(),
                        [](const btBroadphaseProxy& proxy) {
                            const auto* body =
                                static_cast<const btCollisionObject*>(proxy.m_clientObject);
                            return static_cast<std::uint32_t>(body->getUserIndex());
                        }),
                exact);
}

void bodyBeyondBullet(Run& run) {
    SmallWorld world(run);
    for (int i = 0; i < 5; ++i) {
        world.add(1, btScalar(0.6F), {static_cast<btScalar>(i), 0, 0});
    }
    const btRigidBody& still = world.add(0, 6e5F, {0, -6.1e5F, 0});
    const btRigidBody& giant = world.add(1, 6e5F, {0, 6.1e5F, 0});
    for (int step = 0; step < 3; ++step) {
        world.step();
        judgeWorld(world, run);
    }
    run.expect(giant.getActivationState() == DISABLE_SIMULATION, "Bullet disables the large body");
    run.expect(still.getActivationState() != DISABLE_SIMULATION,
               "Bullet keeps the large static body");
    if (run.isOurs) {
        // Bullet's bound is a diagonal of 1e6 m.
        const btRigidBody& large = world.add(1, 2.8e5F, {2e6F, 0, 0});
        world.step();
        judgeWorld(world, run);
        run.expect(large.getActivationState() != DISABLE_SIMULATION,
                   "Bullet keeps a body just below its size limit");
    }
}

// --- Hard worlds ----------------------------------------------------------------------------------

// The broadphase of physics_cases.hpp that is meant; nullptr where there is none.
const PhysicsBroadphase* find(const std::vector<PhysicsBroadphase>& all, const Run& run) {
    // In the order that hardBroadphases() promises.
    static constexpr std::array<std::string_view, 6> kNames{
        "hash", "simple", "dbvt", "dbvt-deferred", "", "axis-sweep"};
    const auto at = std::find(kNames.begin(), kNames.end(), run.name);
    const auto place = run.isOurs ? 0 : at - kNames.begin();
    return place < static_cast<std::ptrdiff_t>(all.size()) ? &all[static_cast<std::size_t>(place)]
                                                           : nullptr;
}

std::string story(const PhysicsOutcome& outcome) {
    const double millimetres = outcome.worstPenetration * 1000;
    return outcome.scene + ": penetration at most " + rounded(millimetres, 1) + " mm, " +
           (outcome.settleStep < 0
                ? "not asleep at the end"
                : "asleep after " + std::to_string(outcome.settleStep) + " steps") +
           ", energy +" + rounded(outcome.energyDrift, 2) + " J.";
}

// The worlds with these names, over the broadphase in question, btSimpleBroadphase and btDbvtBroadphase.
void runWorlds(Run& run, std::initializer_list<std::string_view> names, int quickSize) {
    for (HardWorld world : hardWorlds()) {
        if (std::find(names.begin(), names.end(), world.name) == names.end()) {
            continue;
        }
        const int steps = run.isQuick ? std::min(world.steps, 400) : world.steps;
        world.size = run.isQuick ? std::min(world.size, quickSize) : world.size;
        const std::vector<PhysicsBroadphase> all = hardBroadphases(world);
        const PhysicsBroadphase* asked = find(all, run);
        if (asked == nullptr) {
            return;
        }
        std::vector<PhysicsOutcome> outcomes = runPhysicsCase(world, steps, std::array{*asked});
        {
            const LimitPause pause;
            const std::vector<PhysicsOutcome> others =
                runPhysicsCase(world, steps, std::array{all[1], all[2]});
            outcomes.insert(outcomes.end(), others.begin(), others.end());
        }
        run.expect(outcomes[0].trajectoryHash == outcomes[1].trajectoryHash,
                   world.name + ": every body moves as under btSimpleBroadphase");
        if (run.isOurs) {
            for (const std::string& fault : faultsOf(outcomes[0], outcomes)) {
                run.expect(false, world.name + ": hashphase has no fault (" + fault + ")");
            }
        }
        run.note(story(outcomes[0]));
    }
}

void piles(Run& run) {
    runWorlds(run, {"tower", "pyramid", "cards"}, 4);
}

void massRatios(Run& run) {
    runWorlds(run, {"heavy-100", "heavy-1000"}, 4);
}

constexpr HardCase kBodyCases[] = {
    {"H4", "a dynamic body of 1.2e6 m",
     "a world of five small bodies, a static body of 1.2e6 m and a dynamic body of 1.2e6 m; three "
     "steps",
     "Bullet disables the large dynamic body, as under any broadphase, and keeps the static body; "
     "exact pairs",
     bodyBeyondBullet},
    {"H36", "a tower, a pyramid, a house of cards",
     "three worlds, for as many steps as their bodies need to fall asleep (--quick: small worlds, "
     "400 steps); the order of the pair lists depends only on the pairs",
     "every body moves as under btSimpleBroadphase, bit for bit, and falls asleep no later than "
     "under btDbvtBroadphase",
     piles},
    {"H37", "heavy bodies on light ones",
     "mass ratios of 100 and 1,000, the heavy bodies on top; pair lists in the order of H36",
     "every body moves as under btSimpleBroadphase, bit for bit: all errors are the solver's",
     massRatios},
};

}  // namespace

std::span<const HardCase> bodyCases() {
    return kBodyCases;
}

}  // namespace hashphase::demos
