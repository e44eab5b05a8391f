// SPDX-License-Identifier: Zlib
#pragma once

// A recording of boxes on stage (Broadmark's `.aabbs`): it moves as it was recorded, and begins again
// after its last frame.

#include <demos/scenes/recording_scene.hpp>
#include <demos/viewer/stage/rival_pairs.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <broadphase/pairs.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::demos {

class RecordingStage final : public Stage {
public:
    /// As RecordingScene, and throws as it does.
    RecordingStage(const std::filesystem::path& path, std::size_t objects);

    [[nodiscard]] std::size_t size() const override { return proxies_.size(); }
    [[nodiscard]] std::uint32_t indexLimit() const override {
        return static_cast<std::uint32_t>(proxies_.size());
    }
    [[nodiscard]] StageBody body(std::uint32_t index) const override;
    [[nodiscard]] std::uint64_t placesHash() const override;
    void listPairs(std::vector<PairKey>& pairs) const override;
    [[nodiscard]] std::size_t pairCount() const override;
    void listBoxes(std::vector<Aabb<float>>& boxes,
                   std::vector<CollisionFilter>& filters) const override;
    [[nodiscard]] const Grid<float>* grid() const override { return grid_.get(); }
    [[nodiscard]] std::optional<std::int64_t> memoryBytes() const override;

private:
    void runFrame() override;
    [[nodiscard]] std::string faultOf(const SceneEffects& effects) const override;
    void follow(const SceneEffects& before) override;
    void useBroadphase(const BroadphaseKind& kind) override;
    void makeGrid();
    void findPairs();

    RecordingScene scene_;
    int frame_ = 0;
    std::unique_ptr<Grid<float>> grid_;
    std::vector<ProxyId> proxies_;  // by object, which is their index
    std::unique_ptr<Pairs<float>> pairs_;
    Observers<float> ownObservers_;
    std::unique_ptr<RivalPairs> rival_;
};

}  // namespace hashphase::demos
