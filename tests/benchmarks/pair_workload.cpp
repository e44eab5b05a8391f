// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/pair_workload.hpp>

#include <demos/report/frame_clock.hpp>

namespace hashphase::benchmarks {

PairWorkload::PairWorkload(std::unique_ptr<demos::BoxScene> scene, Setting setting)
    : scene_(std::move(scene)), setting_(setting) {}

void PairWorkload::add(const ContestantKind& kind) {
    Entry entry;
    entry.kind = kind;
    {
        const demos::HeapScope scope(entry.heap);
        entry.contestant = kind.make(scene_.needs());
        entry.contestant->fill(scene_.frame());
    }
    entries_.push_back(std::move(entry));
}

void PairWorkload::beginFrame() {
    if (begun_ && setting_ == Setting::everything) {
        scene_.advance();
    }
    begun_ = true;
}

double PairWorkload::runFrame(std::size_t contestant) {
    const Entry& entry = entries_[contestant];
    Contestant& current = *entry.contestant;
    const FrameBoxes frame = frameFor(entry.kind);
    const demos::FrameClock watch(entry.kind.onThreads);
    if (setting_ == Setting::everything) {
        current.setAll(frame);
    }
    current.findPairs();
    return watch.milliseconds();
}

void PairWorkload::runWatchedFrame(std::size_t contestant) {
    const demos::HeapScope scope(entries_[contestant].heap);
    runFrame(contestant);
}

void PairWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    entries_[contestant].contestant->listPairs(answers);
}

void PairWorkload::listExactAnswers(std::vector<Answer>& answers) {
    demos::findExactPairs(demos::ReferenceMethod::kSweep, scene_.boxes(), scene_.frame().filters,
                          answers);
}

void PairWorkload::endFrame(std::size_t contestant) {
    entries_[contestant].contestant->afterFrame();
}

Memory PairWorkload::memory(std::size_t contestant) const {
    const Entry& entry = entries_[contestant];
    return {entry.heap.bytes(), entry.contestant->ownBytes()};
}

}  // namespace hashphase::benchmarks
