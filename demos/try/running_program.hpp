// SPDX-License-Identifier: Zlib
#pragma once

// A program that is tried, while it runs: itself, the processes that it starts and may leave behind, and the
// signals that end it.

#include <demos/try/record.hpp>

#include <array>
#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace hashphase::demos {

/// Notes the signals that would end this process (SIGINT, SIGQUIT, SIGTERM, SIGHUP), for as long as it lives,
/// but for those that are ignored, as nohup asks. One at a time.
class NotedSignals {
public:
    NotedSignals() noexcept;
    ~NotedSignals();
    NotedSignals(const NotedSignals&) = delete;
    NotedSignals& operator=(const NotedSignals&) = delete;

    /// The last that was received; 0: none.
    [[nodiscard]] int received() const noexcept;

    /// Whether that has reached all programs of the terminal as well.
    [[nodiscard]] bool isFromKeyboard() const noexcept;

private:
    static constexpr std::array kSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP};
    std::array<struct sigaction, kSignals.size()> before_{};
};

/// The words, for a call of the system's; nullptr is the last one.
[[nodiscard]] std::vector<char*> pointersTo(std::vector<std::string>& words);

struct ProgramCall {
    std::string path;
    std::vector<std::string> words;      // argv, the name first
    std::vector<std::string> variables;  // its environment: "NAME=value"
};

/// Its processes are the descendants of this one, as /proc tells, but for those that were there before: orphans
/// of the program become children of this process (PR_SET_CHILD_SUBREAPER). The one whose steps are recorded may
/// have been left behind by what was started.
class RunningProgram {
public:
    /// Starts the program, which fills `record`. Throws InputError when it cannot be started.
    RunningProgram(ProgramCall call, const tryout::Record& record);

    /// Whether what was started still runs, then the process whose steps are recorded, or, for as long as
    /// there is none, any of it.
    [[nodiscard]] bool isRunning();

    /// Whether any process of it still runs.
    [[nodiscard]] bool hasProcesses();

    /// Whether what was started has ended.
    [[nodiscard]] bool hasLeft() const { return status_.has_value(); }

    /// Sends it to the process whose steps are recorded; to all, where there is none.
    void sendToRecorded(int signal);

    /// Sends it to all processes of it, or, with `reachedOurGroup`, to those that are not in the process group
    /// of this one.
    void send(int signal, bool reachedOurGroup = false) const;

    /// As wait() has it: of the recorded process, or, where somebody else has waited for that, of what was
    /// started.
    [[nodiscard]] int status() const { return recordedStatus_.value_or(status_.value_or(0)); }
    [[nodiscard]] bool isStatusOfRecorded() const { return recordedStatus_.has_value(); }

private:
    void reap();
    [[nodiscard]] pid_t findRecorded();
    [[nodiscard]] std::vector<pid_t> processes() const;

    std::vector<pid_t> earlier_;  // descendants that are none of the program's
    const tryout::Record& record_;
    pid_t child_ = 0;
    pid_t recorded_ = 0;  // once it was found
    std::optional<int> status_;
    std::optional<int> recordedStatus_;
};

}  // namespace hashphase::demos
