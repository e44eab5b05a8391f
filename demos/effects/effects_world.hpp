// SPDX-License-Identifier: Zlib
#pragma once

// A scene file come to life: bodies, ground, zones, a camera that looks about, and somebody who clicks; and what
// is wrong in it.

#include <demos/scenes/effects_file.hpp>

#include <integration/effects/simulation.hpp>

#include <cstdint>
#include <vector>

namespace hashphase::demos {

/// A simulation of the scene, with the effects that are given in place of the file's own. The same
/// scene has the same bodies, whatever is declared.
class EffectsWorld {
public:
    EffectsWorld(const EffectsScene& scene, const SceneEffects& effects);

    /// Turns the camera, which is not timed.
    void beginFrame(std::uint32_t frame);

    /// Clicks, drags, and simulates a frame.
    void runFrame();

    [[nodiscard]] const Simulation<float>& simulation() const noexcept { return simulation_; }
    [[nodiscard]] Simulation<float>& simulation() noexcept { return simulation_; }

    /// All that was found in the last frame, and where bodies are, as one number for each effect that
    /// looks: equal where the results are.
    [[nodiscard]] std::uint64_t resultOf(Effect effect) const;
    [[nodiscard]] std::uint64_t placesResult() const;

    /// Bodies are numbered from 0 in the order of the scene.
    [[nodiscard]] BodyId body(std::uint32_t number) const { return bodies_[number]; }

    static constexpr int kPicks = 20;  // a frame
    static constexpr int kSelections = 2;

private:
    EffectsScene scene_;
    EffectSet declared_;
    Simulation<float> simulation_;
    std::vector<BodyId> bodies_;
    Camera<float> view_;
    std::vector<Pixel> clicks_;         // of the frame
    std::vector<ProxyId> picked_;       // by them
    std::vector<ProxyId> selected_;     // by the last rectangle
    std::vector<ProxyId> allSelected_;  // by all of the frame
};

/// What is wrong in a scene, found by looking at all of it: what effects are there to prevent.
class EffectsProbe {
public:
    explicit EffectsProbe(const EffectsScene& scene);

    /// Pairs of spheres that reach into each other by more than a twentieth of a radius.
    [[nodiscard]] std::size_t interpenetrating(const EffectsWorld& world) const;

    /// Bodies that walk, and whose height is wrong by more than a centimetre.
    [[nodiscard]] std::size_t offGround(const EffectsWorld& world) const;

private:
    EffectsScene scene_;
    Grid<float> grid_;
    hashphase::Terrain<float> ground_;
};

}  // namespace hashphase::demos
