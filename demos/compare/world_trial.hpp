// SPDX-License-Identifier: Zlib
#pragma once

// Broadphases at work in Bullet worlds: each gets a world of its own with the same contents, stepped
// at 1/60 s. The worlds part company with time, so each broadphase is judged by the boxes of its own.

#include <demos/compare/heap_meter.hpp>
#include <demos/compare/trial.hpp>
#include <demos/scenes/tell_waiting.hpp>
#include <demos/scenes/world_contents.hpp>

#include <functional>
#include <memory>
#include <vector>

namespace hashphase::demos {

/// Fills a world, always with the same contents.
using FillWorld = std::function<void(WorldContents&)>;

class WorldTrial : public Trial {
public:
    /// Makes one world to learn its size, and tells how far that is. Throws what `fill` throws.
    WorldTrial(FillWorld fill, ReferenceMethod reference, const TellWaiting& tell = {});
    ~WorldTrial() override;

    /// The time is that of the broadphase, and of the boxes of what is put into it: nothing else of
    /// the world's.
    std::optional<double> add(const BroadphaseKind& kind, const GoOn& goOn) override;
    void beginFrame() override {}
    Observation runFrame(std::size_t contestant) override;
    /// Nothing: in a world the time is that of more than the broadphase.
    std::optional<double> removeObjects(std::size_t /*contestant*/, std::size_t /*count*/,
                                        const GoOn& /*goOn*/) override {
        return std::nullopt;
    }
    [[nodiscard]] std::optional<std::int64_t> memoryBytes(std::size_t contestant) const override;
    [[nodiscard]] std::size_t objectCount() const override { return needs_.objects; }
    [[nodiscard]] Aabb<float> bounds() const override { return needs_.bounds; }
    [[nodiscard]] bool sharesBoxes() const override { return false; }

private:
    struct World;

    void observe(World& world);

    FillWorld fill_;
    ReferenceMethod reference_;
    BroadphaseNeeds needs_;
    std::vector<std::unique_ptr<World>> worlds_;
    std::vector<Aabb<float>> boxes_;
    std::vector<CollisionFilter> filters_;
    std::vector<PairKey> exact_;
    std::vector<PairKey> reported_;
};

}  // namespace hashphase::demos
