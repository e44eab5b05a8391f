// SPDX-License-Identifier: Zlib
#include <demos/paper/phase_measurement.hpp>

#include <demos/compare/reference_pairs.hpp>
#include <demos/console/format.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/scenes/random.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

/// What of an answer for all objects is about the subjects.
PhaseAnswer restricted(Phase phase, const PhaseAnswer& answer, const Subjects& subjects) {
    PhaseAnswer some;
    for (const std::uint64_t key : answer.found) {
        if (subjects.contains(static_cast<std::uint32_t>(key >> 32)) ||
            (phase == Phase::collision && subjects.contains(static_cast<std::uint32_t>(key)))) {
            some.found.push_back(key);
        }
    }
    for (const std::uint32_t object : subjects.list()) {
        const std::size_t first = std::size_t{4} * object;
        for (std::size_t i = first; i < std::min(first + 4, answer.numbers.size()); ++i) {
            some.numbers.push_back(answer.numbers[i]);
        }
    }
    return some;
}

/// Heights and velocities come by sums in another order, and from triangles in another precision.
std::size_t countOfDifferent(const std::vector<float>& a, const std::vector<float>& b) {
    std::size_t count = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        constexpr float kTolerance = 1e-3F;
        const float allowed = kTolerance * std::max(1.0F, std::abs(b[i]));
        count += std::abs(a[i] - b[i]) <= allowed ? 0 : 1;
    }
    return count;
}

constexpr std::uint32_t kFewestOfQuick = 2;  // frames of what is not as slow

Subjects spotSubjects(const PhaseTask& task) {
    return task.objects <= kSpotChecked ? Subjects::all(task.objects)
                                        : Subjects::drawn(task.objects, kSpotChecked, task.seed);
}

class PhaseRun {
public:
    PhaseRun(const PhaseTask& task, std::span<const MethodSpec> specs, const PhaseEffort& effort,
             const IsTimeUp& isTimeUp, Measurements& measured)
        : task_(task),
          effort_(effort),
          isTimeUp_(isTimeUp),
          measured_(measured),
          bed_(task.objects, task.seed),
          random_(task.seed),
          all_(Subjects::all(task.objects)),
          spot_(spotSubjects(task)),
          order_(specs.size()) {
        for (const MethodSpec& spec : specs) {
            const std::int64_t row =
                measured.add("runs", {{"part", task.part},
                                      {"phase", nameOf(task.phase)},
                                      {"objects", task.objects},
                                      {"radius", task.aiRadius},
                                      {"method", nameOf(spec.kind)},
                                      {"cell", spec.cellSize},
                                      {"side", bed_.side()},
                                      {"triangles", bed_.ground().boxes.size()}});
            methods_.push_back(
                {spec.kind, row,
                 spec.make({task.phase, spec.kind, spec.cellSize.value_or(0), task.aiRadius}, bed_,
                           all_),
                 effort.frames});
        }
        std::iota(order_.begin(), order_.end(), std::size_t{0});
    }

    void run() {
        for (std::uint32_t frame = 0; frame <= effort_.frames; ++frame) {
            if (frame > 0) {
                bed_.advance();
            }
            if (!runFrame(frame)) {
                break;
            }
        }
        for (const Entry& each : methods_) {
            if (each.isMeasured) {
                const double cellSize = each.method->cellSize();
                measured_.add("memory",
                              {{"run", each.row},
                               {"bytes", each.method->memoryBytes()},
                               {"chosen_cell", cellSize > 0 ? Datum(cellSize) : Datum()}});
            }
        }
    }

private:
    struct Entry {
        MethodKind kind;
        std::int64_t row;  // of `runs`
        std::unique_ptr<PhaseMethod> method;
        std::uint32_t lastFrame;
        bool isMeasured = false;  // once
        bool isTimed = false;     // in the present frame
    };
    using Turns = std::vector<Entry*>;  // of the present frame

    /// Returns whether there is another one to be run.
    bool runFrame(std::uint32_t frame) {
        if (!effort_.isHurried) {
            shuffle(order_, random_);
        }
        Turns turns;
        for (const std::size_t i : order_) {
            if (frame <= methods_[i].lastFrame && !isTimeUp_()) {
                runMethod(methods_[i], frame);
                turns.push_back(&methods_[i]);
            }
        }
        judge(frame, turns);
        return !turns.empty() && !isTimeUp_();
    }

    void runMethod(Entry& entry, std::uint32_t frame) {
        const FrameClock clock;
        entry.method->hash(bed_);
        const double hashed = clock.milliseconds();
        entry.method->run(bed_);
        const double found = clock.milliseconds();
        entry.method->stand(bed_);
        const double all = clock.milliseconds();
        entry.isTimed =
            frame > 0 || (all > effort_.slowMilliseconds && entry.kind != MethodKind::hashphase);
        if (entry.isTimed) {
            entry.isMeasured = true;
            measured_.add(
                "frames",
                {{"run", entry.row}, {"hash_ms", hashed}, {"stand_ms", all - found}, {"ms", all}});
        }
        if (frame == 0) {
            entry.lastFrame = framesFor(all) - (entry.isTimed ? 1 : 0);  // this one is
        }
    }

    /// How many to time of what takes so long [ms].
    [[nodiscard]] std::uint32_t framesFor(double milliseconds) const {
        const double frames = effort_.methodMilliseconds / std::max(milliseconds, 1e-6);
        const std::uint32_t fewest = milliseconds > effort_.slowMilliseconds
                                         ? effort_.fewestFrames
                                         : std::max(effort_.fewestFrames, kFewestOfQuick);
        return frames > effort_.frames ? effort_.frames
                                       : std::max(static_cast<std::uint32_t>(frames), fewest);
    }

