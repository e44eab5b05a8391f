// SPDX-License-Identifier: Zlib
#include <demos/viewer/viewer_program.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace hashphase::demos {
namespace {

// Beside this program where both are installed, and in a folder below it where they are built.
std::string viewerPath() {
    std::error_code error;
    const std::filesystem::path here =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
    for (const char* place : {"hashphase-wander", "viewer/hashphase-wander"}) {
        if (std::filesystem::exists(here / place, error)) {
            return (here / place).string();
        }
    }
    return {};
}

}  // namespace

Subcommand viewerCommand() {
    Subcommand command;
    command.name = kViewerCommand;
    command.description = "Watch the paper's simulation, and play with it";
    command.declareOptions = [](CLI::App&) {};
    command.run = [](Console& console) { return runViewerProgram({}, console); };
    return command;
}

int runViewerProgram(std::span<const std::string> arguments, Console& console) {
    std::string path = viewerPath();
    std::vector<std::string> words(arguments.begin(), arguments.end());
    std::vector<char*> pointers{path.data()};
    for (std::size_t i = 1; i < words.size(); ++i) {
        pointers.push_back(words[i].data());
    }
    pointers.push_back(nullptr);
    console.out.flush();
    if (path.empty()) {
        console.err << "hashphase: the viewer was not built. Install libepoxy-dev, libstb-dev, "
                       "libimgui-dev and libglfw3-dev (Debian, Ubuntu), and build again.\n";
        return kExitUsage;
    }
    execv(path.c_str(), pointers.data());  // returns only where it fails
    const std::string reason = std::strerror(errno);
    console.err << "hashphase: " << path << " cannot be run: " << reason << ".\n";
    return kExitUsage;
}

}  // namespace hashphase::demos
