// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/stage.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

namespace hashphase::demos {

SceneEffects effectsOf(EffectSet effects) {
    SceneEffects declared;
    for (const Effect effect : kAllEffects) {
        if (effects.contains(effect)) {
            declared.declare(effect);
        }
    }
    return declared;
}

std::size_t Stage::remove(std::span<const std::uint32_t> indices) {
    const auto count =
        std::ranges::count_if(indices, [this](std::uint32_t index) { return removeOne(index); });
    forgetRemoved();
    return static_cast<std::size_t>(count);
}

void Stage::setBroadphase(const BroadphaseKind& kind) {
    if (&kind != broadphase_) {
        useBroadphase(kind);
        broadphase_ = &kind;
    }
}

Picked<float> Stage::pick(const RayRegion<float>& ray) {
    const float groundShare = meets(ground(), ray.from(), ray.direction()).value_or(1);
    const auto exactly = [&](ProxyId id, const RayRegion<float>& along,
                             float limit) -> std::optional<float> {
        const std::optional<float> share = meets(body(id.index), along.from(), along.direction());
        return share && *share <= std::min(limit, groundShare) ? share : std::nullopt;
    };
    return grid() != nullptr ? observers().pick({*grid()}, ray, exactly) : Picked<float>{};
}

void Stage::declare(const SceneEffects& effects) {
    if (const std::string fault = faultOf(effects); !fault.empty()) {
        throw std::invalid_argument(fault);
    }
    const SceneEffects before = std::exchange(effects_, effects);
    follow(before);
    noteZones();
    if (!effects_.radar) {
        radar_.reset();
    }
    if (effects_.proximity && !before.proximity) {
        colourAgents();
    }
}

void Stage::step() {
    runFrame();
    noteZones();
    if (effects_.radar && observers().cost()[SceneCounter::radarScans] > 0) {
        noteRadar();
    }
}

// Scenes add balls, and remove none.
void Stage::noteZones() {
    interestZones_.clear();
    if (!effects_.zones) {
        return;
    }
    const Zones<float>& zones = observers().zones();
    for (std::uint32_t index = 0; index < zones.size(); ++index) {
        const ZoneId id{index, 1};
        const Aabb<float> box = std::get<SphereRegion<float>>(zones.zone(id).shape).bounds();
        interestZones_.push_back({box.center(), box.sizes().x() / 2, zones.occupants(id).size()});
    }
}

// Its cells begin at multiples of their size: see RadarWindow.
void Stage::noteRadar() {
    const RadarEffect& effect = *effects_.radar;
    radar_.reset();
    if (effect.up != UpAxis::y) {
        return;
    }
    const auto size = static_cast<float>(effect.cellSize);
    const Vector3<float> centre = observers().interest().value_or(Vector3<float>::Zero());
    const auto first = [size](float middle, std::uint32_t count) {
        return size * (std::floor(middle / size) - static_cast<float>(count / 2));
    };
    radar_ = RadarView{{first(centre.x(), effect.columns), first(centre.z(), effect.rows)},
                       size,
                       effect.columns,
                       effect.rows,
                       effect.groupCount,
                       observers().radarCounts()};
}

void Stage::colourAgents() {
    for (std::uint32_t index = 0; index < indexLimit(); ++index) {
        observers().setColour(index, index % effects().proximity->colourCount);
    }
}

}  // namespace hashphase::demos
