// SPDX-License-Identifier: Zlib
#include <demos/try/running_program.hpp>

#include <demos/scenes/input_error.hpp>
#include <demos/system/interruption.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>
#include <thread>

#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

using Clock = std::chrono::steady_clock;

struct ProcessStatus {
    pid_t parent = 0;
    pid_t ownNumber = 0;  // what the process takes for its number itself, in a namespace of its own
    bool isDead = false;  // and not waited for yet
    int threadCount = 0;  // that of a dead one is 1
};

// As /proc tells; of one that is gone nothing.
ProcessStatus statusOf(pid_t process) {
    ProcessStatus status{.ownNumber = process};
    std::ifstream lines("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string label;
        words >> label;
        if (label == "NSpid:") {
            while (words >> status.ownNumber) {  // from the outermost namespace to the innermost
            }
        } else if (label == "PPid:") {
            words >> status.parent;
        } else if (label == "State:") {
            const auto letter = static_cast<char>((words >> std::ws).peek());
            status.isDead = letter == 'Z' || letter == 'X';
        } else if (label == "Threads:") {
            words >> status.threadCount;
        }
    }
    return status;
}

// The first thread of a process may be dead, and others alive.
bool isAlive(pid_t process) {
    const ProcessStatus status = statusOf(process);
    return status.threadCount > (status.isDead ? 1 : 0);
}

