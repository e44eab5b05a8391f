// SPDX-License-Identifier: Zlib
#include <demos/compare/comparison.hpp>

#include <demos/compare/filled_broadphase.hpp>
#include <demos/console/format.hpp>
#include <demos/report/json_values.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace hashphase::demos {
namespace {

// The caches and the adaptive parts settle in so many frames at most.
constexpr int kMostWarmUpFrames = 10;

constexpr std::size_t kObjectsToRemove = 1000;

// JSON has no numbers for what is not finite.
Json cornerJson(const Vector3<float>& corner) {
    Json numbers = Json::array();
    for (const float number : corner) {
        numbers.push_back(std::isfinite(number) ? Json(number) : Json(nullptr));
    }
    return numbers;
}

// The first pair that a broadphase got wrong.
void recordFault(std::string_view name, int frame, const PairVerdict& verdict,
                 std::span<const Aabb<float>> boxes, Measurements& measured) {
    const bool isMissing = !verdict.missing.empty();
    const PairKey pair = isMissing ? verdict.missing.front() : verdict.extra.front();
    Json boxesJson = Json::array();
    for (const std::uint32_t object : {firstOf(pair), secondOf(pair)}) {
        boxesJson.push_back(
            {{"min", cornerJson(boxes[object].min())}, {"max", cornerJson(boxes[object].max())}});
    }
    measured.add("faults", {{"name", name},
                            {"fault_frame", frame},
                            {"kind", isMissing ? "missing" : "extra"},
                            {"first", firstOf(pair)},
                            {"second", secondOf(pair)},
                            {"first_text", boxText(boxes[firstOf(pair)])},
                            {"second_text", boxText(boxes[secondOf(pair)])},
                            {"objects_json", Json::array({firstOf(pair), secondOf(pair)}).dump()},
                            {"boxes_json", boxesJson.dump()}});
}

const PairVerdict& record(int frame, bool isTimed, const Observation& seen, Contestant& contestant,
                          Measurements& measured) {
    const PairVerdict& verdict = contestant.verifier.judge(seen.reported, seen.exact);
    measured.add("frames", {{"name", contestant.kind->name},
                            {"frame", frame},
                            {"measured", isTimed},
                            {"pairs", seen.reported.size()},
                            {"exact_pairs", seen.exact.size()},
                            {"missing", verdict.missing.size()},
                            {"extra", verdict.extra.size()},
                            {"stale", verdict.stale},
                            {"set_aabb_ms", seen.setAabbMs},
                            {"calculate_ms", seen.calculateMs},
                            {"step_ms", seen.stepMs}});
    if (!contestant.isWrong && !(verdict.missing.empty() && verdict.extra.empty())) {
        contestant.isWrong = true;
        recordFault(contestant.kind->name, frame, verdict, seen.boxes, measured);
    }
    return verdict;
}

// Brings its code into memory, so that its filling tells nothing of that.
void touch(const BroadphaseKind& kind) {
    const Aabb<float> box(Vector3<float>::Zero(), Vector3<float>::Ones());
    FilledBroadphase once(kind, {box, 1});
    once.create(0, {btVector3(0, 0, 0), btVector3(1, 1, 1)}, {});
}

Contestant fill(Trial& trial, const BroadphaseKind& kind, double seconds,
                const ComparisonSettings& settings) {
    Progress progress(settings.err, settings.progress, "filling " + std::string(kind.name),
                      trial.facts.objects);
    touch(kind);
    const Stopwatch watch;
    Contestant contestant;
    contestant.kind = &kind;
    contestant.fillMs = trial.add(kind, [&](std::size_t filled) {
        progress.update(filled);
        return watch.milliseconds() <= seconds * 1000 && !isInterrupted();
    });
    if (!contestant.fillMs) {
        contestant.leftOutAfter = std::min(seconds, watch.milliseconds() / 1000);
    }
    return contestant;
}

// Those that take part, by their numbers in the trial.
std::vector<Contestant*> filled(std::vector<Contestant>& all) {
    std::vector<Contestant*> some;
    for (Contestant& each : all) {
        if (!each.leftOutAfter) {
            some.push_back(&each);
        }
    }
    return some;
}

// Of all that were asked for.
void recordEnd(Trial& trial, const ComparisonSettings& settings, std::size_t objectsToRemove,
               std::span<const Contestant> contestants, Measurements& measured) {
    std::size_t number = 0;
    for (const Contestant& each : contestants) {
        std::optional<std::int64_t> memory;
        std::optional<double> removeMs;
        if (!each.leftOutAfter) {
            Progress progress(settings.err, settings.progress,
                              "removing from " + std::string(each.kind->name), objectsToRemove);
            memory = trial.memoryBytes(number);
            removeMs = trial.removeObjects(number, objectsToRemove, [&](std::size_t removed) {
                progress.update(removed);
                return !settings.limit.isOver();
            });
            ++number;
        }
        measured.add("broadphases", {{"name", each.kind->name},
                                     {"title", each.kind->title},
                                     {"ours", each.kind->ours},
                                     {"fill_ms", each.fillMs},
                                     {"left_out_after", each.leftOutAfter},
                                     {"remove_ms", removeMs},
                                     {"memory", memory}});
    }
}

}  // namespace

