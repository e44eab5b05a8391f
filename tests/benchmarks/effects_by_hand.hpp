// SPDX-License-Identifier: Zlib
#pragma once

// The frames of scenes as one writes them for just that scene: what a build without
// hashphase::effects would run.

#include <tests/benchmarks/effects_workload.hpp>

#include <memory>

namespace hashphase::benchmarks {

/// For a scene of EffectsWorkload.
[[nodiscard]] std::unique_ptr<EffectsContestant> makeByHand(EffectSet own,
                                                            const RoamingSpheres& spheres);

}  // namespace hashphase::benchmarks
