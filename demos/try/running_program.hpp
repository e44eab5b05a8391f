// SPDX-License-Identifier: Zlib
#pragma once

// A program that is tried, while it runs: itself, and the processes that it starts and may leave behind.

#include <demos/try/record.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace hashphase::demos {

struct ProgramCall {
    std::string path;
    std::vector<std::string> words;      // argv, the name first
    std::vector<std::string> variables;  // its environment: "NAME=value"
};

class RunningProgram {
public:
    /// Starts the program. `recordPath` names the file of `record`, which the processes of the program have
    /// mapped if the library was loaded into them. Orphans of the program become children of this process
    /// (PR_SET_CHILD_SUBREAPER). Throws InputError when it cannot be started.
    RunningProgram(ProgramCall call, const std::filesystem::path& recordPath,
                   const tryout::Record& record);

    /// Whether something of it still runs: what was started, then the process whose steps are recorded, or,
    /// for as long as there is none, any into which the library was loaded.
    [[nodiscard]] bool isRunning();

    /// Whether what was started has ended; those that it has left behind are looked for in /proc.
    [[nodiscard]] bool hasLeft() const { return status_.has_value(); }

    /// Sends it to all of what runs.
    void send(int signal) const;

    /// Of what was started, as wait() has it.
    [[nodiscard]] int status() const { return status_.value_or(0); }

private:
    [[nodiscard]] std::vector<pid_t> leftBehind() const;

    std::string recordName_;
    const tryout::Record& record_;
    pid_t child_ = 0;
    std::optional<int> status_;
};

}  // namespace hashphase::demos
