// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

#include <cstddef>

namespace hashphase::demos {

/// `hashphase effects`: runs a scene with and without each effect, and writes what each costs, and what the
/// scene lacks without it. Its exit code is kExitCheckFailed when an undeclared effect did anything, or changed
/// a result. `allocationCount` says how often the program has allocated; null where nobody counts.
[[nodiscard]] Subcommand effectsCommand(std::size_t (*allocationCount)() = nullptr);

}  // namespace hashphase::demos
