// SPDX-License-Identifier: Zlib
#pragma once

// OpenGL without a window, a display or a GPU: for tests, and for pictures made where nobody looks
// on.

namespace hashphase::demos {

/// An OpenGL 3.3 context of the calling thread, current from its creation to its end. Draws
/// nowhere: whoever uses it brings a framebuffer.
class HeadlessContext {
public:
    /// Tries EGL's devices, then a display without surfaces. Throws DrawError, which says what is
    /// missing and what to install, where neither can be had.
    HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;
    ~HeadlessContext();

private:
    void* display_ = nullptr;  // an EGLDisplay
    void* context_ = nullptr;  // an EGLContext
};

}  // namespace hashphase::demos
