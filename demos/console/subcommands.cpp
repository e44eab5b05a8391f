// SPDX-License-Identifier: Zlib
#include <demos/console/program.hpp>

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
        "Run a scene with our broadphase and Bullet's; verify the pairs; compare the times"},
    Description{"paper", "Reproduce the paper's figures 13 to 15: its numbers beside today's"},
    Description{"accuracy",
                "Measure what accuracy costs in time: every choice, its error and its ms"},
    Description{"stability",
                "Run hard cases with our broadphase and Bullet's; say what each one does"},
    Description{"effects", "Say what each effect of a scene costs, and what is lost without it"},
    Description{"report",
                "Join in one page what these find: compare, paper, accuracy, effects, "
                "stability"},
    Description{"try",
                "Run a program of yours, as it is, with Bullet's broadphase and with ours, "
                "and compare"},
    Description{"swarm",
                "Spread a million wandering spheres over the processes of an MPI program; "
                "verify the pairs"},
    Description{"wander", "Watch the paper's simulation, and play with it"},
};

// As CLI11 writes those of the subcommands.
void writeHelp(std::ostream& out) {
    const auto line = [&out](std::string_view name, std::string_view description) {
        constexpr std::size_t width = 28;
        out << "  " << name << std::string(width - std::min(name.size(), width), ' ') << description
            << '\n';
    };
    out << "hashphase: a spatial-hash broadphase for Bullet, shown at work\n"
           "Usage: hashphase [OPTIONS] [SUBCOMMAND]\n\nOptions:\n";
    line("-h,--help", "Print this help message and exit");
    line("--version", "Display program version information and exit");
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
        writeHelp(console.err);
        return kExitUsage;
    }
    const std::string& first = arguments.front();
    if (first == "help" || first == "-h" || first == "--help") {
        const std::string of = arguments.size() > 1 ? arguments[1] : first;
        if (of != "help" && of != "version" && !of.starts_with('-')) {
            return startSubcommand({of, "--help"}, console, start);
        }
        writeHelp(console.out);
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
