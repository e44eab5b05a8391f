// SPDX-License-Identifier: Zlib
#pragma once

// A recording as a tab of a page.

#include <demos/replay/replay_recording.hpp>
#include <demos/report/page.hpp>

namespace hashphase::demos {

/// Adds the tab "Replay" to the page, unless no frame was recorded. `framesRun` is how many frames the
/// run had, the recorded ones included.
void addReplayTab(const ReplayRecording& recording, std::size_t framesRun, Page& page);

}  // namespace hashphase::demos
