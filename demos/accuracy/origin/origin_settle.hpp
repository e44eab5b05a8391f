// SPDX-License-Identifier: Zlib
#pragma once

// Where balls come to rest that fall far from the origin, in Bullet with single precision.

#include <demos/report/statistics.hpp>
#include <demos/scenes/physics_world.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::demos {

struct SettleMethod {
    std::string name;
    PhysicsBroadphase broadphase;
    bool shiftsOrigin = false;  // Bullet sees places relative to a whole-numbered origin nearby
};

/// In world coordinates over btDbvtBroadphase and over ours; over ours with the origin shifted.
[[nodiscard]] std::vector<SettleMethod> settleMethods();

struct SettleOutcome {
    double positionError = 0;  // of the ball that is farthest from where it ought to rest [m]
    int settleStep = 0;        // after which no ball moves by more than a millimetre
    Spread stepMs;
    std::uint64_t localState = 0;  // of the last step, as Bullet sees it; see stateHash()
};

/// Drops balls onto a floor at `offset` along all three axes, by all methods in turn.
[[nodiscard]] std::vector<SettleOutcome> settleAt(double offset,
                                                  std::span<const SettleMethod> methods);

}  // namespace hashphase::demos
