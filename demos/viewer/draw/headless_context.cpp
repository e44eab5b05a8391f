// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/headless_context.hpp>

#include <demos/viewer/draw/draw_error.hpp>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>

namespace hashphase::demos {

namespace {

constexpr const char* kAdvice =
    " (Debian, Ubuntu: apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri; they draw in software "
    "where there is no GPU).";

struct HeadlessDisplay {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
};

/// A current context on the display, or none.
HeadlessDisplay tryDisplay(EGLDisplay display) {
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
        return {};
    }
    constexpr std::array<EGLint, 7> kAttributes{EGL_CONTEXT_MAJOR_VERSION,
                                                3,
                                                EGL_CONTEXT_MINOR_VERSION,
                                                3,
                                                EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API) == EGL_TRUE) {
        const EGLContext context =
            eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes.data());
        if (context != EGL_NO_CONTEXT &&
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
            return {display, context};
        }
    }
    eglTerminate(display);
    return {};
}

HeadlessDisplay tryDevices() {
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
        eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) ==
            EGL_FALSE) {
        return {};
    }
    for (EGLint i = 0; i < count; ++i) {
        const auto found =
            tryDisplay(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
        if (found.context != EGL_NO_CONTEXT) {
            return found;
        }
    }
    return {};
}

HeadlessDisplay trySurfaceless() {
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        return {};
    }
    return tryDisplay(
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
}

}  // namespace

HeadlessContext::HeadlessContext() {
    if (!epoxy_has_egl()) {
        throw DrawError(std::string("No picture can be drawn without a window, because EGL is not "
                                    "installed") +
                        kAdvice);
    }
    HeadlessDisplay found = tryDevices();
    if (found.context == EGL_NO_CONTEXT) {
        found = trySurfaceless();
    }
    if (found.context == EGL_NO_CONTEXT) {
        throw DrawError(std::string("No picture can be drawn without a window, because EGL offers "
                                    "no OpenGL 3.3 on any device: a driver is missing") +
                        kAdvice);
    }
    display_ = found.display;
    context_ = found.context;
}

// The display is the process's, and stays: others may draw on it.
HeadlessContext::~HeadlessContext() {
    if (eglGetCurrentContext() == context_) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display_, context_);
}

std::string HeadlessContext::description() const {
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const auto* version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    return std::string(renderer) + ", OpenGL " + version;
}

}  // namespace hashphase::demos
