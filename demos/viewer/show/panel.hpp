// SPDX-License-Identifier: Zlib
#pragma once

// The panel over the picture: what runs and what it takes, as tables, graphs and switches, by Dear ImGui.
// All that is switched goes through the session's commands.

#include <demos/viewer/session/session.hpp>
#include <demos/viewer/show/picture_maker.hpp>

#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

inline constexpr float kPanelWidth = 350;  // [pixels]

class Panel {
public:
    /// Needs the OpenGL context that draw() will be called in; one panel at a time.
    Panel();
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    /// The pointer, in pixels, and whether its left and right buttons are down; wheel steps since the last
    /// frame.
    struct Pointer {
        float x = -1;
        float y = -1;
        bool left = false;
        bool right = false;
        float wheel = 0;
    };

    /// Lays out a frame and runs what was switched. `legends` say what the picture's colours tell. `seconds`
    /// have passed since the last one; 0 where nobody looks on.
    void build(Session& session, std::span<const Legend> legends, const Pointer& pointer,
               double seconds);

    /// Draws it into the framebuffer that is bound, of the size of the session's picture.
    void draw();

    /// Whether the pointer is over the panel, and not the scene's.
    [[nodiscard]] bool hasPointer() const;

    /// What is shown for some seconds at the lower border: an error, or what a command said.
    void say(const std::string& message, bool isFault = false);

    /// Runs a command of the user's, unless `guard` throws InputError; says what was wrong, where it cannot be
    /// run.
    void run(Session& session, std::string_view command);
    std::function<void(std::string_view command)> guard;

private:
    /// Runs what was switched in the frame that is laid out.
    struct Switches;

    void showSwitches(Session& session);
    void showMessage(const Session& session) const;

    std::string message_;
    bool isFault_ = false;
    double messageSeconds_ = 0;
    double frameSeconds_ = 0;  // smoothed
};

}  // namespace hashphase::demos
