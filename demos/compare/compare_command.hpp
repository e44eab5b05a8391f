// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/compare/broadphase_kind.hpp>
#include <demos/console/program.hpp>

#include <span>

namespace hashphase::demos {

/// `hashphase compare` over the given broadphases, which must outlive it: a scene run with all of them, the
/// pair sets verified in every frame, the times side by side. Fails with kExitCheckFailed when a broadphase
/// of ours missed or invented a pair, or the time limit left no frame of it to verify. Throws InputError for
/// unknown names, broken files, and files that cannot be written.
[[nodiscard]] Subcommand compareCommand(std::span<const BroadphaseKind> kinds = broadphaseKinds());

}  // namespace hashphase::demos
