// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/stage.hpp>

#include <demos/viewer/stage/body_shape.hpp>

#include <algorithm>

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

void Stage::colourAgents(bool hadColours) {
    if (hadColours || !effects().proximity) {
        return;
    }
    for (std::uint32_t index = 0; index < indexLimit(); ++index) {
        observers().setColour(index, index % effects().proximity->colourCount);
    }
}

}  // namespace hashphase::demos
