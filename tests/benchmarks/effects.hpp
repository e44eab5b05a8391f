// SPDX-License-Identifier: Zlib
#pragma once

// Scenes of spheres that roam a square, and who runs their frames: a Simulation, or a frame by hand.

#include <broadphase/convex_region.hpp>
#include <broadphase/pairs.hpp>
#include <integration/effects/effect.hpp>
#include <tests/benchmarks/workload.hpp>

namespace hashphase::benchmarks {

/// Spheres as dense as the paper's.
struct RoamingSpheres {
    RoamingSpheres(std::size_t count, std::uint64_t seed);

    static constexpr float kRadius = 1;            // on the mean; by up to a tenth more or less [m]
    static constexpr float kTimeStep = 1.0F / 60;  // [s]
    static constexpr float kSight = 10;            // how far colours are seen [m]
    static constexpr std::uint32_t kColours = 4;

    Aabb<float> bounds;  // of their centres, where they turn back
    std::vector<Vector3<float>> positions;
    std::vector<Vector3<float>> velocities;
    std::vector<float> radii;
    std::vector<std::uint32_t> colours;
};

/// Who runs the frames of a scene with motion and one of pairs, pairs and response, culling, or proximity.
class EffectsBody : public Interface {
public:
    /// A frame; `view` is what the camera sees in it.
    virtual void advance(const ConvexRegion<float>& view) = 0;

    [[nodiscard]] virtual Vector3<float> position(std::uint32_t body) const = 0;

    /// Appends what the scene's own effect said in the last frame.
    virtual void listFinds(std::vector<Answer>& finds) const = 0;
};

/// Finds as answers: births and deaths of pairs, and each body's colour.
void listChanges(const PairChanges& changes, std::vector<Answer>& finds);
void listColours(std::span<const std::uint32_t> colours, std::vector<Answer>& finds);

/// The frames as one writes them for just that scene: what a build without hashphase::effects would run.
[[nodiscard]] std::unique_ptr<EffectsBody> makeByHand(EffectSet own, const RoamingSpheres& spheres);

}  // namespace hashphase::benchmarks
