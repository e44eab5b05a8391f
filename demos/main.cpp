// SPDX-License-Identifier: Zlib

// hashphase: what the spatial hash does, shown and measured. Each subcommand is a folder here.

#include <demos/accuracy/accuracy_command.hpp>
#include <demos/allocation_count.hpp>
#include <demos/compare/compare_command.hpp>
#include <demos/console/program.hpp>
#include <demos/effects/effects_command.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/report_command.hpp>
#include <demos/stability/stability_command.hpp>
#include <demos/try/try_command.hpp>
#include <demos/viewer/viewer_program.hpp>

#include <array>
#include <iostream>
#include <string>
#include <vector>

#include <unistd.h>

int main(int argc, char** argv) {
    using namespace hashphase::demos;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    Console console{std::cout, std::cerr, isatty(STDERR_FILENO) != 0, "hashphase"};
    for (const std::string& argument : arguments) {
        console.commandLine += " " + argument;
    }
#if HASHPHASE_COUNTS_ALLOCATIONS
    const auto countAllocations = allocationCount;
#else
    constexpr std::size_t (*countAllocations)() = nullptr;
#endif
    if (!arguments.empty() && arguments.front() == kViewerCommand) {
        return runViewerProgram(arguments, console);
    }
    const Subcommand report = reportCommand(
        {{compareCommand(), {"--objects", "10000", "--frames", "60"}, 5, 60},
         {paperCommand(), {"--quick"}, 20, 90},
         {accuracyCommand(), {"--quick"}, 40, 660},
         {effectsCommand(countAllocations), {"--objects", "2000", "--frames", "60"}, 2, 40},
         {stabilityCommand(), {"--quick"}, 20, 70}});
    const std::array subcommands{compareCommand(),
                                 paperCommand(),
                                 accuracyCommand(),
                                 stabilityCommand(),
                                 effectsCommand(countAllocations),
                                 report,
                                 tryCommand(),
                                 viewerCommand()};
    return runProgram(arguments, subcommands, console);
}
