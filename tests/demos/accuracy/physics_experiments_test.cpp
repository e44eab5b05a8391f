// SPDX-License-Identifier: Zlib
//
// The experiments with dynamics, at a tiny size: that their checks hold, and that they notice a method that
// is broken.

#include <demos/accuracy/physics/time_step_experiment.hpp>
#include <demos/accuracy/physics/trajectory_experiment.hpp>

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace hashphase::demos {
namespace {

const TellProgress kTellNobody = [](double, std::string_view) {};

/// Claims and evidence of the checks that do not hold, a line each.
std::string broken(const Findings& findings) {
    std::string text;
    for (const Check& check : findings.checks) {
        text += check.holds ? "" : check.claim + " (" + check.evidence + ")\n";
    }
    return text;
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
                auto* a =
                    const_cast<btBroadphaseProxy*>(manifold.getBody0()->getBroadphaseHandle());
                auto* b =
                    const_cast<btBroadphaseProxy*>(manifold.getBody1()->getBroadphaseHandle());
                getOverlappingPairCache()->removeOverlappingPair(a, b, dispatcher);
                hasForgotten_ = true;
            }
        }
    }

private:
    bool hasForgotten_ = false;
};

PhysicsBroadphase forgetful() {
    return {"forgetful", true, true,
            [](PairCache* cache) { return std::make_unique<Forgetful>(cache); }};
}

// --- P8 ---------------------------------------------------------------------------------------------

constexpr TrajectorySettings kFewSteps{80, 1, true};

std::vector<PhysicsScene> smallScenes() {
    std::vector<PhysicsScene> scenes = physicsScenes();
    std::erase_if(scenes, [](const PhysicsScene& scene) {
        return scene.name != "lattice" && scene.name != "compounds" && scene.name != "churn";
    });
    for (PhysicsScene& scene : scenes) {
        scene.quickObjects = 27;
    }
    return scenes;
}

TEST(TrajectoryExperiment, FindsThatExactBroadphasesMoveBodiesAlike) {
    const Findings findings =
        compareTrajectories(physicsBroadphases(), smallScenes(), kFewSteps, kTellNobody);
    EXPECT_EQ(broken(findings), "");
    EXPECT_EQ(findings.checks.size(), 2U);
}

TEST(TrajectoryExperiment, NoticesAPairThatIsForgottenForOneStep) {
    std::vector<PhysicsBroadphase> broadphases = physicsBroadphases();
    broadphases.front() = forgetful();
    const Findings findings =
        compareTrajectories(broadphases, smallScenes(), kFewSteps, kTellNobody);
    EXPECT_NE(broken(findings).find("forgetful"), std::string::npos);
}

// --- P7 ---------------------------------------------------------------------------------------------

Findings timeSteps(const std::vector<PhysicsContestant>& contestants) {
    std::vector<PhysicsTask> tasks = physicsTasks();
    std::erase_if(
        tasks, [](const PhysicsTask& task) { return task.name != "roll" && task.name != "fall"; });
    return measureTimeSteps(tasks, contestants, {{1, 2}, {5}, 8, 1}, kTellNobody);
}

TEST(TimeStepExperiment, FindsThatTheBroadphaseChangesNothing) {
    const Findings findings = timeSteps(timeStepContestants());
    EXPECT_EQ(broken(findings), "");
    EXPECT_EQ(findings.checks.size(), 2U);
}

TEST(TimeStepExperiment, NoticesAPairThatIsForgottenForOneStep) {
    std::vector<PhysicsContestant> contestants = timeStepContestants();
    contestants.front().broadphase = forgetful();
    EXPECT_NE(broken(timeSteps(contestants)).find("curves coincide"), std::string::npos);
}

// The errors are those of the world, not of the measure: with half the gravity the fall is no longer
// what theory says.
TEST(TimeStepExperiment, NoticesAnEngineThatFallsOtherwise) {
    std::vector<PhysicsTask> tasks = physicsTasks();
    std::erase_if(tasks, [](const PhysicsTask& task) { return task.name != "fall"; });
    const auto fill = tasks.front().fill;
    tasks.front().fill = [fill](WorldContents& contents, std::uint64_t seed) {
        contents.world().setGravity(btVector3(0, -5, 0));
        fill(contents, seed);
    };
    const Findings findings =
        measureTimeSteps(tasks, timeStepContestants(), {{1}, {}, 7, 1}, kTellNobody);
    EXPECT_NE(broken(findings).find("Free fall"), std::string::npos);
}

}  // namespace
}  // namespace hashphase::demos
