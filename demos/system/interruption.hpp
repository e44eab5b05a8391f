// SPDX-License-Identifier: Zlib
#pragma once

// Signals that ask this process to end, such as Ctrl-C: interruption_posix.cpp, interruption_windows.cpp.

#include <exception>

namespace hashphase::demos {

/// While it lives, this process notes these signals and goes on, so that its work can end with what it has. Signals
/// that are ignored stay so, as nohup asks. One at a time. A limit on the size of files is then an error like a full
/// disk, too, and no signal.
class NotedSignals {
public:
    /// What further signals do.
    enum class Next { endsProcess, isNoted };

    explicit NotedSignals(Next next = Next::endsProcess) noexcept;
    ~NotedSignals();
    NotedSignals(const NotedSignals&) = delete;
    NotedSignals& operator=(const NotedSignals&) = delete;
};

/// The last signal that was noted; 0: none.
[[nodiscard]] int notedSignal() noexcept;

/// Whether a terminal sent it, to all programs in its foreground. POSIX only.
[[nodiscard]] bool isFromKeyboard() noexcept;

[[nodiscard]] inline bool isInterrupted() noexcept {
    return notedSignal() != 0;
}

/// Leaves work that has nothing to show before its end.
struct Interrupted : std::exception {
    [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

inline void throwIfInterrupted() {
    if (isInterrupted()) {
        throw Interrupted();
    }
}

}  // namespace hashphase::demos
