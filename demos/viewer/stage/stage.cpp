// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/stage.hpp>

#include <demos/viewer/stage/body_shape.hpp>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace hashphase::demos {

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
    if (effects_.proximity && !before.proximity) {
        colourAgents();
    }
}

void Stage::colourAgents() {
    for (std::uint32_t index = 0; index < indexLimit(); ++index) {
        observers().setColour(index, index % effects().proximity->colourCount);
    }
}

}  // namespace hashphase::demos
