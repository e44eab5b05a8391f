// SPDX-License-Identifier: Zlib
#include <demos/console/program.hpp>

#include <demos/console/nearest_name.hpp>
#include <demos/console/options.hpp>
#include <demos/scenes/input_error.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <iterator>
#include <optional>
#include <ostream>
#include <utility>

namespace hashphase::demos {
namespace {

int refuse(Console& console, const std::string& sentence) {
    console.err << "hashphase: " << sentence << '\n';
    return kExitUsage;
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            names.push_back("--" + name);
        }
    }
    return names;
}

// `call` is what the user types to run the command, `takesRest` whether words follow after `--`.
std::string unknownWordSentence(const CLI::App& command, const std::string& call,
                                const std::string& word, bool takesRest) {
    if (!word.starts_with('-')) {
        if (takesRest) {
            return "'" + word + "' belongs behind --: " + call + " [options] -- " + word;
        }
        return "'" + command.get_name() + "' takes no argument '" + word + "'; see " + call +
               " --help.";
    }
    const std::string name = word.substr(0, word.find('='));
    return unknownNameSentence("option", name, optionNames(command));
}

// Takes what follows the first `--` off the arguments of a subcommand that wants it, as it is.
std::vector<std::string> takeRest(std::vector<std::string>& arguments,
                                  std::span<const Subcommand> subcommands) {
    const bool isWanted =
        !arguments.empty() && std::any_of(subcommands.begin(), subcommands.end(),
                                          [&arguments](const Subcommand& subcommand) {
                                              return subcommand.name == arguments.front() &&
                                                     subcommand.takeRest;
                                          });
    const auto dashes = std::find(arguments.begin(), arguments.end(), "--");
    if (!isWanted || dashes == arguments.end()) {
        return {};
    }
    std::vector<std::string> rest;
    std::move(dashes + 1, arguments.end(), std::back_inserter(rest));
    arguments.erase(dashes, arguments.end());
    return rest;
}

void warnOfSlowBuild(Console& console) {
#ifndef __OPTIMIZE__
    console.err << "hashphase: warning: built without optimisation; the times mean nothing.\n";
#else
    static_cast<void>(console);
#endif
}

// Instead of how many values CLI11 wants.
std::string countSentence(const CLI::ArgumentMismatch& error) {
    const std::string sentence = error.what();
    const std::size_t end = std::min(sentence.find(": "), sentence.size());
    return sentence.substr(0, end) + (sentence.find("At Most") == std::string::npos
                                          ? ": its value is missing"
                                          : ": it is given more than once");
}

// The exit code where parsing ends the program.
std::optional<int> parse(CLI::App& app, const std::vector<std::string>& arguments,
                         Console& console) {
    try {
        // CLI11 takes the arguments from the back.
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        console.out << app.help();
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

int runGuarded(const Subcommand& command, const CLI::App& parsed, Console& console) {
    if (const std::string fault = pathClash(parsed); !fault.empty()) {
        return refuse(console, fault);
    }
    warnOfSlowBuild(console);
    try {
        return command.run(console);
    } catch (const InputError& error) {
        return refuse(console, error.what());
    } catch (const std::bad_alloc&) {
        return refuse(console, "there is not enough memory for so large a scene.");
    }
}

std::string versionText() {
    return std::string("hashphase ") + programVersion();
}

}  // namespace

int runProgram(std::vector<std::string> arguments, std::span<const Subcommand> subcommands,
               Console console) {
    std::vector<std::string> rest = takeRest(arguments, subcommands);
    CLI::App app("hashphase: a spatial-hash broadphase for Bullet, shown at work", "hashphase");
    app.set_version_flag("--version", versionText());
    // Unknown words are collected rather than refused, so that the right one can be suggested.
    app.allow_extras();
    std::vector<std::string> names;
    for (const Subcommand& subcommand : subcommands) {
        CLI::App* parsed = app.add_subcommand(subcommand.name, subcommand.description);
        parsed->allow_extras();
        subcommand.declareOptions(*parsed);
        checkValues(*parsed);
        names.push_back(subcommand.name);
    }

    if (const std::optional<int> ended = parse(app, arguments, console)) {
        return *ended;
    }
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) {
        return refuse(console, extras.front().starts_with('-')
                                   ? unknownNameSentence("option", extras.front(), optionNames(app))
                                   : unknownNameSentence("subcommand", extras.front(), names));
    }
    if (chosen.size() != 1) {
        console.err << app.help();
        return kExitUsage;
    }
    const auto subcommand = std::find_if(
        subcommands.begin(), subcommands.end(),
        [&chosen](const Subcommand& known) { return known.name == chosen.front()->get_name(); });
    if (const std::vector<std::string> extras = chosen.front()->remaining(); !extras.empty()) {
        return refuse(
            console, unknownWordSentence(*chosen.front(), "hashphase " + chosen.front()->get_name(),
                                         extras.front(), subcommand->takeRest != nullptr));
    }
    if (subcommand->takeRest) {
        subcommand->takeRest(std::move(rest));
    }
    return runGuarded(*subcommand, *chosen.front(), console);
}

int runSingleCommand(const std::vector<std::string>& arguments, const Subcommand& command,
                     Console console) {
    CLI::App app(command.description, command.name);
    app.set_version_flag("--version", versionText());
    app.allow_extras();
    command.declareOptions(app);
    checkValues(app);
    if (const std::optional<int> ended = parse(app, arguments, console)) {
        return *ended;
    }
    if (const std::vector<std::string> extras = app.remaining(); !extras.empty()) {
        return refuse(console, unknownWordSentence(app, command.name, extras.front(), false));
    }
    return runGuarded(command, app, console);
}

const char* programVersion() noexcept {
#ifdef HASHPHASE_VERSION
    return HASHPHASE_VERSION;
#else
    return "(version unknown)";
#endif
}

}  // namespace hashphase::demos
