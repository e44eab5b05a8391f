// SPDX-License-Identifier: Zlib
#pragma once

// Bullet's own answer to tunnelling, from end to end: spheres that fly at walls through
// btDiscreteDynamicsWorld, with its continuous collision detection or without, and how many come out
// on the other side.

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

struct FlyingBodiesPlan {
    std::vector<double> thicknesses;  // [m]
    std::vector<double> ratios;       // of the step to thickness + 2 * kBulletRadius
    int rounds = 0;                   // of kBodies each, a point
};

struct FlyingBodiesPoint {
    double ratio = 0;
    bool isContinuous = false;
    std::uint64_t bodies = 0;
    std::uint64_t tunnelled = 0;
};

/// "Bullet's bodies, continuous"
[[nodiscard]] std::string nameOf(const FlyingBodiesPoint& point);

/// A point for each ratio with continuous detection, and one without, over all thicknesses.
[[nodiscard]] std::vector<FlyingBodiesPoint> measureFlyingBodies(const FlyingBodiesPlan& plan,
                                                                 std::uint64_t seed);

}  // namespace hashphase::demos
