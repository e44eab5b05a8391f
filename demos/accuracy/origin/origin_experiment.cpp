// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>

#include <demos/compare/reference_pairs.hpp>
#include <demos/console/format.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr std::string_view kOriginDeclaration =
#include <demos/accuracy/origin/origin.sql>
    ;

constexpr double kFineUnit = 0x1p-10;  // boxes of 0.5 to 2 m within 20 m

/// So large that a step of the scene is the distance of neighbouring numbers in single precision at
/// the farthest offset, 2^30 m: boxes of 1 to 4 km within 41 km.
constexpr double kCoarseUnit = 0x1p7 / static_cast<double>(OriginScene::kStep);

/// Whether this power of two is the one next to a power of ten.
bool isNextToPowerOfTen(double offset) {
    const double power = std::pow(10.0, std::round(std::log10(offset)));
    return offset == std::exp2(std::round(std::log2(power)));
}

// --- Pairs and rays ------------------------------------------------------------------------------

std::vector<WorldBox> worldBoxes(const OriginScene& scene, const BodyPlacement& place) {
    std::vector<WorldBox> boxes;
    for (const IntegerBox& box : scene.boxes()) {
        boxes.push_back(place(box));
    }
    return boxes;
}

std::vector<PairKey> exactPairs(const std::vector<IntegerBox>& boxes) {
    std::vector<PairKey> pairs;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
            if (overlapExactly(boxes[i], boxes[j])) {
                pairs.push_back(pairKey(i, j));
            }
        }
    }
    return pairs;
}

std::vector<std::uint32_t> exactHits(const IntegerRay& ray, const std::vector<IntegerBox>& boxes) {
    std::vector<std::uint32_t> hits;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (meetExactly(ray, boxes[i])) {
            hits.push_back(i);
        }
    }
    return hits;
}

void judge(const OriginScene& scene, const BodyPlacement& place,
           std::span<const OriginMethod> methods, std::span<const OriginWorld> worlds,
           Measurements& measured) {
    const std::vector<PairKey> truePairs = exactPairs(scene.boxes());
    std::vector<std::vector<std::uint32_t>> trueHits;
    for (const IntegerRay& ray : scene.rays()) {
        trueHits.push_back(exactHits(ray, scene.boxes()));
    }
    for (std::size_t k = 0; k < methods.size(); ++k) {
        std::vector<PairKey> pairs;
        worlds[k].listPairs(pairs);
        std::sort(pairs.begin(), pairs.end());
        std::size_t hits = 0;
        std::size_t missed = 0;
        std::size_t falsely = 0;
        for (std::size_t i = 0; i < trueHits.size(); ++i) {
            std::vector<std::uint32_t> listed;
            worlds[k].listHits(place(scene.rays()[i]), listed);
            std::sort(listed.begin(), listed.end());
            hits += trueHits[i].size();
            missed += countMissing(trueHits[i], listed);
            falsely += countMissing(listed, trueHits[i]);
        }
        measured.add("looks", {{"fine", place.unit == kFineUnit},
                               {"offset", place.offset},
                               {"method", methods[k].name},
                               {"pairs", truePairs.size()},
                               {"missed_pairs", countMissing(truePairs, pairs)},
                               {"extra_pairs", countMissing(pairs, truePairs)},
                               {"hits", hits},
                               {"missed_hits", missed},
                               {"false_hits", falsely}});
    }
}

/// Moves the scene, all methods in each frame, and the first one at the origin as well;
/// compares every tenth frame with exact arithmetic.
void moveScene(const BodyPlacement& place, OriginScene scene, std::span<const OriginMethod> methods,
               Measurements& measured) {
    constexpr int framesALook = 10;
    const BodyPlacement atOrigin{0, place.unit};
    std::vector<WorldBox> boxes = worldBoxes(scene, place);
    std::vector<WorldBox> boxesAtOrigin = worldBoxes(scene, atOrigin);
    std::vector<OriginWorld> worlds;
    std::vector<TimedMethod> timed;
    const auto add = [&](const OriginMethod& method, const Datum& name, const auto& itsBoxes) {
        worlds.push_back(method.make());
        timed.push_back(
            {{{"fine", place.unit == kFineUnit}, {"offset", place.offset}, {"method", name}},
             [&itsBoxes, set = worlds.back().set] { set(itsBoxes); }});
    };
    for (const OriginMethod& method : methods) {
        add(method, method.name, boxes);
    }
    add(methods.front(), {}, boxesAtOrigin);
    const auto begin = [&](int frame) {
        if (frame % framesALook == 1) {
            judge(scene, place, methods, worlds, measured);
        }
        scene.advance();
        boxes = worldBoxes(scene, place);
        boxesAtOrigin = worldBoxes(scene, atOrigin);
    };
    measureTimes(measured, {.warmUp = 2, .table = "frames"}, begin, timed);
}

// --- Balls that come to rest ---------------------------------------------------------------------

constexpr int kBalls = 16;
constexpr double kRadius = 0.5;

using Places = Eigen::Matrix<double, 3, kBalls>;

/// Where the balls ought to rest, on the floor at height 0.
Places restPlaces() {
    Places places;
    for (int i = 0; i < kBalls; ++i) {
        places.col(i) << 2.0 * i - 16 + i / 32.0, kRadius, 3 - i / 64.0;
    }
    return places;
}

