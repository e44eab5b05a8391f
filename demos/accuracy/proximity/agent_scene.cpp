// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/agent_scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

constexpr double kUnitsPerMetre = 256;
constexpr std::array<std::size_t, 3> kAxisOrder{0, 2, 1};

std::int32_t unitsOf(double metres) {
    return static_cast<std::int32_t>(std::lround(metres * kUnitsPerMetre));
}

}  // namespace

AgentScene::AgentScene(const AgentPlan& plan, std::uint64_t seed)
    : random_(seed),
      axes_(plan.isFlat ? 2 : 3),
      side_(unitsOf(plan.side)),
      step_(std::max(1, unitsOf(plan.step))),
      halfEdge_(static_cast<float>(unitsOf(plan.edge) / 2 / kUnitsPerMetre)),
      places_(plan.agents) {
    for (Place& place : places_) {
        for (int i = 0; i < axes_; ++i) {
            place[kAxisOrder[static_cast<std::size_t>(i)]] = draw(0, side_);
        }
    }
    placeBoxes();
}

void AgentScene::advance() {
    for (Place& place : places_) {
        for (int i = 0; i < axes_; ++i) {
            std::int32_t& coordinate = place[kAxisOrder[static_cast<std::size_t>(i)]];
            coordinate = std::clamp(coordinate + draw(-step_, step_), 0, side_);
        }
    }
    placeBoxes();
}

Aabb<float> AgentScene::bounds() const {
    const auto side = static_cast<float>(side_ / kUnitsPerMetre);
    const Vector3<float> low = Vector3<float>::Constant(-halfEdge_);
    return {low, Vector3<float>(side, axes_ == 3 ? side : 0, side) - low};
}

std::int32_t AgentScene::draw(std::int32_t low, std::int32_t high) {
    const auto count = static_cast<float>(high - low + 1);
    return std::min(low + static_cast<std::int32_t>(random_.unit() * count), high);
}

void AgentScene::placeBoxes() {
    boxes_.clear();
    const Vector3<float> half = Vector3<float>::Constant(halfEdge_);
    for (const Place& place : places_) {
        const auto metres = [&](std::size_t axis) {
            return static_cast<float>(place[axis] / kUnitsPerMetre);
        };
        const Vector3<float> centre(metres(0), metres(1), metres(2));
        boxes_.emplace_back(centre - half, centre + half);
    }
}

}  // namespace hashphase::demos
