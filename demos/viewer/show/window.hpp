// SPDX-License-Identifier: Zlib
#pragma once

// The viewer in a window, by GLFW: keys and the mouse become commands of the session.

#include <demos/viewer/session/session.hpp>
#include <demos/viewer/show/frame_rate.hpp>
#include <demos/viewer/show/panel.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

namespace hashphase::demos {

class Viewer;

class Window {
public:
    /// Opens the window, with an OpenGL context that is current while it lives. Throws InputError, which says
    /// what to do, where there is no display or no OpenGL 3.3.
    Window(int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Has this asked before keys, clicks and the panel run a command; see Panel::setGuard().
    void setGuard(Panel::Guard guard) { guard_ = std::move(guard); }

    /// Shows the session until the window is closed, `frames` of the scene have been simulated, if that is
    /// not 0, or `isDone`, which is asked before each frame and may run commands, says so. Returns how many
    /// frames it has shown a second.
    FrameRate run(Session& session, std::uint64_t frames, const std::function<bool()>& isDone);

private:
    struct Input;
    void listen(Session& session, Viewer& viewer, double seconds);
    void present(Session& session, Viewer& viewer, double seconds);
    void rest(const Session& session, double frameSeconds);

    std::unique_ptr<Input> input_;
    Panel::Guard guard_;
};

}  // namespace hashphase::demos
