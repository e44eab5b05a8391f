// SPDX-License-Identifier: Zlib
#pragma once

// Broadphases alone on a scene of moving boxes: in every frame each gets setAabb for all boxes, then
// calculateOverlappingPairs.

#include <demos/compare/filled_broadphase.hpp>
#include <demos/compare/trial.hpp>

#include <memory>
#include <vector>

namespace hashphase::demos {

class BoxTrial : public Trial {
public:
    BoxTrial(std::unique_ptr<BoxScene> scene, ReferenceMethod reference);

    std::optional<double> add(const BroadphaseKind& kind, const GoOn& goOn) override;
    void beginFrame() override;
    Observation runFrame(std::size_t contestant) override;
    std::optional<double> removeObjects(std::size_t contestant, std::size_t count,
                                        const GoOn& goOn) override;
    [[nodiscard]] std::optional<std::int64_t> memoryBytes(std::size_t contestant) const override;
    [[nodiscard]] std::size_t objectCount() const override { return boxes_.size(); }
    [[nodiscard]] Aabb<float> bounds() const override { return scene_->bounds(); }
    [[nodiscard]] bool sharesBoxes() const override { return true; }
    [[nodiscard]] std::optional<int> frameLimit() const override { return scene_->frameLimit(); }

private:
    std::unique_ptr<BoxScene> scene_;
    ReferenceMethod reference_;
    bool begun_ = false;
    std::vector<BulletBox> boxes_;
    std::vector<std::unique_ptr<FilledBroadphase>> contestants_;
    std::vector<PairKey> exact_;
    std::vector<PairKey> reported_;
};

}  // namespace hashphase::demos
