// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own answer to tunnelling, from end to end: spheres that fly at walls through
// btDiscreteDynamicsWorld, with its continuous collision detection or without, and how many come out
// on the other side.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct FlyingBodiesPoint {
    double ratio = 0;
    bool isContinuous = false;
    std::uint64_t bodies = 0;
    std::uint64_t tunnelled = 0;
};

/// "Bullet's bodies, continuous"
[[nodiscard]] std::string nameOf(const FlyingBodiesPoint& point);

/// A point for each ratio without continuous detection, then one with it, of `rounds` times 32 bodies
/// for each thickness [m]. Ratios are of the step to thickness + 2 * kBulletRadius.
[[nodiscard]] std::vector<FlyingBodiesPoint> measureFlyingBodies(
    std::span<const double> thicknesses, std::span<const double> ratios, int rounds,
    std::uint64_t seed);

}  // namespace hashphase::demos
