// SPDX-License-Identifier: Zlib
#include <demos/console/subcommands.hpp>

#include <demos/console/nearest_name.hpp>

#include <algorithm>
#include <array>
#include <ostream>
#include <stdexcept>

namespace hashphase::demos {
namespace {

constexpr std::array kSubcommands{
    SubcommandName{
        "compare",
        "Run a scene with our broadphase and Bullet's; verify the pairs; compare the times"},
    SubcommandName{"paper", "Reproduce the paper's figures 13 to 15: its numbers beside today's"},
    SubcommandName{"accuracy",
                   "Measure what accuracy costs in time: every choice, its error and its ms"},
    SubcommandName{"stability",
                   "Run hard cases with our broadphase and Bullet's; say what each one does"},
    SubcommandName{"effects", "Say what each effect of a scene costs, and what is lost without it"},
    SubcommandName{"report",
                   "Join in one page what these find: compare, paper, accuracy, effects, "
                   "stability"},
    SubcommandName{"try",
                   "Run a program of yours, as it is, with Bullet's broadphase and with ours, "
                   "and compare"},
    SubcommandName{"wander", "Watch the paper's simulation, and play with it"},
};

// As CLI11 writes those of the subcommands.
void writeHelp(std::span<const SubcommandName> subcommands, std::ostream& out) {
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
    for (const auto& [name, description] : subcommands) {
        line(name, description);
    }
}

}  // namespace

int refuse(Console& console, const std::string& sentence) {
    console.err << "hashphase: " << sentence << '\n';
    return kExitUsage;
}

const char* programVersion() noexcept {
#ifdef HASHPHASE_VERSION
    return HASHPHASE_VERSION;
#else
    return "(version unknown)";
#endif
}

std::span<const SubcommandName> subcommandNames() {
    return kSubcommands;
}

std::string descriptionOf(std::string_view name) {
    for (const SubcommandName& each : kSubcommands) {
        if (each.name == name) {
            return std::string(each.description);
        }
    }
    throw std::logic_error("There is no subcommand '" + std::string(name) + "'.");
}

int startSubcommand(const std::vector<std::string>& arguments,
                    std::span<const SubcommandName> subcommands, Console& console,
                    const std::function<int(std::size_t, std::vector<std::string>)>& start) {
    if (arguments.empty()) {
        writeHelp(subcommands, console.err);
        return kExitUsage;
    }
    const std::string& first = arguments.front();
    if (first == "-h" || first == "--help") {
        writeHelp(subcommands, console.out);
        return kExitOk;
    }
    if (first == "--version") {
        console.out << "hashphase " << programVersion() << '\n';
        return kExitOk;
    }
    if (first.starts_with('-')) {
        const std::vector<std::string> options{"--help", "--version"};
        return refuse(console, unknownNameSentence("option", first, options));
    }
    std::vector<std::string> names;
    for (const SubcommandName& each : subcommands) {
        names.emplace_back(each.name);
    }
    const auto found = std::find(names.begin(), names.end(), first);
    if (found == names.end()) {
        return refuse(console, unknownNameSentence("subcommand", first, names));
    }
    return start(static_cast<std::size_t>(found - names.begin()),
                 {arguments.begin() + 1, arguments.end()});
}

}  // namespace hashphase::demos
