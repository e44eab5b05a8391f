// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/pair_workload.hpp>

namespace hashphase::benchmarks {
namespace {

class PairRunner final : public Runner {
public:
    PairRunner(const PairWorkload& workload, const ContestantKind& kind)
        : workload_(workload), kind_(kind), contestant_(kind.make(workload.scene().needs())) {
        contestant_->fill(workload.scene().frame());
    }

    void prepare() override { frame_ = workload_.frameFor(kind_); }
    void run() override {
        if (workload_.setting() == Setting::everything) {
            contestant_->setAll(frame_);
        }
        contestant_->findPairs();
    }
    void listAnswers(std::vector<Answer>& answers) override { contestant_->listPairs(answers); }
    void endFrame() override { contestant_->afterFrame(); }
    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        return contestant_->ownBytes();
    }

private:
    const PairWorkload& workload_;
    const ContestantKind& kind_;
    std::unique_ptr<Contestant> contestant_;
    FrameBoxes frame_;
};

}  // namespace

std::unique_ptr<Runner> PairWorkload::make(const ContestantKind& kind) {
    return std::make_unique<PairRunner>(*this, kind);
}

void PairWorkload::beginFrame() {
    if (begun_ && setting_ == Setting::everything) {
        scene_.advance();
    }
    begun_ = true;
}

void PairWorkload::listExactAnswers(std::vector<Answer>& answers) {
    demos::findExactPairs(demos::ReferenceMethod::kSweep, scene_.boxes(), scene_.frame().filters,
                          answers);
}

std::function<std::unique_ptr<Workload>(std::size_t, std::uint64_t)> makePairWorkload(
    MakeScene makeScene, Setting setting) {
    return [makeScene = std::move(makeScene), setting](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<PairWorkload>(makeScene(objects, seed), setting);
    };
}

}  // namespace hashphase::benchmarks
