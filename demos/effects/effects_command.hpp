// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

#include <cstddef>

namespace hashphase::demos {

/// `hashphase effects`. `allocationCount` says how often the program has allocated; null where nobody
/// counts.
[[nodiscard]] Subcommand effectsCommand(std::size_t (*allocationCount)() = nullptr);

}  // namespace hashphase::demos
