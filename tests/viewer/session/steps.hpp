// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/script.hpp>
#include <demos/viewer/session/session.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Simulates so many frames.
inline void step(Session& session, std::uint64_t frames) {
    session.askForSteps(frames);
    while (session.isWaiting()) {
        session.advance();
    }
}

/// What is wrong with a command; "none" where it can be run.
inline std::string faultOf(Session& session, const std::string& line) {
    try {
        session.run(line);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

/// Runs a script to its end and returns what was said.
inline std::vector<std::string> runScript(Session& session, const std::string& text) {
    std::vector<std::string> said;
    Script script(text, "script");
    session.isPlaying = false;
    while (!script.isDone() || session.isWaiting()) {
        script.feed(session);
        session.advance();
        for (const std::string& message : session.takeMessages()) {
            said.push_back(message);
        }
        static_cast<void>(session.takeScreenshots());
    }
    return said;
}

}  // namespace hashphase::demos
