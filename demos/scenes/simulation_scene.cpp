// SPDX-License-Identifier: Zlib
#include <demos/scenes/simulation_scene.hpp>

#include <demos/scenes/random.hpp>
#include <demos/scenes/terrain.hpp>

#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float heightOf(const EffectsScene& scene, const Terrain& hills, float x, float z) {
    return scene.terrain > 0 ? hills.height(x, z) : 0;
}

}  // namespace

float groundHeight(const EffectsScene& scene, float x, float z) {
    return heightOf(scene, Terrain(scene.seed), x, z);
}

std::vector<Vector3<float>> groundOf(const EffectsScene& scene) {
    const Terrain hills(scene.seed);
    const float side = static_cast<float>(scene.domain) / static_cast<float>(scene.terrain);
    const auto corner = [&](std::uint32_t i, std::uint32_t k) -> Vector3<float> {
        const float x = side * static_cast<float>(i);
        const float z = side * static_cast<float>(k);
        return {x, hills.height(x, z), z};
    };
    std::vector<Vector3<float>> corners;
    for (std::uint32_t i = 0; i < scene.terrain; ++i) {
        for (std::uint32_t k = 0; k < scene.terrain; ++k) {
            for (const auto& [di, dk] : {std::pair(0U, 0U),
                                         {1U, 0U},
                                         {0U, 1U},  //
                                         {1U, 0U},
                                         {1U, 1U},
                                         {0U, 1U}}) {
                corners.push_back(corner(i + di, k + dk));
            }
        }
    }
    return corners;
}

std::vector<BodyId> addBodies(const EffectsScene& scene, Simulation<float>& simulation) {
    Random random(scene.seed);
    const Terrain hills(scene.seed);
    std::vector<BodyId> bodies;
    const auto domain = static_cast<float>(scene.domain);
    const auto radius = static_cast<float>(scene.radius);
    for (std::uint32_t i = 0; i < scene.objects; ++i) {
        const float x = random.between(radius, domain - radius);
        const float z = random.between(radius, domain - radius);
        const float heading = random.between(-kPi, kPi);
        const float lot = random.unit();
        const float pace = random.between(0.5F, 1.5F);
        const bool flies = lot < static_cast<float>(scene.fast);
        const bool moves = lot < static_cast<float>(scene.moving);
        const auto speed =
            flies ? static_cast<float>(scene.fastSpeed) : pace * static_cast<float>(scene.speed);
        Body<float> body;
        body.position = {x, heightOf(scene, hills, x, z) + radius, z};
        body.radius = radius;
        body.velocity = {speed * std::cos(heading), 0, speed * std::sin(heading)};
        body.group = i;
        if (flies) {
            body.effects.erase(Effect::terrain);
        } else if (!moves) {
            body.effects.erase(Effect::motion);
        }
        if (simulation.declared().radar) {
            body.group = i % simulation.declared().radar->groupCount;
        }
        bodies.push_back(simulation.add(body));
        if (simulation.declared().proximity) {
            simulation.observers().setColour(bodies.back().index,
                                             i % simulation.declared().proximity->colourCount);
        }
    }
    return bodies;
}

void addZones(const EffectsScene& scene, Simulation<float>& simulation) {
    Random random(scene.seed + 1);  // so that zones do not depend on bodies
    const Terrain hills(scene.seed);
    const auto domain = static_cast<float>(scene.domain);
    for (std::uint32_t i = 0; i < scene.zones; ++i) {
        const float x = random.between(0, domain);
        const float z = random.between(0, domain);
        static_cast<void>(simulation.observers().zones().add(
            {SphereRegion<float>({x, heightOf(scene, hills, x, z), z}, domain / 20)}));
    }
}

}  // namespace hashphase::demos
