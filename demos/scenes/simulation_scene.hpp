// SPDX-License-Identifier: Zlib
#pragma once

// What a scene file describes, in a simulation: bodies, ground, zones.

#include <demos/scenes/effects_file.hpp>

#include <integration/effects/simulation.hpp>

#include <vector>

namespace hashphase::demos {

/// The ground of the scene, as triangles; none where it has none.
[[nodiscard]] std::vector<Vector3<float>> groundOf(const EffectsScene& scene);

/// How high it is there; 0 without ground.
[[nodiscard]] float groundHeight(const EffectsScene& scene, float x, float z);

/// Adds the bodies, with groups and colours where these are declared, and returns them in their order.
/// The same scene has the same bodies, whatever is declared.
std::vector<BodyId> addBodies(const EffectsScene& scene, Simulation<float>& simulation);

/// Adds the zones. Needs zones.
void addZones(const EffectsScene& scene, Simulation<float>& simulation);

}  // namespace hashphase::demos
