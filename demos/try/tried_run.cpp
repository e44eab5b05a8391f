// SPDX-License-Identifier: Zlib
#include <demos/try/tried_run.hpp>

#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

using tryout::Record;
using Clock = std::chrono::steady_clock;

/// A file with a record, mapped; removed in the end.
class RecordFile {
public:
    explicit RecordFile(const TriedRunSettings& settings)
        : path_((std::filesystem::temp_directory_path() / "hashphase-try-XXXXXX").string()) {
        const int file = mkstemp(path_.data());
        void* bytes = MAP_FAILED;
        if (file >= 0 && ftruncate(file, sizeof(Record)) == 0) {
            bytes = mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        }
        if (file >= 0) {
            close(file);
        }
        if (bytes == MAP_FAILED) {
            throw InputError("no file can be made in the folder of temporary files: " +
                             std::string(std::strerror(errno)));
        }
        record_ = static_cast<Record*>(bytes);  // of zeros
        record_->format = Record::kFormat;
        record_->broadphase = settings.broadphase;
        record_->stepLimit =
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

/// Lets the program have the keyboard's signals for as long as this lives.
class IgnoredInterrupts {
public:
    IgnoredInterrupts()
        : interrupt_(std::signal(SIGINT, SIG_IGN)), quit_(std::signal(SIGQUIT, SIG_IGN)) {}
    ~IgnoredInterrupts() {
        std::signal(SIGINT, interrupt_);
        std::signal(SIGQUIT, quit_);
    }
    IgnoredInterrupts(const IgnoredInterrupts&) = delete;
    IgnoredInterrupts& operator=(const IgnoredInterrupts&) = delete;

private:
    void (*interrupt_)(int);
    void (*quit_)(int);
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
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t defaults;
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGINT);
    sigaddset(&defaults, SIGQUIT);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t child = 0;
    const int error = posix_spawn(&child, settings.path.c_str(), nullptr, &attributes,
                                  pointersTo(words).data(), pointersTo(variables).data());
    posix_spawnattr_destroy(&attributes);
    if (error != 0) {
        throw InputError(settings.path + " cannot be run: " + std::strerror(error));
    }
    return child;
}

bool isAtLimit(const TriedRunSettings& settings, const Record& record, Clock::duration time) {
    return (settings.stepLimit && record.rowCount.load() >= record.stepLimit) ||
           (settings.secondLimit &&
            std::chrono::duration<double>(time).count() >= *settings.secondLimit);
}

// Asks the program to end when it is at a limit, and some seconds later no longer asks.
RunEnd waitFor(pid_t child, const TriedRunSettings& settings, const Record& record) {
    constexpr std::chrono::milliseconds kLook(5);
    constexpr std::chrono::seconds kPatience(3);
    const Clock::time_point begin = Clock::now();
    std::optional<Clock::time_point> asked;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0) {
        const Clock::time_point now = Clock::now();
        if (!asked && isAtLimit(settings, record, now - begin)) {
            asked = now;
            kill(child, SIGTERM);
        } else if (asked && now - *asked > kPatience) {
            kill(child, SIGKILL);
        }
        std::this_thread::sleep_for(kLook);
    }
    if (asked) {
        return {.isStopped = true};
    }
    return WIFSIGNALED(status) ? RunEnd{.isCrash = true, .code = WTERMSIG(status)}
                               : RunEnd{.code = WEXITSTATUS(status)};
}

}  // namespace

std::string textOf(const RunEnd& end) {
    if (end.isStopped) {
        return "was stopped at the limit";
    }
    if (end.isCrash) {
        return "was ended by signal " + std::to_string(end.code) + " (" + strsignal(end.code) + ")";
    }
    return "ended with status " + std::to_string(end.code);
}

TriedRun runTried(const TriedRunSettings& settings) {
    if (settings.preload.find_first_of(" :") != std::string::npos) {
        throw InputError(settings.preload +
                         " cannot be preloaded: its path has a blank or a colon in it");
    }
    const RecordFile file(settings);
    const Record& record = file.record();
    TriedRun run;
    {
        const IgnoredInterrupts interrupts;
        run.end = waitFor(start(settings, file.path()), settings, record);
    }
    run.broadphase = settings.broadphase;
    run.hasBroadphase = record.dbvtCount.load() + record.axisSweepCount.load() > 0;
    run.dbvtCount = record.dbvtCount;
    run.axisSweepCount = record.axisSweepCount;
    run.foreignCalculations = record.foreignCalculations;
    run.otherProcesses = record.otherProcesses;
    const std::uint32_t count = record.rowCount.load(std::memory_order_acquire);
    run.rows.assign(record.rows.begin(), record.rows.begin() + count);
    const tryout::Verification& verification = record.verification;
    run.calculations = verification.calculations;
    run.pairs = verification.pairs;
    run.missing = verification.missing;
    run.extra = verification.extra;
    run.unasked = verification.unasked;
    run.stockMissing = verification.stockMissing;
    run.stockExtra = verification.stockExtra;
    run.firstFault = verification.firstFault.data();
    return run;
}

}  // namespace hashphase::demos
