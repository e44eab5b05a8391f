// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_trial.hpp>

#include <demos/accuracy/timing.hpp>
#include <demos/compare/verifier.hpp>

namespace hashphase::demos {
namespace {

constexpr std::size_t kBruteForceUpTo = 20'000;

class Trier {
public:
    Trier(std::size_t trial, BoxScene& scene, std::span<const PairMethod> methods,
          Measurements& measured)
        : trial_(trial), scene_(scene), measured_(measured) {
        const BroadphaseNeeds needs{scene.bounds(), scene.boxes().size(), {}};
        toBulletBoxes(scene_.boxes(), boxes_);
        for (const PairMethod& method : methods) {
            Entry& entry = entries_.emplace_back();
            entry.mostTestsTimed = method.mostTestsTimed;
            const HeapScope scope(entry.heap);
            entry.source = method.make(needs, boxes_);
        }
        for (std::size_t way = 0; way < methods.size(); ++way) {
            measured_.add("ways", {{"trial", trial},
                                   {"way", way},
                                   {"method", methods[way].name},
                                   {"factor", methods[way].factor},
                                   {"origin", methods[way].origin},
                                   {"exact", methods[way].isExact},
                                   {"complete", methods[way].isComplete}});
        }
    }

    void judge(int frames) {
        for (int frame = 0; frame < frames; ++frame) {
            advance();
            findTruth(frame == 0);
            for (std::size_t way = 0; way < entries_.size(); ++way) {
                judge(way);
            }
        }
    }

    /// What the heap holds now is what the methods need.
    void weigh() {
        for (std::size_t way = 0; way < entries_.size(); ++way) {
            measured_.add("heap",
                          {{"trial", trial_}, {"way", way}, {"bytes", entries_[way].heap.bytes()}});
        }
    }

    void time(const PairTrialPlan& plan) {
        std::vector<std::vector<BulletBox>> frames(static_cast<std::size_t>(plan.framesTogether));
        std::vector<TimedMethod> methods;
        for (std::size_t way = 0; way < entries_.size(); ++way) {
            if (entries_[way].tested <= entries_[way].mostTestsTimed * entries_[way].testedFrames) {
                methods.push_back(
                    {{{"trial", trial_}, {"way", way}}, [&frames, &source = *entries_[way].source] {
                         for (const std::vector<BulletBox>& boxes : frames) {
                             source.step(boxes);
                         }
                     }});
            }
        }
        const auto begin = [&](int /*round*/) {
            for (std::vector<BulletBox>& boxes : frames) {
                advance();
                boxes = boxes_;
            }
        };
        measureTimes(measured_, plan.rounds, 1, begin, methods, 1.0 / plan.framesTogether);
    }

private:
    struct Entry {
        std::unique_ptr<PairSource> source;
        HeapMeter heap;
        Verifier verifier;
        double mostTestsTimed = 0;
        double tested = 0;
        int testedFrames = 0;
    };

    void advance() {
        scene_.advance();
        toBulletBoxes(scene_.boxes(), boxes_);
    }

    void findTruth(bool byBruteForceToo) {
        findExactPairs(ReferenceMethod::kSweep, scene_.boxes(), {}, truth_);
        if (byBruteForceToo && boxes_.size() <= kBruteForceUpTo) {
            findExactPairs(ReferenceMethod::kBrute, scene_.boxes(), {}, listed_);
            measured_.add("truths", {{"differs", listed_ != truth_}});
        }
    }

    void judge(std::size_t way) {
        Entry& entry = entries_[way];
        {
            const HeapScope scope(entry.heap);
            entry.source->step(boxes_);
        }
        const std::optional<std::uint64_t> tested = entry.source->boxesTested();
        entry.tested += static_cast<double>(tested.value_or(0));
        ++entry.testedFrames;
        entry.source->listPairs(listed_);
        const FrameVerdict verdict = entry.verifier.judge(listed_, truth_);
        measured_.add("judged", {{"trial", trial_},
                                 {"way", way},
                                 {"true_pairs", verdict.exactPairs},
                                 {"missed", verdict.missing},
                                 {"extra", verdict.extra},
                                 {"tested", tested}});
    }

    std::size_t trial_;
    BoxScene& scene_;
    Measurements& measured_;
    std::vector<BulletBox> boxes_;
    std::vector<Entry> entries_;
    std::vector<PairKey> truth_;
    std::vector<PairKey> listed_;
};

}  // namespace

void tryPairs(std::size_t trial, BoxScene& scene, std::span<const PairMethod> methods,
              const PairTrialPlan& plan, Measurements& measured) {
    Trier trier(trial, scene, methods, measured);
    trier.judge(plan.judgedFrames);
    trier.weigh();
    trier.time(plan);
    trier.judge(plan.judgedFrames);
}

}  // namespace hashphase::demos
