// SPDX-License-Identifier: Zlib
#pragma once

// The broadphases of `hashphase compare` as contestants: ours in Bullet, pair cache included, and
// Bullet's own.

#include <tests/benchmarks/contestant.hpp>

namespace hashphase::benchmarks {

/// `bullet` must outlive what this returns.
[[nodiscard]] ContestantKind bulletKind(const demos::BroadphaseKind& bullet);

/// Ours first, one by one and in batches.
[[nodiscard]] std::vector<ContestantKind> bulletKinds();

}  // namespace hashphase::benchmarks