// The parents of all processes that are alive or not waited for.
std::map<pid_t, pid_t> allParents() {
    std::map<pid_t, pid_t> parents;
    std::error_code error;
    for (std::filesystem::directory_iterator entry("/proc", error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (name.find_first_not_of("0123456789") == std::string::npos) {
            const pid_t process = std::stoi(name);
            parents[process] = statusOf(process).parent;
        }
    }
    return parents;
}

// The descendants of this process, but for `others` and theirs.
std::vector<pid_t> descendantsBut(const std::vector<pid_t>& others) {
    const std::map<pid_t, pid_t> parents = allParents();
    const auto isOurs = [&](pid_t process) {
        // Read while processes come and go, a line of parents may lead anywhere.
        for (std::size_t i = 0; i < parents.size(); ++i) {
            const auto found = parents.find(process);
            if (found == parents.end() || std::ranges::find(others, process) != others.end()) {
                return false;
            }
            process = found->second;
            if (process == getpid()) {
                return true;
            }
        }
        return false;
    };
    std::vector<pid_t> descendants;
    for (const auto& [process, parent] : parents) {
        if (isOurs(process)) {
            descendants.push_back(process);
        }
    }
    return descendants;
}

/// Its processes are the descendants of this one, as /proc tells, but for those that were there before: orphans
/// of the program become children of this process (PR_SET_CHILD_SUBREAPER). The one whose steps are recorded may
/// have been left behind by what was started.
class RunningProgram {
public:
    RunningProgram(ProgramCall& call, const tryout::Record& record)
        : earlier_(descendantsBut({})), record_(record) {
        prctl(PR_SET_CHILD_SUBREAPER, 1);
        const int error =
            posix_spawn(&child_, call.path.c_str(), nullptr, nullptr, pointersTo(call.words).data(),
                        pointersTo(call.variables).data());
        if (error != 0) {
            throw InputError(call.path + " cannot be run: " + std::strerror(error) + ".");
        }
    }

    /// Whether what was started still runs, then the process whose steps are recorded, or, for as long as
    /// there is none, any of it.
    [[nodiscard]] bool isRunning() {
        reap();
        if (!status_) {
            return true;
        }
        const bool isAnyAlive =
            record_.process.load() != 0 ? isAlive(findRecorded()) : !processes().empty();
        if (!isAnyAlive) {
            reap();  // what has ended since
        }
        return isAnyAlive;
    }

    /// Whether any process of it still runs.
    [[nodiscard]] bool hasProcesses() {
        reap();
        return !status_ || !processes().empty();
    }

    /// Whether what was started has ended.
    [[nodiscard]] bool hasLeft() const { return status_.has_value(); }

    /// Sends it to the process whose steps are recorded; to all, where there is none.
    void sendToRecorded(int signal) {
        const pid_t recorded = findRecorded();
        if (isAlive(recorded)) {
            kill(recorded, signal);
        } else {
            send(signal);
        }
    }

    /// Sends it to all processes of it, or, with `reachedOurGroup`, to those that are not in the process group
    /// of this one.
    void send(int signal, bool reachedOurGroup = false) const {
        std::vector<pid_t> receivers = processes();
        if (!status_) {
            std::erase(receivers, child_);
            receivers.push_back(child_);
        }
        for (const pid_t receiver : receivers) {
            if (!reachedOurGroup || getpgid(receiver) != getpgrp()) {
                kill(receiver, signal);
            }
        }
    }

    /// As wait() has it: of the recorded process, or, where somebody else has waited for that, of what was
    /// started.
    [[nodiscard]] int status() const { return recordedStatus_.value_or(status_.value_or(0)); }
    [[nodiscard]] bool isStatusOfRecorded() const { return recordedStatus_.has_value(); }

private:
    // While a dead process is not waited for, it can still be asked who it was.
    void reap() {
        siginfo_t ended{};
        while (waitid(P_ALL, 0, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid != 0) {
            const bool wasRecorded = statusOf(ended.si_pid).ownNumber == record_.process.load();
            int status = 0;
            waitpid(ended.si_pid, &status, 0);
            if (ended.si_pid == child_) {
                status_ = status;
            }
            if (wasRecorded) {
                recordedStatus_ = status;
            }
            ended = {};
        }
    }

    pid_t findRecorded() {
        const pid_t ownNumber = record_.process.load();
        if (recorded_ == 0 && ownNumber != 0) {
            for (const pid_t process : processes()) {
                if (statusOf(process).ownNumber == ownNumber) {
                    recorded_ = process;
                }
            }
        }
        return recorded_;
    }

    // Those with rights of their own (setuid) cannot be ended, and load nothing of ours.
    [[nodiscard]] std::vector<pid_t> processes() const {
        std::vector<pid_t> numbers = descendantsBut(earlier_);
        std::erase_if(numbers, [](pid_t number) { return kill(number, 0) != 0; });
        return numbers;
    }

    std::vector<pid_t> earlier_;  // descendants that are none of the program's
    const tryout::Record& record_;
    pid_t child_ = 0;
    pid_t recorded_ = 0;  // once it was found
    std::optional<int> status_;
    std::optional<int> recordedStatus_;
};

// Pairs that are calculated by hand count where there are no steps.
bool isAtLimit(const ProgramCall& call, const tryout::Record& record, Clock::duration time) {
    const std::uint32_t steps = record.stepCount.load(std::memory_order_acquire);
    return (call.stepLimit && (steps > 0 ? steps : record.rowCount.load()) >= *call.stepLimit) ||
           (call.secondLimit && std::chrono::duration<double>(time).count() >= *call.secondLimit);
}

// `isAsked`: it was asked to end.
RunEnd endOf(const RunningProgram& program, const tryout::Record& record, bool isAsked,
             int received) {
    const int status = program.status();
    const std::string code = std::to_string(WEXITSTATUS(status));
    if (!program.isStatusOfRecorded() && record.process.load() != 0 && record.hasEnded == 0 &&
        !isAsked) {
        return {
            "was ended otherwise than by exit(), after which what had started it ended with "
            "status " +
                code,
            true};
    }
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (isAsked && (signal == 0 || signal == SIGTERM || signal == SIGKILL || signal == received)) {
        return {"was stopped"};
    }
    if (signal != 0) {
        return {"was ended by signal " + std::to_string(signal) + " (" + strsignal(signal) + ")",
                true};
    }
    return {"ended with status " + code};
}

}  // namespace

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

// Ends the program when it is at a limit or we are asked to: by and by, so that what has started it can clean
// up behind it.
RunEnd runToTheEnd(ProgramCall call, const tryout::Record& record) {
    constexpr std::chrono::milliseconds kLook(5);
    constexpr std::chrono::milliseconds kLookInProc(50);
    constexpr std::chrono::seconds kFirstPatience(1);
    constexpr std::chrono::seconds kLastPatience(3);
    constexpr int kLooksInSilence = 40;
    RunningProgram program(call, record);
    const Clock::time_point begin = Clock::now();
    std::optional<Clock::time_point> asked;  // to end
    bool areAllAsked = false;
    int looksForNobody = 0;
    while (asked ? program.hasProcesses() : program.isRunning()) {
        const Clock::time_point now = Clock::now();
        if (asked && now - *asked > kLastPatience) {
            program.send(SIGKILL);
        } else if (asked && now - *asked > kFirstPatience && !areAllAsked) {
            areAllAsked = true;
            program.send(SIGTERM);
        } else if (!asked && isInterrupted()) {
            asked = now;
            program.send(notedSignal(), isFromKeyboard());
        } else if (!asked && isAtLimit(call, record, now - begin)) {
            asked = now;
            program.sendToRecorded(SIGTERM);
        }
        if (program.hasLeft() && record.process.load() == 0 &&
            looksForNobody++ == kLooksInSilence) {
            call.sayThatItWaits();
        }
        std::this_thread::sleep_for(program.hasLeft() ? kLookInProc : kLook);
    }
    return endOf(program, record, asked || isInterrupted(), notedSignal());
}

}  // namespace hashphase::demos
