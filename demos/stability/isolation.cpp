// SPDX-License-Identifier: Zlib
#include <demos/stability/isolation.hpp>

#include <demos/console/format.hpp>
#include <demos/report/stopwatch.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <thread>

#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

File temporaryFile() {
    File file(std::tmpfile());
    if (file == nullptr) {
        throw std::runtime_error("No temporary file can be made.");
    }
    return file;
}

// The outcome, as its numbers and then its note.
struct Numbers {
    double ratio;
    std::uint64_t hasRatio;
    std::uint64_t kind;
    std::uint64_t compared;
    std::uint64_t missing;
    std::uint64_t extra;
};

void writeOutcome(const CaseOutcome& outcome, std::FILE* file) {
    const Numbers numbers{outcome.costRatio.value_or(0),
                          outcome.costRatio.has_value(),
                          static_cast<std::uint64_t>(outcome.kind),
                          outcome.compared,
                          outcome.missing,
                          outcome.extra};
    std::fwrite(&numbers, sizeof numbers, 1, file);
    std::fwrite(outcome.note.data(), 1, outcome.note.size(), file);
    std::fflush(file);
}

std::string textOf(std::FILE* file, std::size_t most) {
    std::string text(most, '\0');
    text.resize(std::fread(text.data(), 1, most, file));
    return text;
}

CaseOutcome readOutcome(std::FILE* file) {
    std::rewind(file);
    CaseOutcome outcome;
    Numbers numbers;
    if (std::fread(&numbers, sizeof numbers, 1, file) != 1) {
        outcome.kind = OutcomeKind::crashes;
        outcome.note = "It ended without an answer.";
        return outcome;
    }
    outcome.kind = static_cast<OutcomeKind>(numbers.kind);
    outcome.compared = numbers.compared;
    outcome.missing = numbers.missing;
    outcome.extra = numbers.extra;
    if (numbers.hasRatio != 0) {
        outcome.costRatio = numbers.ratio;
    }
    outcome.note = textOf(file, 4000);
    return outcome;
}

itimerval timerOf(double seconds) {
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(seconds);
    timer.it_value.tv_usec =
        static_cast<suseconds_t>(std::max(1.0, (seconds - std::floor(seconds)) * 1e6));
    return timer;
}

CaseOutcome callGuarded(const std::function<CaseOutcome()>& work) {
    try {
        return work();
    } catch (const std::exception& error) {
        CaseOutcome outcome;
        outcome.kind = OutcomeKind::wrong;
        outcome.note = std::string("It threw: ") + error.what();
        return outcome;
    }
}

[[noreturn]] void runChild(const std::function<CaseOutcome()>& work, double seconds,
                           std::FILE* answer, std::FILE* said) {
    const rlimit noCore{0, 0};
    setrlimit(RLIMIT_CORE, &noCore);
    dup2(fileno(said), STDOUT_FILENO);
    dup2(fileno(said), STDERR_FILENO);
    // The timer's signal ends the process.
    std::signal(SIGPROF, SIG_DFL);
    const itimerval timer = timerOf(seconds);
    setitimer(ITIMER_PROF, &timer, nullptr);
    writeOutcome(callGuarded(work), answer);
    _exit(0);
}

// Waits for the process; false when it had to be killed.
bool waitFor(pid_t child, double wallSeconds, const std::function<void()>& whileWaiting,
             int& status) {
    const Stopwatch watch;
    std::chrono::microseconds nap{50};
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (watch.milliseconds() > wallSeconds * 1000) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            return false;
        }
        std::this_thread::sleep_for(nap);
        nap = std::min(2 * nap, std::chrono::microseconds{20'000});
        if (whileWaiting) {
            whileWaiting();
        }
    }
    return true;
}

CaseOutcome crash(const std::string& how, std::FILE* said) {
    CaseOutcome outcome;
    outcome.kind = OutcomeKind::crashes;
    outcome.note = how;
    std::rewind(said);
    if (const std::string words = textOf(said, 600); !words.empty()) {
        outcome.note += " It said: " + words;
    }
    return outcome;
}

CaseOutcome hang(double seconds, const char* ofWhat) {
    CaseOutcome outcome;
    outcome.kind = OutcomeKind::hangs;
    outcome.seconds = seconds;
    outcome.note =
        "It did not end within " + fixed(seconds, seconds < 1 ? 2 : 0) + " s of " + ofWhat + ".";
    return outcome;
}

}  // namespace

CaseOutcome runIsolated(const std::function<CaseOutcome()>& work, const IsolationLimits& limits,
                        const std::function<void()>& whileWaiting) {
    const File answer = temporaryFile();
    const File said = temporaryFile();
    const pid_t child = fork();
    if (child < 0) {
        throw std::runtime_error(std::string("No process can be made: ") + std::strerror(errno));
    }
    if (child == 0) {
        runChild(work, limits.seconds, answer.get(), said.get());
    }
    int status = 0;
    if (!waitFor(child, limits.wallSeconds(), whileWaiting, status)) {
        return hang(limits.wallSeconds(), "wall time");
    }
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) {
        return hang(limits.seconds, "processor time");
    }
    if (WIFSIGNALED(status)) {
        return crash("It ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                         strsignal(WTERMSIG(status)) + ").",
                     said.get());
    }
    if (WEXITSTATUS(status) != 0) {
        return crash("It ended with status " + std::to_string(WEXITSTATUS(status)) + ".",
                     said.get());
    }
    return readOutcome(answer.get());
}

LimitPause::LimitPause() {
    const itimerval off{};
    itimerval left{};
    setitimer(ITIMER_PROF, &off, &left);
    secondsLeft_ = left.it_value.tv_sec;
    microsecondsLeft_ = left.it_value.tv_usec;
}

LimitPause::~LimitPause() {
    if (secondsLeft_ == 0 && microsecondsLeft_ == 0) {
        return;
    }
    itimerval left{};
    left.it_value.tv_sec = secondsLeft_;
    left.it_value.tv_usec = static_cast<suseconds_t>(microsecondsLeft_);
    setitimer(ITIMER_PROF, &left, nullptr);
}

}  // namespace hashphase::demos
