// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/headless_context.hpp>

#include <demos/viewer/draw/image.hpp>

#include <epoxy/egl.h>

#include <array>
#include <string>
#include <vector>

namespace hashphase::demos {

namespace {

/// A current context on the display, or none.
EGLContext tryDisplay(EGLDisplay display) {
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
        return EGL_NO_CONTEXT;
    }
    constexpr std::array<EGLint, 7> kAttributes{EGL_CONTEXT_MAJOR_VERSION,
                                                3,
                                                EGL_CONTEXT_MINOR_VERSION,
                                                3,
                                                EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                EGL_NONE};
    if (eglBindAPI(EGL_OPENGL_API) == EGL_TRUE) {
        EGLContext context =
            eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, kAttributes.data());
        if (context != EGL_NO_CONTEXT &&
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
            return context;
        }
    }
    eglTerminate(display);
    return EGL_NO_CONTEXT;
}

/// EGL's devices, then the one without surfaces.
std::vector<EGLDisplay> displays() {
    std::vector<EGLDisplay> all;
    std::array<EGLDeviceEXT, 8> devices{};
    EGLint count = 0;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") &&
        eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) ==
            EGL_TRUE) {
        for (EGLint i = 0; i < count; ++i) {
            all.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
        }
    }
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        all.push_back(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    }
    return all;
}

[[noreturn]] void refuse(const std::string& why) {
    throw DrawError("No picture can be drawn without a window, because EGL " + why +
                    " (Debian, Ubuntu: apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri; they "
                    "draw in software where there is no GPU).");
}

}  // namespace

HeadlessContext::HeadlessContext() {
    if (!epoxy_has_egl()) {
        refuse("is not installed");
    }
    for (EGLDisplay display : displays()) {
        context_ = tryDisplay(display);
        if (context_ != EGL_NO_CONTEXT) {
            display_ = display;
            return;
        }
    }
    refuse("offers no OpenGL 3.3 on any device: a driver is missing");
}

// The display is the process's, and stays: others may draw on it.
HeadlessContext::~HeadlessContext() {
    if (eglGetCurrentContext() == context_) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display_, context_);
}

}  // namespace hashphase::demos
