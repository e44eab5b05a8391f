// SPDX-License-Identifier: Zlib
#include <broadphase/position_region.hpp>
#include <demos/accuracy/proximity/proximity_experiment.hpp>
#include <integration/ai/proximity.hpp>

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

void ask(const Grid<float>& grid, ProxyId self, double radius, double radiusByCell,
         Measurements& measured) {
    const Vector3<float> centre = positionOf(grid.box(self));
    const auto isWithin = [&](const Aabb<float>& box) {
        return (box.cast<double>().center() - centre.cast<double>()).norm() <= radius;
    };
    std::vector<ProxyId> found;
    estimateWithin(grid, centre, static_cast<float>(radius), found, acceptAll, self);
    const double farthest = std::sqrt(3.0) * (radius + kCellSize);
    int within = 0;
    int tooFar = 0;
    for (const ProxyId id : found) {
        const Aabb<double> box = grid.box(id).cast<double>();
        within += isWithin(grid.box(id)) ? 1 : 0;
        tooFar += box.exteriorDistance(centre.cast<double>().eval()) > farthest ? 1 : 0;
    }
    int truth = 0;
    grid.forEach(
        [&](ProxyId id, const Aabb<float>& box) { truth += id != self && isWithin(box) ? 1 : 0; });
    measured.add("estimates", {{"ratio", radiusByCell},
                               {"found", found.size()},
                               {"within", within},
                               {"missed", truth - within},
                               {"too_far", tooFar}});
}

}  // namespace

void measureStatedEstimates(std::size_t estimates, std::uint64_t seed, Measurements& measured) {
    for (const double radiusByCell : {1.0, 2.0, 4.0, 8.0}) {
        const double radius = radiusByCell * kCellSize;
        AgentPlan plan;
        plan.agents = kAgents;
        plan.side = std::cbrt(static_cast<double>(kAgents) * ballVolume(radius) / kNeighbours);
        plan.edge = kEdge;
        plan.isFlat = false;
        const AgentScene scene(plan, seed);
        Grid<float> grid(GridConfig{.cellSize = kCellSize});
        std::vector<ProxyId> ids;
        for (const Aabb<float>& box : scene.boxes()) {
            ids.push_back(grid.add(box));
        }
        grid.update();
        // Only agents that have all the cells around them within the cube are asked for.
        const double margin = radius + kCellSize + kEdge;
        std::size_t asked = 0;
        for (std::size_t i = 0; i < ids.size() && asked < estimates; ++i) {
            const Vector3<double> place = scene.boxes()[i].center().cast<double>();
            if (place.minCoeff() >= margin && place.maxCoeff() <= plan.side - margin) {
                ask(grid, ids[i], radius, radiusByCell, measured);
                ++asked;
            }
        }
        const double width = 2 * radius + kCellSize + kEdge;  // as in proximity_experiment.cpp
        measured.add("theory", {{"ratio", radiusByCell},
                                {"precision", ballVolume(radius) / (width * width * width)}});
    }
}

}  // namespace hashphase::demos
