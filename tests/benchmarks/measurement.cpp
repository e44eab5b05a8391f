// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/measurement.hpp>

#include <demos/compare/verifier.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/report/stopwatch.hpp>

#include <algorithm>
#include <limits>

namespace hashphase::benchmarks {
namespace {

// Checking a million boxes takes seconds; so many are checked in every frame.
constexpr std::size_t kCheckedInEveryFrame = 100'000;
constexpr int kCheckedFrames = 10;  // beyond, every tenth

// Who is hopeless shows after as many warm-up frames; one alone may have been disturbed.
constexpr int kFramesBeforeDropping = 2;

bool isChecked(std::size_t objects, int frame) {
    return objects <= kCheckedInEveryFrame || frame % kCheckedFrames == 0;
}

class Run {
public:
    Run(const Case& toRun, const MeasurementSettings& settings)
        : case_(toRun),
          settings_(settings),
          workload_(toRun.benchmark->make(toRun.objects, settings.seed)) {
        result_.name = toRun.name();
        result_.group = toRun.benchmark->group;
        result_.description = toRun.benchmark->description;
        result_.operation = toRun.benchmark->operation;
        result_.objects = workload_->objects();
        result_.operations = workload_->operations();
        result_.warmUpFrames = settings.warmUpFrames;
        warmUpMs_.assign(toRun.contestants.size(), std::numeric_limits<double>::infinity());
    }

    CaseResult run() {
        for (const ContestantKind& kind : case_.contestants) {
            const demos::Stopwatch watch;
            workload_->add(kind);
            ContestantResult contestant;
            contestant.kind = kind;
            contestant.fillMs = watch.milliseconds();
            result_.contestants.push_back(std::move(contestant));
        }
        const int frames = settings_.warmUpFrames + settings_.frames;
        for (int frame = 0; frame < frames; ++frame) {
            if (settings_.isTimeUp()) {
                result_.timeLimitHit = true;
                break;
            }
            runFrame(frame);
            settings_.tellProgress(frame + 1);
        }
        return std::move(result_);
    }

private:
    void runFrame(int frame) {
        workload_->beginFrame();
        const bool checked = isChecked(result_.objects, frame);
        if (checked) {
            workload_->listExactAnswers(exact_);
        }
        const std::size_t count = result_.contestants.size();
        for (std::size_t turn = 0; turn < count; ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(frame)) % count;
            if (result_.contestants[i].droppedOut) {
                continue;
            }
            letRun(i, frame);
            if (checked) {
                check(i, frame);
            }
            workload_->endFrame(i);
        }
        if (frame >= settings_.warmUpFrames) {
            ++result_.framesDone;
        } else if (frame + 1 >= kFramesBeforeDropping) {
            dropHopeless();
        }
    }

    void letRun(std::size_t i, int frame) {
        ContestantResult& contestant = result_.contestants[i];
        if (frame >= settings_.warmUpFrames) {
            contestant.frameMs.push_back(workload_->runFrame(i));
            return;
        }
        const demos::FrameClock watch;
        workload_->runWatchedFrame(i);
        warmUpMs_[i] = std::min(warmUpMs_[i], watch.milliseconds());
        contestant.memory = workload_->memory(i);
    }

    void check(std::size_t i, int frame) {
        ContestantResult& contestant = result_.contestants[i];
        workload_->listAnswers(i, answers_);
        const std::string fault = auditAnswers(answers_, exact_, contestant.tally);
        if (contestant.firstFault.empty() && !fault.empty()) {
            contestant.firstFault = fault + " in frame " + std::to_string(frame);
        }
    }

    void dropHopeless() {
        const double factor = case_.benchmark->dropFactor;
        if (factor <= 0) {
            return;
        }
        double fastest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < warmUpMs_.size(); ++i) {
            if (!result_.contestants[i].droppedOut) {
                fastest = std::min(fastest, warmUpMs_[i]);
            }
        }
        for (std::size_t i = 0; i < warmUpMs_.size(); ++i) {
            result_.contestants[i].droppedOut |= warmUpMs_[i] > factor * fastest;
        }
    }

    const Case& case_;
    const MeasurementSettings& settings_;
    std::unique_ptr<Workload> workload_;
    CaseResult result_;
    std::vector<double> warmUpMs_;  // of the quickest warm-up frame, by contestant
    std::vector<Answer> answers_;
    std::vector<Answer> exact_;
};

std::string answerText(const char* fault, Answer answer) {
    return std::string(fault) + " (" + std::to_string(demos::firstOf(answer)) + ", " +
           std::to_string(demos::secondOf(answer)) + ")";
}

}  // namespace

std::string auditAnswers(std::vector<Answer>& answers, const std::vector<Answer>& exact,
                         AnswerTally& tally) {
    ++tally.framesChecked;
    tally.answers += answers.size();
    tally.exact += exact.size();
    std::sort(answers.begin(), answers.end());
    const auto end = std::unique(answers.begin(), answers.end());
    const auto duplicates = static_cast<std::uint64_t>(answers.end() - end);
    tally.duplicates += duplicates;
    answers.erase(end, answers.end());
    const demos::FrameVerdict verdict = demos::Verifier().judge(answers, exact);
    tally.missing += verdict.missing;
    tally.extra += verdict.extra;
    if (verdict.firstMissing) {
        return answerText("missed", *verdict.firstMissing);
    }
    if (verdict.firstExtra) {
        return answerText("reported in excess", *verdict.firstExtra);
    }
    return duplicates > 0 ? "reported " + std::to_string(duplicates) + " answers again"
                          : std::string();
}

std::optional<demos::Spread> ContestantResult::spread() const {
    return frameMs.empty() ? std::nullopt : std::optional(demos::spreadOf(frameMs));
}

const ContestantResult* CaseResult::find(std::string_view contestant) const {
    const auto found =
        std::find_if(contestants.begin(), contestants.end(),
                     [contestant](const ContestantResult& c) { return c.kind.name == contestant; });
    return found == contestants.end() ? nullptr : &*found;
}

bool CaseResult::oursWereExact() const {
    return std::all_of(contestants.begin(), contestants.end(),
                       [](const ContestantResult& c) { return !c.kind.ours || c.tally.isExact(); });
}

std::optional<double> speedAgainst(const ContestantResult* other, const ContestantResult& own) {
    if (other == nullptr) {
        return std::nullopt;
    }
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(other->frameMs.size(), own.frameMs.size()); ++i) {
        if (own.frameMs[i] > 0) {
            ratios.push_back(other->frameMs[i] / own.frameMs[i]);
        }
    }
    return ratios.empty() ? std::nullopt : std::optional(demos::spreadOf(ratios).median);
}

CaseResult measure(const Case& toRun, const MeasurementSettings& settings) {
    return Run(toRun, settings).run();
}

}  // namespace hashphase::benchmarks
