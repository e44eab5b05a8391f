// SPDX-License-Identifier: Zlib
#include <demos/swarm/swarm_command.hpp>
#include <demos/system/process.hpp>

#include <iostream>
#include <sstream>

int main(int argc, char** argv) {
    using namespace hashphase::demos;
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    if (rankByEnvironment() == 0) {
        return runMain(argc, argv, swarmCommand(arguments));
    }
    // Of many ranks one talks.
    std::ostringstream silence;
    Subcommand command = swarmCommand(arguments);
    command.name = "hashphase swarm";
    return runSingleCommand(arguments, command, {silence, silence, false, {}});
}
