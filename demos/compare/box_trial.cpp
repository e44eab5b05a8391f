// SPDX-License-Identifier: Zlib
#include <demos/compare/filled_broadphase.hpp>
#include <demos/compare/trial.hpp>
#include <demos/report/stopwatch.hpp>

#include <utility>

namespace hashphase::demos {
namespace {

class BoxTrial final : public Trial {
public:
    BoxTrial(std::unique_ptr<BoxScene> scene, ReferenceMethod reference)
        : Trial(
              {scene->boxes().size(), scene->bounds(), true, scene->frameLimit(), scene->ground()}),
          scene_(std::move(scene)),
          reference_(reference) {
        toBulletBoxes(scene_->boxes(), boxes_);
    }

    std::optional<double> add(const BroadphaseKind& kind, const GoOn& goOn) override {
        const Stopwatch watch;
        auto filled =
            std::make_unique<FilledBroadphase>(kind, BroadphaseNeeds{facts.bounds, boxes_.size()});
        {
            const HeapScope scope(filled->heap());
            for (std::size_t i = 0; i < boxes_.size(); ++i) {
                if (i % kObjectsBetweenLooks == 0 && !goOn(i)) {
                    return std::nullopt;
                }
                filled->create(static_cast<std::uint32_t>(i), boxes_[i], filterOf(*scene_, i));
            }
        }
        const double taken = watch.milliseconds();
        contestants_.push_back(std::move(filled));
        return taken;
    }

    void beginFrame() override {
        if (begun_) {
            scene_->advance();
            toBulletBoxes(scene_->boxes(), boxes_);
        }
        begun_ = true;
        findExactPairs(reference_, scene_->boxes(), scene_->filters(), exact_);
    }

    Observation runFrame(std::size_t contestant) override {
        FilledBroadphase& current = *contestants_[contestant];
        Observation seen;
        {
            const HeapScope scope(current.heap());
            const Stopwatch watch;
            current.setAll(boxes_);
            seen.setAabbMs = watch.milliseconds();
            current.findPairs();
            seen.calculateMs = watch.milliseconds() - seen.setAabbMs;
        }
        current.listPairs(reported_);
        seen.reported = reported_;
        seen.exact = exact_;
        seen.boxes = scene_->boxes();
        seen.cellSize = cellSizeOf(current.broadphase());
        return seen;
    }

    std::optional<double> removeObjects(std::size_t contestant, std::size_t count,
                                        const GoOn& goOn) override {
        const Stopwatch watch;
        for (std::size_t i = 0; i < count; ++i) {
            if (i % kObjectsBetweenLooks == 0 && !goOn(i)) {
                return std::nullopt;
            }
            contestants_[contestant]->destroy(
                static_cast<std::uint32_t>(i * boxes_.size() / count));
        }
        return watch.milliseconds();
    }

    [[nodiscard]] std::optional<std::int64_t> memoryBytes(std::size_t contestant) const override {
        return std::as_const(*contestants_[contestant]).heap().bytes();
    }

private:
    std::unique_ptr<BoxScene> scene_;
    ReferenceMethod reference_;
    bool begun_ = false;
    std::vector<BulletBox> boxes_;
    std::vector<std::unique_ptr<FilledBroadphase>> contestants_;
    std::vector<PairKey> exact_;
    std::vector<PairKey> reported_;
};

}  // namespace

std::unique_ptr<Trial> boxTrial(std::unique_ptr<BoxScene> scene, ReferenceMethod reference) {
    return std::make_unique<BoxTrial>(std::move(scene), reference);
}

}  // namespace hashphase::demos
