// SPDX-License-Identifier: Zlib
#include <demos/compare/comparison.hpp>

#include <demos/compare/filled_broadphase.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <string>

namespace hashphase::demos {
namespace {

// The caches and the adaptive parts settle in so many frames at most.
constexpr int kMostWarmUpFrames = 10;

constexpr std::size_t kObjectsToRemove = 1000;

Fault faultOf(int frame, const FrameVerdict& verdict, std::span<const Aabb<float>> boxes) {
    Fault fault;
    fault.frame = frame;
    fault.missing = verdict.firstMissing.has_value();
    fault.pair = fault.missing ? *verdict.firstMissing : *verdict.firstExtra;
    fault.firstBox = boxes[firstOf(fault.pair)];
    fault.secondBox = boxes[secondOf(fault.pair)];
    return fault;
}

void record(int frame, bool measured, const Observation& seen, Verifier& verifier, Result& result) {
    FrameRow row;
    row.frame = frame;
    row.measured = measured;
    row.setAabbMs = seen.setAabbMs;
    row.calculateMs = seen.calculateMs;
    row.stepMs = seen.stepMs;
    row.verdict = verifier.judge(seen.reported, seen.exact);
    if (!result.firstFault && row.verdict.missing + row.verdict.extra > 0) {
        result.firstFault = faultOf(frame, row.verdict, seen.boxes);
    }
    result.rows.push_back(row);
}

// Brings its code into memory, so that its filling tells nothing of that.
void touch(const BroadphaseKind& kind) {
    const Aabb<float> box(Vector3<float>::Zero(), Vector3<float>::Ones());
    FilledBroadphase once(kind, {box, 1});
    once.create(0, {btVector3(0, 0, 0), btVector3(1, 1, 1)}, {});
}

Result fill(Trial& trial, const BroadphaseKind& kind, double seconds,
            const ComparisonSettings& settings) {
    Progress progress(settings.err, settings.progress, "filling " + std::string(kind.name),
                      trial.objectCount());
    touch(kind);
    const Stopwatch watch;
    Result result;
    result.kind = &kind;
    result.fillMs = trial.add(kind, [&](std::size_t filled) {
        progress.update(filled);
        return watch.milliseconds() <= seconds * 1000;
    });
    if (!result.fillMs) {
        result.leftOutAfter = seconds;
    }
    return result;
}

// The results of those that take part, by their numbers in the trial.
std::vector<Result*> contestants(Comparison& comparison) {
    std::vector<Result*> filled;
    for (Result& result : comparison.results) {
        if (!result.leftOutAfter) {
            filled.push_back(&result);
        }
    }
    return filled;
}

void removeFromAll(Trial& trial, const ComparisonSettings& settings,
                   const std::vector<Result*>& results, Comparison& comparison) {
    comparison.objectsRemoved = std::min(kObjectsToRemove, (trial.objectCount() + 1) / 2);
    for (std::size_t i = 0; i < results.size(); ++i) {
        Progress progress(settings.err, settings.progress,
                          "removing from " + std::string(results[i]->kind->name),
                          comparison.objectsRemoved);
        results[i]->memoryBytes = trial.memoryBytes(i);
        results[i]->removeMs =
            trial.removeObjects(i, comparison.objectsRemoved, [&](std::size_t removed) {
                progress.update(removed);
                return !settings.limit.isOver();
            });
    }
}

}  // namespace

Comparison fillBroadphases(Trial& trial, const std::vector<const BroadphaseKind*>& kinds,
                           const ComparisonSettings& settings) {
    const double seconds = settings.limit.secondsLeft() / 2;
    const Stopwatch watch;
    Comparison comparison;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const double left = std::max(0.0, seconds - watch.milliseconds() / 1000);
        const double share = left / static_cast<double>(kinds.size() - i);
        comparison.results.push_back(fill(trial, *kinds[i], share, settings));
    }
    return comparison;
}

std::vector<const BroadphaseKind*> contestantsOf(const Comparison& comparison) {
    std::vector<const BroadphaseKind*> kinds;
    for (const Result& result : comparison.results) {
        if (!result.leftOutAfter) {
            kinds.push_back(result.kind);
        }
    }
    return kinds;
}

void runFrames(Trial& trial, const ComparisonSettings& settings, ReplayRecording* replay,
               Comparison& comparison) {
    const std::vector<Result*> results = contestants(comparison);
    comparison.warmUpFrames = std::min(kMostWarmUpFrames, settings.frames / 4);
    std::vector<Verifier> verifiers(results.size());
    const auto frames = static_cast<std::size_t>(settings.frames);
    Progress progress(settings.err, settings.progress, "frame", frames * results.size());

    for (std::size_t frame = 0; frame < frames; ++frame) {
        if (results.empty() || settings.limit.isOver()) {
            comparison.timeLimitHit = true;
            break;
        }
        const auto tell = [&](std::size_t turn, std::string_view what) {
            progress.update(frame * results.size() + turn, withThousands(frame + 1) + " of " +
                                                               withThousands(frames) + ", " +
                                                               std::string(what));
        };
        if (trial.sharesBoxes()) {
            tell(0, "exact pairs");
        }
        trial.beginFrame();
        const bool isReplayed = replay != nullptr && !replay->isFull();
        for (std::size_t turn = 0; turn < results.size(); ++turn) {
            const std::size_t i = (turn + frame) % results.size();
            tell(turn, results[i]->kind->name);
            const Observation seen = trial.runFrame(i);
            const int number = static_cast<int>(frame);
            record(number, number >= comparison.warmUpFrames, seen, verifiers[i], *results[i]);
            if (isReplayed) {
                replay->add(i, {seen.boxes, seen.exact, verifiers[i].missing(),
                                verifiers[i].extra(), seen.cellSize});
            }
        }
        if (isReplayed) {
            replay->finishFrame();
        }
        comparison.framesDone = static_cast<int>(frame) + 1;
    }
    removeFromAll(trial, settings, results, comparison);
}

std::optional<Timing> timingOf(const Result& result) {
    std::vector<double> setAabb;
    std::vector<double> calculate;
    std::vector<double> both;
    std::vector<double> step;
    for (const FrameRow& row : result.rows) {
        if (!row.measured) {
            continue;
        }
        setAabb.push_back(row.setAabbMs);
        calculate.push_back(row.calculateMs);
        both.push_back(row.setAabbMs + row.calculateMs);
        if (row.stepMs) {
            step.push_back(*row.stepMs);
        }
    }
    if (both.empty()) {
        return std::nullopt;
    }
    Timing timing{spreadOf(setAabb), spreadOf(calculate), spreadOf(both), std::nullopt};
    if (!step.empty()) {
        timing.step = spreadOf(step);
    }
    return timing;
}

Tally tallyOf(const Result& result, std::size_t FrameVerdict::*count) {
    Tally tally;
    for (const FrameRow& row : result.rows) {
        tally.total += row.verdict.*count;
        tally.most = std::max(tally.most, row.verdict.*count);
    }
    return tally;
}

}  // namespace hashphase::demos
