// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_experiment.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr std::string_view kSweepDeclaration =
#include <demos/accuracy/sweeps/sweeps.sql>
    ;

using Keys = std::vector<PairKey>;

/// A method at work on a scene.
struct Sweeping {
    const SweepMethod* method;
    SweepFinder finder;
};

std::vector<Sweeping> sweepings(std::span<const SweepMethod> methods, const SweptFrame& frame) {
    std::vector<Sweeping> all;
    for (const SweepMethod& method : methods) {
        all.push_back({&method, method.make(frame)});
    }
    return all;
}

/// Pairs of one mover at least that did not touch when the frame began; sorted.
void keepFresh(Keys& listed, std::uint32_t movers, const Keys& older) {
    std::erase_if(listed, [&](PairKey pair) {
        return firstOf(pair) >= movers || std::binary_search(older.begin(), older.end(), pair);
    });
    std::sort(listed.begin(), listed.end());
}

/// How far the times of contact are off at worst: in frames, and as a share of them. Infinite where
/// none is given.
std::pair<double, double> worstTimes(const SweepFinder& finder, const SweptFrame& frame,
                                     const SweepTruth& truth) {
    std::pair<double, double> worst;
    for (std::size_t i = 0; i < truth.contacts.size(); ++i) {
        const std::optional<double> time = finder.contactTime(
            frame.objects[firstOf(truth.contacts[i])], frame.objects[secondOf(truth.contacts[i])]);
        const double error =
            time ? truth.moments[i].errorOf(*time) : std::numeric_limits<double>::infinity();
        worst.first = std::max(worst.first, error);
        worst.second = std::max(worst.second, error / truth.moments[i].value());
    }
    return worst;
}

/// Where a frame is: at walls, or among fast movers.
struct Where {
    Datum thickness;
    Datum ratio;
    Datum motion;
};

constexpr int kPapersOneFrameIn = 32;

/// Lets all methods do the frame, those that are slow only some of many, and says what they get wrong.
void judge(std::span<const Sweeping> sweepings, const SweptFrame& frame, int number,
           const Where& where, Measurements& measured) {
    const SweepTruth truth = findTruth(frame);
    std::optional<Keys> ofFirstExact;
    for (const auto& [method, finder] : sweepings) {
        if (method->is("paper") && number % kPapersOneFrameIn != 0) {
            continue;
        }
        finder.step(frame);
        Keys listed;
        const std::optional<SweepWork> work = finder.listPairs(listed);
        keepFresh(listed, frame.movers, truth.older);
        const bool isCompared = method->is("compared");
        const auto [timeError, relativeTimeError] = method->is("tells_time")
                                                        ? worstTimes(finder, frame, truth)
                                                        : std::pair<double, double>();
        measured.add("frames", {{"method", method->name},
                                {"thickness", where.thickness},
                                {"ratio", where.ratio},
                                {"motion", where.motion},
                                {"movers", frame.movers},
                                {"contacts", truth.contacts.size()},
                                {"missed", countMissing(truth.contacts, listed)},
                                {"invented", countMissing(listed, truth.contacts)},
                                {"unlike", isCompared && ofFirstExact && listed != *ofFirstExact},
                                {"time_error", timeError},
                                {"relative_time_error", relativeTimeError},
                                {"cells", work ? Datum(work->cells) : Datum()},
                                {"tests", work ? Datum(work->tests) : Datum()}});
        if (isCompared && !ofFirstExact) {
            ofFirstExact = std::move(listed);
        }
    }
}

void shootAtWalls(const SweepPlan& plan, std::uint64_t seed, std::span<const SweepMethod> methods,
                  const std::function<void(double)>& tell, Measurements& measured) {
    Random random(seed);
    std::size_t points = 0;
    for (const double thickness : plan.thicknesses) {
        for (const double ratio : plan.ratios) {
            tell(static_cast<double>(points++) /
                 static_cast<double>(plan.thicknesses.size() * plan.ratios.size()));
            BulletsAtWalls lanes(thickness, ratio, random);
            const std::vector<Sweeping> all = sweepings(methods, lanes.frame());
            for (int frame = 0; frame < plan.wallFrames; ++frame) {
                judge(all, lanes.frame(), frame, {thickness, ratio, {}}, measured);
                lanes.advance();
            }
        }
    }
}