std::vector<Contestant> fillBroadphases(Trial& trial,
                                        const std::vector<const BroadphaseKind*>& kinds,
                                        const ComparisonSettings& settings) {
    const double seconds = settings.limit.secondsLeft() / 2;
    const Stopwatch watch;
    std::vector<Contestant> contestants;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        const double left = std::max(0.0, seconds - watch.milliseconds() / 1000);
        const double share = left / static_cast<double>(kinds.size() - i);
        contestants.push_back(fill(trial, *kinds[i], share, settings));
    }
    return contestants;
}

ComparisonEnd runFrames(Trial& trial, const ComparisonSettings& settings,
                        std::vector<Contestant>& all, ReplayRecording* replay,
                        Measurements& measured) {
    const std::vector<Contestant*> contestants = filled(all);
    ComparisonEnd end;
    end.warmUpFrames = std::min(kMostWarmUpFrames, settings.frames / 4);
    end.objectsToRemove = std::min(kObjectsToRemove, (trial.facts.objects + 1) / 2);
    const auto frames = static_cast<std::size_t>(settings.frames);
    Progress progress(settings.err, settings.progress, "frame", frames * contestants.size());

    for (std::size_t frame = 0; frame < frames; ++frame) {
        end.isStopped = settings.limit.isOver();
        if (end.isStopped || contestants.empty()) {
            break;
        }
        const auto tell = [&](std::size_t turn, std::string_view what) {
            progress.update(frame * contestants.size() + turn, withThousands(frame + 1) + " of " +
                                                                   withThousands(frames) + ", " +
                                                                   std::string(what));
        };
        if (trial.facts.sharesBoxes) {
            tell(0, "exact pairs");
        }
        trial.beginFrame();
        const bool isReplayed = replay != nullptr && !replay->isFull();
        for (std::size_t turn = 0; turn < contestants.size(); ++turn) {
            const std::size_t i = (turn + frame) % contestants.size();
            Contestant& contestant = *contestants[i];
            tell(turn, contestant.kind->name);
            const Observation seen = trial.runFrame(i);
            const int number = static_cast<int>(frame);
            const PairVerdict& verdict =
                record(number, number >= end.warmUpFrames, seen, contestant, measured);
            if (isReplayed) {
                replay->add(
                    i, {seen.boxes, seen.exact, verdict.missing, verdict.extra, seen.cellSize});
            }
        }
        if (isReplayed) {
            replay->finishFrame();
        }
        end.framesDone = static_cast<int>(frame) + 1;
    }
    recordEnd(trial, settings, end.objectsToRemove, all, measured);
    return end;
}

}  // namespace hashphase::demos
