// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_probe.hpp>

#include <demos/scenes/simulation_scene.hpp>
#include <demos/scenes/terrain.hpp>

#include <broadphase/neighbours.hpp>

#include <cmath>

namespace hashphase::demos {

EffectsProbe::EffectsProbe(const EffectsScene& scene) : scene_(scene), ground_(grid_) {
    ground_.add(groundOf(scene));
}

std::size_t EffectsProbe::interpenetrating(const EffectsWorld& world) const {
    const Simulation<float>& simulation = world.simulation();
    const auto radius = static_cast<float>(scene_.radius);
    Grid<float> boxes;
    for (std::uint32_t i = 0; i < scene_.objects; ++i) {
        const Vector3<float>& place = simulation.position(world.body(i));
        const auto half = Vector3<float>::Constant(radius);
        static_cast<void>(boxes.add({place - half, place + half}));
    }
    Neighbours<float> neighbours;
    std::size_t count = 0;
    for (const auto& [a, b] : neighbours.find(boxes, 0)) {
        const Vector3<float> apart =
            simulation.position(world.body(a.index)) - simulation.position(world.body(b.index));
        count += apart.norm() < 1.95F * radius ? 1 : 0;
    }
    return count;
}

std::size_t EffectsProbe::offGround(const EffectsWorld& world) const {
    const Simulation<float>& simulation = world.simulation();
    const auto radius = static_cast<float>(scene_.radius);
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < scene_.objects; ++i) {
        const EffectSet effects = simulation.effects(world.body(i));
        if (!effects.contains(Effect::terrain) || !effects.contains(Effect::motion)) {
            continue;
        }
        const Vector3<float>& place = simulation.position(world.body(i));
        const Vector3<float> above =
            place + Vector3<float>(0, 2 * hashphase::demos::Terrain::kHighest, 0);
        const auto rest = ground_.restingHeight(above, radius);
        count += rest && std::abs(rest->height - place.y()) > 0.01F ? 1 : 0;
    }
    return count;
}

}  // namespace hashphase::demos
