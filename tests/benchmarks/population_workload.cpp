// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/population_workload.hpp>

#include <demos/report/frame_clock.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

namespace hashphase::benchmarks {

RemovalWorkload::RemovalWorkload(std::unique_ptr<demos::BoxScene> scene, std::size_t removals,
                                 RemovalTiming timing, std::uint64_t seed)
    : scene_(std::move(scene)),
      removals_(std::min(removals, (scene_.size() + 1) / 2)),
      timing_(timing),
      random_(seed),
      order_(scene_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
}

void RemovalWorkload::add(const ContestantKind& kind) {
    auto contestant = kind.make(scene_.needs());
    contestant->fill(scene_.frame());
    contestant->findPairs();
    contestant->afterFrame();
    contestants_.push_back(std::move(contestant));
}

void RemovalWorkload::beginFrame() {
    for (std::size_t i = 0; i < removals_; ++i) {
        const float share = random_.unit();
        const auto left = static_cast<float>(order_.size() - i);
        const auto step = static_cast<std::size_t>(share * left);
        std::swap(order_[i], order_[std::min(i + step, order_.size() - 1)]);
    }
}

double RemovalWorkload::runFrame(std::size_t contestant) {
    Contestant& current = *contestants_[contestant];
    Population& population = *current.population();
    const demos::FrameClock watch;
    population.remove(removed());
    if (timing_ == RemovalTiming::removalsAndPairs) {
        current.findPairs();
    }
    return watch.milliseconds();
}

void RemovalWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    contestants_[contestant]->listPairs(answers);
}

void RemovalWorkload::listExactAnswers(std::vector<Answer>& answers) {
    std::vector<Aabb<float>> left = scene_.boxes();
    for (std::size_t i = 0; i < removals_; ++i) {
        // Overlaps nothing.
        left[order_[i]].min().setConstant(std::numeric_limits<float>::quiet_NaN());
    }
    demos::findExactPairs(demos::ReferenceMethod::kSweep, left, scene_.frame().filters, answers);
}

void RemovalWorkload::endFrame(std::size_t contestant) {
    Contestant& current = *contestants_[contestant];
    current.afterFrame();
    current.population()->add(removed(), scene_.frame());
    current.findPairs();
    current.afterFrame();
}

CreationWorkload::CreationWorkload(std::unique_ptr<demos::BoxScene> scene)
    : scene_(std::move(scene)) {}

void CreationWorkload::add(const ContestantKind& kind) {
    entries_.push_back({&kind, nullptr});
}

void CreationWorkload::beginFrame() {
    scene_.advance();
    for (Entry& entry : entries_) {
        entry.contestant = entry.kind->make(scene_.needs());
    }
}

double CreationWorkload::runFrame(std::size_t contestant) {
    Contestant& current = *entries_[contestant].contestant;
    const demos::FrameClock watch;
    current.fill(scene_.frame());
    current.findPairs();
    return watch.milliseconds();
}

void CreationWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    entries_[contestant].contestant->listPairs(answers);
}

void CreationWorkload::listExactAnswers(std::vector<Answer>& answers) {
    demos::findExactPairs(demos::ReferenceMethod::kSweep, scene_.boxes(), scene_.frame().filters,
                          answers);
}

void CreationWorkload::endFrame(std::size_t contestant) {
    entries_[contestant].contestant.reset();
}

}  // namespace hashphase::benchmarks
