// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/physics_experiments.hpp>

#include <array>

namespace hashphase::demos {
namespace {

constexpr std::string_view kTrajectoryDeclaration =
#include <demos/accuracy/physics/trajectory.sql>
    ;

/// Steps the scene over each of the broadphases, all in turn in each step; notes after each one the
/// state of all bodies and the number of pairs.
void run(const PhysicsScene& scene, std::size_t objects, ListOrder order,
         std::span<const PhysicsBroadphase> broadphases, const TrajectorySettings& settings,
         Measurements& measured) {
    constexpr btScalar kStep = btScalar(1) / btScalar(60);
    std::vector<std::unique_ptr<PhysicsWorld>> worlds;
    std::vector<TimedMethod> methods;
    for (const PhysicsBroadphase& broadphase : broadphases) {
        worlds.push_back(std::make_unique<PhysicsWorld>(broadphase, order));
        scene.fill(worlds.back()->contents(), objects, settings.seed);
        methods.push_back(
            {{{"list", titleOf(order)}, {"scene", scene.name}, {"method", broadphase.name}},
             [&world = *worlds.back()] { world.step(kStep); }});
    }
    const auto lookAfter = [&](int step) {
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            Record row = methods[i].columns;
            row.emplace_back("step", step);
            row.emplace_back("state", std::to_string(stateHash(worlds[i]->contents())));
            row.emplace_back("asleep", worlds[i]->sleepingCount());
            row.emplace_back("pairs", worlds[i]->pairCount());
            measured.add("states", row);
        }
    };
    const auto begin = [&](int step) {
        if (step > 0) {
            lookAfter(step);
        }
        for (const auto& world : worlds) {
            if (scene.disturb != nullptr) {
                scene.disturb(world->contents(), step);
            }
        }
    };
    measureTimes(measured, {.frames = settings.steps}, begin, methods);
    lookAfter(settings.steps);
}

}  // namespace

Findings compareTrajectories(std::span<const PhysicsBroadphase> broadphases,
                             std::span<const PhysicsScene> scenes,
                             const TrajectorySettings& settings, const TellProgress& tell) {
    constexpr std::array kListOrders{ListOrder::canonical, ListOrder::byUniqueId,
                                     ListOrder::asShipped};
    Measurements measured;
    measured.add("plan", {{"steps", settings.steps}, {"seed", settings.seed}});
    for (const PhysicsBroadphase& each : broadphases) {
        measured.add("methods",
                     {{"method", each.name}, {"ours", each.isOurs}, {"exact", each.isExact}});
    }
    double done = 0;
    for (const ListOrder order : kListOrders) {
        for (const PhysicsScene& scene : scenes) {
            tell(done++ / static_cast<double>(kListOrders.size() * scenes.size()), scene.name);
            const std::size_t objects = settings.isQuick ? scene.quickObjects : scene.fullObjects;
            measured.add("runs",
                         {{"list", titleOf(order)}, {"scene", scene.name}, {"objects", objects}});
            run(scene, objects, order, broadphases, settings, measured);
        }
    }
    return findingsOf(kTrajectoryDeclaration, measured);
}

Experiment trajectoryExperiment() {
    return {"P8",
            "Does the grid change physics?",
            "Which broadphases give motion that is bit-identical to brute force?",
            4,
            60,
            [](const Effort& effort, const TellProgress& tell) {
                const TrajectorySettings settings{effort.quickOrFull(120, 600), effort.seed,
                                                  effort.isQuick};
                return compareTrajectories(physicsBroadphases(), physicsScenes(), settings, tell);
            }};
}

}  // namespace hashphase::demos