void shootBodies(const SweepPlan& plan, std::uint64_t seed, Measurements& measured) {
    Random random(seed);
    for (const bool isContinuous : {false, true}) {
        for (const double ratio : plan.ratios) {
            for (const double thickness : plan.thicknesses) {
                for (int round = 0; round < plan.bodyRounds; ++round) {
                    measured.add(
                        "bodies",
                        {{"continuous", isContinuous},
                         {"ratio", ratio},
                         {"bodies", kFlyingBodies},
                         {"tunnelled", countTunnelled(thickness, ratio, isContinuous, random)}});
                }
            }
        }
    }
}

void moveFast(const SweepPlan& plan, std::uint64_t seed, std::span<const SweepMethod> methods,
              const std::function<void(double)>& tell, Measurements& measured) {
    const TimedFrames timed{plan.timedFrames, 4};
    for (std::size_t i = 0; i < plan.motions.size(); ++i) {
        const FastMotion& motion = plan.motions[i];
        measured.add("motions", {{"motion", motion.cells}, {"judged_frames", motion.judgedFrames}});
        FastMovers scene(plan.objects, plan.movers, motion.cells, seed);
        const std::vector<Sweeping> all = sweepings(methods, scene.frame());
        for (int frame = 0; frame < motion.judgedFrames; ++frame) {
            judge(all, scene.frame(), 0, {{}, {}, motion.cells}, measured);
            scene.advance();
        }
        std::vector<TimedMethod> steps;
        for (const auto& [method, finder] : all) {
            steps.push_back({{{"method", method->name}, {"motion", motion.cells}},
                             [&scene, &step = finder.step] { step(scene.frame()); }});
        }
        const auto begin = [&](int frame) {
            scene.advance();
            tell((static_cast<double>(i) +
                  frame / static_cast<double>(timed.frames + timed.warmUp)) /
                 static_cast<double>(plan.motions.size()));
        };
        measureTimes(measured, timed, begin, steps);
    }
}

/// 0.1 to 1000, evenly on a logarithmic axis.
std::vector<double> ratiosPerDecade(int count) {
    std::vector<double> ratios;
    for (int i = 0; i <= 4 * count; ++i) {
        ratios.push_back(std::pow(10.0, static_cast<double>(i) / count - 1));
    }
    return ratios;
}

}  // namespace

Findings findSweeps(const SweepPlan& plan, std::uint64_t seed, std::span<const SweepMethod> methods,
                    const TellProgress& tell) {
    constexpr double shareOfWalls = 0.4;  // of the time, about
    Measurements measured;
    measured.add("plan", {{"objects", plan.objects},
                          {"movers", plan.movers},
                          {"timed_frames", plan.timedFrames},
                          {"seed", seed}});
    addMethods(methods,
               {"misses_nothing", "invents_nothing", "exact", "compared", "discrete", "tells_time"},
               measured);
    shootAtWalls(
        plan, seed, methods, [&](double share) { tell(shareOfWalls * share, "bullets at walls"); },
        measured);
    tell(shareOfWalls, "bodies at walls");
    shootBodies(plan, seed, measured);
    moveFast(
        plan, seed, methods,
        [&](double share) { tell(shareOfWalls + (1 - shareOfWalls) * share, "fast movers"); },
        measured);
    return findingsOf(kSweepDeclaration, measured);
}

Experiment sweepExperiment() {
    return {"P1",
            "Fast objects",
            "How many contacts of fast objects are missed, and what does it cost to detect all?",
            4,
            100,
            [](const Effort& effort, const TellProgress& tell) {
                const SweepPlan plan{{0.001, 0.01, 0.1, 1},
                                     ratiosPerDecade(effort.quickOrFull(2, 4)),
                                     effort.quickOrFull(64, 768),
                                     effort.quickOrFull(1, 4),
                                     effort.quickOrFull(6'000U, 30'000U),
                                     effort.quickOrFull(50U, 1'000U),
                                     {{1, effort.quickOrFull(200, 100)},
                                      {10, effort.quickOrFull(40, 32)},
                                      {100, effort.quickOrFull(10, 8)}},
                                     60};
                return findSweeps(plan, effort.seed, sweepMethods(), tell);
            }};
}

}  // namespace hashphase::demos
