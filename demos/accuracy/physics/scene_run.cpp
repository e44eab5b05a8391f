// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/scene_run.hpp>

#include <demos/accuracy/timing.hpp>

#include <functional>
#include <memory>

namespace hashphase::demos {
namespace {

using Worlds = std::vector<std::unique_ptr<PhysicsWorld>>;

void compare(const Worlds& worlds, std::size_t reference, int step,
             std::vector<SceneOutcome>& outcomes) {
    const std::uint64_t expected = stateHash(worlds[reference]->contents());
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        if (outcomes[i].isSame() && stateHash(worlds[i]->contents()) != expected) {
            outcomes[i].firstDifference = step;
        }
        outcomes[i].asleep += worlds[i]->sleepingCount();
    }
}

}  // namespace

std::vector<SceneOutcome> runScene(const PhysicsScene& scene, std::size_t objects,
                                   std::uint64_t seed, int steps,
                                   std::span<const PhysicsBroadphase> broadphases, ListOrder order,
                                   std::size_t reference) {
    constexpr btScalar kStep = btScalar(1) / btScalar(60);
    Worlds worlds;
    std::vector<std::function<void()>> methods;
    for (const PhysicsBroadphase& broadphase : broadphases) {
        worlds.push_back(std::make_unique<PhysicsWorld>(broadphase, order));
        scene.fill(worlds.back()->contents(), objects, seed);
        methods.emplace_back([world = worlds.back().get()] { world->step(kStep); });
    }
    std::vector<SceneOutcome> outcomes(worlds.size());
    const auto begin = [&](int step) {
        if (step > 0) {
            compare(worlds, reference, step, outcomes);
        }
        for (const auto& world : worlds) {
            scene.disturb(world->contents(), step);
        }
    };
    const std::vector<Spread> times = timeInTurn(steps, 0, begin, methods);
    compare(worlds, reference, steps, outcomes);
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        outcomes[i].stepMs = times[i];
        outcomes[i].pairs = worlds[i]->pairCount();
    }
    return outcomes;
}

}  // namespace hashphase::demos