    void judge(std::uint32_t frame, const Turns& turns) {
        const auto unoptimized = std::find_if(turns.begin(), turns.end(), [](const Entry* each) {
            return each->kind == MethodKind::unoptimized;
        });
        if (unoptimized != turns.end()) {
            compare(turns, (*unoptimized)->method->answer(), all_);
        } else if (frame == 0 && !effort_.isHurried && !turns.empty()) {
            // All objects, where they are not too many.
            compareByBruteForce(turns, task_.objects <= kMostBruteForced ? all_ : spot_);
        } else if (!turns.empty() && isLastOfAny(frame, turns)) {
            compareByBruteForce(turns, spot_);
        }
    }

    [[nodiscard]] bool isLastOfAny(std::uint32_t frame, const Turns& turns) const {
        return isTimeUp_() || std::any_of(turns.begin(), turns.end(), [&](const Entry* each) {
                   return frame == each->lastFrame;
               });
    }

    /// Where no method that is measured is right by itself.
    void compareByBruteForce(const Turns& turns, const Subjects& subjects) {
        const auto method =
            makeMethod({task_.phase, MethodKind::unoptimized, 0, task_.aiRadius}, bed_, subjects);
        method->run(bed_);
        method->stand(bed_);
        compare(turns, method->answer(), subjects);
    }

    void compare(const Turns& turns, const PhaseAnswer& right, const Subjects& subjects) {
        for (const Entry* each : turns) {
            const auto fault = faultOf(task_.phase, each->method->answer(), right, subjects);
            measured_.add("checks", {{"run", each->row},
                                     {"timed", each->isTimed},
                                     {"objects", subjects.list().size()},
                                     {"found", right.found.size()},
                                     {"fault", fault ? Datum(*fault) : Datum()}});
        }
    }

    PhaseTask task_;
    const PhaseEffort& effort_;
    const IsTimeUp& isTimeUp_;
    Measurements& measured_;
    TestBed bed_;
    Random random_;
    Subjects all_;
    Subjects spot_;
    std::vector<Entry> methods_;
    std::vector<std::size_t> order_;  // of the methods, in the present frame
};

}  // namespace

std::string_view nameOf(Phase phase) {
    constexpr std::array<std::string_view, 3> kNames{"collision", "visibility", "AI"};
    return kNames[static_cast<std::size_t>(phase)];
}

std::string_view nameOf(MethodKind kind) {
    constexpr std::array<std::string_view, 3> kNames{"un-optimized", "paper's grid", "hashphase"};
    return kNames[static_cast<std::size_t>(kind)];
}

Subjects::Subjects(std::vector<char> isOne) : isOne_(std::move(isOne)) {
    for (std::uint32_t i = 0; i < isOne_.size(); ++i) {
        if (contains(i)) {
            list_.push_back(i);
        }
    }
}

Subjects Subjects::all(std::uint32_t objects) {
    return Subjects(std::vector<char>(objects, 1));
}

Subjects Subjects::drawn(std::uint32_t objects, std::uint32_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<char> isOne(objects, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto object = static_cast<std::uint32_t>(random.unit() * static_cast<float>(objects));
        isOne[std::min(object, objects - 1)] = 1;
    }
    return Subjects(std::move(isOne));
}

std::unique_ptr<PhaseMethod> makeMethod(const MethodPlan& plan, const TestBed& bed,
                                        Subjects subjects) {
    constexpr std::array<MakeMethod*, 3> kMakers{makeCollisionMethod, makeVisibilityMethod,
                                                 makeAiMethod};
    return kMakers[static_cast<std::size_t>(plan.phase)](plan, bed, std::move(subjects));
}

std::vector<MethodSpec> figureMethods(std::uint32_t objects) {
    std::vector<MethodSpec> specs;
    if (objects <= kMostBruteForced) {
        specs.push_back({MethodKind::unoptimized, std::nullopt});
    }
    for (const double cellSize : kPrintedCellSizes) {
        specs.push_back({MethodKind::paperGrid, cellSize});
        specs.push_back({MethodKind::hashphase, cellSize});
    }
    specs.push_back({MethodKind::hashphase, std::nullopt});
    return specs;
}

std::optional<std::string> faultOf(Phase phase, const PhaseAnswer& answer, const PhaseAnswer& right,
                                   const Subjects& subjects) {
    const PhaseAnswer asked = subjects.areAll() ? answer : restricted(phase, answer, subjects);
    const std::size_t missing = countMissing(right.found, asked.found);
    const std::size_t extra = countMissing(asked.found, right.found);
    const std::string ofAll = " of " + withThousands(right.found.size());
    if (missing + extra > 0) {
        return phase == Phase::ai
                   ? withThousands(std::max(missing, extra)) + ofAll + " colours differ"
                   : withThousands(missing) + ofAll + " are missing, " + withThousands(extra) +
                         " are extra";
    }
    const std::size_t wrong = countOfDifferent(asked.numbers, right.numbers);
    return wrong == 0
               ? std::nullopt
               : std::optional(withThousands(wrong) + " of " + withThousands(right.numbers.size()) +
                               " heights and speeds differ");
}

void measurePhase(const PhaseTask& task, std::span<const MethodSpec> specs,
                  const PhaseEffort& effort, Measurements& measured, const IsTimeUp& isTimeUp) {
    PhaseRun(task, specs, effort, isTimeUp, measured).run();
}

}  // namespace hashphase::demos
