// SPDX-License-Identifier: Zlib
#pragma once

// The viewer in a window, by GLFW: keys and the mouse become commands of the session.

#include <demos/viewer/session/session.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace hashphase::demos {

/// How many frames a window has shown in a second. The first second is left out: windows and tables come up
/// in it.
struct FrameRate {
    /// A frame has been shown, so many seconds after the window came up.
    void note(double seconds) {
        if (seconds >= 1) {
            first = count++ == 0 ? seconds : first;
            last = seconds;
        }
    }

    /// None where nothing was shown after the first second.
    [[nodiscard]] std::optional<double> perSecond() const {
        return last > first ? std::optional((static_cast<double>(count) - 1) / (last - first))
                            : std::nullopt;
    }

    double first = 0;  // frame after the first second [s]
    double last = 0;
    std::uint64_t count = 0;
};

/// Shows the session until the window is closed, `frames` of the scene have been simulated, if that is not 0,
/// or `isDone`, which is asked before each frame and may run commands, says so. `guard` is asked before keys,
/// clicks and the panel run a command; see Panel::run(). Returns how many frames it has shown a second. Throws
/// InputError, which says what to do, where there is no display or no OpenGL 3.3.
FrameRate showInWindow(Session& session, std::uint64_t frames, const std::function<bool()>& isDone,
                       const std::function<void(std::string_view)>& guard);

}  // namespace hashphase::demos
