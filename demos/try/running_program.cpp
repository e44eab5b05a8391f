// SPDX-License-Identifier: Zlib
#include <demos/try/running_program.hpp>

#include <demos/scenes/input_error.hpp>
#include <demos/try/program_file.hpp>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

std::filesystem::path folderOf(pid_t process) {
    return std::filesystem::path("/proc") / std::to_string(process);
}

struct Process {
    pid_t number = 0;
    pid_t ownNumber = 0;  // what it takes for its number itself, in a namespace of its own
    pid_t parent = 0;
};

// As /proc tells. One that ends meanwhile has no parent.
Process processOf(pid_t number) {
    Process process{number, number, 0};
    std::ifstream status(folderOf(number) / "status");
    for (std::string line; std::getline(status, line);) {
        std::istringstream words(line);
        std::string label;
        words >> label;
        if (label == "PPid:") {
            words >> process.parent;
        } else if (label == "NSpid:") {
            while (words >> process.ownNumber) {  // from the outermost namespace to the innermost
            }
        }
    }
    return process;
}

std::vector<Process> allProcesses() {
    std::vector<Process> processes;
    std::error_code error;
    for (std::filesystem::directory_iterator entry("/proc", error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.find_first_not_of("0123456789") == std::string::npos) {
            processes.push_back(processOf(std::stoi(name)));
        }
    }
    return processes;
}

// The children of the process, and theirs.
std::vector<Process> descendantsOf(pid_t ancestor) {
    const std::vector<Process> all = allProcesses();
    std::vector<Process> descendants;
    const auto addChildrenOf = [&](pid_t parent) {
        std::copy_if(all.begin(), all.end(), std::back_inserter(descendants),
                     [parent](const Process& process) { return process.parent == parent; });
    };
    addChildrenOf(ancestor);
    for (std::size_t i = 0; i < descendants.size(); ++i) {
        addChildrenOf(descendants[i].number);
    }
    return descendants;
}

}  // namespace

RunningProgram::RunningProgram(ProgramCall call, const std::filesystem::path& recordPath,
                               const tryout::Record& record)
    : recordName_(recordPath.filename().string()), record_(record) {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    const int error = posix_spawn(&child_, call.path.c_str(), nullptr, nullptr,
                                  pointersTo(call.words).data(), pointersTo(call.variables).data());
    if (error != 0) {
        throw InputError(call.path + " cannot be run: " + std::strerror(error));
    }
}

bool RunningProgram::isRunning() {
    int status = 0;
    for (pid_t ended = 0; (ended = waitpid(-1, &status, WNOHANG)) > 0;) {
        if (ended == child_) {
            status_ = status;
        }
    }
    return !status_ || !leftBehind().empty();
}

void RunningProgram::send(int signal) const {
    if (!status_) {
        kill(child_, signal);
    }
    for (const pid_t process : leftBehind()) {
        kill(process, signal);
    }
}

// The dead have nothing mapped, whether they were waited for or not.
std::vector<pid_t> RunningProgram::leftBehind() const {
    const pid_t recorded = record_.process.load();
    std::vector<pid_t> numbers;
    for (const Process& process : descendantsOf(getpid())) {
        if (process.number != child_ && (recorded == 0 || process.ownNumber == recorded) &&
            fileContains((folderOf(process.number) / "maps").string(), recordName_)) {
            numbers.push_back(process.number);
        }
    }
    return numbers;
}

}  // namespace hashphase::demos
