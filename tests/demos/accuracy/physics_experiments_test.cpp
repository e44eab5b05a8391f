// SPDX-License-Identifier: Zlib
//
// The experiments with dynamics, at a tiny size.

#include <demos/accuracy/physics/physics_experiments.hpp>
#include <tests/demos/accuracy/experiment_faults.hpp>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

namespace hashphase::demos {
namespace {

Findings trajectories(const std::vector<PhysicsBroadphase>& broadphases = physicsBroadphases()) {
    std::vector<PhysicsScene> scenes = physicsScenes();
    std::erase_if(scenes, [](const PhysicsScene& scene) {
        return scene.name != "lattice" && scene.name != "compounds" && scene.name != "churn";
    });
    for (PhysicsScene& scene : scenes) {
        scene.quickObjects = 27;
    }
    return compareTrajectories(broadphases, scenes, {80, 1, true}, ignoreProgress);
}

Findings timeSteps(const std::vector<PhysicsContestant>& contestants = timeStepContestants()) {
    std::vector<PhysicsTask> tasks = physicsTasks();
    std::erase_if(
        tasks, [](const PhysicsTask& task) { return task.name != "roll" && task.name != "fall"; });
    return measureTimeSteps(tasks, contestants, {{1, 2}, {5}, 8, 1}, ignoreProgress);
}

/// btSimpleBroadphase, but once, as soon as bodies touch, it forgets a pair of such bodies. It finds
/// the pair again in the next step.
class Forgetful : public btSimpleBroadphase {
public:
    explicit Forgetful(btOverlappingPairCache* cache) : btSimpleBroadphase(1000, cache) {}

    void calculateOverlappingPairs(btDispatcher* dispatcher) override {
        btSimpleBroadphase::calculateOverlappingPairs(dispatcher);
        for (int i = 0; i < dispatcher->getNumManifolds() && !hasForgotten_; ++i) {
            const btPersistentManifold& manifold = *dispatcher->getManifoldByIndexInternal(i);
            if (manifold.getNumContacts() > 0) {
                // A manifold knows its bodies, and so their proxies, as const only.
                const auto proxyOf = [](const btCollisionObject* body) {
                    return const_cast<btBroadphaseProxy*>(body->getBroadphaseHandle());
                };
                getOverlappingPairCache()->removeOverlappingPair(
                    proxyOf(manifold.getBody0()), proxyOf(manifold.getBody1()), dispatcher);
                hasForgotten_ = true;
            }
        }
    }

private:
    bool hasForgotten_ = false;
};

const PhysicsBroadphase kForgetful{
    "forgetful", true, true, [](PairCache* cache) { return std::make_unique<Forgetful>(cache); }};

Findings trajectoriesOfForgetful() {
    std::vector<PhysicsBroadphase> broadphases = physicsBroadphases();
    broadphases.front() = kForgetful;
    return trajectories(broadphases);
}

Findings timeStepsOfForgetful() {
    std::vector<PhysicsContestant> contestants = timeStepContestants();
    contestants.front().broadphase = kForgetful;
    return timeSteps(contestants);
}

// The errors are those of the world, not of the measure: the fall is no longer what theory says.
Findings timeStepsWithHalfTheGravity() {
    const std::vector<PhysicsTask> tasks = physicsTasks();
    PhysicsTask fall = *std::ranges::find(tasks, "fall", &PhysicsTask::name);
    fall.fill = [fill = fall.fill](WorldContents& contents, std::uint64_t seed) {
        contents.world().setGravity(btVector3(0, -5, 0));
        fill(contents, seed);
    };
    return measureTimeSteps(std::span(&fall, 1), timeStepContestants(), {{1}, {}, 7, 1},
                            ignoreProgress);
}

TEST(PhysicsExperiments, HoldForEveryBroadphase) {
    expectHold({{"P7", timeSteps(), {2, 0, 0, 0}}, {"P8", trajectories(), {2, 0, 0, 0}}});
}

TEST(PhysicsExperiments, NoticeAnEngineThatMovesBodiesOtherwise) {
    expectNoticed({
        {"a pair is forgotten for a step", trajectoriesOfForgetful, {"forgetful"}},
        {"a pair is forgotten for a step", timeStepsOfForgetful, {"curves coincide"}},
        {"bodies fall otherwise", timeStepsWithHalfTheGravity, {"Free fall"}},
    });
}

}  // namespace
}  // namespace hashphase::demos
