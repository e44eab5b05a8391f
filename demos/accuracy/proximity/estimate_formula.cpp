// SPDX-License-Identifier: Zlib
#include <demos/accuracy/proximity/estimate_formula.hpp>

#include <broadphase/position_region.hpp>
#include <demos/accuracy/proximity/agent_scene.hpp>
#include <integration/ai/proximity.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hashphase::demos {
namespace {

constexpr double kCellSize = 2;  // [m]
constexpr double kEdge = kCellSize / 2;
constexpr double kNeighbours = 20;
constexpr std::size_t kAgents = 8000;

double ballVolume(double radius) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

void ask(const Grid<float>& grid, ProxyId self, double radius, StatedEstimate& counted) {
    const Vector3<float> centre = positionOf(grid.box(self));
    std::vector<ProxyId> found;
    estimateWithin(grid, centre, static_cast<float>(radius), found, acceptAll, self);
    const double farthest = std::sqrt(3.0) * (radius + kCellSize);
    std::uint64_t within = 0;
    for (const ProxyId id : found) {
        const Aabb<double> box = grid.box(id).cast<double>();
        const double distance = (box.center() - centre.cast<double>()).norm();
        within += distance <= radius ? 1 : 0;
        counted.tooFar += box.exteriorDistance(centre.cast<double>().eval()) > farthest ? 1 : 0;
    }
    std::uint64_t truth = 0;
    grid.forEach([&](ProxyId id, const Aabb<float>& box) {
        const double distance = (box.cast<double>().center() - centre.cast<double>()).norm();
        truth += id != self && distance <= radius ? 1 : 0;
    });
    counted.found += found.size();
    counted.within += within;
    counted.missed += truth - within;
}

/// Agents in a cube so large that each has twenty others in a ball of that radius.
AgentPlan planFor(double radius) {
    AgentPlan plan;
    plan.agents = kAgents;
    plan.side = std::cbrt(static_cast<double>(kAgents) * ballVolume(radius) / kNeighbours);
    plan.edge = kEdge;
    plan.isFlat = false;
    return plan;
}

/// Asks for agents that have all the cells around them within the cube.
void askMany(double radius, std::size_t estimates, std::uint64_t seed, StatedEstimate& counted) {
    const AgentPlan plan = planFor(radius);
    const AgentScene scene(plan, seed);
    GridConfig config;
    config.cellSize = kCellSize;
    Grid<float> grid(config);
    std::vector<ProxyId> ids;
    for (const Aabb<float>& box : scene.boxes()) {
        ids.push_back(grid.add(box));
    }
    grid.update();
    const double margin = radius + kCellSize + kEdge;
    std::size_t asked = 0;
    for (std::size_t i = 0; i < ids.size() && asked < estimates; ++i) {
        const Vector3<float> place = scene.boxes()[i].center();
        if (static_cast<double>(place.minCoeff()) >= margin &&
            static_cast<double>(place.maxCoeff()) <= plan.side - margin) {
            ask(grid, ids[i], radius, counted);
            ++asked;
        }
    }
}

}  // namespace

double estimatePrecisionOnPlain(double radius, double cellSize, double edge) {
    const double width = 2 * radius + cellSize + edge;
    return std::numbers::pi * radius * radius / (width * width);
}

double estimatePrecisionInSpace(double radius, double cellSize, double edge) {
    const double width = 2 * radius + cellSize + edge;
    return ballVolume(radius) / (width * width * width);
}

double StatedEstimate::precision() const {
    return found == 0 ? 0 : static_cast<double>(within) / static_cast<double>(found);
}

std::vector<StatedEstimate> checkStatedEstimates(std::size_t estimates, std::uint64_t seed) {
    constexpr std::array<std::array<double, 2>, 4> kStated{{{1, 1}, {2, 2}, {4, 3}, {8, 4}}};
    std::vector<StatedEstimate> results;
    for (const auto& [radiusByCell, tenths] : kStated) {
        const double radius = radiusByCell * kCellSize;
        StatedEstimate counted;
        counted.radiusByCell = radiusByCell;
        counted.statedTenths = tenths;
        counted.theory = estimatePrecisionInSpace(radius, kCellSize, kEdge);
        askMany(radius, estimates, seed, counted);
        results.push_back(counted);
    }
    return results;
}

}  // namespace hashphase::demos
