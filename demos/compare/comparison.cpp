// SPDX-License-Identifier: Zlib
#include <demos/compare/comparison.hpp>

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

std::vector<Result> fillAll(Trial& trial, const std::vector<const BroadphaseKind*>& kinds,
                            ProgressStyle style, std::ostream& err) {
    std::vector<Result> results;
    Progress progress(err, style, "filling the broadphases", kinds.size());
    for (const BroadphaseKind* kind : kinds) {
        const Stopwatch watch;
        trial.add(*kind);
        Result result;
        result.kind = kind;
        result.fillMs = watch.milliseconds();
        results.push_back(std::move(result));
        progress.update(results.size());
    }
    return results;
}

}  // namespace

Comparison runComparison(Trial& trial, const std::vector<const BroadphaseKind*>& kinds,
                         const ComparisonSettings& settings, std::ostream& err) {
    const Stopwatch watch;
    Comparison comparison;
    comparison.results = fillAll(trial, kinds, settings.progress, err);
    comparison.warmUpFrames = std::min(kMostWarmUpFrames, settings.frames / 4);
    std::vector<Verifier> verifiers(kinds.size());
    Progress progress(err, settings.progress, "frame", static_cast<std::size_t>(settings.frames));

    for (int frame = 0; frame < settings.frames; ++frame) {
        if (settings.timeLimit && watch.milliseconds() > *settings.timeLimit * 1000) {
            comparison.timeLimitHit = true;
            break;
        }
        trial.beginFrame();
        ReplayRecording* const replay =
            settings.replay != nullptr && !settings.replay->isFull() ? settings.replay : nullptr;
        for (std::size_t turn = 0; turn < kinds.size(); ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(frame)) % kinds.size();
            const Observation seen = trial.runFrame(i);
            record(frame, frame >= comparison.warmUpFrames, seen, verifiers[i],
                   comparison.results[i]);
            if (replay != nullptr) {
                replay->add(i, {seen.boxes, seen.exact, verifiers[i].missing(),
                                verifiers[i].extra(), seen.cellSize});
            }
        }
        if (replay != nullptr) {
            replay->finishFrame();
        }
        comparison.framesDone = frame + 1;
        progress.update(static_cast<std::size_t>(comparison.framesDone));
    }
    comparison.objectsRemoved = std::min(kObjectsToRemove, (trial.objectCount() + 1) / 2);
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        comparison.results[i].memoryBytes = trial.memoryBytes(i);
        comparison.results[i].removeMs = trial.removeObjects(i, comparison.objectsRemoved);
    }
    return comparison;
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
