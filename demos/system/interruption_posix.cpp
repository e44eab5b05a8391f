// SPDX-License-Identifier: Zlib
#include <demos/system/interruption.hpp>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <string_view>

#include <unistd.h>

namespace hashphase::demos {
namespace {

constexpr std::array kSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP, SIGXFSZ};

// What signal handlers may write and read.
volatile std::sig_atomic_t lastSignal = 0;
volatile std::sig_atomic_t isSentByKernel = 0;
volatile std::sig_atomic_t nextEndsProcess = 0;

std::array<struct sigaction, kSignals.size()> actionsBefore{};

void sayHowToEndAtOnce() {
    constexpr std::string_view kText =
        "\nhashphase: ending with what is measured so far; Ctrl-C again ends at once\n";
    const int error = errno;
    const auto written = write(STDERR_FILENO, kText.data(), kText.size());
    static_cast<void>(written);
    errno = error;
}

void note(int signal, siginfo_t* information, void* /*context*/) {
    if (signal == SIGXFSZ) {
        return;
    }
    if (lastSignal != 0 && nextEndsProcess != 0) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);  // ends the process when this function returns
        return;
    }
    isSentByKernel = information->si_code > 0 ? 1 : 0;
    lastSignal = signal;
    if (signal == SIGINT && nextEndsProcess != 0) {
        sayHowToEndAtOnce();
    }
}

}  // namespace

NotedSignals::NotedSignals(Next next) noexcept {
    lastSignal = 0;
    nextEndsProcess = next == Next::endsProcess ? 1 : 0;
    struct sigaction action {};
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    action.sa_sigaction = &note;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], nullptr, &actionsBefore[i]);
        if (actionsBefore[i].sa_handler != SIG_IGN) {
            sigaction(kSignals[i], &action, nullptr);
        }
    }
}

NotedSignals::~NotedSignals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], &actionsBefore[i], nullptr);
    }
    lastSignal = 0;
}

int notedSignal() noexcept {
    return lastSignal;
}

bool isFromKeyboard() noexcept {
    return isSentByKernel != 0;
}

}  // namespace hashphase::demos
