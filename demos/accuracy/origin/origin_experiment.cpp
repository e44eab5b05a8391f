// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/timing.hpp>
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

using Worlds = std::vector<std::unique_ptr<OriginWorld>>;

std::vector<WorldBox> worldBoxes(const OriginScene& scene, const BodyPlacement& place) {
    std::vector<WorldBox> boxes;
    for (const IntegerBox& box : scene.boxes()) {
        boxes.push_back(place(box));
    }
    return boxes;
}

/// What is there, sorted, against what a method lists.
struct Comparison {
    std::size_t all = 0;
    std::size_t missed = 0;
    std::size_t falsely = 0;  // listed, but not there; or a second time

    template <class Thing>
    void add(const std::vector<Thing>& there, std::vector<Thing>& listed) {
        std::sort(listed.begin(), listed.end());
        const auto missing = static_cast<std::size_t>(
            std::count_if(there.begin(), there.end(), [&](const Thing& each) {
                return !std::binary_search(listed.begin(), listed.end(), each);
            }));
        all += there.size();
        missed += missing;
        falsely += listed.size() - (there.size() - missing);
    }
};

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
           std::span<const OriginMethod> methods, const Worlds& worlds, Measurements& measured) {
    const std::vector<PairKey> truePairs = exactPairs(scene.boxes());
    std::vector<std::vector<std::uint32_t>> trueHits;
    for (const IntegerRay& ray : scene.rays()) {
        trueHits.push_back(exactHits(ray, scene.boxes()));
    }
    for (std::size_t k = 0; k < methods.size(); ++k) {
        Comparison pairs;
        std::vector<PairKey> listedPairs;
        worlds[k]->listPairs(listedPairs);
        pairs.add(truePairs, listedPairs);
        Comparison hits;
        for (std::size_t i = 0; i < trueHits.size(); ++i) {
            std::vector<std::uint32_t> listedHits;
            worlds[k]->listHits(place(scene.rays()[i]), listedHits);
            hits.add(trueHits[i], listedHits);
        }
        measured.add("looks", {{"fine", place.unit == kFineUnit},
                               {"offset", place.offset},
                               {"method", methods[k].name},
                               {"pairs", pairs.all},
                               {"missed_pairs", pairs.missed},
                               {"extra_pairs", pairs.falsely},
                               {"hits", hits.all},
                               {"missed_hits", hits.missed},
                               {"false_hits", hits.falsely}});
    }
}

/// Moves the scene, all methods in turn in each frame, and the first one at the origin as well;
/// compares every tenth frame with exact arithmetic.
void moveScene(const BodyPlacement& place, OriginScene scene, std::span<const OriginMethod> methods,
               Measurements& measured) {
    constexpr int framesALook = 10;
    constexpr int warmUp = 2;
    const BodyPlacement atOrigin{0, place.unit};
    std::vector<WorldBox> boxes = worldBoxes(scene, place);
    std::vector<WorldBox> boxesAtOrigin = worldBoxes(scene, atOrigin);
    Worlds worlds;
    std::vector<std::function<void()>> timed;
    for (const OriginMethod& method : methods) {
        worlds.push_back(method.make());
        timed.emplace_back([&boxes, world = worlds.back().get()] { world->set(boxes); });
    }
    const std::unique_ptr<OriginWorld> reference = methods.front().make();
    timed.emplace_back([&] { reference->set(boxesAtOrigin); });
    const auto times = timesInTurn(
        kFewestFrames, warmUp,
        [&](int frame) {
            if (frame % framesALook == 1) {
                judge(scene, place, methods, worlds, measured);
            }
            scene.advance();
            boxes = worldBoxes(scene, place);
            boxesAtOrigin = worldBoxes(scene, atOrigin);
        },
        timed);
    for (std::size_t i = 0; i < times.size(); ++i) {
        for (const double milliseconds : times[i]) {
            measured.add("frames",
                         {{"fine", place.unit == kFineUnit},
                          {"offset", place.offset},
                          {"method", i < methods.size() ? Datum(methods[i].name) : Datum()},
                          {"ms", milliseconds}});
        }
    }
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

/// Drops balls onto a floor at `offset` along all three axes, by all methods in turn.
void settle(double offset, std::span<const SettleMethod> methods, Measurements& measured) {
    constexpr int steps = 300;
    constexpr btScalar stepLength = btScalar(1) / btScalar(60);  // [s]
    std::vector<std::unique_ptr<PhysicsWorld>> worlds;
    std::vector<std::function<void()>> timed;
    for (const SettleMethod& method : methods) {
        worlds.push_back(std::make_unique<PhysicsWorld>(method.broadphase, ListOrder::asShipped));
        fill(worlds.back()->contents(), method.shiftsOrigin ? 0 : offset);
        timed.emplace_back([world = worlds.back().get()] { world->step(stepLength); });
    }
    std::vector<std::vector<Places>> courses(methods.size());
    const auto look = [&](int /*step*/) {
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            courses[i].push_back(placesOf(worlds[i]->contents()));
        }
    };
    const auto times = timesInTurn(steps, 0, look, timed);
    look(steps);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const double seenFrom = methods[i].shiftsOrigin ? 0 : offset;
        const Places ought = restPlaces().array() + seenFrom;
        measured.add("settled", {{"offset", offset},
                                 {"method", methods[i].name},
                                 {"position_error", farthest(courses[i].back(), ought)},
                                 {"step", settleStep(courses[i])},
                                 {"state", std::to_string(stateHash(worlds[i]->contents()))}});
        for (const double milliseconds : times[i]) {
            measured.add("steps",
                         {{"offset", offset}, {"method", methods[i].name}, {"ms", milliseconds}});
        }
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
    for (const OriginMethod& method : methods) {
        measured.add("methods", {{"number", &method - methods.data()},
                                 {"method", method.name},
                                 {"ours", method.isOurs},
                                 {"misses_no_pair", method.missesNoPair},
                                 {"misses_no_hit", method.missesNoHit},
                                 {"exact", method.isExact}});
    }
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
            "What is missed and what is false far from the origin, and what does it cost to be "
            "right there?",
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
