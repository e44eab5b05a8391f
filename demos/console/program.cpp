// SPDX-License-Identifier: Zlib
#include <demos/console/program.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/process.hpp>

#include <broadphase/core/compiler.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

namespace hashphase::demos {
namespace {

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

std::string unknownWordSentence(const CLI::App& app, const Subcommand& command,
                                const std::string& word) {
    if (word.starts_with('-')) {
        return unknownNameSentence("option", word.substr(0, word.find('=')), optionNames(app));
    }
    return command.takesRest
               ? "'" + word + "' belongs behind --: " + command.name + " [options] -- " + word
               : "'" + command.name + "' takes no argument '" + word + "'; see " + command.name +
                     " --help.";
}

// Takes what follows the first `--` off the arguments.
std::vector<std::string> takeRest(std::vector<std::string>& arguments) {
    const auto dashes = std::find(arguments.begin(), arguments.end(), "--");
    if (dashes == arguments.end()) {
        return {};
    }
    std::vector<std::string> rest;
    std::move(dashes + 1, arguments.end(), std::back_inserter(rest));
    arguments.erase(dashes, arguments.end());
    return rest;
}

void warnOfSlowBuild(Console& console) {
    if (!HASHPHASE_IS_OPTIMISED) {
        console.err << "hashphase: warning: built without optimisation; the times mean nothing.\n";
    }
}

// Instead of how many values CLI11 wants.
std::string countSentence(const CLI::ArgumentMismatch& error) {
    const std::string sentence = error.what();
    const std::size_t end = std::min(sentence.find(": "), sentence.size());
    return sentence.substr(0, end) + (sentence.find("At Most") == std::string::npos
                                          ? ": its value is missing"
                                          : ": it is given more than once");
}

// Descriptions of options continue below each other.
void printHelp(const CLI::App& app, const Console& console) {
    std::istringstream lines(app.help());
    for (std::string line; std::getline(lines, line);) {
        console.out << wrapped(line, lineWidth(console), line.starts_with("  ") ? kHelpIndent : 0)
                    << '\n';
    }
}

// The exit code where parsing ends the program.
std::optional<int> parse(CLI::App& app, const std::vector<std::string>& arguments,
                         Console& console) {
    try {
        // CLI11 takes the arguments from the back.
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        printHelp(app, console);
        return kExitOk;
    } catch (const CLI::CallForVersion& version) {
        console.out << version.what() << '\n';
        return kExitOk;
    } catch (const CLI::ArgumentMismatch& error) {
        return refuse(console, countSentence(error));
    } catch (const CLI::ParseError& error) {
        return refuse(console, error.what());
    }
    return std::nullopt;
}

int runGuarded(const Subcommand& command, Console& console) {
    try {
        return command.run(console);
    } catch (const InputError& error) {
        return refuse(console, error.what());
    } catch (const std::bad_alloc&) {
        return refuse(console, "there is not enough memory for this scene; ask for fewer objects.");
    } catch (const Interrupted&) {
        return kExitCheckFailed;  // before there was anything to show
    }
}

int runUnlessInterrupted(const Subcommand& command, Console& console) {
    const NotedSignals signals(command.nextSignal);
    const int exitCode = finish(console, runGuarded(command, console));
    if (!isInterrupted()) {
        return exitCode;
    }
    console.err << "hashphase: the run was interrupted.\n";
    constexpr int kExitInterrupted = 128;  // and the signal, as shells have it
    return kExitInterrupted + notedSignal();
}

std::string versionText() {
    return std::string("hashphase ") + programVersion();
}

}  // namespace

int runSingleCommand(std::vector<std::string> arguments, const Subcommand& command,
                     Console console) {
    CLI::App app(command.description, command.name);
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.set_version_flag("--version", versionText(), "Print the version and exit");
    // Unknown words are collected rather than refused, so that the right one can be suggested.
    app.allow_extras();
    command.declareOptions(app);
    checkValues(app);
    if (command.takesRest) {
        console.rest = takeRest(arguments);
    }
    if (const std::optional<int> ended = parse(app, arguments, console)) {
        return finish(console, *ended);
    }
    if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) {
        return refuse(console, unknownWordSentence(app, command, extras.front()));
    }
    if (const std::string fault = pathClash(app); !fault.empty()) {
        return refuse(console, fault);
    }
    warnOfSlowBuild(console);
    return runUnlessInterrupted(command, console);
}

int runMain(int argc, char** argv, Subcommand command) {
    command.name = "hashphase " + command.name;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    Console console{std::cout, std::cerr, errIsTerminal(), command.name};
    console.columns = outColumns();
    for (const std::string& argument : arguments) {
        console.commandLine += " " + argument;
    }
    return runSingleCommand(arguments, command, std::move(console));
}

int runProgram(const std::vector<std::string>& arguments, std::span<const Subcommand> subcommands,
               Console console) {
    return startSubcommand(
        arguments, console, [&](const std::string& name, std::vector<std::string> rest) {
            Subcommand command = *std::ranges::find(subcommands, name, &Subcommand::name);
            command.name = "hashphase " + name;
            return runSingleCommand(std::move(rest), command, console);
        });
}

}  // namespace hashphase::demos
