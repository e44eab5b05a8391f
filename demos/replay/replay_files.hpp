// SPDX-License-Identifier: Zlib
#pragma once

// The JavaScript and the style sheet of the replay, as they were when the program was built.

#include <demos/report/page_tab.hpp>

namespace hashphase::demos {

[[nodiscard]] PageScript replayScript();
[[nodiscard]] std::string_view replayStyle();

}  // namespace hashphase::demos
