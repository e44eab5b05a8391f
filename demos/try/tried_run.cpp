// SPDX-License-Identifier: Zlib
#include <demos/try/tried_run.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
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
    explicit RecordFile(const TriedRunSettings& settings) : path_(pathOfNone()) {
        const int file = mkstemp(path_.data());
        void* bytes = MAP_FAILED;
        if (file >= 0 && hasRoom(file)) {
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
    // Of which mkstemp() fills in the end, and which it refuses if it is empty.
    static std::string pathOfNone() {
        std::error_code error;
        const std::filesystem::path folder =
            std::filesystem::absolute(std::filesystem::temp_directory_path(error), error);
        return error ? "" : (folder / "hashphase-try-XXXXXX").string();
    }

    // All of it, now: where there is none, the program would pay for it.
    static bool hasRoom(int file) {
        const auto before = std::signal(SIGXFSZ, SIG_IGN);  // a limit is an error as any other
        int error = EINTR;
        while (error == EINTR) {
            error = posix_fallocate(file, 0, sizeof(Record));
        }
        std::signal(SIGXFSZ, before);
        return error == 0;
    }

    std::string path_;
    Record* record_ = nullptr;
};

// This process's, with our library before others that are preloaded.
std::vector<std::string> environmentFor(const std::string& preload, const std::string& recordPath) {
    const std::string record = std::string(tryout::kRecordVariable) + "=";
    std::vector<std::string> all;
    std::string preloads = preload;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        if (text.starts_with("LD_PRELOAD=")) {
            preloads += ":" + text.substr(text.find('=') + 1);
        } else if (!text.starts_with(record)) {
            all.push_back(text);
        }
    }
    all.push_back("LD_PRELOAD=" + preloads);
    all.push_back(record + recordPath);
    return all;
}

// Pairs that are calculated by hand count where there are no steps.
bool isAtLimit(const TriedRunSettings& settings, const Record& record, Clock::duration time) {
    const std::uint32_t steps = record.stepCount.load(std::memory_order_acquire);
    return (settings.stepLimit &&
            (steps > 0 ? steps : record.rowCount.load()) >= *settings.stepLimit) ||
           (settings.secondLimit &&
            std::chrono::duration<double>(time).count() >= *settings.secondLimit);
}

constexpr std::chrono::seconds kFirstPatience(1);
constexpr std::chrono::seconds kLastPatience(3);

/// Ends a program by and by, so that what has started it can clean up behind it.
class Ending {
public:
    explicit Ending(RunningProgram& program) : program_(program) {}

    [[nodiscard]] bool hasBegun() const { return begin_.has_value(); }

    void begin(const NotedSignals& signals) {
        begin_ = Clock::now();
        if (signals.received() == 0) {
            program_.sendToRecorded(SIGTERM);
        } else {
            program_.send(signals.received(), signals.isFromKeyboard());
        }
    }
    void goOn() {
        const Clock::duration time = Clock::now() - *begin_;
        if (time > kLastPatience) {
            program_.send(SIGKILL);
        } else if (time > kFirstPatience && !hasAskedAll_) {
            hasAskedAll_ = true;
            program_.send(SIGTERM);
        }
    }

private:
    RunningProgram& program_;
    std::optional<Clock::time_point> begin_;
    bool hasAskedAll_ = false;
};

