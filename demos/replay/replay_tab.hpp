// SPDX-License-Identifier: Zlib
#pragma once

// A recording as a tab of a page.

#include <demos/replay/replay_recording.hpp>
#include <demos/report/page.hpp>
#include <demos/report/page_tab.hpp>

#include <string_view>

namespace hashphase::demos {

/// Adds the tab "Replay" to the page, unless no frame was recorded. `framesRun` is how many frames the
/// run had, the recorded ones included.
void addReplayTab(const ReplayRecording& recording, std::size_t framesRun, Page& page);

/// The JavaScript and the style sheet of the tab, as they were when the program was built.
[[nodiscard]] PageScript replayScript();
[[nodiscard]] std::string_view replayStyle();

}  // namespace hashphase::demos
