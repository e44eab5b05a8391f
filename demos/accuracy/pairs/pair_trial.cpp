// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_experiments.hpp>

#include <demos/compare/verifier.hpp>

namespace hashphase::demos {
namespace {

PairSource broadphaseSource(const BroadphaseKind& kind, const BroadphaseNeeds& needs,
                            std::span<const BulletBox> boxes) {
    const auto filled = std::make_shared<FilledBroadphase>(kind, needs);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        filled->create(static_cast<std::uint32_t>(i), boxes[i], {});
    }
    PairSource source{[=](std::span<const BulletBox> moved) {
                          filled->setAll(moved);
                          filled->findPairs();
                      },
                      [=](std::vector<PairKey>& pairs) { filled->listPairs(pairs); }};
    if (const auto* hash = dynamic_cast<const SpatialHashBroadphase*>(&filled->broadphase())) {
        source.boxesTested = [filled, hash] { return hash->lastCost().boxesTested; };
    }
    return source;
}

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
                                   {"origin", methods[way].origin()},
                                   {"exact", methods[way].is("exact")},
                                   {"complete", methods[way].is("complete")}});
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
                    {{{"trial", trial_}, {"way", way}}, [&frames, &source = entries_[way].source] {
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
        measureTimes(measured_, {plan.rounds, 1, 1.0 / plan.framesTogether}, begin, methods);
    }

private:
    struct Entry {
        PairSource source;
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
            entry.source.step(boxes_);
        }
        std::optional<std::uint64_t> tested;
        if (entry.source.boxesTested) {
            tested = entry.source.boxesTested();
        }
        entry.tested += static_cast<double>(tested.value_or(0));
        ++entry.testedFrames;
        entry.source.listPairs(listed_);
        const PairVerdict& verdict = entry.verifier.judge(listed_, truth_);
        measured_.add("judged", {{"trial", trial_},
                                 {"way", way},
                                 {"true_pairs", truth_.size()},
                                 {"missed", verdict.missing.size()},
                                 {"extra", verdict.extra.size()},
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

PairMethod hashMethod(std::string name, const GridConfig& grid) {
    return {{std::move(name), "ours exact complete",
             [grid](const BroadphaseNeeds& needs, std::span<const BulletBox> boxes) {
                 BroadphaseNeeds own = needs;
                 own.grid = grid;
                 return broadphaseSource(broadphaseKind("hash"), own, boxes);
             }}};
}

PairMethod dbvtMethod(bool isDeferred) {
    const BroadphaseKind& kind = broadphaseKind(isDeferred ? "dbvt-deferred" : "dbvt");
    return {{std::string(kind.title), "bullet complete",
             [&kind](const BroadphaseNeeds& needs, std::span<const BulletBox> boxes) {
                 return broadphaseSource(kind, needs, boxes);
             }}};
}

void tryPairs(std::size_t trial, BoxScene& scene, std::span<const PairMethod> methods,
              const PairTrialPlan& plan, Measurements& measured) {
    Trier trier(trial, scene, methods, measured);
    trier.judge(plan.judgedFrames);
    trier.weigh();
    trier.time(plan);
    trier.judge(plan.judgedFrames);
}

}  // namespace hashphase::demos