// Ends the program when it is at a limit or we are asked to.
RunEnd waitFor(RunningProgram& program, const TriedRunSettings& settings, const Record& record,
               const NotedSignals& signals) {
    constexpr std::chrono::milliseconds kLook(5);
    constexpr std::chrono::milliseconds kLookInProc(50);
    constexpr int kLooksInSilence = 40;
    const Clock::time_point begin = Clock::now();
    int looksForNobody = 0;
    Ending ending(program);
    while (ending.hasBegun() ? program.hasProcesses() : program.isRunning()) {
        const Clock::time_point now = Clock::now();
        if (ending.hasBegun()) {
            ending.goOn();
        } else if (signals.received() != 0 || isAtLimit(settings, record, now - begin)) {
            ending.begin(signals);
        }
        if (program.hasLeft() && record.process.load() == 0 &&
            looksForNobody++ == kLooksInSilence) {
            settings.sayThatItWaits();
        }
        std::this_thread::sleep_for(program.hasLeft() ? kLookInProc : kLook);
    }
    const int status = program.status();
    if (!program.isStatusOfRecorded() && record.process.load() != 0 && record.hasEnded == 0 &&
        !ending.hasBegun() && signals.received() == 0) {
        return {.isCrash = true, .isHidden = true, .code = WEXITSTATUS(status)};
    }
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if ((ending.hasBegun() || signals.received() != 0) &&
        (signal == 0 || signal == SIGTERM || signal == SIGKILL || signal == signals.received())) {
        return {.isStopped = true, .code = 0};
    }
    return signal != 0 ? RunEnd{.isCrash = true, .code = signal}
                       : RunEnd{.code = WEXITSTATUS(status)};
}

// Pairs that were calculated outside of steps count where there are no steps. Rays that were cast before
// them are before the next step, too.
std::vector<tryout::StepRow> stepsOf(const Record& record) {
    const auto isUnwritten = [](const tryout::StepRow& row) { return row.calculations == 0; };
    const auto isNoStep = [](const tryout::StepRow& row) { return row.isStep == 0; };
    const std::uint32_t count = std::min(record.rowCount.load(), Record::kMaxRows);
    std::vector<tryout::StepRow> rows(record.rows.begin(), record.rows.begin() + count);
    std::erase_if(rows, isUnwritten);
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

ProgramCall callFor(const TriedRunSettings& settings, const std::string& recordPath) {
    for (const std::string& library : settings.preloads) {
        if (library.find_first_of(" :") != std::string::npos) {
            throw InputError(library +
                             " cannot be preloaded: there is a blank or a colon in the path");
        }
    }
    return {settings.path, settings.words,
            environmentFor(joined(settings.preloads, ":"), recordPath)};
}

}  // namespace

std::string textOf(const RunEnd& end) {
    if (end.isStopped) {
        return "was stopped";
    }
    if (end.isHidden) {
        return "was ended otherwise than by exit(), after which what had started it ended with "
               "status " +
               std::to_string(end.code);
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
    return (a.isCrash == b.isCrash && a.isHidden == b.isHidden && a.code == b.code) ||
           ((a.isStopped || b.isStopped) && isRegular(a) && isRegular(b));
}

TriedRun runTried(const TriedRunSettings& settings, const NotedSignals& signals) {
    const RecordFile file(settings);
    const Record& record = file.record();
    const ProgramCall call = callFor(settings, file.path());
    if (settings.inputBegin >= 0) {
        lseek(STDIN_FILENO, settings.inputBegin, SEEK_SET);
    }
    RunningProgram program(call, record);
    TriedRun run;
    run.end = waitFor(program, settings, record, signals);
    run.broadphase = settings.broadphase;
    run.isLoaded = record.isLoaded.load() != 0;
    run.hasBroadphase = record.dbvtCount.load() + record.axisSweepCount.load() > 0;
    run.dbvtCount = record.dbvtCount;
    run.axisSweepCount = record.axisSweepCount;
    run.derivedSweepCount = record.derivedSweepCount;
    run.foreignCalculations = record.foreignCalculations;
    run.otherProcesses = record.otherProcesses;
    run.droppedRows = record.rowCount - std::min(record.rowCount.load(), Record::kMaxRows);
    run.rows = stepsOf(record);
    if (settings.stepLimit) {
        run.rows.resize(std::min<std::size_t>(run.rows.size(), *settings.stepLimit));
    }
    run.verification = record.verification;
    return run;
}

}  // namespace hashphase::demos
