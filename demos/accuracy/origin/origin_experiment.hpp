// SPDX-License-Identifier: Zlib
#pragma once

// P6: what becomes of pairs, rays and resting bodies far from the origin, and what it costs to have
// them right.

#include <demos/accuracy/experiment.hpp>
#include <demos/accuracy/origin/origin_methods.hpp>
#include <demos/scenes/physics_world.hpp>

namespace hashphase::demos {

/// A world of Bullet's, in single precision, in which balls come to rest.
struct SettleMethod {
    std::string name;
    PhysicsBroadphase broadphase;
    bool shiftsOrigin = false;  // Bullet sees places relative to a whole-numbered origin nearby
};

/// In world coordinates over btDbvtBroadphase and over ours; over ours with the origin shifted.
[[nodiscard]] std::vector<SettleMethod> settleMethods();

struct OriginPlan {
    std::vector<double> offsets;  // 0 first, then powers of two, ascending, up to 2^30 [m]
    std::size_t boxes = 1000;
    std::size_t rays = 50;
};

/// Measures, and says what it shows (origin.sql).
[[nodiscard]] Findings findOrigin(const OriginPlan& plan, std::uint64_t seed,
                                  std::span<const OriginMethod> methods,
                                  std::span<const SettleMethod> settling, const TellProgress& tell);

}  // namespace hashphase::demos
