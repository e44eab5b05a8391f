// SPDX-License-Identifier: Zlib
#include <demos/try/noted_signals.hpp>

#include <cstddef>

namespace hashphase::demos {
namespace {

volatile std::sig_atomic_t receivedSignal = 0;
volatile std::sig_atomic_t isSentByKernel = 0;

void note(int signal, siginfo_t* information, void* /*context*/) {
    isSentByKernel = information->si_code == SI_KERNEL ? 1 : 0;
    receivedSignal = signal;
}

}  // namespace

NotedSignals::NotedSignals() noexcept {
    receivedSignal = 0;
    struct sigaction action {};
    action.sa_flags = SA_SIGINFO;
    action.sa_sigaction = &note;
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN) {
            sigaction(kSignals[i], &action, nullptr);
        }
    }
}

NotedSignals::~NotedSignals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], &before_[i], nullptr);
    }
}

int NotedSignals::received() const noexcept {
    return receivedSignal;
}

bool NotedSignals::isFromKeyboard() const noexcept {
    return isSentByKernel != 0;
}

}  // namespace hashphase::demos
