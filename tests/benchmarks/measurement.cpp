// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/measurement.hpp>

#include <demos/compare/heap_meter.hpp>
#include <demos/compare/verifier.hpp>
#include <demos/report/frame_clock.hpp>
#include <demos/report/stopwatch.hpp>

#include <algorithm>
#include <limits>
#include <optional>

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
    Run(const Case& toRun, const MeasurementSettings& settings, demos::Measurements& measured)
        : settings_(settings),
          measured_(measured),
          dropFactor_(toRun.benchmark->dropFactor),
          workload_(toRun.benchmark->make(toRun.objects, settings.seed)) {
        const Benchmark& benchmark = *toRun.benchmark;
        row_ = measured.add("cases", {{"name", toRun.name()},
                                      {"group", benchmark.group},
                                      {"description", benchmark.description},
                                      {"operation", benchmark.operation},
                                      {"objects", workload_->objects()},
                                      {"operations", workload_->operations()},
                                      {"warm_up_frames", settings.warmUpFrames},
                                      {"frames_asked", settings.frames}});
        for (const ContestantKind& kind : toRun.contestants) {
            addContestant(kind);
        }
    }

    std::int64_t run() {
        const int frames = settings_.warmUpFrames + settings_.frames;
        for (int frame = 0; frame < frames && !settings_.isTimeUp(); ++frame) {
            runFrame(frame);
            settings_.tellProgress(frame + 1);
        }
        for (const Entry& entry : entries_) {
            const auto own = entry.runner->ownBytes();
            measured_.add(
                "ends", {{"contestant", entry.row},
                         {"dropped_out", entry.droppedOut},
                         {"heap_bytes", entry.heapBytes},
                         {"own_for_objects", own ? demos::Datum(own->forObjects) : demos::Datum()},
                         {"own_for_pairs", own ? demos::Datum(own->forPairs) : demos::Datum()}});
        }
        return row_;
    }

private:
    struct Entry {
        std::int64_t row;  // of `contestants`
        bool onThreads;
        std::unique_ptr<Runner> runner;
        demos::HeapMeter heap;
        std::optional<std::int64_t> heapBytes = std::nullopt;       // as warmed up
        double warmUpMs = std::numeric_limits<double>::infinity();  // of the quickest such frame
        bool droppedOut = false;  // too slow, see Benchmark::dropFactor
    };

    void addContestant(const ContestantKind& kind) {
        const demos::Stopwatch watch;
        Entry& entry = entries_.emplace_back(Entry{0, kind.onThreads, nullptr, {}});
        watched(entry, [&] { entry.runner = workload_->make(kind); });
        entry.row = measured_.add("contestants", {{"case", row_},
                                                  {"name", kind.name},
                                                  {"title", kind.title},
                                                  {"package", kind.package},
                                                  {"ours", kind.ours},
                                                  {"fill_ms", watch.milliseconds()}});
    }

    /// While the contestant's heap is watched, which costs time of its own.
    template <class Work>
    void watched(Entry& entry, const Work& work) {
        if (!workload_->watchesHeap()) {
            return work();
        }
        const demos::HeapScope scope(entry.heap);
        work();
    }

    void runFrame(int frame) {
        workload_->beginFrame();
        for (const Entry& entry : entries_) {
            if (!entry.droppedOut) {
                entry.runner->beginFrame();
            }
        }
        const bool checked = isChecked(workload_->objects(), frame);
        if (checked) {
            workload_->listExactAnswers(exact_);
        }
        for (std::size_t turn = 0; turn < entries_.size(); ++turn) {
            Entry& entry = entries_[(turn + static_cast<std::size_t>(frame)) % entries_.size()];
            if (entry.droppedOut) {
                continue;
            }
            letRun(entry, frame);
            if (checked) {
                check(entry, frame);
            }
            entry.runner->endFrame();
        }
        if (frame < settings_.warmUpFrames && frame + 1 >= kFramesBeforeDropping) {
            dropHopeless();
        }
    }

    void letRun(Entry& entry, int frame) {
        entry.runner->prepare();
        if (frame < settings_.warmUpFrames) {
            const demos::FrameClock clock;
            watched(entry, [&] { entry.runner->run(); });
            entry.warmUpMs = std::min(entry.warmUpMs, clock.milliseconds());
            entry.heapBytes = workload_->watchesHeap() ? entry.heap.bytes() : std::nullopt;
            return;
        }
        const demos::FrameClock clock(entry.onThreads);
        entry.runner->run();
        const double milliseconds = clock.milliseconds();
        measured_.add("frames",
                      {{"contestant", entry.row}, {"frame", frame}, {"ms", milliseconds}});
    }

    void check(Entry& entry, int frame) {
        entry.runner->listAnswers(answers_);
        const FrameAudit audit = auditAnswers(answers_, exact_);
        measured_.add("checks", {{"contestant", entry.row},
                                 {"frame", frame},
                                 {"answers", audit.answers},
                                 {"exact", exact_.size()},
                                 {"missing", audit.missing},
                                 {"extra", audit.extra},
                                 {"duplicates", audit.duplicates},
                                 {"fault", audit.fault.empty() ? demos::Datum() : audit.fault}});
    }

    void dropHopeless() {
        if (dropFactor_ <= 0) {
            return;
        }
        double fastest = std::numeric_limits<double>::infinity();
        for (const Entry& entry : entries_) {
            fastest = entry.droppedOut ? fastest : std::min(fastest, entry.warmUpMs);
        }
        for (Entry& entry : entries_) {
            entry.droppedOut |= entry.warmUpMs > dropFactor_ * fastest;
        }
    }

    const MeasurementSettings& settings_;
    demos::Measurements& measured_;
    double dropFactor_;
    std::unique_ptr<Workload> workload_;
    std::int64_t row_;  // of `cases`
    std::vector<Entry> entries_;
    std::vector<Answer> answers_;
    std::vector<Answer> exact_;
};

std::string answerText(const char* fault, Answer answer) {
    return std::string(fault) + " (" + std::to_string(demos::firstOf(answer)) + ", " +
           std::to_string(demos::secondOf(answer)) + ")";
}

}  // namespace

FrameAudit auditAnswers(std::vector<Answer>& answers, const std::vector<Answer>& exact) {
    FrameAudit audit;
    audit.answers = answers.size();
    std::sort(answers.begin(), answers.end());
    const auto end = std::unique(answers.begin(), answers.end());
    audit.duplicates = static_cast<std::size_t>(answers.end() - end);
    answers.erase(end, answers.end());
    demos::Verifier verifier;
    const demos::PairVerdict& verdict = verifier.judge(answers, exact);
    audit.missing = verdict.missing.size();
    audit.extra = verdict.extra.size();
    audit.fault = audit.missing > 0 ? answerText("missed", verdict.missing.front())
                  : audit.extra > 0 ? answerText("reported in excess", verdict.extra.front())
                  : audit.duplicates > 0
                      ? "reported " + std::to_string(audit.duplicates) + " answers again"
                      : "";
    return audit;
}

std::int64_t measure(const Case& toRun, const MeasurementSettings& settings,
                     demos::Measurements& measured) {
    return Run(toRun, settings, measured).run();
}

}  // namespace hashphase::benchmarks
