// SPDX-License-Identifier: Zlib
#pragma once

// A Bullet world on stage. The grid is that of its broadphase, where that is ours; beside another one, the
// viewer keeps a grid of its own for what looks at bodies, and its cost shows.

#include <demos/compare/filled_broadphase.hpp>
#include <demos/compare/trial.hpp>
#include <demos/scenes/world_scenes.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/effects/bullet_frame.hpp>

#include <btBulletDynamicsCommon.h>

#include <array>
#include <memory>
#include <vector>

namespace hashphase::demos {

class BulletStage final : public Stage {
public:
    BulletStage(const WorldSceneKind& scene, std::size_t objects, std::uint64_t seed,
                const SceneEffects& effects);
    ~BulletStage() override;

    void step() override;

    [[nodiscard]] std::size_t size() const override { return size_; }
    [[nodiscard]] std::uint32_t indexLimit() const override;
    [[nodiscard]] StageBody body(std::uint32_t index) const override;
    std::size_t remove(std::span<const std::uint32_t> indices) override;
    bool push(std::uint32_t index, const Vector3<float>& velocity) override;
    [[nodiscard]] Aabb<float> bounds() const override { return bounds_; }
    [[nodiscard]] std::span<const Vector3<float>> ground() const override { return ground_; }
    [[nodiscard]] std::span<const TunnelMark> tunnelMarks() const override { return marks_; }
    [[nodiscard]] std::uint64_t placesHash() const override;

    [[nodiscard]] const SceneEffects& effects() const override { return effects_; }
    void declare(const SceneEffects& effects) override;
    [[nodiscard]] EffectSet possibleEffects() const override;
    void setBroadphase(const BroadphaseKind& kind) override;
    [[nodiscard]] const BroadphaseKind& broadphase() const override { return *kind_; }
    void listPairs(std::vector<PairKey>& pairs) const override;
    [[nodiscard]] std::size_t pairCount() const override;
    void listBoxes(std::vector<Aabb<float>>& boxes,
                   std::vector<CollisionFilter>& filters) const override;
    [[nodiscard]] const Grid<float>* grid() const override;
    [[nodiscard]] Observers<float>& observers() override { return observers_; }
    [[nodiscard]] const Observers<float>& observers() const override { return observers_; }
    [[nodiscard]] std::span<const Zone> zones() const override { return zones_; }
    [[nodiscard]] std::uint64_t memoryBytes() const override;

private:
    /// The grid beside a broadphase that has none.
    struct SecondIndex {
        explicit SecondIndex(const GridConfig& config) : grid(config) {}

        Grid<float> grid;
        std::vector<ProxyId> proxies;  // by body
    };

    class World;

    /// Null where nobody has the index.
    [[nodiscard]] btRigidBody* bodyAt(std::uint32_t index) const;
    bool removeOne(std::uint32_t index);
    void measureBounds();
    void fileAnew(const BroadphaseKind& kind);
    void makeSecondIndex();
    void noteGivenBoxes();
    void fileWhereBodiesAre();
    void notePlaces();
    void findTunnelled();
    void takeTimes(double wholeMs);

    SceneEffects effects_;
    const BroadphaseKind* kind_;
    std::unique_ptr<World> world_;
    std::unique_ptr<SecondIndex> second_;
    Observers<float> observers_;
    std::size_t size_ = 0;
    Aabb<float> bounds_;
    std::array<Vector3<float>, 6> ground_;
    std::vector<Aabb<float>> given_;      // boxes of which pairs were found, by index
    std::vector<Vector3<float>> before_;  // where bodies were, by index
    std::vector<TunnelMark> marks_;
    std::vector<Zone> zones_;
    std::vector<Picked<float>> picked_;  // scratch
};

}  // namespace hashphase::demos
