// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/proximity_experiment.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase::demos {
namespace {

constexpr double kUnitsPerMetre = 256;

std::int32_t unitsOf(double metres) {
    return static_cast<std::int32_t>(std::lround(metres * kUnitsPerMetre));
}

}  // namespace

AgentScene::AgentScene(const AgentPlan& plan, std::uint64_t seed)
    : random_(seed),
      isFlat_(plan.isFlat),
      side_(unitsOf(plan.side)),
      step_(std::max(1, unitsOf(plan.step))),
      halfEdge_(static_cast<float>(unitsOf(plan.edge) / 2 / kUnitsPerMetre)),
      places_(plan.agents, Place{}) {
    moveBy(0, side_);
}

void AgentScene::moveBy(std::int32_t low, std::int32_t high) {
    const auto count = static_cast<float>(high - low + 1);
    const Vector3<float> half = Vector3<float>::Constant(halfEdge_);
    boxes_.clear();
    for (Place& place : places_) {
        for (const std::size_t axis : {0U, 2U, 1U}) {
            if (axis != 1 || !isFlat_) {
                const auto way = low + static_cast<std::int32_t>(random_.unit() * count);
                place[axis] = std::clamp(place[axis] + std::min(way, high), 0, side_);
            }
        }
        const auto metres = [&](std::size_t axis) {
            return static_cast<float>(place[axis] / kUnitsPerMetre);
        };
        const Vector3<float> centre(metres(0), metres(1), metres(2));
        boxes_.emplace_back(centre - half, centre + half);
    }
}

Aabb<float> AgentScene::bounds() const {
    const auto side = static_cast<float>(side_ / kUnitsPerMetre);
    const Vector3<float> low = Vector3<float>::Constant(-halfEdge_);
    return {low, Vector3<float>(side, isFlat_ ? 0 : side, side) - low};
}

}  // namespace hashphase::demos
