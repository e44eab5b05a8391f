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
class FrameRate {
public:
    /// A frame has been shown, so many seconds after the window came up.
    void note(double seconds) {
        if (seconds < kLeftOut) {
            return;
        }
        if (!begin_) {
            begin_ = seconds;
        } else {
            ++frameCount_;
            end_ = seconds;
        }
    }

    /// None where nothing was shown after the first second.
    [[nodiscard]] std::optional<double> perSecond() const {
        if (frameCount_ == 0 || !(end_ > *begin_)) {
            return std::nullopt;
        }
        return static_cast<double>(frameCount_) / (end_ - *begin_);
    }

private:
    static constexpr double kLeftOut = 1;  // [s]

    std::optional<double> begin_;  // when the last frame was shown that is left out [s]
    double end_ = 0;               // when the last one was [s]
    std::uint64_t frameCount_ = 0;
};

/// Shows the session until the window is closed, `frames` of the scene have been simulated, if that is not 0,
/// or `isDone`, which is asked before each frame and may run commands, says so. `guard` is asked before keys,
/// clicks and the panel run a command; see Panel::run(). Returns how many frames it has shown a second. Throws
/// InputError, which says what to do, where there is no display or no OpenGL 3.3.
FrameRate showInWindow(Session& session, std::uint64_t frames, const std::function<bool()>& isDone,
                       const std::function<void(std::string_view)>& guard);

}  // namespace hashphase::demos
