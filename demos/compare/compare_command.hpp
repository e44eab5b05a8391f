// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/compare/broadphase_kind.hpp>
#include <demos/console/program.hpp>

#include <span>

namespace hashphase::demos {

/// The subcommand `compare` over the given broadphases, which must outlive it.
[[nodiscard]] Subcommand compareCommand(std::span<const BroadphaseKind> kinds = broadphaseKinds());

}  // namespace hashphase::demos
