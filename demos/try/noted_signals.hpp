// SPDX-License-Identifier: Zlib
#pragma once

#include <array>
#include <csignal>

namespace hashphase::demos {

/// Notes the signals that would end this process (SIGINT, SIGQUIT, SIGTERM, SIGHUP), for as long as it lives,
/// but for those that are ignored, as nohup asks. One at a time.
class NotedSignals {
public:
    NotedSignals() noexcept;
    ~NotedSignals();
    NotedSignals(const NotedSignals&) = delete;
    NotedSignals& operator=(const NotedSignals&) = delete;

    /// The last that was received; 0: none.
    [[nodiscard]] int received() const noexcept;

    /// Whether that has reached all programs of the terminal as well.
    [[nodiscard]] bool isFromKeyboard() const noexcept;

private:
    static constexpr std::array kSignals{SIGINT, SIGQUIT, SIGTERM, SIGHUP};
    std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace hashphase::demos
