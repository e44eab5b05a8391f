// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_trial.hpp>

#include <demos/accuracy/timing.hpp>
#include <demos/compare/verifier.hpp>

namespace hashphase::demos {
namespace {

class Trier {
public:
    Trier(BoxScene& scene, std::span<const PairMethod> methods)
        : scene_(scene), needs_{scene.bounds(), scene.boxes().size(), {}} {
        takeBoxes();
        for (const PairMethod& method : methods) {
            Entry& entry = entries_.emplace_back();
            entry.mostTestsTimed = method.mostTestsTimed;
            const HeapScope scope(entry.heap);
            entry.source = method.make(needs_, boxes_);
        }
    }

    void judge(int frames) {
        for (int frame = 0; frame < frames; ++frame) {
            advance();
            findTruth(frame == 0);
            for (Entry& entry : entries_) {
                judge(entry);
            }
        }
    }

    void time(const PairTrialPlan& plan) {
        std::vector<Entry*> timed;
        std::vector<std::function<void()>> runs;
        for (Entry& entry : entries_) {
            if (entry.tests() <= entry.mostTestsTimed) {
                timed.push_back(&entry);
                runs.push_back([this, source = entry.source.get()] {
                    for (const std::vector<BulletBox>& boxes : block_) {
                        source->step(boxes);
                    }
                });
            }
        }
        const auto begin = [&](int /*round*/) {
            block_.resize(static_cast<std::size_t>(plan.framesTogether));
            for (std::vector<BulletBox>& boxes : block_) {
                advance();
                boxes = boxes_;
            }
        };
        const std::vector<Spread> times = timeInTurn(plan.rounds, 1, begin, runs);
        const double share = 1.0 / plan.framesTogether;
        for (std::size_t i = 0; i < timed.size(); ++i) {
            timed[i]->measured.time =
                Spread{times[i].median * share, times[i].low * share, times[i].high * share};
        }
    }

    /// What the heap holds now is what the method needs.
    void takeBytes() {
        for (Entry& entry : entries_) {
            entry.measured.bytes = entry.heap.bytes();
        }
    }

    [[nodiscard]] PairTrial result() {
        for (Entry& entry : entries_) {
            if (entry.testedFrames > 0) {
                entry.measured.testsPerFrame = entry.tests();
            }
            trial_.measurements.push_back(entry.measured);
        }
        return trial_;
    }

private:
    struct Entry {
        std::unique_ptr<PairSource> source;
        HeapMeter heap;
        Verifier verifier;
        PairMeasurement measured;
        double mostTestsTimed = 0;
        double tested = 0;
        int testedFrames = 0;

        [[nodiscard]] double tests() const { return testedFrames == 0 ? 0 : tested / testedFrames; }
    };

    void takeBoxes() { toBulletBoxes(scene_.boxes(), boxes_); }
    void advance() {
        scene_.advance();
        takeBoxes();
    }

    void findTruth(bool byBruteForceToo) {
        findExactPairs(ReferenceMethod::kSweep, scene_.boxes(), {}, truth_);
        if (byBruteForceToo && boxes_.size() <= PairTrial::kBruteForceUpTo) {
            findExactPairs(ReferenceMethod::kBrute, scene_.boxes(), {}, listed_);
            ++trial_.framesByBruteForce;
            trial_.framesThatDiffer += listed_ == truth_ ? 0 : 1;
        }
    }

    void judge(Entry& entry) {
        {
            const HeapScope scope(entry.heap);
            entry.source->step(boxes_);
        }
        if (const auto tested = entry.source->boxesTested()) {
            entry.tested += static_cast<double>(*tested);
            ++entry.testedFrames;
        }
        entry.source->listPairs(listed_);
        const FrameVerdict verdict = entry.verifier.judge(listed_, truth_);
        ++entry.measured.judgedFrames;
        entry.measured.truePairs += verdict.exactPairs;
        entry.measured.missed += verdict.missing;
        entry.measured.extra += verdict.extra;
    }

    BoxScene& scene_;
    BroadphaseNeeds needs_;
    std::vector<BulletBox> boxes_;
    std::vector<std::vector<BulletBox>> block_;
    std::vector<Entry> entries_;
    std::vector<PairKey> truth_;
    std::vector<PairKey> listed_;
    PairTrial trial_;
};

}  // namespace

PairTrial tryPairs(BoxScene& scene, std::span<const PairMethod> methods,
                   const PairTrialPlan& plan) {
    Trier trier(scene, methods);
    trier.judge(plan.judgedFrames);
    trier.takeBytes();
    trier.time(plan);
    trier.judge(plan.judgedFrames);
    return trier.result();
}

}  // namespace hashphase::demos
