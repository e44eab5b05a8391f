// SPDX-License-Identifier: Zlib
#include <demos/system/interruption.hpp>

#include <array>
#include <csignal>

namespace hashphase::demos {
namespace {

constexpr std::array kSignals{SIGINT, SIGBREAK, SIGTERM};

volatile std::sig_atomic_t lastSignal = 0;
volatile std::sig_atomic_t nextEndsProcess = 0;

// A signal is handled once, unless its handler is set again.
void note(int signal) {
    lastSignal = signal;
    if (nextEndsProcess == 0) {
        std::signal(signal, &note);
    }
}

}  // namespace

NotedSignals::NotedSignals(Next next) noexcept {
    lastSignal = 0;
    nextEndsProcess = next == Next::endsProcess ? 1 : 0;
    for (const int signal : kSignals) {
        std::signal(signal, &note);
    }
}

NotedSignals::~NotedSignals() {
    for (const int signal : kSignals) {
        std::signal(signal, SIG_DFL);
    }
    lastSignal = 0;
}

int notedSignal() noexcept {
    return lastSignal;
}

}  // namespace hashphase::demos
