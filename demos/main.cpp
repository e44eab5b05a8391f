// SPDX-License-Identifier: Zlib

// hashphase: what the spatial hash does, shown and measured. Each subcommand is a folder here, and a program
// of its own beside this one.

#include <demos/console/program.hpp>
#include <demos/system/process.hpp>

#include <filesystem>
#include <iostream>
#include <system_error>
#include <utility>

namespace {

using namespace hashphase::demos;

/// What building a program needs, as the end of a sentence.
std::string needs(const std::string& name) {
    if (name == "hashphase-wander") {
        return ", which needs libepoxy-dev, libstb-dev, libimgui-dev and libglfw3-dev (Debian, "
               "Ubuntu).";
    }
    if (name == "hashphase-swarm") {
        return ", which needs an MPI (Debian, Ubuntu: libopenmpi-dev).";
    }
    return ".";
}

/// Runs the program in place of this one.
int become(const std::string& name, std::vector<std::string> arguments, Console& console) {
    const std::filesystem::path path = programBeside(name);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        return refuse(console, path.string() +
                                   " is missing. Build it with demos/run in the source tree" +
                                   needs(name));
    }
    try {
        return runInstead(path, std::move(arguments));
    } catch (const std::system_error& failure) {
        return refuse(console, path.string() + " cannot be run: " + failure.code().message() + ".");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Console console{std::cout, std::cerr, errIsTerminal(), "hashphase"};
    console.columns = outColumns();
    return startSubcommand({argv + 1, argv + argc}, console,
                           [&console](const std::string& name, std::vector<std::string> rest) {
                               return become("hashphase-" + name, std::move(rest), console);
                           });
}
