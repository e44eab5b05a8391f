// SPDX-License-Identifier: Zlib
#include <demos/effects/effects_world.hpp>

#include <demos/scenes/camera_view.hpp>

#include <bit>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr double kScreenWidth = 1600;
constexpr double kScreenHeight = 900;

float heightAt(const EffectsScene& scene, const Terrain& hills, float x, float z) {
    return scene.terrain > 0 ? hills.height(x, z) : 0;
}

View<float> viewOf(const CameraPose& pose) {
    return {cameraView(pose).viewProjection, kDepthRange, {0, 0, kScreenWidth, kScreenHeight}};
}

/// FNV-1a, by Fowler, Noll and Vo.
class ResultHash {
public:
    void add(std::uint64_t number) { value_ = (value_ ^ number) * 0x100000001b3U; }
    void add(const Vector3<float>& vector) {
        for (int axis = 0; axis < 3; ++axis) {
            add(std::bit_cast<std::uint32_t>(vector[axis]));
        }
    }
    void add(ProxyId id) { add(std::uint64_t{id.index}); }
    void add(const ZoneEvent& event) {
        add(event.zone.index);
        add(event.proxy);
    }
    void add(const ProxyPair& pair) {
        add(pair.first);
        add(pair.second);
    }
    template <class List>
    void addAll(const List& list) {
        for (const auto& item : list) {
            add(item);
        }
        add(list.size());
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace

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

EffectsWorld::EffectsWorld(const EffectsScene& scene, const SceneEffects& effects)
    : scene_(scene),
      declared_(effects.set()),
      hills_(scene.seed),
      simulation_(effects),
      view_(viewOf({})) {
    // Each has numbers of its own, so that none depends on what the others are declared for.
    Random bodyNumbers(scene.seed);
    Random zoneNumbers(scene.seed + 1);
    addBodies(bodyNumbers);
    if (declared_.contains(Effect::terrain)) {
        simulation_.ground().add(groundOf(scene));
    }
    if (declared_.contains(Effect::zones)) {
        addZones(zoneNumbers);
    }
}

void EffectsWorld::addBodies(Random& random) {
    const auto domain = static_cast<float>(scene_.domain);
    const auto radius = static_cast<float>(scene_.radius);
    for (std::uint32_t i = 0; i < scene_.objects; ++i) {
        const float x = random.between(radius, domain - radius);
        const float z = random.between(radius, domain - radius);
        const float heading = random.between(-kPi, kPi);
        const float lot = random.unit();
        const float pace = random.between(0.5F, 1.5F);
        const bool flies = lot < static_cast<float>(scene_.fast);
        const bool moves = lot < static_cast<float>(scene_.moving);
        const auto speed =
            flies ? static_cast<float>(scene_.fastSpeed) : pace * static_cast<float>(scene_.speed);
        Body<float> body;
        body.position = {x, heightAt(scene_, hills_, x, z) + radius, z};
        body.radius = radius;
        body.velocity = {speed * std::cos(heading), 0, speed * std::sin(heading)};
        body.group = i;
        if (flies) {
            body.effects.erase(Effect::terrain);
        } else if (!moves) {
            body.effects.erase(Effect::motion);
        }
        if (simulation_.declared().radar) {
            body.group = i % simulation_.declared().radar->groupCount;
        }
        bodies_.push_back(simulation_.add(body));
        if (simulation_.declared().proximity) {
            simulation_.observers().setColour(bodies_.back().index,
                                              i % simulation_.declared().proximity->colourCount);
        }
    }
}

void EffectsWorld::addZones(Random& random) {
    const auto domain = static_cast<float>(scene_.domain);
    for (std::uint32_t i = 0; i < scene_.zones; ++i) {
        const float x = random.between(0, domain);
        const float z = random.between(0, domain);
        static_cast<void>(simulation_.observers().zones().add(
            {SphereRegion<float>({x, heightAt(scene_, hills_, x, z), z}, domain / 20)}));
    }
}

void EffectsWorld::beginFrame(std::uint32_t frame) {
    // In the middle, somewhat above the ground; it turns for half of the time.
    constexpr std::uint32_t kPeriod = 60;  // frames
    const std::uint32_t turning =
        frame / kPeriod * (kPeriod / 2) + std::min(frame % kPeriod, kPeriod / 2);
    const float middle = static_cast<float>(scene_.domain) / 2;
    const float height = heightAt(scene_, hills_, middle, middle) + 15;
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

}  // namespace hashphase::demos
