// SPDX-License-Identifier: Zlib
#include <demos/system/process.hpp>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#if HASHPHASE_HAS_AFFINITY
#include <sched.h>
#endif
#include <sys/ioctl.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

std::size_t columnsOfTerminal(int file) noexcept {
    winsize size{};
    if (isatty(file) == 0) {
        return 0;
    }
    return ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

}  // namespace

bool errIsTerminal() noexcept {
    return isatty(STDERR_FILENO) != 0;
}

std::size_t outColumns() noexcept {
    return columnsOfTerminal(STDOUT_FILENO);
}

std::size_t errColumns() noexcept {
    return columnsOfTerminal(STDERR_FILENO);
}

std::filesystem::path programBeside(const std::string& name) {
    std::error_code error;
    return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / name;
}

int runInstead(const std::filesystem::path& program, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), program.string());
    std::vector<char*> pointers;
    for (std::string& argument : arguments) {
        pointers.push_back(argument.data());
    }
    pointers.push_back(nullptr);
    execv(program.c_str(), pointers.data());  // returns only where it fails
    throw std::system_error(errno, std::generic_category());
}

void setEnvironment(const char* name, const char* value) noexcept {
    static_cast<void>(setenv(name, value, 1));
}

void pinToThisCore() noexcept {
#if HASHPHASE_HAS_AFFINITY
    const int core = sched_getcpu();
    if (core >= 0) {
        cpu_set_t cores;
        CPU_ZERO(&cores);
        CPU_SET(static_cast<unsigned>(core), &cores);
        static_cast<void>(sched_setaffinity(0, sizeof(cores), &cores));
    }
#endif
}

std::string processorName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
            return line.substr(line.find(": ") + 2);
        }
    }
    return "unknown";
}

std::string operatingSystem() {
    utsname system{};
    return uname(&system) < 0
               ? std::string("unknown")
               : std::string(system.sysname) + ' ' + system.release + ' ' + system.machine;
}

}  // namespace hashphase::demos
