// SPDX-License-Identifier: Zlib
#include <demos/console/program.hpp>

#include <demos/console/columns.hpp>
#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <ostream>
#include <stdexcept>

namespace hashphase::demos {
namespace {

struct Description {
    std::string_view name;
    std::string_view text;
};

constexpr std::array kSubcommands{
    Description{
        "compare",
        "Run a scene with hashphase and with Bullet's broadphases: check the pairs, compare "
        "the times"},
    Description{"paper",
                "Measure figures 13 to 15 of the paper (Hastings, Mesit, Guha 2005) again, next to "
                "its printed numbers"},
    Description{
        "accuracy",
        "Measure how much time is saved by lower accuracy: the error and the time of each method"},
    Description{"stability",
                "Run hard cases with hashphase and with Bullet's broadphases, and report what each "
                "one does"},
    Description{"effects",
                "Measure what each effect of a scene (culling, picking, terrain ...) costs, and "
                "what the scene loses without it"},
    Description{"report",
                "Run compare, paper, accuracy, effects and stability, and join their results in a "
                "page"},
    Description{"try",
                "Run your own Bullet program unchanged, with Bullet's broadphase and with "
                "hashphase, and compare"},
    Description{"swarm",
                "Spread a million moving spheres over the processes of an MPI program, and check "
                "the pairs"},
    Description{"wander", "Watch the paper's simulation in a window, and play with it"},
};

void writeHelp(std::ostream& out, std::size_t columns) {
    const auto line = [&](std::string_view name, std::string_view description) {
        std::string text = "  " + std::string(name);
        text.resize(std::max(text.size() + 1, kHelpIndent), ' ');
        out << wrapped(text += description, columns, kHelpIndent) << '\n';
    };
    out << "hashphase shows and measures a spatial-hash broadphase for the Bullet physics engine.\n"
           "Usage: hashphase [OPTIONS] [SUBCOMMAND]\n\nOptions:\n";
    line("-h,--help", "Print this help and exit");
    line("--version", "Print the version and exit");
    out << "\nSubcommands:\n";
    for (const auto& [name, description] : kSubcommands) {
        line(name, description);
    }
    line("help [SUBCOMMAND]", "Print this help, or the options of a subcommand");
    line("version", "Print the version");
}

}  // namespace

int refuse(Console& console, const std::string& sentence) {
    console.err << "hashphase: " << masked(sentence) << '\n';
    return kExitUsage;
}

int finish(Console& console, int exitCode) {
    console.out.flush();
    if (console.out || exitCode == kExitUsage) {
        return exitCode;
    }
    return refuse(
        console,
        "the standard output cannot be written to its end, so results are lost; is the disk "
        "full?");
}

const char* programVersion() noexcept {
#ifdef HASHPHASE_VERSION
    return HASHPHASE_VERSION;
#else
    return "(version unknown)";
#endif
}

std::string descriptionOf(std::string_view name) {
    const auto* found = std::ranges::find(kSubcommands, name, &Description::name);
    if (found == kSubcommands.end()) {
        throw std::logic_error("There is no subcommand '" + std::string(name) + "'.");
    }
    return std::string(found->text);
}

int startSubcommand(const std::vector<std::string>& arguments, Console& console,
                    const std::function<int(const std::string&, std::vector<std::string>)>& start) {
    if (arguments.empty()) {
        writeHelp(console.err, lineWidth(console));
        return kExitUsage;
    }
    const std::string& first = arguments.front();
    if (first == "help" || first == "-h" || first == "--help") {
        const std::string of = arguments.size() > 1 ? arguments[1] : first;
        if (of != "help" && of != "version" && !of.starts_with('-')) {
            return startSubcommand({of, "--help"}, console, start);
        }
        writeHelp(console.out, lineWidth(console));
        return finish(console, kExitOk);
    }
    if (first == "version" || first == "--version") {
        console.out << "hashphase " << programVersion() << '\n';
        return finish(console, kExitOk);
    }
    if (first.starts_with('-')) {
        return refuse(
            console,
            unknownNameSentence("option", first, std::vector<std::string>{"--help", "--version"}));
    }
    std::vector<std::string> names;
    for (const Description& each : kSubcommands) {
        names.emplace_back(each.name);
    }
    names.insert(names.end(), {"help", "version"});
    if (std::ranges::find(kSubcommands, first, &Description::name) == kSubcommands.end()) {
        return refuse(console, unknownNameSentence("subcommand", first, names));
    }
    return start(first, {arguments.begin() + 1, arguments.end()});
}

}  // namespace hashphase::demos
