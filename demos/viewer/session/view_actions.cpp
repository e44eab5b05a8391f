// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/command_actions.hpp>

#include <demos/console/format.hpp>

#include <array>
#include <numbers>
#include <vector>

namespace hashphase::demos::actions {
namespace {

constexpr double kFar = 1e6;  // [m], [pixels]
constexpr double kDegree = std::numbers::pi / 180;

float metres(Arguments& words, std::string_view name) {
    return static_cast<float>(words.number(name, -kFar, kFar));
}

float degrees(Arguments& words, std::string_view name) {
    return static_cast<float>(words.number(name, -360, 360) * kDegree);
}

// The one that is named, or the one after the present one.
std::size_t chosenOrNext(Arguments& words, std::string_view name,
                         std::span<const std::string_view> known, std::size_t now) {
    std::vector<std::string_view> names(known.begin(), known.end());
    names.push_back("next");
    const std::size_t chosen = words.isEmpty() ? known.size() : words.choice(name, names);
    words.end();
    return chosen < known.size() ? chosen : (now + 1) % known.size();
}

Pixel pixel(Arguments& words) {
    const double x = words.number("X", -kFar, kFar);
    const double y = words.number("Y", -kFar, kFar);
    return {x, y};
}

}  // namespace

// --- Camera --------------------------------------------------------------------------------------

void camera(Session& session, Arguments& words) {
    const std::size_t chosen = words.choice("camera", kCameraModes);
    words.end();
    const auto mode = static_cast<CameraMode>(chosen);
    session.setCameraMode(mode);
}

void home(Session& session, Arguments& words) {
    words.end();
    session.goHome();
}

void move(Session& session, Arguments& words) {
    const float right = metres(words, "RIGHT");
    const float up = metres(words, "UP");
    const float forward = metres(words, "FORWARD");
    words.end();
    session.camera().move({right, up, forward});
}

void turn(Session& session, Arguments& words) {
    const float yaw = degrees(words, "LEFT");
    const float pitch = degrees(words, "UP");
    words.end();
    session.camera().turn(yaw, pitch);
}

void zoom(Session& session, Arguments& words) {
    const auto factor = static_cast<float>(words.number("FACTOR", 0.01, 100));
    words.end();
    session.camera().zoom(factor);
}

void eye(Session& session, Arguments& words) {
    const float x = metres(words, "X");
    const float y = metres(words, "Y");
    const float z = metres(words, "Z");
    const float yaw = degrees(words, "YAW");
    const float pitch = degrees(words, "PITCH");
    words.end();
    session.camera().place({x, y, z}, yaw, pitch);
}

void pose(Session& session, Arguments& words) {
    const auto mode = static_cast<CameraMode>(words.choice("camera", kCameraModes));
    Camera::State state{};
    for (std::size_t i = 0; i < state.size(); ++i) {
        const auto [low, high] = Camera::stateLimits()[i];
        state[i] = static_cast<float>(words.number("NUMBER", double{low}, double{high}));
    }
    words.end();
    session.camera().setState(mode, state);
}

void freeze(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.frozenPose().has_value());
    words.end();
    session.freeze(isOn);
}

void size(Session& session, Arguments& words) {
    const long long width = words.whole("WIDTH", kLeastSide, kMostSide);
    const long long height = words.whole("HEIGHT", kLeastSide, kMostSide);
    words.end();
    session.resize(static_cast<int>(width), static_cast<int>(height));
}

// --- Selection -----------------------------------------------------------------------------------

void pick(Session& session, Arguments& words) {
    const Pixel at = pixel(words);
    words.end();
    session.pick(at);
}

void box(Session& session, Arguments& words) {
    const Pixel from = pixel(words);
    const Pixel to = pixel(words);
    words.end();
    session.setRectangle(std::nullopt);
    session.selectBetween(from, to);
}

void drag(Session& session, Arguments& words) {
    const Pixel from = pixel(words);
    const Pixel to = pixel(words);
    words.end();
    session.setRectangle(DrawnRectangle{from.cast<float>(), to.cast<float>()});
}

void clear(Session& session, Arguments& words) {
    words.end();
    session.setRectangle(std::nullopt);
    session.forgetSelection();
}

void push(Session& session, Arguments& words) {
    Vector3<float> velocity(0, 12, 0);
    if (!words.isEmpty()) {
        const float x = metres(words, "X");
        const float y = metres(words, "Y");
        const float z = metres(words, "Z");
        velocity = {x, y, z};
    }
    words.end();
    session.say("pushed " + withThousands(session.pushSelected(velocity)));
}

void remove(Session& session, Arguments& words) {
    words.end();
    session.say("removed " + withThousands(session.removeSelected()));
}

void recolour(Session& session, Arguments& words) {
    words.end();
    session.say("recoloured " + withThousands(session.recolourSelected()));
}

// --- How it is shown -----------------------------------------------------------------------------

void colour(Session& session, Arguments& words) {
    session.options().colouring = static_cast<Colouring>(chosenOrNext(
        words, "colouring", kColourings, static_cast<std::size_t>(session.options().colouring)));
}

void overlay(Session& session, Arguments& words) {
    bool& isShown = session.options().overlays[words.choice("overlay", kOverlays)];
    const bool isOn = words.onOff(isShown);
    words.end();
    isShown = isOn;
}

void dots(Session& session, Arguments& words) {
    const double radius = words.number("PIXELS", 0, 20);
    words.end();
    session.options().dots = static_cast<float>(radius);
}

void theme(Session& session, Arguments& words) {
    session.options().theme = static_cast<Theme>(
        chosenOrNext(words, "theme", kThemes, static_cast<std::size_t>(session.options().theme)));
}

void panel(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.options().panel);
    words.end();
    session.options().panel = isOn;
}

void help(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.options().help);
    words.end();
    session.options().help = isOn;
}

}  // namespace hashphase::demos::actions
