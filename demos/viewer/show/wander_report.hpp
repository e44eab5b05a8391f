// SPDX-License-Identifier: Zlib
#pragma once

// What `hashphase wander` says: what there is to be chosen, and the numbers of a run at its end.

#include <demos/viewer/session/session.hpp>

#include <iosfwd>
#include <optional>

namespace hashphase::demos {

/// Lists scenes, keys, commands and readings.
void listWander(std::ostream& out);

/// A run at its end.
struct WanderEnd {
    const Session& session;
    bool drewPictures = false;
    std::optional<double> framesPerSecond;  // that a window has shown, if it did for long enough
};

/// The phases of a frame, as a table, and how many bodies there are.
void tellPhases(const WanderEnd& end, std::ostream& out);

/// How many frames were shown a second, where that is known.
void tellFrameRate(const WanderEnd& end, std::ostream& out);

/// All numbers, as JSON; null for those that there are not.
void writeNumbers(const WanderEnd& end, std::ostream& out);

}  // namespace hashphase::demos
