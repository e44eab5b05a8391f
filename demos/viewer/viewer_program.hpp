// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase wander` is a program of its own beside this one, hashphase-wander, so that nothing else links
// graphics.

#include <demos/console/program.hpp>

#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

inline constexpr std::string_view kViewerCommand = "wander";

/// For the list of subcommands.
[[nodiscard]] Subcommand viewerCommand();

/// Becomes the viewer's program, with the arguments after the first. Returns only where it is not there:
/// kExitUsage, and says what to do.
int runViewerProgram(std::span<const std::string> arguments, Console& console);

}  // namespace hashphase::demos
