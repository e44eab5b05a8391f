// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/accuracy/accuracy.hpp>
#include <demos/console/program.hpp>

namespace hashphase::demos {

/// The subcommand `accuracy`, over the given experiments.
[[nodiscard]] Subcommand accuracyCommand(std::span<const Experiment> known = experiments());

}  // namespace hashphase::demos
