// SPDX-License-Identifier: Zlib
//
// The experiments with dynamics and with distance, at a tiny size: that their checks hold, and that
// they notice a method that is broken.

#include <demos/accuracy/origin/origin_experiment.hpp>
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
    const TimeStepSettings settings{{1, 2}, {5}, 8, 1};
    const std::vector<TaskPoint> points = runTimeSteps(tasks, contestants, settings, kTellNobody);
    return judgeTimeSteps(tasks, contestants, points);
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
    const std::vector<PhysicsContestant> contestants = timeStepContestants();
    const std::vector<TaskPoint> points =
        runTimeSteps(tasks, contestants, {{1}, {}, 7, 1}, kTellNobody);
    const Findings findings = judgeTimeSteps(tasks, contestants, points);
    EXPECT_NE(broken(findings).find("Free fall"), std::string::npos);
}

// --- P6 ---------------------------------------------------------------------------------------------

/// Double precision, but the last pair and the first hit are lost.
class Lossy : public OriginWorld {
public:
    explicit Lossy(std::unique_ptr<OriginWorld> world) : world_(std::move(world)) {}

    void set(std::span<const WorldBox> boxes) override { world_->set(boxes); }
    void listPairs(std::vector<PairKey>& pairs) override {
        world_->listPairs(pairs);
        pairs.pop_back();
    }
    void listHits(const WorldRay& ray, std::vector<std::uint32_t>& boxes) override {
        world_->listHits(ray, boxes);
        if (!boxes.empty()) {
            boxes.pop_back();
        }
    }

private:
    std::unique_ptr<OriginWorld> world_;
};

Findings origin(const std::vector<OriginMethod>& methods,
                const std::vector<SettleMethod>& settling) {
    OriginSettings settings;
    settings.offsets = {0, 0x1p20, 0x1p30};
    settings.boxes = 150;
    settings.rays = 20;
    return judgeOrigin(methods, settling, settings,
                       runOrigin(methods, settling, settings, kTellNobody));
}

TEST(OriginExperiment, FindsTheSamePairsAtAnyDistance) {
    const Findings findings = origin(originMethods(), settleMethods());
    EXPECT_EQ(broken(findings), "");
    EXPECT_GT(findings.checks.size(), 10U);
}

TEST(OriginExperiment, NoticesALostPairAndALostHit) {
    std::vector<OriginMethod> methods = originMethods();
    const auto exact = std::find_if(methods.begin(), methods.end(),
                                    [](const OriginMethod& method) { return method.isExact; });
    const auto make = exact->make;
    exact->make = [make] { return std::make_unique<Lossy>(make()); };
    exact->name = "lossy";
    const std::string found = broken(origin(methods, settleMethods()));
    EXPECT_NE(found.find("lossy finds the same pairs at every distance ("), std::string::npos);
    EXPECT_NE(found.find("lossy misses no hit"), std::string::npos);
}

TEST(OriginExperiment, NoticesBallsThatRestElsewhereFarAway) {
    const std::vector<SettleMethod> settling = settleMethods();
    const OriginSettings settings{{0, 0x1p20}, 20, 2, 1};
    std::vector<OriginPoint> points = runOrigin(originMethods(), settling, settings, kTellNobody);
    // As if the origin had not been shifted.
    points.back().settled.back() = points.back().settled.front();
    const Findings findings = judgeOrigin(originMethods(), settling, settings, points);
    EXPECT_NE(broken(findings).find("origin shifted"), std::string::npos);
}

TEST(OriginScene, TellsExactlyWhetherARayMeetsABox) {
    const IntegerBox box{{0, 0, 0}, {2, 2, 2}};
    EXPECT_TRUE(meetExactly({{-5, 0, 0}, {5, 0, 0}}, box));
    EXPECT_TRUE(meetExactly({{-5, 2, 2}, {5, 2, 2}}, box));   // along an edge
    EXPECT_TRUE(meetExactly({{0, 4, 0}, {4, 0, 0}}, box));    // through an edge, at (2, 2, 0)
    EXPECT_FALSE(meetExactly({{0, 5, 0}, {4, 0, 0}}, box));   // past it
    EXPECT_TRUE(meetExactly({{-5, 0, 0}, {-2, 0, 0}}, box));  // ends on a face
    EXPECT_FALSE(meetExactly({{-5, 0, 0}, {-3, 0, 0}}, box));
    EXPECT_TRUE(meetExactly({{1, 1, 1}, {1, 1, 1}}, box));
    EXPECT_FALSE(meetExactly({{3, 1, 1}, {3, 1, 1}}, box));
}

}  // namespace
}  // namespace hashphase::demos
