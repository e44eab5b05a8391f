// SPDX-License-Identifier: Zlib
#pragma once

// Draws pictures (picture.hpp) by OpenGL 3.3, into a framebuffer of its own or another one: the same pixels
// with a window and without one.
//
// A frame  draw(), then read() the pixels, or blit framebuffer() to a window's. A window of the same size is
//          better drawn into: a blit takes a software renderer a tenth of a frame
// Context  current in every call, from the constructor to the destructor; whatever state a draw()
//          needs it sets, and it may leave any state behind
// Memory   grows to the largest picture so far; from then on a draw() allocates nothing
// Misuse   DrawError where OpenGL refuses: what() says what

#include <demos/viewer/draw/body_layers.hpp>
#include <demos/viewer/draw/ground_layer.hpp>
#include <demos/viewer/draw/image.hpp>
#include <demos/viewer/draw/picture.hpp>

namespace hashphase::demos {

/// A framebuffer of colour and depth.
struct FrameTarget {
    FrameTarget(int wide, int high);

    int width;
    int height;
    GlFramebuffer framebuffer;
    GlRenderbuffer colour;
    GlRenderbuffer depth;
};

class Renderer {
public:
    /// For pictures of so many pixels, at least one each way.
    Renderer(int width, int height) : target_(width, height) {}

    /// The next picture is of that size. Where it is another one, what was drawn is lost.
    void resize(int width, int height);

    /// Returns when OpenGL has the picture; it may still be drawing it.
    void draw(const Picture& picture) { draw(picture, framebuffer()); }
    /// Draws into the framebuffer of that name, as large as pictures are, with colour and depth; 0 is that of
    /// the context's window.
    void draw(const Picture& picture, unsigned framebuffer);

    /// What was drawn last into framebuffer(). Waits for it.
    [[nodiscard]] Image read() const;

    /// OpenGL's name of its own framebuffer.
    [[nodiscard]] unsigned framebuffer() const { return target_.framebuffer.name(); }

private:
    void prepare(const Picture& picture, const View& view, unsigned framebuffer);

    FrameTarget target_;
    GlBuffer frame_;
    Layer sky_{{.shader = "sky"}};
    GroundLayer ground_;
    BodyLayers bodies_;
    Layer rectangle_{{.shader = "rectangle"}};
};

}  // namespace hashphase::demos
