// SPDX-License-Identifier: Zlib
#include <demos/console/program.hpp>

#include <demos/console/nearest_name.hpp>
#include <demos/scenes/input_error.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <optional>
#include <ostream>

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

// `call` is what the user types to run the command.
std::string unknownWordSentence(const CLI::App& command, const std::string& call,
                                const std::string& word) {
    if (word.front() != '-') {
        return "'" + command.get_name() + "' takes no argument '" + word + "'; see " + call +
               " --help.";
    }
    const std::string name = word.substr(0, word.find('='));
    return unknownNameSentence("option", name, optionNames(command));
}

// The words that the command does not know: those that look like options, and the rest.
struct Extras {
    std::vector<std::string> refused;
    std::vector<std::string> rest;
};

Extras extrasOf(const CLI::App& app, bool takesRest) {
    const std::vector<std::string> words = app.remaining();
    Extras extras;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--") {
            extras.rest.insert(extras.rest.end(),
                               words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
            break;
        }
        const bool isOption = words[i].starts_with("-") && words[i] != "-";
        (isOption ? extras.refused : extras.rest).push_back(words[i]);
    }
    if (!takesRest) {
        extras.refused.insert(extras.refused.end(), extras.rest.begin(), extras.rest.end());
    }
    return extras;
}

void warnOfSlowBuild(Console& console) {
#ifndef __OPTIMIZE__
    console.err << "hashphase: warning: built without optimisation; the times mean nothing.\n";
#else
    static_cast<void>(console);
#endif
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
    } catch (const CLI::ParseError& error) {
        return refuse(console, error.what());
    }
    return std::nullopt;
}

int runGuarded(const Subcommand& command, Console& console) {
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

int runProgram(const std::vector<std::string>& arguments, std::span<const Subcommand> subcommands,
               Console console) {
    CLI::App app("hashphase: a spatial-hash broadphase for Bullet, shown at work", "hashphase");
    app.set_version_flag("--version", versionText());
    // Unknown words are collected rather than refused, so that the right one can be suggested.
    app.allow_extras();
    std::vector<std::string> names;
    for (const Subcommand& subcommand : subcommands) {
        CLI::App* parsed = app.add_subcommand(subcommand.name, subcommand.description);
        parsed->allow_extras();
        subcommand.declareOptions(*parsed);
        names.push_back(subcommand.name);
    }

    if (const std::optional<int> ended = parse(app, arguments, console)) {
        return *ended;
    }
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    if (const std::vector<std::string> extras = extrasOf(app, false).refused; !extras.empty()) {
        return refuse(console, extras.front().front() == '-'
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
    const Extras extras = extrasOf(*chosen.front(), static_cast<bool>(subcommand->takeRest));
    if (!extras.refused.empty()) {
        return refuse(
            console, unknownWordSentence(*chosen.front(), "hashphase " + chosen.front()->get_name(),
                                         extras.refused.front()));
    }
    if (subcommand->takeRest) {
        subcommand->takeRest(extras.rest);
    }
    return runGuarded(*subcommand, console);
}

int runSingleCommand(const std::vector<std::string>& arguments, const Subcommand& command,
                     Console console) {
    CLI::App app(command.description, command.name);
    app.set_version_flag("--version", versionText());
    app.allow_extras();
    command.declareOptions(app);
    if (const std::optional<int> ended = parse(app, arguments, console)) {
        return *ended;
    }
    if (const Extras extras = extrasOf(app, false); !extras.refused.empty()) {
        return refuse(console, unknownWordSentence(app, command.name, extras.refused.front()));
    }
    return runGuarded(command, console);
}

const char* programVersion() noexcept {
#ifdef HASHPHASE_VERSION
    return HASHPHASE_VERSION;
#else
    return "(version unknown)";
#endif
}

}  // namespace hashphase::demos
