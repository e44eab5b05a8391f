// SPDX-License-Identifier: Zlib
#pragma once

#include <array>
#include <csignal>

namespace hashphase::demos {

/// Signals as they are in a terminal: a shell that starts the tests in the background, or nohup, has some ignored.
inline const std::array kInterruptible{std::signal(SIGINT, SIG_DFL), std::signal(SIGTERM, SIG_DFL),
                                       std::signal(SIGHUP, SIG_DFL)};

}  // namespace hashphase::demos
