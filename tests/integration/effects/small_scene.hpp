// SPDX-License-Identifier: Zlib
#pragma once

// A scene with something for every effect, small enough to be run thousands of times.

#include <integration/effects/simulation.hpp>
#include <tests/support/camera_matrices.hpp>
#include <tests/support/random.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace hashphase::test {

/// Those that a Simulation runs.
inline constexpr EffectSet kSimulated =
    EffectSet::all() - EffectSet{Effect::rotation, Effect::friction};

/// A frame [s].
inline constexpr float kStep = 1.0F / 64;

/// What a body takes part in that stands.
inline const EffectSet kStanding = EffectSet::all() - EffectSet{Effect::motion};

/// So many frames; returns what they cost altogether.
template <class Scalar>
SceneCost run(Simulation<Scalar>& simulation, int frames, Scalar seconds = Scalar(kStep)) {
    SceneCost sum;
    for (int frame = 0; frame < frames; ++frame) {
        sum += simulation.advance(seconds);
    }
    return sum;
}

/// These effects, with default settings.
[[nodiscard]] inline SceneEffects declared(EffectSet set) {
    SceneEffects effects;
    for (const Effect effect : kAllEffects) {
        if (set.contains(effect)) {
            effects.declare(effect);
        }
    }
    return effects;
}

/// The effects with settings under which each has something to do in the small scene.
[[nodiscard]] inline SceneEffects smallSceneEffects(EffectSet set) {
    SceneEffects effects = declared(set);
    if (effects.motion) {
        effects.motion->bounds = {Vector3<double>(0, -100, 0), Vector3<double>(20, 100, 20)};
    }
    if (effects.sleeping) {
        effects.sleeping->interestRadius = 12;
    }
    if (effects.culling) {
        effects.culling->margin = 0.5;
    }
    if (effects.proximity) {
        effects.proximity->radius = 4;
    }
    if (effects.radar) {
        effects.radar = RadarEffect{.cellSize = 5, .columns = 6, .rows = 6, .groupCount = 2};
    }
    return effects;
}

/// A camera in a corner.
[[nodiscard]] inline Camera<float> smallSceneView() {
    const Eigen::Matrix4d camera = cameraMatrix<double>({}, {-2, 6, -2}, {10, 0, 10});
    return {camera.cast<float>(), DepthRange::zeroToOne, {0, 0, 800, 500}};
}

/// Bodies that meet, of which each fourth is fast, a ground of slopes, a camera, zones.
inline void fill(Simulation<float>& simulation, int bodyCount = 40) {
    const EffectSet declared = simulation.declared().set();
    Random random(0x5eed0fec);
    for (int i = 0; i < bodyCount; ++i) {
        const double speed = i % 4 == 0 ? 150 : 3;
        const Vector3<double> position = random.pointIn({0, 1, 0}, {20, 3, 20});
        const Vector3<double> velocity = random.pointIn({-speed, 0, -speed}, {speed, 0, speed});
        simulation.add({.position = position.cast<float>(),
                        .radius = static_cast<float>(random.between(0.5, 1)),
                        .velocity = velocity.cast<float>(),
                        .group = static_cast<std::uint32_t>(i % 2)});
    }
    if (declared.contains(Effect::terrain)) {
        const std::vector<Vector3<float>> corners{{-5, 0, -5}, {30, 1, -5}, {-5, 2, 30},
                                                  {30, 1, -5}, {30, 0, 30}, {-5, 2, 30}};
        simulation.ground().add(corners);
    }
    Observers<float>& observers = simulation.observers();
    observers.setInterest(Vector3<float>(10, 1, 10));
    if (declared.contains(Effect::culling)) {
        const Camera<float> view = smallSceneView();
        observers.setView(frustumRegion<float>(view.viewProjection(), DepthRange::zeroToOne));
    }
    if (declared.contains(Effect::proximity)) {
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(bodyCount); ++i) {
            observers.setColour(i, i % 4);
        }
    }
    if (declared.contains(Effect::zones)) {
        static_cast<void>(observers.zones().add({SphereRegion<float>({10, 1, 10}, 5)}));
        static_cast<void>(observers.zones().add(
            {BoxRegion<float>{{Vector3<float>(0, -5, 0), Vector3<float>(8, 5, 8)}},
             Presence::box}));
    }
}

}  // namespace hashphase::test
