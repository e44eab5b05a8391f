// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/viewer/session/session.hpp>

#include <span>

namespace hashphase::demos {

/// Stops the session's clock, and runs each command, followed by the frames that it asks for, or by one.
inline void play(Session& session, std::span<const char* const> commands) {
    session.isPlaying = false;
    for (const char* command : commands) {
        session.run(command);
        do {
            session.advance();
        } while (session.isWaiting());
    }
}

}  // namespace hashphase::demos
