// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase stability`: runs hard cases with our broadphase and Bullet's, each in a process of its own,
// and says what each one does.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/console/program.hpp>
#include <demos/stability/hard_case.hpp>

#include <span>
#include <string>

namespace hashphase::demos {

/// The subcommand `stability`, over the given broadphases and cases. Its exit code is kExitCheckFailed when ours
/// is not as required in one.
[[nodiscard]] Subcommand stabilityCommand(std::span<const BroadphaseKind> kinds = broadphaseKinds(),
                                          std::span<const HardCase> cases = hardCases());

/// In a word or two: "exact", "-3 +12", "costly 12x", "> 2 s", "crashes"; "-" for nothing.
[[nodiscard]] std::string outcomeText(const CaseOutcome& outcome);

}  // namespace hashphase::demos
