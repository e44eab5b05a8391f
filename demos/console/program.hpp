// SPDX-License-Identifier: Zlib
#pragma once

// The command line of a command.

#include <demos/console/console.hpp>

#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hashphase::demos {

struct Subcommand {
    std::string name;
    std::string description;

    /// Declares the options, bound to storage that the subcommand owns.
    std::function<void(CLI::App&)> declareOptions;

    /// Takes the words that follow the first `--`, as they are; empty: there are none to take.
    std::function<void(std::vector<std::string>)> takeRest = {};

    /// Runs with the options as parsed; returns the exit code. May throw InputError.
    std::function<int(Console&)> run;
};

/// Parses the arguments, runs the command and returns its exit code; `command.name` is what the user types
/// to run it. Unknown words are told together with what was probably meant.
int runSingleCommand(std::vector<std::string> arguments, const Subcommand& command,
                     Console console);

/// The same for the program `hashphase-<name>` of a subcommand `hashphase <name>`, as its main() does.
int runMain(int argc, char** argv, Subcommand command);

/// The same for a program of several (subcommands.hpp), which are all in it.
int runProgram(const std::vector<std::string>& arguments, std::span<const Subcommand> subcommands,
               Console console);

}  // namespace hashphase::demos
