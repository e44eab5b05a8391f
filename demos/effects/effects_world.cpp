// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_world.hpp>

#include <demos/scenes/camera_view.hpp>
#include <demos/scenes/random.hpp>
#include <demos/scenes/result_hash.hpp>
#include <demos/scenes/simulation_scene.hpp>
#include <demos/scenes/terrain.hpp>

#include <broadphase/neighbours.hpp>

#include <cmath>

namespace hashphase::demos {
namespace {

constexpr double kScreenWidth = 1600;
constexpr double kScreenHeight = 900;

Camera<float> viewOf(const CameraPose& pose) {
    return {cameraView(pose).viewProjection, kDepthRange, {0, 0, kScreenWidth, kScreenHeight}};
}

}  // namespace

EffectsWorld::EffectsWorld(const EffectsScene& scene, const SceneEffects& effects)
    : scene_(scene), declared_(effects.set()), simulation_(effects), view_(viewOf({})) {
    bodies_ = addBodies(scene, simulation_);
    if (declared_.contains(Effect::terrain)) {
        simulation_.ground().add(groundOf(scene));
    }
    if (declared_.contains(Effect::zones)) {
        addZones(scene, simulation_);
    }
}

void EffectsWorld::beginFrame(std::uint32_t frame) {
    // In the middle, somewhat above the ground; it turns for half of the time.
    constexpr std::uint32_t kPeriod = 60;  // frames
    const std::uint32_t turning =
        frame / kPeriod * (kPeriod / 2) + std::min(frame % kPeriod, kPeriod / 2);
    const float middle = static_cast<float>(scene_.domain) / 2;
    const float height = groundHeight(scene_, middle, middle) + 15;
    const CameraPose pose{.eye = {middle, height, middle},
                          .yaw = 0.02F * static_cast<float>(turning),
                          .pitch = -0.2F,
                          .fieldOfView = 0.9F,
                          .farPlane = 0.4F * static_cast<float>(scene_.domain)};
    view_ = viewOf(pose);
    simulation_.observers().setInterest(pose.eye);
    if (declared_.contains(Effect::culling)) {
        simulation_.observers().setView(
            ConvexRegion<float>(cameraView(pose).planes, Containment::touching, Touch::byPlanes));
    }
    Random random(scene_.seed + frame);
    clicks_.clear();
    for (int i = 0; i < kPicks + 2 * kSelections; ++i) {
        const double x = double{random.unit()} * kScreenWidth;
        const double y = double{random.unit()} * kScreenHeight;
        clicks_.emplace_back(x, y);
    }
}

void EffectsWorld::runFrame() {
    picked_.clear();
    allSelected_.clear();
    if (declared_.contains(Effect::picking)) {
        for (int i = 0; i < kPicks; ++i) {
            const Pixel& pixel = clicks_[static_cast<std::size_t>(i)];
            picked_.push_back(simulation_.pick(view_.rayThrough(pixel)).id);
        }
    }
    if (declared_.contains(Effect::boxSelection)) {
        for (std::size_t i = kPicks; i + 1 < clicks_.size(); i += 2) {
            simulation_.select(view_, clicks_[i], clicks_[i + 1], selected_);
            allSelected_.insert(allSelected_.end(), selected_.begin(), selected_.end());
        }
    }
    simulation_.advance(static_cast<float>(scene_.timeStep));
}

std::uint64_t EffectsWorld::placesResult() const {
    ResultHash hash;
    for (const BodyId& body : bodies_) {
        hash.add(simulation_.position(body));
    }
    return hash.value();
}

std::uint64_t EffectsWorld::resultOf(Effect effect) const {
    ResultHash hash;
    const Observers<float>& observers = simulation_.observers();
    switch (effect) {
        case Effect::pairs:
            hash.addAll(simulation_.pairChanges().born);
            hash.addAll(simulation_.pairChanges().died);
            break;
        case Effect::picking:
            hash.addAll(picked_);
            break;
        case Effect::boxSelection:
            hash.addAll(allSelected_);
            break;
        case Effect::culling:
            hash.addAll(observers.culler().bits());
            break;
        case Effect::proximity:
            hash.addAll(observers.colours());
            break;
        case Effect::zones:
            hash.addAll(observers.zoneEvents().entered);
            hash.addAll(observers.zoneEvents().stayed);
            hash.addAll(observers.zoneEvents().left);
            break;
        case Effect::radar:
            hash.addAll(observers.radarCounts());
            break;
        default:
            return placesResult();
    }
    return hash.value();
}

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
