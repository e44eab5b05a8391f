// SPDX-License-Identifier: Zlib
#pragma once

// Boxes that are handed to a broadphase as they are, and the numbers that some of them are made of.

#include <tests/integration/bullet/player.hpp>

#include <limits>

namespace hashphase::test {

inline constexpr btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN();
inline constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();

inline const Box kUnit = boxAround({0, 0, 0}, {1, 1, 1});

/// Filtered as Bullet does it by default.
inline Command createCommand(int object, const Box& box) {
    return {Action::create, object, box, btBroadphaseProxy::DefaultFilter,
            btBroadphaseProxy::AllFilter};
}

}  // namespace hashphase::test