void fill(WorldContents& contents, double offset) {
    constexpr btScalar halfFloor = 32;
    const auto at = [offset](double x, double y, double z) {
        return btVector3(static_cast<btScalar>(x + offset), static_cast<btScalar>(y + offset),
                         static_cast<btScalar>(z + offset));
    };
    auto& floor = contents.addShape<btBoxShape>(btVector3(halfFloor, halfFloor, halfFloor));
    contents.addBody(floor, 0, at(0, -double{halfFloor}, 0));
    auto& sphere = contents.addShape<btSphereShape>(static_cast<btScalar>(kRadius));
    const Places places = restPlaces();
    for (int i = 0; i < kBalls; ++i) {
        const double drop = 0.5 + i / 16.0;
        contents.addBody(sphere, 1, at(places(0, i), places(1, i) + drop, places(2, i)));
    }
}

Places placesOf(const WorldContents& contents) {
    Places places;
    for (int i = 0; i < kBalls; ++i) {
        const btVector3& place =
            contents.bodies()[static_cast<std::size_t>(i) + 1]->getWorldTransform().getOrigin();
        places.col(i) << place.x(), place.y(), place.z();
    }
    return places;
}

/// The largest distance between the two places of a ball; infinite where a place is not a number.
double farthest(const Places& a, const Places& b) {
    return (a - b).allFinite() ? (a - b).colwise().norm().maxCoeff()
                               : std::numeric_limits<double>::infinity();
}

/// After which no ball moves by more than a millimetre.
std::size_t settleStep(const std::vector<Places>& course) {
    std::size_t step = course.size();
    while (step > 0 && farthest(course[step - 1], course.back()) <= 1e-3) {
        --step;
    }
    return step + 1;
}

/// Drops balls onto a floor at `offset` along all three axes, by all methods.
void settle(double offset, std::span<const SettleMethod> methods, Measurements& measured) {
    constexpr int steps = 300;
    constexpr btScalar stepLength = btScalar(1) / btScalar(60);  // [s]
    std::vector<std::unique_ptr<PhysicsWorld>> worlds;
    std::vector<TimedMethod> timed;
    for (const SettleMethod& method : methods) {
        worlds.push_back(std::make_unique<PhysicsWorld>(method.broadphase, ListOrder::asShipped));
        fill(worlds.back()->contents(), method.shiftsOrigin ? 0 : offset);
        timed.push_back({{{"offset", offset}, {"method", method.name}},
                         [&world = *worlds.back()] { world.step(stepLength); }});
    }
    std::vector<std::vector<Places>> courses(methods.size());
    const auto look = [&](int /*step*/) {
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            courses[i].push_back(placesOf(worlds[i]->contents()));
        }
    };
    measureTimes(measured, {.frames = steps, .table = "steps"}, look, timed);
    look(steps);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const double seenFrom = methods[i].shiftsOrigin ? 0 : offset;
        const Places ought = restPlaces().array() + seenFrom;
        measured.add("settled", {{"offset", offset},
                                 {"method", methods[i].name},
                                 {"position_error", farthest(courses[i].back(), ought)},
                                 {"step", settleStep(courses[i])},
                                 {"state", std::to_string(stateHash(worlds[i]->contents()))}});
    }
}

}  // namespace

std::vector<SettleMethod> settleMethods() {
    return {{"Bullet in float, btDbvtBroadphase", physicsBroadphase(kDbvtName), false},
            {"Bullet in float, hashphase", physicsBroadphase(kHashName), false},
            {"Bullet in float, hashphase, origin shifted", physicsBroadphase(kHashName), true}};
}

Findings findOrigin(const OriginPlan& plan, std::uint64_t seed,
                    std::span<const OriginMethod> methods, std::span<const SettleMethod> settling,
                    const TellProgress& tell) {
    Measurements measured;
    measured.add("plan", {{"boxes", plan.boxes}, {"rays", plan.rays}, {"seed", seed}});
    addMethods(methods, {"misses_no_pair", "misses_no_hit", "exact"}, measured);
    for (const SettleMethod& method : settling) {
        measured.add("settling", {{"number", &method - settling.data()},
                                  {"method", method.name},
                                  {"ours", method.broadphase.isOurs},
                                  {"shifts_origin", method.shiftsOrigin}});
    }
    const OriginScene fine(plan.boxes, plan.rays, 1, seed);
    const OriginScene coarse(plan.boxes, plan.rays, OriginScene::kStep, seed);
    for (std::size_t i = 0; i < plan.offsets.size(); ++i) {
        const double offset = plan.offsets[i];
        tell(static_cast<double>(i) / static_cast<double>(plan.offsets.size()),
             withThousands(static_cast<std::uint64_t>(offset)) + " m");
        measured.add("points", {{"offset", offset},
                                {"in_tables", offset == 0 || isNextToPowerOfTen(offset)}});
        moveScene({offset, kFineUnit}, fine, methods, measured);
        moveScene({offset, kCoarseUnit}, coarse, methods, measured);
        settle(offset, settling, measured);
    }
    return findingsOf(kOriginDeclaration, measured);
}

Experiment originExperiment() {
    return {"P6",
            "Distance from the origin",
            "What is missed or false far from the origin, and what do exact results cost there?",
            4,
            40,
            [](const Effort& effort, const TellProgress& tell) {
                // Those next to a thousand, ten thousand, ... up to a billion, or all in between as
                // well.
                OriginPlan plan{{0},
                                effort.quickOrFull<std::size_t>(400, 1000),
                                effort.quickOrFull<std::size_t>(50, 200)};
                for (int exponent = 10; exponent <= 30; ++exponent) {
                    const double offset = std::ldexp(1.0, exponent);
                    if (!effort.isQuick || isNextToPowerOfTen(offset)) {
                        plan.offsets.push_back(offset);
                    }
                }
                return findOrigin(plan, effort.seed, originMethods(), settleMethods(), tell);
            }};
}

}  // namespace hashphase::demos
