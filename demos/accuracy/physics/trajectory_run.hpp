// SPDX-License-Identifier: Zlib
#pragma once

// What P8 runs, and what it measured as tables and as charts.

#include <demos/accuracy/physics/scene_run.hpp>
#include <demos/accuracy/physics/trajectory_experiment.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// In which orders of lists the scenes are run.
inline constexpr std::array kListOrders{ListOrder::canonical, ListOrder::byUniqueId,
                                        ListOrder::asShipped};

/// Everything that was run: outcomes[order][scene][broadphase].
struct TrajectoryRun {
    std::span<const PhysicsBroadphase> broadphases;
    std::span<const PhysicsScene> scenes;
    TrajectorySettings settings;
    std::vector<std::vector<std::vector<SceneOutcome>>> outcomes;

    [[nodiscard]] std::size_t objects(const PhysicsScene& scene) const {
        return settings.isQuick ? scene.quickObjects : scene.fullObjects;
    }
    [[nodiscard]] std::size_t indexOf(std::string_view name) const {
        const auto at = std::find_if(broadphases.begin(), broadphases.end(),
                                     [name](const auto& each) { return each.name == name; });
        return static_cast<std::size_t>(at - broadphases.begin());
    }
    [[nodiscard]] const std::vector<std::vector<SceneOutcome>>& in(ListOrder order) const {
        return outcomes[static_cast<std::size_t>(
            std::find(kListOrders.begin(), kListOrders.end(), order) - kListOrders.begin())];
    }
    /// In how many scenes the broadphase moves bodies as the reference does.
    [[nodiscard]] std::size_t sameCount(ListOrder order, std::size_t broadphase) const {
        const auto& scenesOfOrder = in(order);
        return static_cast<std::size_t>(
            std::count_if(scenesOfOrder.begin(), scenesOfOrder.end(),
                          [&](const auto& scene) { return scene[broadphase].isSame(); }));
    }
    [[nodiscard]] std::string sameText(ListOrder order, std::size_t broadphase) const {
        return std::to_string(sameCount(order, broadphase)) + " of " +
               std::to_string(scenes.size());
    }
};

[[nodiscard]] TrajectoryRun runTrajectories(std::span<const PhysicsBroadphase> broadphases,
                                            std::span<const PhysicsScene> scenes,
                                            const TrajectorySettings& settings,
                                            const TellProgress& tell);

[[nodiscard]] std::string trajectorySettingsText(const TrajectoryRun& run);

/// Whose bodies move as under brute force, scene by scene; what a step costs, lists as shipped.
[[nodiscard]] std::vector<DataTable> trajectoryTables(const TrajectoryRun& run);
[[nodiscard]] std::vector<Chart> trajectoryCharts(const TrajectoryRun& run);

}  // namespace hashphase::demos
