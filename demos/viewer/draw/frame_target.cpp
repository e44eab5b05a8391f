// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/frame_target.hpp>

#include <demos/viewer/draw/draw_error.hpp>

#include <algorithm>
#include <string>

namespace hashphase::demos {

FrameTarget::FrameTarget(int width, int height) : width_(width), height_(height) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (std::min(width, height) < 1 || std::max(width, height) > largest) {
        throw DrawError("A picture of " + size + " pixels cannot be drawn: each way, 1 to " +
                        std::to_string(largest) + " are possible.");
    }
    glBindRenderbuffer(GL_RENDERBUFFER, colour_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_.name());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                              colour_.name());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw DrawError("OpenGL offers no framebuffer of " + size +
                        " pixels with colour and depth.");
    }
}

Image FrameTarget::read() const {
    Image image{width_, height_, {}};
    const std::size_t rowSize = std::size_t{4} * width_;
    image.pixels.resize(rowSize * height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data());

    // OpenGL's first row is the lowest one.
    auto top = image.pixels.begin();
    auto bottom = image.pixels.end();
    for (int row = 0; row < height_ / 2; ++row) {
        bottom -= static_cast<std::ptrdiff_t>(rowSize);
        top = std::swap_ranges(bottom, bottom + static_cast<std::ptrdiff_t>(rowSize), top);
    }
    return image;
}

}  // namespace hashphase::demos
