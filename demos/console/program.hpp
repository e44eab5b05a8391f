// SPDX-License-Identifier: Zlib
#pragma once

// The command line of a program made of subcommands, or of a single command.
//
// Exit codes  0 all well, 1 a check failed, 2 wrong usage or bad input.
// Output      results go to `out`; progress, warnings and errors to `err`.

#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hashphase::demos {

struct Page;

inline constexpr int kExitOk = 0;
inline constexpr int kExitCheckFailed = 1;
inline constexpr int kExitUsage = 2;

/// Where a subcommand writes.
struct Console {
    std::ostream& out;
    std::ostream& err;
    bool errIsTerminal = false;
    std::string commandLine;  // as typed, for the record

    /// Takes the page of a report, whether or not it goes to a file; empty: nobody does.
    std::function<void(const Page&)> takePage = {};
};

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

/// Parses the arguments (without the program's name), runs the subcommand and returns its exit
/// code. Unknown words are told together with what was probably meant.
int runProgram(std::vector<std::string> arguments, std::span<const Subcommand> subcommands,
               Console console);

/// The same for a program without subcommands: `command.name` is what the user types to run it.
int runSingleCommand(const std::vector<std::string>& arguments, const Subcommand& command,
                     Console console);

/// The version of hashphase that this program was built from.
[[nodiscard]] const char* programVersion() noexcept;

}  // namespace hashphase::demos
