// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/viewer.hpp>

#include <demos/console/result_file.hpp>
#include <demos/scenes/input_error.hpp>

#include <epoxy/gl.h>

#include <algorithm>
#include <ostream>

namespace hashphase::demos {
namespace {

constexpr double kSlow = 0.038;        // [s]: with the simulation, 22 pictures a second
constexpr double kQuick = 0.028;       // [s]
constexpr float kPace = 1.05F;         // of the change, in a frame
constexpr float kMostContact = 40.0F;  // [pixels]

}  // namespace

void Viewer::keepPace(double seconds) {
    if (seconds > kSlow) {
        contactFrom_ = std::min(kPace * contactFrom_, kMostContact);
    } else if (seconds < kQuick) {
        contactFrom_ = std::max(contactFrom_ / kPace, kContactFrom);
    }
}

void Viewer::layOut(Session& session) {
    static_cast<void>(maker_.make(session));
    panel_.build(session, maker_.legends(session), {}, 0);
}

void Viewer::show(Session& session, const Panel::Pointer& pointer, double seconds,
                  bool fitsWindow) {
    renderer_.resize(session.width, session.height);
    panel_.build(session, maker_.legends(session), pointer, seconds);
    framebuffer_ = fitsWindow && session.screenshots.empty() ? 0 : renderer_.framebuffer();
    const float contactFrom = !session.screenshots.empty() ? kContactFrom : contactFrom_;
    const int covered = session.options.panel ? static_cast<int>(kPanelWidth) : 0;
    renderer_.draw(maker_.make(session, contactFrom, covered), framebuffer_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, session.width, session.height);
    panel_.draw();
    for (const std::string& path : session.takeScreenshots()) {
        try {
            ResultFile(path).write(
                [this](std::ostream& file) { writePng(renderer_.read(), file); });
        } catch (const DrawError& error) {
            throw InputError(error.what());
        }
        session.say("wrote " + path);
    }
}

}  // namespace hashphase::demos
