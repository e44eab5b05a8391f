// SPDX-License-Identifier: Zlib

// hashphase-benchmarks: what tests/benchmarks/run builds and starts.

#include <demos/system/process.hpp>
#include <tests/benchmarks/benchmark_command.hpp>

#include <iostream>
#include <string>
#include <vector>

int main(int argc, char** argv) {
    using namespace hashphase;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    demos::Console console{std::cout, std::cerr, demos::errIsTerminal(), "tests/benchmarks/run"};
    console.columns = demos::outColumns();
    for (const std::string& argument : arguments) {
        console.commandLine += " " + argument;
    }
    return demos::runSingleCommand(arguments, benchmarks::benchmarkCommand(), console);
}
