// SPDX-License-Identifier: Zlib

// hashphase: what the spatial hash does, shown and measured. Each subcommand is a folder here, and a program
// of its own beside this one.

#include <demos/console/program.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>

#include <unistd.h>

namespace {

using hashphase::demos::Console;

/// Becomes the program; returns only where that cannot be.
int become(const std::string& name, std::vector<std::string> arguments, Console& console) {
    std::error_code error;
    const std::filesystem::path path =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
    if (!std::filesystem::exists(path, error)) {
        return refuse(
            console,
            path.string() + " is not there. In the source tree demos/run builds it" +
                (name == "hashphase-wander" ? ", where libepoxy-dev, libstb-dev, libimgui-dev and "
                                              "libglfw3-dev (Debian, Ubuntu) are installed."
                                            : "."));
    }
    arguments.insert(arguments.begin(), path.string());
    std::vector<char*> pointers;
    for (std::string& argument : arguments) {
        pointers.push_back(argument.data());
    }
    pointers.push_back(nullptr);
    execv(path.c_str(), pointers.data());  // returns only where it fails
    const std::string reason = std::strerror(errno);
    return refuse(console, path.string() + " cannot be run: " + reason + ".");
}

}  // namespace

int main(int argc, char** argv) {
    using namespace hashphase::demos;
    Console console{std::cout, std::cerr, isatty(STDERR_FILENO) != 0, "hashphase"};
    return startSubcommand({argv + 1, argv + argc}, console,
                           [&console](const std::string& name, std::vector<std::string> rest) {
                               return become("hashphase-" + name, std::move(rest), console);
                           });
}
