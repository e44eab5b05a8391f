// SPDX-License-Identifier: Zlib
#pragma once

// hashphase::Grid and hashphase::Pairs without Bullet: what a frame costs before any pair cache.

#include <broadphase/grid_config.hpp>
#include <tests/benchmarks/contestant.hpp>

namespace hashphase::benchmarks {

/// Its frame ends with the sorted births and deaths. The list that they add up to, which is what is
/// checked, is kept outside of the timing.
[[nodiscard]] ContestantKind gridKind(std::string name, const GridConfig& config);

}  // namespace hashphase::benchmarks
