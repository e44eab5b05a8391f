// SPDX-License-Identifier: Zlib
#include <demos/paper/phase_measurement.hpp>

#include <demos/console/format.hpp>
#include <demos/report/frame_clock.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

/// What of an answer for all objects is about the subjects.
PhaseAnswer restricted(Phase phase, const PhaseAnswer& answer, const Subjects& subjects) {
    PhaseAnswer some;
    for (std::size_t i = 0; i < answer.found.size(); ++i) {
        const std::uint64_t found = answer.found[i];
        const auto low = static_cast<std::uint32_t>(found);
        const auto high = static_cast<std::uint32_t>(found >> 32);
        const bool isAsked = phase == Phase::ai ? subjects.contains(static_cast<std::uint32_t>(i))
                             : phase == Phase::collision
                                 ? subjects.contains(low) || subjects.contains(high)
                                 : subjects.contains(low);
        if (isAsked) {
            some.found.push_back(found);
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

std::size_t countOfFirstAlone(const std::vector<std::uint64_t>& a,
                              const std::vector<std::uint64_t>& b) {
    std::vector<std::uint64_t> alone;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(alone));
    return alone.size();
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

std::size_t countOfDifferent(const std::vector<std::uint64_t>& a,
                             const std::vector<std::uint64_t>& b) {
    std::size_t count = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        count += a[i] == b[i] ? 0 : 1;
    }
    return count;
}

constexpr std::uint32_t kFewestOfQuick = 2;  // frames of what is not as slow

/// Whom the others are compared with where no method that is measured is right by itself.
class Judge {
public:
    Judge(const PhaseTask& task, Subjects subjects)
        : subjects_(std::move(subjects)),
          method_(bruteForce(task.phase, subjects_, task.aiRadius)) {}

    [[nodiscard]] PhaseAnswer answer(const TestBed& bed) {
        method_->run(bed);
        method_->stand(bed);
        return method_->answer();
    }
    [[nodiscard]] const Subjects& subjects() const { return subjects_; }

private:
    Subjects subjects_;
    std::unique_ptr<PhaseMethod> method_;
};

Subjects spotSubjects(const PhaseTask& task) {
    return task.objects <= kSpotChecked ? Subjects::all(task.objects)
                                        : Subjects::drawn(task.objects, kSpotChecked, task.seed);
}

/// All objects, where they are not too many.
Subjects firstSubjects(const PhaseTask& task) {
    return task.objects <= kMostBruteForced ? Subjects::all(task.objects) : spotSubjects(task);
}

void shuffle(std::vector<std::size_t>& order, Random& random) {
    for (std::size_t left = order.size(); left > 1; --left) {
        const auto other = static_cast<std::size_t>(random.unit() * static_cast<float>(left));
        std::swap(order[left - 1], order[std::min(other, left - 1)]);
    }
}

PhaseResult unmeasured(const PhaseTask& task, std::span<const MethodSpec> specs) {
    PhaseResult result;
    result.task = task;
    for (const MethodSpec& spec : specs) {
        result.methods.emplace_back();
        result.methods.back().kind = spec.kind;
        result.methods.back().cellSize = spec.cellSize;
    }
    return result;
}

class PhaseRun {
public:
    PhaseRun(const PhaseTask& task, std::span<const MethodSpec> specs, const PhaseEffort& effort,
             const IsTimeUp& isTimeUp)
        : effort_(effort),
          isTimeUp_(isTimeUp),
          bed_(task.objects, task.seed),
          random_(task.seed),
          all_(Subjects::all(task.objects)),
          firstJudge_(task, firstSubjects(task)),
          lastJudge_(task, spotSubjects(task)),
          result_(unmeasured(task, specs)) {
        for (const MethodSpec& spec : specs) {
            methods_.push_back(spec.make(bed_));
        }
        lastFrame_.assign(specs.size(), effort.frames);
        order_.resize(specs.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        result_.side = bed_.side();
        result_.triangles = bed_.ground().boxes.size();
    }

    PhaseResult run() {
        for (std::uint32_t frame = 0; frame <= effort_.frames; ++frame) {
            if (frame > 0) {
                bed_.advance();
            }
            if (!runFrame(frame)) {
                break;
            }
        }
        for (std::size_t i = 0; i < methods_.size(); ++i) {
            MethodResult& method = result_.methods[i];
            if (method.isMeasured()) {
                method.bytes = methods_[i]->memoryBytes();
                const double cellSize = methods_[i]->cellSize();
                method.chosenCellSize = cellSize > 0 ? std::optional(cellSize) : std::nullopt;
            }
        }
        return std::move(result_);
    }

private:
    struct Turn {
        std::size_t method;
        bool isTimed;
    };

    /// Returns whether there is another one to be run.
    bool runFrame(std::uint32_t frame) {
        if (!effort_.isHurried) {
            shuffle(order_, random_);
        }
        std::vector<Turn> turns;
        for (const std::size_t i : order_) {
            if (frame <= lastFrame_[i] && !isTimeUp_()) {
                turns.push_back({i, runMethod(i, frame)});
            }
        }
        judge(frame, turns);
        return !turns.empty() && !isTimeUp_();
    }

    /// Returns whether the frame counts.
    bool runMethod(std::size_t i, std::uint32_t frame) {
        const FrameClock clock;
        methods_[i]->hash(bed_);
        const double hashed = clock.milliseconds();
        methods_[i]->run(bed_);
        const double found = clock.milliseconds();
        methods_[i]->stand(bed_);
        const double all = clock.milliseconds();
        MethodResult& method = result_.methods[i];
        const bool isTimed =
            frame > 0 || (all > effort_.slowMilliseconds && method.kind != MethodKind::hashphase);
        if (isTimed) {
            method.frameMs.push_back(all);
            method.hashMs.push_back(hashed);
            method.standMs.push_back(all - found);
        }
        if (frame == 0) {
            lastFrame_[i] = framesFor(all) - (isTimed ? 1 : 0);  // this one is
        }
        return isTimed;
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

    void judge(std::uint32_t frame, const std::vector<Turn>& turns) {
        const auto unoptimized = std::find_if(turns.begin(), turns.end(), [this](const Turn& turn) {
            return result_.methods[turn.method].kind == MethodKind::unoptimized;
        });
        if (unoptimized != turns.end()) {
            compare(turns, methods_[unoptimized->method]->answer(), all_);
        } else if (frame == 0 && !effort_.isHurried && !turns.empty()) {
            compare(turns, firstJudge_.answer(bed_), firstJudge_.subjects());
        } else if (!turns.empty() && isLastOfAny(frame, turns)) {
            compare(turns, lastJudge_.answer(bed_), lastJudge_.subjects());
        }
    }

    [[nodiscard]] bool isLastOfAny(std::uint32_t frame, const std::vector<Turn>& turns) const {
        return isTimeUp_() || std::any_of(turns.begin(), turns.end(), [&](const Turn& turn) {
                   return frame == lastFrame_[turn.method];
               });
    }

    void compare(const std::vector<Turn>& turns, const PhaseAnswer& right,
                 const Subjects& subjects) {
        result_.found = std::max(result_.found, right.found.size());
        for (const auto& [i, isTimed] : turns) {
            MethodResult& method = result_.methods[i];
            const std::string fault =
                faultOf(result_.task.phase, methods_[i]->answer(), right, subjects);
            ++method.checkedFrames;
            method.checkedTimed += isTimed ? 1 : 0;
            method.checkedObjects += subjects.list().size();
            if (!fault.empty()) {
                method.fault = method.wrongFrames == 0 ? fault : method.fault;
                ++method.wrongFrames;
            }
        }
    }

    const PhaseEffort& effort_;
    const IsTimeUp& isTimeUp_;
    TestBed bed_;
    Random random_;
    Subjects all_;
    Judge firstJudge_;
    Judge lastJudge_;
    PhaseResult result_;
    std::vector<std::unique_ptr<PhaseMethod>> methods_;
    std::vector<std::uint32_t> lastFrame_;  // of each method
    std::vector<std::size_t> order_;        // of the methods, in the present frame
};

}  // namespace

std::vector<double> MethodResult::lookMs() const {
    std::vector<double> differences;
    for (std::size_t i = 0; i < frameMs.size(); ++i) {
        differences.push_back(frameMs[i] - hashMs[i] - standMs[i]);
    }
    return differences;
}

std::optional<double> MethodResult::rate() const {
    constexpr double kSecond = 1000;  // [ms]
    return isMeasured() ? std::optional(kSecond / time().median) : std::nullopt;
}

const MethodResult* PhaseResult::find(MethodKind kind, std::optional<double> cellSize) const {
    const auto method = std::find_if(methods.begin(), methods.end(), [&](const MethodResult& each) {
        return each.kind == kind && each.cellSize == cellSize;
    });
    return method == methods.end() ? nullptr : &*method;
}

std::string describe(const MethodResult& method) {
    std::string text(nameOf(method.kind));
    if (method.cellSize) {
        text += ", cells of " + fixed(*method.cellSize, 0) + " m";
    } else if (method.kind == MethodKind::hashphase) {
        text += ", automatic cells";
    }
    return text;
}

std::string faultOf(Phase phase, const PhaseAnswer& answer, const PhaseAnswer& right,
                    const Subjects& subjects) {
    const PhaseAnswer asked = subjects.areAll() ? answer : restricted(phase, answer, subjects);
    if (phase == Phase::ai) {
        const std::size_t wrong = countOfDifferent(asked.found, right.found);
        return wrong == 0 ? std::string()
                          : withThousands(wrong) + " of " + withThousands(right.found.size()) +
                                " colours differ";
    }
    const std::size_t missing = countOfFirstAlone(right.found, asked.found);
    const std::size_t extra = countOfFirstAlone(asked.found, right.found);
    if (missing + extra > 0) {
        return withThousands(missing) + " of " + withThousands(right.found.size()) +
               " are missing, " + withThousands(extra) + " are extra";
    }
    const std::size_t wrong = countOfDifferent(asked.numbers, right.numbers);
    return wrong == 0 ? std::string()
                      : withThousands(wrong) + " of " + withThousands(right.numbers.size()) +
                            " heights and speeds differ";
}

PhaseResult measurePhase(const PhaseTask& task, std::span<const MethodSpec> specs,
                         const PhaseEffort& effort, const IsTimeUp& isTimeUp) {
    return PhaseRun(task, specs, effort, isTimeUp).run();
}

PaperCheck agreement(std::span<const PhaseResult> results) {
    std::size_t timed = 0;
    std::size_t checkedTimed = 0;
    std::size_t checked = 0;
    std::string faults;
    for (const PhaseResult& result : results) {
        for (const MethodResult& method : result.methods) {
            timed += method.frameMs.size();
            checkedTimed += method.checkedTimed;
            checked += method.checkedFrames;
            if (method.wrongFrames > 0) {
                faults += (faults.empty() ? "" : "; ") + std::string(nameOf(result.task.phase)) +
                          " of " + withThousands(result.task.objects) + ", " + describe(method) +
                          ": " + method.fault;
            }
        }
    }
    const CheckOutcome outcome = !faults.empty() ? CheckOutcome::broken
                                 : checked == 0  ? CheckOutcome::notChecked
                                                 : CheckOutcome::holds;
    return {"Every method finds what brute force finds in the same frame", outcome,
            faults.empty() ? withThousands(checkedTimed) + " of " + withThousands(timed) +
                                 " timed frames checked, and " +
                                 withThousands(checked - checkedTimed) + " that are not timed"
                           : faults};
}

}  // namespace hashphase::demos
