// SPDX-License-Identifier: Zlib
#pragma once

// The paper's simulation on stage: spheres that roam a terrain, by the library's own Simulation. Where one
// of Bullet's broadphases finds the pairs, the bodies move as they do with the grid's, to the last bit.

#include <demos/scenes/effects_file.hpp>
#include <demos/viewer/stage/rival_pairs.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <integration/effects/simulation.hpp>

#include <memory>
#include <string>
#include <vector>

namespace hashphase::demos {

class PaperStage final : public Stage {
public:
    explicit PaperStage(const EffectsFile& file);

    [[nodiscard]] std::size_t size() const override { return simulation_.size(); }
    [[nodiscard]] std::uint32_t indexLimit() const override {
        return static_cast<std::uint32_t>(bodies_.size());
    }
    [[nodiscard]] StageBody body(std::uint32_t index) const override;
    bool push(std::uint32_t index, const Vector3<float>& velocity) override;
    [[nodiscard]] std::span<const Vector3<float>> ground() const override;
    [[nodiscard]] std::uint64_t placesHash() const override;
    void listPairs(std::vector<PairKey>& pairs) const override { pairs = presentPairs(); }
    [[nodiscard]] std::size_t pairCount() const override { return presentPairs().size(); }
    void listBoxes(std::vector<Aabb<float>>& boxes,
                   std::vector<CollisionFilter>& filters) const override;
    [[nodiscard]] const Grid<float>* grid() const override;
    [[nodiscard]] std::optional<std::int64_t> memoryBytes() const override;

private:
    void runFrame() override;
    [[nodiscard]] std::string faultOf(const SceneEffects& effects) const override;
    void follow(const SceneEffects& /*before*/) override { declareToSimulation(); }
    void useBroadphase(const BroadphaseKind& kind) override;
    bool removeOne(std::uint32_t index) override;
    void forgetRemoved() override;
    [[nodiscard]] const std::vector<PairKey>& presentPairs() const;
    void declareToSimulation();
    void addGroundAndZones(bool hadGround, bool hadZones);
    void takeChanges();

    EffectsScene scene_;
    std::vector<Vector3<float>> ground_;
    Simulation<float> simulation_;       // declares no pairs where a rival finds them
    std::vector<BodyId> bodies_;         // by index; null where nobody is
    std::vector<Vector3<float>> kept_;   // their velocities while motion is not declared
    std::unique_ptr<RivalPairs> rival_;  // none: the grid finds the pairs
    std::vector<PairKey> pairs_;         // the grid's
    std::vector<Aabb<float>> boxes_;     // scratch
    std::vector<CollisionFilter> noFilters_;
};

/// While what is returned lives, it is simulated on at most so many threads: those of oneTBB, where that was found
/// when the program was built, and on one thread else.
[[nodiscard]] std::shared_ptr<void> limitThreads(std::size_t count);

}  // namespace hashphase::demos
