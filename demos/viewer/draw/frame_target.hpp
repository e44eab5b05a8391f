// SPDX-License-Identifier: Zlib
#pragma once

// What is drawn into: a framebuffer of colour and depth.

#include <demos/viewer/draw/gl_objects.hpp>
#include <demos/viewer/draw/image.hpp>

namespace hashphase::demos {

class FrameTarget {
public:
    FrameTarget(int width, int height);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] GLuint name() const { return framebuffer_.name(); }

    [[nodiscard]] Image read() const;

private:
    int width_;
    int height_;
    GlFramebuffer framebuffer_;
    GlRenderbuffer colour_;
    GlRenderbuffer depth_;
};

}  // namespace hashphase::demos
