// SPDX-License-Identifier: Zlib
#include <demos/stability/isolation.hpp>

#include <demos/console/format.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/system/interruption.hpp>

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
#include <utility>

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
        throw std::runtime_error("Cannot create a temporary file.");
    }
    return file;
}

std::string textIn(std::FILE* file, std::size_t most) {
    std::string text(most, '\0');
    text.resize(std::fread(text.data(), 1, most, file));
    return text;
}

CaseOutcome outcomeOf(OutcomeKind kind, std::string note) {
    CaseOutcome outcome;
    outcome.kind = kind;
    outcome.note = std::move(note);
    return outcome;
}

// The outcome, as its numbers and then its note.
void writeOutcome(const CaseOutcome& outcome, std::FILE* file) {
    const CaseNumbers& numbers = outcome;
    std::fwrite(&numbers, sizeof numbers, 1, file);
    std::fwrite(outcome.note.data(), 1, outcome.note.size(), file);
    std::fflush(file);
}

CaseOutcome readOutcome(std::FILE* file) {
    std::rewind(file);
    CaseOutcome outcome;
    CaseNumbers& numbers = outcome;
    if (std::fread(&numbers, sizeof numbers, 1, file) != 1) {
        return outcomeOf(OutcomeKind::crashes, "The process ended without an answer.");
    }
    outcome.note = textIn(file, 4000);
    return outcome;
}

CaseOutcome callGuarded(const std::function<CaseOutcome()>& work) {
    try {
        return work();
    } catch (const std::exception& error) {
        return outcomeOf(OutcomeKind::wrong, std::string("It threw: ") + error.what());
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
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(seconds);
    timer.it_value.tv_usec =
        static_cast<suseconds_t>(std::max(1.0, (seconds - std::floor(seconds)) * 1e6));
    setitimer(ITIMER_PROF, &timer, nullptr);
    writeOutcome(callGuarded(work), answer);
    _exit(0);
}

// Waits for the process; false when it had to be killed, also by an interruption.
bool waitFor(pid_t child, double wallSeconds, const std::function<void()>& whileWaiting,
             int& status) {
    const Stopwatch watch;
    std::chrono::microseconds nap{50};
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (watch.milliseconds() > wallSeconds * 1000 || isInterrupted()) {
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
    std::rewind(said);
    const std::string words = textIn(said, 600);
    return outcomeOf(OutcomeKind::crashes, words.empty() ? how : how + " It printed: " + words);
}

CaseOutcome hang(double seconds, const char* ofWhat) {
    CaseOutcome outcome = outcomeOf(
        OutcomeKind::hangs,
        "It did not end within " + fixed(seconds, seconds < 1 ? 2 : 0) + " s of " + ofWhat + ".");
    outcome.seconds = seconds;
    return outcome;
}

}  // namespace

CaseOutcome runIsolated(const std::function<CaseOutcome()>& work, const IsolationLimits& limits,
                        const std::function<void()>& whileWaiting) {
    const File answer = temporaryFile();
    const File said = temporaryFile();
    const pid_t child = fork();
    if (child < 0) {
        throw std::runtime_error(std::string("Cannot start a process: ") + std::strerror(errno));
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
        return crash("The process was ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
                         strsignal(WTERMSIG(status)) + ").",
                     said.get());
    }
    if (WEXITSTATUS(status) != 0) {
        return crash("The process ended with status " + std::to_string(WEXITSTATUS(status)) + ".",
                     said.get());
    }
    return readOutcome(answer.get());
}

}  // namespace hashphase::demos
