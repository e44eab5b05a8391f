// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/viewer/session/session.hpp>

#include <cstdint>

namespace hashphase::demos {

/// Simulates so many frames.
inline void step(Session& session, std::uint64_t frames) {
    session.askForSteps(frames);
    while (session.isWaiting()) {
        session.advance();
    }
}

}  // namespace hashphase::demos
