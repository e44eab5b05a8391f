// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/time_step_experiment.hpp>

#include <demos/accuracy/experiments.hpp>

#include <string_view>

namespace hashphase::demos {
namespace {

std::string nameOf(std::string_view broadphase, ListOrder order) {
    return std::string(broadphase) +
           (order == ListOrder::asShipped ? "" : ", lists in canonical order");
}

}  // namespace

std::vector<PhysicsContestant> timeStepContestants() {
    std::vector<PhysicsContestant> contestants;
    for (const ListOrder order : {ListOrder::canonicalByUniqueId, ListOrder::asShipped}) {
        for (const PhysicsBroadphase& each : physicsBroadphases()) {
            if (each.name == kHashName || each.name == kDbvtName) {
                contestants.push_back({nameOf(each.name, order), each, order});
            }
        }
    }
    return contestants;
}

std::vector<TaskPoint> runTimeSteps(std::span<const PhysicsTask> tasks,
                                    std::span<const PhysicsContestant> contestants,
                                    const TimeStepSettings& settings, const TellProgress& tell) {
    std::vector<TaskPoint> points;
    for (const PhysicsTask& task : tasks) {
        for (const int substeps : settings.substeps) {
            points.push_back({&task, std::string(kSmallerSteps), {substeps, 10}, {}});
        }
        for (const int substeps : settings.substeps) {
            points.push_back({&task, std::string(kKeepingEnergy), {substeps, 10, true}, {}});
        }
    }
    for (const int iterations : settings.iterations) {
        points.push_back({&tasks.front(), "steps of 1/60 s, more iterations", {2, iterations}, {}});
    }
    const std::string shared =
        std::to_string(settings.product) + " iterations, shared among the steps of 1/30 s";
    for (const int substeps : settings.substeps) {
        if (settings.product % substeps == 0) {
            points.push_back({&tasks.front(), shared, {substeps, settings.product / substeps}, {}});
        }
    }
    double stepsOfAll = 0;
    for (const TaskPoint& point : points) {
        stepsOfAll += point.stepping.substeps;
    }
    double done = 0;
    for (TaskPoint& point : points) {
        tell(done / stepsOfAll, point.task->name);
        point.outcomes = runTask(*point.task, point.stepping, settings.seed, contestants);
        done += point.stepping.substeps;
    }
    return points;
}

Experiment timeStepExperiment() {
    return {"P7",
            "Time step, substeps, iterations",
            "What do smaller steps and more iterations buy, and does the broadphase change it?",
            5,
            60,
            [](const Effort& effort, const TellProgress& tell) {
                TimeStepSettings settings;
                settings.substeps =
                    effort.quickOrFull<std::vector<int>>({1, 2, 4}, {1, 2, 4, 8, 16, 32, 64});
                settings.iterations =
                    effort.quickOrFull<std::vector<int>>({2, 10, 50}, {1, 2, 5, 10, 20, 50, 100});
                settings.product = effort.quickOrFull(16, 64);
                settings.seed = effort.seed;
                const std::vector<PhysicsTask> tasks = physicsTasks();
                const std::vector<PhysicsContestant> contestants = timeStepContestants();
                const std::vector<TaskPoint> points =
                    runTimeSteps(tasks, contestants, settings, tell);
                return judgeTimeSteps(tasks, contestants, points);
            }};
}

}  // namespace hashphase::demos
