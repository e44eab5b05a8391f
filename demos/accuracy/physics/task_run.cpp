// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/task_run.hpp>

#include <demos/accuracy/timing.hpp>

#include <cmath>
#include <functional>
#include <memory>

namespace hashphase::demos {
namespace {

using Worlds = std::vector<std::unique_ptr<PhysicsWorld>>;

void keepEnergy(PhysicsWorld& world) {
    world.world().getSolverInfo().m_splitImpulsePenetrationThreshold = 1;  // [m]
    for (const auto& body : world.contents().bodies()) {
        body->setContactProcessingThreshold(0);
    }
}

void look(const PhysicsTask& task, const Worlds& worlds, double seconds,
          std::vector<TaskOutcome>& outcomes) {
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        const WorldContents& contents = worlds[i]->contents();
        for (std::size_t k = 0; k < task.measures.size(); ++k) {
            outcomes[i].errors[k] += task.measures[k].squaredError(contents, seconds);
        }
        outcomes[i].states = outcomes[i].states * 0x100000001b3U + stateHash(contents);
    }
}

}  // namespace

std::vector<TaskOutcome> runTask(const PhysicsTask& task, const Stepping& stepping,
                                 std::uint64_t seed,
                                 std::span<const PhysicsContestant> contestants) {
    constexpr int kLooks = kFewestFrames;
    const btScalar step = 1 / static_cast<btScalar>(stepping.stepsPerSecond());
    Worlds worlds;
    std::vector<std::function<void()>> methods;
    for (const PhysicsContestant& each : contestants) {
        worlds.push_back(std::make_unique<PhysicsWorld>(each.broadphase, each.order));
        btContactSolverInfo& solver = worlds.back()->world().getSolverInfo();
        solver.m_numIterations = stepping.iterations;
        solver.m_restitutionVelocityThreshold = 0;  // what is lossless is so at any speed
        task.fill(worlds.back()->contents(), seed);
        if (stepping.keepsEnergy) {
            keepEnergy(*worlds.back());
        }
        methods.emplace_back([&stepping, step, world = worlds.back().get()] {
            world->step(step, stepping.substeps);
        });
    }
    std::vector<TaskOutcome> outcomes(worlds.size());
    for (TaskOutcome& each : outcomes) {
        each.errors.resize(task.measures.size());
    }
    const auto lookBefore = [&](int frame) {
        if (frame > 0) {
            look(task, worlds, static_cast<double>(frame) / kLooksPerSecond, outcomes);
        }
    };
    const std::vector<Spread> times = timeInTurn(kLooks, 0, lookBefore, methods);
    lookBefore(kLooks);
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        const Spread& frame = times[i];
        outcomes[i].secondMs = {kLooksPerSecond * frame.median, kLooksPerSecond * frame.low,
                                kLooksPerSecond * frame.high};
        for (double& error : outcomes[i].errors) {
            error = std::sqrt(error / kLooks);
        }
    }
    return outcomes;
}

}  // namespace hashphase::demos
