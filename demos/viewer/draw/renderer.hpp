// SPDX-License-Identifier: Zlib
#pragma once

// Draws pictures (picture.hpp) by OpenGL 3.3, into a framebuffer of its own: the same pixels with a
// window and without one.
//
// A frame  draw(), then read() the pixels, or blit framebuffer() to a window's
// Context  current in every call, from the constructor to the destructor; whatever state a draw()
//          needs it sets, and it may leave any state behind
// Memory   grows to the largest picture so far; from then on a draw() allocates nothing
// Misuse   DrawError where OpenGL refuses: what() says what

#include <demos/viewer/draw/image.hpp>
#include <demos/viewer/draw/picture.hpp>

#include <memory>

namespace hashphase::demos {

class Renderer {
public:
    /// For pictures of so many pixels, at least one each way.
    Renderer(int width, int height);
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    ~Renderer();

    /// The next picture is of another size. What was drawn is lost.
    void resize(int width, int height);
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;

    /// Returns when OpenGL has the picture; it may still be drawing it.
    void draw(const Picture& picture);

    /// What was drawn last. Waits for it.
    [[nodiscard]] Image read() const;

    /// OpenGL's name of what is drawn into, to be read from.
    [[nodiscard]] unsigned framebuffer() const;

private:
    struct Layers;
    std::unique_ptr<Layers> layers_;
};

}  // namespace hashphase::demos
