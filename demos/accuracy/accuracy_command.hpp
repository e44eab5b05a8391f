// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase accuracy`: runs experiments, writes what they found, and says what to choose.

#include <demos/accuracy/experiment.hpp>
#include <demos/console/program.hpp>

namespace hashphase::demos {

/// The subcommand, over the given experiments. Fails where a check does not hold, with
/// kExitCheckFailed, and for unknown ids and files that cannot be written.
[[nodiscard]] Subcommand accuracyCommand(std::span<const Experiment> known = experiments());

}  // namespace hashphase::demos
