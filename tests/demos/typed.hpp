// SPDX-License-Identifier: Zlib
#pragma once

// What comes of a command line.

#include <demos/console/program.hpp>

#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace hashphase::demos {

struct Typed {
    int exitCode = 0;
    std::string out;
    std::string err;
};

inline Typed typed(const std::vector<std::string>& arguments,
                   std::span<const Subcommand> subcommands, bool isOnTerminal = false) {
    std::ostringstream out;
    std::ostringstream err;
    const int exitCode =
        runProgram(arguments, subcommands, {out, err, isOnTerminal, "hashphase test"});
    return {exitCode, out.str(), err.str()};
}

/// The same of `command`, whose name stands in front of the arguments.
inline Typed typed(const Subcommand& command, std::vector<std::string> arguments,
                   bool isOnTerminal = false) {
    arguments.insert(arguments.begin(), command.name);
    return typed(arguments, std::span(&command, 1), isOnTerminal);
}

}  // namespace hashphase::demos
