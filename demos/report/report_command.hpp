// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase report`: other subcommands run one after the other, their pages joined in one.

#include <demos/console/program.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

/// A subcommand that hands its page to Console::takePage, and takes --seed, --time-limit and --quiet.
struct ReportPart {
    Subcommand command;
    std::vector<std::string> quickOptions;  // of its own, that make it quick
    double quickSeconds = 1;                // about how long it takes, to share a time limit fairly
    double fullSeconds = 1;
};

/// The subcommand `report` of these parts.
[[nodiscard]] Subcommand reportCommand(std::vector<ReportPart> parts);

}  // namespace hashphase::demos
