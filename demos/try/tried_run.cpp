// SPDX-License-Identifier: Zlib
#include <demos/try/tried_run.hpp>

#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

using tryout::Record;
using Clock = std::chrono::steady_clock;

/// A file with a record, mapped; removed in the end.
class RecordFile {
public:
    explicit RecordFile(const TriedRunSettings& settings) {
        std::error_code error;
        path_ = (std::filesystem::absolute(std::filesystem::temp_directory_path(error), error) /
                 "hashphase-try-XXXXXX")
                    .string();
        const int file = error ? -1 : mkstemp(path_.data());
        void* bytes = MAP_FAILED;
        // All of it, now: where there is no room, the program would pay for it.
        if (file >= 0 && posix_fallocate(file, 0, sizeof(Record)) == 0) {
            bytes = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        }
        if (file >= 0) {
            close(file);
        }
        if (bytes == MAP_FAILED) {
            unlink(path_.c_str());
            throw InputError("no file of " + std::to_string(sizeof(Record) >> 20U) +
                             " MiB can be made in the folder of temporary files (TMPDIR)");
        }
        record_ = static_cast<Record*>(bytes);  // of zeros
        record_->format = Record::kFormat;
        record_->broadphase = settings.broadphase;
        record_->rowLimit =
            std::min(settings.stepLimit.value_or(Record::kMaxRows), Record::kMaxRows);
    }
    ~RecordFile() {
        munmap(record_, sizeof(Record));
        unlink(path_.c_str());
    }
    RecordFile(const RecordFile&) = delete;
    RecordFile& operator=(const RecordFile&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const Record& record() const { return *record_; }

private:
    std::string path_;
    Record* record_ = nullptr;
};

volatile std::sig_atomic_t receivedSignal = 0;

/// Notes the signals that would end this process, for as long as it lives.
class NotedSignals {
public:
    NotedSignals() {
        receivedSignal = 0;
        struct sigaction note {};
        note.sa_handler = [](int signal) { receivedSignal = signal; };
        for (std::size_t i = 0; i < kSignals.size(); ++i) {
            sigaction(kSignals[i], &note, &before_[i]);
        }
    }
    ~NotedSignals() {
        for (std::size_t i = 0; i < kSignals.size(); ++i) {
            sigaction(kSignals[i], &before_[i], nullptr);
        }
    }
    NotedSignals(const NotedSignals&) = delete;
    NotedSignals& operator=(const NotedSignals&) = delete;

private:
    static constexpr std::array kSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP};
    std::array<struct sigaction, 4> before_{};
};

std::vector<char*> pointersTo(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    return pointers;
}

// This process's, with our library before others that are preloaded.
std::vector<std::string> environmentFor(const std::string& preload, const std::string& recordPath) {
    std::vector<std::string> all;
    std::string preloads = preload;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        if (text.starts_with("LD_PRELOAD=")) {
            preloads += ":" + text.substr(text.find('=') + 1);
        } else {
            all.push_back(text);
        }
    }
    all.push_back("LD_PRELOAD=" + preloads);
    all.push_back(std::string(tryout::kRecordVariable) + "=" + recordPath);
    return all;
}

pid_t start(const TriedRunSettings& settings, const std::string& recordPath) {
    std::vector<std::string> words = settings.words;
    std::vector<std::string> variables = environmentFor(settings.preload, recordPath);
    pid_t child = 0;
    if (settings.inputBegin >= 0) {
        lseek(STDIN_FILENO, settings.inputBegin, SEEK_SET);
    }
    const int error = posix_spawn(&child, settings.path.c_str(), nullptr, nullptr,
                                  pointersTo(words).data(), pointersTo(variables).data());
    if (error != 0) {
        throw InputError(settings.path + " cannot be run: " + std::strerror(error));
    }
    return child;
}

bool isAtLimit(const TriedRunSettings& settings, const Record& record, Clock::duration time) {
    return (settings.stepLimit && record.rowCount.load() >= record.rowLimit) ||
           (settings.secondLimit &&
            std::chrono::duration<double>(time).count() >= *settings.secondLimit);
}

// One that is dead is there until it is waited for, but has no program any more.
bool isAlive(pid_t process) {
    std::array<char, 1> name{};
    return process > 0 && kill(process, 0) == 0 &&
           readlink(("/proc/" + std::to_string(process) + "/exe").c_str(), name.data(), 1) >= 0;
}

/// The program that was started, and whoever of its descendants has the record, whom it may leave behind.
class RunningProgram {
public:
    RunningProgram(pid_t child, const Record& record) : child_(child), record_(record) {}

    /// Whether anything of it still runs.
    [[nodiscard]] bool isRunning() {
        int status = 0;
        if (!status_ && waitpid(child_, &status, WNOHANG) == child_) {
            status_ = status;
        }
        // Orphans are ours (PR_SET_CHILD_SUBREAPER), and dead ones remain until they are waited for.
        if (const pid_t recorded = record_.process.load(); recorded > 0 && recorded != child_) {
            waitpid(recorded, nullptr, WNOHANG);
        }
        return !status_ || (record_.process.load() != child_ && isAlive(record_.process.load()));
    }

