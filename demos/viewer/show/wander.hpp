// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>
#include <demos/viewer/session/session.hpp>

#include <iosfwd>
#include <optional>

namespace hashphase::demos {

/// `hashphase wander`: the paper's simulation to watch and play with, in a window or to pictures. Exits with
/// kExitCheckFailed when an expectation of a script does not hold, or a recording comes out otherwise. Throws
/// InputError for bad options, files and commands, and where no picture can be drawn or written: what was
/// played until then has been written.
[[nodiscard]] Subcommand wanderCommand();

/// Lists scenes, keys, commands and readings.
void listWander(std::ostream& out);

/// Of a session at its end: the phases of a frame, as a table, and how many bodies there are.
void tellPhases(const Session& session, bool drewPictures, std::ostream& out);

/// All numbers, as JSON; null for those that there are not, such as how many frames a window has shown a second.
void writeNumbers(const Session& session, std::optional<double> framesPerSecond, std::ostream& out);

}  // namespace hashphase::demos
