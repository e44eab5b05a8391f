// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/viewer.hpp>

#include <demos/scenes/input_error.hpp>
#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/png.hpp>

#include <epoxy/gl.h>

namespace hashphase::demos {

void Viewer::show(Session& session, const Panel::Pointer& pointer, double seconds) {
    if (renderer_.width() != session.width() || renderer_.height() != session.height()) {
        renderer_.resize(session.width(), session.height());
    }
    panel_.build(session, pointer, seconds);
    renderer_.draw(maker_.make(session));
    glBindFramebuffer(GL_FRAMEBUFFER, renderer_.framebuffer());
    glViewport(0, 0, session.width(), session.height());
    panel_.draw();
    for (const std::string& path : session.takeScreenshots()) {
        try {
            writePng(path, renderer_.read());
        } catch (const DrawError& error) {
            throw InputError(error.what());
        }
        session.say("wrote " + path);
    }
}

}  // namespace hashphase::demos
