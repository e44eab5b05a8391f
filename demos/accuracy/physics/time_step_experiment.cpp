// SPDX-License-Identifier: Zlib
#include <demos/accuracy/physics/physics_experiments.hpp>

namespace hashphase::demos {
namespace {

constexpr std::string_view kTimeStepDeclaration =
#include <demos/accuracy/physics/time_step.sql>
    ;

constexpr int kLooksPerSecond = 30;

/// A task with one setting of the engine.
struct Point {
    std::size_t task;
    std::string way;   // in which accuracy is bought
    int substeps = 1;  // between two looks
    int iterations = 10;

    /// Only what touches is in contact (setContactProcessingThreshold(0)), and overlap is undone
    /// without adding speed, however small it is (m_splitImpulsePenetrationThreshold above 0).
    bool keepsEnergy = false;
};

std::vector<Point> pointsOf(std::size_t tasks, const TimeStepSettings& settings) {
    std::vector<Point> points;
    for (std::size_t task = 0; task < tasks; ++task) {
        for (const int substeps : settings.substeps) {
            points.push_back({task, "smaller steps, 10 iterations each", substeps});
        }
        for (const int substeps : settings.substeps) {
            points.push_back({task, "smaller steps, 10 iterations each, contacts that keep energy",
                              substeps, 10, true});
        }
    }
    for (const int iterations : settings.iterations) {
        points.push_back({0, "steps of 1/60 s, more iterations", 2, iterations});
    }
    for (const int substeps : settings.substeps) {
        if (settings.product % substeps == 0) {
            points.push_back(
                {0,
                 std::to_string(settings.product) + " iterations, shared among the steps of 1/30 s",
                 substeps, settings.product / substeps});
        }
    }
    return points;
}

std::unique_ptr<PhysicsWorld> worldOf(const Point& point, const PhysicsTask& task,
                                      std::uint64_t seed, const PhysicsContestant& contestant) {
    auto world = std::make_unique<PhysicsWorld>(contestant.broadphase, contestant.order);
    btContactSolverInfo& solver = world->world().getSolverInfo();
    solver.m_numIterations = point.iterations;
    solver.m_restitutionVelocityThreshold = 0;  // what is lossless is so at any speed
    task.fill(world->contents(), seed);
    if (point.keepsEnergy) {
        solver.m_splitImpulsePenetrationThreshold = 1;  // [m]
        for (const auto& body : world->contents().bodies()) {
            body->setContactProcessingThreshold(0);
        }
    }
    return world;
}

/// Simulates two seconds: sixty looks, all contestants in turn between two of them.
void run(const Point& point, std::size_t number, const PhysicsTask& task, std::uint64_t seed,
         std::span<const PhysicsContestant> contestants, Measurements& measured) {
    constexpr int kLooks = kFewestFrames;
    const btScalar step = 1 / static_cast<btScalar>(kLooksPerSecond * point.substeps);
    std::vector<std::unique_ptr<PhysicsWorld>> worlds;
    std::vector<TimedMethod> methods;
    for (const PhysicsContestant& contestant : contestants) {
        worlds.push_back(worldOf(point, task, seed, contestant));
        methods.push_back(
            {{{"point", number}, {"contestant", methods.size()}},
             [&point, step, &world = *worlds.back()] { world.step(step, point.substeps); }});
    }
    const auto lookBefore = [&](int frame) {
        if (frame == 0) {
            return;
        }
        const double seconds = static_cast<double>(frame) / kLooksPerSecond;
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            const WorldContents& contents = worlds[i]->contents();
            measured.add("states", {{"point", number},
                                    {"contestant", i},
                                    {"look", frame},
                                    {"state", std::to_string(stateHash(contents))}});
            for (std::size_t k = 0; k < task.measures.size(); ++k) {
                measured.add("errors",
                             {{"point", number},
                              {"contestant", i},
                              {"measure", k},
                              {"seconds", seconds},
                              {"squared", task.measures[k].squaredError(contents, seconds)}});
            }
        }
    };
    measureTimes(measured, {kLooks, 0, kLooksPerSecond}, lookBefore, methods);
    lookBefore(kLooks);
}

void name(std::span<const PhysicsTask> tasks, std::span<const PhysicsContestant> contestants,
          Measurements& measured) {
    for (std::size_t i = 0; i < contestants.size(); ++i) {
        const auto& [name, broadphase, order] = contestants[i];
        measured.add("contestants", {{"contestant", i},
                                     {"method", name},
                                     {"ours", broadphase.isOurs},
                                     {"canonical", order == ListOrder::canonical ||
                                                       order == ListOrder::canonicalByUniqueId}});
    }
    for (std::size_t task = 0; task < tasks.size(); ++task) {
        for (std::size_t k = 0; k < tasks[task].measures.size(); ++k) {
            const PhysicsMeasure& measure = tasks[task].measures[k];
            measured.add("measures", {{"task", task},
                                      {"measure", k},
                                      {"task_name", tasks[task].name},
                                      {"task_title", tasks[task].title},
                                      {"name", measure.name},
                                      {"title", measure.title},
                                      {"unit", measure.unit}});
        }
    }
}

}  // namespace

std::vector<PhysicsContestant> timeStepContestants() {
    std::vector<PhysicsContestant> contestants;
    for (const ListOrder order : {ListOrder::canonicalByUniqueId, ListOrder::asShipped}) {
        for (const PhysicsBroadphase& each : physicsBroadphases()) {
            if (each.name == kHashName || each.name == kDbvtName) {
                const char* ending =
                    order == ListOrder::asShipped ? "" : ", lists in canonical order";
                contestants.push_back({each.name + ending, each, order});
            }
        }
    }
    return contestants;
}

Findings measureTimeSteps(std::span<const PhysicsTask> tasks,
                          std::span<const PhysicsContestant> contestants,
                          const TimeStepSettings& settings, const TellProgress& tell) {
    Measurements measured;
    name(tasks, contestants, measured);
    const std::vector<Point> points = pointsOf(tasks.size(), settings);
    double stepsOfAll = 0;
    for (const Point& point : points) {
        stepsOfAll += point.substeps;
    }
    double done = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& point = points[i];
        tell(done / stepsOfAll, tasks[point.task].name);
        measured.add("points", {{"point", i},
                                {"task", point.task},
                                {"way", point.way},
                                {"per_second", kLooksPerSecond * point.substeps},
                                {"iterations", point.iterations},
                                {"keeps_energy", point.keepsEnergy}});
        run(point, i, tasks[point.task], settings.seed, contestants, measured);
        done += point.substeps;
    }
    return findingsOf(kTimeStepDeclaration, measured);
}

Experiment timeStepExperiment() {
    return {"P7",
            "Time step, substeps, iterations",
            "Do smaller steps and more iterations reduce errors, and does the broadphase matter?",
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
                return measureTimeSteps(physicsTasks(), timeStepContestants(), settings, tell);
            }};
}

}  // namespace hashphase::demos
