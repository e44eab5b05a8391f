// SPDX-License-Identifier: Zlib
#pragma once

// A Bullet world on stage. The grid is that of its broadphase, where that is ours; beside another one, the
// viewer keeps a grid of its own for what looks at bodies, and its cost shows.

#include <demos/viewer/stage/bullet_world.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace hashphase::demos {

class BulletStage final : public Stage {
public:
    /// Declares what Bullet does by itself, and what the viewer asks.
    BulletStage(const WorldSceneKind& scene, std::size_t objects, std::uint64_t seed);

    [[nodiscard]] std::size_t size() const override { return size_; }
    [[nodiscard]] std::uint32_t indexLimit() const override;
    [[nodiscard]] StageBody body(std::uint32_t index) const override;
    bool push(std::uint32_t index, const Vector3<float>& velocity) override;
    [[nodiscard]] std::span<const Vector3<float>> ground() const override { return ground_; }
    [[nodiscard]] std::uint64_t placesHash() const override;
    void listPairs(std::vector<PairKey>& pairs) const override;
    [[nodiscard]] std::size_t pairCount() const override;
    void listBoxes(std::vector<Aabb<float>>& boxes,
                   std::vector<CollisionFilter>& filters) const override;
    [[nodiscard]] const Grid<float>* grid() const override;
    [[nodiscard]] std::optional<std::int64_t> memoryBytes() const override;

private:
    /// The grid beside a broadphase that has none.
    struct SecondIndex {
        explicit SecondIndex(const GridConfig& config) : grid(config) {}

        Grid<float> grid;
        std::vector<ProxyId> proxies;  // by body
    };

    void runFrame() override;
    [[nodiscard]] std::string faultOf(const SceneEffects& effects) const override;
    void follow(const SceneEffects& before) override;
    void useBroadphase(const BroadphaseKind& kind) override { fileAnew(kind); }
    bool removeOne(std::uint32_t index) override;
    /// Null where nobody has the index.
    [[nodiscard]] btRigidBody* bodyAt(std::uint32_t index) const;
    void measureBounds();
    void fileAnew(const BroadphaseKind& kind);
    void makeSecondIndex();
    void noteGivenBoxes();
    void fileWhereBodiesAre();
    void takeTimes(double wholeMs);
    void markTunnels();

    std::unique_ptr<BulletWorld> world_;
    std::unique_ptr<SecondIndex> second_;
    Observers<float> ownObservers_;
    std::size_t size_ = 0;
    std::uint64_t frame_ = 0;
    std::array<Vector3<float>, 6> ground_;
    std::vector<Aabb<float>> given_;      // boxes of which pairs were found, by index
    std::vector<Vector3<float>> before_;  // where bodies were before the frame, by index
};

}  // namespace hashphase::demos
