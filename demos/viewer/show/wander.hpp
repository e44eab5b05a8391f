// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

namespace hashphase::demos {

/// `hashphase wander`: the paper's simulation to watch and play with, in a window or to pictures. Exits with
/// kExitCheckFailed when an expectation of a script does not hold, or a recording comes out otherwise. Throws
/// InputError for bad options, files and commands, and where no picture can be drawn or written: what was
/// played until then has been written.
[[nodiscard]] Subcommand wanderCommand();

}  // namespace hashphase::demos