    void send(int signal) const {
        if (!status_) {
            kill(child_, signal);
        }
        if (const pid_t recorded = record_.process.load();
            recorded != child_ && isAlive(recorded)) {
            kill(recorded, signal);
        }
    }

    /// Of the child, which has ended.
    [[nodiscard]] int status() const { return status_.value_or(0); }

private:
    pid_t child_;
    const Record& record_;
    std::optional<int> status_;
};

// Asks the program to end when it is at a limit or we are asked to, and some seconds later no longer asks.
RunEnd waitFor(RunningProgram& program, const TriedRunSettings& settings, const Record& record) {
    constexpr std::chrono::milliseconds kLook(5);
    constexpr std::chrono::seconds kPatience(3);
    const Clock::time_point begin = Clock::now();
    std::optional<Clock::time_point> asked;
    while (program.isRunning()) {
        const Clock::time_point now = Clock::now();
        if (!asked && (receivedSignal != 0 || isAtLimit(settings, record, now - begin))) {
            asked = now;
            // The keyboard's signals have reached the program as well.
            const bool hasItToo = receivedSignal == SIGINT || receivedSignal == SIGQUIT;
            if (!hasItToo) {
                program.send(receivedSignal != 0 ? receivedSignal : SIGTERM);
            }
        } else if (asked && now - *asked > kPatience) {
            program.send(SIGKILL);
        }
        std::this_thread::sleep_for(kLook);
    }
    const int status = program.status();
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (asked &&
        (signal == 0 || signal == SIGTERM || signal == SIGKILL || signal == receivedSignal)) {
        return {.isStopped = true, .code = 0};
    }
    return signal != 0 ? RunEnd{.isCrash = true, .code = signal}
                       : RunEnd{.code = WEXITSTATUS(status)};
}

// Pairs that were calculated outside of steps count where there are no steps. Rays that were cast before
// them are before the next step, too.
std::vector<tryout::StepRow> stepsOf(const Record& record) {
    const std::uint32_t count = record.rowCount.load(std::memory_order_acquire);
    std::vector<tryout::StepRow> rows(record.rows.begin(), record.rows.begin() + count);
    const auto isNoStep = [](const tryout::StepRow& row) { return row.step == 0; };
    if (std::all_of(rows.begin(), rows.end(), isNoStep)) {
        return rows;
    }
    float raysBetween = 0;
    std::uint32_t rayBetweenCount = 0;
    for (tryout::StepRow& row : rows) {
        raysBetween += row.raysBetween;
        rayBetweenCount += row.rayBetweenCount;
        if (!isNoStep(row)) {
            row.raysBetween = std::exchange(raysBetween, 0.0F);
            row.rayBetweenCount = std::exchange(rayBetweenCount, 0);
        }
    }
    std::erase_if(rows, isNoStep);
    return rows;
}

}  // namespace

std::string textOf(const RunEnd& end) {
    if (end.isStopped) {
        return "was stopped";
    }
    if (end.isCrash) {
        return "was ended by signal " + std::to_string(end.code) + " (" + strsignal(end.code) + ")";
    }
    return "ended with status " + std::to_string(end.code);
}

bool areAlike(const RunEnd& a, const RunEnd& b) noexcept {
    const auto isRegular = [](const RunEnd& end) {
        return end.isStopped || (!end.isCrash && end.code == 0);
    };
    return (a.isCrash == b.isCrash && a.code == b.code) ||
           ((a.isStopped || b.isStopped) && isRegular(a) && isRegular(b));
}

TriedRun runTried(const TriedRunSettings& settings) {
    if (settings.preload.find(' ') != std::string::npos) {
        throw InputError(settings.preload + " cannot be preloaded: there is a blank in the path");
    }
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    const RecordFile file(settings);
    const Record& record = file.record();
    TriedRun run;
    {
        const NotedSignals signals;
        RunningProgram program(start(settings, file.path()), record);
        run.end = waitFor(program, settings, record);
        run.interruption = receivedSignal;
    }
    run.broadphase = settings.broadphase;
    run.hasBroadphase = record.dbvtCount.load() + record.axisSweepCount.load() > 0;
    run.dbvtCount = record.dbvtCount;
    run.axisSweepCount = record.axisSweepCount;
    run.derivedSweepCount = record.derivedSweepCount;
    run.foreignCalculations = record.foreignCalculations;
    run.otherProcesses = record.otherProcesses;
    // At the limit that was asked for, some more are no loss.
    run.droppedRows = settings.stepLimit ? 0 : record.droppedRows.load();
    run.rows = stepsOf(record);
    const tryout::Verification& verification = record.verification;
    run.calculations = verification.calculations;
    run.pairs = verification.pairs;
    run.missing = verification.missing;
    run.extra = verification.extra;
    run.unasked = verification.unasked;
    run.removed = verification.removed;
    run.stockMissing = verification.stockMissing;
    run.stockExtra = verification.stockExtra;
    run.firstFault = verification.firstFault.data();
    return run;
}

}  // namespace hashphase::demos
