// SPDX-License-Identifier: Zlib
#pragma once

// The command lines of `hashphase` and of its subcommands, each of which is a program of its own, as git's are:
// `hashphase compare` is hashphase-compare.
//
// Exit codes    0 all well, 1 a check failed, 2 wrong usage, bad input, or results that could not be written,
//               128 + n interrupted by signal n.
// Output        results go to `out`; progress, warnings and errors to `err`.
// Interruption  a signal such as Ctrl-C ends a command as its time limit does (interruption.hpp).

#include <demos/system/interruption.hpp>

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace hashphase::demos {

struct Page;

inline constexpr int kExitOk = 0;
inline constexpr int kExitCheckFailed = 1;
inline constexpr int kExitUsage = 2;

/// Where a command writes.
struct Console {
    std::ostream& out;
    std::ostream& err;
    bool errIsTerminal = false;
    std::string commandLine;  // as typed, for the record

    /// Takes the page of a report, whether or not it goes to a file; empty: nobody does.
    std::function<void(const Page&)> takePage = {};

    std::vector<std::string> rest = {};  // words behind `--`
    std::size_t columns = 0;             // of the terminal that shows `out`; 0: none does
};

/// Says what is wrong, and returns kExitUsage.
int refuse(Console& console, const std::string& sentence);

/// Flushes the results. Returns the exit code, or kExitUsage after a sentence if not all of them could be written.
int finish(Console& console, int exitCode);

/// The version of hashphase that this program was built from.
[[nodiscard]] const char* programVersion() noexcept;

// --- A subcommand --------------------------------------------------------------------------------

struct Subcommand {
    std::string name;
    std::string description;

    /// Declares the options, bound to storage that the subcommand owns.
    std::function<void(CLI::App&)> declareOptions;

    /// Runs with the options as parsed; returns the exit code. May throw InputError, and Interrupted.
    std::function<int(Console&)> run;

    bool takesRest = false;  // words that follow the first `--`, as Console::rest
    NotedSignals::Next nextSignal = NotedSignals::Next::endsProcess;  // what a second signal does
};

/// What `hashphase --help` says of the subcommand of that name, which there must be.
[[nodiscard]] std::string descriptionOf(std::string_view name);

/// The subcommand of that name, which declares its options and runs with them.
template <class Options, class Declare, class Run>
[[nodiscard]] Subcommand makeSubcommand(const std::string& name, Declare declare, Run run) {
    auto options = std::make_shared<Options>();
    return {name, descriptionOf(name), [=](CLI::App& app) { declare(app, *options); },
            [=](Console& console) { return run(*options, console); }};
}

/// Parses the arguments, runs the command and returns its exit code, or 128 + n after signal n; `command.name` is
/// what the user types to run it. Unknown words are told together with what was probably meant.
int runSingleCommand(std::vector<std::string> arguments, const Subcommand& command,
                     Console console);

/// The same for the program `hashphase-<name>` of a subcommand `hashphase <name>`, as its main() does.
int runMain(int argc, char** argv, Subcommand command);

// --- All of them ---------------------------------------------------------------------------------

/// Tells the help, the version and what is wrong, or starts the subcommand of a name with what follows that;
/// returns its exit code.
int startSubcommand(
    const std::vector<std::string>& arguments, Console& console,
    const std::function<int(const std::string& name, std::vector<std::string> rest)>& start);

/// The same where some are in one program.
int runProgram(const std::vector<std::string>& arguments, std::span<const Subcommand> subcommands,
               Console console);

}  // namespace hashphase::demos
