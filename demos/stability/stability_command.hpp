// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/compare/broadphase_kind.hpp>
#include <demos/console/program.hpp>
#include <demos/stability/hard_case.hpp>

#include <span>

namespace hashphase::demos {

/// The subcommand `stability`, over the given broadphases and cases.
[[nodiscard]] Subcommand stabilityCommand(std::span<const BroadphaseKind> kinds = broadphaseKinds(),
                                          std::span<const HardCase> cases = hardCases());

}  // namespace hashphase::demos
