// SPDX-License-Identifier: Zlib

// hashphase-benchmarks: what tests/benchmarks/run builds and starts.

#include <tests/benchmarks/benchmark_command.hpp>

#include <iostream>
#include <string>
#include <vector>

#include <unistd.h>

int main(int argc, char** argv) {
    using namespace hashphase;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    demos::Console console{std::cout, std::cerr, isatty(STDERR_FILENO) != 0,
                           "tests/benchmarks/run"};
    for (const std::string& argument : arguments) {
        console.commandLine += " " + argument;
    }
    return demos::runSingleCommand(arguments, benchmarks::benchmarkCommand(), console);
}
