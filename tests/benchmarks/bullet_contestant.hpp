// SPDX-License-Identifier: Zlib
#pragma once

// The broadphases of `hashphase compare` as contestants: ours in Bullet, pair cache included, and
// Bullet's own.

#include <tests/benchmarks/contestant.hpp>

namespace hashphase::benchmarks {

/// Ours first.
[[nodiscard]] std::vector<ContestantKind> bulletKinds();

}  // namespace hashphase::benchmarks
