// SPDX-License-Identifier: Zlib
#include <demos/paper/phase_measurement.hpp>

#include <demos/console/format.hpp>
#include <demos/report/frame_clock.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

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

constexpr double kSlowFrame = 250;           // [ms]; that memory was new then matters little
constexpr std::uint32_t kFewestOfQuick = 2;  // frames of what is not as slow

class PhaseRun {
public:
    PhaseRun(const PhaseTask& task, std::span<const MethodSpec> specs, const PhaseEffort& effort,
             const IsTimeUp& isTimeUp)
        : effort_(effort),
          isTimeUp_(isTimeUp),
          bed_(task.objects, task.seed),
          subjects_(task.objects <= kMostBruteForced
                        ? Subjects::all(task.objects)
                        : Subjects::drawn(task.objects, kSubjectsBeyond, task.seed)),
          judge_(bruteForce(task.phase, subjects_, task.aiRadius)) {
        result_.task = task;
        result_.subjects = static_cast<std::uint32_t>(subjects_.list().size());
        for (const MethodSpec& spec : specs) {
            methods_.push_back(spec.make(bed_));
            result_.methods.emplace_back();
            result_.methods.back().kind = spec.kind;
            result_.methods.back().cellSize = spec.cellSize;
        }
        lastFrame_.assign(specs.size(), effort.frames);
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
            result_.methods[i].bytes = methods_[i]->memoryBytes();
        }
        return std::move(result_);
    }

private:
    /// Returns whether there is another one to be run.
    bool runFrame(std::uint32_t frame) {
        std::vector<std::size_t> ran;
        for (std::size_t turn = 0; turn < methods_.size() && !isTimeUp_(); ++turn) {
            const std::size_t i = (turn + frame) % methods_.size();
            if (frame <= lastFrame_[i]) {
                const FrameClock clock;
                methods_[i]->hash(bed_);
                const double hashed = clock.milliseconds();
                methods_[i]->run(bed_);
                note(i, frame, hashed, clock.milliseconds());
                ran.push_back(i);
            }
        }
        judge(frame, ran);
        return !ran.empty() && !isTimeUp_();
    }

    void note(std::size_t i, std::uint32_t frame, double hashed, double milliseconds) {
        MethodResult& method = result_.methods[i];
        if (frame > 0 || (milliseconds > kSlowFrame && method.kind != MethodKind::hashphase)) {
            method.frameMs.push_back(milliseconds);
            method.hashMs.push_back(hashed);
        }
        if (frame == 0) {
            const double frames = effort_.methodMilliseconds / std::max(milliseconds, 1e-6);
            const std::uint32_t fewest = milliseconds > kSlowFrame
                                             ? effort_.fewestFrames
                                             : std::max(effort_.fewestFrames, kFewestOfQuick);
            const std::uint32_t measured =
                frames > effort_.frames ? effort_.frames
                                        : std::max(static_cast<std::uint32_t>(frames), fewest);
            lastFrame_[i] = measured - (method.isMeasured() ? 1 : 0);  // this one is
        }
    }

    void judge(std::uint32_t frame, const std::vector<std::size_t>& ran) {
        const auto unoptimized = std::find_if(ran.begin(), ran.end(), [this](std::size_t i) {
            return result_.methods[i].kind == MethodKind::unoptimized;
        });
        const bool isDue = frame == 0 || frame + 1 == effort_.fewestFrames;
        if (ran.empty() || (unoptimized == ran.end() && (!isDue || isTimeUp_()))) {
            return;
        }
        PhaseAnswer right;
        if (unoptimized != ran.end()) {
            right = methods_[*unoptimized]->answer();
        } else {
            judge_->run(bed_);
            right = judge_->answer();
        }
        if (frame == 0) {
            result_.found = right.found.size();
        }
        for (const std::size_t i : ran) {
            MethodResult& method = result_.methods[i];
            const std::string fault =
                faultOf(result_.task.phase, methods_[i]->answer(), right, subjects_);
            ++method.checkedFrames;
            if (!fault.empty()) {
                method.fault = method.wrongFrames == 0 ? fault : method.fault;
                ++method.wrongFrames;
            }
        }
    }

    const PhaseEffort& effort_;
    const IsTimeUp& isTimeUp_;
    TestBed bed_;
    Subjects subjects_;
    std::unique_ptr<PhaseMethod> judge_;
    PhaseResult result_;
    std::vector<std::unique_ptr<PhaseMethod>> methods_;
    std::vector<std::uint32_t> lastFrame_;  // of each method
};

}  // namespace

std::vector<double> MethodResult::lookMs() const {
    std::vector<double> differences;
    std::transform(frameMs.begin(), frameMs.end(), hashMs.begin(), std::back_inserter(differences),
                   std::minus<>());
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

Check agreement(std::span<const PhaseResult> results) {
    std::size_t checked = 0;
    std::string faults;
    for (const PhaseResult& result : results) {
        for (const MethodResult& method : result.methods) {
            checked += method.checkedFrames;
            if (method.wrongFrames > 0) {
                faults += (faults.empty() ? "" : "; ") + std::string(nameOf(result.task.phase)) +
                          " of " + withThousands(result.task.objects) + ", " + describe(method) +
                          ": " + method.fault;
            }
        }
    }
    return {"Every method finds what brute force finds in the same frame", faults.empty(),
            faults.empty() ? withThousands(checked) + " frames of all methods compared" : faults};
}

}  // namespace hashphase::demos
