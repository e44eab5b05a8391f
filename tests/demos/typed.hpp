// SPDX-License-Identifier: Zlib
#pragma once

// What comes of a command line.

#include <demos/console/program.hpp>

#include <gtest/gtest.h>

#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct Typed {
    int exitCode = 0;
    std::string out;
    std::string err;
};

inline Typed typed(const std::vector<std::string>& arguments,
                   std::span<const Subcommand> subcommands, bool isTerminal = false) {
    std::ostringstream out;
    std::ostringstream err;
    const int exitCode =
        runProgram(arguments, subcommands, {out, err, isTerminal, "hashphase test"});
    return {exitCode, out.str(), err.str()};
}

/// The same of `command`, whose name stands in front of the arguments.
inline Typed typed(const Subcommand& command, std::vector<std::string> arguments,
                   bool isTerminal = false) {
    arguments.insert(arguments.begin(), command.name);
    return typed(arguments, std::span(&command, 1), isTerminal);
}

/// Whether the text has the part; shows both.
inline testing::AssertionResult holds(const std::string& text, std::string_view part) {
    const bool isThere = text.find(part) != std::string::npos;
    return (isThere ? testing::AssertionSuccess() : testing::AssertionFailure())
           << "'" << part << "' in\n"
           << text;
}

}  // namespace hashphase::demos
