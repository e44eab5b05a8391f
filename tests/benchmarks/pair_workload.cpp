// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/pair_workload.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>

namespace hashphase::benchmarks {
namespace {

class PairRunner final : public Runner {
public:
    PairRunner(const PairWorkload& workload, const ContestantKind& kind)
        : workload_(workload), kind_(kind) {
        if (workload_.what() != PairFrame::create) {
            contestant_ = kind.make(workload.scene().needs());
            contestant_->fill(workload.scene().frame());
        }
        if (removes()) {
            contestant_->findPairs();
            contestant_->afterFrame();
        }
    }

    void beginFrame() override {
        if (workload_.what() == PairFrame::create) {
            contestant_ = kind_.make(workload_.scene().needs());
        }
    }
    void prepare() override { frame_ = workload_.frameFor(kind_); }

    void run() override {
        const PairFrame what = workload_.what();
        if (what == PairFrame::setAll) {
            contestant_->setAll(frame_);
        } else if (what == PairFrame::setMovers) {
            contestant_->set(workload_.movers(), frame_);
        } else if (what == PairFrame::create) {
            contestant_->fill(frame_);
        } else if (removes()) {
            contestant_->remove(workload_.removed());
        }
        if (what != PairFrame::remove) {
            contestant_->findPairs();
        }
    }

    void listAnswers(std::vector<Answer>& answers) override { contestant_->listPairs(answers); }

    void endFrame() override {
        contestant_->afterFrame();
        if (removes()) {
            contestant_->add(workload_.removed(), frame_);
            contestant_->findPairs();
            contestant_->afterFrame();
        } else if (workload_.what() == PairFrame::create) {
            contestant_.reset();
        }
    }

    [[nodiscard]] std::optional<OwnBytes> ownBytes() const override {
        return workload_.watchesHeap() ? contestant_->ownBytes() : std::nullopt;
    }

private:
    [[nodiscard]] bool removes() const { return !workload_.removed().empty(); }

    const PairWorkload& workload_;
    const ContestantKind& kind_;
    std::unique_ptr<Contestant> contestant_;
    FrameBoxes frame_;
};

}  // namespace

PairWorkload::PairWorkload(std::unique_ptr<demos::BoxScene> scene, PairFrame what,
                           std::uint64_t seed)
    : scene_(std::move(scene)),
      what_(what),
      random_(seed),
      order_(scene_.size()),
      moves_(what == PairFrame::create) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (what == PairFrame::remove || what == PairFrame::removeAndFind) {
        constexpr std::size_t kMostRemovals = 1000;
        removals_ = std::min(kMostRemovals, (scene_.size() + 1) / 2);
    } else if (what == PairFrame::setMovers) {
        std::copy_if(
            order_.begin(), order_.end(), std::back_inserter(movers_),
            [&](std::uint32_t object) { return !isStatic(scene_.frame().filterOf(object)); });
    }
}

std::unique_ptr<Runner> PairWorkload::make(const ContestantKind& kind) {
    return std::make_unique<PairRunner>(*this, kind);
}

void PairWorkload::beginFrame() {
    if (moves_) {
        scene_.advance();
    }
    moves_ = removals_ == 0 && what_ != PairFrame::setNothing;
    for (std::size_t i = 0; i < removals_; ++i) {
        const float share = random_.unit();
        const auto left = static_cast<float>(order_.size() - i);
        const auto step = static_cast<std::size_t>(share * left);
        std::swap(order_[i], order_[std::min(i + step, order_.size() - 1)]);
    }
}

void PairWorkload::listExactAnswers(std::vector<Answer>& answers) {
    std::vector<Aabb<float>> left = scene_.boxes();
    for (const std::uint32_t object : removed()) {
        left[object].min().setConstant(
            std::numeric_limits<float>::quiet_NaN());  // overlaps nothing
    }
    demos::findExactPairs(demos::ReferenceMethod::kSweep, left, scene_.frame().filters, answers);
}

std::function<std::unique_ptr<Workload>(std::size_t, std::uint64_t)> makePairWorkload(
    MakeScene makeScene, PairFrame what) {
    return [makeScene = std::move(makeScene), what](std::size_t objects, std::uint64_t seed) {
        return std::make_unique<PairWorkload>(makeScene(objects, seed), what, seed);
    };
}

}  // namespace hashphase::benchmarks
