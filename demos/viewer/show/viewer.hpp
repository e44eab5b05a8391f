// SPDX-License-Identifier: Zlib
#pragma once

// A session with a picture: draws it, with the panel over it, and writes the pictures that were asked for. The
// same in a window and without one.

#include <demos/viewer/draw/renderer.hpp>
#include <demos/viewer/session/session.hpp>
#include <demos/viewer/show/panel.hpp>
#include <demos/viewer/show/picture_maker.hpp>

namespace hashphase::demos {

class Viewer {
public:
    /// Needs an OpenGL context, for as long as it lives.
    Viewer(int width, int height) : renderer_(width, height) {}

    /// Lays out what show() draws: new parts of the panel find their size, and colours what they tell.
    void layOut(Session& session);

    /// Draws the session as it is; straight into the context's window where the picture `fitsWindow`, unless
    /// it is wanted as a screenshot, too. Somebody looks on where it is `seconds` after the last frame, not 0. Throws
    /// InputError where a picture that was asked for cannot be written; it has been drawn even so.
    void show(Session& session, const Panel::Pointer& pointer, double seconds,
              bool fitsWindow = false);

    /// A picture took so long to draw: small spheres go without their contact shade while that is long, but for
    /// screenshots, as nothing else costs that much.
    void keepPace(double seconds);

    /// OpenGL's name of what has been drawn into: 0 for the window.
    [[nodiscard]] unsigned framebuffer() const noexcept { return framebuffer_; }
    /// Spheres larger than that have a dark spot below them now [pixels, radius].
    [[nodiscard]] float contactFrom() const noexcept { return contactFrom_; }
    [[nodiscard]] Panel& panel() noexcept { return panel_; }

private:
    unsigned framebuffer_ = 0;
    float contactFrom_ = kContactFrom;  // [pixels]
    Renderer renderer_;
    Panel panel_;
    PictureMaker maker_;
};

}  // namespace hashphase::demos
